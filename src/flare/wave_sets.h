/* SPDX-License-Identifier: MIT
 *
 * Which set of waves a ghost takes.
 *
 *   in   a flare whose plan has sets; how many ghosts and lights there are
 *   out  bundles, as of glint_plan_bundle(), one after the other
 *
 * Method: all ghosts are planned with the first set, which says which can be
 * seen and how bright they are. Rays of its two outermost waves through the
 * same places of the pupil's box, which follows the outline from wave to wave,
 * land as far apart as their outlines are. Those that need more waves are
 * planned anew. Light between two waves takes a step of about 5 / n of the
 * ghost's, in the channel where it is largest.
 */
#ifndef GLINT_FLARE_WAVE_SETS_H
#define GLINT_FLARE_WAVE_SETS_H

#include "flare/state.h"

struct glint_wave_planner {
    /* Plans N_JOBS pairs of a ghost and a light, ghosts first; returns how many
     * bundles there are, and sets the statistics of what was needed. */
    int (*plan)(struct glint_flare *flare, int n_jobs);
};

/* First wave of set SET. */
int glint_wave_sets_first(const struct glint_wave_sets *sets, int set);

/* The set of wave WAVE. */
int glint_wave_sets_of(const struct glint_wave_sets *sets, int wave);

#endif
