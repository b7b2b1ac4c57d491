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
    double age[GLINT_MOTION_MAX_FOODS]; /* frames that its place is a mean of */
    bool has_begun;                     /* private */
};

struct glint_located {
    struct glint_rigid pose;
    int n_known;     /* foods that it is found from */
    double residual; /* the most by which one of them was seen elsewhere */
};

void glint_localiser_init(struct glint_localiser *localiser, bool average);

/* Takes the N foods that are SEEN in the next frame, in the body's axes; those
 * that are NEW were not seen before. Returns NULL, or what is wrong, in static
 * text; the pose is then not to be had. N is the same for all frames. */
const char *glint_localise(struct glint_localiser *localiser, int n,
                           const double (*seen)[3], const bool *is_new,
                           struct glint_located *located);

#endif
