/* SPDX-License-Identifier: MIT */
#include "lens_pages/search.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "model/lens_files.h"
#include "model/table_file.h"
#include "options/suggest.h"

static bool contains_search_word(const char *text, const char *word)
{
    const size_t n = strlen(word);

    for (; *text; text++)
        if (strncasecmp(text, word, n) == 0)
            return true;
    return false;
}

static bool lens_has_word(const char *name,
                          const struct glint_prescription *lens,
                          const char *word)
{
    return contains_search_word(name, word) ||
           contains_search_word(lens->source, word) ||
           contains_search_word(lens->character, word);
}

bool lens_has_words(const char *name, const struct glint_prescription *lens,
                    char **words, int n)
{
    for (int i = 0; i < n; i++)
        if (!lens_has_word(name, lens, words[i]))
            return false;
    return true;
}

/* Fields to search, by priority. Of two words that are equally similar to the
 * mistyped one, a word of a name is suggested rather than one of a sentence. */
enum { OF_NAME, OF_SOURCE, OF_CHARACTER, N_PLACES };

struct search {
    const struct tool *tool;
    struct glint_prescription *lens; /* scratch memory for a lens table */
    const char *word;
    char small[SUGGEST_CHARS]; /* the word in lower case */
    struct suggest near[N_PLACES];
    bool found; /* whether any lens contains the word */
};

/* Adds each word of TEXT with at least four letters or digits, and TEXT itself,
 * as candidates for suggestions. */
static void suggest_words_of_text(struct suggest *suggest, const char *text)
{
    char small[SUGGEST_CHARS];
    size_t n = 0;

    suggest_add_candidate(suggest, text, strlen(text));
    for (;; text++) {
        const int c = tolower((unsigned char)*text);

        if (isalnum(c) && n < sizeof small)
            small[n++] = (char)c;
        else if (!isalnum(c)) {
            if (n > 3)
                suggest_add_candidate(suggest, small, n);
            n = 0;
        }
        if (!c)
            return;
    }
}

static bool search_words_in_lens(void *ctx, const char *name)
{
    struct search *s = ctx;

    if (tool_read_lens(s->tool, name, s->lens) != EXIT_OK)
        return true;
    s->found = lens_has_word(name, s->lens, s->word);
    suggest_words_of_text(&s->near[OF_NAME], name);
    suggest_words_of_text(&s->near[OF_SOURCE], s->lens->source);
    suggest_words_of_text(&s->near[OF_CHARACTER], s->lens->character);
    return !s->found;
}

/* Returns the most similar known word, or NULL if none is similar enough. */
static const char *find_similar_word(const struct search *s)
{
    const struct suggest *best = &s->near[0];

    for (int i = 1; i < N_PLACES; i++)
        if (s->near[i].distance < best->distance)
            best = &s->near[i];
    return suggest_find_best(best);
}

int lens_report_unknown_words(const struct tool *tool, char **words, int n)
{
    struct search s = {
        .tool = tool, .lens = malloc(sizeof *s.lens), .found = true};
    const char *best;

    if (!s.lens)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    for (int i = 0; i < n && s.found; i++) {
        s.word = words[i];
        s.found = false;
        snprintf(s.small, sizeof s.small, "%s", s.word);
        for (char *c = s.small; *c; c++)
            *c = (char)tolower((unsigned char)*c);
        for (int k = 0; k < N_PLACES; k++)
            suggest_begin(&s.near[k], s.small);
        lens_files_visit_all(search_words_in_lens, &s);
    }
    free(s.lens);
    best = find_similar_word(&s);
    if (s.found)
        fprintf(stderr, "glint lenses: no lens has all of these words in its "
                        "name, source or character\n");
    else
        fprintf(stderr,
                "glint lenses: no lens has '%s' in its name, source or "
                "character%s%s\n",
                s.word, best ? "; did you mean " : "", best ? best : "");
    return EXIT_LENS;
}

struct wanted {
    const char *name;
    struct suggest near;
    bool found;
};

static bool compare_lens_name(void *ctx, const char *name)
{
    struct wanted *w = ctx;

    w->found = strcmp(name, w->name) == 0;
    suggest_add_candidate(&w->near, name, strlen(name));
    return !w->found;
}

int lens_check_requested_names(const char *const *names, int n)
{
    for (int i = 0; i < n; i++) {
        struct wanted w = {.name = names[i]};
        const char *best;

        suggest_begin(&w.near, w.name);
        lens_files_visit_all(compare_lens_name, &w);
        if (w.found)
            continue;
        best = suggest_find_best(&w.near);
        fprintf(stderr,
                "glint lenses: -o, --only: no lens has the name '%s'; %s%s\n",
                w.name,
                best ? "did you mean " : "glint lenses --names lists them",
                best ? best : "");
        return EXIT_LENS;
    }
    return EXIT_OK;
}
