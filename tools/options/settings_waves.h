/* SPDX-License-Identifier: MIT
 *
 * --wavelengths: which ones are drawn.
 */
#ifndef GLINT_TOOLS_OPTIONS_SETTINGS_WAVES_H
#define GLINT_TOOLS_OPTIONS_SETTINGS_WAVES_H

#include "options/settings.h"

/* "auto", a number of wavelengths, or a list of them. False: neither. */
bool settings_take_waves(struct settings *settings, const char *text);

/* Before SETTINGS's lens is opened: which wavelengths a setup is made for. */
void settings_choose_waves(struct settings *settings);

/* Once the setup is made: its colours, and sets for ghosts to choose from. */
void settings_weigh(struct settings *settings);

#endif
