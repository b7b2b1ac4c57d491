/* SPDX-License-Identifier: MIT */
#include "engine/setup/iris.h"

#include <math.h>

#include "engine/setup/degrees.h"
#include "engine/setup/setup.h"

/* max curvature of arcs, 1 / stop radius; above it, arcs barely differ from a
 * circle, and the offsets of their centres would be too small for 30 fraction
 * bits */
static const double most_round = 0.9999;

void glint_iris_compute_sides(struct glint_iris_sides *sides,
                              const struct glint_setup *setup)
{
    const int n = setup->n_blades;
    const double round = fmin(setup->iris.roundness, most_round);

    *sides = (struct glint_iris_sides){.n = n, .arcs = n && round > 0};
    if (n == 0)
        return;
    sides->apothem = cos(GLINT_PI / n);
    sides->round = round;
    /* The offset d of the centre of an arc solves d^2 + 2 d apothem + 1 = 1 /
     * round^2. */
    sides->off =
        sqrt(1 - round * round * (1 - sides->apothem * sides->apothem)) -
        sides->apothem * round;
    for (int i = 0; i < n; i++) {
        const double a = setup->blade_rotation_deg + (i + 0.5) * 360.0 / n;

        sides->normal[i][0] = glint_cos_deg(a);
        sides->normal[i][1] = glint_sin_deg(a);
    }
}

double glint_iris_compute_side_distance(const struct glint_iris_sides *s,
                                        int side, double x, double y)
{
    const double straight =
        s->apothem - x * s->normal[side][0] - y * s->normal[side][1];

    return s->arcs ? s->off * straight + 0.5 * s->round * (1 - x * x - y * y)
                   : straight;
}

double glint_iris_compute_edge_distance(const struct glint_iris_sides *sides,
                                        double x, double y)
{
    double depth = sides->n ? 4 : 1 - hypot(x, y);

    for (int i = 0; i < sides->n; i++)
        depth = fmin(depth, glint_iris_compute_side_distance(sides, i, x, y));
    return depth;
}

/* Returns the area of a stop with N sides of curvature ROUND, stop radii^2. It
 * is the area of the polygon plus the area of the segments between its sides
 * and the arcs. */
static double compute_opening_area(int n, double round)
{
    const double half_side = sin(GLINT_PI / n);
    const double polygon = 0.5 * n * sin(2 * GLINT_PI / n);
    const double turn = 2 * asin(round * half_side);

    return round < 1e-6
               ? polygon
               : polygon + n * (turn - sin(turn)) / (2 * round * round);
}

double glint_iris_compute_area_fraction(const struct glint_setup *setup)
{
    return setup->n_blades
               ? compute_opening_area(setup->n_blades, setup->iris.roundness) /
                     GLINT_PI
               : 1;
}

/* Returns the mean of r^POWER over a stop with N sides of curvature ROUND, r in
 * stop radii. N 0: a circle. */
static double compute_mean_power(int n, double round, int power)
{
    enum { STEPS = 64 };
    double apothem, off, sum = 0, area = 0;

    if (n == 0)
        return 2.0 / (power + 2);
    apothem = cos(GLINT_PI / n);
    off = sqrt(1 - round * round * (1 - apothem * apothem)) - apothem * round;
    for (int i = 0; i < STEPS; i++) {
        const double a = (i + 0.5) * GLINT_PI / n / STEPS;
        const double s = off * sin(a);
        const double r = round < 1e-6
                             ? apothem / cos(a)
                             : (sqrt(1 - s * s) - off * cos(a)) / round;

        area += r * r;
        sum += pow(r, power + 2);
    }
    return sum / area * 2 / (power + 2);
}

double glint_iris_compute_light_fraction(const struct glint_setup *setup,
                                         const double falloff[2])
{
    const double round = fmin(setup->iris.roundness, most_round);
    double light = 1;

    for (int k = 0; k < 2; k++)
        if (falloff[k] != 0)
            light += falloff[k] *
                     (compute_mean_power(setup->n_blades, round, 2 * k + 2) /
                          compute_mean_power(GLINT_FLUX_BLADES, 0, 2 * k + 2) -
                      1);
    return light * glint_iris_compute_area_fraction(setup);
}
