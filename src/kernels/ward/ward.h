/* SPDX-License-Identifier: MIT
 *
 * Kernel that shades brushed metal: sums environment light over samples of a
 * Ward lobe. The rules of kernels.h apply, except that texels are gathered from
 * any address.
 *
 * Let o be the direction to the eye, h the half vector, n the normal, and i = 2
 * (h.o) h - o the direction to the light. The weight of a sample depends on the
 * normalisation. With that of 1992 [Ward92] it is (h.o) (h.n)^3 sqrt(n.i /
 * n.o). With the bounded one [Geisler10] it is (n.i) / ((h.o) (h.n)) = 2 -
 * (n.o) / ((h.o) (h.n)). Weights are clamped to 8. */
#ifndef GLINT_KERNELS_WARD_WARD_H
#define GLINT_KERNELS_WARD_WARD_H

#include "glint/scene/lobe.h"

/* Returns the best kernel that the GLINT_SET_ bits SETS allow; the kernel in C
 * if no bit is set. */
glint_ward_sum_fn *glint_choose_ward_kernel(unsigned sets);

glint_ward_sum_fn glint_ward_sum_c, glint_ward_sum_sse41, glint_ward_sum_avx2,
    glint_ward_sum_neon;

#endif
