/* SPDX-License-Identifier: MIT
 *
 * Chooses, for each ghost and light, one of several sets of waves: the smallest
 * one without visible steps of colour.
 *
 *   in   a flare whose plan has sets of waves; numbers of ghosts and lights
 *   out  bundles as by glint_plan_bundle(), one after the other
 *
 * Method: all ghosts are planned with the first set, which finds the visible
 * ghosts and their brightness. Rays of the first set's two outermost
 * wavelengths are then traced through the same points of the ghost's pupil. The
 * pupil follows the ghost's outline from wavelength to wavelength, so the
 * distance between two such rays on the sensor is that between the outlines.
 * Ghosts that need more wavelengths are planned again with a larger set. From
 * one of n wavelengths to the next, light changes by at most about 5 / n of the
 * ghost's light in any channel; a tenth of that is compared with the smallest
 * visible step. */
#ifndef GLINT_FLARE_WAVE_SETS_H
#define GLINT_FLARE_WAVE_SETS_H

#include "flare/state.h"

struct glint_wave_planner {
    /* Plans N_JOBS pairs of a ghost and a light, sorted by light, then by
     * ghost. Returns the number of ray bundles. Sets the statistics of needed
     * and dropped bundles. */
    int (*plan)(struct glint_flare *flare, int n_jobs);
};

/* Returns the index of the set that contains wavelength WAVE. */
int glint_wave_sets_find_set_of_wave(const struct glint_wave_sets *sets,
                                     int wave);

#endif
