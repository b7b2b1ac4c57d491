/* SPDX-License-Identifier: MIT
 *
 * Tests the diffraction pattern of a stop with round blades. For roundness 0
 * and 1 it must equal that of the polygon and of the circle. Far out it must
 * approximate the exact pattern without its fringes. It must have as many fans
 * of light as straight blades have spikes, and rotate with the blades. A soft
 * edge limits it, and the extent of the lamp blurs it.
 */
#include "engine/star/psf.h"

#include "engine/star/star_tables.h"
#include "glint/view.h"
#include "support/stars/canvas.h"
#include "support/test.h"

static double arc_pattern(const struct glint_arcs *arcs, double x, double y)
{
    const double q = hypot(x, y);
    double pattern;

    glint_arcs_compute_patterns(arcs, atan2(y, x), &q, 1, &pattern);
    return pattern;
}

static double compute_far_arc_pattern(const struct glint_arcs *arcs, double x,
                                      double y)
{
    const double q = hypot(x, y);
    double pattern;

    glint_arcs_compute_far_patterns(arcs, atan2(y, x), &q, 1, &pattern);
    return pattern;
}

/* Returns the mean of the diffraction pattern |F|^2 / A^2 times q^3 / AT^3 over
 * the frequencies q of 0.8 to 1.2 times AT, in the direction PHI. F is the
 * amplitude and A the area of the stop. */
static double
mean_scaled_pattern(double (*f)(const struct glint_arcs *, double, double),
                    const struct glint_arcs *arcs, double at, double phi)
{
    enum { N = 400 };
    double sum = 0;

    for (int i = 0; i < N; i++) {
        const double r = 0.8 + 0.4 * (i + 0.5) / N;

        sum += f(arcs, r * at * cos(phi), r * at * sin(phi)) * r * r * r / N;
    }
    return sum;
}

static double compute_circle_pattern(const struct glint_arcs *arcs, double x,
                                     double y)
{
    (void)arcs;
    return glint_psf_compute_pattern(0, 0, x, y);
}

static double compute_polygon_pattern(const struct glint_arcs *arcs, double x,
                                      double y)
{
    return glint_psf_compute_pattern(arcs->n, arcs->rotation_deg, x, y);
}

TEST(arcs_end_at_the_corners)
{
    static const int blades[] = {3, 5, 6, 8, 9, 64};

    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 40; k++) {
            const double at = 0.3 + 0.1 * k, phi = 0.7 * k;
            struct glint_arcs arcs;
            double one, other;

            glint_arcs_init(&arcs, blades[i], 10, 0.9999);
            one = mean_scaled_pattern(arc_pattern, &arcs, at, phi);
            other = mean_scaled_pattern(compute_circle_pattern, &arcs, at, phi);
            assert_true(fabs(one / other - 1) < 0.02);
            glint_arcs_init(&arcs, blades[i], 10, 1e-3);
            one = mean_scaled_pattern(arc_pattern, &arcs, at, phi);
            other =
                mean_scaled_pattern(compute_polygon_pattern, &arcs, at, phi);
            assert_true(fabs(one / other - 1) < 0.02);
        }
}

/* Checks that the two methods of summing an arc agree at the frequency q = 5,
 * at which the code switches between them. */
TEST(switching_methods_causes_no_step)
{
    struct glint_arcs arcs;

    for (int n = 3; n < 12; n++)
        for (int k = 0; k < 20; k++) {
            const double phi = k * 0.31;
            double before, after;

            glint_arcs_init(&arcs, n, 10, 0.05 + 0.04 * k);
            before = arc_pattern(&arcs, 4.99999 * cos(phi), 4.99999 * sin(phi));
            after = arc_pattern(&arcs, 5.00001 * cos(phi), 5.00001 * sin(phi));
            assert_true(fabs(sqrt(before) - sqrt(after)) < 4e-4);
        }
}

/* Checks the sum over the arcs' outlines against a fine sum over the points of
 * the arcs, at frequencies on both sides of q = 5, many at once. */
TEST(patterns_match_direct_summation)
{
    enum { N = 150, POINTS = 20000 };

    for (int n = 5; n < 9; n++) {
        struct glint_arcs a;
        double q[N], pattern[N];

        glint_arcs_init(&a, n, 10, 0.1 * (n - 3));
        for (int k = 0; k < N; k++)
            q[k] = 0.05 + 0.2 * k;
        glint_arcs_compute_patterns(&a, 0.7, q, N, pattern);
        for (int k = 0; k < N; k += 7) {
            double re = 0, im = 0, size;

            for (int i = 0; i < n * POINTS; i++) {
                const double normal =
                    10 * GLINT_PI / 180 + (i / POINTS + 0.5) * 2 * GLINT_PI / n;
                const double phi =
                    a.turn * (2 * (i % POINTS + 0.5) / POINTS - 1);
                const double phase = 2 * GLINT_PI * q[k] *
                                     (cos(normal + phi - 0.7) / a.round -
                                      a.behind * cos(normal - 0.7));

                re += cos(normal + phi - 0.7) * cos(phase);
                im -= cos(normal + phi - 0.7) * sin(phase);
            }
            size = hypot(re, im) * 2 * a.turn / a.round / POINTS /
                   (2 * GLINT_PI * q[k] * a.area);
            assert_true(fabs(sqrt(pattern[k]) - size) < 4e-4);
        }
    }
}

/* Checks the approximation of the distant pattern on a circle around the lamp.
 * The sum over the circle, with all fans and gaps, must be right within 5 %,
 * each direction within a factor of three. */
TEST(distant_pattern_sums_over_a_circle)
{
    enum { PHIS = 48 };

    for (int k = 0; k < 24; k++) {
        struct glint_arcs arcs;
        double exact = 0, far = 0;

        glint_arcs_init(&arcs, 5 + k % 4, 10, 0.05 + 0.3 * (k / 4 % 3));
        for (int i = 0; i < PHIS; i++) {
            const double phi = 2 * GLINT_PI * i / PHIS, at = k < 12 ? 12 : 60;
            const double one = mean_scaled_pattern(arc_pattern, &arcs, at, phi);
            const double other =
                mean_scaled_pattern(compute_far_arc_pattern, &arcs, at, phi);

            assert_true(other > 0.3 * one && other < 3 * one);
            exact += one;
            far += other;
        }
        assert_true(fabs(far / exact - 1) < 0.05);
    }
}

/* Returns the number of peaks on a circle of R pixels. A peak is brighter than
 * both of its neighbours and than the mean of the circle. */
static int count_peaks_on_circle(const struct glint_psf *p, double r)
{
    enum { N = 720 };
    double light[N], mean = 0;
    int n = 0;

    for (int i = 0; i < N; i++) {
        const double phi = 2 * GLINT_PI * i / N;
        double rgb[3];

        glint_psf_compute_far_light(p, r * cos(phi), r * sin(phi), NULL, NULL,
                                    rgb);
        light[i] = rgb[1];
        mean += rgb[1] / N;
    }
    for (int i = 0; i < N; i++)
        n += light[i] > mean && light[(i + N - 1) % N] <= mean;
    return n;
}

/* Checks that stops of 5, 6 and 8 blades give 10, 6 and 8 fans, which rotate
 * with the blades. */
TEST(fans_rotate_with_the_blades)
{
    static const int blades[3] = {5, 6, 8}, fans[3] = {10, 6, 8};

    for (int i = 0; i < 3; i++) {
        struct glint_psf one, turned;
        double a[3], b[3];

        assert_ok(glint_psf_init_iris(&one, blades[i], 20, 1, 0.2, 0, false));
        assert_ok(
            glint_psf_init_iris(&turned, blades[i], 21, 1, 0.2, 0, false));
        assert_int_equal(count_peaks_on_circle(&one, 200), fans[i]);
        for (int k = 0; k < 90; k++) {
            const double phi = k * GLINT_PI / 180, turn = GLINT_PI / 180;

            /* In images, y points down. */
            glint_psf_compute_light(&one, 40 * cos(phi), 40 * sin(phi), a);
            glint_psf_compute_light(&turned, 40 * cos(phi - turn),
                                    40 * sin(phi - turn), b);
            assert_true(fabs(a[1] / b[1] - 1) < 1e-6);
        }
        glint_psf_finish(&one);
        glint_psf_finish(&turned);
    }
}

/* Checks that a soft edge of the stop keeps most light in the centre of the
 * pattern, and removes its light far out. */
TEST(soft_edge_removes_distant_light)
{
    struct glint_psf hard, soft;
    double a[3], b[3];

    assert_true(fabs(glint_psf_compute_soft_edge_factor(0.1, 0) - 1) < 1e-9);
    assert_true(glint_psf_compute_soft_edge_factor(0.1, 100) < 1e-3);
    assert_ok(glint_psf_init_iris(&hard, 8, 0, 1, 0.3, 0, false));
    assert_ok(glint_psf_init_iris(&soft, 8, 0, 1, 0.3, 0.1, false));
    assert_ok(glint_psf_make_near_table(&hard));
    assert_ok(glint_psf_make_near_table(&soft));
    glint_psf_compute_light(&hard, 0, 0, a);
    glint_psf_compute_light(&soft, 0, 0, b);
    assert_true(b[1] > 0.75 * a[1] && b[1] < a[1]);
    glint_psf_compute_light(&hard, 100, 30, a);
    glint_psf_compute_light(&soft, 100, 30, b);
    assert_true(b[1] < 0.02 * a[1]);
    glint_psf_finish(&hard);
    glint_psf_finish(&soft);
}

static struct glint_star_tables *make_star_tables(int n_blades, double round,
                                                  double soft)
{
    const struct glint_star_optics o = {.n_blades = n_blades,
                                        .f_number = 2 / 0.55,
                                        .pixel_um = 1,
                                        .has_core = true,
                                        .round = round,
                                        .soft = soft};
    struct glint_star_tables *t;

    assert_ok(glint_star_tables_make(&t, &o));
    return t;
}

/* Returns the full width at half maximum, pixels, of a spike. The spike points
 * upwards from a lamp of RADIUS pixels, and is measured 100 pixels from the
 * lamp. */
static int measure_spike_width_px(double round, double soft, double radius)
{
    enum { SIDE = 255, ROW = 27 };
    struct glint_star_tables *t = make_star_tables(6, round, soft);
    struct glint_star_light lamp = star_canvas_make_light(127.5, 127.5, 20);
    int32_t *linear_q20 =
        test_free_later(malloc(3 * SIDE * SIDE * sizeof *linear_q20));
    const int32_t *row = linear_q20 + 3 * SIDE * ROW;
    struct star_canvas canvas;
    int n = 0;

    lamp.radius_q8 = (int32_t)(256 * radius);
    star_canvas_open(&canvas, SIDE, SIDE, 5, 1, 1);
    star_canvas_draw_light(&canvas, t, &lamp, 1, glint_real_of(0x1p-21),
                           GLINT_LINEAR_Q20, linear_q20);
    star_canvas_close(&canvas);
    for (int x = 90; x < 165; x++)
        n += 2 * row[3 * x + 1] > row[3 * 127 + 1];
    glint_star_tables_free(t);
    return n;
}

/* Checks that the extent of a lamp widens fans as much as spikes, and that
 * almost straight blades give almost the same pattern as straight ones. */
TEST(wide_lamp_widens_fans)
{
    for (int radius = 4; radius <= 16; radius *= 2) {
        const int straight = measure_spike_width_px(0, 0, radius);
        const int close = measure_spike_width_px(0.001, 0.001, radius);
        const int round = measure_spike_width_px(0.03, 0, radius);
        const int soft = measure_spike_width_px(0, 0.003, radius);

        assert_int_equal(close, straight);
        assert_true(4 * round > 3 * straight && 3 * round < 4 * straight);
        assert_true(4 * soft > 3 * straight && 3 * soft < 4 * straight);
    }
}

/* Halos are tabulated for radii of 8 and 16 pixels. */
TEST(halos_are_interpolated_between_tabulated_radii)
{
    const int narrow = measure_spike_width_px(0.03, 0, 8);
    const int between = measure_spike_width_px(0.03, 0, 11.3);
    const int wide = measure_spike_width_px(0.03, 0, 16);

    assert_true(between > narrow && between < wide);
}

/* Checks that blades of curvature 1 have the tables of a circle, and that
 * blades of almost that curvature have an almost even halo. */
TEST(round_blades_become_a_circle)
{
    struct glint_star_tables *circle = make_star_tables(0, 0, 0);
    struct glint_star_tables *one = make_star_tables(6, 1, 0);
    struct glint_star_tables *near = make_star_tables(6, 0.97, 0);

    assert_int_equal(glint_star_tables_count_bytes(one),
                     glint_star_tables_count_bytes(circle));
    assert_memory_equal(one->halo, circle->halo, sizeof one->halo);
    assert_memory_equal(one->core, circle->core, sizeof one->core);
    for (int i = 12; i < 24; i++) {
        int least = 65535, most = 0;

        for (int k = 0; k < GLINT_STAR_HALO_COLUMNS; k++) {
            least = near->halo[i][k][1] < least ? near->halo[i][k][1] : least;
            most = near->halo[i][k][1] > most ? near->halo[i][k][1] : most;
        }
        /* a third of an octave, as log2 in Q11 */
        assert_true(most - least < 1024);
    }
    glint_star_tables_free(circle);
    glint_star_tables_free(one);
    glint_star_tables_free(near);
}
