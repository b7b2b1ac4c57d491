/* SPDX-License-Identifier: MIT
 *
 * Localises a body by four foods (landmarks), by the method of [Bodonyi26]:
 * the barycentric weights of a point with respect to four fixed foods do not
 * change when the body moves. The interface is that of glint_localiser
 * (bake/motion/localise.h).
 */
#ifndef REFERENCE_MOTION_FOUR_H
#define REFERENCE_MOTION_FOUR_H

#include "bake/motion/localise.h"

enum four_fit {
    /* by barycentric weights with respect to the four foods (landmarks) whose
     * tetrahedron has the largest relative volume */
    FOUR_BEST,
    /* by barycentric weights with respect to the first four foods (landmarks)
     * of the frame */
    FOUR_FIRST,
    FOUR_CHAIN /* by the product of the motions between successive frames */
};

/* FOUR_FLOAT32: every result is rounded to float. This gives the same bits as
 * float arithmetic, as double has more than twice the digits of float. */
enum four_arithmetic { FOUR_DOUBLE, FOUR_FLOAT32 };

struct four {
    enum four_fit fit;
    enum four_arithmetic arithmetic;
    bool has_begun;
    double place[GLINT_MOTION_MAX_FOODS][3];
    /* positions of the foods (landmarks) in the previous frame */
    double last[GLINT_MOTION_MAX_FOODS][3];
    /* product of the motions of all frames so far: an affine map, 3 x 4 by
     * columns */
    double chain[4][3];
};

/* Returns X rounded to the precision of ARITHMETIC. */
double four_round_value(enum four_arithmetic arithmetic, double x);

void four_init_localiser(struct four *four, enum four_fit fit,
                         enum four_arithmetic arithmetic);

/* Like glint_localise_body(), but sets only the pose of LOCATED. */
const char *four_localise_by_landmarks(struct four *four, int n,
                                       const double (*seen)[3],
                                       const bool *is_new,
                                       struct glint_located *located);

#endif
