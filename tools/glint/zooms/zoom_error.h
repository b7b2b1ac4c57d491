/* SPDX-License-Identifier: MIT
 *
 * Measures the error of a zoom lens's model between positions, per ghost, in
 * pictures.
 *
 *   in   a zoom that is set somewhere, the table zoomed to the same place
 *   out  of each ghost and of lights at several angles, the mean squared error
 *        of the whole picture, as fractions of white in sRGB, if all but that
 *        ghost was exact
 *
 * Pictures are exposed as glint compare exposes them. */
#ifndef GLINT_TOOLS_ZOOMS_ZOOM_ERROR_H
#define GLINT_TOOLS_ZOOMS_ZOOM_ERROR_H

#include "glint/model.h"
#include "options/tool.h"
#include "glint/bake.h"

enum { ZOOM_ANGLES = 96 };

/* Errors of one ghost, per angle. */
struct zoom_error {
    double of[ZOOM_ANGLES];
};

/* Measures the ghosts whose first error is below 0 among the N entries of
 * ERROR, one per ghost. Lights are at angles up to 1.5 times the half diagonal
 * of the field of LENS, at most MAX_DEG. SHIFT, 0 to 1, is the position of each
 * light within its interval of angle. Every fourth angle is measured, others
 * only near angles where a ghost appears or vanishes; the rest are
 * interpolated. */
enum glint_status zoom_error_measure(const struct tool *tool,
                                     const struct glint_prescription *lens,
                                     const struct glint_zoom_lens *zoom,
                                     double max_deg, double shift, int n,
                                     struct zoom_error *error,
                                     struct glint_error *message);

#endif
