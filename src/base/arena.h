/* SPDX-License-Identifier: MIT
 *
 * Bump allocator in one block that the caller owns; nothing is freed.
 *
 * If base is NULL, the arena only counts bytes. Each object has one function
 * that allocates its buffers. The function runs twice: first to measure the
 * size, then to place the buffers. So the reported size is always the size that
 * init needs.
 */
#ifndef GLINT_BASE_ARENA_H
#define GLINT_BASE_ARENA_H

#include <stddef.h>
#include <stdint.h>

#define GLINT_ALIGN 64 /* alignment of base and of every allocation, bytes */

struct glint_arena {
    /* Memory aligned to GLINT_ALIGN, or NULL if the arena only counts bytes. */
    uint8_t *base;
    size_t size; /* number of bytes at base; SIZE_MAX if base is NULL */
    size_t used; /* number of bytes allocated so far; if it exceeds SIZE, an
                    allocation has failed */
};

/* Returns an arena that only counts bytes: base is NULL. */
struct glint_arena glint_arena_begin_measuring(void);

/* Returns an arena that allocates from MEM[BYTES]; MEM is aligned to
 * GLINT_ALIGN. */
struct glint_arena glint_arena_init_in_memory(void *mem, size_t bytes);

/* Allocates COUNT items of BYTES bytes each and returns the uninitialised
 * memory. Returns NULL if the arena only counts bytes or is full. If COUNT
 * times BYTES overflows, the arena is full afterwards. */
void *glint_arena_allocate(struct glint_arena *arena, size_t count,
                           size_t bytes);

#endif
