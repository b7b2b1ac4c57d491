/* SPDX-License-Identifier: MIT
 *
 * What a frame will take, from its plan: counts that the plan knows or tells
 * cheaply, times what each takes.
 */
#ifndef GLINT_ENGINE_FRAME_COST_H
#define GLINT_ENGINE_FRAME_COST_H

#include <stdbool.h>

#include "glint/dials.h"
#include "glint/flare.h"

/* Counts of what is worked through. */
enum glint_cost_kind {
    GLINT_COST_BUNDLES, /* that are drawn: a few rays, and a polynomial each row
                         */
    GLINT_COST_VERTICES, /* of grids */
    GLINT_COST_EDGES,    /* across which light changes */
    GLINT_COST_ROWS,     /* of pixels that these cross */
    GLINT_COST_LIT,      /* pixels with any light */
    GLINT_COST_KINDS
};

struct glint_cost {
    double count[GLINT_COST_KINDS];
};

/* A frame that was planned, not yet binned. */
struct glint_cost_plan {
    const struct glint_flare *flare;
    int width, height;        /* of the picture */
    double n_looked_at;       /* bundles */
    bool can_half;            /* it is in codes, by edges */
    struct glint_dials dials; /* that it was planned with */
};

/* Of the bundles of PLAN, if dials were THEN. Of fineness within a factor of 4
 * of the planned one, or grids at the limits are misjudged. */
struct glint_cost glint_cost_of(const struct glint_cost_plan *plan,
                                const struct glint_dials *then);

/* Instructions, in millions, of a processor with 8 lanes of 32 bits; times what
 * one takes on this machine it is time. Fitted to counts of callgrind. */
double glint_cost_minsn(const struct glint_cost *cost);

#endif
