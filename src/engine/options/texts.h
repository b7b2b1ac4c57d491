/* SPDX-License-Identifier: MIT
 *
 * Validates the values of options of type TEXT.
 */
#ifndef GLINT_ENGINE_OPTIONS_TEXTS_H
#define GLINT_ENGINE_OPTIONS_TEXTS_H

#include "glint/options.h"

/* Returns whether option ID accepts TEXT, which must not be empty. Does not
 * check that files and lenses exist, and does not parse coatings, which
 * requires the offline half. */
bool glint_option_text_is_valid(enum glint_option_id id, const char *text);

/* Returns a copy of OPTIONS in which options that the caller's struct does not
 * contain, as the program was compiled for an older library, have their
 * defaults. */
struct glint_options
glint_options_complete_with_defaults(const struct glint_options *options);

#endif
