/* SPDX-License-Identifier: MIT
 *
 * A ghost's polynomials, zone of angles by zone of angles.
 *
 *   in   a ghost, a tolerance
 *   out  systems whose outputs are sparse polynomials in u, v, s and w
 *
 * A zone that cannot be described well enough with the terms there are, or that
 * the box cannot follow, is cut in half, until halving no longer helps. What is
 * still off by more than shows then is halved in colour, where its box wanders
 * with it, and in parts of the pupil. The limiting barrels each get a
 * polynomial of their own, (1 + r^2) / 2, which is as smooth as the positions
 * are, in place of their maximum, which is not. Limits: what lies outside of
 * what is seen has little weight.
 */
#ifndef GLINT_BAKE_FIT_FIT_H
#define GLINT_BAKE_FIT_FIT_H

#include "bake/fit/fitted.h"
#include "bake/fit/tolerance.h"
#include "bake/fit/visible.h"
#include "glint/status.h"

/* OUT is to be finished in any case. GLINT_E_MEMORY. */
enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  struct glint_fitted_ghost *out);

#endif
