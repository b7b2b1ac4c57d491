/* SPDX-License-Identifier: MIT
 *
 * Rays of a zone that are traced together, as they share a path.
 *
 *     batch.path = &path;
 *     for (batch.n = 0; batch.n < GLINT_RAY_BATCH;)
 *         glint_ray_batch_add(&batch, &zone, x);
 *     glint_ray_batch_trace(&batch);
 */
#ifndef GLINT_BAKE_FIT_RAY_BATCH_H
#define GLINT_BAKE_FIT_RAY_BATCH_H

#include "bake/fit/zone.h"

enum { GLINT_RAY_BATCH = 32 };

struct glint_ray_batch {
    const struct glint_path *path;
    int n;
    double x[GLINT_RAY_BATCH][GLINT_VARIABLES]; /* in the zone */
    struct glint_launch from[GLINT_RAY_BATCH];
    struct glint_ray ray[GLINT_RAY_BATCH];
    enum glint_ray_status status[GLINT_RAY_BATCH];
    double hits[GLINT_RAY_BATCH * (GLINT_MAX_EVENTS + 1)]
               [2]; /* -1: not reached */
};

/* Adds the ray at X of the zone, w being that of the path and v 0 .. 1 from the
 * inner end of what there is. */
void glint_ray_batch_add(struct glint_ray_batch *batch,
                         const struct glint_zone *zone,
                         const double x[GLINT_VARIABLES]);

void glint_ray_batch_trace(struct glint_ray_batch *batch);

/* Where ray K meets each event of the path, [n_events]. */
static inline double (*glint_ray_batch_hits(struct glint_ray_batch *batch,
                                            int k))[2]
{
    return batch->hits + k * batch->path->n_events;
}

/* Number K of low-discrepancy places, -1 .. 1 in each variable: multiples of
 * powers of the root of x^5 = x + 1, which fill four dimensions evenly. */
void glint_ray_batch_scatter(int k, double x[GLINT_VARIABLES]);

#endif
