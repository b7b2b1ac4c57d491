/* SPDX-License-Identifier: MIT
 *
 * Fits the outputs of one zone, or of one part of a zone.
 *
 *   in   rays of the zone, tolerances for its ghost
 *   out  a sparse polynomial per output, and its errors
 *
 *     glint_zone_trace_rays(&zone, visible, &buffers->rays);
 *     aim = glint_zone_aim_compute_tolerances(tolerance, &zone,
 *                                             &buffers->rays);
 *     status = glint_zone_fit_outputs(&task, &aim, buffers, &system, &errors);
 *
 * Errors count where they are visible: a ray outside the visible region or the
 * field only has to stay outside. Rays that the polynomials transmit although
 * the lens clearly blocks them get more weight in a second fit.
 */
#ifndef GLINT_BAKE_FIT_ZONE_FIT_H
#define GLINT_BAKE_FIT_ZONE_FIT_H

#include "bake/fit/zone_aim.h"

struct glint_zone_task {
    const struct glint_zone *zone;
    const struct glint_tolerance *tolerance;
    /* visibility of the ghost in the band that is fitted */
    const struct glint_visible *visible;
    /* max tolerance at barrels, as in struct glint_tolerance */
    double barrel;
    bool thorough; /* true: allow a root of the energy, and more terms */
    bool stacks;   /* true: coatings of several films reflect the ghost */
    /* error, in tolerances; a fit stops early once it is clear that its error
     * stays above this value; 0: never */
    double hopeless;
    /* Error, in tolerances. Once the error of an output exceeds it, the
     * remaining outputs are skipped, because the zone will be fitted again in
     * any case. Skew zones compare the errors of positions and outlines,
     * thorough fits dims of struct glint_zone_errors. 0: never skip. */
    double settled;
    /* Memory for choosing the barrels once positions and energy are fitted and
     * the remaining outputs matter; NULL: the rays have their barrels. */
    glint_zone_sampling *sampling;
};

/* Number of doubles of scratch memory for one fit. Skew zones have most planes
 * and the highest degrees: 9, 8, 5, 4 and 5 for positions. */
#define GLINT_ZONE_SCRATCH \
    GLINT_REGRESS_DOUBLES(GLINT_ZONE_RAYS, 132, 19 * 17, 6 * 5 * 6)

/* Memory for fitting one zone; used by one fit at a time. */
struct glint_zone_buffers {
    double *scratch; /* scratch memory, GLINT_ZONE_SCRATCH doubles */
    /* Rays that are fitted; each fit overwrites them. Energies are traced and
     * barrels chosen when the fit of a zone first needs them. */
    struct glint_zone_rays rays, energies;
    bool has_energies, has_barrels;
    double weight[GLINT_ZONE_RAYS], sensor_weight[GLINT_ZONE_RAYS];
    /* brightness weights, see glint_zone_aim_set_ray_brightness() */
    double light[GLINT_ZONE_RAYS];
    double channel_weight[GLINT_ZONE_RAYS], value[GLINT_ZONE_RAYS];
};

/* max errors of a fit, in tolerances */
struct glint_zone_errors {
    double places; /* error of positions on the sensor */
    /* error of outlines, from positions in the stop and at barrels */
    double outlines;
    double shows; /* visible part of the position and outline errors */
    /* max of shows and, for fast lenses, energy; decides whether a box is
     * divided */
    double dims;
    double worst;  /* max of places, outlines and energy */
    double energy; /* relative error of the energy */
};

/* Fits all outputs of SYSTEM, which must have none yet. Skips the remaining
 * outputs if errors exceed TASK->hopeless or TASK->settled. May return
 * GLINT_E_MEMORY. */
enum glint_status glint_zone_fit_outputs(const struct glint_zone_task *task,
                                         const struct glint_zone_aim *aim,
                                         struct glint_zone_buffers *buffers,
                                         struct glint_fitted_system *system,
                                         struct glint_zone_errors *errors);

#endif
