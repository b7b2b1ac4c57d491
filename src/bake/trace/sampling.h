/* SPDX-License-Identifier: MIT
 *
 * What a sparse grid of rays tells of a ghost.
 *
 *   in   a path, a light in the x-z plane, the part of the pupil that counts
 *   out  the barrels that cut, how much the light bends, whether it
 *        folds
 *
 * Most surfaces are wider than the light that the stop lets through: of dozens,
 * none, one or two really cut. A barrel cuts where it is met first between a
 * ray that passes and one that does not, with a margin for what lies between
 * the rays that were asked.
 */
#ifndef GLINT_BAKE_TRACE_SAMPLING_H
#define GLINT_BAKE_TRACE_SAMPLING_H

#include "glint/trace.h"

enum { GLINT_MAX_SAMPLING = 96 };

struct glint_sampling {
    int n_cuts;
    int cut_event[GLINT_MAX_EVENTS];  /* index into the path, rising */
    int cut_weight[GLINT_MAX_EVENTS]; /* the larger, the more of the outline it
                                         is */
    double bend_mm;    /* second difference of the sensor position over one step
                          that spans the pupil's box, RMS of the rays that pass:
                          a grid of n cells is off by bend / (8 n^2) */
    double outline_mm; /* the same of what the stop and the barrels cut by, the
                          one that bends most */
    double round_mm;   /* the same of a round stop's outline */
    int n_inside;      /* rays that pass, with neighbours that arrive */
    double step;       /* stop radii over the pupil's box, harmonic mean of
                          neighbouring rays that the opening may lie between */
    bool folds;        /* some light arrives turned over, some does not */
};

/* Asks a grid of SIDE cells a side (even, up to GLINT_MAX_SAMPLING) over PUPIL.
 */
void glint_sampling_run(struct glint_sampling *sampling,
                        const struct glint_path *path,
                        const struct glint_pupil *pupil,
                        const double direction[3], double stop_radius_mm,
                        int side);

#endif
