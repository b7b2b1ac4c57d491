/* SPDX-License-Identifier: MIT
 *
 * Shows where lights are: a cross, a box of twice their size and their number.
 */
#ifndef GLINT_TOOLS_SHOW_LIGHTS_H
#define GLINT_TOOLS_SHOW_LIGHTS_H

#include "glint/image.h"
#include "glint/tracks.h"

/* Draws over IMAGE, of 8 bits and any format, what of TRACK lies in it: green
 * when steady, yellow rising, red fading, blue where it left. */
void show_light(const struct glint_image *image,
                const struct glint_track *track);

#endif
