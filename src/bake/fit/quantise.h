/* SPDX-License-Identifier: MIT
 *
 * Converts the doubles of a fit into the integers of a model and proves that
 * these cannot overflow at run time.
 *
 *   in   a fitted system
 *   out  integer coefficients and exponents; for each output a proven bound on
 *        every intermediate result of src/lens/transfer*.c and on the rounding
 *        error of its value
 *
 * Method: interval arithmetic over the whole domain, operation by operation in
 * the order of the run time: angle and wavelength into the coefficients, v into
 * the row, Horner's rule along u. Interpolated coefficients lie between those
 * of two knots, so the interval covers both.
 */
#ifndef GLINT_BAKE_FIT_QUANTISE_H
#define GLINT_BAKE_FIT_QUANTISE_H

#include "bake/fit/fitted.h"

/* Limit of the sum of the coefficients' magnitudes. */
#define GLINT_COEF_LIMIT (INT64_C(1) << 29)

/* One output. The last N_NARROW coefficients in ORDER are multiples of
 * 2^SHIFT; divided by it, they fit 16 bits. */
struct glint_quantised_output {
    int32_t exponent;
    int32_t *coef; /* [sets][n_terms]; owned */
    int n_narrow, shift;
    int head; /* as in struct glint_model_output; energy only */
    uint8_t order[GLINT_MAX_MODEL_TERMS]; /* indices of the terms in the order
                                             of the file */
    uint32_t bound, rounding_q8;
    bool proven;
};

struct glint_quantised_system {
    struct glint_quantised_output output[GLINT_OUT_KINDS];
    int32_t box_exponent;
    int32_t *box; /* owned */
    int n_box;
};

/* Quantises SYSTEM. Returns GLINT_E_LENS if a number is not finite or the
 * proof fails; may return GLINT_E_MEMORY. The caller must call
 * glint_quantised_finish() on OUT even after an error. */
enum glint_status glint_quantise(const struct glint_fitted_system *system,
                                 struct glint_quantised_system *out);

void glint_quantised_finish(struct glint_quantised_system *system);

#endif
