/* SPDX-License-Identifier: MIT
 *
 * Bins items, each with a bounding box in pixels, into tiles: lists for each
 * tile the items whose boxes overlap it.
 *
 * Three steps, so that every list has exactly the length it needs and is
 * ordered by item, never by arrival: count, prefix sum, scatter. The same code
 * bins on both levels: a frame into large tiles, and a large tile into small
 * tiles. */
#ifndef GLINT_TILE_BINS_H
#define GLINT_TILE_BINS_H

#include <stdint.h>

#include "tile/box.h"

struct glint_bins {
    struct glint_box region; /* pixels that the tiles cover */
    int tile_log2;
    int tiles_x, tiles_y;
    /* [tiles_x * tiles_y + 1]: first entry of each tile in ref. */
    int32_t *start;
    int32_t *ref; /* indices of items, rising within a tile */
};

/* Sets up BINS for REGION, with tiles of 2^TILE_LOG2 pixels. Computes the
 * numbers of tiles across and down, and stores the arrays START and REF,
 * which the caller owns. */
void glint_bins_init(struct glint_bins *bins, struct glint_box region,
                     int tile_log2, int32_t *start, int32_t *ref);

/* Returns the number of tiles of BINS that BOX overlaps, which is the number
 * of list entries that BOX needs. */
int glint_bins_span(const struct glint_bins *bins, struct glint_box box);

/* open() sets all counts to 0; count() increments the counts of the tiles
 * that BOX overlaps; call it once for each item. */
void glint_bins_open(struct glint_bins *bins);
void glint_bins_count(struct glint_bins *bins, struct glint_box box);
/* Converts the counts to start indices of the lists. */
void glint_bins_sum(struct glint_bins *bins);
/* Appends ITEM to the lists of the tiles that BOX overlaps. Call it in the
 * order that the lists are to have. */
void glint_bins_put(struct glint_bins *bins, struct glint_box box,
                    int32_t item);
/* Resets the start indices, which glint_bins_put() advanced, to the beginnings
 * of the lists. */
void glint_bins_close(struct glint_bins *bins);

/* Returns the pixels of tile TILE. */
struct glint_box glint_bins_tile(const struct glint_bins *bins, int tile);

#endif
