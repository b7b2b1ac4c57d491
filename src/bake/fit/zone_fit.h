/* SPDX-License-Identifier: MIT
 *
 * The outputs of one zone, or of one part of it.
 *
 *   in   rays of the zone, tolerances for its ghost
 *   out  a sparse polynomial of each output, and how far off they are
 *
 *     glint_zone_trace(&zone, visible, &buffers->rays, &buffers->energies);
 *     aim = glint_zone_aim_of(tolerance, &zone, &buffers->rays);
 *     status = glint_zone_fit(&task, &aim, buffers, &system, &errors);
 *
 * Errors count where they show: past the edge of what is seen, and past the
 * field, a ray only has to stay out. Rays that the polynomials would let pass
 * and the lens stops by far are heard in a second fit.
 */
#ifndef GLINT_BAKE_FIT_ZONE_FIT_H
#define GLINT_BAKE_FIT_ZONE_FIT_H

#include "bake/fit/zone_aim.h"

struct glint_zone_task {
    const struct glint_zone *zone;
    const struct glint_visible *visible; /* ghost over the wavelengths fitted */
    double barrel;   /* tolerance of barrels, see struct glint_tolerance */
    bool thorough;   /* true allows a root of the energy, and more terms */
    double hopeless; /* tolerances; a zone with a larger error is not fitted to
                        the end; 0: every zone is */
};

/* Memory for the fit of one zone after the other. */
struct glint_zone_buffers {
    double *scratch; /* glint_regress_doubles(GLINT_ZONE_RAYS) */
    struct glint_zone_rays rays, energies; /* in; they are overwritten */
    double weight[GLINT_ZONE_RAYS], sensor_weight[GLINT_ZONE_RAYS];
    double channel_weight[GLINT_ZONE_RAYS], value[GLINT_ZONE_RAYS];
};

/* How far off a fit is, in tolerances. */
struct glint_zone_errors {
    double places; /* the worst place or barrel */
    double worst;  /* that, or the energy */
};

/* Fits the outputs of SYSTEM, which has none. With places beyond
 * TASK->hopeless not all outputs are there. GLINT_E_MEMORY. */
enum glint_status glint_zone_fit(const struct glint_zone_task *task,
                                 const struct glint_zone_aim *aim,
                                 struct glint_zone_buffers *buffers,
                                 struct glint_fitted_system *system,
                                 struct glint_zone_errors *errors);

#endif
