/* SPDX-License-Identifier: MIT */
#include "bake/cuts.h"

#include <math.h>

/* Counts the ray of HITS for the one barrel that stops it, if only one does. */
static void mark_cut(const struct glint_path *path, double stop_r,
                     double (*hits)[2], int *rays)
{
    const double margin = 1.1;
    double worst = stop_r, second = 0;
    int at = -1;

    for (int k = 0; k < path->n_events; k++) {
        const struct glint_event *e = &path->event[k];
        const double r = e->kind == GLINT_STOP
                             ? 0
                             : hypot(hits[k][0], hits[k][1]) / e->semi_mm;

        if (r > worst) {
            second = worst;
            worst = r;
            at = k;
        } else if (r > second) {
            second = r;
        }
    }
    if (at >= 0 && worst > 0.99 && second < margin)
        rays[at]++;
}

void glint_cuts_find(struct glint_cuts *cuts, const struct glint_path *path,
                     const struct glint_pupil *p, const double direction[3],
                     double stop_radius_mm, int survey)
{
    int rays[GLINT_MAX_EVENTS + 1] = {0};
    double hits[GLINT_MAX_EVENTS + 1][2];

    for (int j = 0; j <= survey / 2; j++)
        for (int i = 0; i <= survey; i++) {
            const double x = p->x0_mm + (p->x1_mm - p->x0_mm) * i / survey;
            const double y = p->y1_mm * j / (survey / 2);
            struct glint_ray ray;

            if (glint_trace(path, x, y, direction, &ray, hits) == GLINT_RAY_OK)
                mark_cut(path,
                         hypot(ray.stop_x_mm, ray.stop_y_mm) / stop_radius_mm,
                         hits, rays);
        }
    cuts->n = 0;
    for (int k = 0; k < path->n_events && cuts->n < GLINT_MAX_EVENTS; k++)
        if (rays[k]) {
            cuts->event[cuts->n] = k;
            cuts->rays[cuts->n++] = rays[k];
        }
}
