/* SPDX-License-Identifier: MIT
 *
 * Adds primitives to one tile's accumulators.
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
#ifndef GLINT_PUBLISHED_RASTER_H
#define GLINT_PUBLISHED_RASTER_H

#include <stdint.h>

#include "glint/flare.h"
#include "published/clip.h"
#include "flare/edges/primitive.h"

struct glint_cell_raster {
    const struct glint_vertex *vertex;
    const struct glint_primitive *primitive;
    const struct glint_bundle *bundle;
    const struct glint_stop *stop;
    enum glint_weights weights;
    int antialias;
    int tile_log2;
};

/* Adds primitive PRIMITIVE to ACC_Q20, the [3][side * side] sums of the tile
 * whose pixels are TILE. CLIP is scratch. */
void glint_cell_raster_primitive(const struct glint_cell_raster *raster,
                                 int primitive, struct glint_box tile,
                                 struct glint_clip *clip, int64_t *acc_q20);

#endif
