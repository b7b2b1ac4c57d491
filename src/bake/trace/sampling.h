/* SPDX-License-Identifier: MIT
 *
 * Samples a ghost by a sparse grid of rays.
 *
 *   in   a path, a light in the x-z plane, the visible region of the pupil
 *   out  the barrels that block rays, the nonlinearity of positions, whether
 *        some of the light arrives mirrored and some does not
 *
 * Most surfaces are wider than the beam through the stop: of dozens of
 * surfaces, only a few vignette the beam. A barrel counts if it is the first
 * obstacle between a visible and a blocked ray, with a margin for the gaps
 * between rays.
 */
#ifndef GLINT_BAKE_TRACE_SAMPLING_H
#define GLINT_BAKE_TRACE_SAMPLING_H

#include "glint/trace.h"

enum { GLINT_MAX_SAMPLING = 96 };

struct glint_sampling {
    int n_cuts;
    /* barrels that block rays: indices among the path's events, ascending */
    int cut_event[GLINT_MAX_EVENTS];
    /* weight of each barrel, which increases with the length of the outline
     * that it forms */
    int cut_weight[GLINT_MAX_EVENTS];
    /* Second difference of the sensor position over the pupil box, RMS over
     * visible rays, mm. A grid of n cells per side has the error bend_mm / (8
     * n^2). */
    double bend_mm;
    /* Nonlinearity of the ghost's outline, mm on the sensor: the max of the
     * second differences of the stop position and of the radii at those barrels
     * that block rays. */
    double outline_mm;
    /* second difference of the outline of a circular stop, mm on the sensor */
    double round_mm;
    /* number of differences averaged in bend_mm: a visible ray counts once for
     * each of its two grid lines on which both neighbours are valid */
    int n_inside;
    /* Size of the pupil box when it is projected to the stop, in stop radii.
     * Extrapolated from the harmonic mean distance of neighbouring rays between
     * which the opening may lie. */
    double step;
    bool folds; /* true: some of the light arrives mirrored and some does not */
};

/* Traces SIDE x SIDE cells over PUPIL for light along DIRECTION. SIDE: even, at
 * most GLINT_MAX_SAMPLING. */
void glint_sampling_trace_grid(struct glint_sampling *sampling,
                               const struct glint_path *path,
                               const struct glint_pupil *pupil,
                               const double direction[3], double stop_radius_mm,
                               int side);

#endif
