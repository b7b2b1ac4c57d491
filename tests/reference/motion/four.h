/* SPDX-License-Identifier: MIT
 *
 * Localises a body by four foods (landmarks), as published [Bodonyi26]: the
 * barycentric weights of a point with respect to four foods do not change when
 * the body moves. The interface is that of glint_localiser
 * (bake/motion/localise.h).
 */
#ifndef REFERENCE_MOTION_FOUR_H
#define REFERENCE_MOTION_FOUR_H

#include "bake/motion/localise.h"

enum four_fit {
    /* weights with respect to the four foods that span the largest volume */
    FOUR_BEST,
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
    /* food positions observed in the previous frame */
    double last[GLINT_MOTION_MAX_FOODS][3];
    /* product of the motions of all frames so far, by columns */
    double chain[4][3];
};

/* Returns X rounded to ARITHMETIC. */
double four_round_value(enum four_arithmetic arithmetic, double x);

void four_init_localiser(struct four *four, enum four_fit fit,
                         enum four_arithmetic arithmetic);

/* Like glint_localise_body(), but sets only the pose of LOCATED. */
const char *four_localise_body(struct four *four, int n,
                               const double (*seen)[3], const bool *is_new,
                               struct glint_located *located);

#endif
