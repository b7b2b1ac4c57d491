/* SPDX-License-Identifier: MIT
 *
 * The starburst of a frame: power and extent that its lamps are taken to have,
 * how many are drawn, and limits of memory and time.
 */
#include <stdint.h>

#include <math.h>
#include <string.h>

#include "engine/frame/frame.h"
#include "support/settings_frame.h"
#include "options/tool.h"
#include "support/night.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 120 }; /* 200 pixels of diagonal */

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
    settings_defaults(&opened.settings);
    opened.settings.options.starburst = 1;
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
    assert_ok(settings_frame(&tool, &opened, WIDTH, HEIGHT, &frame));
    glint_image_place(&image, rgb);
}

TEST_CLOSE
{
    glint_frame_finish(&frame);
    opened_lens_close(&opened.lens);
}

/* Returns the power, in the brightest channel, of the star of a lamp of POWER
 * at LEVEL. SEEN_PX is the RMS radius with which the picture shows the lamp
 * clipped; 0: it is not clipped. */
static double power_of(double power, double seen_px, double level)
{
    const struct glint_lamp lamp = {5, 30, power, {1, .5, 0}, {0, 0}, 0};

    struct glint_engine_lamp known = glint_engine_lamp_of(&lamp, 1);

    known.seen_px = seen_px;
    known.level = level;
    frame.known = &known;
    assert_ok(glint_frame_star_set(&frame, &lamp, 1, 1, &image));
    frame.known = NULL;
    return glint_real_value(frame.star.light[0].power);
}

static bool is_near(double a, double b)
{
    return fabs(a / b - 1) < 1e-3;
}

/* Returns half of the power at which the star of a point is white as far out as
 * SEEN_PX says: a power W is white out to cbrt(W a) / pi pixels, where a is
 * wavelength times f-number in pixels. */
static double white_of(double seen_px)
{
    const double airy_px = 0.55e-3 * 22 / hypot(36, 24) * 200;

    return pow(GLINT_PI * sqrt(2) * seen_px, 3) / airy_px / 2;
}

TEST(power)
{
    /* The power of a lamp that does not clip must stay. */
    assert_true(is_near(power_of(1000, 0, 1), 1000));
    /* A lamp that clips must get more power, 32 times at most, and no more than
     * makes its star as wide as is seen. */
    assert_true(is_near(power_of(1000, 50, 1), 32000));
    assert_true(is_near(power_of(1000, 2, 1), white_of(2)));
    assert_true(is_near(power_of(1000, 0.5, 1), 1000));
    /* The star of a lamp that fades must fade, too. */
    assert_true(is_near(power_of(500, 2, 0.5), 0.5 * white_of(2)));
}

static double radius_of(double power, double seen_px)
{
    power_of(power, seen_px, 1);
    return frame.star.light[0].radius_q8 / 256.0;
}

/* Radius of the widest lamp that a rim of SEEN_PX may hide, as stills have it.
 */
static double hidden_of(double seen_px)
{
    return floor(256 * seen_px / 6) * 2 / 256;
}

/* A lamp that the picture shows no wider than its own star must be as wide as
 * its rim may hide, like that of a still; one that fills what is seen must be a
 * disc. */
TEST(extent)
{
    assert_true(radius_of(100, 0) == 0);
    assert_true(radius_of(1e7, 2) == hidden_of(2));
    assert_true(radius_of(1e9, 6) < 0.6 * sqrt(2) * 6);
    assert_true(radius_of(10, 6) > 0.8 * sqrt(2) * 6);
    /* Of a spot without glare the part that its star would make white must not
     * count. */
    assert_true(radius_of(GLINT_PI * 2 * 6 * 6, 6) < 0.95 * sqrt(2) * 6);
}

/* A spot that is wide by the glare of a lamp far over white must throw spikes
 * as a small lamp does, one that is hardly over white those of a disc, and all
 * between must have no step. A fading lamp must keep its extent. */
TEST(glare)
{
    const double white = GLINT_PI * 2 * 50 * 50;
    double before = 1e9;

    assert_true(radius_of(0.9 * white, 50) > 0.6 * sqrt(2) * 50);
    assert_true(radius_of(6 * white, 50) == hidden_of(50));
    for (double over = 0.5; over < 6; over += 0.1) {
        const double radius = radius_of(over * white, 50);

        assert_true(radius <= before);
        assert_true(over == 0.5 || before - radius < 4);
        before = radius;
    }
    before = radius_of(3 * white, 50);
    power_of(1.5 * white, 50, 0.5);
    assert_true(fabs(frame.star.light[0].radius_q8 / 256.0 - before) < 0.01);
}

/* Of too many lamps the brightest must be drawn, the brightest first, whatever
 * order they have. */
TEST(most)
{
    enum { N = GLINT_STAR_MAX_LIGHTS + 100 };
    static struct glint_lamp lamps[N];

    for (int i = 0; i < N; i++)
        lamps[i] =
            (struct glint_lamp){5, i * 0.05, i + 1, {1, 1, 1}, {0, 0}, 0};
    assert_ok(glint_frame_star_set(&frame, lamps, N, 1, &image));
    assert_true(is_near(glint_real_value(frame.star.light[0].power), N));
    assert_true(is_near(
        glint_real_value(frame.star.light[GLINT_STAR_MAX_LIGHTS - 1].power),
        101));
}

/* After room was taken for many lamps, a frame must take no more memory. */
TEST(hold)
{
    const struct glint_star *star;
    const struct glint_star_tables *tables;
    size_t bytes;

    assert_ok(glint_frame_star_hold(&frame, 5000));
    star = frame.star.star;
    tables = frame.star.tables;
    bytes = glint_frame_star_bytes(&frame);
    power_of(1000, 0, 1);
    assert_ptr_equal(star, frame.star.star);
    assert_int_equal(bytes, glint_frame_star_bytes(&frame));
    /* Tables and lamps, the latter twice: as they are given and as they are
     * drawn. */
    assert_true(bytes > 40000 + GLINT_STAR_MAX_LIGHTS * 160);
    assert_true(bytes < (1 << 20) + GLINT_STAR_MAX_LIGHTS * 400);
    assert_ptr_equal(tables, frame.star.tables);
}

/* With a budget stars must keep to a quarter of it, however many and bright
 * they are. */
TEST(budget)
{
    const struct glint_budget none = frame.budget;
    double pixels;

    power_of(1e7, 0, 1);
    pixels = frame.star.pixels;
    frame.budget.ms_per_minsn = 0.1;
    frame.budget.ms = 1;
    power_of(1e7, 0, 1);
    print_message("%.0f pixels, %.0f within 1 ms\n", pixels, frame.star.pixels);
    assert_true(frame.star.pixels > 1000);
    assert_true(frame.star.pixels < 0.5 * pixels);
    assert_true(frame.star.pixels * 0.32e-3 * 0.1 <= 0.25);
    frame.budget.ms = 1e-6;
    power_of(1e7, 0, 1);
    assert_true(frame.star.pixels == 0);
    frame.budget = none;
}

/* Noise of the camera must not show as flicker of stars: of lamps of three
 * sizes, in noise of 2 and 4 codes, the star may change by 2 % from frame to
 * frame once the lamp is there, and by 7 % in four seconds. In noise of 8
 * codes, which hides the rim of the smallest, that is 6 % and 25 %: a star's
 * power goes with the cube of the extent. */
TEST(noise)
{
    enum { FRAMES = 100, SETTLED = 25 };
    static const double radius[] = {2, 3, 6};

    for (int k = 0; k < 9; k++) {
        const struct night_lamp lamp = {80.3, 60.6, radius[k % 3], 6};
        struct night night;
        double last = 0, least = HUGE_VAL, most = 0, step = 0;

        night_init(&night, WIDTH, HEIGHT);
        night.sigma = 2 << k / 3;
        assert_true(night_open(&night));
        for (int i = 0; i < FRAMES; i++) {
            const struct glint_lamp_track *t = &night.track[0];
            double power;

            night_step(&night, &lamp, 1, 40000);
            if (i < SETTLED)
                continue;
            assert_int_equal(night.n_tracks, 1);
            power = power_of((double)t->power_q16 / 65536, t->size_q8 / 256.0,
                             t->level_q15 / 32768.0);
            step = last > 0 ? fmax(step, fabs(log(power / last))) : step;
            least = fmin(least, power);
            most = fmax(most, power);
            last = power;
        }
        print_message("%g px in noise of %g codes: steps of %.2f %%, %.2f %% "
                      "in all\n",
                      radius[k % 3], night.sigma, 100 * step,
                      100 * (most / least - 1));
        assert_true(k < 6 ? step < 0.02 && most < 1.07 * least
                          : step < 0.06 && most < 1.25 * least);
        night_close(&night);
    }
}

/* The more is left out of stars, the fewer pixels they must take. */
TEST(cull)
{
    const double cull = frame.dials.star_cull;
    double last = HUGE_VAL;

    for (frame.dials.star_cull = 0.5; frame.dials.star_cull < 300;
         frame.dials.star_cull *= 8) {
        power_of(1e4, 0, 1);
        print_message("%g times: %.0f pixels\n", frame.dials.star_cull,
                      frame.star.pixels);
        assert_true(frame.star.pixels > 0 && frame.star.pixels < 0.9 * last);
        last = frame.star.pixels;
    }
    frame.dials.star_cull = cull;
}
