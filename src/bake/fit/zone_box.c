/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "bake/fit/zone.h"
#include "bake/regress/regress.h"
#include "engine/setup/degrees.h"

/* Share of a box: if as much of it is seen, that is enough. A fuller box would
 * need higher powers of s, and polynomials of what is seen through it would
 * have to undo them. */
#define ENOUGH_FILL 0.6
/* A higher degree in s is taken only if it fills the box so many times more. */
#define FULLER 1.6

double glint_zone_node(int k, int n)
{
    return n == 1 ? 0 : -cos(GLINT_PI * k / (n - 1));
}

double glint_zone_at(const double side[GLINT_BOX_TERMS], double s, double w)
{
    double value = 0;

    for (int k = GLINT_BOX_POWERS - 1; k >= 0; k--)
        value = value * s + side[k];
    return value +
           w * (side[GLINT_BOX_POWERS] + s * side[GLINT_BOX_POWERS + 1]);
}

double glint_zone_side(const struct glint_zone *zone,
                       const double side[GLINT_BOX_TERMS],
                       const double x[GLINT_VARIABLES])
{
    const double s = x[GLINT_S], p = x[GLINT_P];

    if (!zone->skew)
        return glint_zone_at(side, s, x[GLINT_W]);
    return side[0] + s * (side[1] + s * side[2]) +
           p * (side[3] + s * side[4] + p * side[5]) +
           x[GLINT_W] *
               (side[GLINT_BOX_POWERS] + s * side[GLINT_BOX_POWERS + 1]);
}

/* The boxes that a zone's box has to hold, at places s and w of the zone. */
enum { ROOM = GLINT_PROFILE * GLINT_VISIBLE_WAVES };

struct seen {
    int n, n_angles;
    double s[ROOM], w[ROOM];
    double middle[ROOM], half_x[ROOM], half_y[ROOM];
    double narrowest;
};

static void add(struct seen *seen, double s, double w,
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

/* Gathers the boxes of the zone and of one angle beyond each end, so that the
 * ends are covered. */
static void gather(const struct glint_visible_profile *p, double lo, double hi,
                   bool by_colour, struct seen *seen)
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
        add(seen, (2 * p->sine[k] - lo - hi) / (hi - lo), 0, &p->box[k]);
    for (int k = 0; k < p->n_samples && by_colour; k++) {
        const struct glint_box_sample *g = &p->sample[k];

        if (g->sine >= p->sine[first] && g->sine <= p->sine[last])
            add(seen, (2 * g->sine - lo - hi) / (hi - lo), g->w, &g->box);
    }
}

/* Sets SIDE to the polynomial that follows VALUE within TOLERANCE, or as well
 * as it can: powers of s up to DEGREE and, BY_COLOUR, w and s w. */
static void follow(const struct seen *seen, const double *value, int degree,
                   bool by_colour, double tolerance,
                   double side[GLINT_BOX_TERMS])
{
    static const double zero[ROOM];
    double scratch[GLINT_REGRESS_DOUBLES(ROOM, GLINT_BOX_TERMS, GLINT_BOX_TERMS,
                                         3 * (2 * GLINT_BOX_POWERS - 1))];
    double weight[ROOM];
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
    glint_regress_fit(scratch, &samples, value, &degrees, tolerance,
                      4 * tolerance, &fit);
    for (int k = 0; k < fit.n; k++)
        side[fit.power[k][3] ? GLINT_BOX_POWERS + fit.power[k][2]
                             : fit.power[k][2]] = fit.coef[k];
}

/* Returns minus the least value of the polynomial HALF over the zone, sampled:
 * what its constant lacks for 0 or more; negative if it has more than that. */
static double lacks(const double half[GLINT_BOX_TERMS])
{
    double lowest = HUGE_VAL;

    for (int k = -8; k <= 8; k++)
        lowest = fmin(lowest, fmin(glint_zone_at(half, k / 8.0, -1),
                                   glint_zone_at(half, k / 8.0, 1)));
    return -lowest;
}

/* Widens the box until it holds all that was seen, and by 1/100 more. */
static void widen(struct glint_zone *z, const struct seen *seen)
{
    double more_x = 0, more_y = 0;

    for (int i = 0; i < seen->n; i++) {
        const double s = seen->s[i], w = seen->w[i];
        const double off =
            fabs(seen->middle[i] - glint_zone_at(z->middle, s, w));

        more_x = fmax(more_x,
                      seen->half_x[i] + off - glint_zone_at(z->half_x, s, w));
        more_y = fmax(more_y, seen->half_y[i] - glint_zone_at(z->half_y, s, w));
    }
    z->half_x[0] += more_x;
    z->half_y[0] += more_y;
    z->half_x[0] += fmax(0.01 * z->half_x[0], 1.1 * lacks(z->half_x));
    z->half_y[0] += fmax(0.01 * z->half_y[0], 1.1 * lacks(z->half_y));
}

static double mean_fill(const struct glint_zone *z, const struct seen *seen)
{
    double sum = 0;

    for (int i = 0; i < seen->n; i++)
        sum += seen->half_x[i] * seen->half_y[i] /
               (glint_zone_at(z->half_x, seen->s[i], seen->w[i]) *
                glint_zone_at(z->half_y, seen->s[i], seen->w[i]));
    return sum / seen->n;
}

static void set_box(struct glint_zone *z, const struct seen *seen, int degree,
                    bool by_colour)
{
    const double tolerance = 0.02 * seen->narrowest;
    const int tame = degree < 2 ? degree : 2;

    follow(seen, seen->middle, degree, by_colour, tolerance, z->middle);
    follow(seen, seen->half_x, tame, by_colour, tolerance, z->half_x);
    follow(seen, seen->half_y, tame, by_colour, tolerance, z->half_y);
    widen(z, seen);
    z->fill = mean_fill(z, seen);
}

void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour)
{
    struct seen seen;
    int most;

    gather(profile, lo, hi, by_colour, &seen);
    most = seen.n_angles > 12 ? GLINT_BOX_POWERS - 1 : (seen.n_angles - 1) / 2;
    *zone = (struct glint_zone){.fill = 0};
    for (int degree = most < 1 ? most : 1;
         degree <= most && zone->fill < ENOUGH_FILL; degree++) {
        struct glint_zone z = {.lo = lo, .hi = hi};

        set_box(&z, &seen, degree, by_colour);
        if (z.fill > FULLER * zone->fill)
            *zone = z;
    }
}

/* Replaces w by W0 + (1 + w) / 2 * (W1 - W0). */
static void narrow(double side[GLINT_BOX_TERMS], double w0, double w1)
{
    double *of_w = side + GLINT_BOX_POWERS;

    for (int k = 0; k < 2; k++) {
        side[k] += 0.5 * (w0 + w1) * of_w[k];
        of_w[k] *= 0.5 * (w1 - w0);
    }
}

double glint_zone_rim(int annulus)
{
    return annulus / (annulus + 1.0);
}

void glint_zone_part_halve(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second)
{
    const int k = part->annulus;

    *first = *second = *part;
    if (along_v) { /* The part spans k .. k + 1 in units of 1 / (k + 1) of its
                      height. */
        first->top *= (2 * k + 1) / (2 * k + 2.0);
        first->annulus = 2 * k;
        second->annulus = 2 * k + 1;
    } else {
        first->u1 = second->u0 = 0.5 * (part->u0 + part->u1);
    }
}

void glint_zone_cut(struct glint_zone *zone, const struct glint_zone_part *part)
{
    for (int k = 0; k < GLINT_BOX_TERMS; k++) {
        zone->middle[k] += 0.5 * (part->u0 + part->u1) * zone->half_x[k];
        zone->half_x[k] *= 0.5 * (part->u1 - part->u0);
        zone->half_y[k] *= part->top;
    }
    narrow(zone->middle, part->w0, part->w1);
    narrow(zone->half_x, part->w0, part->w1);
    narrow(zone->half_y, part->w0, part->w1);
    zone->annulus = part->annulus;
}
