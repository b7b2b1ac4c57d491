/* SPDX-License-Identifier: MIT
 *
 * Tests the pupil window: the rectangle in a ghost's pupil that contains every
 * ray that passes a stop narrower than the model's. It must contain all of
 * them, be only a little larger, and move continuously while the stop closes.
 */
#include "flare/window.h"
#include "support/model_builder.h"
#include "support/test.h"

enum { ONE = 1 << 30, ACROSS = 240, DOWN = 120 };

/* Polynomials of a ray's position in the stop, |x|, |y| <= 2, and of its radius
 * r in the barrel aperture. */
struct shape {
    const char *name;
    uint16_t x_power[3], y_power[3];
    double x[3], y[3];
    /* (1 + r^2) / 2 = barrel[0] + barrel[1] u; barrel[0] = 0: there is no
     * barrel aperture */
    double barrel[2];
    /* max size of the window divided by the extent of passing rays */
    double slack;
};

#define P(u, v) MODEL_POWER(u, v, 0, 0)

static const struct shape shape[] = {
    {"straight", {P(1, 0)}, {P(0, 1)}, {1}, {1}, {0}, 1.15},
    {"aside", {P(0, 0), P(1, 0)}, {P(0, 1)}, {0.7, 0.9}, {0.5}, {0}, 1.15},
    {"bent",
     {P(0, 0), P(1, 0), P(2, 0)},
     {P(0, 1), P(1, 1)},
     {-0.2, 0.6, 0.5},
     {0.8, 0.3},
     {0},
     1.2},
    {"folded: seen twice",
     {P(0, 0), P(2, 0)},
     {P(0, 1)},
     {-0.36, 1},
     {1},
     {0},
     1.4},
    {"flat in the middle",
     {P(3, 0)},
     {P(0, 1), P(0, 3)},
     {1},
     {0.5, 0.5},
     {0},
     1.6},
    {"a ring",
     {P(1, 0), P(3, 0), P(1, 2)},
     {P(0, 1), P(2, 1), P(0, 3)},
     {-0.5, 1, 1},
     {-0.5, 1, 1},
     {0},
     1.25},
    {"half behind a barrel", {P(1, 0)}, {P(0, 1)}, {1}, {1}, {1, 2}, 1.5},
};

/* Shapes for lenses without rotational symmetry. Their pupil boxes have two
 * separate halves in y, with as many rows of rays together as other boxes have.
 * In the first shape, light passes a narrow strip over the full height of the
 * box, so its windows have the full height of 2^31. */
static const struct shape whole_shape[] = {
    {"a strip", {P(1, 0)}, {P(0, 1)}, {2}, {0.01}, {0}, 1.45},
    {"a strip aside",
     {P(0, 0), P(1, 0)},
     {P(0, 0), P(0, 1)},
     {0.4, 1.5},
     {0.1, 0.2},
     {0},
     1.45},
    {"above", {P(1, 0)}, {P(0, 0), P(0, 1)}, {1}, {-0.5, 1}, {0}, 1.45},
    {"below, askew",
     {P(1, 0), P(0, 1)},
     {P(0, 0), P(0, 1)},
     {1, 0.1},
     {0.5, 0.9},
     {0},
     1.45},
    {"at the top", {P(1, 0)}, {P(0, 0), P(0, 1)}, {1}, {-0.9, 1}, {0}, 1.45},
};

static struct glint_model_system begin_window_model(struct model_image *m,
                                                    enum glint_basis basis)
{
    static const int32_t box[GLINT_LENS_SIDES] = {0, 1 << 22, 1 << 22, 0};
    static const int32_t across_q30[2] = {0, ONE / 2};
    struct glint_model_system s;

    model_begin_header(m, basis, "shape");
    if (!glint_basis_is_lens(basis))
        return model_make_auto_system(m, 0, ONE / 2, MODEL_WAVE_LO_Q24,
                                      MODEL_WAVE_HI_Q24, 0);
    s = (struct glint_model_system){.sine_hi_q30 = ONE / 2,
                                    .wave_lo_q24 = MODEL_WAVE_LO_Q24,
                                    .wave_hi_q24 = MODEL_WAVE_HI_Q24,
                                    .box_exponent = -20,
                                    .box_terms = 1};
    s.box_at = model_append_items(m, box, sizeof box);
    s.across_at = model_append_items(m, across_q30, sizeof across_q30);
    return s;
}

static struct glint_lens
open_shape(const struct shape *s, enum glint_basis basis, struct model_image *m)
{
    static const struct glint_model_ghost ghost = {0, 1, 0, 1};
    /* With this exponent, coefficients may have values up to 4. */
    const int exponent = -28;
    struct model_polynomial p[] = {
        {GLINT_OUT_SENSOR_X, 1, -28, {P(1, 0)}, {1 << 27}},
        {GLINT_OUT_SENSOR_Y, 1, -28, {P(0, 1)}, {1 << 27}},
        {GLINT_OUT_STOP_X, 0, exponent, {0}, {0}},
        {GLINT_OUT_STOP_Y, 0, exponent, {0}, {0}},
        {GLINT_OUT_ENERGY, 1, -30, {P(0, 0)}, {1 << 28}},
        {GLINT_OUT_BARREL_0, 2, exponent, {P(0, 0), P(1, 0)}, {0}}};
    struct glint_model_system system = begin_window_model(m, basis);
    struct glint_lens lens;
    const char *reason = "";

    for (int k = 0; k < 3; k++) {
        p[2].power[k] = s->x_power[k];
        p[2].coef[k] = (int32_t)lrint(ldexp(s->x[k], 28));
        p[3].power[k] = s->y_power[k];
        p[3].coef[k] = (int32_t)lrint(ldexp(s->y[k], 28));
        p[2].n_terms = (uint8_t)(p[2].n_terms + (s->x[k] != 0));
        p[3].n_terms = (uint8_t)(p[3].n_terms + (s->y[k] != 0));
    }
    for (int k = 0; k < 2; k++)
        p[5].coef[k] = (int32_t)lrint(ldexp(s->barrel[k], 28));
    model_write_outputs(m, &system, p, s->barrel[0] != 0 ? 6 : 5, 0);
    model_append_ghosts(m, &ghost, 1, &system, 1);
    if (glint_lens_open(&lens, m->data, m->bytes, &reason) != GLINT_OK)
        fail_msg("%s: %s", s->name, reason);
    return lens;
}

static bool ray_passes_stop(const struct glint_transfer *t, double radius,
                            int i, int j)
{
    struct glint_outputs out;
    double x, y;

    glint_transfer_ray(t, (int32_t)((2.0 * i / ACROSS - 1) * ONE),
                       (int32_t)((double)j / DOWN * ONE), &out);
    x = ldexp(out.at[GLINT_OUT_STOP_X], t->exponent[GLINT_OUT_STOP_X]);
    y = ldexp(out.at[GLINT_OUT_STOP_Y], t->exponent[GLINT_OUT_STOP_Y]);
    return hypot(x, y) <= radius &&
           (!(t->outputs >> GLINT_OUT_BARREL_0 & 1) ||
            ldexp(out.at[GLINT_OUT_BARREL_0],
                  t->exponent[GLINT_OUT_BARREL_0]) <= 1);
}

/* Extent of the rays that pass a stop, found ray by ray; pupil coordinates of
 * -1 .. 1. LOW and HIGH are 0 .. 1 unless the pupil box has two halves in y. */
struct seen {
    double left, right, low, high;
    int n;
};

static struct seen find_range_of_passing_rays(const struct glint_transfer *t,
                                              double radius)
{
    struct seen s = {1, -1, t->whole ? 1 : 0, t->whole ? -1 : 0, 0};

    for (int j = t->whole ? -DOWN : 0; j <= DOWN; j++)
        for (int i = 0; i <= ACROSS; i++)
            if (ray_passes_stop(t, radius, i, j)) {
                s.left = fmin(s.left, 2.0 * i / ACROSS - 1);
                s.right = fmax(s.right, 2.0 * i / ACROSS - 1);
                s.low = fmin(s.low, (double)j / DOWN);
                s.high = fmax(s.high, (double)j / DOWN);
                s.n++;
            }
    return s;
}

static struct seen compute_pupil_window(const struct glint_transfer *t)
{
    const struct glint_box_window *w = &t->window;

    return (struct seen){((double)w->u_middle_q30 - w->u_half_q30) / ONE,
                         ((double)w->u_middle_q30 + w->u_half_q30) / ONE,
                         (double)w->v_from_q30 / ONE, (double)w->v_to_q30 / ONE,
                         0};
}

static void check_window_contains_rays(const struct shape *s,
                                       const struct glint_lens *lens,
                                       double opening)
{
    static struct glint_window_nodes nodes;
    static struct glint_transfer t;
    struct seen want, got;

    assert_int_equal(glint_transfer_init(&t, lens, 0, 0, MODEL_WAVE_LO_Q24), 1);
    want = find_range_of_passing_rays(&t, opening);
    if (!glint_window_narrow_to_stop(&nodes, &t, (int32_t)(opening * ONE))) {
        if (want.n)
            fail_msg("%s at %g: %d rays are invalid", s->name, opening, want.n);
        return;
    }
    got = compute_pupil_window(&t);
    assert_true(got.left >= -1 && got.right <= 1 && got.left < got.right);
    assert_true(got.low >= -1 && got.high > got.low && got.high <= 1);
    assert_true(t.whole || t.window.v_from_q30 == 0);
    if (want.n < 100)
        return;
    if (got.left > want.left + 1e-6 || got.right < want.right - 1e-6 ||
        got.low > want.low + 1e-6 || got.high < want.high - 1e-6)
        fail_msg("%s at %g: %g .. %g, %g .. %g instead of %g .. %g, %g .. %g",
                 s->name, opening, got.left, got.right, got.low, got.high,
                 want.left, want.right, want.low, want.high);
    /* the search is exact to one step */
    if (got.right - got.left >
            s->slack * (want.right - want.left + 4.0 / ACROSS) ||
        got.high - got.low > s->slack * (want.high - want.low + 2.0 / DOWN))
        fail_msg("%s at %g: %g .. %g, %g .. %g for %g .. %g, %g .. %g", s->name,
                 opening, got.left, got.right, got.low, got.high, want.left,
                 want.right, want.low, want.high);
}

TEST(window_contains_all_passing_rays)
{
    for (size_t k = 0; k < sizeof shape / sizeof *shape; k++) {
        struct model_image m;
        const struct glint_lens lens =
            open_shape(&shape[k], GLINT_BASIS_AUTO, &m);

        for (double opening = 1; opening > 0.01; opening *= 0.93)
            check_window_contains_rays(&shape[k], &lens, opening);
    }
}

/* Checks a pupil box with two halves in y, whose height of 2^31 overflows 32
 * bits. */
TEST(box_with_both_halves_does_not_overflow)
{
    for (size_t k = 0; k < sizeof whole_shape / sizeof *whole_shape; k++) {
        struct model_image m;
        const struct glint_lens lens = open_shape(
            &whole_shape[k],
            GLINT_BASIS_LENS + GLINT_MIRRORS_X + GLINT_MIRRORS_Y, &m);

        for (double opening = 1; opening > 0.01; opening *= 0.8)
            check_window_contains_rays(&whole_shape[k], &lens, opening);
    }
}

/* Closes the stop by 0.2 %. Checks that each side of the window moves by less
 * than a hundredth of the window's size. */
TEST(window_moves_smoothly_with_the_stop)
{
    static struct glint_window_nodes nodes;
    static struct glint_transfer t;
    struct model_image m;
    const struct glint_lens lens = open_shape(&shape[0], GLINT_BASIS_AUTO, &m);
    struct seen last = {-1, 1, 0, 1, 0};
    double worst = 0;

    for (double opening = 0.9; opening > 0.005; opening *= 0.998) {
        struct seen now;

        glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24);
        assert_int_equal(
            glint_window_narrow_to_stop(&nodes, &t, (int32_t)(opening * ONE)),
            1);
        now = compute_pupil_window(&t);
        if (opening < 0.89)
            worst = fmax(worst, fmax(fabs(now.right - last.right),
                                     fabs(now.high - last.high)) /
                                    opening);
        last = now;
    }
    print_message("sides step by %.4f of the stop at most\n", worst);
    assert_true(worst < 0.01);
}

TEST(no_passing_ray_gives_no_window)
{
    static const struct shape beside = {
        "beside", {P(0, 0), P(1, 0)}, {P(0, 1)}, {0.9, 0.1}, {0.5}, {0}, 1};
    static struct glint_window_nodes nodes;
    static struct glint_transfer t;
    struct model_image m;
    const struct glint_lens lens = open_shape(&beside, GLINT_BASIS_AUTO, &m);

    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24);
    assert_int_equal(
        glint_window_narrow_to_stop(&nodes, &t, (int32_t)(0.79 * ONE)), 0);
    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24);
    assert_int_equal(
        glint_window_narrow_to_stop(&nodes, &t, (int32_t)(0.85 * ONE)), 1);
    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24);
    assert_int_equal(glint_window_narrow_to_stop(&nodes, &t, 1 << 20), 0);
}

/* Checks that the window of an annular pupil has a lower and an upper end. */
TEST(annular_box_has_two_window_ends)
{
    static struct glint_window_nodes nodes;
    static struct glint_transfer t;
    static const struct shape aside = {
        "upwards", {P(1, 0)}, {P(0, 1), P(0, 3)}, {1}, {-0.64, 1}, {0}, 1};
    struct model_image m;
    /* the stop position y is 0 at v = 0.8, away from the middle */
    const struct glint_lens lens = open_shape(&aside, GLINT_BASIS_AUTO, &m);
    double low, high;

    glint_transfer_init(&t, &lens, 0, 0, MODEL_WAVE_LO_Q24);
    t.annulus = 1; /* the annular pupil begins at v = 1/2 */
    assert_int_equal(glint_window_narrow_to_stop(&nodes, &t, ONE / 20), 1);
    low = ldexp(glint_transfer_v(&t, 0, 8), -30);
    high = ldexp(glint_transfer_v(&t, 8, 8), -30);
    assert_true(low > 0.7 && low < 0.76 && high > 0.83 && high < 0.89);
}
