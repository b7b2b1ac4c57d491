/* SPDX-License-Identifier: MIT
 *
 * Measures the errors of a model: compares exactly traced random rays with the
 * run time's integer polynomials.
 */
#ifndef GLINT_BAKE_MEASURE_MODEL_H
#define GLINT_BAKE_MEASURE_MODEL_H

#include "bake/fit/fitted.h"
#include "bake/visible/visible.h"
#include "glint/model.h"

struct glint_errors {
    double rms, p50, p99, max;
};

struct glint_measured {
    int rays; /* number of rays that pass the real lens */
    /* number of rays that the model transmits although the real lens blocks
     * them. A ray counts if it misses a surface, or if it lies more than 3 %
     * outside a surface's semi-diameter or the stop's radius. Not included in
     * RAYS. */
    int intruders;
    struct glint_errors of[GLINT_OUT_KINDS]; /* errors per output, in the units
                                                of the model file */
};

/* Measures system SYSTEM of LENS, which was quantised from FITTED.
 * Deterministic. */
void glint_measure_system_errors(const struct glint_visible *visible,
                                 const struct glint_lens *lens, int system,
                                 const struct glint_fitted_system *fitted,
                                 struct glint_measured *out);

#endif
