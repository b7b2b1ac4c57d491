/* SPDX-License-Identifier: MIT
 *
 * Crops a part of a zone to what can be seen of it. */
#include <math.h>

#include "bake/fit/zone_batch.h"

/* Reduces *FROM .. *TO to LOW .. HIGH of it, where -1 .. 1 is the whole. */
static void reduce(double low, double high, double *from, double *to)
{
    const double middle = 0.5 * (*from + *to), half = 0.5 * (*to - *from);

    *from = middle + fmax(-1, low) * half;
    *to = middle + fmin(1, high) * half;
}

/* Bounds of the visible rays in u, v, s and w. */
struct sighting {
    double low[GLINT_VARIABLES], high[GLINT_VARIABLES];
};

/* Traces T at wavelength WAVE of the ghost and of those beside it. */
static void sight(const struct glint_visible *visible, int wave,
                  struct glint_zone_batch *t, struct sighting *seen)
{
    for (int m = 0; m <= visible->n_beside; m++) {
        const struct glint_visible *const h = glint_visible_member(visible, m);

        t->path = &h->position_path[wave];
        glint_zone_batch_trace(t);
        for (int i = 0; i < t->n; i++)
            if (t->status[i] == GLINT_RAY_OK &&
                glint_visible_passes(h, &t->ray[i]))
                for (int k = 0; k < GLINT_VARIABLES; k++) {
                    seen->low[k] = fmin(seen->low[k], t->x[i][k]);
                    seen->high[k] = fmax(seen->high[k], t->x[i][k]);
                }
    }
}

double glint_zone_crop(const struct glint_zone *zone,
                       const struct glint_visible *visible,
                       struct glint_zone_part *part)
{
    enum { ANGLES = 5, COLUMNS = GLINT_ZONE_BATCH, ROWS = 12 };
    /* Rays of shaped lenses take long; few of their colours go apart. */
    const int stride = visible->shaped ? (GLINT_VISIBLE_WAVES - 1) / 2 : 1;
    const double margin = 3.0 / COLUMNS;
    const struct glint_zone_part before = *part;
    struct sighting seen = {{9, 9, 9, 9}, {-9, -9, -9, -9}};
    struct glint_zone_batch t;

    for (int k = 0; k < ANGLES * GLINT_VISIBLE_WAVES * (ROWS + 1); k++) {
        const int row = k % (ROWS + 1), wave = k / (ROWS + 1) / ANGLES;

        if (wave % stride)
            continue;
        for (t.n = 0; t.n < COLUMNS;) {
            const double x[GLINT_VARIABLES] = {
                2.0 * t.n / (COLUMNS - 1) - 1, (double)row / ROWS,
                2.0 * (k / (ROWS + 1) % ANGLES) / (ANGLES - 1) - 1,
                glint_zone_node(wave, GLINT_VISIBLE_WAVES)};

            glint_zone_batch_add(&t, zone, x);
        }
        sight(visible, wave, &t, &seen);
    }
    if (seen.high[0] < seen.low[0])
        return 0;
    reduce(seen.low[0] - margin, seen.high[0] + margin, &part->u0, &part->u1);
    reduce(seen.low[3] - 0.3, seen.high[3] + 0.3, &part->w0, &part->w1);
    if (!part->annulus)
        part->top *= fmin(1, seen.high[1] + 1.5 / ROWS);
    return (part->u1 - part->u0) / (before.u1 - before.u0) *
           (part->w1 - part->w0) / (before.w1 - before.w0) * part->top /
           before.top;
}
