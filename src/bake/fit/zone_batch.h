/* SPDX-License-Identifier: MIT
 *
 * Rays of a zone that share a path and are traced together.
 *
 *     batch.path = &path;
 *     for (batch.n = 0; batch.n < GLINT_ZONE_BATCH;)
 *         glint_zone_batch_add(&batch, &zone, x);
 *     glint_zone_batch_trace(&batch); */
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
               [2]; /* mm; -1: not reached */
};

/* Adds the ray at X of the zone; its w is that of the path, its v 0 .. 1 from
 * the middle, or the inner end, of the box to its rim, or of a skew zone -1 ..
 * 1. */
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

/* Sets X to place number K of such a sequence over ZONE: of five dimensions if
 * it is skew, else with v of 0 or more. */
void glint_zone_scatter(const struct glint_zone *zone, int k,
                        double x[GLINT_VARIABLES]);

#endif
