/* SPDX-License-Identifier: MIT
 *
 * Samples a ghost by a sparse grid of rays.
 *
 *   in   a path, a light in the x-z plane, the part of the pupil that counts
 *   out  the barrels that cut, how much the light bends, whether it folds
 *
 * Most surfaces are wider than the beam through the stop: of dozens, none, one
 * or two vignette it. A barrel cuts if it is the first obstacle between a ray
 * that passes and one that does not, with a margin for the gaps between rays.
 */
#ifndef GLINT_BAKE_TRACE_SAMPLING_H
#define GLINT_BAKE_TRACE_SAMPLING_H

#include "glint/trace.h"

enum { GLINT_MAX_SAMPLING = 96 };

struct glint_sampling {
    int n_cuts;
    int cut_event[GLINT_MAX_EVENTS];  /* index into the path, rising */
    int cut_weight[GLINT_MAX_EVENTS]; /* a larger weight: the barrel makes up
                                         more of the outline */
    double bend_mm; /* second difference of the sensor position over the pupil's
                       box, RMS over the rays that pass: a grid of n cells per
                       side has an error of bend_mm / (8 n^2) */
    double outline_mm; /* the largest such bend of the stop position or of a
                          barrel that cuts, converted to mm on the sensor */
    double round_mm;   /* such a bend of a round stop's outline */
    int n_inside; /* number of rays that pass and have both neighbours along a
                     line of the grid, across and down counted apart */
    /* Distance in the stop, in stop radii, that rays cover over the pupil's
     * box: harmonic mean over neighbouring rays between which the opening may
     * lie. */
    double step;
    bool folds; /* true: some of the light arrives mirrored, some does not */
};

/* Traces a grid of SIDE x SIDE cells (SIDE even, up to GLINT_MAX_SAMPLING) over
 * PUPIL. */
void glint_sampling_run(struct glint_sampling *sampling,
                        const struct glint_path *path,
                        const struct glint_pupil *pupil,
                        const double direction[3], double stop_radius_mm,
                        int side);

#endif
