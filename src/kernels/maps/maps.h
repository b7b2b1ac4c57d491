/* SPDX-License-Identifier: MIT
 *
 * Kernel that convolves texture maps of translucent objects. The rules of
 * kernels.h apply, except that arrays need no alignment.
 */
#ifndef GLINT_KERNELS_MAPS_MAPS_H
#define GLINT_KERNELS_MAPS_MAPS_H

#include <stddef.h>
#include <stdint.h>

/* Packs two int16 into an int32, FIRST in the lower half. */
static inline int32_t glint_pack_int16_pair(int32_t first, int32_t second)
{
    return (int32_t)((uint32_t)(uint16_t)first | (uint32_t)second << 16);
}

/* Adds a convolution of pairs of values with pairs of taps to SUM[0 .. N -
 * 1]:
 *   sum[i] += sum over k of value[i + k stride] . tap[k]
 * where . is the dot product of two pairs of int16. No int16 is -32768, and
 * the caller guarantees that partial sums fit int32 in any order. N is a
 * multiple of 32. */
typedef void glint_convolve_fn(int32_t *sum, const int32_t *value,
                               ptrdiff_t stride, const int32_t *tap, int n_taps,
                               int n);

/* Returns the best kernel that the GLINT_SET_ bits SETS allow; the kernel in C
 * if no bit is set. */
glint_convolve_fn *glint_choose_convolve_kernel(unsigned sets);

glint_convolve_fn glint_convolve_c, glint_convolve_sse41, glint_convolve_avx2,
    glint_convolve_neon;

#endif
