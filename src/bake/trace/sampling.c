/* SPDX-License-Identifier: MIT */
#include "bake/trace/sampling.h"

#include <math.h>
#include <stdbool.h>

/* number of rays per call of the tracer */
enum { SOME = 16 };

/* Weight that a pair of rays adds to a barrel if it proves that the barrel
 * blocks light. A pair that only suggests it adds 1. */
enum { SHOWN = 1000 };

/* one ray of the sparse grid */
struct probe {
    bool traced, inside;
    double x_mm, y_mm; /* position on the sensor, mm */
    double stop_x, stop_y, stop_r2;
    /* squared relative radius at each event */
    double r2[GLINT_MAX_EVENTS + 1];
};

/* Sets P from the traced RAY and its positions HITS at the events of PATH. */
static void set_probe_from_ray(struct probe *p, const struct glint_path *path,
                               const struct glint_ray *ray, double (*hits)[2],
                               double stop_radius_mm)
{
    const double sx = ray->stop_x_mm / stop_radius_mm;
    const double sy = ray->stop_y_mm / stop_radius_mm;

    *p = (struct probe){.traced = true,
                        .x_mm = ray->sensor_x_mm,
                        .y_mm = ray->sensor_y_mm,
                        .stop_x = sx,
                        .stop_y = sy,
                        .stop_r2 = sx * sx + sy * sy};
    p->inside = p->stop_r2 <= 1 && ray->rel_radius <= 1;
    for (int k = 0; k < path->n_events; k++) {
        const struct glint_event *e = &path->event[k];
        const double hx = hits[k][0] / e->semi_mm, hy = hits[k][1] / e->semi_mm;

        p->r2[k] = e->kind == GLINT_STOP ? 0 : hx * hx + hy * hy;
    }
}

/* Sets ROW to the SIDE + 1 rays that start at height Y on PUPIL, mm. */
static void trace_probe_row(struct probe *row, const struct glint_path *path,
                            const struct glint_pupil *pupil, double y,
                            const double direction[3], double stop_radius_mm,
                            int side)
{
    double hits[SOME * (GLINT_MAX_EVENTS + 1)][2];
    struct glint_launch from[SOME];
    struct glint_ray ray[SOME];
    enum glint_ray_status status[SOME];

    for (int first = 0; first <= side; first += SOME) {
        const int n = side + 1 - first < SOME ? side + 1 - first : SOME;

        for (int k = 0; k < n; k++)
            from[k] = (struct glint_launch){
                pupil->x0_mm +
                    (pupil->x1_mm - pupil->x0_mm) * (first + k) / side,
                y,
                {direction[0], direction[1], direction[2]}};
        glint_trace_many(path, n, from, ray, status, hits);
        for (int k = 0; k < n; k++) {
            row[first + k].traced = false;
            if (status[k] == GLINT_RAY_OK)
                set_probe_from_ray(&row[first + k], path, &ray[k],
                                   hits + k * path->n_events, stop_radius_mm);
        }
    }
}

/* Adds weight to the barrel that blocks ray P, if only one barrel does; the
 * test has a margin for the gaps between rays. If several barrels block a ray
 * that passes the stop, as beyond a caustic, adds weight to the one with the
 * largest relative radius. */
static void weight_blocking_barrel(const struct probe *p, int n, int *weight)
{
    const double margin = 1.1;
    double worst = p->traced ? p->stop_r2 : 0, second = 0;
    int at = -1;

    for (int k = 0; k < n && p->traced; k++) {
        const double r2 = p->r2[k];

        if (r2 > worst) {
            second = worst;
            worst = r2;
            at = k;
        } else if (r2 > second) {
            second = r2;
        }
    }
    if (at >= 0 && worst > 0.99 * 0.99 &&
        (second < margin * margin || p->stop_r2 < margin * margin))
        weight[at]++;
}

/* Returns where the rim of an opening lies between two rays, as a fraction of
 * the distance from the first ray. IN and OUT: the rays' squared relative
 * radii, interpolated linearly; the rim is at 1. IN is at most 1. Returns 2 if
 * OUT is at most 1, too. */
static double compute_rim_crossing_fraction(double in, double out)
{
    return out > 1 ? (1 - in) / (out - in) : 2;
}

/* Adds weight to the barrel at whose rim the light between the visible ray and
 * the blocked ray ends. Adds a small weight to barrels whose rim follows soon
 * after. */
static void weight_first_crossed_barrel(const struct probe *a,
                                        const struct probe *b, int n,
                                        int *weight)
{
    const struct probe *in = a, *out = b;
    double first;

    if (!a->traced || !b->traced || a->inside == b->inside)
        return;
    if (b->inside) {
        in = b;
        out = a;
    }
    first = compute_rim_crossing_fraction(in->stop_r2, out->stop_r2);
    for (int k = 0; k < n; k++)
        first =
            fmin(first, compute_rim_crossing_fraction(in->r2[k], out->r2[k]));
    for (int k = 0; k < n; k++) {
        const double at = compute_rim_crossing_fraction(in->r2[k], out->r2[k]);

        if (at <= first)
            weight[k] += SHOWN;
        else if (at < first + 0.2)
            weight[k]++;
    }
}

/* -------------------------------------------------------------------- bend */

/* sums of squared first and second differences of a quantity along grid
 * lines */
struct change {
    double first, second;
};

struct bend {
    int n;
    struct change sensor; /* mm */
    struct change stop;
    /* differences of r^2 / 2 at each event, where r is the relative radius */
    struct change barrel[GLINT_MAX_EVENTS + 1];
    /* numbers of cells whose image on the sensor is upright and mirrored */
    int up, down;
    int n_steps;
    /* sum of 1 / d over pairs of neighbouring rays; d: their distance in the
     * stop, in stop radii */
    double thick;
};

static void add_squared_differences(struct change *change, double a, double b,
                                    double c)
{
    change->first += 0.25 * (c - a) * (c - a);
    change->second += (a - 2 * b + c) * (a - 2 * b + c);
}

/* Adds the differences at ray B, whose neighbours on a grid line are A and
 * C. */
static void add_ray_differences(struct bend *bend, const struct probe *a,
                                const struct probe *b, const struct probe *c,
                                int n_events)
{
    if (!b->traced || !b->inside || !a->traced || !c->traced)
        return;
    add_squared_differences(&bend->sensor, a->x_mm, b->x_mm, c->x_mm);
    add_squared_differences(&bend->sensor, a->y_mm, b->y_mm, c->y_mm);
    add_squared_differences(&bend->stop, a->stop_x, b->stop_x, c->stop_x);
    add_squared_differences(&bend->stop, a->stop_y, b->stop_y, c->stop_y);
    for (int k = 0; k < n_events; k++)
        add_squared_differences(&bend->barrel[k], 0.5 * a->r2[k],
                                0.5 * b->r2[k], 0.5 * c->r2[k]);
    bend->n++;
}

/* Returns the RMS second difference of CUT per grid step, converted to mm on
 * the sensor. CUT: differences of the position at the stop or at a barrel. */
static double convert_bend_to_sensor_mm(const struct bend *bend,
                                        const struct change *cut)
{
    return cut->first > 0
               ? sqrt(cut->second / bend->n * bend->sensor.first / cut->first)
               : 0;
}

static double compute_outline_bend_mm(const struct bend *bend,
                                      const int *weight, int n_events)
{
    double most = convert_bend_to_sensor_mm(bend, &bend->stop);

    for (int k = 0; k < n_events; k++)
        if (weight[k] >= SHOWN)
            most =
                fmax(most, convert_bend_to_sensor_mm(bend, &bend->barrel[k]));
    return most;
}

/* Adds the distance d in the stop between rays A and B if the stop's opening
 * may lie between them: one of them is at most d outside it. Sums 1 / d, the
 * density of rays, because more light passes where rays are dense. */
static void add_distance_in_stop(struct bend *bend, const struct probe *a,
                                 const struct probe *b)
{
    double step;

    if (!a->traced || !b->traced)
        return;
    step = hypot(b->stop_x - a->stop_x, b->stop_y - a->stop_y);
    if (step == 0 || sqrt(fmin(a->stop_r2, b->stop_r2)) > 1 + step)
        return;
    bend->n_steps++;
    bend->thick += 1 / step;
}

/* Counts whether the image of a cell is mirrored. A: a corner of the cell; B:
 * the corner beside it; C: the corner below it. */
static void count_cell_orientation(struct bend *bend, const struct probe *a,
                                   const struct probe *b, const struct probe *c)
{
    double turn;

    if (!a->traced || !b->traced || !c->traced ||
        !(a->inside || b->inside || c->inside))
        return;
    turn = (b->x_mm - a->x_mm) * (c->y_mm - a->y_mm) -
           (b->y_mm - a->y_mm) * (c->x_mm - a->x_mm);
    bend->up += turn > 0;
    bend->down += turn < 0;
}

/* ---------------------------------------------------------------- sampling */

struct rows {
    /* the last three rows of the grid, in a ring buffer */
    struct probe row[3][GLINT_MAX_SAMPLING + 1];
};

static void add_grid_ray_to_sums(const struct rows *r, int i, int j,
                                 int n_events, int *weight, struct bend *bend)
{
    const struct probe *here = &r->row[j % 3][i];
    const struct probe *above = &r->row[(j + 2) % 3][i];

    weight_blocking_barrel(here, n_events, weight);
    if (i > 0) {
        weight_first_crossed_barrel(here - 1, here, n_events, weight);
        add_distance_in_stop(bend, here - 1, here);
    }
    if (j > 0) {
        weight_first_crossed_barrel(above, here, n_events, weight);
        add_distance_in_stop(bend, above, here);
    }
    if (i > 1)
        add_ray_differences(bend, here - 2, here - 1, here, n_events);
    if (j > 1)
        add_ray_differences(bend, &r->row[(j + 1) % 3][i], above, here,
                            n_events);
    if (i > 0 && j > 0)
        count_cell_orientation(bend, above - 1, above, here - 1);
}

void glint_sampling_trace_grid(struct glint_sampling *sampling,
                               const struct glint_path *path,
                               const struct glint_pupil *p,
                               const double direction[3], double stop_radius_mm,
                               int side)
{
    int weight[GLINT_MAX_EVENTS + 1] = {0};
    struct bend bend = {.n = 0};
    struct glint_path places = *path;
    struct rows r; /* 460 KB; see GLINT_BAKE_STACK_BYTES */

    places.places_only = true;
    for (int j = 0; j <= (path->round ? side / 2 : side); j++) {
        trace_probe_row(r.row[j % 3], &places, p,
                        path->round
                            ? p->y1_mm * 2 * j / side
                            : p->y0_mm + (p->y1_mm - p->y0_mm) * j / side,
                        direction, stop_radius_mm, side);
        for (int i = 0; i <= side; i++)
            add_grid_ray_to_sums(&r, i, j, path->n_events, weight, &bend);
    }
    sampling->bend_mm = sampling->outline_mm = sampling->round_mm = 0;
    sampling->n_inside = bend.n;
    sampling->step = bend.n_steps ? bend.n_steps / bend.thick * side : 0;
    if (bend.n) {
        sampling->bend_mm = sqrt(bend.sensor.second / bend.n) * side * side;
        sampling->outline_mm =
            compute_outline_bend_mm(&bend, weight, path->n_events) * side *
            side;
        /* On the stop's outline the relative radius r is 1, so the first
         * difference of r^2 / 2 equals the first difference of the stop
         * position s. The second difference is the square of the derivative of
         * s. */
        sampling->round_mm =
            sqrt(bend.stop.first * bend.sensor.first) / bend.n * side * side;
    }
    sampling->folds = bend.up > 0 && bend.down > 0;
    sampling->n_cuts = 0;
    for (int k = 0; k < path->n_events && sampling->n_cuts < GLINT_MAX_EVENTS;
         k++)
        if (weight[k]) {
            sampling->cut_event[sampling->n_cuts] = k;
            sampling->cut_weight[sampling->n_cuts++] = weight[k];
        }
}
