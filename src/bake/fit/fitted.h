/* SPDX-License-Identifier: MIT
 *
 * A fitted ghost in double precision, before it is quantised. Same structure
 * as in glint/model.h.
 */
#ifndef GLINT_BAKE_FIT_FITTED_H
#define GLINT_BAKE_FIT_FITTED_H

#include "bake/regress/regress.h"
#include "glint/model.h"
#include "glint/status.h"

/* One output of a system: a polynomial. It owns coef, [n_terms]. */
struct glint_fitted_output {
    enum glint_channel kind;
    int n_terms; /* number of terms, 1 .. GLINT_MAX_MODEL_TERMS */
    uint8_t power[GLINT_MAX_MODEL_TERMS][GLINT_VARIABLES];
    double *coef;
    /* max rounding error of a coefficient that is harmless; 0: coefficients
     * must not be rounded to 16 bits */
    double grain;
    int event; /* barrels only: index of the barrel among the path's events */
    /* barrels only: rays end at the event by their angle (critical.h), not at
     * a rim */
    bool critical;
    /* energy only: number of times that the polynomial's value is squared to
     * get the energy */
    int roots;
    /* energy only: max value of the polynomial over rays that reach the sensor;
     * 0: unknown */
    double most;
    bool met; /* true: the fit meets its tolerance */
};

struct glint_fitted_system {
    /* index of the ghost, and of the part of its pupil, from 0 */
    int ghost, part;
    /* index of the ring of the pupil, as in struct glint_model_system */
    int annulus;
    double sine_lo, sine_hi;
    /* true: lens that is not round; directions have two components, x in
     * sine_lo .. sine_hi and y in y_lo .. y_hi */
    bool skew;
    double y_lo, y_hi;
    double wave_lo, wave_hi; /* range of 1 / wavelength^2, um^-2 */
    /* polynomials of the box, mm, ordered as in the model file; owned */
    double *box;
    int n_outputs;
    /* outputs, sorted by kind */
    struct glint_fitted_output output[GLINT_OUT_KINDS];
    bool met;
};

/* All systems of one ghost, in the order of the model file. Owns the array
 * system. */
struct glint_fitted_ghost {
    int n_systems;
    struct glint_fitted_system *system;
};

/* Moves all systems of part PART of GHOST to OUT, which must be empty. May
 * return GLINT_E_MEMORY. */
enum glint_status glint_fitted_move_part(struct glint_fitted_ghost *ghost,
                                         int part,
                                         struct glint_fitted_ghost *out);

/* Appends SYSTEM to GHOST, which then owns it. May return GLINT_E_MEMORY. */
enum glint_status
glint_fitted_append_system(struct glint_fitted_ghost *ghost,
                           const struct glint_fitted_system *system);

/* Frees the memory that SYSTEM owns. */
void glint_fitted_free_system(struct glint_fitted_system *system);

void glint_fitted_free_ghost(struct glint_fitted_ghost *ghost);

#endif
