/* SPDX-License-Identifier: MIT
 *
 * suggest.h - finds the word that a mistyped one may have meant.
 *
 *     struct suggest s;
 *     suggest_begin(&s, "ovrelay");
 *     suggest_try(&s, "overlay", 7);                    each known word
 *     if (suggest_best(&s))
 *         printf("did you mean %s?", suggest_best(&s));
 */
#ifndef GLINT_TOOLS_OPTIONS_SUGGEST_H
#define GLINT_TOOLS_OPTIONS_SUGGEST_H

#include <stddef.h>

enum { SUGGEST_CHARS = 48 };

struct suggest {
    const char *word; /* not owned */
    char best[SUGGEST_CHARS];
    int distance; /* distance of the best word */
    char words[SUGGEST_CHARS + 20];
};

void suggest_begin(struct suggest *suggest, const char *word);

/* Offers CANDIDATE[N]. If it contains the word, of 3 letters or more, it counts
 * as at most one letter off. */
void suggest_try(struct suggest *suggest, const char *candidate, size_t n);

/* Returns the nearest candidate if no more of its letters are wrong than a
 * third of them, or than one if that is more; else NULL. */
const char *suggest_best(const struct suggest *suggest);

/* Returns "; did you mean 'BEST'?", or "" if there is none. */
const char *suggest_words(struct suggest *suggest);

#endif
