/* SPDX-License-Identifier: MIT */
#include "bake/table/coatings.h"

#include <stdio.h>
#include <string.h>

static const struct glint_text_range nm_range = {"coating wavelength", 100,
                                                 5000};
static const struct glint_text_range index_range = {"coating index", 1.01, 4};
static const struct glint_text_range quarters_range = {"coating thickness",
                                                       0.01, 16};

/* ------------------------------------------------------------------- names */

/* Antireflection coatings by name. Indices of refraction: magnesium fluoride
 * 1.38; aluminium oxide, evaporated, 1.63 to 1.69; zirconium oxide 2.1. The
 * single layer of 1.38 and the two quarter waves are textbook designs. The
 * three layers of a quarter, a half and a quarter wave follow Cox, Hass and
 * Thelen, Triple-layer antireflection coatings on glass for the visible and
 * near infrared, JOSA 52(9), 1962. The four layers use two materials; a search
 * chose their thicknesses for the smallest reflectance from 420 to 680 nm on
 * glasses of 1.52 to 1.7. */
static const struct {
    const char *name;
    struct glint_coating coating;
} named[] = {
    {"v-coat", {550, 2, {{GLINT_MGF2_INDEX, 1}, {1.69, 1}}}},
    {"broadband-3", {520, 3, {{GLINT_MGF2_INDEX, 1}, {2.1, 2}, {1.63, 1}}}},
    {"broadband-4",
     {520,
      4,
      {{GLINT_MGF2_INDEX, 1.01},
       {2.1, 2.2},
       {GLINT_MGF2_INDEX, 0.31},
       {2.1, 0.26}}}},
};

const char *glint_coating_named(int k, struct glint_coating *coating)
{
    if (k < 0 || k >= (int)(sizeof named / sizeof *named))
        return NULL;
    *coating = named[k].coating;
    return named[k].name;
}

void glint_coating_set_single_layer(struct glint_coating *coating, double nm)
{
    *coating = (struct glint_coating){nm, 1, {{GLINT_MGF2_INDEX, 1}}};
}

/* ----------------------------------------------------------------- reading */

/* Cuts WORD at the first SIGN. Returns the text after the sign; its length is 0
 * if there is no sign, and -1 if no text follows. */
static struct glint_word split_word_at_sign(struct glint_word *word, char sign)
{
    const char *found = word->length > 0
                            ? memchr(word->start, sign, (size_t)word->length)
                            : NULL;
    struct glint_word rest = *word;
    const int length = found ? (int)(found - word->start) : word->length;

    rest.start += length;
    rest.length -= length;
    rest.place.column += length;
    if (found) {
        word->length = length;
        rest.start++;
        rest.length--;
        rest.place.column++;
        if (rest.length == 0)
            rest.length = -1;
    }
    return rest;
}

/* Reads WORD as a number in RANGE. A WORD of length -1 is reported as
 * missing. */
static bool read_number_word(const struct glint_text *text,
                             struct glint_word word,
                             const struct glint_text_range *range,
                             double *value)
{
    if (word.length < 0)
        word.length = 0;
    return glint_text_parse_value(text, &word, range, value);
}

/* Reads the first word of a coating: "none", a name or a wavelength. TAKES
 * receives the max number of words that may follow. */
static bool read_coating_kind(const struct glint_text *text,
                              const struct glint_word *word,
                              struct glint_coating *coating, int *takes)
{
    char quote[GLINT_QUOTE_BYTES];
    double nm;

    memset(coating, 0, sizeof *coating);
    *takes = 0;
    if (glint_word_equals(word, "none"))
        return true;
    *takes = 1;
    for (size_t k = 0; k < sizeof named / sizeof *named; k++)
        if (glint_word_equals(word, named[k].name)) {
            *coating = named[k].coating;
            return true;
        }
    if (word->length > 0 && word->start[0] >= 'a' && word->start[0] <= 'z')
        return glint_text_set_error(text, word->place,
                                    "'%s' is not a coating; expected none, %s, "
                                    "%s, %s or a wavelength in nm",
                                    glint_word_quote(word, quote),
                                    named[0].name, named[1].name,
                                    named[2].name);
    if (!read_number_word(text, *word, &nm_range, &nm))
        return false;
    glint_coating_set_single_layer(coating, nm);
    *takes = GLINT_MAX_FILMS;
    return true;
}

/* Reads word number AT, counted from 0, of those that follow the first word of
 * COATING. If IS_NAMED, it is the design wavelength, else INDEX[:QUARTERS] of
 * film AT. */
static bool read_coating_word(const struct glint_text *text,
                              struct glint_word word, bool is_named, int at,
                              struct glint_coating *coating)
{
    struct glint_film *film = &coating->film[at];
    struct glint_word quarters;

    if (is_named)
        return read_number_word(text, word, &nm_range, &coating->nm);
    quarters = split_word_at_sign(&word, ':');
    film->quarters = 1;
    coating->n_films = at + 1;
    return read_number_word(text, word, &index_range, &film->index) &&
           (quarters.length == 0 ||
            read_number_word(text, quarters, &quarters_range, &film->quarters));
}

/* Source of the words of one coating: the rest of a line, or one word whose
 * values are separated by slashes. */
struct word_source {
    struct glint_text *text;
    bool in_word;
    /* unread rest of the word whose values are separated by slashes */
    struct glint_word rest;
};

static struct glint_word read_next_coating_word(struct word_source *word_source)
{
    struct glint_word part = word_source->rest;

    if (!word_source->in_word)
        return glint_text_next_word(word_source->text);
    word_source->rest = split_word_at_sign(&part, '/');
    if (part.length == 0 && word_source->rest.length)
        part.length = -1; /* marks a missing value between two slashes */
    return part;
}

static bool read_coating_words(struct word_source *word_source,
                               struct glint_coating *coating)
{
    struct glint_word part = read_next_coating_word(word_source);
    int takes;

    if (!read_coating_kind(word_source->text, &part, coating, &takes))
        return false;
    for (int at = 0; at < takes; at++) {
        part = read_next_coating_word(word_source);
        if (!part.length)
            return true;
        if (!read_coating_word(word_source->text, part, takes == 1, at,
                               coating))
            return false;
    }
    if (takes < GLINT_MAX_FILMS)
        return true;
    part = read_next_coating_word(word_source);
    return !part.length ||
           glint_text_set_error(word_source->text, part.place,
                                "more than %d films", GLINT_MAX_FILMS);
}

bool glint_coating_read(struct glint_text *text, struct glint_coating *coating)
{
    struct word_source word_source = {.text = text};

    return read_coating_words(&word_source, coating);
}

static bool read_coating_from_word(struct glint_text *text,
                                   struct glint_word word,
                                   struct glint_coating *coating)
{
    struct word_source word_source = {text, true, word};
    char quote[GLINT_QUOTE_BYTES];

    if (!read_coating_words(&word_source, coating))
        return false;
    if (word_source.rest.length < 0)
        return glint_text_set_error(text, word_source.rest.place,
                                    "a value is missing after the slash");
    return !word_source.rest.length ||
           glint_text_set_error(text, word_source.rest.place,
                                "'%s' is one value too many for the coating",
                                glint_word_quote(&word_source.rest, quote));
}

bool glint_coatings_read(struct glint_text *text,
                         struct glint_coating coatings[GLINT_MAX_COATINGS],
                         int *n)
{
    struct glint_word word = glint_text_next_word(text);

    *n = 0;
    do {
        if (*n == GLINT_MAX_COATINGS)
            return glint_text_set_error(
                text, word.place, "more than %d coatings", GLINT_MAX_COATINGS);
        if (!read_coating_from_word(text, word, &coatings[*n]))
            return false;
        ++*n;
        word = glint_text_next_word(text);
    } while (word.length);
    return true;
}

enum glint_status
glint_coatings_parse(struct glint_coating coatings[GLINT_MAX_COATINGS], int *n,
                     const char *text, struct glint_error *error)
{
    struct glint_coating read[GLINT_MAX_COATINGS];
    struct glint_error found = {""};
    struct glint_text line;
    char words[GLINT_LINE_BYTES + 1];
    const int length = snprintf(words, sizeof words, "%s", text);
    int n_read;

    if (length >= (int)sizeof words) {
        snprintf(error->text, sizeof error->text,
                 "the text of a coating has at most %d characters",
                 GLINT_LINE_BYTES);
        return GLINT_E_ARGUMENT;
    }
    for (char *c = words; *c; c++)
        *c = (char)(*c == ',' ? ' ' : *c == ' ' ? ',' : *c);
    if (!glint_text_open(&line, words, (size_t)length, "", &found) ||
        !glint_text_next_line(&line) ||
        !glint_coatings_read(&line, read, &n_read)) {
        const char *cause = strstr(found.text, ": ");

        snprintf(error->text, sizeof error->text, "%.150s",
                 cause ? cause + 2 : "the text of the coating is empty");
        return GLINT_E_ARGUMENT;
    }
    memcpy(coatings, read, (size_t)n_read * sizeof *coatings);
    *n = n_read;
    return GLINT_OK;
}

/* ----------------------------------------------------------------- dealing */

int glint_coatings_mixed(struct glint_coating coatings[GLINT_MAX_COATINGS])
{
    /* A quarter wave at 1080 nm is a half wave at 540 nm, in the middle of the
     * visible band, so that it reflects green. */
    static const double nm[] = {450, 620, 1080, 520, 680, 490, 560};
    enum { N = sizeof nm / sizeof *nm };

    for (int i = 0; i < N; i++)
        glint_coating_set_single_layer(&coatings[i], nm[i]);
    return N;
}

void glint_prescription_coat(struct glint_prescription *lens,
                             const struct glint_coating *coatings, int n)
{
    int dealt = 0;

    for (int k = 0; k < lens->n_surfaces; k++) {
        struct glint_surface *s = &lens->surface[k];
        const bool cemented = k > 0 && s[-1].vd > 0.0 && s->vd > 0.0;

        if (cemented)
            memset(&s->coating, 0, sizeof s->coating);
        else
            s->coating = coatings[dealt++ % n];
    }
}
