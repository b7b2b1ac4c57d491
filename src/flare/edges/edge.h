/* SPDX-License-Identifier: MIT
 *
 * Accumulates light in one tile from edges: lines across which the light
 * changes.
 *
 * An edge adds its light to all pixels on its right, in proportion to the area
 * of each pixel that lies on its right. What is stored are differences between
 * neighbouring pixels, and these are nonzero only at the pixels that the edge
 * crosses. One running sum along each row converts differences to light. So the
 * interior of a ghost costs nothing.
 *
 * To the right of a closed outline its edges cancel exactly: their signed
 * heights in a row cancel, and light times height is never rounded. The light
 * that an edge adds to a pixel depends only on the edge, so that the picture
 * depends neither on tiles nor on the order of edges. Each row of a tile begins
 * with the light that is carried in from the tile on its left, and ends with
 * the light that is carried out to the right.
 *
 * Formats: corners _q8, slopes _q40, light _q20 below 2^40. Sums for pictures
 * of linear light: light _q20 times areas _q16, modulo 2^64. For all others
 * light _q16 (_q20 if fine) times areas _q8, modulo 2^64, or modulo 2^32 if the
 * edges of a tile together cannot exceed that, at 128 (if fine, 8) times white:
 * the same results, faster. The caller's limit on light keeps final sums below
 * 2^63 (by_edges.c); intermediate sums may wrap, and wrap back. */
#ifndef GLINT_FLARE_EDGE_H
#define GLINT_FLARE_EDGE_H

#include <stdint.h>

#include "base/compiler.h"
#include "base/q.h"
#include "glint/light.h"
#include "kernels/kernels.h"
#include "tile/bins.h"
#include "flare/edges/primitive.h"

struct glint_edge {     /* 32 bytes */
    int64_t slope_q40;  /* pixels of x per 1/256 pixel of y */
    int32_t x_q8, y_q8; /* upper end, pixels */
    int32_t end_y_q8;   /* y of the lower end, > y_q8, pixels */
    /* light on the left and on the right side, packed by glint_light_pack();
     * negative for a mirrored ghost */
    int32_t left, right;
    /* patch: 1 if this struct is not an edge but one of those that store a
     * patch (patch.h). whole: for edges, 1 if pixel-snapped; for patches, 1 in
     * all structs but the first. */
    unsigned bundle : 30, patch : 1, whole : 1;
};

/* Packs light, 1 = display white, into a 32-bit floating-point number with a
 * mantissa of 25 bits above an exponent of 5 bits. Every packed value is a
 * multiple of 2^-20, so that sums of light and the same light negated are
 * exactly 0. */
static inline int32_t glint_light_pack(int64_t light_q20)
{
    const int wide =
        bit_length((uint64_t)(light_q20 < 0 ? -light_q20 : light_q20));
    const int exponent = wide > 25 ? wide - 25 : 0;

    return q_narrow(q_shift(light_q20, exponent) * 32 + exponent);
}

static inline int64_t glint_light_unpack_q20(int32_t packed)
{
    return (packed >> 5) * (INT64_C(1) << (packed & 31));
}

/* size of the scratch memory of a patch function, bytes */
enum { GLINT_PATCH_SCRATCH = 8192 };

/* Adds the pixels of patch E in the tile of SUMS to the narrow (32-bit) or wide
 * sums. LIGHT is the patch's light through a clear stop, per channel, in the
 * units of the sums. */
struct glint_edge_sums;
typedef void glint_patch_fn(const struct glint_edge_sums *sums, int narrow,
                            const struct glint_edge *e, const int64_t light[3]);

/* Light of one tile, stored as differences between neighbouring pixels of a
 * row, in 64 bits (wide) or 32 bits (narrow): [3][rows][stride], R, G, B. The
 * entry after the tile's last column is carried into the tile on the right. All
 * entries are 0 before a tile is begun. */
struct glint_edge_sums {
    struct glint_box tile;
    int tile_log2, stride;
    int linear; /* nonzero: the picture is in linear light */
    int fine;   /* 1: light is _q20 even if the picture has 8-bit codes */
    int lit;    /* nonzero: light may be carried in from the tile on the left;
                   set by the pass (edges_pass.c) */
    /* For patches (patch.h): the function that draws a patch, the shade of the
     * stop (its soft edge, dust and masks), and scratch memory of
     * GLINT_PATCH_SCRATCH bytes. */
    glint_patch_fn *patch;
    const struct glint_shade *shade;
    void *scratch;
    int in_narrow; /* 1: glint_edges_add_to_sums() put the light into the narrow
                      sums, as 32 bits suffice */
    uint64_t *wide;
    uint32_t *narrow;
    int64_t *carry;    /* [3][side rows]: light that is carried into each row
                          from the left; after the row is read, the light that
                          it carries out to the right */
    uint64_t *touched; /* [3]: per channel, bit n is set if row n has nonzero
                          differences */
};

/* Number of array elements per row of a tile of 2^LOG2 pixels. */
#define GLINT_EDGE_STRIDE(log2) ((1 << (log2)) + 16)

/* Sets EDGE to the line from A to B, (x, y) in pixels. If y falls from A to B,
 * LIGHT is on the line's right side and OTHER on its left side. If y rises, the
 * sides are swapped. Returns 0 if the line is horizontal, as such a line is not
 * an edge. */
int glint_edge_set_from_points(struct glint_edge *edge, const int32_t a_q8[2],
                               const int32_t b_q8[2], int32_t light,
                               int32_t other);

/* Returns the x coordinate of EDGE at Y, which must be between the ends of the
 * edge. The magnitude is below 2^61. Slopes are rounded towards 0, so x never
 * exceeds the range of the two ends. */
static inline int64_t compute_edge_x_q40(const struct glint_edge *e,
                                         int32_t y_q8)
{
    return e->x_q8 * (INT64_C(1) << 32) + e->slope_q40 * (y_q8 - e->y_q8);
}

/* Snaps EDGE to the nearest pixel boundary in each row. A snapped edge costs a
 * fraction of a smooth one. It is used for changes of light that are barely
 * visible. The edges of a closed outline still cancel, as their heights are
 * unchanged. */
void glint_edge_snap_to_pixels(struct glint_edge *edge);

/* glint_edge_count_into_bins() increments the counts of the tiles that EDGE
 * crosses and returns their number. glint_edge_put_into_bins() appends INDEX,
 * the index of EDGE, to the lists of these tiles. Parts of EDGE left of the
 * picture belong to the first column of tiles. */
int glint_edge_count_into_bins(const struct glint_edge *edge,
                               struct glint_bins *bins);
void glint_edge_put_into_bins(const struct glint_edge *edge,
                              struct glint_bins *bins, int32_t index);
/* Returns the number of entries that EDGE needs in BINS, without changing BINS.
 */
int glint_edge_count_bin_entries(const struct glint_edge *edge,
                                 const struct glint_bins *bins);

/* Adds the edges EDGE[REF[0 .. N_REFS - 1]] to SUMS, each in the colour of its
 * ray bundle. The light of both sides is multiplied by the colour before it is
 * subtracted, so that edges still cancel exactly. */
void glint_edges_add_to_sums(struct glint_edge_sums *sums,
                             const struct glint_edge *edge,
                             const struct glint_bundle *bundle,
                             const int32_t *ref, int n_refs);

/* Returns whether row ROW has no light: no differences, and no light carried in
 * from the left. */
int glint_sums_is_row_dark(const struct glint_edge_sums *sums, int row);

/* Convert row ROW of channel CHANNEL to light, clear the row's differences, and
 * set its carry to the light carried out of the tile.
 * glint_sums_read_linear_row() writes one value per pixel, clamped to int32.
 * glint_sums_read_code_row() rounds the number of values up to a multiple of
 * GLINT_LANES, and returns 0 if the row has no differences and the light
 * carried in rounds to 0. */
void glint_sums_read_linear_row(const struct glint_edge_sums *sums, int channel,
                                int row, int32_t *light_q20);
int glint_sums_read_code_row(const struct glint_edge_sums *sums, int channel,
                             int row, const struct glint_kernels *kernels,
                             uint16_t *light_q16);

#endif
