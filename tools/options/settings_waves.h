/* SPDX-License-Identifier: MIT
 *
 * --wavelengths: which wavelengths are drawn.
 */
#ifndef GLINT_TOOLS_OPTIONS_SETTINGS_WAVES_H
#define GLINT_TOOLS_OPTIONS_SETTINGS_WAVES_H

#include "options/settings.h"

/* Chooses the wavelengths that a setup is made for, before the lens of SETTINGS
 * is opened. */
void settings_choose_waves(struct settings *settings);

/* Sets the colours of the setup, once it is made: weighs the wavelengths if
 * only their number was given; for "auto" with a model, makes the sets of
 * wavelengths that ghosts choose from. A list stays as it is. */
void settings_weigh(struct settings *settings);

#endif
