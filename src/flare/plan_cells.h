/* SPDX-License-Identifier: MIT
 *
 * Chooses the number of cells of a bundle's ray grid from the second
 * differences of probed rays.
 *
 *   in   a probe of the bundle, its irradiance
 *   out  cells per side; mean error of straight lines between rays (sags) */
#ifndef GLINT_FLARE_PLAN_CELLS_H
#define GLINT_FLARE_PLAN_CELLS_H

#include "flare/plan.h"

static inline struct glint_real
plan_compute_pixels_per_mm(const struct glint_plan *p)
{
    struct glint_real x = p->frame->pixels_per_mm;

    x.exponent -= p->half;
    return x;
}

/* Returns the number of cells per side of the ray grid of a bundle.
 * IRRADIANCE is its mean light, 1 = display white. For an annular pupil box the
 * number includes the two rows of cells next to the middle, which have no
 * light. */
int glint_plan_choose_cells(const struct glint_plan *plan,
                            const struct glint_probe *probe,
                            const struct glint_transfer *transfer,
                            struct glint_real irradiance);

/* Sets the sags of PLANNED (struct glint_bundle_plan) for a grid of N_CELLS
 * cells per side and a stop whose outline has the curvature ROUND_Q16, in 1 /
 * stop radius. */
void glint_plan_set_sags(struct glint_bundle_plan *planned,
                         const struct glint_probe *probe,
                         const struct glint_transfer *transfer, int n_cells,
                         int32_t round_q16);

#endif
