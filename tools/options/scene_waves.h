/* SPDX-License-Identifier: MIT
 *
 * --wavelengths: which a scene is drawn with.
 */
#ifndef GLINT_TOOLS_OPTIONS_SCENE_WAVES_H
#define GLINT_TOOLS_OPTIONS_SCENE_WAVES_H

#include "options/scene.h"

/* "auto", a number of wavelengths, or a list of them. False: neither. */
bool scene_take_waves(struct scene *scene, const char *text);

/* Before SCENE's lens is opened: which wavelengths a setup is made for. */
void scene_choose_waves(struct scene *scene);

/* Once the setup is made: its colours, and sets for ghosts to choose from. */
void scene_weigh(struct scene *scene);

#endif
