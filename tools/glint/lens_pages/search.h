/* SPDX-License-Identifier: MIT
 *
 * search.h - finds lenses by words of their name, source and character. */
#ifndef GLINT_TOOLS_LENS_FIGURES_SEARCH_H
#define GLINT_TOOLS_LENS_FIGURES_SEARCH_H

#include "options/tool.h"

/* Returns whether name, source and character of the lens NAME contain all N
 * WORDS, ignoring case. */
bool lens_has_words(const char *name, const struct glint_prescription *lens,
                    char **words, int n);

/* Rejects the first of N NAMES that is not a lens of the library, and prints a
 * similar name. Returns an exit code. */
int lens_check_requested_names(const char *const *names, int n);

#endif
