/* SPDX-License-Identifier: MIT
 *
 * Reconstructs the pose of a body in each frame from the positions of static
 * landmarks (foods), which are given in the body's axes.
 *
 *     glint_localiser_init(&localiser, true);
 *     glint_localise(&localiser, n, seen, is_new, &located);        each frame
 *
 * In frame 0 the body is at the origin, not rotated. A pose is fitted to the
 * foods whose positions are known; it then gives the positions of new foods. If
 * averaging is on, the position of a food is the mean over its frames so far,
 * each computed from the pose of the other foods. So the error of a single
 * frame is not passed on from food to food.
 */
#ifndef GLINT_BAKE_MOTION_LOCALISE_H
#define GLINT_BAKE_MOTION_LOCALISE_H

#include "bake/motion/rigid.h"
#include "glint/scene/motion.h"

struct glint_localiser {
    bool average; /* true: average positions over the life of each food */
    double place[GLINT_MOTION_MAX_FOODS][3];
    double age[GLINT_MOTION_MAX_FOODS]; /* number of frames averaged for each
                                           food */
    bool has_begun;                     /* private */
};

struct glint_located {
    struct glint_rigid pose;
    int n_known;     /* number of foods that the pose is fitted to */
    double residual; /* max distance of one of these foods from its expected
                        position */
};

void glint_localiser_init(struct glint_localiser *localiser, bool average);

/* Processes the next frame: positions SEEN of N foods, in the body's axes;
 * foods marked NEW were not seen before. N must be the same for all frames.
 * Returns NULL, or the error as static text; there is no pose then. */
const char *glint_localise(struct glint_localiser *localiser, int n,
                           const double (*seen)[3], const bool *is_new,
                           struct glint_located *located);

#endif
