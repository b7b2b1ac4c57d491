/* SPDX-License-Identifier: MIT
 *
 * The hot loop of brushed metal. The rules of kernels.h apply, except that
 * texels are gathered from any address.
 *
 * With o to the eye, i = 2 (h.o) h - o to the light, n the normal, a sample
 * counts (h.o) (h.n)^3 sqrt(n.i / n.o) in the norm of 1992 and, bounded, (n.i)
 * / ((h.o) (h.n)), which is 2 - (n.o) / ((h.o) (h.n)); clamped to 8. */
#ifndef GLINT_KERNELS_WARD_WARD_H
#define GLINT_KERNELS_WARD_WARD_H

#include "glint/scene/lobe.h"

/* Returns the best kernel that the GLINT_SET_ bits SETS allow; the kernel in C
 * if no bit is set. */
glint_ward_sum_fn *glint_ward_sum_of(unsigned sets);

glint_ward_sum_fn glint_ward_sum_c, glint_ward_sum_sse41, glint_ward_sum_avx2,
    glint_ward_sum_neon;

#endif
