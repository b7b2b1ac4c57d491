/* SPDX-License-Identifier: MIT
 *
 * Fits polynomials to a ghost, one zone (range of angles) after the other.
 *
 *   in   a ghost, a tolerance
 *   out  systems whose outputs are sparse polynomials in u, v, s and w
 *
 * A zone whose polynomials or box are not accurate enough is halved until
 * halving no longer helps. If the remaining error is visible, the zone's band
 * is halved (if the box moves with the wavelength) and its box is divided into
 * parts. Each barrel that cuts the ghost gets a polynomial of its own, (1 +
 * r^2) / 2, which is as smooth as the positions are; the max of all relative
 * radii is not smooth. Limits: rays that are blocked have little weight.
 */
#ifndef GLINT_BAKE_FIT_FIT_H
#define GLINT_BAKE_FIT_FIT_H

#include "bake/fit/fitted.h"
#include "bake/fit/brightness.h"
#include "bake/visible/visible.h"
#include "glint/status.h"

/* Called after each fit of a zone. WORK is the number of fits so far, where
 * thorough fits count twice; SHARE is the fraction of the ghost's angles
 * that are done, 0 .. 1. A status other than GLINT_OK ends the fit of the
 * ghost, which returns it. */
typedef enum glint_status glint_fit_told_fn(void *ctx, double work,
                                            double share);

/* Fits a ghost; TOLD may be NULL. The caller must call glint_fitted_finish()
 * on OUT even after an error. May return GLINT_E_MEMORY. */
enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  glint_fit_told_fn *told, void *ctx,
                                  struct glint_fitted_ghost *out);

#endif
