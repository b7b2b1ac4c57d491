/* SPDX-License-Identifier: MIT
 *
 * Predicts the cost of a frame from its plan: counts that the plan has or
 * computes cheaply, times the cost of each. */
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
    int every;     /* only one of so many bundles is evaluated; 0, 1: all are */
    bool can_half; /* true: the picture is in codes */
    bool can_dim;  /* true: three waves, so that ghosts may be dim */
    double code;   /* light of a code near black; 0: linear */
    double n_star; /* pixels that parts of stars give light to */
    double n_veil; /* pixels under a veil, and what spreads it as such */
    /* Shade of the stop, all of its tables; NULL: there is none. */
    const struct glint_shade *shade;
    struct glint_dials dials; /* dials that the frame was planned with */
};

/* Predicts the cost of the bundles of PLAN if the dials were THEN. Their
 * fineness must be within a factor of 4 of the planned one, or grids at the
 * limits are misjudged. */
struct glint_cost glint_cost_of(const struct glint_cost_plan *plan,
                                const struct glint_dials *then);

/* Returns millions of instructions of a processor with 8 lanes of 32 bits;
 * multiplied by their time on this machine that is the frame's time. Fitted to
 * counts of callgrind. */
double glint_cost_minsn(const struct glint_cost *cost);

#endif
