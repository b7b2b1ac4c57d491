/* SPDX-License-Identifier: MIT
 *
 * What the polynomials of a zone are held to: less where its ghost is faint.
 *
 *   in   rays of the zone, how bright a ghost is that an exposure goes by
 *   out  tolerances, root mean square
 */
#ifndef GLINT_BAKE_FIT_ZONE_AIM_H
#define GLINT_BAKE_FIT_ZONE_AIM_H

#include "bake/fit/fitted.h"
#include "bake/fit/tolerance.h"
#include "bake/fit/zone_rays.h"

struct glint_zone_aim {
    /* Tolerances of places and of outlines on the sensor. */
    double sensor_mm, edge_mm;
    double stop;   /* tolerance of places in the stop, radii */
    double energy; /* share */
    double ease;   /* over the tolerances of a bright ghost */
    double hidden; /* error of places at which the ghost begins to show it, over
                      sensor_mm */
};

struct glint_zone_aim glint_zone_aim_of(const struct glint_tolerance *tolerance,
                                        const struct glint_zone *zone,
                                        const struct glint_zone_rays *rays);

/* What an outline may be off, in units of which STRETCH_MM are a millimetre:
 * MOST, or as little as a sixteenth of it. */
double glint_zone_aim_outline(const struct glint_zone_aim *aim, double most,
                              double stretch_mm);

/* Sensor millimetres for a unit of the place A, B (or A alone), root mean
 * square over neighbours; of barrels only where they cut, from NEAR up. */
double glint_zone_aim_stretch(const struct glint_zone_rays *rays,
                              const double *a, const double *b, double near);

#endif
