/* SPDX-License-Identifier: MIT
 *
 * Reconstructs the pose of a body in each frame from the positions of static
 * landmarks (foods), which are measured in the body's axes.
 *
 *     glint_localiser_init(&localiser, true);
 *     in each frame:
 *         glint_localise_body(&localiser, n, seen, is_new, &located);
 *
 * In frame 0 the body is at the origin, not rotated. In later frames a pose is
 * fitted to the foods whose positions are known. The positions of new foods
 * follow from this pose. If averaging is on, the position of a food is the mean
 * over all frames so far. The position in each frame follows from the pose
 * fitted to the other foods. So the error of a single frame is not passed on
 * from food to food.
 */
#ifndef GLINT_BAKE_MOTION_LOCALISE_H
#define GLINT_BAKE_MOTION_LOCALISE_H

#include "bake/motion/rigid.h"
#include "glint/scene/motion.h"

struct glint_localiser {
    /* true: the position of a food is averaged over all its frames */
    bool average;
    double place[GLINT_MOTION_MAX_FOODS][3];
    /* [foods]: number of frames over which the food's position is averaged */
    double age[GLINT_MOTION_MAX_FOODS];
    /* true after the first frame; set by glint_localise_body() */
    bool has_begun;
};

struct glint_located {
    struct glint_rigid pose;
    int n_known; /* number of foods to which the pose is fitted */
    /* max distance between the positions of the known foods in this frame and
     * their positions estimated from earlier frames */
    double residual;
};

void glint_localiser_init(struct glint_localiser *localiser, bool average);

/* Locates the body in the next frame. SEEN: positions of N foods in the body's
 * axes. IS_NEW marks foods that occur for the first time. N must be the same
 * for all frames. Returns NULL, or an error text; the pose is not set after an
 * error. */
const char *glint_localise_body(struct glint_localiser *localiser, int n,
                                const double (*seen)[3], const bool *is_new,
                                struct glint_located *located);

#endif
