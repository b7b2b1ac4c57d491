/* SPDX-License-Identifier: MIT
 *
 * Chooses the number of cells per side of a ray grid, for models and exact
 * rays.
 *
 * Curves are approximated by straight lines between rays. At a fineness of 64,
 * the error is at most 0.01 pixel for folds (curves along which light piles
 * up), and at most 0.1 pixel for the outlines of the stop and the barrels. If a
 * curve bends by B over n cells, the error is B / (8 n^2). So n is sqrt(B / (8
 * * 0.01)) times fineness / 64. */
#ifndef GLINT_LENS_GRID_H
#define GLINT_LENS_GRID_H

#include "glint/bundle.h"

/* Returns the max number of cells per side for FINENESS. The number is doubled
 * if FOLDS is 1, that is, if the ghost's light folds over itself. */
static inline int glint_grid_get_max_cells(int fineness, int folds)
{
    return (folds ? 4 : 2) * fineness;
}

static inline int glint_grid_round_up_to_four(int n)
{
    return (n + 3) / 4 * 4;
}

#endif
