/* SPDX-License-Identifier: MIT
 *
 * Decodes texels of environment maps.
 */
#ifndef GLINT_TESTS_TEXEL_H
#define GLINT_TESTS_TEXEL_H

#include <math.h>

#include "glint/scene/ward.h"

static inline double decode_rgb9e5(const struct glint_environment *e,
                                   uint32_t word, int c)
{
    return ldexp(word >> (9 * c) & 511,
                 (int)(word >> 27) - 12 + e->header->unit_log2);
}

/* Returns channel C of texel I of level K. */
static inline double decode_texel(const struct glint_environment *e, int k,
                                  size_t i, int c)
{
    return decode_rgb9e5(e, ((const uint32_t *)e->texel[k])[i], c);
}

#endif
