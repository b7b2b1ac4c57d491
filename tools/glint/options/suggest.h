/* SPDX-License-Identifier: MIT
 *
 * suggest.h - finds the known word that is most similar to a mistyped word.
 *
 *     struct suggest s;
 *     suggest_begin(&s, "ovrelay");
 *     suggest_add_candidate(&s, "overlay", 7);     each known word
 *     if (suggest_find_best(&s))
 *         printf("did you mean %s?", suggest_find_best(&s));
 */
#ifndef GLINT_TOOLS_OPTIONS_SUGGEST_H
#define GLINT_TOOLS_OPTIONS_SUGGEST_H

#include <stddef.h>

enum { SUGGEST_CHARS = 48 };

struct suggest {
    const char *word; /* the mistyped word, not owned */
    char best[SUGGEST_CHARS];
    int distance; /* edit distance of the best candidate */
    char words[SUGGEST_CHARS + 20];
};

void suggest_begin(struct suggest *suggest, const char *word);

/* Compares CANDIDATE[N] with the mistyped word. If the word has 3 letters or
 * more and CANDIDATE contains it, the distance counts as at most 1. */
void suggest_add_candidate(struct suggest *suggest, const char *candidate,
                           size_t n);

/* Returns the candidate with the smallest distance, or NULL if that distance
 * exceeds the larger of 1 and a third of the candidate's letters. */
const char *suggest_find_best(const struct suggest *suggest);

/* Returns "; did you mean 'BEST'?", or "" if no candidate is similar enough. */
const char *suggest_from_words(struct suggest *suggest);

#endif
