/* SPDX-License-Identifier: MIT
 *
 * Adds light to one tile's sums, given as edges across which the light changes.
 *
 * An edge adds its light to all pixels on its right, in proportion to the area
 * of a pixel that lies on its right. So a sum changes only at the pixels that
 * the edge crosses, by the difference of that area from one pixel to the next,
 * and one running sum along each row turns changes into light: the interior of
 * a ghost costs nothing.
 *
 * The edges of a closed outline cancel exactly: their signed heights in a row
 * cancel, and light times height is never rounded. The light that an edge adds
 * to a pixel depends on the edge alone, so that neither tiles nor the order of
 * edges change any bit. A tile's rows begin with the light that runs in from
 * its left neighbour and end with the light that runs out to the right one.
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
    int32_t x_q8, y_q8; /* upper end */
    int32_t end_y_q8;   /* lower end, > y */
    /* Light on the left and right side, packed; negative for a mirrored ghost.
     */
    int32_t left, right;
    /* patch: 1 if this is not an edge but a slot of a patch (patch.h), the
     * patch's first slot if whole is 0. Otherwise whole is 1 if the edge is
     * pixel-snapped. */
    unsigned bundle : 30, patch : 1, whole : 1;
};

/* Packs light, display white: a mantissa of 25 bits above an exponent of five.
 * Every packed value is an integer of _q20, so that sums which should cancel do
 * so exactly. */
static inline int32_t glint_light_pack(int64_t light_q20)
{
    const int wide =
        bit_length((uint64_t)(light_q20 < 0 ? -light_q20 : light_q20));
    const int exponent = wide > 25 ? wide - 25 : 0;

    return q_narrow(q_shift(light_q20, exponent) * 32 + exponent);
}

static inline int64_t glint_light_q20(int32_t packed)
{
    return (packed >> 5) * (INT64_C(1) << (packed & 31));
}

/* bytes of scratch memory of a patch function */
enum { GLINT_PATCH_SCRATCH = 8192 };

/* Adds the part of patch E that lies in a tile to the tile's narrow or wide
 * sums. LIGHT is the light through a clear stop, per channel, in the units of
 * the sums. */
struct glint_edge_sums;
typedef void glint_patch_fn(const struct glint_edge_sums *sums, int narrow,
                            const struct glint_edge *e, const int64_t light[3]);

/* Light of one tile, stored as differences between neighbouring pixels of a
 * row: wide and narrow are [3][side rows][stride], R, G, B. The entry after the
 * tile's last column is carried into the next tile. All entries are 0 between
 * tiles. */
struct glint_edge_sums {
    struct glint_box tile;
    int tile_log2, stride;
    int linear; /* nonzero: the picture is in linear light */
    int fine;   /* 1: light is _q20 even if the picture is in codes */
    int lit;    /* nonzero: light may run in from the left; set by the code that
                   draws rows of tiles */
    /* For patches (patch.h): the function that draws them, the shade of the
     * stop, and scratch memory of GLINT_PATCH_SCRATCH bytes. */
    glint_patch_fn *patch;
    const struct glint_shade *shade;
    void *scratch;
    int in_narrow; /* set by glint_edges_add_to_sums(): 1 if the narrow sums
                      sufficed and hold the result */
    uint64_t *wide;
    uint32_t *narrow;
    int64_t *carry;    /* [3][side rows]: light that runs into the tile; after a
                          row is read, the light that runs out */
    uint64_t *touched; /* [3]: per channel, bit n is set if row n has changes */
};

/* Returns the number of values reserved per row of a tile of 2^LOG2 pixels. */
#define GLINT_EDGE_STRIDE(log2) ((1 << (log2)) + 16)

/* Sets EDGE to the line from A to B, (x, y) _q8. LIGHT is on the right of an
 * upward line, y falling, OTHER on the other side. Returns 0 if the line is
 * horizontal, and so not an edge. */
int glint_edge_set_from_points(struct glint_edge *edge, const int32_t a_q8[2],
                               const int32_t b_q8[2], int32_t light,
                               int32_t other);

/* Returns x of EDGE at height Y, which must be between its ends. The magnitude
 * is below 2^61. Slopes are rounded towards 0, so x never lies beyond the
 * ends. */
static inline int64_t edge_x_at_q40(const struct glint_edge *e, int32_t y_q8)
{
    return e->x_q8 * (INT64_C(1) << 32) + e->slope_q40 * (y_q8 - e->y_q8);
}

/* Snaps EDGE to the nearest pixel boundary in each row. This costs a fraction
 * of a smooth edge, and is meant for changes of light that are barely visible.
 * Closed outlines still cancel, as heights are unchanged. */
void glint_edge_snap_to_pixels(struct glint_edge *edge);

/* Put EDGE, whose index is INDEX, into the bins of the tiles that it crosses,
 * or only count it there and return the number of entries. Parts left of the
 * picture belong to the first column of tiles. */
int glint_edge_count_into_bins(const struct glint_edge *edge,
                               struct glint_bins *bins);
void glint_edge_put_into_bins(const struct glint_edge *edge,
                              struct glint_bins *bins, int32_t index);
/* Returns the number of entries of EDGE in BINS without counting it there. */
int glint_edge_count_bin_entries(const struct glint_edge *edge,
                                 const struct glint_bins *bins);

/* Adds the edges EDGE[REF[0 .. N_REFS - 1]] to the changes of SUMS, each in the
 * colour of its bundle. The light of both sides is coloured before it is
 * subtracted, so that edges still cancel. */
void glint_edges_add_to_sums(struct glint_edge_sums *sums,
                             const struct glint_edge *edge,
                             const struct glint_bundle *bundle,
                             const int32_t *ref, int n_refs);

/* Returns whether row ROW has no light: neither changes nor light from the
 * left. */
int glint_sums_is_row_dark(const struct glint_edge_sums *sums, int row);

/* Write the light of row ROW of the tile in channel CHANNEL, clear its changes,
 * and set its carry to the light that runs out of the tile. For linear pictures
 * one value per pixel is written, clamped to int32. For pictures in codes the
 * number of values is rounded up to a multiple of GLINT_LANES; returns 0 if the
 * row has no light at all. */
void glint_sums_read_linear_row(const struct glint_edge_sums *sums, int channel,
                                int row, int32_t *light_q20);
int glint_sums_read_code_row(const struct glint_edge_sums *sums, int channel,
                             int row, const struct glint_kernels *kernels,
                             uint16_t *light_q16);

#endif
