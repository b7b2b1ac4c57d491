/* SPDX-License-Identifier: MIT
 *
 * The result of a fit in double precision, before it is made integers: the
 * shape of glint/model.h without its formats. */
#ifndef GLINT_BAKE_FIT_FITTED_H
#define GLINT_BAKE_FIT_FITTED_H

#include "bake/regress/regress.h"
#include "glint/model.h"
#include "glint/status.h"

/* One output. COEF is [n_terms], owned. */
struct glint_fitted_output {
    enum glint_channel kind;
    int n_terms; /* 1 .. GLINT_MAX_MODEL_TERMS */
    uint8_t power[GLINT_MAX_MODEL_TERMS][GLINT_VARIABLES];
    double *coef;
    double grain; /* max harmless rounding error of a coefficient; 0: keep all
                     bits */
    int event;    /* event of the path, for a barrel */
    int roots;    /* times that the polynomial is squared to give the energy */
    double most;  /* largest value of the energy's polynomial where light gets
                     through; 0: unknown */
    bool met;     /* true: the tolerance was met */
};

struct glint_fitted_system {
    /* Index of the ghost, and the part of its pupil, 0, 1 ... */
    int ghost, part;
    int annulus; /* as in struct glint_model_system */
    double sine_lo, sine_hi;
    bool skew; /* true: sine_lo .. sine_hi is the range of the x component of
                  directions, y_lo .. y_hi the range of the y component */
    double y_lo, y_hi;
    double wave_lo, wave_hi; /* 1 / wavelength^2, um^-2 */
    double *box;             /* mm, with the layout of the model; owned */
    int n_outputs;
    struct glint_fitted_output output[GLINT_OUT_KINDS]; /* by rising kind */
    bool met;
};

/* All systems of one ghost, in the order of the model; owned. */
struct glint_fitted_ghost {
    int n_systems;
    struct glint_fitted_system *system;
};

/* Moves the systems of part PART to OUT, which must be empty. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_fitted_part(struct glint_fitted_ghost *ghost, int part,
                                    struct glint_fitted_ghost *out);

/* Appends SYSTEM, which GHOST owns from then on. GLINT_E_MEMORY. */
enum glint_status glint_fitted_append(struct glint_fitted_ghost *ghost,
                                      const struct glint_fitted_system *system);

/* Frees the memory that SYSTEM owns. */
void glint_fitted_drop(struct glint_fitted_system *system);

void glint_fitted_finish(struct glint_fitted_ghost *ghost);

#endif
