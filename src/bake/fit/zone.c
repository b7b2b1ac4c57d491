/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "bake/fit/zone.h"
#include "base/compiler.h"
#include "bake/regress/regress.h"
#include "engine/setup/degrees.h"

/* A box is accepted if visible light fills at least this fraction of it. A
 * tighter box would need higher powers of s, which the polynomials of the
 * outputs would then have to compensate. */
#define ENOUGH_FILL 0.6
/* A box of higher degree in s is chosen only if light fills this many times as
 * much of it. */
#define FULLER 1.6

double glint_zone_compute_node(int k, int n)
{
    return n == 1 ? 0 : -cos(GLINT_PI * k / (n - 1));
}

double
glint_zone_evaluate_round_box_polynomial(const double side[GLINT_BOX_TERMS],
                                         double s, double w)
{
    double value = 0;

    for (int k = GLINT_BOX_POWERS - 1; k >= 0; k--)
        value = value * s + side[k];
    return value +
           w * (side[GLINT_BOX_POWERS] + s * side[GLINT_BOX_POWERS + 1]);
}

double glint_zone_evaluate_box_polynomial(const struct glint_zone *zone,
                                          const double side[GLINT_BOX_TERMS],
                                          const double x[GLINT_VARIABLES])
{
    const double s = x[GLINT_S], p = x[GLINT_P];

    if (!zone->skew)
        return glint_zone_evaluate_round_box_polynomial(side, s, x[GLINT_W]);
    return side[0] + s * (side[1] + s * side[2]) +
           p * (side[3] + s * side[4] + p * side[5]) +
           x[GLINT_W] *
               (side[GLINT_BOX_POWERS] + s * side[GLINT_BOX_POWERS + 1]);
}

/* the visible boxes that a zone's box must contain, at zone coordinates s and
 * w */
enum { MAX_BOXES = GLINT_PROFILE * GLINT_VISIBLE_WAVES };
STATIC_ASSERT((int)MAX_BOXES <= (int)GLINT_REGRESS_PLANES);

struct seen {
    int n, n_angles;
    double s[MAX_BOXES], w[MAX_BOXES];
    double middle[MAX_BOXES], half_x[MAX_BOXES], half_y[MAX_BOXES];
    double narrowest;
};

static void append_visible_box(struct seen *seen, double s, double w,
                               const struct glint_pupil *box)
{
    const int i = seen->n++;

    seen->s[i] = s;
    seen->w[i] = w;
    seen->middle[i] = 0.5 * (box->x0_mm + box->x1_mm);
    seen->half_x[i] = 0.5 * (box->x1_mm - box->x0_mm);
    seen->half_y[i] = box->y1_mm;
    seen->narrowest = fmin(seen->narrowest, seen->half_x[i]);
}

/* Collects the visible boxes of all angles in the zone and of one more angle at
 * each end, so that the zone's ends are covered. */
static void collect_visible_boxes(const struct glint_visible_profile *p,
                                  double lo, double hi, bool by_colour,
                                  struct seen *seen)
{
    int first = 0, last = p->n - 1;

    while (first + 1 < last && p->sine[first + 1] <= lo)
        first++;
    while (last - 1 > first && p->sine[last - 1] >= hi)
        last--;
    seen->n = 0;
    seen->n_angles = last - first + 1;
    seen->narrowest = HUGE_VAL;
    for (int k = first; k <= last && !by_colour; k++)
        append_visible_box(seen, (2 * p->sine[k] - lo - hi) / (hi - lo), 0,
                           &p->box[k]);
    for (int k = 0; k < p->n_samples && by_colour; k++) {
        const struct glint_box_sample *g = &p->sample[k];

        if (g->sine >= p->sine[first] && g->sine <= p->sine[last])
            append_visible_box(seen, (2 * g->sine - lo - hi) / (hi - lo), g->w,
                               &g->box);
    }
}

/* Fits the box polynomial SIDE to VALUE within TOLERANCE, or as closely as
 * possible. Terms: powers of s up to DEGREE; BY_COLOUR: also w and s w. */
static void fit_box_polynomial(const struct seen *seen, const double *value,
                               int degree, bool by_colour, double tolerance,
                               double side[GLINT_BOX_TERMS])
{
    static const double zero[MAX_BOXES];
    double scratch[GLINT_REGRESS_DOUBLES(MAX_BOXES, MAX_BOXES, 1,
                                         2 * GLINT_BOX_POWERS)];
    double weight[MAX_BOXES];
    const struct glint_regress_samples samples = {
        seen->n, {zero, zero, seen->s, seen->w}, weight};
    const int total = degree < 2 ? 2 : degree;
    const struct glint_degrees degrees = {
        .most = {0, 0, (uint8_t)degree, by_colour},
        .weight = {1, 1, 1, (uint8_t)(total - 1)},
        .total = total,
        .parity = -1,
        .terms = GLINT_BOX_TERMS};
    struct glint_poly fit;

    for (int i = 0; i < seen->n; i++)
        weight[i] = 1;
    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        side[k] = 0;
    glint_regress_fit_polynomial(scratch, &samples, value, &degrees, tolerance,
                                 4 * tolerance, &fit);
    for (int k = 0; k < fit.n; k++)
        side[fit.power[k][3] ? GLINT_BOX_POWERS + fit.power[k][2]
                             : fit.power[k][2]] = fit.coef[k];
}

/* Returns minus the min over the zone, sampled, of the half-size polynomial
 * HALF, mm. After adding it, no sampled half size is negative. */
static double compute_half_size_deficit(const double half[GLINT_BOX_TERMS])
{
    double lowest = HUGE_VAL;

    for (int k = -8; k <= 8; k++)
        lowest = fmin(
            lowest,
            fmin(glint_zone_evaluate_round_box_polynomial(half, k / 8.0, -1),
                 glint_zone_evaluate_round_box_polynomial(half, k / 8.0, 1)));
    return -lowest;
}

/* Enlarges the box of Z until it contains all visible boxes, with a margin of
 * 1 %. */
static void enlarge_box_to_visible_boxes(struct glint_zone *z,
                                         const struct seen *seen)
{
    double more_x = 0, more_y = 0;

    for (int i = 0; i < seen->n; i++) {
        const double s = seen->s[i], w = seen->w[i];
        const double off =
            fabs(seen->middle[i] -
                 glint_zone_evaluate_round_box_polynomial(z->middle, s, w));

        more_x =
            fmax(more_x,
                 seen->half_x[i] + off -
                     glint_zone_evaluate_round_box_polynomial(z->half_x, s, w));
        more_y =
            fmax(more_y,
                 seen->half_y[i] -
                     glint_zone_evaluate_round_box_polynomial(z->half_y, s, w));
    }
    z->half_x[0] += more_x;
    z->half_y[0] += more_y;
    z->half_x[0] +=
        fmax(0.01 * z->half_x[0], 1.1 * compute_half_size_deficit(z->half_x));
    z->half_y[0] +=
        fmax(0.01 * z->half_y[0], 1.1 * compute_half_size_deficit(z->half_y));
}

static double compute_box_fill(const struct glint_zone *z,
                               const struct seen *seen)
{
    double sum = 0;

    for (int i = 0; i < seen->n; i++)
        sum += seen->half_x[i] * seen->half_y[i] /
               (glint_zone_evaluate_round_box_polynomial(z->half_x, seen->s[i],
                                                         seen->w[i]) *
                glint_zone_evaluate_round_box_polynomial(z->half_y, seen->s[i],
                                                         seen->w[i]));
    return sum / seen->n;
}

static void fit_zone_box(struct glint_zone *z, const struct seen *seen,
                         int degree, bool by_colour)
{
    const double tolerance = 0.02 * seen->narrowest;
    const int tame = degree < 2 ? degree : 2;

    fit_box_polynomial(seen, seen->middle, degree, by_colour, tolerance,
                       z->middle);
    fit_box_polynomial(seen, seen->half_x, tame, by_colour, tolerance,
                       z->half_x);
    fit_box_polynomial(seen, seen->half_y, tame, by_colour, tolerance,
                       z->half_y);
    enlarge_box_to_visible_boxes(z, seen);
    z->fill = compute_box_fill(z, seen);
}

void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour)
{
    struct seen seen;
    int most;

    collect_visible_boxes(profile, lo, hi, by_colour, &seen);
    most = seen.n_angles > 12 ? GLINT_BOX_POWERS - 1 : (seen.n_angles - 1) / 2;
    *zone = (struct glint_zone){.fill = 0};
    for (int degree = most < 1 ? most : 1;
         degree <= most && zone->fill < ENOUGH_FILL; degree++) {
        struct glint_zone z = {.lo = lo, .hi = hi};

        fit_zone_box(&z, &seen, degree, by_colour);
        if (z.fill > FULLER * zone->fill)
            *zone = z;
    }
}

/* Substitutes w in the box polynomial SIDE such that -1 .. 1 becomes
 * W0 .. W1. */
static void narrow_band_of_polynomial(double side[GLINT_BOX_TERMS], double w0,
                                      double w1)
{
    double *of_w = side + GLINT_BOX_POWERS;

    for (int k = 0; k < 2; k++) {
        side[k] += 0.5 * (w0 + w1) * of_w[k];
        of_w[k] *= 0.5 * (w1 - w0);
    }
}

double glint_zone_get_inner_rim(int annulus)
{
    return annulus / (annulus + 1.0);
}

void glint_zone_halve_part(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second)
{
    const int k = part->annulus;

    *first = *second = *part;
    /* the part spans heights k .. k + 1, in units of 1 / (k + 1) of its outer
     * height */
    if (along_v) {
        first->top *= (2 * k + 1) / (2 * k + 2.0);
        first->annulus = 2 * k;
        second->annulus = 2 * k + 1;
    } else {
        first->u1 = second->u0 = 0.5 * (part->u0 + part->u1);
    }
}

void glint_zone_cut_to_part(struct glint_zone *zone,
                            const struct glint_zone_part *part)
{
    for (int k = 0; k < GLINT_BOX_TERMS; k++) {
        zone->middle[k] += 0.5 * (part->u0 + part->u1) * zone->half_x[k];
        zone->half_x[k] *= 0.5 * (part->u1 - part->u0);
        zone->half_y[k] *= part->top;
    }
    narrow_band_of_polynomial(zone->middle, part->w0, part->w1);
    narrow_band_of_polynomial(zone->half_x, part->w0, part->w1);
    narrow_band_of_polynomial(zone->half_y, part->w0, part->w1);
    zone->annulus = part->annulus;
}

/* roots of x^5 = x + 1 and x^6 = x + 1 */
#define ROOT_5 1.16730397826141868426
#define ROOT_6 1.13472413840151949260

/* Returns coordinate STEP of point K of a low-discrepancy sequence, -1 .. 1:
 * the fractional part of 1/2 + (K + 1) STEP, scaled. Points fill n dimensions
 * evenly if coordinate i has STEP 1 / g^i, where g is the root of
 * x^(n + 1) = x + 1. */
static double compute_sequence_coordinate(int k, double step)
{
    const double x = 0.5 + (k + 1) * step;

    return 2 * (x - (int)x) - 1;
}

void glint_zone_set_scattered_point(const struct glint_zone *zone, int k,
                                    double x[GLINT_VARIABLES])
{
    static const double round[] = {1 / ROOT_5, 1 / ROOT_5 / ROOT_5,
                                   1 / ROOT_5 / ROOT_5 / ROOT_5,
                                   1 / ROOT_5 / ROOT_5 / ROOT_5 / ROOT_5, 0};
    static const double skew[] = {
        1 / ROOT_6, 1 / ROOT_6 / ROOT_6, 1 / ROOT_6 / ROOT_6 / ROOT_6,
        1 / ROOT_6 / ROOT_6 / ROOT_6 / ROOT_6,
        1 / ROOT_6 / ROOT_6 / ROOT_6 / ROOT_6 / ROOT_6};

    for (int i = 0; i < GLINT_VARIABLES; i++)
        x[i] = compute_sequence_coordinate(k, zone->skew ? skew[i] : round[i]);
    if (zone->skew)
        return;
    x[GLINT_V] = fabs(x[GLINT_V]);
    x[GLINT_P] = 0;
}

static void compute_light_direction(const struct glint_zone *z,
                                    const double x[GLINT_VARIABLES],
                                    double d[3])
{
    d[0] = 0.5 * (z->lo + z->hi) + 0.5 * x[GLINT_S] * (z->hi - z->lo);
    d[1] = z->skew ? 0.5 * (z->y_lo + z->y_hi) +
                         0.5 * x[GLINT_P] * (z->y_hi - z->y_lo)
                   : 0;
    d[2] = sqrt(fmax(1e-6, 1 - d[0] * d[0] - d[1] * d[1]));
}

void glint_zone_batch_add_ray(struct glint_zone_batch *batch,
                              const struct glint_zone *zone,
                              const double x[GLINT_VARIABLES])
{
    const double rim = glint_zone_get_inner_rim(zone->annulus);
    struct glint_launch *from = &batch->from[batch->n];

    for (int k = 0; k < GLINT_VARIABLES; k++)
        batch->x[batch->n][k] = x[k];
    batch->x[batch->n][1] = rim + (1 - rim) * x[1];
    from->x_mm =
        glint_zone_evaluate_box_polynomial(zone, zone->middle, x) +
        x[0] * glint_zone_evaluate_box_polynomial(zone, zone->half_x, x);
    from->y_mm = batch->x[batch->n][1] *
                 glint_zone_evaluate_box_polynomial(zone, zone->half_y, x);
    if (zone->skew)
        from->y_mm +=
            glint_zone_evaluate_box_polynomial(zone, zone->middle_y, x);
    compute_light_direction(zone, x, from->direction);
    batch->n++;
}

void glint_zone_batch_trace_rays(struct glint_zone_batch *batch, bool hits)
{
    for (int k = 0; k < batch->n * batch->path->n_events && hits; k++)
        batch->hits[k][0] = batch->hits[k][1] = -1;
    glint_trace_many(batch->path, batch->n, batch->from, batch->ray,
                     batch->status, hits ? batch->hits : NULL);
}

/* Shrinks the interval *FROM .. *TO to its part LOW .. HIGH, in relative
 * coordinates -1 .. 1. */
static void shrink_interval(double low, double high, double *from, double *to)
{
    const double middle = 0.5 * (*from + *to), half = 0.5 * (*to - *from);

    *from = middle + fmax(-1, low) * half;
    *to = middle + fmin(1, high) * half;
}

/* numbers of angles, columns and rows of the rays that look for the visible
 * region of a part */
enum { ANGLES = 5, COLUMNS = 32, ROWS = 12 };

/* bounds of the visible rays in u and w, and the max of v */
struct sighting {
    double u[2], w[2], v;
};

static bool is_ray_in_sighting(const struct sighting *seen,
                               const double x[GLINT_VARIABLES])
{
    return x[0] >= seen->u[0] && x[0] <= seen->u[1] && x[1] <= seen->v &&
           x[GLINT_W] >= seen->w[0] && x[GLINT_W] <= seen->w[1];
}

static void extend_sighting(struct sighting *seen,
                            const double x[GLINT_VARIABLES])
{
    seen->u[0] = fmin(seen->u[0], x[0]);
    seen->u[1] = fmax(seen->u[1], x[0]);
    seen->v = fmax(seen->v, x[1]);
    seen->w[0] = fmin(seen->w[0], x[GLINT_W]);
    seen->w[1] = fmax(seen->w[1], x[GLINT_W]);
}

/* Traces the rays of batch T, at wavelength index WAVE, at this and all
 * neighbouring zoom positions, extends SEEN by the visible ones, and empties
 * T. */
static void trace_at_zoom_positions(const struct glint_visible *visible,
                                    int wave, struct glint_zone_batch *t,
                                    struct sighting *seen)
{
    for (int m = 0; m <= visible->n_beside && t->n; m++) {
        const struct glint_visible *const h =
            glint_visible_get_member(visible, m);

        t->path = &h->position_path[wave];
        glint_zone_batch_trace_rays(t, false);
        for (int i = 0; i < t->n; i++)
            if (t->status[i] == GLINT_RAY_OK &&
                glint_visible_is_ray_visible(h, &t->ray[i]))
                extend_sighting(seen, t->x[i]);
    }
    t->n = 0;
}

/* Extends SEEN by the visible rays of a grid over ZONE at wavelength index
 * WAVE, ANGLES x (ROWS + 1) x COLUMNS. Rows are traced from the last one on,
 * and only rays that can extend SEEN. */
static void sight_rays_of_wave(const struct glint_zone *zone,
                               const struct glint_visible *visible, int wave,
                               struct sighting *seen)
{
    const double w = glint_zone_compute_node(wave, GLINT_VISIBLE_WAVES);
    struct glint_zone_batch t = {.n = 0};

    for (int k = ANGLES * (ROWS + 1) * COLUMNS - 1; k >= 0; k--) {
        const int line = k / COLUMNS, row = line / ANGLES;
        const double x[GLINT_VARIABLES] = {
            2.0 * (k % COLUMNS) / (COLUMNS - 1) - 1, (double)row / ROWS,
            2.0 * (line % ANGLES) / (ANGLES - 1) - 1, w};

        glint_zone_batch_add_ray(&t, zone, x);
        t.n -= is_ray_in_sighting(seen, t.x[t.n - 1]);
        if (t.n == GLINT_ZONE_BATCH)
            trace_at_zoom_positions(visible, wave, &t, seen);
    }
    trace_at_zoom_positions(visible, wave, &t, seen);
}

double glint_zone_crop_part(const struct glint_zone *zone,
                            const struct glint_visible *visible,
                            struct glint_zone_part *part)
{
    /* Fewer wavelengths for non-spherical surfaces, through which rays are slow
     * to trace; the colours of such lenses rarely separate. */
    const int stride = visible->shaped ? (GLINT_VISIBLE_WAVES - 1) / 2 : 1;
    const int last = GLINT_VISIBLE_WAVES - 1;
    const double margin = 3.0 / COLUMNS;
    const struct glint_zone_part before = *part;
    struct sighting seen = {{9, -9}, {9, -9}, -9};

    /* the ends of the band first: they set its bounds */
    sight_rays_of_wave(zone, visible, last, &seen);
    for (int wave = 0; wave < last; wave += stride)
        sight_rays_of_wave(zone, visible, wave, &seen);
    if (seen.u[1] < seen.u[0])
        return 0;
    shrink_interval(seen.u[0] - margin, seen.u[1] + margin, &part->u0,
                    &part->u1);
    shrink_interval(seen.w[0] - 0.3, seen.w[1] + 0.3, &part->w0, &part->w1);
    if (!part->annulus)
        part->top *= fmin(1, seen.v + 1.5 / ROWS);
    return (part->u1 - part->u0) / (before.u1 - before.u0) *
           (part->w1 - part->w0) / (before.w1 - before.w0) * part->top /
           before.top;
}
