/* SPDX-License-Identifier: MIT
 *
 * Tests the outline of the stop. Corners must lie exactly on the circle that
 * the f-number defines, and outlines must be convex. Rounded blades must be
 * arcs between the straight side and the circle. Areas must equal those counted
 * from sample points. The integer test that clips ghosts must agree with a test
 * in double precision.
 */
#include "engine/setup/iris.h"

#include "engine/setup/setup.h"
#include "flare/edges/outline.h"
#include "glint/view.h"
#include "support/test.h"

static const int blades[] = {3, 4, 5, 6, 8, 9, 31, 64};
static const double roundness[] = {0, 0.01, 0.3, 0.75, 0.99, 1};

enum {
    N_BLADES = sizeof blades / sizeof *blades,
    N_ROUND = sizeof roundness / sizeof *roundness,
    PHI = 1440
};

static struct glint_setup make_iris_setup(int n, double rotation_deg,
                                          double round)
{
    static struct glint_setup s;

    memset(&s, 0, sizeof s);
    s.opening = 1;
    s.n_blades = n;
    s.blade_rotation_deg = rotation_deg;
    s.iris.roundness = round;
    s.clear = 1;
    return s;
}

/* Returns the radius of the stop's outline at the azimuth PHI, radians, by
 * bisection. */
static double find_outline_radius(const struct glint_iris_sides *s, double phi)
{
    double in = 0, out = 1.5;

    for (int i = 0; i < 60; i++) {
        const double r = 0.5 * (in + out);

        if (glint_iris_compute_edge_distance(s, r * cos(phi), r * sin(phi)) > 0)
            in = r;
        else
            out = r;
    }
    return in;
}

/* Calls TEST for each number of blades and each roundness, rotated by 17
 * degrees. */
static void check_each_iris(void (*test)(const struct glint_setup *s,
                                         const struct glint_iris_sides *sides))
{
    for (int i = 0; i < N_BLADES * N_ROUND; i++) {
        const struct glint_setup s =
            make_iris_setup(blades[i / N_ROUND], 17, roundness[i % N_ROUND]);
        struct glint_iris_sides sides;

        glint_iris_compute_sides(&sides, &s);
        assert_int_equal(sides.n, blades[i / N_ROUND]);
        test(&s, &sides);
    }
}

/* Checks that corners lie on the circle that the f-number defines. Half-way
 * between two corners, the outline must lie on the circle through both of
 * radius 1 / R, where R is the roundness. */
static void check_outline_corners(const struct glint_setup *s,
                                  const struct glint_iris_sides *sides)
{
    const double half = sin(GLINT_PI / s->n_blades);
    const double k = fmin(s->iris.roundness, 0.9999);
    const double sag = k > 0 ? 1 / k - sqrt(1 / (k * k) - half * half) : 0;

    for (int i = 0; i < s->n_blades; i++) {
        const double at = (17 + i * 360.0 / s->n_blades) * GLINT_PI / 180;
        const double middle = at + GLINT_PI / s->n_blades;

        assert_true(fabs(find_outline_radius(sides, at) - 1) < 1e-9);
        assert_true(fabs(find_outline_radius(sides, middle) -
                         (cos(GLINT_PI / s->n_blades) + sag)) < 1e-9);
    }
}

TEST(corners_lie_on_the_f_number_circle)
{
    check_each_iris(check_outline_corners);
}

static void check_outline_is_convex(const struct glint_setup *s,
                                    const struct glint_iris_sides *sides)
{
    double x[PHI], y[PHI], area = 0;

    for (int i = 0; i < PHI; i++) {
        const double phi = 2 * GLINT_PI * i / PHI;
        const double r = find_outline_radius(sides, phi);

        assert_true(r > 0.49 && r < 1 + 1e-9);
        x[i] = r * cos(phi);
        y[i] = r * sin(phi);
    }
    for (int i = 0; i < PHI; i++) {
        const int j = (i + 1) % PHI, k = (i + 2) % PHI;

        area += 0.5 * (x[i] * y[j] - x[j] * y[i]);
        assert_true((x[j] - x[i]) * (y[k] - y[j]) -
                        (y[j] - y[i]) * (x[k] - x[j]) >
                    -1e-9);
    }
    assert_true(fabs(area / GLINT_PI - glint_iris_compute_area_fraction(s)) <
                2e-4);
}

TEST(outline_is_convex_and_has_its_area)
{
    check_each_iris(check_outline_is_convex);
}

/* Checks that the integer test finds points on the same side of the outline as
 * a test in double precision, and at the same distance from it. */
static void check_integer_stop_test(const struct glint_setup *s,
                                    const struct glint_iris_sides *sides)
{
    struct glint_stop stop;
    uint32_t seed = 1;

    glint_setup_stop(s, &stop);
    for (int i = 0; i < 2000; i++) {
        struct glint_vertex v = {0};
        double x, y;

        seed = seed * 1664525 + 1013904223;
        v.stop_x_q16 = (int32_t)(seed >> 15) - 65536;
        seed = seed * 1664525 + 1013904223;
        v.stop_y_q16 = (int32_t)(seed >> 15) - 65536;
        x = v.stop_x_q16 / 65536.0;
        y = v.stop_y_q16 / 65536.0;
        for (int k = 0; k < stop.n_blades; k++) {
            const double d = glint_iris_compute_side_distance(sides, k, x, y);
            const double got =
                (double)glint_side_compute_signed_distance_q16(&stop, k, &v) /
                65536;

            assert_true(fabs(got - d) < 5e-5);
        }
    }
}

TEST(integer_test_agrees_with_the_outline)
{
    check_each_iris(check_integer_stop_test);
}

/* Checks that a rounder stop passes more light, up to that of a circle. */
TEST(rounder_stop_passes_more_light)
{
    for (int i = 0; i < N_BLADES; i++) {
        double last = 0;

        for (int k = 0; k < N_ROUND; k++) {
            const struct glint_setup s =
                make_iris_setup(blades[i], 0, roundness[k]);

            assert_true(glint_iris_compute_area_fraction(&s) > last);
            last = glint_iris_compute_area_fraction(&s);
        }
        assert_true(fabs(last - 1) < 1e-9);
    }
}

/* Checks that a setup rejects values out of range, and recomputes the fraction
 * of light that the stop passes. */
TEST(setup_rejects_values_out_of_range)
{
    struct glint_setup s = make_iris_setup(6, 0, 0);
    struct glint_iris iris = {.roundness = 1.5};
    struct glint_dirt *dirt;
    struct glint_error error;

    s.n_wavelengths = 1;
    s.direct_flux[0] = glint_iris_compute_area_fraction(&s);
    assert_int_equal(glint_setup_iris(&s, &iris, &dirt, &error),
                     GLINT_E_ARGUMENT);
    iris.roundness = NAN;
    assert_int_equal(glint_setup_iris(&s, &iris, &dirt, &error),
                     GLINT_E_ARGUMENT);
    iris.roundness = 1;
    assert_ok(glint_setup_iris(&s, &iris, &dirt, &error));
    assert_true(fabs(s.direct_flux[0] - 1) < 1e-9);
    iris.roundness = 0;
    assert_ok(glint_setup_iris(&s, &iris, &dirt, &error));
    assert_true(fabs(s.direct_flux[0] - glint_iris_compute_area_fraction(&s)) <
                1e-9);
    assert_true(s.direct_flux[0] < 0.83);
}
