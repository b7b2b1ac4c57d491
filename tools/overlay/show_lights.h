/* SPDX-License-Identifier: MIT
 *
 * Shows where lights are: a cross, a box of twice their size and their number.
 */
#ifndef GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H
#define GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H

#include <stdbool.h>

#include "glint/image.h"
#include "glint/lamp_tracker.h"

/* Draws over IMAGE, of 8 bits and any format, what of TRACK lies in it: green
 * when steady, yellow rising, red fading, blue where it left. */
void show_light(const struct glint_image *image,
                const struct glint_lamp_track *track);

/* The same, and its POWER under the number, in stops over that of a white
 * pixel. */
void show_light_of(const struct glint_image *image,
                   const struct glint_lamp_track *track, double power);

/* Says in the lower left corner what numbers and, of lamps that are FOLLOWED,
 * colours are; not in pictures with no room for it. */
void show_legend(const struct glint_image *image, bool followed);

#endif
