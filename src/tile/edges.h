/* SPDX-License-Identifier: MIT
 *
 * Adds primitives to one tile by their edges alone.
 *
 *   in   the visible polygon of each primitive (outline.h), one irradiance each
 *   out  sums of linear light per pixel, by the exact area that polygons cover
 *
 * Method: what an edge adds to a pixel is the area of the pixel to the right of
 * it, times the irradiance; up edges count plus, down edges minus, so that a
 * polygon is the sum of its edges. Along a row that area changes only where the
 * edge runs, so only changes are noted, and one running sum at the end makes
 * light of them. The inside of a ghost costs nothing.
 *
 * The area of an edge in a pixel depends on the edge and the pixel alone, and
 * the areas of a polygon's edges cancel exactly to its right: tiles, their
 * size and the order of primitives change no bit. What lies to the left of a
 * tile goes with its whole height into the first column.
 *
 * Formats: pixels, heights and areas _q16, light _q22, sums _q38 modulo 2^64.
 * The caller's LIMIT keeps the final sums below 2^63: see glint_flare_bin.
 * What comes in between may wrap, and wraps back.
 */
#ifndef GLINT_TILE_EDGES_H
#define GLINT_TILE_EDGES_H

#include <stdint.h>

#include "tile/outline.h"
#include "tile/primitive.h"

struct glint_edges {
    const struct glint_vertex *vertex;
    const struct glint_primitive *primitive;
    const struct glint_bundle *bundle;
    const struct glint_stop *stop;
    int32_t
        limit_q8; /* of a primitive's light in a pixel, energy 1, colour 1 */
    int tile_log2;
};

/* Adds PRIMITIVE to SUM_Q38, [3][side * side], as changes from pixel to pixel
 * of the tile whose pixels are TILE. OUTLINE is scratch. */
void glint_edges_primitive(const struct glint_edges *edges, int primitive,
                           struct glint_box tile, struct glint_outline *outline,
                           uint64_t *sum_q38);

/* Turns changes into light, in place, for the pixels of TILE. */
void glint_edges_finish(const struct glint_edges *edges, struct glint_box tile,
                        int64_t *sum);

#endif
