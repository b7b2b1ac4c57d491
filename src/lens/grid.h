/* SPDX-License-Identifier: MIT
 *
 * Chooses the number of cells per side of a ray grid, for models and exact
 * rays.
 *
 * At a fineness of 64, straight lines between rays deviate by at most 0.01
 * pixel from curves along which light piles up (folds), and by at most 0.1
 * pixel from the outlines of the stop and the barrels. A curve that bends by B
 * over the grid deviates by B / (8 n^2) from its straight lines, so n is the
 * square root of B / (8 * 0.01), times fineness / 64.
 */
#ifndef GLINT_LENS_GRID_H
#define GLINT_LENS_GRID_H

#include "glint/bundle.h"

/* Returns the max number of cells per side for FINENESS. It is doubled if
 * FOLDS: the ghost's light folds over itself. */
static inline int glint_grid_get_max_cells(int fineness, int folds)
{
    return (folds ? 4 : 2) * fineness;
}

/* Returns N rounded up to a multiple of four. */
static inline int glint_grid_round_up_to_four(int n)
{
    return (n + 3) / 4 * 4;
}

#endif
