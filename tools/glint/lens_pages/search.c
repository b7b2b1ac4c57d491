/* SPDX-License-Identifier: MIT */
#include "lens_pages/search.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "model/lens_files.h"
#include "options/suggest.h"

static bool contains_search_word(const char *text, const char *word)
{
    const size_t n = strlen(word);

    for (; *text; text++)
        if (strncasecmp(text, word, n) == 0)
            return true;
    return false;
}

bool lens_has_words(const char *name, const struct glint_prescription *lens,
                    char **words, int n)
{
    for (int i = 0; i < n; i++)
        if (!contains_search_word(name, words[i]) &&
            !contains_search_word(lens->source, words[i]) &&
            !contains_search_word(lens->character, words[i]))
            return false;
    return true;
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
