/* SPDX-License-Identifier: MIT
 *
 * Bump allocation from one block that the caller owns; nothing is freed.
 *
 * With base == NULL the arena only counts. Each object has one function that
 * carves its buffers, and it runs twice: first to measure, then to place. The
 * size an application is asked for cannot drift from what init takes.
 */
#ifndef GLINT_BASE_ARENA_H
#define GLINT_BASE_ARENA_H

#include <stddef.h>
#include <stdint.h>

#define GLINT_ALIGN 64 /* bytes; of every block handed out, and of base */

struct glint_arena {
    uint8_t *base; /* GLINT_ALIGN-aligned, or NULL to measure */
    size_t size;   /* bytes at base; SIZE_MAX while measuring */
    size_t used;   /* > size: something did not fit */
};

/* An arena that measures. */
struct glint_arena glint_arena_measure(void);

/* An arena over MEM[BYTES], aligned to GLINT_ALIGN. */
struct glint_arena glint_arena_over(void *mem, size_t bytes);

/* COUNT items of BYTES each, uninitialised; NULL if measuring or full. A
 * product that overflows leaves the arena full for good. */
void *glint_arena_take(struct glint_arena *arena, size_t count, size_t bytes);

#endif
