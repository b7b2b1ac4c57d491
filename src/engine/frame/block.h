/* SPDX-License-Identifier: MIT
 *
 * Memory aligned as the run-time half asks for it.
 */
#ifndef GLINT_ENGINE_FRAME_BLOCK_H
#define GLINT_ENGINE_FRAME_BLOCK_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* BYTES, aligned to 64, within *MEM, which is to be freed. NULL: there are not
 * so many, or none is asked for; then *MEM is NULL, too. */
static inline void *glint_block_take(size_t bytes, void **mem)
{
    const uintptr_t last = 63;

    *mem = bytes ? malloc(bytes + last) : NULL;
    return *mem ? (char *)*mem + (-(uintptr_t)*mem & last) : NULL;
}

#endif
