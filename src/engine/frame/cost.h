/* SPDX-License-Identifier: MIT
 *
 * Predicts the cost of a frame from its plan: counts of operations, known from
 * the plan or cheap to estimate, times the cost of each operation.
 */
#ifndef GLINT_ENGINE_FRAME_COST_H
#define GLINT_ENGINE_FRAME_COST_H

#include <stdbool.h>

#include "glint/dials.h"
#include "glint/explain.h"
#include "glint/flare.h"

struct glint_cost {
    double count[GLINT_COST_KINDS];
};

/* A frame that was planned, not yet binned. */
struct glint_cost_plan {
    const struct glint_flare *flare;
    int width, height;  /* size of the picture */
    double n_looked_at; /* rays that the plan probed */
    int every;     /* every EVERY-th bundle is evaluated, as a sample; 0, 1: all
                      bundles are */
    bool can_half; /* true: half resolution is possible, as the picture is in
                      codes */
    bool can_dim;  /* true: dim ghosts may share rays, as three wavelengths are
                      drawn */
    double code;   /* light of one code near black; 0: linear picture */
    double n_star; /* number of pixels lit by stars */
    double n_veil; /* cost of the veil, in pixels */
    /* Shade of the stop, all of its tables; NULL: there is none. */
    const struct glint_shade *shade;
    struct glint_dials dials; /* dials that the frame was planned with */
};

/* Predicts the cost of the bundles of PLAN for the dials THEN. Their
 * fineness must be within a factor of 4 of the planned one; outside this
 * range, grids at their size limits are mispredicted. */
struct glint_cost glint_cost_of(const struct glint_cost_plan *plan,
                                const struct glint_dials *then);

/* Returns millions of instructions on a processor with 8 lanes of 32 bits.
 * The frame's time is this number times the time per million instructions on
 * this machine. Fitted to counts by callgrind. */
double glint_cost_to_minsn(const struct glint_cost *cost);

#endif
