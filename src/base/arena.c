/* SPDX-License-Identifier: MIT */
#include "base/arena.h"

struct glint_arena glint_arena_begin_measuring(void)
{
    return (struct glint_arena){.base = NULL, .size = SIZE_MAX, .used = 0};
}

struct glint_arena glint_arena_init_in_memory(void *mem, size_t bytes)
{
    return (struct glint_arena){.base = mem, .size = bytes, .used = 0};
}

void *glint_arena_allocate(struct glint_arena *arena, size_t count,
                           size_t bytes)
{
    const size_t room = SIZE_MAX - arena->used;
    const size_t at = arena->used;

    if (bytes > 0 && count > (room - GLINT_ALIGN) / bytes) {
        /* A block whose size overflows marks the arena as full, so that all
         * later allocations fail, too. */
        arena->used = SIZE_MAX - GLINT_ALIGN;
        return NULL;
    }
    arena->used +=
        (count * bytes + GLINT_ALIGN - 1) / GLINT_ALIGN * GLINT_ALIGN;
    if (!arena->base || arena->used > arena->size)
        return NULL;
    return arena->base + at;
}
