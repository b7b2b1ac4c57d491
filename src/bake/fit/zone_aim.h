/* SPDX-License-Identifier: MIT
 *
 * Computes the tolerances of a zone. They are larger where its ghost is faint.
 *
 *   in   rays of the zone; the irradiance that determines the exposure
 *   out  tolerances, root mean square
 */
#ifndef GLINT_BAKE_FIT_ZONE_AIM_H
#define GLINT_BAKE_FIT_ZONE_AIM_H

#include "bake/fit/fitted.h"
#include "bake/fit/brightness.h"
#include "bake/fit/zone_rays.h"

struct glint_zone_aim {
    /* Tolerances of positions and of outlines on the sensor. */
    double sensor_mm, edge_mm;
    double thin[2]; /* factors on sensor_mm along x and y */
    double stop;    /* tolerance of positions in the stop, stop radii */
    double energy;  /* relative tolerance of the energy */
    double ease;    /* tolerance / tolerance for a bright ghost */
    double share;   /* brightness / brightness of a bright ghost */
    double hidden;  /* smallest visible position error, in units of sensor_mm */
};

struct glint_zone_aim glint_zone_aim_of(const struct glint_tolerance *tolerance,
                                        const struct glint_zone *zone,
                                        const struct glint_zone_rays *rays);

/* Sets LIGHT[N] to the brightness of the ghost at each of RAYS / AIM->share,
 * at most 1. Where rays are spread wide the ghost is faint, and so are its
 * errors. */
void glint_zone_aim_light(const struct glint_tolerance *tolerance,
                          const struct glint_zone *zone,
                          const struct glint_zone_aim *aim,
                          const struct glint_zone_rays *rays, double *light);

/* Returns the RMS error of OUTPUT over the visible rays. Uses the middle one
 * of every STEP rays, weighted by LIGHT unless it is NULL. */
double glint_zone_aim_off(const struct glint_zone_rays *rays,
                          const struct glint_fitted_output *output,
                          const double *light, int step);

/* Returns the tolerance of an outline, clamped to LEAST times MOST .. MOST,
 * in a unit that corresponds to STRETCH_MM on the sensor. */
double glint_zone_aim_outline(const struct glint_zone_aim *aim, double least,
                              double most, double stretch_mm);

/* Returns the RMS distance on the sensor, mm, per unit of distance in the
 * coordinates (A, B), or A alone if B is NULL, over neighbouring rays. Skips
 * rays with A below NEAR, as barrels matter only where they cut. */
double glint_zone_aim_stretch(const struct glint_zone_rays *rays,
                              const double *a, const double *b, double near);

#endif
