/* SPDX-License-Identifier: MIT
 *
 * Index lists: which items, each of a box of pixels, may touch which tile.
 *
 * Three steps, so that every list has exactly the length it needs and order is
 * by item, never by arrival: count, prefix sum, scatter. The same code
 * serves both levels: the frame in large tiles, a large tile in small ones.
 */
#ifndef GLINT_TILE_BINS_H
#define GLINT_TILE_BINS_H

#include <stdint.h>

#include "tile/box.h"

struct glint_bins {
    struct glint_box region; /* pixels that the tiles cover */
    int tile_log2;
    int tiles_x, tiles_y;
    int32_t *start; /* [tiles_x * tiles_y + 1], into ref */
    int32_t *ref;   /* indices of items, rising within a tile */
};

/* Tiles across and down REGION. */
void glint_bins_init(struct glint_bins *bins, struct glint_box region,
                     int tile_log2, int32_t *start, int32_t *ref);

/* How many tiles of BINS the pixels BOX touch: the entries it will take. */
int glint_bins_span(const struct glint_bins *bins, struct glint_box box);

/* count: once for all boxes, after glint_bins_open */
void glint_bins_open(struct glint_bins *bins);
void glint_bins_count(struct glint_bins *bins, struct glint_box box);
/* prefix sum: from counts to starts */
void glint_bins_sum(struct glint_bins *bins);
/* scatter: the same boxes again, in the order wanted */
void glint_bins_put(struct glint_bins *bins, struct glint_box box,
                    int32_t item);
/* puts the starts back where the scatter found them */
void glint_bins_close(struct glint_bins *bins);

/* The pixels of tile TILE. */
struct glint_box glint_bins_tile(const struct glint_bins *bins, int tile);

#endif
