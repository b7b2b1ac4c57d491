/* SPDX-License-Identifier: MIT
 *
 * Chooses the set of waves of each ghost.
 *
 *   in   a flare whose plan has sets of waves; numbers of ghosts and lights
 *   out  bundles as by glint_plan_bundle(), one after the other
 *
 * Method: all ghosts are planned with the first set, which finds the visible
 * ghosts and their brightness. Rays of the first set's two outermost waves are
 * then traced through the same points of the pupil's box. The box follows the
 * outline from wave to wave, so the distance between two such rays on the
 * sensor is the distance between the two outlines. Ghosts that need more waves
 * are planned again with a larger set. From one of n waves to the next, light
 * changes by at most about 5 / n of the ghost's light in any channel; a tenth
 * of that is compared with the smallest visible step. */
#ifndef GLINT_FLARE_WAVE_SETS_H
#define GLINT_FLARE_WAVE_SETS_H

#include "flare/state.h"

struct glint_wave_planner {
    /* Plans N_JOBS pairs of a ghost and a light; all ghosts of the first light
     * come first. Returns the number of bundles, and sets the statistics of
     * needed and dropped bundles. */
    int (*plan)(struct glint_flare *flare, int n_jobs);
};

/* Returns the set that wave WAVE belongs to. */
int glint_wave_sets_find_set(const struct glint_wave_sets *sets, int wave);

#endif
