/* SPDX-License-Identifier: MIT
 *
 * glint/traced_bundle.h - exactly traced rays for the run-time half. */
#ifndef GLINT_TRACED_BUNDLE_H
#define GLINT_TRACED_BUNDLE_H

#include <stdbool.h>

#include "glint/bundle.h"
#include "glint/light.h"
#include "glint/setup.h"
#include "glint/trace.h"
#include "glint/view.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_traced_bundle_config {
    const struct glint_setup *setup;
    struct glint_view view;
    double scale;                   /* factor on all light: gain times 2^EV */
    int max_cells;                  /* fineness of the grids, 1 .. 1024: see
                                       glint_traced_bundle_plan */
    bool uniform;                   /* true: all ghosts get max_cells a side */
    const struct glint_tint *tints; /* [ghosts of the setup]; NULL: none */
};

enum { GLINT_TRACED_CUTS = 8 };

/* One ghost, light and wavelength, with the grid chosen for it and the barrels
 * that cut. A vertex holds the first barrel's value, and the largest value of
 * all other barrels. */
struct glint_traced_bundle {
    const struct glint_lamp *lamp;
    int ghost, wavelength;
    struct glint_pupil pupil;
    bool found;  /* true: something gets through, and PUPIL is set */
    int n_cells; /* cells a side of the grid; 0: nothing of it is in the picture
                  */
    int n_cuts;  /* barrels that may cut inside the stop */
    int cut_event[GLINT_TRACED_CUTS]; /* events of the path, the barrel that
                                         cuts most first */
    /* Ray energy that energy 65536 of a vertex stands for. */
    double energy_unit;
};

/* Finds the pupil and the barrels of TRACED, whose lamp, ghost and wavelength
 * are set, and chooses its grid by how much the light bends in pixels. With
 * max_cells 64 light is off by 0.01 px (RMS), outlines by 0.1 px; with n times
 * as many cells, by n^2 times less. The grid has 8 .. 2 max_cells cells a side,
 * a multiple of 4, or up to 4 max_cells if light folds; it covers the pupil and
 * a pixel more on each side. NEAR, unless NULL, is the same bundle at another
 * wavelength, which makes the search faster. */
void glint_traced_bundle_plan(const struct glint_traced_bundle_config *cfg,
                              struct glint_traced_bundle *traced,
                              const struct glint_traced_bundle *near);

/* Fill BUNDLE, and its (n_cells + 1)^2 vertices, from TRACED, whose n_cells is
 * not 0. */
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
