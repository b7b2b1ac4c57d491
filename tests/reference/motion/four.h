/* SPDX-License-Identifier: MIT
 *
 * Localises a body by four foods, as published [Bodonyi26]: a point has weights
 * with respect to the positions of four foods, which do not change when these
 * move. The interface is that of glint_localiser (bake/motion/localise.h).
 */
#ifndef REFERENCE_MOTION_FOUR_H
#define REFERENCE_MOTION_FOUR_H

#include "bake/motion/localise.h"

enum four_fit {
    FOUR_BEST,  /* weights with respect to the four foods that span the largest
                   volume */
    FOUR_FIRST, /* weights with respect to the first four foods */
    FOUR_CHAIN  /* product of the motions from frame to frame */
};

/* FOUR_FLOAT32 rounds every result to float. The bits are those of float
 * arithmetic, as double has more than twice its digits. */
enum four_arithmetic { FOUR_DOUBLE, FOUR_FLOAT32 };

struct four {
    enum four_fit fit;
    enum four_arithmetic arithmetic;
    bool has_begun;
    double place[GLINT_MOTION_MAX_FOODS][3];
    /* positions seen in the previous frame */
    double last[GLINT_MOTION_MAX_FOODS][3];
    double chain[4][3]; /* product of the motions of all frames so far, by
                           columns */
};

/* Returns X rounded to ARITHMETIC. */
double four_rounded(enum four_arithmetic arithmetic, double x);

void four_init(struct four *four, enum four_fit fit,
               enum four_arithmetic arithmetic);

/* Like glint_localise(), but sets only the pose of LOCATED. */
const char *four_localise(struct four *four, int n, const double (*seen)[3],
                          const bool *is_new, struct glint_located *located);

#endif
