/* SPDX-License-Identifier: MIT
 *
 * Measures, for each ghost, the error of a zoom lens's model at a position
 * between the baked ones.
 *
 * Input: a zoom model set to some position, and the table zoomed to the same
 * position. Output: for each ghost and for lights at several angles, the mean
 * squared error of the whole image (sRGB codes, 1 = white) that the ghost alone
 * causes. Images are exposed as in glint compare.
 */
#ifndef GLINT_TOOLS_ZOOMS_ZOOM_ERROR_H
#define GLINT_TOOLS_ZOOMS_ZOOM_ERROR_H

#include "glint/model.h"
#include "options/tool.h"
#include "glint/bake.h"

enum { ZOOM_ANGLES = 96 };

/* errors of one ghost, per angle */
struct zoom_error {
    double of[ZOOM_ANGLES];
};

/* Measures the ghosts whose first error in ERROR[N], an entry for each ghost,
 * is below 0. Lights are at angles up to 1.5 times that of a corner of the film
 * of LENS, at most MAX_DEG. SHIFT, 0 .. 1, is the position of each
 * light within its interval of angles. Every fourth angle is measured. Other
 * angles are measured only near those where a ghost appears or vanishes, and
 * are otherwise interpolated. */
enum glint_status zoom_error_measure_ghosts(
    const struct tool *tool, const struct glint_prescription *lens,
    const struct glint_zoom_lens *zoom, double max_deg, double shift, int n,
    struct zoom_error *error, struct glint_error *message);

#endif
