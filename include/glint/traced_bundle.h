/* SPDX-License-Identifier: MIT
 *
 * glint/traced_bundle.h - rays that are traced exactly, for the run-time half.
 */
#ifndef GLINT_TRACED_BUNDLE_H
#define GLINT_TRACED_BUNDLE_H

#include <stdbool.h>

#include "glint/bundle.h"
#include "glint/setup.h"
#include "glint/trace.h"
#include "glint/view.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_traced_bundle_config {
    const struct glint_setup *setup;
    struct glint_view view;
    double scale;  /* factor of all light: gain times 2^EV */
    int max_cells; /* fineness of the grids, 1 .. 1024: see
                      glint_traced_bundle_plan */
    bool uniform;  /* all ghosts get max_cells a side */
};

enum { GLINT_TRACED_CUTS = 8 };

/* One ghost, light and wavelength, the grid chosen for it and the barrels that
 * cut. A vertex holds the first barrel's value and the largest of the others'.
 */
struct glint_traced_bundle {
    const struct glint_lamp *lamp;
    int ghost, wavelength;
    struct glint_pupil pupil;
    bool found;  /* something gets through: PUPIL means something */
    int n_cells; /* 0: nothing of it is in the picture */
    int n_cuts;  /* barrels that may cut inside the stop */
    int cut_event[GLINT_TRACED_CUTS]; /* the one that cuts most comes first */
    double energy_unit;               /* energy 65536 of a vertex */
};

/* Finds the pupil and the barrels, and chooses the grid by how much the ghost's
 * light bends in pixels: off by 0.01 px (RMS), outlines by 0.1, with 64 for
 * max_cells, and by the square of it less with more; a multiple of 4 from 8 to
 * 2 max_cells, 4 max_cells where light folds, over the pupil and a pixel more
 * on each side. Lamp, ghost and wavelength are set already. */
void glint_traced_bundle_plan(const struct glint_traced_bundle_config *cfg,
                              struct glint_traced_bundle *traced,
                              const struct glint_traced_bundle *near);

/* Fills BUNDLE from TRACED, n_cells > 0, and its (n_cells + 1)^2 vertices. */
void glint_traced_bundle_make(const struct glint_traced_bundle_config *cfg,
                              const struct glint_traced_bundle *traced,
                              struct glint_bundle *bundle);
void glint_traced_bundle_trace(const struct glint_traced_bundle_config *cfg,
                               const struct glint_traced_bundle *traced,
                               struct glint_vertex *vertex);

#ifdef __cplusplus
}
#endif

#endif
