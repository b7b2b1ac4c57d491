/* SPDX-License-Identifier: MIT
 *
 * How many cells a side a grid of rays takes, whoever traces them.
 *
 * As many as keep what is straight between rays within a hundredth of a pixel
 * of what bends, at a fineness of 64, and outlines within a tenth: light piles
 * up along folds, but not along cuts. What bends by B over the grid lies B / 8
 * n^2 off a straight line, so n is the root of B / (8 * 0.01), times fineness /
 * 64.
 */
#ifndef GLINT_LENS_GRID_H
#define GLINT_LENS_GRID_H

#include "glint/bundle.h"

/* The most cells a side: of a ghost whose light FOLDS over itself twice as
 * many as of others. */
static inline int glint_grid_most(int fineness, int folds)
{
    return (folds ? 4 : 2) * fineness;
}

/* N and up to three more: a multiple of four. */
static inline int glint_grid_fours(int n)
{
    return (n + 3) / 4 * 4;
}

#endif
