/* SPDX-License-Identifier: MIT
 *
 * Evaluates the pupil box of a system, the rectangle of the front vertex plane
 * that contains the rays of a ghost. Its middle and half sizes are polynomials
 * of angle and wavelength. */
#ifndef GLINT_LENS_BOX_H
#define GLINT_LENS_BOX_H

#include "base/q.h"
#include "glint/model.h"

/* Unpacks one polynomial of a box, of which the model stores only the terms
 * whose bits are set in TERMS. Returns a pointer to the next packed
 * polynomial. */
static inline const int32_t *
unpack_box_polynomial(const int32_t *packed, uint32_t terms,
                      int32_t side[GLINT_BOX_TERMS])
{
    for (int m = 0; m < GLINT_BOX_TERMS; m++)
        side[m] = terms >> m & 1 ? *packed++ : 0;
    return packed;
}

/* Returns the value of the box polynomial P at angle S_Q30 and wavelength
 * W_Q30, both within +-2^30. */
static inline int32_t evaluate_box_polynomial(const int32_t p[GLINT_BOX_TERMS],
                                              int32_t s_q30, int32_t w_q30)
{
    const int32_t *of_w = p + GLINT_BOX_POWERS;
    int32_t sum = p[GLINT_BOX_POWERS - 1];

    for (int m = GLINT_BOX_POWERS - 2; m >= 0; m--)
        sum = q_mul(sum, s_q30, 30) + p[m];
    return sum + q_mul(q_mul(of_w[1], s_q30, 30) + of_w[0], w_q30, 30);
}

/* Like evaluate_box_polynomial(), in the lens basis (for lenses that are not
 * round): at direction (S_Q30, Y_Q30) and wavelength W_Q30. */
static inline int32_t
evaluate_lens_box_polynomial(const int32_t p[GLINT_BOX_TERMS], int32_t s_q30,
                             int32_t y_q30, int32_t w_q30)
{
    const int32_t of_s = q_mul(q_mul(p[2], s_q30, 30) + p[1], s_q30, 30);
    const int32_t of_y = q_mul(p[5], y_q30, 30) + q_mul(p[4], s_q30, 30) + p[3];

    return p[0] + of_s + q_mul(of_y, y_q30, 30) +
           q_mul(q_mul(p[7], s_q30, 30) + p[6], w_q30, 30);
}

#endif
