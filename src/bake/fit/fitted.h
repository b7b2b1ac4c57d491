/* SPDX-License-Identifier: MIT
 *
 * A fitted ghost in double precision, before it is quantised. Its structure is
 * that of glint/model.h.
 */
#ifndef GLINT_BAKE_FIT_FITTED_H
#define GLINT_BAKE_FIT_FITTED_H

#include "bake/regress/regress.h"
#include "glint/model.h"
#include "glint/status.h"

/* One output (a polynomial). It owns COEF[n_terms]. */
struct glint_fitted_output {
    enum glint_channel kind;
    int n_terms; /* 1 .. GLINT_MAX_MODEL_TERMS */
    uint8_t power[GLINT_MAX_MODEL_TERMS][GLINT_VARIABLES];
    double *coef;
    double grain; /* max harmless rounding error of a coefficient; 0: no
                     rounding */
    int event;   /* index of the barrel's event on the path; only for barrels */
    int roots;   /* number of times that the polynomial is squared to give the
                    energy */
    double most; /* largest value of the energy's polynomial where light passes;
                    0: unknown */
    bool met;    /* true: the fit meets its tolerance */
};

struct glint_fitted_system {
    /* Index of the ghost, and of the part of its pupil, from 0. */
    int ghost, part;
    int annulus; /* ring of the pupil, as in struct glint_model_system */
    double sine_lo, sine_hi;
    bool skew; /* true: a system for directions in two dimensions: x components
                  sine_lo .. sine_hi, y components y_lo .. y_hi */
    double y_lo, y_hi;
    double wave_lo, wave_hi; /* 1 / wavelength^2, um^-2 */
    double *box;             /* mm, in the layout of the model file; owned */
    int n_outputs;
    struct glint_fitted_output output[GLINT_OUT_KINDS]; /* sorted by kind */
    bool met;
};

/* All systems of one ghost, in the order of the model file. Owns SYSTEM. */
struct glint_fitted_ghost {
    int n_systems;
    struct glint_fitted_system *system;
};

/* Moves the systems of part PART to OUT, which must be empty. May return
 * GLINT_E_MEMORY. */
enum glint_status glint_fitted_part(struct glint_fitted_ghost *ghost, int part,
                                    struct glint_fitted_ghost *out);

/* Appends SYSTEM; GHOST then owns it. May return GLINT_E_MEMORY. */
enum glint_status glint_fitted_append(struct glint_fitted_ghost *ghost,
                                      const struct glint_fitted_system *system);

/* Frees the memory that SYSTEM owns. */
void glint_fitted_drop(struct glint_fitted_system *system);

void glint_fitted_finish(struct glint_fitted_ghost *ghost);

#endif
