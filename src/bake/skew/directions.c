/* SPDX-License-Identifier: MIT */
#include "bake/skew/directions.h"

#include <math.h>

enum { ACROSS = 16, ROUNDS = 4, GROWS = 6 };

static const int waves[GLINT_PATCH_WAVES] = {GLINT_VISIBLE_WAVES / 2, 0,
                                             GLINT_VISIBLE_WAVES - 1};

/* Returns the value in LO .. HI that is nearest to 0. */
static double get_value_nearest_zero(double lo, double hi)
{
    return fmax(lo, fmin(hi, 0));
}

double glint_directions_get_min_sine(const struct glint_directions *patch)
{
    return hypot(get_value_nearest_zero(patch->x0, patch->x1),
                 get_value_nearest_zero(patch->y0, patch->y1));
}

/* ------------------------------------------------------------------- boxes */

/* range of columns and rows of a grid that contain unblocked rays */
struct extent {
    int i0, i1, j0, j1;
};

/* Traces a grid of rays over BOX and sets E to the range of the unblocked ones.
 * Returns whether there are any. */
static bool trace_ray_grid(const struct glint_visible *h,
                           const struct glint_path *path,
                           const double direction[3],
                           const struct glint_pupil *box, struct extent *e)
{
    struct glint_row row = {ACROSS + 1,
                            box->x0_mm,
                            (box->x1_mm - box->x0_mm) / ACROSS,
                            0,
                            {direction[0], direction[1], direction[2]}};
    struct glint_ray ray[ACROSS + 1];
    enum glint_ray_status status[ACROSS + 1];

    *e = (struct extent){ACROSS + 1, -1, ACROSS + 1, -1};
    for (int j = 0; j <= ACROSS; j++) {
        row.y_mm = box->y0_mm + (box->y1_mm - box->y0_mm) * j / ACROSS;
        glint_trace_row(path, &row, ray, status, NULL);
        for (int i = 0; i <= ACROSS; i++) {
            if (status[i] != GLINT_RAY_OK ||
                !glint_visible_is_ray_visible(h, &ray[i]))
                continue;
            e->i0 = i < e->i0 ? i : e->i0;
            e->i1 = i > e->i1 ? i : e->i1;
            e->j0 = j < e->j0 ? j : e->j0;
            e->j1 = j;
        }
    }
    return e->i1 >= 0;
}

static double compute_box_area(const struct glint_pupil *p)
{
    return (p->x1_mm - p->x0_mm) * (p->y1_mm - p->y0_mm);
}

/* Shrinks BOX in several rounds to its unblocked rays, with a margin of one
 * cell. Returns whether there are any. */
static bool shrink_box_to_visible(const struct glint_visible *h,
                                  const struct glint_path *path,
                                  const double direction[3],
                                  struct glint_pupil *box)
{
    for (int round = 0; round < ROUNDS; round++) {
        const struct glint_pupil old = *box;
        const double dx = (old.x1_mm - old.x0_mm) / ACROSS;
        const double dy = (old.y1_mm - old.y0_mm) / ACROSS;
        struct extent e;

        if (!trace_ray_grid(h, path, direction, box, &e))
            return round > 0;
        box->x0_mm = old.x0_mm + dx * fmax(0, e.i0 - 1);
        box->x1_mm = old.x0_mm + dx * fmin(ACROSS, e.i1 + 1);
        box->y0_mm = old.y0_mm + dy * fmax(0, e.j0 - 1);
        box->y1_mm = old.y0_mm + dy * fmin(ACROSS, e.j1 + 1);
        if (compute_box_area(box) > 0.8 * compute_box_area(&old))
            break;
    }
    return true;
}

/* Finds the box of unblocked rays by enlarging NEAR, the box found for another
 * direction or wavelength, on each side where light still passes. Returns false
 * if no box is found. */
static bool grow_box_to_visible(const struct glint_visible *h,
                                const struct glint_path *path,
                                const double direction[3],
                                const struct glint_pupil *near,
                                struct glint_pupil *box)
{
    *box = *near;
    for (int round = 0; round < GROWS; round++) {
        const double x = 0.25 * (box->x1_mm - box->x0_mm);
        const double y = 0.25 * (box->y1_mm - box->y0_mm);
        struct extent e;

        if (round == 0)
            e = (struct extent){0, ACROSS, 0, ACROSS};
        else if (!trace_ray_grid(h, path, direction, box, &e))
            return false;
        if (e.i0 > 0 && e.i1 < ACROSS && e.j0 > 0 && e.j1 < ACROSS)
            return shrink_box_to_visible(h, path, direction, box);
        box->x0_mm -= e.i0 == 0 ? x : 0;
        box->x1_mm += e.i1 == ACROSS ? x : 0;
        box->y0_mm -= e.j0 == 0 ? y : 0;
        box->y1_mm += e.j1 == ACROSS ? y : 0;
    }
    return false;
}

static bool find_visible_box(const struct glint_visible *h,
                             const struct glint_path *path,
                             const double direction[3], struct glint_pupil *box)
{
    return glint_pupil_find_towards(box, path, direction,
                                    h->setup->optics.stop_radius_mm,
                                    h->field_mm, NULL) &&
           shrink_box_to_visible(h, path, direction, box);
}

/* a direction of a patch, and its indices along s and p */
struct place {
    int i, j;
    double direction[3];
};

/* Returns the coordinate -1 .. 1 of direction K along a side of a patch. */
static double compute_patch_coordinate(int k)
{
    return 2.0 * k / (GLINT_PATCH_SIDE - 1) - 1;
}

/* Maps X linearly from LO .. HI to -1 .. 1. */
static double map_to_unit_range(double x, double lo, double hi)
{
    return (2 * x - lo - hi) / (hi - lo);
}

/* Sets BOX to the box of ZONE for light along DIRECTION at wavelength K (index
 * in waves). */
static void evaluate_zone_box(const struct glint_zone *zone,
                              const double direction[3], int k,
                              struct glint_pupil *box)
{
    const double x[GLINT_VARIABLES] = {
        [GLINT_S] = map_to_unit_range(direction[0], zone->lo, zone->hi),
        [GLINT_W] = glint_zone_compute_node(waves[k], GLINT_VISIBLE_WAVES),
        [GLINT_P] = map_to_unit_range(direction[1], zone->y_lo, zone->y_hi)};
    const double half_x =
        glint_zone_evaluate_box_polynomial(zone, zone->half_x, x);
    const double half_y =
        glint_zone_evaluate_box_polynomial(zone, zone->half_y, x);

    box->x0_mm =
        glint_zone_evaluate_box_polynomial(zone, zone->middle, x) - half_x;
    box->x1_mm = box->x0_mm + 2 * half_x;
    box->y0_mm =
        glint_zone_evaluate_box_polynomial(zone, zone->middle_y, x) - half_y;
    box->y1_mm = box->y0_mm + 2 * half_y;
}

/* Finds the pupil box of unblocked rays for direction AT and wavelength K.
 * Searches near the box found last, then in the whole pupil. Corners of the
 * patch skip the first search. WITHIN: see glint_sights_find_boxes(). */
static bool find_box_at_direction(const struct glint_visible *h,
                                  const struct place *at, int k,
                                  const struct glint_zone *within,
                                  const struct glint_sights *seen,
                                  struct glint_pupil *box)
{
    const int last = GLINT_PATCH_SIDE - 1;
    const bool corner = at->i % last == 0 && at->j % last == 0 && k == 0;
    const struct glint_path *path = &h->position_path[waves[k]];

    if (within) {
        evaluate_zone_box(within, at->direction, k, box);
        return shrink_box_to_visible(h, path, at->direction, box);
    }
    return (!corner && seen->n > 0 &&
            grow_box_to_visible(h, path, at->direction,
                                &seen->at[seen->n - 1].box, box)) ||
           find_visible_box(h, path, at->direction, box);
}

/* Adds the boxes of visible light for one direction to SIGHTS. Every second
 * direction uses the middle wavelength only. */
static void add_direction_boxes(const struct glint_visible *h,
                                const struct place *at,
                                const struct glint_zone *within,
                                struct glint_sights *sights)
{
    const int n = (at->i + at->j) % 2 ? 1 : GLINT_PATCH_WAVES;

    for (int k = 0; k < n; k++) {
        struct glint_sight *to = &sights->at[sights->n];

        if (!find_box_at_direction(h, at, k, within, sights, &to->box))
            continue;
        to->x[GLINT_U] = to->x[GLINT_V] = 0;
        to->x[GLINT_S] = compute_patch_coordinate(at->i);
        to->x[GLINT_P] = compute_patch_coordinate(at->j);
        to->x[GLINT_W] = glint_zone_compute_node(waves[k], GLINT_VISIBLE_WAVES);
        sights->n++;
    }
}

void glint_sights_find_boxes(const struct glint_visible *visible,
                             const struct glint_directions *patch,
                             double sine_hi, const struct glint_zone *within,
                             struct glint_sights *sights)
{
    sights->n = 0;
    for (int k = 0; k < GLINT_PATCH_SIDE * GLINT_PATCH_SIDE; k++) {
        const int i = k % GLINT_PATCH_SIDE, j = k / GLINT_PATCH_SIDE;
        const double s = 0.5 + 0.5 * compute_patch_coordinate(i),
                     p = 0.5 + 0.5 * compute_patch_coordinate(j);
        const double x = patch->x0 + s * (patch->x1 - patch->x0);
        const double y = patch->y0 + p * (patch->y1 - patch->y0);
        const struct place at = {
            i, j, {x, y, sqrt(fmax(0, 1 - x * x - y * y))}};

        if (hypot(x, y) <= sine_hi)
            add_direction_boxes(visible, &at, within, sights);
    }
}

/* -------------------------------------------------------------------- zone */

enum { MOST = GLINT_PATCH_SIDE * GLINT_PATCH_SIDE * GLINT_PATCH_WAVES };

/* Samples for the fit of one box polynomial. VALUE is a component of each box:
 * its middle or half size along x or y. X holds the coordinates s, w and p of
 * each box. */
struct sides {
    int n;
    double x[3][MOST], value[MOST];
};

/* Fits the box polynomial SIDE to the samples SIDES. The polynomial has DEGREE
 * in the direction coordinates s and p, and is linear in the wavelength
 * coordinate w. Its error exceeds TOLERANCE if no such polynomial meets it. */
static void fit_box_polynomial(const struct sides *sides, int degree,
                               double tolerance, double side[GLINT_BOX_TERMS])
{
    static const double zero[MOST];
    static const int place[3][3] = {{0, 3, 5}, {1, 4, 0}, {2, 0, 0}};
    double scratch[GLINT_REGRESS_DOUBLES(MOST, MOST, 1, 3 * 2 * 3)];
    double weight[MOST];
    const struct glint_regress_samples samples = {
        sides->n, {zero, zero, sides->x[0], sides->x[1], sides->x[2]}, weight};
    const struct glint_degrees degrees = {
        .most = {0, 0, (uint8_t)degree, 1, (uint8_t)degree},
        .weight = {1, 1, 1, 2, 1},
        .total = 2,
        .parity = -1,
        .terms = GLINT_BOX_TERMS - 1};
    struct glint_poly fit;

    for (int i = 0; i < sides->n; i++)
        weight[i] = 1;
    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        side[k] = 0;
    glint_regress_fit_polynomial(scratch, &samples, sides->value, &degrees,
                                 tolerance, 4 * tolerance, &fit);
    for (int k = 0; k < fit.n; k++)
        side[fit.power[k][GLINT_W]
                 ? GLINT_BOX_POWERS
                 : place[fit.power[k][GLINT_S]][fit.power[k][GLINT_P]]] =
            fit.coef[k];
}

/* Returns the number that must be added to the half-size polynomial HALF so
 * that its min over ZONE, which is sampled, becomes 0. */
static double compute_size_deficit(const struct glint_zone *zone,
                                   const double half[GLINT_BOX_TERMS])
{
    double lowest = HUGE_VAL;

    for (int k = 0; k < 9 * 9 * 2; k++) {
        const double x[GLINT_VARIABLES] = {
            0, 0, (k % 9 - 4) / 4.0, k / 81 ? 1 : -1, (k / 9 % 9 - 4) / 4.0};

        lowest =
            fmin(lowest, glint_zone_evaluate_box_polynomial(zone, half, x));
    }
    return -lowest;
}

static double compute_half_size(const struct glint_pupil *box, bool y)
{
    return y ? 0.5 * (box->y1_mm - box->y0_mm)
             : 0.5 * (box->x1_mm - box->x0_mm);
}

static double compute_box_middle(const struct glint_pupil *box, bool y)
{
    return y ? 0.5 * (box->y0_mm + box->y1_mm)
             : 0.5 * (box->x0_mm + box->x1_mm);
}

/* Sets the polynomials MIDDLE and HALF of ZONE's box, along y if Y is true,
 * else along x. The box then contains all boxes in SIGHTS. */
static void fit_middle_and_half_size(const struct glint_sights *sights,
                                     int degree, bool y,
                                     const struct glint_zone *zone,
                                     double middle[GLINT_BOX_TERMS],
                                     double half[GLINT_BOX_TERMS])
{
    struct sides of = {.n = sights->n};
    double narrowest = HUGE_VAL, more = 0;

    for (int i = 0; i < of.n; i++) {
        of.x[0][i] = sights->at[i].x[GLINT_S];
        of.x[1][i] = sights->at[i].x[GLINT_W];
        of.x[2][i] = sights->at[i].x[GLINT_P];
        narrowest = fmin(narrowest, compute_half_size(&sights->at[i].box, y));
        of.value[i] = compute_box_middle(&sights->at[i].box, y);
    }
    fit_box_polynomial(&of, degree, 0.02 * narrowest, middle);
    for (int i = 0; i < of.n; i++)
        of.value[i] = compute_half_size(&sights->at[i].box, y);
    fit_box_polynomial(&of, degree, 0.02 * narrowest, half);
    for (int i = 0; i < of.n; i++) {
        const double *x = sights->at[i].x;
        const double off =
            fabs(compute_box_middle(&sights->at[i].box, y) -
                 glint_zone_evaluate_box_polynomial(zone, middle, x));

        more =
            fmax(more, of.value[i] + off -
                           glint_zone_evaluate_box_polynomial(zone, half, x));
    }
    half[0] += more;
    half[0] += fmax(0.01 * half[0], 1.1 * compute_size_deficit(zone, half));
}

static double compute_box_fill(const struct glint_sights *sights,
                               const struct glint_zone *zone)
{
    double sum = 0;

    for (int i = 0; i < sights->n; i++) {
        const struct glint_sight *v = &sights->at[i];

        sum += compute_half_size(&v->box, false) *
               compute_half_size(&v->box, true) /
               (glint_zone_evaluate_box_polynomial(zone, zone->half_x, v->x) *
                glint_zone_evaluate_box_polynomial(zone, zone->half_y, v->x));
    }
    return sum / sights->n;
}

void glint_sights_fit_zone(const struct glint_sights *sights,
                           const struct glint_directions *patch,
                           struct glint_zone *zone)
{
    /* These values must equal ENOUGH_FILL and FULLER in zone.c. */
    const double enough = 0.6, fuller = 1.6;

    *zone = (struct glint_zone){.fill = 0};
    for (int degree = 0; degree <= 2 && zone->fill < enough; degree++) {
        struct glint_zone z = {.lo = patch->x0,
                               .hi = patch->x1,
                               .skew = true,
                               .y_lo = patch->y0,
                               .y_hi = patch->y1};

        fit_middle_and_half_size(sights, degree, false, &z, z.middle, z.half_x);
        fit_middle_and_half_size(sights, degree, true, &z, z.middle_y,
                                 z.half_y);
        z.fill = compute_box_fill(sights, &z);
        if (z.fill > fuller * zone->fill)
            *zone = z;
    }
}
