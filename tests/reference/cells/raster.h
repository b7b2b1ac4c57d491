/* SPDX-License-Identifier: MIT
 *
 * Adds primitives to the sums of a picture.
 *
 * A pixel belongs to the primitive that its centre lies in; on a shared edge,
 * to the primitive below or to the right, so that two neighbours never both
 * claim it. Energy and clips are interpolated with barycentric weights of the
 * corners: the plain ones for a triangle, Loop-DeRose's or Wachspress' for a
 * quad. [Bodonyi23]
 *
 * Formats: corners q8, edge functions q16 in 64 bits, weights q16, sums q20 in
 * 64 bits. A contribution is below 2^33, so 2^30 primitives may share a pixel.
 */
#ifndef REFERENCE_CELLS_RASTER_H
#define REFERENCE_CELLS_RASTER_H

#include <stdint.h>

#include "glint/bundle.h"
#include "reference/cells/clip.h"
#include "reference/cells/cell.h"

enum cells_weights { CELLS_WACHSPRESS, CELLS_LOOP_DEROSE };

struct glint_cell_raster {
    const struct glint_vertex *vertex;
    const struct glint_bundle *bundle;
    const struct glint_stop *stop;
    enum cells_weights weights;
    int antialias;
    int width, height; /* pixels */
    int64_t *acc_q20;  /* [height][width][3] */
};

/* Adds P to the sums. */
void glint_cell_raster_primitive(const struct glint_cell_raster *raster,
                                 const struct glint_primitive *p);

#endif
