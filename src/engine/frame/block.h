/* SPDX-License-Identifier: MIT
 *
 * Allocates memory aligned to 64 bytes. The integer part of the library
 * requires this alignment. */
#ifndef GLINT_ENGINE_FRAME_BLOCK_H
#define GLINT_ENGINE_FRAME_BLOCK_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* Allocates BYTES bytes, aligned to 64. The caller frees *MEM, not the returned
 * pointer. Returns NULL and sets *MEM to NULL if memory is short or BYTES is
 * 0. */
static inline void *glint_block_allocate_aligned(size_t bytes, void **mem)
{
    const uintptr_t last = 63;

    *mem = bytes ? malloc(bytes + last) : NULL;
    return *mem ? (char *)*mem + (-(uintptr_t)*mem & last) : NULL;
}

#endif
