/* SPDX-License-Identifier: MIT
 *
 * A flare without ghosts, whose tiles a star or a veil is drawn with. */
#ifndef GLINT_TESTS_BARE_FLARE_H
#define GLINT_TESTS_BARE_FLARE_H

#include <stddef.h>

#include "glint/flare.h"
#include "support/shuffle.h"

struct bare_flare {
    struct glint_flare *flare;
    void *mem;
    struct shuffle shuffle;
};

/* Opens BARE for WIDTH x HEIGHT pixels in tiles of 2^TILE_LOG2, and N_WORKERS
 * workers whose jobs come in an order by ORDER. */
void bare_flare_open(struct bare_flare *bare, int width, int height,
                     int tile_log2, int n_workers, uint32_t order);
void bare_flare_close(struct bare_flare *bare);

/* Returns BYTES, at least 1, of memory filled with 0xa5 at a cache line's
 * start, to be freed. */
void *bare_flare_take(size_t bytes);

#endif
