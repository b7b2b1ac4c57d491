/* SPDX-License-Identifier: MIT */
#include "support/stars/bare_flare.h"

#include "support/test.h"

void *bare_flare_allocate_filled(size_t bytes)
{
    void *mem = NULL;

    assert_true(bytes > 0);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    memset(mem, 0xa5, bytes);
    return mem;
}

void bare_flare_open(struct bare_flare *bare, int width, int height,
                     int tile_log2, int n_workers, uint32_t order)
{
    struct glint_flare_config config;
    size_t bytes;

    init_shuffled_workers(&bare->shuffle, n_workers, order);
    glint_flare_defaults(&config, width, height);
    config.tile_log2 = tile_log2;
    config.workers = &bare->shuffle.workers;
    config.max_bundles = config.max_primitives = config.max_refs = 1;
    bytes = glint_flare_bytes(&config);
    bare->mem = bare_flare_allocate_filled(bytes);
    assert_ok(glint_flare_init(&bare->flare, &config, bare->mem, bytes));
}

void bare_flare_close(struct bare_flare *bare)
{
    free(bare->mem);
}
