/* SPDX-License-Identifier: MIT
 *
 * Marks lamps on pictures by a cross, a box and a number, and candidates by a
 * box. Half the width of the box is twice the RMS radius of the lamp plus four
 * line widths.
 */
#ifndef GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H
#define GLINT_TOOLS_OVERLAY_SHOW_LIGHTS_H

#include <stdbool.h>

#include "glint/image.h"
#include "glint/lamps.h"
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

/* Draws the mark of SPOT, which may be a lamp, in white: a box, and the
 * position for --light-at beside it. */
void show_candidate_mark(const struct glint_image *image,
                         const struct glint_spot *spot);

/* Draws a legend in the lower left corner: the meaning of the numbers and, if
 * FOLLOWED (lamps are tracked), of the colours, and, if HAS_CANDIDATES, of
 * boxes without a cross. Draws nothing if the picture is too small. */
void show_mark_legend(const struct glint_image *image, bool followed,
                      bool has_candidates);

#endif
