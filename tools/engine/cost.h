/* SPDX-License-Identifier: MIT
 *
 * What a frame will take, from its plan: counts that the plan knows or tells
 * cheaply, times what each takes.
 */
#ifndef GLINT_TOOLS_ENGINE_COST_H
#define GLINT_TOOLS_ENGINE_COST_H

#include "engine/frame.h"

/* Counts of what is worked through. */
enum cost_kind {
    COST_BUNDLES,  /* that are drawn: a few rays, and a polynomial each row */
    COST_VERTICES, /* of grids */
    COST_EDGES,    /* across which light changes */
    COST_ROWS,     /* of pixels that these cross */
    COST_LIT,      /* pixels with any light */
    COST_KINDS
};

struct cost {
    double count[COST_KINDS];
};

/* Of the bundles that F's flare has planned, if fineness, steps of irradiance
 * and half were as in THEN (F itself: as they are). Of fineness within a factor
 * of 4 of the planned one, or grids at the limits are misjudged. */
struct cost cost_of(const struct frame *f, const struct frame *then);

/* Instructions, in millions, of a processor with 8 lanes of 32 bits; times what
 * one takes on this machine it is time. Fitted to counts of callgrind. */
double cost_minsn(const struct cost *cost);

#endif
