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
    /* factor by which the ghost's tolerances exceed those of a bright ghost, at
     * least 1 */
    double ease;
    /* brightness of the ghost / brightness level of struct glint_brightness */
    double share;
    /* min position error that is visible, in units of sensor_mm */
    double hidden;
};

struct glint_zone_aim
glint_zone_aim_compute_tolerances(const struct glint_tolerance *tolerance,
                                  const struct glint_zone *zone,
                                  const struct glint_zone_rays *rays);

/* Sets LIGHT[N] to the local brightness of the ghost at each of RAYS /
 * AIM->share, at most 1. Where rays spread widely the ghost is faint, and its
 * errors are less visible. */
void glint_zone_aim_set_ray_brightness(const struct glint_tolerance *tolerance,
                                       const struct glint_zone *zone,
                                       const struct glint_zone_aim *aim,
                                       const struct glint_zone_rays *rays,
                                       double *light);

/* Returns the RMS error of the polynomial OUTPUT over the visible rays; uses
 * one ray, the middle one, of every STEP rays. LIGHT: weights, or NULL. */
double
glint_zone_aim_compute_rms_error(const struct glint_zone_rays *rays,
                                 const struct glint_fitted_output *output,
                                 const double *light, int step);

/* Returns the outline tolerance converted to a unit that corresponds to
 * STRETCH_MM on the sensor, such as stop radii, clamped to LEAST * MOST ..
 * MOST. */
double glint_zone_aim_get_outline_tolerance(const struct glint_zone_aim *aim,
                                            double least, double most,
                                            double stretch_mm);

/* Returns the RMS displacement on the sensor, mm, between neighbouring rays,
 * divided by their distance in channels (A, B), or in A alone if B is NULL.
 * Skips rays with A below NEAR: barrels matter only near their rim. */
double glint_zone_aim_compute_stretch(const struct glint_zone_rays *rays,
                                      const double *a, const double *b,
                                      double near);

#endif
