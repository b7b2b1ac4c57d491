/* SPDX-License-Identifier: MIT
 *
 * Adds light to one tile's sums by the edges across which it changes.
 *
 * An edge adds its light to all that lies to its right: to a pixel in
 * proportion to the area of the part it covers. So a sum is changed only where
 * an edge runs, by the difference of that area from one pixel to the next, and
 * one running sum along each row turns changes into light: the interior of a
 * ghost costs nothing.
 *
 * The edges of a closed outline cancel to the last bit: the heights by which
 * they cross a row cancel, and light times height is never rounded. What an
 * edge adds to a pixel follows from the edge alone, so that neither tiles nor
 * the order of edges change any bit. A tile's rows begin with the light that
 * runs in from its left neighbour and end with the light that runs out to the
 * right one.
 *
 * Formats: corners _q8, slopes _q40, light _q20 below 2^40. Sums for pictures
 * of linear light: light _q20 times areas _q16, modulo 2^64. For all others
 * light _q16 (_q20 if fine) times areas _q8, modulo 2^64, or modulo 2^32 if a
 * tile's edges together cannot bring a sum beyond that, which is 128 (8) times
 * white: the same results, faster. The caller's limit on light keeps final sums
 * below 2^63 (by_edges.c); intermediate sums may wrap, and wrap back. */
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
    /* PATCH: no edge but a place of a patch, patch.h; its first if WHOLE is 0.
     */
    unsigned bundle : 30, patch : 1, whole : 1;
};

/* Packs light, display white: a mantissa of 25 bits above an exponent of five.
 * Every value that can be packed is a whole number of _q20, so that sums which
 * should cancel do so exactly. */
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

/* Sums of one tile, as changes from pixel to pixel: [3][side rows][stride], R,
 * G, B. One value after the tile's last column is the change for the next tile.
 * All are 0 between tiles. */
enum { GLINT_PATCH_SCRATCH = 8192 };

/* Adds the part of patch E that lies in a tile to its narrow or wide sums;
 * LIGHT: of a clear stop, by channel, in the units of the sums. */
struct glint_edge_sums;
typedef void glint_patch_fn(const struct glint_edge_sums *sums, int narrow,
                            const struct glint_edge *e, const int64_t light[3]);

struct glint_edge_sums {
    struct glint_box tile;
    int tile_log2, stride;
    int linear; /* the picture is of linear light */
    int fine;   /* 1: light of _q20 for pictures in codes, too */
    int lit; /* light runs in from the left; set by the code that draws rows of
                tiles */
    /* For patches (patch.h): their method, the shade of the stop, and scratch
     * memory of GLINT_PATCH_SCRATCH bytes. */
    glint_patch_fn *patch;
    const struct glint_shade *shade;
    void *scratch;
    int in_narrow; /* set by glint_edge_add(): the narrow sums suffice and were
                   used */
    uint64_t *wide;
    uint32_t *narrow;
    int64_t *carry;    /* [3][side rows]: light that runs in, and then out */
    uint64_t *touched; /* [3]: bit n: row n has changes */
};

/* Returns the number of values reserved for a row of a tile of 2^LOG2 pixels.
 */
#define GLINT_EDGE_STRIDE(log2) ((1 << (log2)) + 16)

/* Sets EDGE to the line from A to B, (x, y) _q8. LIGHT is on the right of an
 * upward line, y falling, OTHER on the other side. Returns 0 if the line is
 * level and so is not an edge. */
int glint_edge_set(struct glint_edge *edge, const int32_t a_q8[2],
                   const int32_t b_q8[2], int32_t light, int32_t other);

/* Returns x of EDGE at height Y between its ends: below 2^29 pixels _q8, so
 * below 2^61. Slopes are rounded towards 0, so x never lies beyond the ends. */
static inline int64_t edge_x_at_q40(const struct glint_edge *e, int32_t y_q8)
{
    return e->x_q8 * (INT64_C(1) << 32) + e->slope_q40 * (y_q8 - e->y_q8);
}

/* Snaps the light of EDGE to the nearest whole pixel in each row: a fraction of
 * the cost, for changes that are barely visible. Closed outlines still cancel,
 * as heights are unchanged. */
void glint_edge_make_snapped(struct glint_edge *edge);

/* Put EDGE, number INDEX, into the tiles that it crosses, or count it there and
 * return how many entries that is. Parts left of the picture belong to the
 * first column of tiles. */
int glint_edge_count(const struct glint_edge *edge, struct glint_bins *bins);
void glint_edge_put(const struct glint_edge *edge, struct glint_bins *bins,
                    int32_t index);
/* Returns how many entries EDGE takes in BINS, and counts nothing. */
int glint_edge_span(const struct glint_edge *edge,
                    const struct glint_bins *bins);

/* Adds the edges EDGE[REF[0 .. N_REFS - 1]] to the changes of SUMS, each in the
 * colour of its bundle. Light is coloured before its two sides are subtracted,
 * so that edges still cancel. */
void glint_edge_add(struct glint_edge_sums *sums, const struct glint_edge *edge,
                    const struct glint_bundle *bundle, const int32_t *ref,
                    int n_refs);

/* Returns whether row ROW has neither changes nor light that runs in. */
int glint_edge_dark(const struct glint_edge_sums *sums, int row);

/* Write the light of row ROW of the tile in channel CHANNEL, clear its changes,
 * and set its carry to what runs out. For linear pictures that is one value a
 * pixel, clamped to int32; for pictures in codes the number of values is
 * rounded up to a multiple of GLINT_LANES, and 0 is returned if the row has no
 * light at all. */
void glint_edge_linear(const struct glint_edge_sums *sums, int channel, int row,
                       int32_t *light_q20);
int glint_edge_light(const struct glint_edge_sums *sums, int channel, int row,
                     const struct glint_kernels *kernels, uint16_t *light_q16);

#endif
