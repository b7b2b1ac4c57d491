/* SPDX-License-Identifier: MIT
 *
 * Fits polynomials to a ghost, zone by zone; a zone is a range of light angles.
 *
 *   in   a ghost, tolerances
 *   out  systems, whose outputs are sparse polynomials in u, v, s and w
 *        (coordinates of a zone, see zone.h)
 *
 * A zone is halved until its polynomials and its box are accurate enough or
 * halving no longer helps. If the remaining error is visible, the zone's band
 * is halved (if the box moves with the wavelength) and its box is divided into
 * parts. Each barrel that blocks rays gets its own polynomial for (1 + r^2) /
 * 2, r: relative radius, which is as smooth as the positions; the max of r over
 * all barrels is not smooth. Limit: blocked rays have little weight in the fit.
 */
#ifndef GLINT_BAKE_FIT_FIT_H
#define GLINT_BAKE_FIT_FIT_H

#include "bake/fit/fitted.h"
#include "bake/fit/brightness.h"
#include "bake/visible/visible.h"
#include "glint/status.h"

/* Progress callback, called after each fit of a zone. WORK: number of fits so
 * far; a thorough fit counts twice. SHARE: fraction of the ghost's angles that
 * are done, 0 .. 1. A status other than GLINT_OK stops the fit of the ghost,
 * which returns that status. */
typedef enum glint_status glint_fit_progress_fn(void *ctx, double work,
                                                double share);

/* Fits a ghost for lights up to MAX_DEG off the axis. PROGRESS may be NULL. The
 * caller must call glint_fitted_free_ghost() on OUT even after an error. May
 * return GLINT_E_MEMORY. */
enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  glint_fit_progress_fn *progress, void *ctx,
                                  struct glint_fitted_ghost *out);

#endif
