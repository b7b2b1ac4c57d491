/* SPDX-License-Identifier: MIT
 *
 * Fits all systems of one ghost in a lens that is not round.
 *
 *   in   a ghost, tolerances
 *   out  systems, each for a patch of directions and a band of wavelengths
 *
 * Method: the x and y components of directions, in the lens's own frame, are
 * divided into squares. A square from which no light passes is dropped. A
 * square whose polynomials are not accurate enough is halved in x or in y.
 */
#ifndef GLINT_BAKE_SKEW_SKEW_FIT_H
#define GLINT_BAKE_SKEW_SKEW_FIT_H

#include "bake/fit/fit.h"

/* Estimates the work of a bake, as a number of zone fits, from the area of
 * directions and the number of surfaces. HEAD: work before the first ghost.
 * TYPICAL: mean work per ghost. Limit: ghosts with caustics cost ten times as
 * much as the others; the estimate ignores this. */
void glint_skew_estimate_work(const struct glint_prescription *lens,
                              int n_ghosts, double max_deg, double tolerance,
                              double *head, double *typical);

/* Fits a ghost of a lens that is not round; arguments as in
 * glint_fit_ghost(). */
enum glint_status glint_skew_fit_ghost(const struct glint_visible *visible,
                                       double max_deg,
                                       const struct glint_tolerance *tolerance,
                                       glint_fit_progress_fn *progress,
                                       void *ctx,
                                       struct glint_fitted_ghost *out);

#endif
