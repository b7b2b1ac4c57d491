/* SPDX-License-Identifier: MIT
 *
 * Number of cells per side of a ray grid, for models and exact rays.
 *
 * At a fineness of 64, straight lines between rays lie within 0.01 pixel of
 * where light bends, and outlines within 0.1: light piles up along folds, but
 * not along cuts. A curve that bends by B over the grid lies B / (8 n^2) off
 * its straight lines, so n is the root of B / (8 * 0.01), times fineness / 64.
 */
#ifndef GLINT_LENS_GRID_H
#define GLINT_LENS_GRID_H

#include "glint/bundle.h"

/* Returns the max number of cells per side; twice as many if the ghost's light
 * FOLDS over itself. */
static inline int glint_grid_most(int fineness, int folds)
{
    return (folds ? 4 : 2) * fineness;
}

/* Returns N rounded up to a multiple of four. */
static inline int glint_grid_fours(int n)
{
    return (n + 3) / 4 * 4;
}

#endif
