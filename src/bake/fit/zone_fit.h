/* SPDX-License-Identifier: MIT
 *
 * The outputs of one zone, or of one part of it.
 *
 *   in   rays of the zone, tolerances for its ghost
 *   out  a sparse polynomial of each output, and how far off they are
 *
 *     glint_zone_trace(&zone, visible, &fit->rays, &fit->energies);
 *     glint_zone_fit_begin(fit, &zone);
 *     status = glint_zone_fit_run(fit, &zone, &system, &left);
 *
 * Errors count where they show: past the edge of what is seen, and past the
 * field, a ray only has to stay out. Rays that the polynomials would let pass
 * and the lens stops by far are heard in a second fit.
 */
#ifndef GLINT_BAKE_FIT_ZONE_FIT_H
#define GLINT_BAKE_FIT_ZONE_FIT_H

#include "bake/fit/fit.h"
#include "bake/fit/zone_rays.h"

struct glint_zone_fit {
    /* to be set */
    const struct glint_visible *visible; /* in the band of the zone */
    const struct glint_tolerance *tolerance;
    double *scratch; /* glint_regress_doubles(GLINT_ZONE_RAYS) */
    struct glint_zone_rays rays, energies;
    bool thorough;   /* a root of the energy, and more terms */
    double hopeless; /* left of what is not worth to be fitted to the end, in
                        tolerances; 0: everything is */
    /* of this zone: tolerances, and how far they are below what its ghost would
     * show */
    double ease, sensor_mm, edge_mm, stop, energy, hidden;
    double off; /* how far places are off, in tolerances */
    double weight[GLINT_ZONE_RAYS], sensor_weight[GLINT_ZONE_RAYS];
    double channel_weight[GLINT_ZONE_RAYS], value[GLINT_ZONE_RAYS];
};

/* Whether nothing of the rays is seen. */
bool glint_zone_fit_is_dark(const struct glint_zone_fit *fit);

/* Sets tolerances and weights. */
void glint_zone_fit_begin(struct glint_zone_fit *fit,
                          const struct glint_zone *zone);

/* Fits the outputs of SYSTEM, which has none. *LEFT: how far off the worst is,
 * in tolerances; beyond hopeless not all outputs are there. GLINT_E_MEMORY. */
enum glint_status glint_zone_fit_run(struct glint_zone_fit *fit,
                                     const struct glint_zone *zone,
                                     struct glint_fitted_system *system,
                                     double *left);

#endif
