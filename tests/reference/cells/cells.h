/* SPDX-License-Identifier: MIT
 *
 * Draws bundles of rays as [Bodonyi23] does: a primitive is a cell of the grid
 * of rays, whose irradiance is interpolated at the centres of pixels. */
#ifndef REFERENCE_CELLS_CELLS_H
#define REFERENCE_CELLS_CELLS_H

#include "glint/flare.h"
#include "reference/cells/raster.h"

struct cells_options {
    enum cells_weights weights;
    int merge_steps; /* log2 of the largest side, in cells, of a block of cells
                        that may become one primitive, 0 .. 4 */
    /* largest difference between two edges that merge, as a fraction of the
     * longer one, 0 .. 1 */
    int32_t merge_gamma_q16;
    int centres; /* 1: a pixel is lit or not by its centre, as published; 0:
                    outlines are smooth */
};

/* Draws the bundles that FLARE has taken in or planned to PIXELS_Q20
 * [height][width][3], linear light. Returns how many cells became part of a
 * larger primitive. */
int cells_draw(const struct glint_flare *flare,
               const struct cells_options *options, int32_t *pixels_q20);

#endif
