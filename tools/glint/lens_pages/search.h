/* SPDX-License-Identifier: MIT
 *
 * search.h - lenses by words of their name, source and character.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_SEARCH_H
#define GLINT_TOOLS_LENS_FIGURES_SEARCH_H

#include "options/tool.h"

/* Returns whether the lens NAME has all N WORDS, in any case of letters. */
bool lens_has_words(const char *name, const struct glint_prescription *lens,
                    char **words, int n);

/* States which of N WORDS, 1 or more, no lens of the library has, and which it
 * may have meant, or that lenses have them, but none has all. Returns an exit
 * code. */
int lens_words_missed(const struct tool *tool, char **words, int n);

/* Refuses the first of N NAMES that no lens of the library has, with the one
 * that it may have meant. Returns an exit code. */
int lens_names_check(const char *const *names, int n);

#endif
