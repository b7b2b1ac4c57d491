/* SPDX-License-Identifier: MIT
 *
 * Adds light to one tile's sums by the edges across which it changes.
 *
 * An edge adds its light to all that lies to its right: to a pixel in
 * proportion to the area of the part it covers. So a sum is changed only where
 * an edge runs, by the difference of that area from one pixel to the next, and
 * one running sum along each row turns changes into light: the inside of a
 * ghost costs nothing.
 *
 * Edges of a closed outline cancel to the last bit, because the heights by
 * which they cross a row do, and light times height is never rounded. What an
 * edge adds to a pixel follows from the edge alone, so that neither tiles nor
 * the order of edges change any bit. A tile's rows begin with what runs in from
 * its left neighbour and end with what it leaves to the right one.
 *
 * Formats: corners _q8, slopes _q40, light _q20 below 2^40. Sums for pictures
 * of linear light: light _q20 times areas _q16, modulo 2^64. For all others
 * light _q16 (_q20 if fine) times areas _q8, modulo 2^64, or 2^32 where a
 * tile's edges together cannot bring a sum beyond that: the same results,
 * faster. The caller's limit on light keeps final sums below 2^63 (flare.c);
 * what comes in between may wrap, and wraps back.
 */
#ifndef GLINT_FLARE_EDGE_H
#define GLINT_FLARE_EDGE_H

#include <stdint.h>

#include "base/compiler.h"
#include "base/q.h"
#include "kernels/kernels.h"
#include "tile/bins.h"
#include "flare/edges/primitive.h"

struct glint_edge {     /* 32 bytes */
    int64_t slope_q40;  /* pixels of x per 1/256 pixel of y */
    int32_t x_q8, y_q8; /* upper end */
    int32_t end_y_q8;   /* lower end, > y */
    /* Light on its left and right side, packed; negative where a ghost is
     * mirrored. */
    int32_t left, right;
    unsigned bundle : 31, whole : 1;
};

/* Light of 25 bits and an exponent: the product of all but the lower five bits
 * with two to the power of these, display white _q20. Every such value is a
 * whole number, so that what cancels does so exactly. */
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

/* Sums of one tile: changes, [3][side rows][stride], R, G, B; past the tile's
 * last column one more is for what the next tile begins with. All are 0 between
 * tiles. */
struct glint_edge_sums {
    struct glint_box tile;
    int tile_log2, stride;
    int linear; /* the picture is of linear light */
    int fine;   /* light _q20 for others too */
    int lit;    /* set by who draws rows of tiles: light runs in */
    int narrow; /* set by add: narrow sums do, and have been used */
    uint64_t *wide;
    uint32_t *narrow_q24;
    int64_t *carry;    /* [3][side rows]: what runs in, and out */
    uint64_t *touched; /* [3]: bit n: row n has changes */
};

/* Space of GLINT_EDGE_STRIDE(log2) values a row. */
#define GLINT_EDGE_STRIDE(log2) ((1 << (log2)) + 16)

/* The edge from A to B, (x, y) _q8, with LIGHT on the side that is the right
 * one where it runs up, y falling, and OTHER on the other side; returns 0 if it
 * is level. */
int glint_edge_set(struct glint_edge *edge, const int32_t a_q8[2],
                   const int32_t b_q8[2], int32_t light, int32_t other);

/* Lets the light of EDGE begin at a whole pixel in each row, the nearest one: a
 * fraction of the work, for changes that hardly show. What cancels still
 * does, as it is heights that do. */
void glint_edge_make_snapped(struct glint_edge *edge);

/* Puts EDGE, number INDEX, into the tiles it crosses (or counts it, and returns
 * how many entries that is): glint_bins
 * with a box for each row of tiles. What lies left of the picture belongs to
 * the first column. */
int glint_edge_count(const struct glint_edge *edge, struct glint_bins *bins);
void glint_edge_put(const struct glint_edge *edge, struct glint_bins *bins,
                    int32_t index);
/* Returns how many that is, and counts nothing. */
int glint_edge_span(const struct glint_edge *edge,
                    const struct glint_bins *bins);

/* Adds the edges REF[0 .. N_REFS - 1] of EDGE, each in the colour of its
 * bundle, to the changes of SUMS. Light is coloured before sides are compared,
 * so that edges still cancel. */
void glint_edge_add(struct glint_edge_sums *sums, const struct glint_edge *edge,
                    const struct glint_bundle *bundle, const int32_t *ref,
                    int n_refs);

/* Returns whether row ROW has neither changes nor light that runs in. */
int glint_edge_dark(const struct glint_edge_sums *sums, int row);

/* The light of row ROW of the tile in channel CHANNEL; its changes are cleared,
 * its carry goes on. Of linear pictures one value a pixel, saturating at the
 * int32 range; of others so many as are a multiple of GLINT_LANES, and 0 is
 * returned where there is no light at all. */
void glint_edge_linear(const struct glint_edge_sums *sums, int channel, int row,
                       int32_t *light_q20);
int glint_edge_light(const struct glint_edge_sums *sums, int channel, int row,
                     const struct glint_kernels *kernels, uint16_t *light_q16);

#endif
