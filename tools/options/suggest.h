/* SPDX-License-Identifier: MIT
 *
 * suggest.h - what somebody may have meant.
 *
 *     struct suggest s;
 *     suggest_begin(&s, "ovrelay");
 *     suggest_try(&s, "overlay", 7);                    each that there is
 *     if (suggest_best(&s))
 *         printf("did you mean %s?", suggest_best(&s));
 */
#ifndef GLINT_TOOLS_OPTIONS_SUGGEST_H
#define GLINT_TOOLS_OPTIONS_SUGGEST_H

#include <stddef.h>

enum { SUGGEST_CHARS = 48 };

struct suggest {
    const char *word; /* kept */
    char best[SUGGEST_CHARS];
    int distance; /* distance of the best word */
};

/* Letters to insert, leave out, change or swap with the next to come from A to
 * B, each of less than SUGGEST_CHARS characters, else SUGGEST_CHARS. */
int suggest_distance(const char *a, const char *b);

void suggest_begin(struct suggest *suggest, const char *word);

/* Offers the N characters at CANDIDATE. One that contains the word is as near
 * as one with a letter wrong. */
void suggest_try(struct suggest *suggest, const char *candidate, size_t n);

/* The nearest, if no more than a third of its letters are wrong; or NULL. */
const char *suggest_best(const struct suggest *suggest);

#endif
