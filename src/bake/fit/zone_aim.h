/* SPDX-License-Identifier: MIT
 *
 * Computes the tolerances for the polynomials of a zone. Faint ghosts get
 * larger tolerances.
 *
 *   in   rays of the zone; the brightness level that sets the exposure
 *   out  tolerances (RMS)
 */
#ifndef GLINT_BAKE_FIT_ZONE_AIM_H
#define GLINT_BAKE_FIT_ZONE_AIM_H

#include "bake/fit/fitted.h"
#include "bake/fit/brightness.h"
#include "bake/fit/zone_rays.h"

struct glint_zone_aim {
    /* tolerances of positions and of outlines on the sensor, mm */
    double sensor_mm, edge_mm;
    double thin[2]; /* factors on the tolerance sensor_mm along x and y */
    double stop;    /* tolerance of positions in the stop, stop radii */
    double energy;  /* relative tolerance of the energy */
    double ease;    /* tolerance / tolerance for a bright ghost, at least 1 */
    double share;   /* brightness / brightness of a bright ghost */
    /* min position error that is visible, in units of sensor_mm */
    double hidden;
};

struct glint_zone_aim glint_zone_aim_of(const struct glint_tolerance *tolerance,
                                        const struct glint_zone *zone,
                                        const struct glint_zone_rays *rays);

/* Sets LIGHT[N] to the relative brightness of the ghost at each of RAYS:
 * brightness / AIM->share, at most 1. Where rays spread wide the ghost is
 * faint, and so are its errors. */
void glint_zone_aim_light(const struct glint_tolerance *tolerance,
                          const struct glint_zone *zone,
                          const struct glint_zone_aim *aim,
                          const struct glint_zone_rays *rays, double *light);

/* Returns the RMS error of the polynomial OUTPUT over all visible rays. Uses
 * the middle one of every STEP rays. LIGHT: weights, or NULL. */
double glint_zone_aim_off(const struct glint_zone_rays *rays,
                          const struct glint_fitted_output *output,
                          const double *light, int step);

/* Returns the outline tolerance, clamped to LEAST * MOST .. MOST, in a unit
 * that is STRETCH_MM wide on the sensor. */
double glint_zone_aim_outline(const struct glint_zone_aim *aim, double least,
                              double most, double stretch_mm);

/* Returns how many mm a ray moves on the sensor (RMS over neighbouring rays)
 * per unit of distance in coordinates (A, B), or A alone if B is NULL. Skips
 * rays with A below NEAR: barrels matter only near their rim. */
double glint_zone_aim_stretch(const struct glint_zone_rays *rays,
                              const double *a, const double *b, double near);

#endif
