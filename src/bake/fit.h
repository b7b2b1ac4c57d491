/* SPDX-License-Identifier: MIT
 *
 * A ghost's polynomials, zone of angles by zone of angles.
 *
 *   in   a ghost, a tolerance
 *   out  systems whose outputs are sparse polynomials in u, v, s and w
 *
 * A zone that cannot be described well enough with the terms there are, or that
 * the box cannot follow, is cut in half, until halving no longer helps. The
 * limiting barrels each get a polynomial of their own, (1 + r^2) / 2, which is
 * as smooth as the positions are, in place of their maximum, which is not.
 * Limits: what lies outside of what is seen has little weight.
 */
#ifndef GLINT_BAKE_FIT_H
#define GLINT_BAKE_FIT_H

#include "bake/fitted.h"
#include "bake/hunt.h"
#include "glint/status.h"

/* The root mean square that is aimed at; single rays may be off by five times
 * as much. Stop and barrel positions draw the outline: EDGE_MM is what they may
 * shift it on the sensor, but neither is asked for less than STOP (stop radii)
 * and BARREL (of its radius), or more than a fifth of it. */
struct glint_tolerance {
    double sensor_mm, edge_mm, stop, barrel, energy;
};

/* OUT is to be finished in any case. GLINT_E_MEMORY. */
enum glint_status glint_fit_ghost(const struct glint_hunt *hunt, double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  struct glint_fitted_ghost *out);

#endif
