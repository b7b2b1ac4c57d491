/* SPDX-License-Identifier: MIT
 *
 * Tests the frame statistics of ray bundles. Each outcome of a bundle (drawn;
 * closed, as no ray passes; faint; ...) must have its own cause, and counts
 * must equal those of the drawn frame. The images of single ghosts, lights and
 * wavelengths must add up to the complete image.
 */
#include "base/real.h"
#include "flare/by_edges.h"
#include "support/model_builder.h"
#include "support/models/frame_parts.h"
#include "support/test.h"

enum {
    WIDTH = 160,
    HEIGHT = 120,
    WAVES = 2,
    MAX_LIGHTS = 4,
    N = WIDTH * HEIGHT
};

struct fixture {
    struct model_image m;
    struct glint_lens lens;
    struct glint_wave wave[WAVES];
    struct glint_light light[MAX_LIGHTS];
    int n_lights;
    struct glint_flare_frame rays;
    struct glint_flare_config cfg;
    struct glint_flare_stats stats;
    struct glint_flare *flare;
};

/* Opens a model with WAVES wavelengths. Sets N_LIGHTS lights at the angle of
 * sine 1/8, each at another azimuth. */
static void open_model_with_beams(struct fixture *f, int n_lights)
{
    *f = (struct fixture){.m = model_make_three_ghosts(), .n_lights = n_lights};
    f->lens = model_open_image(&f->m);
    set_frame_wavelengths(f->wave);
    for (int i = 0; i < MAX_LIGHTS; i++)
        f->light[i] = (struct glint_light){1 << 27,
                                           1065344904,
                                           (int32_t)lrint(cos(i) * 0x1p30),
                                           (int32_t)lrint(sin(i) * 0x1p30),
                                           real_of(1000 + i, 0),
                                           {16384, 16384, 16384},
                                           0};
    f->rays = make_frame_rays(&f->lens, f->wave, 16);
    f->cfg = make_frame_config(WIDTH, HEIGHT, 4);
    f->cfg.max_bundles = 64;
    f->cfg.max_primitives = 60000;
    f->cfg.max_refs = 120000;
}

static void plan_and_bin_edges(struct fixture *f)
{
    const size_t bytes = glint_flare_bytes(&f->cfg);

    assert_ok(
        glint_flare_init(&f->flare, &f->cfg, test_allocate(bytes), bytes));
    glint_flare_plan(f->flare, &f->rays, f->light, f->n_lights);
    glint_flare_bin(f->flare, &f->stats);
}

/* Returns the address of the coefficient of term TERM of output KIND of
 * system SYSTEM. */
static int32_t *coefficient_of(struct fixture *f, int system, int kind,
                               int term)
{
    const struct glint_model_system *s = &f->lens.system[system];
    const struct glint_model_output *o =
        (const void *)(f->m.data + s->output_at);

    while (o->kind != kind)
        o++;
    return (int32_t *)(void *)(f->m.data + o->coef_at) + term;
}

struct sums {
    int of[GLINT_OUTCOMES], n, edges, refs;
    double flux;
};

/* Checks the statistics of each ray bundle and returns their sums. */
static struct sums sum_bundle_statistics(struct fixture *f)
{
    struct sums sums = {.n = 0};

    for (int light = 0; light < f->n_lights; light++)
        for (int ghost = 0; ghost < (int)f->lens.header->n_ghosts; ghost++)
            for (int wave = 0; wave < WAVES; wave++) {
                struct glint_account a;

                glint_flare_account(f->flare, ghost, light, wave, &a);
                sums.of[a.outcome]++;
                sums.n++;
                sums.edges += a.edges;
                sums.refs += a.refs;
                sums.flux += ldexp(a.flux.mantissa, a.flux.exponent);
                assert_int_equal(a.vertices,
                                 a.cells ? (a.cells + 1) * (a.cells + 1) : 0);
                assert_int_equal(a.outcome == GLINT_OUTCOME_DRAWN, a.edges > 0);
                assert_true(a.rows >= a.edges);
                if (a.cells)
                    assert_true(a.probed == 8 * 5 ||
                                a.probed == 8 * 5 + 17 * 9);
            }
    return sums;
}

static void assert_sums_equal_totals(struct fixture *f)
{
    const struct sums s = sum_bundle_statistics(f);
    struct glint_real brightest, flux;

    assert_int_equal(s.of[GLINT_OUTCOME_DRAWN] + s.of[GLINT_OUTCOME_EMPTY],
                     f->stats.bundles);
    assert_int_equal(s.of[GLINT_OUTCOME_NO_ROOM], f->stats.dropped_bundles);
    assert_int_equal(s.edges, f->stats.primitives);
    assert_int_equal(s.refs, f->stats.refs);
    glint_flare_light(f->flare, &brightest, &flux);
    assert_true(fabs(s.flux - ldexp(flux.mantissa, flux.exponent)) <=
                1e-6 * s.flux);
}

/* Checks that N ray bundles have OUTCOME and that all others are drawn or
 * closed (no ray passes). */
static void assert_bundle_outcome(struct fixture *f, enum glint_outcome outcome,
                                  int n)
{
    struct sums s;

    plan_and_bin_edges(f);
    assert_sums_equal_totals(f);
    s = sum_bundle_statistics(f);
    assert_int_equal(s.of[outcome], n);
    assert_int_equal(
        s.of[outcome] + s.of[GLINT_OUTCOME_CLOSED] +
            (outcome == GLINT_OUTCOME_DRAWN ? 0 : s.of[GLINT_OUTCOME_DRAWN]),
        s.n);
}

/* ------------------------------------------------- outcomes of ray bundles */

/* Ghost 1 of the model is closed (no ray passes) at all angles, ghost 2 at
 * sines below 1/8. */
TEST(counts_drawn_and_closed_bundles)
{
    struct fixture f;

    open_model_with_beams(&f, 3);
    assert_bundle_outcome(&f, GLINT_OUTCOME_DRAWN, 3 * 2 * WAVES);
    assert_int_equal(sum_bundle_statistics(&f).of[GLINT_OUTCOME_CLOSED],
                     3 * WAVES);
    f.light[1].sine_q30 = 1 << 26;
    assert_bundle_outcome(&f, GLINT_OUTCOME_DRAWN, (3 * 2 - 1) * WAVES);
}

TEST(counts_bundles_of_other_ghosts)
{
    struct fixture f;

    open_model_with_beams(&f, 2);
    f.rays.only_ghost = 2;
    assert_bundle_outcome(&f, GLINT_OUTCOME_OTHER, 2 * 2 * WAVES);
}

TEST(counts_lights_outside_the_model)
{
    struct fixture f;

    open_model_with_beams(&f, 3);
    for (int i = 0; i < 3; i++) {
        f.light[i].sine_q30 = 1 << 29; /* 30 degrees */
        ((struct glint_model_header *)f.m.data)->sine_hi_q30 = 1 << 28;
        assert_bundle_outcome(&f, GLINT_OUTCOME_BEYOND, (i + 1) * 3 * WAVES);
    }
}

TEST(counts_bundles_without_light)
{
    struct fixture f;

    open_model_with_beams(&f, 2);
    /* Without red light, wavelength 0 has no light. */
    f.light[1].rgb_q14[0] = 0;
    assert_bundle_outcome(&f, GLINT_OUTCOME_DARK, 2);
    f.light[0].power = real_of(0, 0);
    assert_bundle_outcome(&f, GLINT_OUTCOME_DARK, 2 + 4);
}

TEST(counts_bundles_blocked_by_barrels)
{
    struct fixture f;

    open_model_with_beams(&f, 2);
    /* A value above 1 means that the barrel aperture blocks the ray; here it
     * blocks all rays. */
    *coefficient_of(&f, 0, GLINT_OUT_BARREL_0, 0) = 295279001;
    *coefficient_of(&f, 1, GLINT_OUT_BARREL_0, 0) = 295279001;
    assert_bundle_outcome(&f, GLINT_OUTCOME_BLOCKED, 2 * WAVES);
}

/* Moves ghost 0 to the right of the image, which is 2.5 mm wide. Its outcome
 * must be OUTSIDE far off the image, EMPTY nearer, and DRAWN inside. */
TEST(counts_bundles_outside_the_image)
{
    struct fixture f;

    open_model_with_beams(&f, 1);
    f.light[0].sine_q30 = 1 << 26;
    *coefficient_of(&f, 0, GLINT_OUT_SENSOR_X, 0) = 510027366; /* 1.9 mm */
    assert_bundle_outcome(&f, GLINT_OUTCOME_OUTSIDE, WAVES);
    *coefficient_of(&f, 0, GLINT_OUT_SENSOR_X, 0) = 469762048; /* 1.75 mm */
    assert_bundle_outcome(&f, GLINT_OUTCOME_EMPTY, WAVES);
    *coefficient_of(&f, 0, GLINT_OUT_SENSOR_X, 0) = 402653184; /* 1.5 mm */
    assert_bundle_outcome(&f, GLINT_OUTCOME_DRAWN, WAVES);
}

/* Checks that ray bundles fainter than FAINTEST are counted as faint, with one
 * light and with several. */
TEST(counts_faint_bundles)
{
    struct fixture f;

    for (int n = 1; n <= MAX_LIGHTS; n++) {
        open_model_with_beams(&f, n);
        f.rays.faintest = real_of(1, 60);
        assert_bundle_outcome(&f, GLINT_OUTCOME_FAINT, n * 2 * WAVES);
    }
}

TEST(counts_bundles_without_memory)
{
    struct glint_flare_stats all;
    struct fixture f;

    open_model_with_beams(&f, 4);
    plan_and_bin_edges(&f);
    all = f.stats;
    f.cfg.max_bundles = 8;
    plan_and_bin_edges(&f);
    assert_sums_equal_totals(&f);
    assert_int_equal(sum_bundle_statistics(&f).of[GLINT_OUTCOME_NO_ROOM],
                     4 * 3 * WAVES - 8);
    f.cfg.max_bundles = 64;
    for (int part = 1; part < 4; part++) {
        f.cfg.max_primitives = all.primitives * part / 4;
        f.cfg.max_refs = all.refs;
        plan_and_bin_edges(&f);
        assert_sums_equal_totals(&f);
        assert_true(sum_bundle_statistics(&f).of[GLINT_OUTCOME_NO_ROOM] > 0);
        f.cfg.max_primitives = all.primitives;
        f.cfg.max_refs = all.refs * part / 4;
        plan_and_bin_edges(&f);
        assert_sums_equal_totals(&f);
        assert_true(sum_bundle_statistics(&f).of[GLINT_OUTCOME_NO_ROOM] > 0);
    }
}

static void draw_flare_image(struct fixture *f, int32_t *px_q20)
{
    struct glint_image image =
        glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);

    memset(px_q20, 0, sizeof *px_q20 * 3 * N);
    glint_flare_draw(f->flare, &image);
}

/* Checks that the images of single ghosts, of single lights and of single
 * wavelengths each add up to the whole image, within their rounding to 2^-20.
 * The image of ghost 1, which no ray passes, is black. */
TEST(images_of_parts_add_up)
{
    static int32_t whole[3 * N], part[3 * N];
    static int64_t sum[3 * N];
    const int parts[3] = {3, 2, WAVES};
    struct fixture f;

    open_model_with_beams(&f, 2);
    plan_and_bin_edges(&f);
    draw_flare_image(&f, whole);
    for (int by = 0; by < 3; by++) {
        memset(sum, 0, sizeof sum);
        for (int k = 0; k < parts[by]; k++) {
            int64_t any = 0;

            glint_flare_keep(f.flare, by == 0 ? k : -1, by == 1 ? k : -1,
                             by == 2 ? k : -1);
            draw_flare_image(&f, part);
            for (int i = 0; i < 3 * N; i++) {
                sum[i] += part[i];
                any |= part[i];
            }
            assert_int_equal(any != 0, by != 0 || k != 1);
        }
        for (int i = 0; i < 3 * N; i++)
            assert_true(llabs(sum[i] - whole[i]) <= parts[by]);
    }
    glint_flare_keep(f.flare, -1, -1, -1);
    draw_flare_image(&f, part);
    assert_memory_equal(part, whole, sizeof whole);
}

TEST(statistics_do_not_change_the_image)
{
    static int32_t before[3 * N], after[3 * N];
    struct fixture f;

    open_model_with_beams(&f, 4);
    plan_and_bin_edges(&f);
    draw_flare_image(&f, before);
    plan_and_bin_edges(&f);
    sum_bundle_statistics(&f);
    draw_flare_image(&f, after);
    assert_memory_equal(before, after, sizeof before);
}

/* Checks the number of polynomial terms evaluated for ghost 0: sensor x 3, or 2
 * in the middle of the range of angles, where s and so v^2 s is 0; sensor y 2;
 * stop x 1; stop y 2; energy 1 for a given wavelength; barrel aperture 2. */
TEST(counts_polynomial_terms)
{
    struct glint_account a;
    struct fixture f;

    open_model_with_beams(&f, 1);
    for (int off = 0; off < 2; off++) {
        f.light[0].sine_q30 = (1 << 27) - (off << 26);
        plan_and_bin_edges(&f);
        glint_flare_account(f.flare, 0, 0, 0, &a);
        assert_int_equal(a.outcome, GLINT_OUTCOME_DRAWN);
        assert_int_equal(a.outputs, 6);
        assert_int_equal(a.barrels, 1);
        assert_int_equal(a.terms, 2 + off + 2 + 1 + 2 + 1 + 2);
    }
}

/* Checks the number of rows that edges cross against a count that tests each
 * row for overlap with each edge. */
TEST(counts_rows_of_edges)
{
    struct fixture f;
    int64_t want = 0, got = 0;

    open_model_with_beams(&f, 2);
    /* at this scale the ghost is larger than the image */
    f.rays.pixels_per_mm = real_of(200, 0);
    plan_and_bin_edges(&f);
    for (int i = 0; i < f.stats.primitives; i++)
        for (int y = 0; y < HEIGHT; y++)
            want +=
                glint_flare_get_edges(f.flare)->edge[i].y_q8 < 256 * (y + 1) &&
                glint_flare_get_edges(f.flare)->edge[i].end_y_q8 > 256 * y;
    for (int light = 0; light < 2; light++)
        for (int ghost = 0; ghost < 3; ghost++)
            for (int wave = 0; wave < WAVES; wave++) {
                struct glint_account a;

                glint_flare_account(f.flare, ghost, light, wave, &a);
                got += a.rows;
            }
    assert_true(want > 1000);
    assert_int_equal(got, want);
}

/* Returns the light in the middle WIDTH x HEIGHT pixels of an image that is
 * larger. */
static int64_t sum_light_in_middle(const int32_t *px_q20, int width, int height)
{
    int64_t sum = 0;

    for (int y = (height - HEIGHT) / 2; y < (height + HEIGHT) / 2; y++)
        for (int x = 3 * (width - WIDTH) / 2; x < 3 * (width + WIDTH) / 2; x++)
            sum += px_q20[3 * width * y + x];
    return sum;
}

/* Scales up the polynomials of a ray's position in the stop. With a round stop,
 * only rays in a small spot of the ghost's pupil then pass, and no ray of the
 * prepass is near the edge of this spot. */
static void scale_stop_polynomials(struct fixture *f)
{
    const struct glint_model_output *o =
        (const void *)(f->m.data + f->lens.system[0].output_at);

    for (int k = 0; k < f->lens.system[0].n_outputs; k++, o++)
        for (int term = 0; term < o->n_terms; term++)
            if (o->kind == GLINT_OUT_STOP_X || o->kind == GLINT_OUT_STOP_Y)
                *coefficient_of(f, 0, o->kind, term) =
                    *coefficient_of(f, 0, o->kind, term) / 5 * 12;
    f->cfg.stop.n_blades = 0;
}

/* Checks that a ghost with the outcome OUTSIDE adds no light to the image, by
 * drawing a larger image around it. Tries all azimuths and increasing
 * distances. */
static void check_outside_ghost_adds_no_light(int small_stop)
{
    enum { WIDE = 4 * WIDTH, HIGH = 4 * HEIGHT };
    static int32_t px_q20[3 * WIDE * HIGH];
    int n_outside = 0, n_drawn = 0;
    struct fixture f;

    open_model_with_beams(&f, 1);
    if (small_stop)
        scale_stop_polynomials(&f);
    for (int degrees = 0; degrees < 360; degrees += small_stop ? 90 : 15)
        for (int x_q28 = 1 << 27; x_q28 < 536870912;
             x_q28 += 1 << (small_stop ? 21 : 25)) {
            struct glint_image image =
                glint_image_over(px_q20, GLINT_LINEAR_Q20, WIDE, HIGH);
            struct glint_account a;

            f.rays.pixels_per_mm = real_of(100, 0);
            f.light[0].sine_q30 = 1 << 26;
            f.light[0].cos_q30 =
                (int32_t)lrint(cos(degrees / 57.29578) * 0x1p30);
            f.light[0].sin_q30 =
                (int32_t)lrint(sin(degrees / 57.29578) * 0x1p30);
            *coefficient_of(&f, 0, GLINT_OUT_SENSOR_X, 0) = x_q28;
            f.cfg.width = WIDTH;
            f.cfg.height = HEIGHT;
            plan_and_bin_edges(&f);
            glint_flare_account(f.flare, 0, 0, 0, &a);
            if (a.outcome != GLINT_OUTCOME_OUTSIDE) {
                n_drawn++;
                continue;
            }
            n_outside++;
            f.cfg.width = WIDE;
            f.cfg.height = HIGH;
            plan_and_bin_edges(&f);
            memset(px_q20, 0, sizeof px_q20);
            glint_flare_draw(f.flare, &image);
            assert_true(sum_light_in_middle(px_q20, WIDE, HIGH) == 0);
        }
    assert_true(n_outside > 20 && n_drawn > 20);
}

TEST(outside_bundles_add_no_light)
{
    check_outside_ghost_adds_no_light(0);
    check_outside_ghost_adds_no_light(1);
}
