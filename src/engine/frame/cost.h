/* SPDX-License-Identifier: MIT
 *
 * Predicts the cost of a frame from its plan: counts that the plan knows or
 * finds cheaply, times the cost of each. */
#ifndef GLINT_ENGINE_FRAME_COST_H
#define GLINT_ENGINE_FRAME_COST_H

#include <stdbool.h>

#include "glint/dials.h"
#include "glint/flare.h"

/* Kinds of items whose number decides the cost: of a plan, before anything is
 * drawn, or of a frame that was drawn (engine/explain.h). */
enum glint_cost_kind {
    GLINT_COST_LOOKED_AT, /* bundles that a plan looks at, or for a drawn frame
                             the rays that it traced for them */
    GLINT_COST_BUNDLES,  /* bundles drawn: a few rays each, and a polynomial for
                            each row */
    GLINT_COST_VERTICES, /* vertices of grids */
    GLINT_COST_EDGES,    /* edges across which light changes */
    GLINT_COST_ROWS,     /* rows of pixels that edges cross */
    GLINT_COST_PARTS,    /* parts of cells that dust or a mask shades */
    GLINT_COST_LIT,      /* pixels with any light */
    GLINT_COST_STAR,     /* pixels that parts of stars give light to */
    GLINT_COST_VEIL,     /* pixels under a veil, and what spreads it as such */
    GLINT_COST_KINDS
};

/* The cost of one item, in thousand instructions of a processor with 8 lanes of
 * 32 bits. */
struct glint_cost_weight {
    const char *name;
    double planned; /* weight for counts that glint_cost_of() predicts from a
                       plan */
    double counted; /* weight for counts of a frame that was drawn */
};
extern const struct glint_cost_weight glint_cost_weight[GLINT_COST_KINDS];

struct glint_cost {
    double count[GLINT_COST_KINDS];
};

/* A frame that was planned, not yet binned. */
struct glint_cost_plan {
    const struct glint_flare *flare;
    int width, height;  /* size of the picture */
    double n_looked_at; /* rays that the plan looked at */
    int every; /* bundles of which one stands for all; 0, 1: each for itself */
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
