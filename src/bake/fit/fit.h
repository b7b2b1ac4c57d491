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

#include "bake/fit/brightness.h"
#include "bake/fit/fitted.h"
#include "bake/fit/visible.h"
#include "glint/status.h"

/* Times that a zone's box may be halved. */
enum { GLINT_PART_DEPTH = 4, GLINT_MAX_AXIS_DEPTH = 8 };

/* The root mean square that is aimed at; single rays may be off by five times
 * as much. Stop and barrel positions draw the outline: EDGE_MM is what they may
 * shift it on the sensor, but neither is asked for less than STOP (stop radii)
 * and BARREL (of its radius), or more than a sixteenth of it.
 *
 * For ghosts of the brightness that counts; sRGB shows an error in a ghost of a
 * share v of that by v^0.42 as much, so edges and energy may be off by more
 * there, up to EASE times. */
struct glint_tolerance {
    double sensor_mm, edge_mm, stop, barrel, energy;
    double faint_sensor_mm; /* the most for any ghost */
    double escape; /* past a barrel that is left out, relative radius */
    double ease;
    double axis;    /* zones at the axis, where light folds into rings: how
                       narrow they may become, and how far off places may be,
                       over the same of others */
    int axis_depth; /* times that their boxes may be halved, GLINT_PART_DEPTH
                       to GLINT_MAX_AXIS_DEPTH */
    const struct glint_brightness *brightness;
};

/* OUT is to be finished in any case. GLINT_E_MEMORY. */
enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  struct glint_fitted_ghost *out);

#endif
