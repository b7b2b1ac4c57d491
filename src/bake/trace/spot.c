/* SPDX-License-Identifier: MIT */
#include "bake/trace/spot.h"

#include <math.h>

enum {
    /* number of cells (pairs of neighbouring rays) per segment of the search
     * line */
    LINE = 64,
    LINES = 4, /* number of segments of the search line */
    /* number of times that a segment is searched, each time over a narrower
     * range */
    CLOSER = 6,
    /* number of cells along the borders of a box that are parallel to x */
    BORDER = 64,
    SHORT = 32, /* number of cells along the other two borders */
    /* max number of times that a side of a box is moved outwards */
    GROWTHS = 12
};

/* The positions of rays between two neighbouring rays are assumed to lie in the
 * interval between the neighbours' positions. A margin of this fraction of its
 * length is added at each end, because rays bend. */
#define BENDS 0.5
/* If one of two neighbouring rays is invalid, rays between them are assumed to
 * pass if the two are more than this distance apart. It is measured in
 * semi-diameters at the last event that both reached. */
#define APART 0.25
/* A box grows on one side by this fraction of its size per step. Parts of the
 * visible region are found if they extend less than this beyond the box. */
#define STEP 0.125

/* a segment of neighbouring rays in the light's plane */
struct line {
    double x0_mm, step_mm;
    struct glint_ray ray[LINE + 1];
    enum glint_ray_status status[LINE + 1];
    /* 200 KB, twice on the stack; see GLINT_BAKE_STACK_BYTES */
    double hits[(LINE + 1) * (GLINT_MAX_EVENTS + 1)][2];
};

/* Returns whether RAY passes the stop and all barrels and hits the field. */
static bool is_ray_unblocked(const struct glint_openings *o,
                             const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <= o->stop_mm &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= o->field_mm;
}

static void trace_line_segment(const struct glint_openings *o, double x0_mm,
                               double x1_mm, struct line *line)
{
    const double *d = o->direction;
    const struct glint_row row = {
        LINE + 1, x0_mm, (x1_mm - x0_mm) / LINE, 0, {d[0], d[1], d[2]}};

    line->x0_mm = x0_mm;
    line->step_mm = row.step_mm;
    for (int k = 0; k < row.n * o->path->n_events; k++)
        line->hits[k][0] = HUGE_VAL;
    glint_trace_row(o->path, &row, line->ray, line->status, line->hits);
}

/* Returns the distance from 0 to the interval A .. B, extended by the margin
 * BENDS; 0 if it contains 0. */
static double compute_distance_to_zero(double a, double b)
{
    const double more = BENDS * fabs(a - b);
    const double low = fmin(a, b) - more, high = fmax(a, b) + more;

    return low > 0 ? low : high < 0 ? -high : 0;
}

/* Returns the number of events that ray I of LINE reached before it became
 * invalid. */
static int count_reached_events(const struct line *line, int i, int n_events)
{
    int n = 0;

    while (n < n_events && line->hits[i * n_events + n][0] < HUGE_VAL)
        n++;
    return n;
}

/* Returns whether any ray between rays I and I + 1 may pass. Invalid rays are
 * included, because light often fans out from a spot next to an invalid ray. */
static bool can_any_ray_pass_between(const struct glint_openings *o,
                                     const struct line *line, int i)
{
    const struct glint_ray *a = &line->ray[i], *b = &line->ray[i + 1];
    const int all = o->path->n_events;
    const int n = (int)fmin(count_reached_events(line, i, all),
                            count_reached_events(line, i + 1, all));
    double apart = 0;

    for (int k = 0; k < n; k++) {
        const struct glint_event *e = &o->path->event[k];
        const double *p = line->hits[i * all + k];
        const double *q = line->hits[(i + 1) * all + k];
        const double semi = e->kind == GLINT_STOP ? o->stop_mm : e->semi_mm;

        if (hypot(compute_distance_to_zero(p[0], q[0]),
                  compute_distance_to_zero(p[1], q[1])) > semi)
            return false;
        apart = fabs(p[0] - q[0]) / semi;
    }
    if (line->status[i] != GLINT_RAY_OK || line->status[i + 1] != GLINT_RAY_OK)
        return apart > APART;
    return hypot(compute_distance_to_zero(a->sensor_x_mm, b->sensor_x_mm),
                 compute_distance_to_zero(a->sensor_y_mm, b->sensor_y_mm)) <=
           o->field_mm;
}

/* Sets X_MM to the range of the rays of LINE that pass, extended by one ray on
 * each side. Returns whether any ray passes. */
static bool find_range_of_passing_rays(const struct glint_openings *o,
                                       const struct line *line, double x_mm[2])
{
    bool seen = false;

    for (int i = 0; i <= LINE; i++) {
        if (line->status[i] != GLINT_RAY_OK ||
            !is_ray_unblocked(o, &line->ray[i]))
            continue;
        x_mm[0] = seen ? x_mm[0] : line->x0_mm + (i - 1) * line->step_mm;
        x_mm[1] = line->x0_mm + (i + 1) * line->step_mm;
        seen = true;
    }
    return seen;
}

/* Shrinks X_MM, a range in which rays may pass, to the rays that pass. Returns
 * whether any ray passes. */
static bool refine_range_of_passing_rays(const struct glint_openings *o,
                                         double x_mm[2])
{
    struct line line;

    for (int round = 0; round < CLOSER; round++) {
        int first = LINE, last = -1;

        trace_line_segment(o, x_mm[0], x_mm[1], &line);
        if (find_range_of_passing_rays(o, &line, x_mm))
            return true;
        for (int i = 0; i < LINE; i++)
            if (can_any_ray_pass_between(o, &line, i)) {
                first = i < first ? i : first;
                last = i;
            }
        if (last < 0)
            return false;
        x_mm[0] = line.x0_mm + first * line.step_mm;
        x_mm[1] = line.x0_mm + (last + 1) * line.step_mm;
    }
    return false;
}

/* Searches each run of adjacent cells of LINE in which rays may pass. Sets X_MM
 * to the widest range of passing rays found, if it is wider than X_MM. */
static void refine_runs_of_passing_rays(const struct glint_openings *o,
                                        const struct line *line, double x_mm[2])
{
    int first = -1;

    for (int i = 0; i <= LINE; i++) {
        const bool may = i < LINE && can_any_ray_pass_between(o, line, i);

        if (may && first < 0)
            first = i;
        if (!may && first >= 0) {
            double run[2] = {line->x0_mm + first * line->step_mm,
                             line->x0_mm + i * line->step_mm};

            if (refine_range_of_passing_rays(o, run) &&
                run[1] - run[0] > x_mm[1] - x_mm[0]) {
                x_mm[0] = run[0];
                x_mm[1] = run[1];
            }
            first = -1;
        }
    }
}

bool glint_spot_find_passing_range(const struct glint_openings *o,
                                   const struct glint_pupil *front,
                                   double x_mm[2])
{
    const double length = (front->x1_mm - front->x0_mm) / LINES;
    struct line line;

    x_mm[0] = x_mm[1] = 0;
    for (int k = 0; k < LINES; k++) {
        trace_line_segment(o, front->x0_mm + k * length,
                           front->x0_mm + (k + 1) * length, &line);
        refine_runs_of_passing_rays(o, &line, x_mm);
    }
    return x_mm[1] > x_mm[0];
}

/* Returns whether any of N + 1 rays that start between (X0, Y0) and (X1, Y1)
 * passes. */
static bool has_passing_ray_on_segment(const struct glint_openings *o,
                                       double x0, double y0, double x1,
                                       double y1, int n)
{
    struct glint_launch from[BORDER + 1] = {{0, 0, {0, 0, 0}}};
    struct glint_ray ray[BORDER + 1];
    enum glint_ray_status status[BORDER + 1];
    bool any = false;

    for (int i = 0; i <= n; i++)
        from[i] = (struct glint_launch){
            x0 + (x1 - x0) * i / n,
            y0 + (y1 - y0) * i / n,
            {o->direction[0], o->direction[1], o->direction[2]}};
    glint_trace_many(o->path, n + 1, from, ray, status, NULL);
    for (int i = 0; i <= n && !any; i++)
        any = status[i] == GLINT_RAY_OK && is_ray_unblocked(o, &ray[i]);
    return any;
}

bool glint_spot_grow_pupil(const struct glint_openings *o,
                           struct glint_pupil *p)
{
    const struct glint_pupil before = *p;

    for (int k = 0; k < GROWTHS; k++) {
        const double x0 = p->x0_mm, x1 = p->x1_mm, y0 = p->y0_mm, y1 = p->y1_mm;
        const double wide = STEP * (x1 - x0), high = STEP * (y1 - y0);

        if (has_passing_ray_on_segment(o, x0, y0, x0, y1, SHORT))
            p->x0_mm -= wide;
        if (has_passing_ray_on_segment(o, x1, y0, x1, y1, SHORT))
            p->x1_mm += wide;
        if (has_passing_ray_on_segment(o, x0, y1, x1, y1, BORDER))
            p->y1_mm += high;
        if (!p->mirrored &&
            has_passing_ray_on_segment(o, x0, y0, x1, y0, BORDER))
            p->y0_mm -= high;
        if (p->x0_mm == x0 && p->x1_mm == x1 && p->y0_mm == y0 &&
            p->y1_mm == y1)
            break;
    }
    return p->x0_mm < before.x0_mm || p->x1_mm > before.x1_mm ||
           p->y0_mm < before.y0_mm || p->y1_mm > before.y1_mm;
}
