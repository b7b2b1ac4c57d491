/* SPDX-License-Identifier: MIT
 *
 * Validates the values of options of type TEXT.
 */
#ifndef GLINT_ENGINE_OPTIONS_TEXTS_H
#define GLINT_ENGINE_OPTIONS_TEXTS_H

#include "glint/options.h"

/* Returns whether option ID accepts TEXT, which is not empty. Does not look
 * up names of files and lenses, and does not parse coatings, as that needs
 * the offline half. */
bool glint_option_text_is_valid(enum glint_option_id id, const char *text);

/* Returns OPTIONS, perhaps the smaller struct of an older program, with the
 * defaults of the rows that it does not have. */
struct glint_options
glint_options_complete(const struct glint_options *options);

#endif
