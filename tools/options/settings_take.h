/* SPDX-License-Identifier: MIT
 *
 * Values of the options of settings.h.
 */
#ifndef GLINT_TOOLS_OPTIONS_SETTINGS_TAKE_H
#define GLINT_TOOLS_OPTIONS_SETTINGS_TAKE_H

#include "options/settings.h"

/* Takes VALUE of OPTION, one of enum settings_option but OPT_COATING. Returns
 * false if the option does not take that value. */
bool settings_take(struct settings *settings, int option, const char *value);

#endif
