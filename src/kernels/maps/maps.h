/* SPDX-License-Identifier: MIT
 *
 * The hot loop for maps of translucent objects. The rules of kernels.h apply,
 * except that arrays need no alignment. */
#ifndef GLINT_KERNELS_MAPS_MAPS_H
#define GLINT_KERNELS_MAPS_MAPS_H

#include <stddef.h>
#include <stdint.h>

/* Two int16, the first in the lower half. */
static inline int32_t glint_pair(int32_t first, int32_t second)
{
    return (int32_t)((uint32_t)(uint16_t)first | (uint32_t)second << 16);
}

/* Adds to SUM[0 .. N - 1] a convolution: pairs of values by pairs of taps,
 *   sum[i] += sum over k of value[i + k stride] . tap[k]
 * where a product of pairs is that of the first ones and that of the second
 * ones. No element is -32768; no sum leaves int32, whatever the order in which
 * it is taken. N is a multiple of 32. */
typedef void glint_convolve_fn(int32_t *sum, const int32_t *value,
                               ptrdiff_t stride, const int32_t *tap, int n_taps,
                               int n);

/* Returns the best kernel that the GLINT_SET_ bits SETS allow; the kernel in C
 * if no bit is set. */
glint_convolve_fn *glint_convolve_of(unsigned sets);

glint_convolve_fn glint_convolve_c, glint_convolve_sse41, glint_convolve_avx2,
    glint_convolve_neon;

#endif
