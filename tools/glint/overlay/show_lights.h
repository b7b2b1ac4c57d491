/* SPDX-License-Identifier: MIT
 *
 * Shows where lights are: a cross, a box that reaches twice their RMS radius
 * and four lines' thickness from the middle, and their number.
 */
#ifndef GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H
#define GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H

#include <stdbool.h>

#include "glint/image.h"
#include "glint/lamp_tracker.h"

/* Draws the mark of TRACK on IMAGE, of 8 bits and any format: green when
 * steady, yellow rising, red fading, blue after it left the picture. */
void show_light(const struct glint_image *image,
                const struct glint_lamp_track *track);

/* Draws the mark of TRACK as show_light() does, and POWER under its number, in
 * stops over that of a white pixel. */
void show_light_of(const struct glint_image *image,
                   const struct glint_lamp_track *track, double power);

/* Writes a legend into the lower left corner: the meaning of numbers and, if
 * lamps are FOLLOWED, of colours. Leaves it out where the picture has no
 * room. */
void show_legend(const struct glint_image *image, bool followed);

#endif
