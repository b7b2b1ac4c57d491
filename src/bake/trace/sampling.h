/* SPDX-License-Identifier: MIT
 *
 * Samples a ghost by a sparse grid of rays.
 *
 *   in   a path, a light in the x-z plane, the visible part of the pupil
 *   out  the barrels that cut, the nonlinearity of positions, whether light
 *        folds
 *
 * Most surfaces are wider than the beam through the stop. Of dozens of
 * surfaces, at most a few vignette the beam. A barrel cuts if it is the first
 * obstacle between a visible and a blocked ray, with a margin for the gaps
 * between rays.
 */
#ifndef GLINT_BAKE_TRACE_SAMPLING_H
#define GLINT_BAKE_TRACE_SAMPLING_H

#include "glint/trace.h"

enum { GLINT_MAX_SAMPLING = 96 };

struct glint_sampling {
    int n_cuts;
    int cut_event[GLINT_MAX_EVENTS];  /* events of the path, ascending */
    int cut_weight[GLINT_MAX_EVENTS]; /* number that grows with the barrel's
                                         part of the outline */
    double bend_mm; /* second difference of the sensor position over the pupil
                       box, RMS over visible rays: a grid of n cells per side
                       has the error bend_mm / (8 n^2) */
    /* max of the second differences of the stop position and of the barrels
     * that cut, converted to mm on the sensor */
    double outline_mm;
    double round_mm; /* second difference of the outline of a round stop,
                        converted likewise */
    int n_inside; /* number of visible rays with both neighbours along a line of
                     the grid; counted once per direction of lines */
    /* Distance in the stop, in stop radii, that rays cover over the pupil
     * box: harmonic mean over neighbouring rays between which the opening
     * may lie. */
    double step;
    bool folds; /* true: some of the light arrives mirrored, some does not */
};

/* Traces a grid of SIDE x SIDE cells over PUPIL; SIDE is even, at most
 * GLINT_MAX_SAMPLING. */
void glint_sampling_run(struct glint_sampling *sampling,
                        const struct glint_path *path,
                        const struct glint_pupil *pupil,
                        const double direction[3], double stop_radius_mm,
                        int side);

#endif
