/* SPDX-License-Identifier: MIT */
#include "engine/setup/dust.h"

#include <math.h>
#include <stdint.h>

#include "glint/view.h"

/* min and max radius of round specks of dust, stop radii; large specks are
 * rarer */
static const double least_radius = 0.01, most_radius = 0.05;

struct draw {
    uint64_t state;
};

/* Returns a random number, 0 <= x < 1. It is made of the upper bits of a linear
 * congruential generator, so it is the same on every machine. */
static double generate_random(struct draw *d)
{
    d->state = d->state * UINT64_C(6364136223846793005) +
               UINT64_C(1442695040888963407);
    return (double)(d->state >> 40) * 0x1p-24;
}

static double generate_random_between(struct draw *d, double a, double b)
{
    return a + (b - a) * generate_random(d);
}

/* Sets AT to a random position with uniform density in the unit circle. */
static void generate_random_position(struct draw *d, double at[2])
{
    const double r = sqrt(generate_random(d)),
                 phi = 2 * GLINT_PI * generate_random(d);

    at[0] = r * cos(phi);
    at[1] = r * sin(phi);
}

static void add_dust_disc(struct glint_dust *dust, struct draw *d,
                          double radius, double rim, double opacity)
{
    struct glint_speck *s = &dust->speck[dust->n++];

    generate_random_position(d, s->end[0]);
    s->end[1][0] = s->end[0][0];
    s->end[1][1] = s->end[0][1];
    s->radius = radius;
    s->rim = rim;
    s->opacity = opacity;
}

static void add_scratch(struct glint_dust *dust, struct draw *d)
{
    struct glint_speck *s = &dust->speck[dust->n++];
    const double length = generate_random_between(d, 0.2, 1),
                 phi = 2 * GLINT_PI * generate_random(d);

    generate_random_position(d, s->end[0]);
    s->end[1][0] = s->end[0][0] + length * cos(phi);
    s->end[1][1] = s->end[0][1] + length * sin(phi);
    s->radius = generate_random_between(d, 0.004, 0.01);
    s->rim = 0.5;
    s->opacity = generate_random_between(d, 0.2, 0.6);
}

static void set_speck_bounding_square(struct glint_speck *s)
{
    double half = 0;

    for (int k = 0; k < 2; k++) {
        s->middle[k] = 0.5 * (s->end[0][k] + s->end[1][k]);
        half = fmax(half, 0.5 * fabs(s->end[1][k] - s->end[0][k]));
    }
    s->reach = half + s->radius * (1 + s->rim);
}

void glint_dust_generate_specks(struct glint_dust *dust, double amount,
                                int seed)
{
    /* A disc of radius r covers r^2 of the stop. */
    const int n_lines = (int)ceil(fmin(8, 40 * amount));
    const int n_smudges = (int)ceil(fmin(4, 20 * amount));
    struct draw d = {(uint64_t)(uint32_t)seed * UINT64_C(0x9e3779b97f4a7c15)};
    double left = amount;

    dust->n = 0;
    if (!(amount > 0))
        return;
    for (int i = 0; i < n_lines; i++)
        add_scratch(dust, &d);
    for (int i = 0; i < n_smudges; i++) {
        /* Each statement draws one random number, as the order in which
         * arguments are evaluated is undefined. */
        const double opacity =
            fmin(amount * generate_random_between(&d, 0.5, 2), 0.5);
        const double radius = generate_random_between(&d, 0.15, 0.4);

        add_dust_disc(dust, &d, radius, 0.9, opacity);
    }
    while (left > 0 && dust->n < GLINT_DUST_MOST) {
        const double radius = least_radius * pow(most_radius / least_radius,
                                                 pow(generate_random(&d), 1.5));

        add_dust_disc(dust, &d, radius, 0.3,
                      generate_random_between(&d, 0.3, 0.95));
        left -= radius * radius;
    }
    for (int i = 0; i < dust->n; i++)
        set_speck_bounding_square(&dust->speck[i]);
}

static double square_number(double x)
{
    return x * x;
}

/* Returns the squared distance of (X, Y) from the line segment that is the axis
 * of speck S. */
static double compute_squared_line_distance(const struct glint_speck *s,
                                            double x, double y)
{
    const double ax = s->end[1][0] - s->end[0][0];
    const double ay = s->end[1][1] - s->end[0][1];
    const double bx = x - s->end[0][0], by = y - s->end[0][1];
    const double length2 = ax * ax + ay * ay;
    const double t =
        length2 > 0 ? fmin(fmax((ax * bx + ay * by) / length2, 0), 1) : 0;

    return square_number(bx - t * ax) + square_number(by - t * ay);
}

double glint_dust_compute_transmission(const struct glint_dust *dust, double x,
                                       double y)
{
    double light = 1;

    for (int i = 0; i < dust->n; i++) {
        const struct glint_speck *s = &dust->speck[i];
        const double end = s->radius * (1 + s->rim);
        double far2, in;

        if (fabs(x - s->middle[0]) > s->reach ||
            fabs(y - s->middle[1]) > s->reach)
            continue;
        far2 = compute_squared_line_distance(s, x, y);
        if (far2 >= end * end)
            continue;
        in = fmin((end - sqrt(far2)) / (2 * s->radius * s->rim), 1);
        light *= 1 - s->opacity * in * in * (3 - 2 * in);
    }
    return light;
}
