/* SPDX-License-Identifier: MIT
 *
 * Rounds the doubles of a fitted system to the integers of a model and proves
 * that these cannot overflow at run time.
 *
 *   in   a fitted system
 *   out  integer coefficients and exponents; for each output proven upper
 *        bounds of all intermediate results of src/lens/transfer*.c and of the
 *        rounding error
 *
 * Method: interval arithmetic over the whole domain, with the run time's
 * operations in their order: angle and wavelength are substituted into the
 * coefficients, then v, then Horner's rule is applied along u. A coefficient
 * interpolated between two knots lies between both values, so the interval of
 * both covers it.
 */
#ifndef GLINT_BAKE_FIT_QUANTISE_H
#define GLINT_BAKE_FIT_QUANTISE_H

#include "bake/fit/fitted.h"

/* limit of the sum of the magnitudes of an output's coefficients */
#define GLINT_COEF_LIMIT (INT64_C(1) << 29)

/* The integers of one output. The last n_narrow coefficients, in the order of
 * order, are multiples of 2^shift and fit 16 bits after division by 2^shift. */
struct glint_quantised_output {
    int32_t exponent;
    int32_t *coef; /* integer coefficients, [sets][n_terms]; owned */
    int n_narrow, shift;
    /* scale of the energy, as in struct glint_model_output; energy only */
    int head;
    /* indices of the terms in file order */
    uint8_t order[GLINT_MAX_MODEL_TERMS];
    uint32_t bound, rounding_q8;
    bool proven;
};

struct glint_quantised_system {
    struct glint_quantised_output output[GLINT_OUT_KINDS];
    int32_t box_exponent;
    int32_t *box; /* owned */
    int n_box;
};

/* Quantises SYSTEM. If its fit has diverged, sets all outputs to 0, so that the
 * ghost has no light in this zone. Returns GLINT_E_LENS if a value is not
 * finite or the proof fails, or GLINT_E_MEMORY. The caller must call
 * glint_quantised_free_system() on OUT even after an error. */
enum glint_status
glint_quantise_system(const struct glint_fitted_system *system,
                      struct glint_quantised_system *out);

void glint_quantised_free_system(struct glint_quantised_system *system);

#endif
