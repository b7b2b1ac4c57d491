/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_batch.h"

#include <math.h>

/* Sets X to place number K of a low-discrepancy sequence, -1 .. 1 in each
 * variable, which fills four dimensions evenly: the fractional parts of 1/2 +
 * (K + 1) / g, / g^2 .. / g^4, g being the root of x^5 = x + 1, spread over -1
 * .. 1. */
static void scatter_in_four(int k, double x[GLINT_VARIABLES])
{
    const double root = 1.16730397826141868426;
    double step = 1;

    for (int i = 0; i < GLINT_P; i++) {
        step /= root;
        x[i] = 2 * fmod(0.5 + (k + 1) * step, 1) - 1;
    }
    x[GLINT_P] = 0;
}

void glint_zone_scatter(const struct glint_zone *zone, int k,
                        double x[GLINT_VARIABLES])
{
    const double root = 1.13472413840151949260;
    double step = 1;

    if (!zone->skew) {
        scatter_in_four(k, x);
        x[GLINT_V] = fabs(x[GLINT_V]);
        return;
    }
    for (int i = 0; i < GLINT_VARIABLES; i++) {
        step /= root;
        x[i] = 2 * fmod(0.5 + (k + 1) * step, 1) - 1;
    }
}

static void direction_of(const struct glint_zone *z,
                         const double x[GLINT_VARIABLES], double d[3])
{
    d[0] = 0.5 * (z->lo + z->hi) + 0.5 * x[GLINT_S] * (z->hi - z->lo);
    d[1] = z->skew ? 0.5 * (z->y_lo + z->y_hi) +
                         0.5 * x[GLINT_P] * (z->y_hi - z->y_lo)
                   : 0;
    d[2] = sqrt(fmax(1e-6, 1 - d[0] * d[0] - d[1] * d[1]));
}

void glint_zone_batch_add(struct glint_zone_batch *batch,
                          const struct glint_zone *zone,
                          const double x[GLINT_VARIABLES])
{
    const double rim = glint_zone_rim(zone->annulus);
    struct glint_launch *from = &batch->from[batch->n];

    for (int k = 0; k < GLINT_VARIABLES; k++)
        batch->x[batch->n][k] = x[k];
    batch->x[batch->n][1] = rim + (1 - rim) * x[1];
    from->x_mm = glint_zone_side(zone, zone->middle, x) +
                 x[0] * glint_zone_side(zone, zone->half_x, x);
    from->y_mm = batch->x[batch->n][1] * glint_zone_side(zone, zone->half_y, x);
    if (zone->skew)
        from->y_mm += glint_zone_side(zone, zone->middle_y, x);
    direction_of(zone, x, from->direction);
    batch->n++;
}

void glint_zone_batch_trace(struct glint_zone_batch *batch)
{
    for (int k = 0; k < batch->n * batch->path->n_events; k++)
        batch->hits[k][0] = batch->hits[k][1] = -1;
    glint_trace_many(batch->path, batch->n, batch->from, batch->ray,
                     batch->status, batch->hits);
}
