/* SPDX-License-Identifier: MIT
 *
 * Fits polynomials to a ghost, zone by zone; a zone is a range of light
 * angles.
 *
 *   in   a ghost, a tolerance
 *   out  systems whose outputs are sparse polynomials in u, v, s and w
 *
 * A zone whose polynomials or box are not accurate enough is halved until
 * halving no longer helps. If the remaining error is visible, the zone's band
 * is halved (if the box moves with the wavelength) and its box is divided into
 * parts. Each barrel that blocks rays gets its own polynomial, (1 + r^2) / 2,
 * which is as smooth as the positions; the max of all relative radii r is not
 * smooth. Limit: blocked rays have little weight in the fit.
 */
#ifndef GLINT_BAKE_FIT_FIT_H
#define GLINT_BAKE_FIT_FIT_H

#include "bake/fit/fitted.h"
#include "bake/fit/brightness.h"
#include "bake/visible/visible.h"
#include "glint/status.h"

/* Reports progress after each fit of a zone. WORK: fits so far; a thorough fit
 * counts twice. SHARE: fraction of the ghost's angles that are done, 0 .. 1. A
 * status other than GLINT_OK stops the fit of the ghost, which returns that
 * status. */
typedef enum glint_status glint_fit_told_fn(void *ctx, double work,
                                            double share);

/* Fits a ghost for lights up to MAX_DEG off the axis. TOLD may be NULL. The
 * caller must call glint_fitted_finish() on OUT even after an error. May return
 * GLINT_E_MEMORY. */
enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  glint_fit_told_fn *told, void *ctx,
                                  struct glint_fitted_ghost *out);

#endif
