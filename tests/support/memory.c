/* SPDX-License-Identifier: MIT */
#include "support/memory.h"

#include <stdlib.h>

static void **blocks;
static size_t n_blocks, max_blocks;

void *test_free_later(void *memory)
{
    if (n_blocks == max_blocks) {
        max_blocks = 2 * max_blocks + 16;
        blocks = realloc(blocks, max_blocks * sizeof *blocks);
    }
    if (!memory || !blocks)
        abort();
    return blocks[n_blocks++] = memory;
}

void *test_allocate(size_t bytes)
{
    void *memory = NULL;

    return test_free_later(posix_memalign(&memory, 64, bytes) ? NULL : memory);
}

void test_free_memory(void)
{
    while (n_blocks)
        free(blocks[--n_blocks]);
}
