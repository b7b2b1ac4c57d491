/* SPDX-License-Identifier: MIT
 *
 * Sorts items into tiles by their bounding boxes in pixels. Each tile gets a
 * list of the indices of all items whose boxes overlap the tile.
 *
 * There are three steps: count the entries of each tile; convert the counts to
 * start indices of the lists by a prefix sum; add the items to the lists. So
 * lists need no spare memory. The same code is used twice: it bins a frame into
 * large tiles, and a large tile into small tiles. */
#ifndef GLINT_TILE_BINS_H
#define GLINT_TILE_BINS_H

#include <stdint.h>

#include "tile/box.h"

struct glint_bins {
    struct glint_box region; /* box of pixels that the tiles cover */
    int tile_log2;
    int tiles_x, tiles_y;
    /* start index of each tile's list in ref, [tiles_x * tiles_y + 1]; before
     * the prefix sum, the length of the list */
    int32_t *start;
    int32_t *ref; /* lists of all tiles, one after the other: indices of items,
                     rising within a list */
};

/* Initialises BINS for tiles of 2^TILE_LOG2 x 2^TILE_LOG2 pixels that cover
 * REGION. START and REF are arrays that the caller owns. */
void glint_bins_init(struct glint_bins *bins, struct glint_box region,
                     int tile_log2, int32_t *start, int32_t *ref);

/* Returns the number of tiles that BOX overlaps, which is the number of list
 * entries for an item with that box. */
int glint_bins_count_overlapped_tiles(const struct glint_bins *bins,
                                      struct glint_box box);

/* Count the entries of lists. glint_bins_clear_counts() sets the counts of all
 * tiles to 0. glint_bins_count_box() is called once per item and increments the
 * counts of the tiles that BOX overlaps. */
void glint_bins_clear_counts(struct glint_bins *bins);
void glint_bins_count_box(struct glint_bins *bins, struct glint_box box);
void glint_bins_convert_counts_to_starts(struct glint_bins *bins);
/* Appends ITEM to the lists of the tiles that BOX overlaps. Lists have the
 * order in which items are appended. */
void glint_bins_put_item(struct glint_bins *bins, struct glint_box box,
                         int32_t item);
/* Resets the start indices, which adding items advanced, to the beginnings of
 * the lists. */
void glint_bins_reset_starts(struct glint_bins *bins);

/* Returns the pixels of tile TILE. */
struct glint_box glint_bins_compute_tile_box(const struct glint_bins *bins,
                                             int tile);

#endif
