/* SPDX-License-Identifier: MIT
 *
 * Reconstructs the pose of a body, frame by frame, from the positions of static
 * foods in its axes.
 *
 *     glint_localiser_init(&localiser, true);
 *     glint_localise(&localiser, n, seen, is_new, &located);        each frame
 *
 * Frame 0 is at the origin and not turned. A pose is found from the foods whose
 * places are known; then new foods get theirs by it. With an average each place
 * is the mean, over all frames of a food's life so far, of its place as
 * computed from the others: the error of a single frame is not passed on from
 * food to food. */
#ifndef GLINT_BAKE_MOTION_LOCALISE_H
#define GLINT_BAKE_MOTION_LOCALISE_H

#include "bake/motion/rigid.h"
#include "glint/scene/motion.h"

struct glint_localiser {
    bool average; /* over a food's life */
    double place[GLINT_MOTION_MAX_FOODS][3];
    double age[GLINT_MOTION_MAX_FOODS]; /* number of frames that the food's
                                           position is averaged over */
    bool has_begun;                     /* private */
};

struct glint_located {
    struct glint_rigid pose;
    int n_known;     /* number of foods that the pose is fitted to */
    double residual; /* max distance of one of these foods from its expected
                        position */
};

void glint_localiser_init(struct glint_localiser *localiser, bool average);

/* Adds the next frame: the positions SEEN of N foods, in the body's axes; foods
 * marked NEW were not seen before. N must be the same for all frames. Returns
 * NULL, or the error as static text; then there is no pose. */
const char *glint_localise(struct glint_localiser *localiser, int n,
                           const double (*seen)[3], const bool *is_new,
                           struct glint_located *located);

#endif
