/* SPDX-License-Identifier: MIT
 *
 * Checks the starbursts of a frame: the estimated power and extent of each
 * lamp, the number of stars drawn, and their use of memory and time.
 */
#include "support/settings_frame.h"
#include "support/night.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 120 }; /* diagonal 200 pixels */

static struct tool tool = {.name = "test", .quiet = true, .n_threads = 1};
static struct opened opened;
static struct glint_frame frame;
static uint8_t rgb[3 * WIDTH * HEIGHT];
static struct glint_image image = {.format = GLINT_RGB24,
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .range = GLINT_RANGE_FULL};

TEST_OPEN
{
    settings_set_defaults(&opened.settings);
    opened.settings.coating.kind = COATING_TABLE;
    opened.settings.options.starburst = 1;
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
    assert_ok(make_frame_from_settings(&tool, &opened, WIDTH, HEIGHT, &frame));
    glint_image_place(&image, rgb);
}

TEST_CLOSE
{
    glint_frame_finish(&frame);
    opened_lens_close(&opened.lens);
}

/* Returns the power, in the brightest channel, of the starburst of a lamp of
 * power POWER at the fade level LEVEL, 0 .. 1. SEEN_PX: RMS radius of the
 * lamp's clipped core in the image, pixels; 0: not clipped. */
static double star_power_at_fade(double power, double seen_px, double level)
{
    const struct glint_lamp lamp = {5, 30, power, {1, .5, 0}, {0, 0}, 0};

    struct glint_engine_lamp known = glint_engine_lamp_of(&lamp, 1);

    known.seen_px = seen_px;
    known.level = level;
    frame.known = &known;
    assert_ok(glint_frame_star_set_lamps(&frame, &lamp, 1, 1, &image));
    frame.known = NULL;
    return glint_real_value(frame.star.light[0].power);
}

/* Checks that the core table, which costs a third of the time for all tables of
 * this stop, is made for the first lamp that the image does not show, and then
 * kept, also with another stop. Must be the first test. */
TEST(hidden_lamps_need_a_core_table)
{
    const struct glint_star_tables *tables;

    star_power_at_fade(1000, 2, 1);
    assert_true(frame.star.tables->core_per_pixel_q16 == 0);
    star_power_at_fade(1000, -1, 1);
    assert_true(frame.star.tables->core_per_pixel_q16 > 0);
    tables = frame.star.tables;
    star_power_at_fade(1000, 2, 1);
    assert_true(frame.star.tables == tables);
    opened.lens.setup.blade_rotation_deg += 5;
    star_power_at_fade(1000, 2, 1);
    assert_true(frame.star.tables->core_per_pixel_q16 > 0);
    opened.lens.setup.blade_rotation_deg -= 5;
}

static bool is_relatively_near(double a, double b)
{
    return fabs(a / b - 1) < 1e-3;
}

/* A star of power W is white out to cbrt(W a) / pi pixels, where a is the
 * wavelength times the f-number, pixels. Returns half of the power at which a
 * point lamp's star is white out to the edge of a core of RMS radius
 * SEEN_PX. */
static double compute_half_power_of_white_star(double seen_px)
{
    const double airy_px = 0.55e-3 * 22 / hypot(36, 24) * 200;

    return pow(GLINT_PI * sqrt(2) * seen_px, 3) / airy_px / 2;
}

TEST(clipped_lamps_get_more_star_power)
{
    /* the star of a lamp that is not clipped has the lamp's power */
    assert_true(is_relatively_near(star_power_at_fade(1000, 0, 1), 1000));
    /* The star of a clipped lamp gets more power: at most 32 times, and at most
     * so much that the star is white out to the edge of the visible core. */
    assert_true(is_relatively_near(star_power_at_fade(1000, 50, 1), 32000));
    assert_true(is_relatively_near(star_power_at_fade(1000, 2, 1),
                                   compute_half_power_of_white_star(2)));
    assert_true(is_relatively_near(star_power_at_fade(1000, 0.5, 1), 1000));
    /* the star of a fading lamp fades with the lamp */
    assert_true(is_relatively_near(star_power_at_fade(500, 2, 0.5),
                                   0.5 * compute_half_power_of_white_star(2)));
}

static double compute_star_radius_px(double power, double seen_px)
{
    star_power_at_fade(power, seen_px, 1);
    return frame.star.light[0].radius_q8 / 256.0;
}

/* Returns the max radius, pixels, that a lamp in a still image can have without
 * showing behind its clipped rim of SEEN_PX pixels. */
static double compute_max_hidden_lamp_radius(double seen_px)
{
    return floor(256 * seen_px / 6) * 2 / 256;
}

/* Checks the drawn radius of lamps. A lamp whose core is no wider than its own
 * star gets the largest radius that its clipped rim can hide, as in a still
 * image; a lamp that fills its core is a disc. */
TEST(narrow_core_gets_the_radius_its_rim_can_hide)
{
    assert_true(compute_star_radius_px(100, 0) == 0);
    assert_true(compute_star_radius_px(1e7, 2) ==
                compute_max_hidden_lamp_radius(2));
    assert_true(compute_star_radius_px(1e9, 6) < 0.6 * sqrt(2) * 6);
    assert_true(compute_star_radius_px(10, 6) > 0.8 * sqrt(2) * 6);
    /* The lamp has no glare. The pixels that its own star makes white do not
     * count as a part of its core. */
    assert_true(compute_star_radius_px(GLINT_PI * 2 * 6 * 6, 6) <
                0.95 * sqrt(2) * 6);
}

/* Checks that a spot widened by the glare of a lamp far above white has the
 * spikes of a small lamp, and a spot barely above white those of a disc, with a
 * continuous transition. The star of a fading lamp must keep its extent. */
TEST(glare_of_a_small_lamp_does_not_widen_spikes)
{
    const double white = GLINT_PI * 2 * 50 * 50;
    double before = 1e9;

    assert_true(compute_star_radius_px(0.9 * white, 50) > 0.6 * sqrt(2) * 50);
    assert_true(compute_star_radius_px(6 * white, 50) ==
                compute_max_hidden_lamp_radius(50));
    for (double over = 0.5; over < 6; over += 0.1) {
        const double radius = compute_star_radius_px(over * white, 50);

        assert_true(radius <= before);
        assert_true(over == 0.5 || before - radius < 4);
        before = radius;
    }
    before = compute_star_radius_px(3 * white, 50);
    star_power_at_fade(1.5 * white, 50, 0.5);
    assert_true(fabs(frame.star.light[0].radius_q8 / 256.0 - before) < 0.01);
}

/* Checks that if there are more lamps than stars may be drawn, the brightest
 * lamps get stars, in descending order. They are passed in ascending order. */
TEST(brightest_lamps_get_stars)
{
    enum { N = GLINT_STAR_MAX_LIGHTS + 100 };
    static struct glint_lamp lamps[N];

    for (int i = 0; i < N; i++)
        lamps[i] =
            (struct glint_lamp){5, i * 0.05, i + 1, {1, 1, 1}, {0, 0}, 0};
    assert_ok(glint_frame_star_set_lamps(&frame, lamps, N, 1, &image));
    assert_true(
        is_relatively_near(glint_real_value(frame.star.light[0].power), N));
    assert_true(is_relatively_near(
        glint_real_value(frame.star.light[GLINT_STAR_MAX_LIGHTS - 1].power),
        101));
}

TEST(reserved_memory_prevents_allocations)
{
    const struct glint_star *star;
    const struct glint_star_tables *tables;
    size_t bytes;

    assert_ok(glint_frame_star_allocate(&frame, 5000));
    star = frame.star.star;
    tables = frame.star.tables;
    bytes = glint_frame_star_count_bytes(&frame);
    star_power_at_fade(1000, 0, 1);
    assert_ptr_equal(star, frame.star.star);
    assert_int_equal(bytes, glint_frame_star_count_bytes(&frame));
    /* the star tables, and the lamps twice: as given and as drawn */
    assert_true(bytes > 40000 + GLINT_STAR_MAX_LIGHTS * 160);
    assert_true(bytes < (1 << 20) + GLINT_STAR_MAX_LIGHTS * 400);
    assert_ptr_equal(tables, frame.star.tables);
}

/* Checks that drawing stars takes at most a quarter of the budget, whatever
 * their number and brightness. */
TEST(stars_cost_at_most_a_quarter_of_the_budget)
{
    const struct glint_budget none = frame.budget;
    double pixels;

    star_power_at_fade(1e7, 0, 1);
    pixels = frame.star.pixels;
    frame.budget.ms_per_minsn = 0.1;
    frame.budget.ms = 1;
    star_power_at_fade(1e7, 0, 1);
    print_message("%.0f pixels, %.0f within 1 ms\n", pixels, frame.star.pixels);
    assert_true(frame.star.pixels > 1000);
    assert_true(frame.star.pixels < 0.5 * pixels);
    assert_true(frame.star.pixels * 0.32e-3 * 0.1 <= 0.25);
    frame.budget.ms = 1e-6;
    star_power_at_fade(1e7, 0, 1);
    assert_true(frame.star.pixels == 0);
    frame.budget = none;
}

/* Checks that camera noise does not make stars flicker: for lamps of three
 * sizes and noise of 2 and 4 codes, a star changes by at most 2 % per frame and
 * 7 % in four seconds. Noise of 8 codes hides the rim of the smallest lamp;
 * then the limits are 6 % and 25 %, as a star's power grows with the cube of
 * the lamp's extent. */
TEST(camera_noise_does_not_make_stars_flicker)
{
    enum { FRAMES = 100, SETTLED = 25 };
    static const double radius[] = {2, 3, 6};

    for (int k = 0; k < 9; k++) {
        const struct night_lamp lamp = {80.3, 60.6, radius[k % 3], 6};
        struct night night;
        double last = 0, least = HUGE_VAL, most = 0, step = 0;

        night_init_parameters(&night, WIDTH, HEIGHT);
        night.sigma = 2 << k / 3;
        assert_true(night_open_tracker(&night));
        for (int i = 0; i < FRAMES; i++) {
            const struct glint_lamp_track *t = &night.track[0];
            double power;

            night_draw_and_track(&night, &lamp, 1, 40000);
            if (i < SETTLED)
                continue;
            assert_int_equal(night.n_tracks, 1);
            power =
                star_power_at_fade((double)t->power_q16 / 65536,
                                   t->size_q8 / 256.0, t->level_q15 / 32768.0);
            step = last > 0 ? fmax(step, fabs(log(power / last))) : step;
            least = fmin(least, power);
            most = fmax(most, power);
            last = power;
        }
        print_message(
            "%g px in noise of %g codes: steps of %.2f %%, %.2f %% in all\n",
            radius[k % 3], night.sigma, 100 * step, 100 * (most / least - 1));
        assert_true(k < 6 ? step < 0.02 && most < 1.07 * least
                          : step < 0.06 && most < 1.25 * least);
        night_close_tracker(&night);
    }
}

TEST(higher_cull_codes_cover_fewer_pixels)
{
    const double cull = frame.dials.cull_codes;
    double last = HUGE_VAL;

    for (frame.dials.cull_codes = 1 / 32.; frame.dials.cull_codes < 16;
         frame.dials.cull_codes *= 8) {
        star_power_at_fade(1e4, 0, 1);
        print_message("%g codes: %.0f pixels\n", frame.dials.cull_codes,
                      frame.star.pixels);
        assert_true(frame.star.pixels > 0 && frame.star.pixels < 0.9 * last);
        last = frame.star.pixels;
    }
    frame.dials.cull_codes = cull;
}
