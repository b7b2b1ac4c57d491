/* SPDX-License-Identifier: MIT
 *
 * fans.h - rays of a path that pass the stop and all barrels, for figures.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_FANS_H
#define GLINT_TOOLS_LENS_FIGURES_FANS_H

#include <stdbool.h>

#include "glint/trace.h"

/* A path, and its light at one angle. */
struct fan {
    struct glint_path path;
    struct glint_pupil pupil;
    double direction[3];
    double stop_radius_mm;
};

/* Prepares FAN for light at THETA_DEG in the plane at PHI_DEG, which is the x-z
 * plane of its rays; GHOST is NULL for the direct path. Returns false if
 * nothing gets through. */
bool fan_init(struct fan *fan, const struct glint_prescription *lens,
              const struct glint_ghost *ghost, double nm, double phi_deg,
              double theta_deg);

/* Traces the ray that starts at U, V of the pupil, -1 .. 1 each. HITS is as of
 * glint_trace(). Returns whether it passes. */
bool fan_ray(const struct fan *fan, double u, double v, struct glint_ray *ray,
             double (*hits)[2]);

/* Returns the x at which the ray (U, 0) starts. */
double fan_start_mm(const struct fan *fan, double u);

/* Sets U to the lowest and the highest U of a ray (U, 0) that passes. Returns
 * false if none does. */
bool fan_edges(const struct fan *fan, double u[2]);

#endif
