/* SPDX-License-Identifier: MIT
 *
 * Bump allocator in one block that the caller owns; nothing is freed.
 *
 * With base == NULL the arena only counts bytes. Each object has one function
 * that allocates its buffers. The function runs twice: first to measure the
 * size, then to place the buffers. So the reported size is always the size that
 * init needs.
 */
#ifndef GLINT_BASE_ARENA_H
#define GLINT_BASE_ARENA_H

#include <stddef.h>
#include <stdint.h>

#define GLINT_ALIGN 64 /* alignment of base and of every block, bytes */

struct glint_arena {
    uint8_t *base; /* GLINT_ALIGN-aligned, or NULL to measure */
    size_t size;   /* bytes at base; SIZE_MAX while measuring */
    size_t used;   /* bytes allocated; if this exceeds size, an allocation
                      failed */
};

/* Returns an arena that measures. */
struct glint_arena glint_arena_measure(void);

/* Returns an arena over MEM[BYTES]; MEM is aligned to GLINT_ALIGN. */
struct glint_arena glint_arena_over(void *mem, size_t bytes);

/* Allocates COUNT items of BYTES each, uninitialised; NULL while measuring, or
 * if the arena is full. A product that overflows leaves the arena full. */
void *glint_arena_take(struct glint_arena *arena, size_t count, size_t bytes);

#endif
