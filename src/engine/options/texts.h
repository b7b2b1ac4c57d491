/* SPDX-License-Identifier: MIT
 *
 * Validates the values of options that are texts, and completes options of
 * older programs. */
#ifndef GLINT_ENGINE_OPTIONS_TEXTS_H
#define GLINT_ENGINE_OPTIONS_TEXTS_H

#include "glint/options.h"

/* Returns whether option ID accepts TEXT, which must not be empty. Does not
 * check that files and lenses exist. Does not parse coatings, as that requires
 * the part of the library that bakes lenses. */
bool glint_option_text_is_valid(enum glint_option_id id, const char *text);

/* Returns a copy of OPTIONS. Options that the caller's struct does not contain,
 * as the program was compiled for an older version of the library, get their
 * defaults. */
struct glint_options
glint_options_complete_with_defaults(const struct glint_options *options);

#endif
