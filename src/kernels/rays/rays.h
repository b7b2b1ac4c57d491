/* SPDX-License-Identifier: MIT
 *
 * Kernels for rays: polynomial evaluation and rotation. The rules of kernels.h
 * apply.
 */
#ifndef GLINT_KERNELS_RAYS_RAYS_H
#define GLINT_KERNELS_RAYS_RAYS_H

#include <stdint.h>

#include "base/compiler.h"

/* Evaluate N values of a polynomial by Horner's rule: ((c[D] x + c[D - 1]) x
 * + ...) + c[0]. Each product is shifted right by 30 bits and rounded to an
 * integer. The caller guarantees that values stay below 2^30 in magnitude,
 * and X within +-2^30.
 *   along   one polynomial at x[0 .. N - 1]
 *   across  N polynomials at X; the coefficients C[k] begin STRIDE apart */
typedef void glint_horner_along_fn(int32_t *out, const int32_t *c, int degree,
                                   const int32_t *x_q30, int n);
typedef void glint_horner_across_fn(int32_t *out, const int32_t *c, int stride,
                                    int degree, int32_t x_q30, int n);

/* Rotates points (X, Y), and their mirror images (X, -Y), by an angle, and
 * scales them:
 *   out     x cos - y sin, x sin + y cos; x cos + y sin, x sin - y cos; each
 *           divided by 2^shift, or 0 if that reaches LIMIT in magnitude
 *   lost    [0] for points, [1] for images: all bits are set if a coordinate
 *           reaches LIMIT; else left unchanged
 * X and Y are below 2^30 in magnitude, cosine and sine below 2^31, LIMIT is
 * 2^30 at most. Shifts are 1 .. 62; the C variant accepts any shift. */
enum { GLINT_TURNED = 8 }; /* number of points per call */

struct glint_turn {
    int32_t cos, sin;
    int shift;
    int32_t limit;
};

typedef void glint_turn_fn(const struct glint_turn *turn, const int32_t *x,
                           const int32_t *y, int32_t (*out)[GLINT_TURNED],
                           int32_t (*lost)[GLINT_TURNED]);

struct glint_horner {
    glint_horner_along_fn *along;
    glint_horner_across_fn *across;
};

/* Return the best kernels that the GLINT_SET_ bits SETS allow; the kernels in C
 * if no bit is set. */
const struct glint_horner *glint_choose_horner_kernels(unsigned sets);
glint_turn_fn *glint_choose_turn_kernel(unsigned sets);

glint_horner_along_fn glint_horner_along_c, glint_horner_along_sse41,
    glint_horner_along_avx2, glint_horner_along_neon;
glint_horner_across_fn glint_horner_across_c, glint_horner_across_sse41,
    glint_horner_across_avx2, glint_horner_across_neon;
glint_turn_fn glint_turn_c, glint_turn_sse41, glint_turn_avx2, glint_turn_neon;

#endif
