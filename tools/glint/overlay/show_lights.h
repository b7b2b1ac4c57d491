/* SPDX-License-Identifier: MIT
 *
 * Marks lamps on pictures by a cross, a box and a number. Half the width of the
 * box is twice the RMS radius of the lamp plus four line widths.
 */
#ifndef GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H
#define GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H

#include <stdbool.h>

#include "glint/image.h"
#include "glint/lamp_tracker.h"

/* Draws the mark of TRACK on IMAGE, of any 8-bit format. It is green if the
 * lamp is steady, yellow if it fades in, red if it fades out, blue if it has
 * left the picture. */
void show_lamp_mark(const struct glint_image *image,
                    const struct glint_lamp_track *track);

/* Draws the mark of TRACK like show_lamp_mark(), with POWER below its number,
 * in stops above a white pixel. */
void show_lamp_mark_with_power(const struct glint_image *image,
                               const struct glint_lamp_track *track,
                               double power);

/* Draws a legend in the lower left corner: the meaning of the numbers and, if
 * FOLLOWED (lamps are tracked), of the colours. Draws nothing if the picture is
 * too small. */
void show_mark_legend(const struct glint_image *image, bool followed);

#endif
