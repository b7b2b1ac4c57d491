/* SPDX-License-Identifier: MIT
 *
 * Chooses the set of waves of each ghost.
 *
 *   in   a flare whose plan has sets; how many ghosts and lights there are
 *   out  bundles, as of glint_plan_bundle(), one after the other
 *
 * Method: all ghosts are planned with the first set, which states which can be
 * seen and how bright they are. Rays of its two outermost waves are sent
 * through the same places of the pupil's box. The box follows the outline from
 * wave to wave, so the distance at which two such rays land is that of the
 * outlines. Ghosts that need more waves are planned again with a larger set.
 * From one of n waves to the next, light changes by about 5 / n of the ghost's
 * light in the channel where the change is largest; a tenth of that is compared
 * with the step that may show. */
#ifndef GLINT_FLARE_WAVE_SETS_H
#define GLINT_FLARE_WAVE_SETS_H

#include "flare/state.h"

struct glint_wave_planner {
    /* Plans N_JOBS pairs of a ghost and a light, all ghosts of the first light
     * first. Returns how many bundles that makes, and sets the statistics of
     * what was needed. */
    int (*plan)(struct glint_flare *flare, int n_jobs);
};

/* Returns the set that wave WAVE belongs to. */
int glint_wave_sets_of(const struct glint_wave_sets *sets, int wave);

#endif
