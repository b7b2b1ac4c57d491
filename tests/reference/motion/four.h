/* SPDX-License-Identifier: MIT
 *
 * Localises a body by four foods, as published [Bodonyi26]: a place has weights
 * in the places of four foods, which are the same wherever these move. Used as
 * glint_localiser is (bake/motion/localise.h). */
#ifndef REFERENCE_MOTION_FOUR_H
#define REFERENCE_MOTION_FOUR_H

#include "bake/motion/localise.h"

enum four_fit {
    FOUR_BEST,  /* weights in the four that span the most */
    FOUR_FIRST, /* weights in the first four */
    FOUR_CHAIN  /* product of the motions from frame to frame */
};

/* float32 rounds each result of double, which gives the bits of float: double
 * has more than twice its digits. */
enum four_arithmetic { FOUR_DOUBLE, FOUR_FLOAT32 };

struct four {
    enum four_fit fit;
    enum four_arithmetic arithmetic;
    bool has_begun;
    double place[GLINT_MOTION_MAX_FOODS][3];
    double last[GLINT_MOTION_MAX_FOODS][3]; /* seen one frame ago */
    double chain[4][3];                     /* of the frames so far, columns */
};

/* Returns X as ARITHMETIC has it. */
double four_rounded(enum four_arithmetic arithmetic, double x);

void four_init(struct four *four, enum four_fit fit,
               enum four_arithmetic arithmetic);

/* Sets the pose of LOCATED alone. */
const char *four_localise(struct four *four, int n, const double (*seen)[3],
                          const bool *is_new, struct glint_located *located);

#endif
