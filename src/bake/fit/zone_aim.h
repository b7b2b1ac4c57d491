/* SPDX-License-Identifier: MIT
 *
 * Sets the tolerances of a zone, which are larger where its ghost is faint.
 *
 *   in   rays of the zone, how bright a ghost is that an exposure goes by
 *   out  tolerances, root mean square */
#ifndef GLINT_BAKE_FIT_ZONE_AIM_H
#define GLINT_BAKE_FIT_ZONE_AIM_H

#include "bake/fit/fitted.h"
#include "bake/fit/brightness.h"
#include "bake/fit/zone_rays.h"

struct glint_zone_aim {
    /* Tolerances of positions and of outlines on the sensor. */
    double sensor_mm, edge_mm;
    double thin[2]; /* factors on sensor_mm along x and y */
    double stop;    /* tolerance of positions in the stop, radii */
    double energy;  /* tolerance of the energy, as a fraction */
    double ease;    /* tolerance / tolerance of a bright ghost */
    double share;   /* brightness / brightness of a bright ghost */
    double hidden;  /* smallest visible position error, in units of sensor_mm */
};

struct glint_zone_aim glint_zone_aim_of(const struct glint_tolerance *tolerance,
                                        const struct glint_zone *zone,
                                        const struct glint_zone_rays *rays);

/* Sets LIGHT[N] to the brightness of the ghost at each of RAYS / AIM->share, at
 * most 1: where rays are spread wide, position errors are as invisible as the
 * light. */
void glint_zone_aim_light(const struct glint_tolerance *tolerance,
                          const struct glint_zone *zone,
                          const struct glint_zone_aim *aim,
                          const struct glint_zone_rays *rays, double *light);

/* Returns the RMS error of OUTPUT over the RAYS that get through, using the
 * middle ray of every STEP rays, weighted by LIGHT unless it is NULL. */
double glint_zone_aim_off(const struct glint_zone_rays *rays,
                          const struct glint_fitted_output *output,
                          const double *light, int step);

/* Returns the tolerance of an outline in a unit that stands for STRETCH_MM on
 * the sensor: LEAST times MOST to MOST. */
double glint_zone_aim_outline(const struct glint_zone_aim *aim, double least,
                              double most, double stretch_mm);

/* Returns for how many mm on the sensor a unit of the place (A, B) stands (of A
 * alone if B is NULL), root mean square over neighbouring rays. Rays with A
 * below NEAR do not count: barrels matter only where they cut. */
double glint_zone_aim_stretch(const struct glint_zone_rays *rays,
                              const double *a, const double *b, double near);

#endif
