/* SPDX-License-Identifier: MIT
 *
 * Tests the point lights that represent a lamp of visible extent: their total
 * power, centroid and RMS extent equal the lamp's, they change continuously as
 * the lamp grows, and their number is limited.
 */
#include "glint/area.h"
#include "support/test.h"

static struct glint_area area;

static const double degree = 3.14159265358979323846 / 180;

enum { MOST = 61, PIXELS = 1000 };

static struct glint_lamp make_disc_lamp(double major_px, double minor_px)
{
    return (struct glint_lamp){.theta_deg = 9,
                               .phi_deg = 200,
                               .power = 5,
                               .rgb = {1, 1, 1},
                               .axis = {major_px / PIXELS, minor_px / PIXELS},
                               .turn_deg = 30};
}

static void compute_lamp_position(const struct glint_lamp *lamp, double *u,
                                  double *v)
{
    *u = PIXELS * tan(lamp->theta_deg * degree) * cos(lamp->phi_deg * degree);
    *v = PIXELS * tan(lamp->theta_deg * degree) * sin(lamp->phi_deg * degree);
}

/* Sets SUM to sums over the points of LAMP: power; power times offset from the
 * lamp's centre, pixels, in u and in v; power times squared offset along the
 * major and the minor axis. Returns the number of points. */
static int compute_point_sums(const struct glint_lamp *lamp, double thinning,
                              double sum[5])
{
    const struct glint_area_rule rule = {PIXELS, MOST, lamp->power, thinning};
    const int n = glint_area_plan(&area, lamp, &rule);
    double u0, v0, u, v;

    compute_lamp_position(lamp, &u0, &v0);
    for (int i = 0; i < 5; i++)
        sum[i] = 0;
    for (int i = 0; i < n; i++) {
        const struct glint_lamp p = glint_area_point(&area, i);
        const double c = cos(lamp->turn_deg * degree);
        const double s = sin(lamp->turn_deg * degree);

        compute_lamp_position(&p, &u, &v);
        u -= u0;
        v -= v0;
        assert_true(p.axis[0] == 0 && p.axis[1] == 0);
        sum[0] += p.power;
        sum[1] += p.power * u;
        sum[2] += p.power * v;
        sum[3] += p.power * (c * u + s * v) * (c * u + s * v);
        sum[4] += p.power * (c * v - s * u) * (c * v - s * u);
    }
    return n;
}

TEST(small_lamp_is_one_point)
{
    const struct glint_lamp lamp = make_disc_lamp(0, 0);
    struct glint_lamp point;
    int total;
    const struct glint_area_rule rule =
        glint_area_rule_of(&lamp, 1, PIXELS, MOST, 100, &total);

    assert_int_equal(glint_area_plan(&area, &lamp, &rule), 1);
    point = glint_area_point(&area, 0);
    /* A single point equals the lamp bit by bit. */
    assert_true(point.theta_deg == lamp.theta_deg);
    assert_true(point.phi_deg == lamp.phi_deg);
    assert_true(point.power == lamp.power);
}

TEST(sums_equal_the_lamp)
{
    const struct glint_lamp lamp = make_disc_lamp(30, 10);
    double sum[5];

    assert_int_equal(compute_point_sums(&lamp, 1, sum), MOST);
    assert_true(fabs(sum[0] - 5) < 1e-9);
    assert_true(fabs(sum[1] - 0) < 1e-6);
    assert_true(fabs(sum[2] - 0) < 1e-6);
    assert_true(fabs(sqrt(sum[3] / 5) - 30) < 30 * 0.05);
    assert_true(fabs(sqrt(sum[4] / 5) - 10) < 10 * 0.05);
}

/* Checks that the points of a lamp do not move when the lamp's rotation passes
 * 90 degrees, where its axes jump by a half turn, and that those of a round
 * lamp do not depend on the rotation. */
TEST(half_turn_of_the_axes_keeps_the_points)
{
    const struct glint_area_rule rule = {PIXELS, MOST, 5, 1};

    for (int k = 0; k < 3; k++) {
        struct glint_lamp lamp = make_disc_lamp(12, k == 0 ? 4 : 12);
        struct glint_area a, b;
        double most = 0;
        int n;

        lamp.turn_deg = 90;
        n = glint_area_plan(&a, &lamp, &rule);
        lamp.turn_deg = k == 2 ? 0 : -90;
        assert_int_equal(glint_area_plan(&b, &lamp, &rule), n);
        for (int i = 0; i < n; i++) {
            const struct glint_lamp p = glint_area_point(&a, i);
            const struct glint_lamp q = glint_area_point(&b, i);
            double u[2], v[2];

            compute_lamp_position(&p, &u[0], &v[0]);
            compute_lamp_position(&q, &u[1], &v[1]);
            most = fmax(most, hypot(u[0] - u[1], v[0] - v[1]));
        }
        assert_true(most < 1e-9);
    }
}

/* Checks, while a lamp grows by 0.005 px per step, that its centroid does not
 * move and that its second moments change little per step. */
TEST(points_change_continuously_as_a_lamp_grows)
{
    double last[5], sum[5];

    compute_point_sums(&(struct glint_lamp){.power = 0}, 1, last);
    for (int step = 0; step <= 4000; step++) {
        const struct glint_lamp lamp =
            make_disc_lamp(step * 0.005, step * 0.005);

        compute_point_sums(&lamp, 1, sum);
        assert_true(fabs(sum[1] - 0) < 1e-6);
        assert_true(fabs(sum[2] - 0) < 1e-6);
        if (step > 0)
            for (int k = 3; k < 5; k++)
                assert_true(fabs(sum[k] - last[k]) <
                            0.05 + 5 * 0.06 * step * 0.005);
        for (int k = 0; k < 5; k++)
            last[k] = sum[k];
    }
}

TEST(point_count_is_limited)
{
    struct glint_lamp lamps[10];
    int total;

    for (int i = 0; i < 10; i++)
        lamps[i] = make_disc_lamp(3 * i, 2 * i);
    for (int room = 1; room < 700; room++) {
        const struct glint_area_rule rule =
            glint_area_rule_of(lamps, 10, PIXELS, MOST, room, &total);
        int n = 0;

        for (int i = 0; i < 10; i++) {

            n += glint_area_plan(&area, &lamps[i], &rule);
        }
        assert_true(n <= total);
        assert_true(total <= (room > 10 ? room : 10));
    }
    assert_true(
        glint_area_rule_of(lamps, 1, PIXELS, MOST, 0, &total).thinning == 1);
    assert_int_equal(total, 1);
}

/* Steps between faint points are less visible: a lamp with 1/16 of the power
 * gets 1/4 of the points. */
TEST(faint_lamps_get_fewer_points)
{
    struct glint_lamp lamps[2] = {make_disc_lamp(30, 30),
                                  make_disc_lamp(30, 30)};
    struct glint_area_rule rule;
    int total;

    lamps[1].power = lamps[0].power / 16;
    rule = glint_area_rule_of(lamps, 2, PIXELS, MOST, 1000, &total);
    assert_int_equal(glint_area_plan(&area, &lamps[0], &rule), MOST);
    assert_int_equal(glint_area_plan(&area, &lamps[1], &rule),
                     1 + (MOST - 1) / 4);
    assert_true(total >= MOST + 1 + (MOST - 1) / 4);
}

/* Checks that the points of a disc are as far apart as those of a square grid
 * with the same area per point, and that this distance changes continuously
 * while the disc grows from one point to many. In an ellipse 1/100 as wide as
 * long it is a fifth of that. */
TEST(point_distance_is_that_of_a_square_grid)
{
    double last = 0;
    int total;

    for (int step = 0; step <= 4000; step++) {
        const double radius = step * 0.01; /* RMS radius, pixels */
        const struct glint_lamp lamp = make_disc_lamp(radius, radius);
        const struct glint_area_rule rule =
            glint_area_rule_of(&lamp, 1, PIXELS, MOST, 1000, &total);
        double apart;

        glint_area_plan(&area, &lamp, &rule);
        apart = glint_area_apart(&area) * PIXELS;
        assert_true(step > 0 || apart == 0);
        assert_true(apart >= last - 1e-9 && apart < last + 0.05);
        last = apart;
    }
    assert_true(fabs(last / (2 * 40 * sqrt(GLINT_PI / MOST)) - 1) < 1e-6);
    area.points = 121;
    assert_true(fabs(glint_area_apart(&area) * PIXELS - 80 / 6.2) < 0.1);
    area.lamp.axis[1] /= 100;
    assert_true(fabs(glint_area_apart(&area) * PIXELS - 80 / 6.2 / 5) < 0.1);
}
