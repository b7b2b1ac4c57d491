/* SPDX-License-Identifier: MIT
 *
 * How far a zoom is off between positions, ghost by ghost, in pictures.
 *
 *   in   a zoom that is set somewhere, the table zoomed to the same place
 *   out  of each ghost and of lights at several angles, the mean squared error
 *        of the whole picture, as fractions of white in sRGB, if all but that
 *        ghost was exact
 *
 * Pictures are exposed as glint compare does. */
#ifndef GLINT_TOOLS_ZOOMS_ZOOM_ERROR_H
#define GLINT_TOOLS_ZOOMS_ZOOM_ERROR_H

#include "glint/model.h"
#include "options/tool.h"
#include "glint/bake.h"

enum { ZOOM_ANGLES = 96 };

/* Errors of one ghost, by angle. */
struct zoom_error {
    double of[ZOOM_ANGLES];
};

/* Sets those of the N entries of ERROR, one for each ghost, whose first error
 * is below 0. Lights go up to one and a half times the half diagonal of what
 * LENS sees, at most MAX_DEG; SHIFT, 0 to 1, is where each lies in its fraction
 * of that. Each fourth angle is measured, others only where a ghost begins or
 * ends near them, and else are in proportion. */
enum glint_status zoom_error_measure(const struct tool *tool,
                                     const struct glint_prescription *lens,
                                     const struct glint_zoom_lens *zoom,
                                     double max_deg, double shift, int n,
                                     struct zoom_error *error,
                                     struct glint_error *message);

#endif
