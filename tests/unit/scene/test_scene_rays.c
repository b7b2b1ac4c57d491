/* SPDX-License-Identifier: MIT
 *
 * Tests rays against spheres, planes and triangles: results are compared with
 * examples of the tutorial computed by hand, and with exact arithmetic. Two
 * simpler methods, the area test and plain Q16.16, are shown to fail.
 */
#include "scene/ray.h"
#include "support/models/scene_builder.h"
#include "support/rng.h"
#include "support/test.h"

enum { ONE = 1 << 16, ONE_Q30 = 1 << 30 };

static void assert_near_int(int64_t x, int64_t expected, int64_t off)
{
    if (x < expected - off || x > expected + off)
        fail_msg("%lld is not %lld +- %lld", (long long)x, (long long)expected,
                 (long long)off);
}

static void assert_near_vector(const int32_t v[3], double x, double y, double z,
                               int off)
{
    const double expected[3] = {x, y, z};

    for (int k = 0; k < 3; k++)
        assert_near_int(v[k], llround(ldexp(expected[k], 30)), off);
}

/* Sets V to the corners AT, in scene units, times SIZE. */
static void set_scaled_triangle(int32_t v[3][3], const double at[9],
                                double size)
{
    for (int i = 0; i < 9; i++)
        v[i / 3][i % 3] = (int32_t)llround(at[i] * size * ONE);
}

static int ray_hits_triangle(const struct glint_scene_ray *ray, int32_t v[3][3],
                             struct glint_spot_on *spot)
{
    const int32_t *const vertex[3] = {v[0], v[1], v[2]};
    struct glint_sheared sheared;

    glint_ray_shear_to_axis(ray, &sheared);
    return glint_ray_intersect_triangle(&sheared, vertex, spot);
}

static const struct glint_scene_ray ahead = {{0}, {0, 0, ONE_Q30}};

static const double first[9] = {0, 40, 120, 30, -40, 60, -30, -40, 60};

static struct glint_scene_ray make_ray_from_doubles(const double from[3],
                                                    const double to[3])
{
    struct glint_scene_ray ray;
    const double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);

    for (int k = 0; k < 3; k++) {
        ray.at[k] = (int32_t)llround(from[k]);
        ray.toward_q30[k] = (int32_t)llround(ldexp(d[k] / length, 30));
    }
    return ray;
}

/* ------------------------------------------ vectors and planes (A1 to A3) */

TEST(a1_unit_vectors)
{
    const int64_t v[3] = {0, 6, 8}, zero[3] = {0};
    uint32_t seed = 1;
    int32_t unit_q30[3];

    assert_int_equal(glint_compute_square_root(100), 10);
    assert_true(glint_normalise_vector(v, unit_q30));
    assert_near_vector(unit_q30, 0, .6, .8, 1);
    assert_false(glint_normalise_vector(zero, unit_q30));
    for (int i = 0; i < 200000; i++) {
        const int shift = rng_int_below(&seed, 60);
        double length = 0;
        int64_t w[3];

        for (int k = 0; k < 3; k++) {
            w[k] = (int64_t)((uint64_t)rng_bits32(&seed) << 32 |
                             rng_bits32(&seed)) >>
                   2 >> shift;
            length += ldexp((double)w[k], -31) * ldexp((double)w[k], -31);
        }
        if (!glint_normalise_vector(w, unit_q30))
            continue;
        for (int k = 0; k < 3; k++) {
            const double exact = ldexp((double)w[k] / sqrt(length), -1);

            assert_true(fabs(unit_q30[k] - exact) < 1.1);
        }
    }
}

TEST(square_roots_are_exact)
{
    uint32_t seed = 1;

    for (uint64_t x = 0; x < 70000; x++)
        assert_int_equal(glint_compute_square_root(x), q_root(x));
    for (int i = 0; i < 300000; i++) {
        const uint64_t bits =
            (uint64_t)rng_bits32(&seed) << 32 | rng_bits32(&seed);
        const uint64_t x = bits >> (i % 64), r = q_root(x);

        assert_int_equal(glint_compute_square_root(x), r);
        assert_int_equal(glint_compute_square_root(r * r), r);
        assert_int_equal(glint_compute_square_root(r * r - (r > 0)),
                         r ? r - 1 : 0);
    }
    assert_true(glint_compute_square_root(UINT64_MAX) == UINT32_MAX);
}

TEST(ratios_saturate)
{
    uint32_t seed = 1;

    assert_int_equal(glint_divide_rounded(5, 0), GLINT_FAR);
    assert_int_equal(glint_divide_rounded(0, 5), 0);
    assert_int_equal(glint_divide_rounded(UINT64_MAX >> 2, 1), GLINT_FAR);
    assert_int_equal(glint_divide_rounded(90, 1), 90);
    for (int i = 0; i < 300000; i++) {
        const uint64_t n = ((uint64_t)rng_bits32(&seed) << 28) >> (i % 59);
        const uint64_t d = ((uint64_t)rng_bits32(&seed) << 28) >> (i / 59 % 60);
        const double exact = (double)n / (double)(d | 1);
        const int32_t q = glint_divide_rounded(n, d | 1);

        if (exact < GLINT_FAR - 2)
            assert_true(fabs(q - exact) <= .5 + exact * 0x1p-29);
        else if (exact > GLINT_FAR + 2)
            assert_int_equal(q, GLINT_FAR);
    }
}

TEST(a2_triangle_normal)
{
    int32_t v[3][3], normal_q30[3], a[3], b[3];
    const int32_t *const clockwise[3] = {v[0], v[1], v[2]};
    const int32_t *const back[3] = {v[0], v[2], v[1]};
    int64_t n[3];

    for (int i = 0; i < 9; i++)
        v[i / 3][i % 3] = (int32_t)first[i];
    v3_subtract(v[1], v[0], a);
    v3_subtract(v[2], v[0], b);
    v3_cross(a, b, n);
    assert_true(n[0] == 0 && n[1] == 3600 && n[2] == -4800);
    assert_true(glint_set_triangle_normal(clockwise, normal_q30));
    assert_near_vector(normal_q30, 0, .6, -.8, 1); /* towards the viewer */
    assert_true(glint_set_triangle_normal(back, normal_q30));
    assert_near_vector(normal_q30, 0, -.6, .8, 1);
}

TEST(a3_plane_intersection)
{
    const int32_t *vertex[3];
    int32_t v[3][3], normal_q30[3], hit[3];
    struct glint_spot_on spot;

    set_scaled_triangle(v, first, 1);
    for (int k = 0; k < 3; k++)
        vertex[k] = v[k];
    glint_set_triangle_normal(vertex, normal_q30);
    assert_near_int(v3_dot(normal_q30, v[0]), -72 * (INT64_C(1) << 46),
                    1 << 27);
    assert_int_equal(glint_ray_intersect_plane(&ahead, v[0], normal_q30),
                     90 * ONE);
    assert_true(glint_ray_point_at_distance(&ahead, 90 * ONE, hit));
    assert_true(hit[0] == 0 && hit[1] == 0 && hit[2] == 90 * ONE);
    assert_true(ray_hits_triangle(&ahead, v, &spot));
    assert_int_equal(spot.t, 90 * ONE);
}

/* ---------------------------------------------------- triangles (A4, A5) */

static double compute_double_area(const double a[3], const double b[3],
                                  const double c[3])
{
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double w[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};

    return sqrt(pow(u[1] * w[2] - u[2] * w[1], 2) +
                pow(u[2] * w[0] - u[0] * w[2], 2) +
                pow(u[0] * w[1] - u[1] * w[0], 2));
}

/* Tests a point by the area test, a simpler method: a point of the plane is
 * inside a triangle if the areas of the three triangles between the point and
 * the sides sum to the area of the triangle, within .005. */
static int is_inside_by_areas(const double v[9], const double p[3])
{
    const double s = compute_double_area(v, v + 3, v + 6);

    return fabs(s - compute_double_area(v, v + 3, p) -
                compute_double_area(v + 3, v + 6, p) -
                compute_double_area(v + 6, v, p)) < .005;
}

/* Aims random rays at a box five times the area of a triangle of height SIZE.
 * Returns the fraction of rays that the area test classifies wrongly. Checks
 * that glint's test is right, except close to edges. */
static double measure_error_rate_of_area_test(double size)
{
    double v[9], from[3] = {0};
    int wrong = 0, n = 0, ours = 0;
    uint32_t seed = 1;
    int32_t steps[3][3];
    struct glint_spot_on spot;

    for (int i = 0; i < 9; i++)
        v[i] = first[i] * size / 80;
    set_scaled_triangle(steps, v, 1);
    for (; n < 4000; n++) {
        /* position in the triangle: 0 .. 1 down from its top, -1 .. 1 across */
        const double down = .5 + 1.58 * (rng_unit(&seed) - .5);
        const double across = 1.58 * (2 * rng_unit(&seed) - 1);
        const double u = (down + across) / 2, w = (down - across) / 2;
        double p[3], at[3];
        struct glint_scene_ray ray;
        const int is_in = u >= 0 && w >= 0 && u + w <= 1;

        for (int k = 0; k < 3; k++) {
            p[k] = v[k] + u * (v[3 + k] - v[k]) + w * (v[6 + k] - v[k]);
            at[k] = p[k] * ONE;
        }
        wrong += is_inside_by_areas(v, p) != is_in;
        ray = make_ray_from_doubles(from, at);
        if (fabs(u) * size > .01 * size && fabs(w) > .01 &&
            fabs(u + w - 1) > .01)
            ours += ray_hits_triangle(&ray, steps, &spot) != is_in;
    }
    assert_int_equal(ours, 0);
    return (double)wrong / n;
}

TEST(a4_area_test_of_triangles)
{
    const double p[3] = {0, 0, 90};

    assert_near_int(
        llround(compute_double_area(first, first + 3, first + 6) * 16),
        6000 * 16, 0);
    assert_near_int(llround(compute_double_area(first, first + 3, p) * 16),
                    1500 * 16, 0);
    assert_near_int(llround(compute_double_area(first + 6, first, p) * 16),
                    1500 * 16, 0);
    assert_near_int(llround(compute_double_area(first + 3, first + 6, p) * 16),
                    3000 * 16, 0);
    assert_true(measure_error_rate_of_area_test(80) == 0);
    for (double size = .1; size > .005; size /= 10) {
        const double share = measure_error_rate_of_area_test(size);

        print_message("areas are wrong for %.1f %% of rays at size %g\n",
                      100 * share, size);
        assert_true(share > (size > .05 ? .35 : .75));
    }
}

TEST(a5_nearest_triangle)
{
    static const double u[9] = {0, 30, 40, 40, -30, 120, -40, -30, 120},
                        y[9] = {-50, 30, 124, 50, 30, 124, 0, -30, 44},
                        z[9] = {-30, 0, 37, 30, 40, 117, 30, -40, 117};
    const double *const each[3] = {u, y, z};
    const int expected[3] = {80, 84, 77};
    struct glint_spot_on spot;
    int32_t v[3][3];

    for (int i = 0; i < 3; i++) {
        set_scaled_triangle(v, each[i], 1);
        assert_true(ray_hits_triangle(&ahead, v, &spot));
        assert_near_int(spot.t, expected[i] * ONE, 1);
    }
}

/* Checks that rays through edges and vertices hit the triangle, from both
 * sides. */
TEST(rays_through_edges_hit)
{
    static const double on_edge[9] = {0, -9, 50, 0, 9, 40, 9, 0, 30},
                        on_vertex[9] = {0, 0, 50, 9, 9, 40, 9, -9, 30};
    const double *const each[2] = {on_edge, on_vertex};
    const int expected[2] = {45, 50};
    struct glint_spot_on spot;

    for (int i = 0; i < 12; i++) {
        int32_t v[3][3], turned[3][3];

        set_scaled_triangle(v, each[i % 2], 1);
        for (int k = 0; k < 9; k++)
            turned[k / 3][k % 3] =
                v[(i / 6 ? 8 - k / 3 + i / 2 : k / 3 + i / 2) % 3][k % 3];
        assert_true(ray_hits_triangle(&ahead, turned, &spot));
        assert_near_int(spot.t, expected[i % 2] * ONE, 1);
    }
}

/* ----------------------------- mirrored, refracted, missed (A9, A12, A14) */

TEST(a9_mirrored_direction)
{
    uint32_t seed = 1;

    for (int i = 0; i < 100000; i++) {
        int32_t d[3], n[3], r[3], back[3];
        int64_t v[3], w[3];
        double length = 0;

        for (int k = 0; k < 3; k++) {
            v[k] = (int32_t)rng_bits32(&seed) >> 1;
            w[k] = (int32_t)rng_bits32(&seed) >> 1;
        }
        if (!glint_normalise_vector(v, d) || !glint_normalise_vector(w, n))
            continue;
        glint_reflect_direction(d, n, r);
        glint_reflect_direction(r, n, back);
        for (int k = 0; k < 3; k++) {
            assert_near_int(back[k], d[k], 8);
            length += ldexp(r[k], -30) * ldexp(r[k], -30);
        }
        assert_true(fabs(sqrt(length) - 1) < 0x1p-28);
    }
}

TEST(a12_refracted_direction)
{
    const int32_t n[3] = {0, 0, -ONE_Q30};
    uint32_t seed = 1;

    for (int i = 0; i < 100000; i++) {
        const double eta = exp2(6 * rng_unit(&seed) - 2);
        const uint32_t eta_q28 = (uint32_t)ldexp(eta, 28);
        const double angle = rng_unit(&seed) * 1.57;
        const double sine = sin(angle) * ldexp(eta_q28, -28);
        const int32_t d[3] = {(int32_t)llround(ldexp(sin(angle), 30)), 0,
                              (int32_t)llround(ldexp(cos(angle), 30))};
        int32_t to[3] = {7, 7, 7};

        if (fabs(sine - 1) < 1e-6)
            continue;
        if (!glint_bend(d, n, eta_q28, to)) {
            assert_true(sine > 1 && to[0] == 7);
            continue;
        }
        assert_true(sine < 1);
        assert_near_int(to[0], llround(ldexp(sine, 30)),
                        64 + (int64_t)(eta * eta / 2));
        assert_int_equal(to[1], 0);
        assert_near_int((int64_t)to[0] * to[0] + (int64_t)to[2] * to[2],
                        INT64_C(1) << 60, INT64_C(1) << 33);
    }
}

TEST(a14_degenerate_triangles_are_missed)
{
    const int32_t up[3] = {0, ONE_Q30, 0}, ground[3] = {0, -ONE, 0};
    static const double flat[9] = {-9, 0, 10, 9, 0, 10, 0, 0, 30},
                        line[9] = {0, 0, 10, 0, 0, 20, 0, 0, 30},
                        point[9] = {0, 0, 9, 0, 0, 9, 0, 0, 9},
                        side[9] = {-5, -5, 9, 5, 5, 9, 0, 0, 9};
    const double *const each[4] = {flat, line, point, side};
    const struct glint_scene_ray falling = {{0}, {0, -5, ONE_Q30}};
    struct glint_spot_on spot;
    int32_t v[3][3], n[3];

    assert_int_equal(glint_ray_intersect_plane(&ahead, ground, up),
                     0); /* parallel */
    assert_int_equal(glint_ray_intersect_plane(&falling, ground, up),
                     GLINT_PLANE_END);
    /* in the plane */
    assert_int_equal(glint_ray_intersect_plane(&ahead, ahead.at, up), 0);
    for (int i = 0; i < 4; i++) {
        const int32_t *const vertex[3] = {v[0], v[1], v[2]};
        struct glint_sheared sheared;

        set_scaled_triangle(v, each[i], 1);
        glint_ray_shear_to_axis(&ahead, &sheared);
        assert_false(glint_ray_intersect_triangle(&sheared, vertex, &spot));
        assert_false(glint_ray_clamp_to_triangle(&sheared, vertex, &spot));
        assert_int_equal(glint_set_triangle_normal(vertex, n), i == 0);
    }
    /* a triangle behind the origin of the ray */
    set_scaled_triangle(v, first, -1);
    assert_false(ray_hits_triangle(&ahead, v, &spot));
}

/* ----------------------------------------------------------- spheres (A15) */

TEST(a15_sphere_intersections)
{
    const int32_t centre[3] = {0, 0, 10 * ONE}, far[3] = {0, 0, -10 * ONE};
    const int32_t aside[3] = {3 * ONE, 0, 10 * ONE}, me[3] = {0, 0, ONE};
    struct glint_chord c;
    int32_t place[3], n[3];

    /* both intersections */
    assert_true(glint_ray_intersect_sphere(&ahead, centre, 2 * ONE, &c));
    assert_true(c.t[0] == 8 * ONE && c.t[1] == 12 * ONE);
    glint_chord_set_end_point_and_normal(&c, &ahead, centre, 0, place, n);
    assert_true(place[0] == 0 && place[1] == 0 && place[2] == 8 * ONE);
    assert_near_vector(n, 0, 0, -1, 0);
    glint_chord_set_end_point_and_normal(&c, &ahead, centre, 1, place, n);
    assert_true(place[2] == 12 * ONE && n[2] == ONE_Q30);
    /* rays that graze the ball, or miss it by one step */
    assert_true(glint_ray_intersect_sphere(&ahead, aside, 3 * ONE, &c));
    assert_true(c.t[0] == 10 * ONE && c.t[1] == 10 * ONE);
    assert_false(glint_ray_intersect_sphere(&ahead, aside, 3 * ONE - 1, &c));
    /* The ray starts inside the ball; then the ball is behind the origin. */
    assert_true(glint_ray_intersect_sphere(&ahead, me, 2 * ONE, &c));
    assert_true(c.t[0] == -ONE && c.t[1] == 3 * ONE);
    assert_true(glint_ray_intersect_sphere(&ahead, far, 2 * ONE, &c));
    assert_true(c.t[0] < 0 && c.t[1] < 0);
    assert_true(glint_ray_intersect_sphere(&ahead, centre, 1, &c));
    assert_true(c.t[0] == 10 * ONE - 1 && c.t[1] == 10 * ONE + 1);
}

/* Aims rays at the rim of a ball of radius 1/2 at DISTANCE; they pass the rim
 * within a hundredth of the radius. Returns the fraction of rays that are
 * wrongly found to hit or to miss. */
static double measure_error_rate_at_ball_rim(double distance)
{
    const double unit = exp2(floor(log2(GLINT_FAR / 4.0 / distance)));
    const int32_t radius = (int32_t)(unit / 2);
    uint32_t seed = 1;
    int wrong = 0;
    enum { RAYS = 200000 };

    for (int i = 0; i < RAYS; i++) {
        const double a = 6.2831853 * rng_unit(&seed),
                     b = acos(2 * rng_unit(&seed) - 1),
                     tilt = 6.2831853 * rng_unit(&seed);
        const double out = radius * (.99 + .02 * rng_unit(&seed));
        const double d[3] = {sin(b) * cos(a), sin(b) * sin(a), cos(b)};
        const double e[3] = {cos(b) * cos(a), cos(b) * sin(a), -sin(b)};
        const double f[3] = {-sin(a), cos(a), 0};
        long double l[3], dot = 0, square = 0;
        struct glint_scene_ray ray = {0};
        struct glint_chord chord;
        int32_t centre[3];

        for (int k = 0; k < 3; k++) {
            centre[k] =
                (int32_t)llround(d[k] * distance * unit +
                                 out * (cos(tilt) * e[k] + sin(tilt) * f[k]));
            ray.toward_q30[k] = (int32_t)llround(ldexp(d[k], 30));
            l[k] = centre[k];
            dot += l[k] * d[k];
        }
        for (int k = 0; k < 3; k++)
            square += (l[k] - dot * d[k]) * (l[k] - dot * d[k]);
        wrong += glint_ray_intersect_sphere(&ray, centre, radius, &chord) !=
                 (square <= (long double)radius * radius);
    }
    return (double)wrong / RAYS;
}

TEST(a15_rays_at_the_rim)
{
    for (double distance = 1; distance < 2e4; distance *= 10) {
        const double share = measure_error_rate_at_ball_rim(distance);

        print_message("ball of radius 0.5 at %5.0f: %.4f %% wrong\n", distance,
                      100 * share);
        assert_true(share <= .001);
    }
}

/* --------------------------------------------------- rays in closed meshes */

enum {
    SIDES = 12,
    RINGS = 7,
    BALL = SIDES * RINGS + 2,
    TRIANGLES = 2 * SIDES * RINGS
};

static void make_bumpy_ball_mesh(double at[BALL][3], uint32_t t[TRIANGLES][3],
                                 double size)
{
    uint32_t seed = 5;

    for (int i = 0; i < BALL; i++) {
        const double b = i < BALL - 2
                             ? 3.14159265 * (i / SIDES + 1) / (RINGS + 1)
                             : 3.14159265 * (i - BALL + 2);
        const double a = 6.2831853 * (i % SIDES) / SIDES;
        const double r = size * (.7 + .3 * rng_unit(&seed));

        at[i][0] = r * sin(b) * cos(a);
        at[i][1] = r * sin(b) * sin(a);
        at[i][2] = r * cos(b);
    }
    assert_int_equal(scene_make_ball(RINGS, SIDES, t), TRIANGLES);
}

/* The intersection of [Moller97] in plain 32-bit Q16.16, a simpler method. */
static int32_t mul_q16(int32_t a, int32_t b)
{
    return (int32_t)(((int64_t)a * b) >> 16);
}

/* Returns A + B; an overflow wraps. */
static int32_t add_with_wraparound(int32_t a, uint32_t b)
{
    return (int32_t)((uint32_t)a + b);
}

static void cross_q16(const int32_t a[3], const int32_t b[3], int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = add_with_wraparound(
            mul_q16(a[(k + 1) % 3], b[(k + 2) % 3]),
            -(uint32_t)mul_q16(a[(k + 2) % 3], b[(k + 1) % 3]));
}

static int32_t dot_q16(const int32_t a[3], const int32_t b[3])
{
    return add_with_wraparound(
        add_with_wraparound(mul_q16(a[0], b[0]), (uint32_t)mul_q16(a[1], b[1])),
        (uint32_t)mul_q16(a[2], b[2]));
}

static int ray_hits_triangle_q16(const struct glint_scene_ray *ray,
                                 int32_t v[3][3])
{
    int32_t d[3], e1[3], e2[3], s[3], p[3], q[3], det, u, w, sign;

    for (int k = 0; k < 3; k++) {
        d[k] = ray->toward_q30[k] >> 14;
        e1[k] = v[1][k] - v[0][k];
        e2[k] = v[2][k] - v[0][k];
        s[k] = ray->at[k] - v[0][k];
    }
    cross_q16(d, e2, p);
    det = dot_q16(e1, p);
    cross_q16(s, e1, q);
    u = dot_q16(s, p);
    w = dot_q16(d, q);
    sign = det;
    if (det < 0) {
        det = add_with_wraparound(0, -(uint32_t)det);
        u = add_with_wraparound(0, -(uint32_t)u);
        w = add_with_wraparound(0, -(uint32_t)w);
    }
    return det != 0 && u >= 0 && w >= 0 && (int64_t)u + w <= det &&
           (dot_q16(e2, q) ^ sign) >= 0;
}

/* Aims RAYS rays from inside a closed mesh: a third each at vertices, at
 * edges and at the interior of triangles. Each ray must hit a triangle, and
 * rays of the last third must hit exactly one. Returns the number of rays
 * that do not. */
static int count_rays_through_mesh(double size, int is_naive)
{
    enum { RAYS = 1500 };
    double at[BALL][3];
    uint32_t t[TRIANGLES][3];
    int n = 0;
    uint32_t seed = 3;

    make_bumpy_ball_mesh(at, t, size * ONE);
    for (int i = 0; i < RAYS; i++) {
        const uint32_t *aim = t[rng_int_below(&seed, TRIANGLES)];
        double w[3] = {.1 + rng_unit(&seed), .1 + rng_unit(&seed), 0}, from[3],
               to[3];
        struct glint_scene_ray ray;
        int met = 0;

        w[2] = i % 3 == 2 ? .1 + rng_unit(&seed) : 0;
        w[1] = i % 3 == 0 ? 0 : w[1];
        for (int k = 0; k < 3; k++) {
            from[k] = (rng_unit(&seed) - .5) * .2 * size * ONE;
            to[k] = 0;
            for (int j = 0; j < 3; j++)
                to[k] += w[j] * round(at[aim[j]][k]) / (w[0] + w[1] + w[2]);
            from[k] = round(from[k]);
        }
        ray = make_ray_from_doubles(from, to);
        for (int j = 0; j < TRIANGLES; j++) {
            struct glint_spot_on spot;
            int32_t v[3][3];

            for (int k = 0; k < 9; k++)
                v[k / 3][k % 3] = (int32_t)llround(at[t[j][k / 3]][k % 3]);
            met += is_naive ? ray_hits_triangle_q16(&ray, v)
                            : ray_hits_triangle(&ray, v, &spot);
        }
        n += i % 3 == 2 ? met != 1 : met == 0;
    }
    return n;
}

TEST(closed_mesh_has_no_leaks)
{
    for (double size = .01; size < 3000; size *= 7)
        assert_int_equal(count_rays_through_mesh(size, 0), 0);
    assert_true(count_rays_through_mesh(.01, 1) > 400);
    assert_true(count_rays_through_mesh(200, 1) > 400);
}

/* Checks that plain Q16.16 arithmetic overflows for the first triangle of the
 * tutorial. */
TEST(plain_q16_arithmetic_overflows)
{
    int32_t v[3][3], a[3], b[3], n[3];
    int64_t d = 0;

    set_scaled_triangle(v, first, 1);
    v3_subtract(v[1], v[0], a);
    v3_subtract(v[2], v[0], b);
    cross_q16(a, b, n);
    for (int k = 0; k < 3; k++)
        d += ((int64_t)n[k] * v[0][k]) >> 16;
    assert_true(d == -432000 * (int64_t)ONE && d != (int32_t)d);
}

/* Checks that the barycentric weights of a hit, applied to the corners, give
 * the hit's position. */
TEST(barycentric_weights_reproduce_the_hit)
{
    uint32_t seed = 9;

    for (int i = 0; i < 20000; i++) {
        double w[3], from[3], to[3] = {0}, sum = 0;
        struct glint_spot_on spot;
        struct glint_scene_ray ray;
        int32_t v[3][3], hit[3];

        for (int k = 0; k < 3; k++) {
            from[k] = rng_int_below(&seed, 1000);
            sum += w[k] = .02 + rng_unit(&seed);
        }
        for (int k = 0; k < 9; k++) {
            v[k / 3][k % 3] =
                (k % 3 == 2) * 40000 + rng_int_below(&seed, 30000);
            to[k % 3] += w[k / 3] / sum * v[k / 3][k % 3];
        }
        ray = make_ray_from_doubles(from, to);
        if (!ray_hits_triangle(&ray, v, &spot))
            continue; /* rounding may miss a sliver */
        assert_true(glint_ray_point_at_distance(&ray, spot.t, hit));
        assert_int_equal(spot.part_q30[0] + spot.part_q30[1] + spot.part_q30[2],
                         ONE_Q30);
        for (int k = 0; k < 3; k++) {
            int64_t at = 0;

            for (int j = 0; j < 3; j++)
                at += (int64_t)spot.part_q30[j] * v[j][k];
            assert_near_int(q_shift(at, 30), hit[k], 2);
        }
    }
}
