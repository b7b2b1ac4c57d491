/* SPDX-License-Identifier: MIT
 *
 * Measures the errors of a model: random rays that get through are traced
 * exactly and sent through the integers of the run time. */
#ifndef GLINT_BAKE_MEASURE_MODEL_H
#define GLINT_BAKE_MEASURE_MODEL_H

#include "bake/fit/fitted.h"
#include "bake/visible/visible.h"
#include "glint/model.h"

struct glint_errors {
    double rms, p50, p99, max;
};

struct glint_measured {
    int rays; /* number of rays that got through */
    /* besides RAYS, rays that the model lets through although the real lens
     * does not: they fail, or lie more than 3 % outside a surface's
     * semi-diameter or the stop's radius */
    int intruders;
    struct glint_errors of[GLINT_OUT_KINDS]; /* errors of each output, in the
                                                model file's units */
};

/* Measures system SYSTEM of LENS, which was made from FITTED. Deterministic. */
void glint_measure_system(const struct glint_visible *visible,
                          const struct glint_lens *lens, int system,
                          const struct glint_fitted_system *fitted,
                          struct glint_measured *out);

#endif
