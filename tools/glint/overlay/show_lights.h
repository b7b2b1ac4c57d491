/* SPDX-License-Identifier: MIT
 *
 * Marks lights on pictures: a cross, a box whose half-width is twice the RMS
 * radius plus four line widths, and the light's number. */
#ifndef GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H
#define GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H

#include <stdbool.h>

#include "glint/image.h"
#include "glint/lamp_tracker.h"

/* Draws the mark of TRACK on IMAGE, of any 8-bit format. Colours: green steady,
 * yellow rising, red fading, blue after the lamp left the picture. */
void show_lamp_mark(const struct glint_image *image,
                    const struct glint_lamp_track *track);

/* Draws the mark of TRACK like show_lamp_mark(), with POWER below its number,
 * in stops above a white pixel. */
void show_lamp_mark_with_power(const struct glint_image *image,
                               const struct glint_lamp_track *track,
                               double power);

/* Draws a legend in the lower left corner: the meaning of numbers and, if
 * FOLLOWED (lamps are tracked), of colours. Draws nothing if the picture is too
 * small. */
void show_mark_legend(const struct glint_image *image, bool followed);

#endif
