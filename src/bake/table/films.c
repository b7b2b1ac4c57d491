/* SPDX-License-Identifier: MIT */
#include "bake/table/films.h"

#include <stdio.h>
#include <string.h>

static const struct glint_text_range nm_range = {"coating wavelength", 100,
                                                 5000};
const struct glint_text_range glint_film_index_range = {"coating index", 1.01,
                                                        4};

bool glint_film_of(const struct glint_text *text, const struct glint_word *word,
                   struct glint_film *film)
{
    *film = (struct glint_film){0, 0};
    if (glint_word_is(word, "none"))
        return true;
    film->index = GLINT_MGF2_INDEX;
    return glint_text_value_of(text, word, &nm_range, &film->nm);
}

/* Reads a film and, after a slash, its index. */
static bool read_film(const struct glint_text *text,
                      const struct glint_word *word, struct glint_film *film)
{
    const char *slash = memchr(word->start, '/', (size_t)word->length);
    struct glint_word nm = *word, index = *word;

    if (!slash)
        return glint_film_of(text, word, film);
    nm.length = (int)(slash - word->start);
    index.start = slash + 1;
    index.length = word->length - nm.length - 1;
    index.place.column += nm.length + 1;
    return glint_text_value_of(text, &nm, &nm_range, &film->nm) &&
           glint_text_value_of(text, &index, &glint_film_index_range,
                               &film->index);
}

bool glint_films_read(struct glint_text *text,
                      struct glint_film films[GLINT_MAX_FILMS], int *n)
{
    struct glint_word word = glint_text_next_word(text);

    *n = 0;
    do {
        if (*n == GLINT_MAX_FILMS)
            return glint_text_fail(text, word.place, "more than %d films",
                                   GLINT_MAX_FILMS);
        if (!read_film(text, &word, &films[*n]))
            return false;
        ++*n;
        word = glint_text_next_word(text);
    } while (word.length);
    return true;
}

enum glint_status glint_films_parse(struct glint_film films[GLINT_MAX_FILMS],
                                    int *n, const char *text,
                                    struct glint_error *error)
{
    struct glint_film read[GLINT_MAX_FILMS];
    struct glint_error found = {""};
    struct glint_text line;
    char words[GLINT_LINE_BYTES + 1];
    const int length = snprintf(words, sizeof words, "%s", text);
    int n_read;

    if (length >= (int)sizeof words) {
        snprintf(error->text, sizeof error->text,
                 "films take at most %d characters", GLINT_LINE_BYTES);
        return GLINT_E_ARGUMENT;
    }
    for (char *c = words; *c; c++)
        *c = (char)(*c == ',' ? ' ' : *c == ' ' ? ',' : *c);
    if (!glint_text_open(&line, words, (size_t)length, "", &found) ||
        !glint_text_next_line(&line) ||
        !glint_films_read(&line, read, &n_read)) {
        const char *cause = strstr(found.text, ": ");

        snprintf(error->text, sizeof error->text, "%.150s",
                 cause ? cause + 2 : "there is no film");
        return GLINT_E_ARGUMENT;
    }
    memcpy(films, read, (size_t)n_read * sizeof *films);
    *n = n_read;
    return GLINT_OK;
}

int glint_films_mixed(struct glint_film films[GLINT_MAX_FILMS])
{
    /* 1080 is a half wave in the middle of the band, which reflects green */
    static const double nm[] = {450, 620, 1080, 520, 680, 490, 560};
    enum { N = sizeof nm / sizeof *nm };

    for (int i = 0; i < N; i++)
        films[i] = (struct glint_film){nm[i], GLINT_MGF2_INDEX};
    return N;
}

void glint_prescription_coat(struct glint_prescription *lens,
                             const struct glint_film *films, int n)
{
    int dealt = 0;

    for (int k = 0; k < lens->n_surfaces; k++) {
        struct glint_surface *s = &lens->surface[k];
        const bool cemented = k > 0 && s[-1].vd > 0.0 && s->vd > 0.0;

        s->coating_nm = s->coating_n = 0;
        if (cemented)
            continue;
        s->coating_nm = films[dealt % n].nm;
        s->coating_n = films[dealt % n].index;
        dealt++;
    }
}
