/* SPDX-License-Identifier: MIT
 *
 * Tests frames that reuse the binned edges of the previous frame. Each must
 * equal, bit by bit, the image drawn without reuse, for any number of workers
 * and whatever changed before it. An unchanged frame must be reused. Lights
 * that move less than a tolerance are drawn with their old rays but their
 * present power; they are never displaced by more than the tolerance.
 */
#include "support/shuffle.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 240, H = 160, BYTES = 3 * W * H, LIGHTS = 6, FRAMES = 48 };

static struct stage stage;
static struct glint_frame reusing, fresh;
static struct glint_lamp lamps[LIGHTS];
static uint8_t got[BYTES], want[BYTES];
static struct glint_engine_report of_reusing, of_fresh;

TEST_OPEN
{
    assert_true(stage_open_lens(&stage, "double-gauss-angenieux", W, H));
}

TEST_CLOSE
{
    stage_free(&stage);
}

static void open_both_frames(double px)
{
    glint_frame_init_like(&reusing, &stage.frame, stage.view);
    glint_frame_init_like(&fresh, &stage.frame, stage.view);
    reusing.cfg.reuse = &glint_reuse;
    reusing.dials.still_px = px;
    for (int i = 0; i < LIGHTS; i++)
        lamps[i] = stage_make_lamp(3 + 2 * i, 50 * i, 3e5 * exp2(-i));
}

static void close_both_frames(void)
{
    glint_frame_finish(&reusing);
    glint_frame_finish(&fresh);
}

static void draw_lamps_with_frame(struct glint_frame *frame, int n,
                                  double scale, uint8_t *codes,
                                  struct glint_engine_report *report)
{
    struct glint_image image = glint_image_over(codes, GLINT_RGB24, W, H);

    memset(codes, 20, BYTES);
    assert_ok(glint_frame_draw(frame, lamps, n, scale, &image, report));
}

/* Draws N lamps with and without reuse and checks that both images are equal.
 * Returns whether the edges of the previous frame were reused. */
static bool draw_with_and_without_reuse(int n)
{
    draw_lamps_with_frame(&reusing, n, 1, got, &of_reusing);
    draw_lamps_with_frame(&fresh, n, 1, want, &of_fresh);
    assert_int_equal(of_fresh.stats.reused, 0);
    assert_memory_equal(got, want, BYTES);
    return of_reusing.stats.reused;
}

static void set_stop_of_frames(double opening)
{
    struct glint_frame *const all[] = {&reusing, &fresh};

    for (int i = 0; i < 2; i++) {
        all[i]->cfg.stop.opening_q30 = (int32_t)lrint(opening * 0x1p30);
        glint_frame_apply_config(all[i]);
    }
}

/* -------------------------------------------------------- unchanged frames */

/* At certain values of TIME, changes the lamps or a setting of both frames and
 * returns true. At others returns false; the next frame must then reuse the
 * edges. */
static bool change_setting_or_lamps_at_times(int time, int *n)
{
    switch (time % 12) {
    case 1: /* one lamp moves by an invisible amount */
        lamps[time / 12].theta_deg += 1e-6 * (time + 1);
        return true;
    case 3:
        lamps[time / 12].power *= 1.001;
        return true;
    case 5:
        *n = *n == LIGHTS ? LIGHTS - 1 : LIGHTS;
        return true;
    case 7:
        set_stop_of_frames(time % 24 == 7 ? 0.7 : 1);
        return true;
    case 9:
        reusing.dials = glint_dials_at((1 << 11) + 500 * time);
        reusing.dials.still_px = 0;
        fresh.dials = reusing.dials;
        return true;
    case 11:
        lamps[time / 12].rgb[1] *= 0.99;
        return true;
    default:
        return false;
    }
}

static void check_reuse_in_video(void)
{
    int n = LIGHTS, n_reused = 0;

    open_both_frames(0);
    draw_with_and_without_reuse(n);
    for (int time = 0; time < FRAMES; time++) {
        const bool turned = change_setting_or_lamps_at_times(time, &n);
        const bool reused = draw_with_and_without_reuse(n);

        n_reused += reused;
        assert_int_equal(reused, !turned);
        /* frames that are reused skip the ray prepass and planning */
        assert_true(reused == (of_reusing.looked == 0));
        assert_int_equal(of_reusing.stats.primitives,
                         of_fresh.stats.primitives);
        assert_int_equal(of_reusing.ghosts, of_fresh.ghosts);
    }
    assert_int_equal(n_reused, FRAMES / 2);
    close_both_frames();
}

TEST(reused_rays_give_the_same_image)
{
    struct shuffle shuffle;

    check_reuse_in_video();
    for (int n = 2; n <= 5; n += 3) {
        init_shuffled_workers(&shuffle, n, (uint32_t)n);
        stage.frame.cfg.workers = &shuffle.workers;
        check_reuse_in_video();
    }
    stage.frame.cfg.workers = NULL;
}

static struct glint_tint tints[GLINT_MAX_GHOSTS];

/* Changes input number K of the frame's plan. Returns false if there is no
 * input of this number. */
static bool change_plan_input(int k)
{
    struct glint_lamp *const l = lamps;

    switch (k) {
    case 0:
        l[1].theta_deg += 0.01;
        return true;
    case 1:
        l[1].phi_deg += 0.01;
        return true;
    case 2:
        l[2].power *= 1.01;
        return true;
    case 3:
        l[2].rgb[2] = 0.5;
        return true;
    case 4:
        l[0].axis[0] = l[0].axis[1] = 0.02;
        return true;
    case 5:
        tints[2].gain.exponent = -29;
        return true;
    case 6:
        tints[3].rgb_q14[1] = 1 << 13;
        return true;
    case 7:
        reusing.only_ghost = fresh.only_ghost = 4;
        return true;
    case 8:
        reusing.dials.snap_codes_q8 = fresh.dials.snap_codes_q8 = 300;
        return true;
    case 9:
        reusing.dials.cull_codes = fresh.dials.cull_codes = 0.3;
        return true;
    case 10:
        reusing.dials.fineness = fresh.dials.fineness = 24;
        return true;
    case 11:
        reusing.dials.dim_codes = fresh.dials.dim_codes = 1;
        return true;
    case 12:
        reusing.picture.uniform = fresh.picture.uniform = true;
        return true;
    case 13:
        reusing.tints = fresh.tints = NULL;
        return true;
    default:
        return false;
    }
}

TEST(any_change_prevents_reuse)
{
    const int things = 14;

    open_both_frames(0);
    for (int i = 0; i < GLINT_MAX_GHOSTS; i++)
        tints[i] =
            (struct glint_tint){{1 << 14, 1 << 14, 1 << 14}, {1 << 30, -30}};
    reusing.tints = fresh.tints = tints;
    draw_with_and_without_reuse(3);
    for (int k = 0; k < things; k++) {
        assert_true(draw_with_and_without_reuse(3));
        assert_true(change_plan_input(k));
        assert_false(draw_with_and_without_reuse(3));
    }
    assert_false(change_plan_input(things));
    assert_true(draw_with_and_without_reuse(3));
    close_both_frames();
}

/* Draws only some ray bundles of a frame. Checks that the next frame draws
 * all. */
TEST(restricted_frame_does_not_restrict_the_next)
{
    open_both_frames(0);
    draw_with_and_without_reuse(3);
    assert_true(draw_with_and_without_reuse(3));
    glint_flare_keep(reusing.memory.flare, -1, 1, -1);
    assert_false(draw_with_and_without_reuse(3));
    assert_true(draw_with_and_without_reuse(3));
    close_both_frames();
}

/* Checks two cases without reuse: a frame in reserved memory with more lights
 * than can be remembered, and a linear image after one of pixel codes. */
TEST(frame_with_too_many_lights_is_drawn_again)
{
    static int32_t linear[2][3 * W * H];
    struct glint_image image = {
        .format = GLINT_LINEAR_Q20, .width = W, .height = H};

    open_both_frames(0);
    reusing.cfg.reuse_lights = 2;
    assert_ok(
        glint_frame_reserve_memory(&reusing, NULL, 8 << 20, LIGHTS, LIGHTS));
    draw_with_and_without_reuse(4);
    assert_true(draw_with_and_without_reuse(4));
    reusing.cfg.reuse_lights = 3;
    glint_frame_apply_config(&reusing);
    draw_with_and_without_reuse(4);
    assert_false(draw_with_and_without_reuse(4));
    draw_with_and_without_reuse(3);
    assert_true(draw_with_and_without_reuse(3));
    for (int i = 0; i < 2; i++) {
        glint_image_place(&image, linear[i]);
        assert_ok(glint_frame_draw(i ? &fresh : &reusing, lamps, 3, 1, &image,
                                   &of_reusing));
        assert_int_equal(of_reusing.stats.reused, 0);
    }
    assert_memory_equal(linear[0], linear[1], sizeof linear[0]);
    assert_false(draw_with_and_without_reuse(3));
    close_both_frames();
}

/* -------------------------------------------------------- stationary lamps */

static double sum_image_codes(const uint8_t *codes)
{
    double sum = 0;

    for (int i = 0; i < BYTES; i++)
        sum += codes[i] - 20;
    return sum;
}

/* Draws N stationary lamps with the frame that reuses edges, and the same
 * lights and factors with a frame that builds its edges again. Checks that both
 * images are equal. Returns whether the reusing frame reused edges. */
static bool draw_stationary_lamps(int n, double scale)
{
    draw_lamps_with_frame(&reusing, n, scale, got, &of_reusing);
    glint_frame_apply_config(&fresh);
    draw_lamps_with_frame(&fresh, n, scale, want, &of_fresh);
    assert_int_equal(of_fresh.stats.reused, 0);
    assert_memory_equal(got, want, BYTES);
    return of_reusing.stats.reused;
}

/* Checks that noise in the position, power, colour and order of lamps causes no
 * ray to be traced, and that changed powers and colours are applied. */
TEST(noise_of_lamps_traces_no_rays)
{
    const double degree = 0.02; /* 0.02 degrees are 0.1 pixel */
    uint64_t noise = 1;

    open_both_frames(0.5);
    fresh.cfg.reuse = &glint_reuse;
    fresh.dials = reusing.dials;
    draw_stationary_lamps(LIGHTS, 1);
    for (int i = 0; i < 24; i++) {
        const struct glint_lamp first = lamps[0];
        struct glint_lamp was[LIGHTS];

        for (int k = 0; k < LIGHTS - 1; k++)
            lamps[k] = lamps[k + 1];
        lamps[LIGHTS - 1] = first;
        memcpy(was, lamps, sizeof was);
        for (int k = 0; k < LIGHTS; k++) {
            lamps[k].theta_deg += stage_random_uniform(&noise, -degree, degree);
            lamps[k].power *=
                stage_random_uniform(&noise, i % 8 ? 0.8 : 0, 1.2);
            lamps[k].rgb[i % 3] *= stage_random_uniform(&noise, 0.9, 1.1);
        }
        assert_true(draw_stationary_lamps(LIGHTS, i % 2 ? 0.9 : 1.1));
        memcpy(lamps, was, sizeof was);
    }
    fresh.dials.still_px = 0;
    for (double scale = 0.25; scale < 1.65; scale += 0.1) {
        draw_lamps_with_frame(&reusing, LIGHTS, scale, got, &of_reusing);
        draw_lamps_with_frame(&fresh, LIGHTS, scale, want, &of_fresh);
        assert_int_equal(of_reusing.stats.reused, scale < 1.5);
        assert_true(fabs(sum_image_codes(got) / sum_image_codes(want) - 1) <
                    0.005);
        assert_true(stage_max_block_difference(&stage, got, want) < 1.5);
    }
    close_both_frames();
}

/* Returns the distance, pixels, from LAMP to the nearest light whose rays are
 * reused. */
static double measure_distance_to_reused_light_px(const struct glint_lamp *lamp)
{
    const double degree = GLINT_PI / 180;
    const double pixels =
        fabs(stage.of_model.optics.focal_mm) * W / stage.view.sensor_width_mm;
    const double r = sin(lamp->theta_deg * degree);
    double least = HUGE_VAL;

    for (int i = 0; i < reusing.still.n; i++) {
        const struct glint_light *b = &reusing.still.light[i];
        const double sine = b->sine_q30 * 0x1p-30;
        const double x =
            r * cos(lamp->phi_deg * degree) - sine * b->cos_q30 * 0x1p-30;
        const double y =
            r * sin(lamp->phi_deg * degree) - sine * b->sin_q30 * 0x1p-30;

        least = fmin(least, pixels * hypot(x, y));
    }
    return least;
}

/* Checks that a slowly moving lamp is traced again before the tolerance
 * displaces it, that a new lamp is traced, and that no ray is traced when a
 * lamp disappears. */
TEST(moving_lamp_is_traced_before_the_tolerance)
{
    int n_reused = 0;

    open_both_frames(0.5);
    fresh.cfg.reuse = &glint_reuse;
    fresh.dials = reusing.dials;
    draw_stationary_lamps(LIGHTS - 1, 1);
    for (int i = 0; i < 60; i++) {
        lamps[2].theta_deg += 0.005;
        n_reused += draw_stationary_lamps(LIGHTS - 1, 1);
        assert_true(measure_distance_to_reused_light_px(&lamps[2]) <= 0.5);
    }
    assert_true(n_reused > 48 && n_reused < 59);
    assert_false(draw_stationary_lamps(LIGHTS, 1));
    assert_true(draw_stationary_lamps(LIGHTS - 2, 1));
    assert_true(draw_stationary_lamps(LIGHTS, 1));
    /* a limit of lights below the number of reused lights */
    reusing.dials.max_lights = fresh.dials.max_lights = 2;
    assert_false(draw_stationary_lamps(2, 1));
    assert_int_equal(reusing.lights.n, 2);
    close_both_frames();
}

/* Checks that a frame in reserved memory reuses the rays of lights only if they
 * fit into the memory. */
TEST(reserved_memory_limits_reuse)
{
    for (int i = 0; i < 2; i++) {
        open_both_frames(i ? 0.5 : 0);
        assert_ok(glint_frame_reserve_memory(&reusing, NULL, 8 << 20, LIGHTS,
                                             LIGHTS));
        reusing.dials.still_px = 0.5;
        draw_lamps_with_frame(&reusing, LIGHTS, 1, got, &of_reusing);
        assert_int_equal(reusing.still.n, i ? LIGHTS : 0);
        draw_lamps_with_frame(&reusing, LIGHTS, 1.1, got, &of_reusing);
        assert_int_equal(of_reusing.stats.reused, i);
        close_both_frames();
    }
}

static struct glint_light make_light_of_lamp(double theta_deg, double power,
                                             const double rgb[3])
{
    const double degree = GLINT_PI / 180;
    struct glint_light b = {
        .sine_q30 = (int32_t)lrint(sin(theta_deg * degree) * 0x1p30),
        .cosine_q30 = (int32_t)lrint(cos(theta_deg * degree) * 0x1p30),
        .cos_q30 = 1 << 30,
        .power = glint_real_of(power)};

    for (int c = 0; c < 3; c++)
        b.rgb_q14[c] = (int32_t)lrint(rgb[c] * 16384);
    return b;
}

/* Checks brightness factors of reused lights against factors computed by hand.
 * Distances are chords: 1 degree is 0.01745. */
TEST(reuse_factors_match_hand_computation)
{
    static const double red[3] = {1, 0.5, 0}, other[3] = {1, 0.25, 0.01},
                        blue[3] = {1, 0.5, 0.1}, dark[3] = {0.5, 0.25, 0};
    const int32_t near_q30 = (int32_t)(0.00175 * 0x1p30); /* 0.1 degrees */
    struct glint_light light[3], at[2];
    int32_t gain_q14[2][3];
    int64_t sum_q20[2][3];
    struct glint_still s = {2, 0, at, gain_q14, sum_q20};

    light[0] = make_light_of_lamp(5, 1000, red);
    light[1] = make_light_of_lamp(8, 3, red);
    assert_int_equal(glint_lights_still(&s, light, 2, near_q30), 2);
    assert_int_equal(gain_q14[1][0], 1 << 14);
    /* The second light was switched off, the first is now two lights of half
     * the power. */
    light[0] = make_light_of_lamp(5.09, 600, dark);
    light[1] = make_light_of_lamp(4.91, 600, dark);
    assert_int_equal(glint_lights_still(&s, light, 2, near_q30), 2);
    assert_in_range(gain_q14[0][0], 9830, 9831);
    assert_in_range(gain_q14[0][1], 9830, 9831);
    assert_int_equal(gain_q14[0][2], 1 << 14);
    assert_int_equal(gain_q14[1][0] | gain_q14[1][1], 0);
    assert_int_equal(at[0].power.mantissa, glint_real_of(1000).mantissa);
    /* another colour, brighter */
    light[0] = make_light_of_lamp(5, 1400, other);
    assert_int_equal(glint_lights_still(&s, light, 1, near_q30), 2);
    assert_in_range(gain_q14[0][0], 22937, 22938);
    assert_in_range(gain_q14[0][1], 11468, 11469);
    /* These are traced again: a light with added blue, a light that is too
     * bright, and one too far away. */
    light[0] = make_light_of_lamp(5, 1000, blue);
    assert_int_equal(glint_lights_still(&s, light, 1, near_q30), 1);
    light[0] = make_light_of_lamp(5, 1530, blue);
    light[1] = make_light_of_lamp(9, 1, blue);
    assert_int_equal(glint_lights_still(&s, light, 1, near_q30), 1);
    assert_int_equal(gain_q14[0][0], 1 << 14);
    light[0] = make_light_of_lamp(5.11, 1530, blue);
    assert_int_equal(glint_lights_still(&s, light, 1, near_q30), 1);
    assert_int_equal(at[0].sine_q30, light[0].sine_q30);
    light[0].apart_q30 = 2 * near_q30;
    assert_int_equal(glint_lights_still(&s, light, 1, near_q30), 1);
    assert_int_equal(at[0].apart_q30, 2 * near_q30);
    /* of two lights within the tolerance, the nearer is reused */
    light[0] = make_light_of_lamp(5, 10, red);
    light[1] = make_light_of_lamp(5.05, 10, red);
    assert_int_equal(glint_lights_still(&s, light, 2, near_q30), 2);
    light[0] = make_light_of_lamp(5.01, 5, red);
    light[1] = make_light_of_lamp(5.04, 8, red);
    assert_int_equal(glint_lights_still(&s, light, 2, near_q30), 2);
    assert_in_range(gain_q14[0][0], 8191, 8193);
    assert_in_range(gain_q14[1][0], 13106, 13108);
    /* Three lights exceed the limit. After that, a frame without lights reuses
     * none, either. */
    light[2] = make_light_of_lamp(1, 1, red);
    assert_int_equal(glint_lights_still(&s, light, 3, near_q30), 0);
    assert_int_equal(glint_lights_still(&s, light, 0, near_q30), 0);
}
