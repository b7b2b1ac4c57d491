/* SPDX-License-Identifier: MIT
 *
 * Converts the doubles of a fit into the integers of a model, and proves that
 * they cannot overflow.
 *
 *   in   a fitted system
 *   out  integer coefficients and exponents; for each output a proven bound on
 *        every intermediate of src/lens/transfer*.c and on how far rounding can
 *        take its result from the polynomial
 *
 * Method: interval arithmetic over the whole domain, operation by operation as
 * the run time does them: angle and wavelength into the coefficients, v into
 * the row, Horner's rule along u. Interpolated coefficients lie between those
 * of two knots, so the range of both is taken. */
#ifndef GLINT_BAKE_FIT_QUANTISE_H
#define GLINT_BAKE_FIT_QUANTISE_H

#include "bake/fit/fitted.h"

/* Limit of the sum of coefficients' magnitudes. */
#define GLINT_COEF_LIMIT (INT64_C(1) << 29)

/* One output. The last N_NARROW coefficients in ORDER fit 16 bits when divided
 * by 2^SHIFT; here they are multiples of that. */
struct glint_quantised_output {
    int32_t exponent;
    int32_t *coef; /* [sets][n_terms]; owned */
    int n_narrow, shift;
    int head;                             /* as in struct glint_model_output */
    uint8_t order[GLINT_MAX_MODEL_TERMS]; /* indices of the terms in the file's
                                             order */
    uint32_t bound, rounding_q8;
    bool proven;
};

struct glint_quantised_system {
    struct glint_quantised_output output[GLINT_OUT_KINDS];
    int32_t box_exponent;
    int32_t *box; /* owned */
    int n_box;
};

/* Quantises SYSTEM. GLINT_E_MEMORY. GLINT_E_LENS: a number is not finite, or
 * the proof fails. The caller finishes OUT in any case. */
enum glint_status glint_quantise(const struct glint_fitted_system *system,
                                 struct glint_quantised_system *out);

void glint_quantised_finish(struct glint_quantised_system *system);

#endif
