/* SPDX-License-Identifier: MIT
 *
 * Rays of a zone that are traced together, as they share a path.
 *
 *     batch.path = &path;
 *     for (batch.n = 0; batch.n < GLINT_ZONE_BATCH;)
 *         glint_zone_batch_add(&batch, &zone, x);
 *     glint_zone_batch_trace(&batch);
 */
#ifndef GLINT_BAKE_FIT_ZONE_BATCH_H
#define GLINT_BAKE_FIT_ZONE_BATCH_H

#include "bake/fit/zone.h"

enum { GLINT_ZONE_BATCH = 32 };

struct glint_zone_batch {
    const struct glint_path *path;
    int n;
    /* coordinates in the zone, each -1 .. 1 */
    double x[GLINT_ZONE_BATCH][GLINT_VARIABLES];
    struct glint_launch from[GLINT_ZONE_BATCH];
    struct glint_ray ray[GLINT_ZONE_BATCH];
    enum glint_ray_status status[GLINT_ZONE_BATCH];
    double hits[GLINT_ZONE_BATCH * (GLINT_MAX_EVENTS + 1)]
               [2]; /* -1: not reached */
};

/* Adds the ray at X of the zone, w being that of the path and v 0 .. 1 from the
 * inner end of what there is. */
void glint_zone_batch_add(struct glint_zone_batch *batch,
                          const struct glint_zone *zone,
                          const double x[GLINT_VARIABLES]);

void glint_zone_batch_trace(struct glint_zone_batch *batch);

/* Returns the place of ray K at each event of the path, [n_events]. */
static inline double (*glint_zone_batch_hits(struct glint_zone_batch *batch,
                                             int k))[2]
{
    return batch->hits + k * batch->path->n_events;
}

/* Number K of low-discrepancy places, -1 .. 1 in each variable: multiples of
 * powers of the root of x^5 = x + 1, which fill four dimensions evenly. */
void glint_zone_batch_scatter(int k, double x[GLINT_VARIABLES]);

#endif
