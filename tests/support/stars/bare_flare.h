/* SPDX-License-Identifier: MIT
 *
 * A flare renderer that draws no ghosts. Tests use its tiles to draw starbursts
 * and veils.
 */
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

/* Opens BARE for WIDTH x HEIGHT pixels in tiles of 2^TILE_LOG2 pixels, with
 * N_WORKERS workers. ORDER: seed of the random order in which jobs run. */
void bare_flare_open(struct bare_flare *bare, int width, int height,
                     int tile_log2, int n_workers, uint32_t order);
void bare_flare_close(struct bare_flare *bare);

/* Allocates BYTES, at least 1, aligned to a cache line and filled with 0xa5.
 * The caller frees them. */
void *bare_flare_allocate_filled(size_t bytes);

#endif
