/* SPDX-License-Identifier: MIT
 *
 * Checks the power, colour and extent of lamps clipped to white, which are
 * estimated from the light profile around them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log2.h"
#include "glint/glint.h"
#include "support/power_picture.h"
#include "support/rng.h"
#include "support/test.h"

enum { W = 160, H = 120, MAX_SPOTS = 64 };

static struct glint_spot spot[MAX_SPOTS];
static double light[W * H], rgb[3 * W * H];
static uint8_t codes[3 * W * H];
static uint32_t seed = 1;

/* ------------------------------ power, profile and colour of drawn lamps */

/* Returns a lamp of SHAPE in the centre of the image; all other parameters have
 * typical values. */
static struct power_lamp make_default_lamp(enum power_shape shape,
                                           double radius)
{
    return (struct power_lamp){.shape = shape,
                               .x = W / 2 + 0.3,
                               .y = H / 2 - 0.2,
                               .radius = radius,
                               .sigma = 0.8,
                               .glare = 0.03,
                               .reach = 2,
                               .fall = 2.8,
                               .rgb = {1, 1, 1}};
}

static void measure_spot_profiles(const struct glint_image *image, int n)
{
    const size_t bytes = glint_profile_bytes();
    struct glint_profile *profile;
    void *mem;

    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    memset(mem, 0xa5, bytes);
    assert_ok(glint_profile_init(&profile, mem, bytes));
    glint_profile_measure(profile, image, spot, n);
    free(mem);
}

/* Finds and measures all bright spots of IMAGE. Returns their number. */
static int find_and_measure_spots(const struct glint_image *image)
{
    struct glint_lamp_finder_config cfg;
    struct glint_lamp_finder *finder;
    size_t bytes;
    void *mem;
    int n;

    glint_lamp_finder_defaults(&cfg, image->width, image->height);
    cfg.judge = 0;
    cfg.threshold_high_q8 = -256;
    cfg.threshold_low_q8 = -512;
    cfg.min_area = 1;
    cfg.max_share_q15 = 1 << 15;
    cfg.white_code = 255;
    bytes = glint_lamp_finder_bytes(&cfg);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_ok(glint_lamp_finder_init(&finder, &cfg, mem, bytes));
    n = glint_lamp_finder_find(finder, image, spot, MAX_SPOTS);
    free(mem);
    measure_spot_profiles(image, n);
    return n;
}

static struct glint_image make_grey_image(uint8_t *px, int width, int height)
{
    return glint_image_over(px, GLINT_RGB24, width, height);
}

/* Draws LAMP with POWER into light[], over a background of BLACK and with noise
 * of SIGMA codes. Returns the number of bright spots found. */
static int draw_and_find_spots(const struct power_lamp *lamp, double power,
                               double black, double sigma)
{
    const struct power_picture settings = {W, H, rgb};
    const struct glint_image image = make_grey_image(codes, W, H);

    for (int i = 0; i < 3 * W * H; i++)
        rgb[i] = black + power * lamp->rgb[i % 3] * light[i / 3];
    power_expose_codes(codes, &settings, 1, sigma, &seed);
    return find_and_measure_spots(&image);
}

static double compute_spot_power(void)
{
    return (double)spot[0].power_q16 / 65536;
}

/* ------------------------------------------------------------------- tests */

TEST(logarithms_match_known_values)
{
    assert_int_equal(q_log2_q16(1), 0);
    assert_int_equal(q_log2_q16(1024), 10 << 16);
    assert_int_equal(q_exp2_q16(0), 65536);
    assert_int_equal(q_exp2_q16(-(16 << 16)), 1);
    assert_int_equal(q_exp2_q16(20 << 16), INT64_C(1) << 36);
    for (int i = 1; i < 1 << 20; i += 7) {
        const double x = log2(i);

        assert_true(fabs(q_log2_q16((uint64_t)i) / 65536.0 - x) < 1.0 / 16384);
    }
    for (int32_t x = -(16 << 16); x < 40 << 16; x += 1013) {
        const double y = exp2(x / 65536.0) * 65536;

        assert_true(fabs((double)q_exp2_q16(x) - y) <= 1 + y / 32768);
    }
}

TEST(rejects_too_little_memory)
{
    const size_t bytes = glint_profile_bytes();
    struct glint_profile *profile;
    uint8_t *mem;

    assert_int_equal(posix_memalign((void **)&mem, 64, bytes + 64), 0);
    assert_int_equal(glint_profile_init(&profile, mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_int_equal(glint_profile_init(&profile, mem + 8, bytes),
                     GLINT_E_ARGUMENT);
    assert_ok(glint_profile_init(&profile, mem, bytes));
    free(mem);
}

/* Checks that the power of an unclipped lamp is its flux, for 13 and 45 white
 * pixels, blurred by Gaussians of 1.6 and 3 pixels. */
TEST(unclipped_power_is_the_flux)
{
    struct power_lamp lamp = make_default_lamp(POWER_DISC, 0.4);

    lamp.glare = 0;
    lamp.sigma = 1.6;
    power_draw_lamp(light, W, H, &lamp);
    assert_int_equal(draw_and_find_spots(&lamp, 13, 0, 0), 1);
    print_message("13 white pixels unclipped: %.2f\n", compute_spot_power());
    assert_true(compute_spot_power() > 0.85 * 13 &&
                compute_spot_power() < 1.1 * 13);
    lamp.sigma = 3;
    power_draw_lamp(light, W, H, &lamp);
    assert_int_equal(draw_and_find_spots(&lamp, 45, 0, 0), 1);
    print_message("45 white pixels unclipped: %.2f\n", compute_spot_power());
    assert_true(compute_spot_power() > 0.85 * 45 &&
                compute_spot_power() < 1.1 * 45);
}

/* Checks the RMS semi-axes of lamps. A tube 36 pixels long has 18 / sqrt(3)
 * along its length, here rotated clockwise by 30 degrees. A disc has half its
 * radius along both axes. */
TEST(extent_of_a_tube_is_its_axis)
{
    struct power_lamp lamp = make_default_lamp(POWER_TUBE, 18);

    lamp.glare = 0.002;
    lamp.angle = 3.14159265 / 6;
    power_draw_lamp(light, W, H, &lamp);
    assert_int_equal(draw_and_find_spots(&lamp, 2000, 0.002, 0), 1);
    assert_true(abs(spot[0].axis_q8[0] - 2660) < 200);
    assert_true(spot[0].axis_q8[1] < 550);
    assert_true(abs(spot[0].cos_q15 - 28378) < 300);
    assert_true(abs(spot[0].sin_q15 - 16384) < 500);
    lamp = make_default_lamp(POWER_DISC, 12);
    lamp.glare = 0;
    power_draw_lamp(light, W, H, &lamp);
    assert_int_equal(draw_and_find_spots(&lamp, 2000, 0.002, 0), 1);
    print_message("disc: axes %d and %d\n", spot[0].axis_q8[0],
                  spot[0].axis_q8[1]);
    assert_true(abs(spot[0].axis_q8[0] - 6 * 256) < 200);
    assert_true(abs(spot[0].axis_q8[1] - 6 * 256) < 200);
}

/* Checks a lamp two pixels wide with the light of 16384 white pixels, whose
 * glare is clipped over some pixels: the extent does not include the clipped
 * glare. */
TEST(extent_excludes_glare)
{
    struct power_lamp lamp = make_default_lamp(POWER_DISC, 1);

    lamp.glare = 0.1;
    power_draw_lamp(light, W, H, &lamp);
    assert_int_equal(draw_and_find_spots(&lamp, 16384, 0.002, 0), 1);
    print_message("glare: axes %d of a core of %d pixels, size %d\n",
                  spot[0].axis_q8[0], spot[0].n_clipped, spot[0].size_q8);
    assert_true(spot[0].n_clipped > 20);
    assert_true(spot[0].axis_q8[0] < spot[0].size_q8 / 3);
}

/* Sets light[] to 4 inside RADIUS. At RADIUS, the light drops to RIM; from
 * there it falls with the distance r from the centre as 1 / r^FALL. */
static void draw_core_and_glare(double radius, double rim, double fall)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double r = hypot(x + 0.5 - W / 2.0, y + 0.5 - H / 2.0);

            light[y * W + x] = r < radius ? 4 : rim * pow(r / radius, -fall);
        }
}

/* Checks that a sodium lamp, whose core is clipped to yellow and white, gets
 * the colour of its unclipped fringe: 1.99, 0.79, 0.04 at luminance 1. */
TEST(clipped_lamp_gets_the_colour_of_its_fringe)
{
    struct power_lamp lamp = make_default_lamp(POWER_DISC, 3);

    lamp.rgb[0] = 1.99;
    lamp.rgb[1] = 0.79;
    lamp.rgb[2] = 0.04;
    power_draw_lamp(light, W, H, &lamp);
    for (double p = 50; p < 20000; p *= 4) {
        assert_int_equal(draw_and_find_spots(&lamp, p, 0.01, 1), 1);
        print_message("power %5.0f: %.2f %.2f %.2f, %.0f\n", p,
                      spot[0].rgb_q15[0] / 32768.0,
                      spot[0].rgb_q15[1] / 32768.0,
                      spot[0].rgb_q15[2] / 32768.0, compute_spot_power());
        assert_true(abs(spot[0].rgb_q15[0] - 65200) < 13000);
        assert_true(abs(spot[0].rgb_q15[1] - 25900) < 6000);
        assert_true(spot[0].rgb_q15[2] < 6000);
    }
}

/* Checks lamps of 2^4 .. 2^14 white pixels in several sizes and shapes: each
 * estimated power is right within a factor of 2^4.5, half of them within a
 * factor of 2. */
TEST(clipped_power_is_within_4_stops)
{
    int n = 0, n_near = 0;

    for (int shape = 0; shape < POWER_SHAPES; shape++)
        for (double radius = 1; radius < 12; radius *= 2) {
            const struct power_lamp lamp =
                make_default_lamp((enum power_shape)shape, radius);

            power_draw_lamp(light, W, H, &lamp);
            for (int ev = 4; ev <= 14; ev += 2) {
                double stops;

                if (draw_and_find_spots(&lamp, exp2(ev), 0.01, 1.5) != 1)
                    continue;
                stops = log2(compute_spot_power()) - ev;
                assert_true(fabs(stops) < 4.5);
                n_near += fabs(stops) < 1;
                n++;
            }
        }
    print_message("%d of %d lamps within a stop\n", n_near, n);
    assert_true(n > 40 && 2 * n_near > n);
}

/* Raises the exposure by 2^(1/32) per step, from no clipping to complete
 * clipping. Checks that no step raises the estimated power by 2^0.4 or lowers
 * it by 2^-0.1. */
TEST(power_rises_smoothly)
{
    for (int shape = 0; shape < POWER_SHAPES; shape++)
        for (int radius = 1; radius <= 9; radius += 4) {
            const struct power_lamp lamp =
                make_default_lamp((enum power_shape)shape, radius);
            double last = 0, most = 0, least = 1;

            power_draw_lamp(light, W, H, &lamp);
            for (double ev = 3 + radius / 3; ev < 12; ev += 1 / 32.0) {
                if (draw_and_find_spots(&lamp, exp2(ev), 0.01, 0) != 1)
                    continue;
                if (last > 0) {
                    most = fmax(most, log2(compute_spot_power() / last));
                    least = fmin(least, log2(compute_spot_power() / last));
                }
                last = compute_spot_power();
            }
            print_message("shape %d of %d: steps of %+.3f to %+.3f stops\n",
                          shape, radius, least, most);
            assert_true(most < 0.4 && least > -0.1);
        }
}

/* Moves a sun into the image over its left border by half a pixel per step.
 * Checks that no step raises its power by 0.1 of the total or lowers it by
 * 0.13. */
TEST(entering_sun_rises_smoothly)
{
    enum { OUT = 48, WIDE = W + OUT };
    struct power_lamp lamp = make_default_lamp(POWER_DISC, 6);
    static double wide[WIDE * H];
    const double full = 4000;
    double last = 0, most = 0, least = 0;

    for (double x = -20; x < 40; x += 0.5) {
        lamp.x = OUT + x;
        power_draw_lamp(wide, WIDE, H, &lamp);
        for (int i = 0; i < W * H; i++)
            light[i] = wide[i / W * WIDE + i % W + OUT];
        if (draw_and_find_spots(&lamp, full, 0.05, 0) < 1)
            continue;
        most = fmax(most, (compute_spot_power() - last) / full);
        least = fmin(least, (compute_spot_power() - last) / full);
        last = compute_spot_power();
    }
    print_message("entering: steps of %+.3f to %+.3f of it, then %.0f\n", least,
                  most, last);
    assert_true(most < 0.1 && least > -0.13);
}

/* Checks noise of 3 codes: the power varies by less than 10 % RMS, and its mean
 * by less than a factor of 2^0.5. */
TEST(noise_changes_power_little)
{
    const struct power_lamp lamp = make_default_lamp(POWER_DISC, 4);
    double sum = 0, sum2 = 0, still;
    const int n = 40;

    power_draw_lamp(light, W, H, &lamp);
    draw_and_find_spots(&lamp, 600, 0.03, 0);
    still = compute_spot_power();
    for (int i = 0; i < n; i++) {
        draw_and_find_spots(&lamp, 600, 0.03, 3);
        sum += compute_spot_power() / n;
        sum2 += compute_spot_power() * compute_spot_power() / n;
    }
    print_message("noise: %.0f becomes %.0f +- %.0f\n", still, sum,
                  sqrt(fmax(sum2 - sum * sum, 0)));
    assert_true(fabs(log2(sum / still)) < 0.5);
    assert_true(sum2 - sum * sum < 0.01 * sum * sum);
}

/* Checks that each of two adjacent lamps gets the power of a single one, not
 * twice as much. */
TEST(adjacent_lamps_have_single_powers)
{
    struct power_lamp lamp = make_default_lamp(POWER_DISC, 3);
    static double other[W * H];
    double alone;

    lamp.x = 60;
    power_draw_lamp(light, W, H, &lamp);
    draw_and_find_spots(&lamp, 500, 0.01, 0);
    alone = compute_spot_power();
    lamp.x = 100;
    power_draw_lamp(other, W, H, &lamp);
    for (int i = 0; i < W * H; i++)
        light[i] += other[i];
    assert_int_equal(draw_and_find_spots(&lamp, 500, 0.01, 0), 2);
    for (int i = 0; i < 2; i++)
        assert_true(fabs(log2((double)spot[i].power_q16 / 65536 / alone)) <
                    0.7);
}

/* Checks that a white lamp gets nearly the same power in all formats: within a
 * factor of 2 in RGB565, of 2^0.1 in all others. */
TEST(power_is_the_same_in_all_formats)
{
    static uint8_t px[4 * W * H];
    const struct power_lamp lamp = make_default_lamp(POWER_DISC, 4);
    double expected;

    power_draw_lamp(light, W, H, &lamp);
    draw_and_find_spots(&lamp, 600, 0.05, 0);
    expected = compute_spot_power();
    for (int f = GLINT_RGB24; f <= GLINT_RGB565; f++) {
        struct glint_image image =
            glint_image_over(px, (enum glint_pixel_format)f, W, H);

        if (f == GLINT_LINEAR_Q20)
            continue;
        memset(px, 128, sizeof px);
        for (int i = 0; i < W * H; i++) {
            const int code = codes[3 * i + 1], x = i % W;
            uint8_t *row = image.plane[0] + i / W * image.stride_bytes[0];
            const int bits = code >> 3 << 11 | code >> 2 << 5 | code >> 3;

            switch (f) {
            case GLINT_RGB24:
            case GLINT_BGR24:
                memset(row + 3 * x, code, 3);
                break;
            case GLINT_XRGB8888:
                memset(row + 4 * x, code, 3);
                break;
            case GLINT_RGB565:
                row[2 * x] = (uint8_t)(bits & 255);
                row[2 * x + 1] = (uint8_t)(bits >> 8);
                break;
            case GLINT_YUYV:
            case GLINT_UYVY:
                row[2 * x + (f == GLINT_UYVY)] = (uint8_t)code;
                break;
            default:
                row[x] = (uint8_t)code;
            }
        }
        assert_int_equal(find_and_measure_spots(&image), 1);
        assert_true(fabs(log2(compute_spot_power() / expected)) <
                    (f == GLINT_RGB565 ? 1 : 0.1));
    }
}

/* ---------------------------------------------------------------- extremes */

TEST(white_images_give_valid_results)
{
    static const int sides[][2] = {{1, 1}, {2, 1}, {1, 7}, {64, 64}};
    static uint8_t white[3 * 64 * 64];

    memset(white, 255, sizeof white);
    for (int i = 0; i < 4; i++) {
        const struct glint_image image =
            make_grey_image(white, sides[i][0], sides[i][1]);
        const int n = find_and_measure_spots(&image);

        assert_true(n <= 1);
        for (int k = 0; k < n; k++) {
            assert_true(spot[k].power_q16 >= 0);
            assert_int_equal(spot[k].rgb_q15[1], 1 << 15);
            assert_true(spot[k].axis_q8[0] <= 64 * 256);
        }
    }
}

TEST(measures_a_lamp_of_one_pixel)
{
    const struct glint_image image = make_grey_image(codes, W, H);

    memset(codes, 0, sizeof codes);
    memset(codes + 3 * (50 * W + 40), 255, 3);
    assert_int_equal(find_and_measure_spots(&image), 1);
    assert_true(compute_spot_power() >= 1 && compute_spot_power() < 64);
    assert_int_equal(spot[0].axis_q8[0], 0);
    assert_int_equal(spot[0].axis_q8[1], 0);
}

/* Checks that results are in their allowed ranges, for any bright spots and
 * images. */
TEST(results_stay_in_range_for_any_spots)
{
    static const int32_t any[] = {INT32_MIN, -1, 0, 1, 256, 40000, INT32_MAX};
    struct glint_image image = make_grey_image(codes, W, H);

    for (int round = 0; round < 60; round++) {
        for (int i = 0; i < 3 * W * H; i++)
            codes[i] = (uint8_t)(round % 3 ? 255 * rng_unit(&seed)
                                           : 255 * (rng_unit(&seed) > 0.5));
        for (int i = 0; i < MAX_SPOTS; i++)
            spot[i] = (struct glint_spot){
                .x_q8 = i % 4 ? (int)(256 * W * rng_unit(&seed))
                              : any[(int)(7 * rng_unit(&seed))],
                .y_q8 = i % 5 ? (int)(256 * H * rng_unit(&seed))
                              : any[(int)(7 * rng_unit(&seed))],
                .size_q8 = i % 3 ? (int)(2560 * rng_unit(&seed))
                                 : any[(int)(7 * rng_unit(&seed))]};
        measure_spot_profiles(&image, MAX_SPOTS);
        for (int i = 0; i < MAX_SPOTS; i++) {
            const struct glint_spot *s = &spot[i];
            const double turn =
                hypot(s->cos_q15 / 32768.0, s->sin_q15 / 32768.0);

            assert_true(s->power_q16 >= 0 && s->power_q16 <= INT64_C(1) << 42);
            assert_true(s->axis_q8[0] >= s->axis_q8[1] && s->axis_q8[1] >= 0);
            assert_true(fabs(turn - 1) < 0.01 && s->cos_q15 >= 0);
            for (int c = 0; c < 3; c++)
                assert_true(s->rgb_q15[c] >= 0 && s->rgb_q15[c] <= 1 << 20);
        }
    }
}

/* Checks the RMS extent of a lamp of radius 36, which is 18 pixels. If the lamp
 * lights its surroundings to half of white, up to twice this extent is
 * accepted. A point lamp whose glare clips within the same radius must have a
 * smaller extent. */
TEST(width_excludes_a_lamps_own_light)
{
    const struct power_lamp lamp = make_default_lamp(POWER_DISC, 36);

    for (double rim = 0.05; rim < 0.57; rim += 0.05) {
        draw_core_and_glare(36, rim, 0.5);
        assert_int_equal(draw_and_find_spots(&lamp, 1, 0, 0), 1);
        for (int k = 0; k < 2; k++)
            assert_in_range(spot[0].axis_q8[k], 17 * 256, 36 * 256);
    }
    for (double fall = 1; fall < 2.6; fall += 0.25) {
        draw_core_and_glare(36, 1, fall);
        assert_int_equal(draw_and_find_spots(&lamp, 1, 0, 0), 1);
        assert_in_range(spot[0].axis_q8[0], 0, 6 * 256);
    }
}

/* Checks a ring with a dark middle that lights its surroundings. The middle
 * must not count as missing light at the rim, which would enlarge the lamp's
 * extent. */
TEST(ring_is_not_widened_by_its_middle)
{
    const struct power_lamp lamp = make_default_lamp(POWER_DISC, 50);

    draw_core_and_glare(50, 0.49, 0.1);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            if (hypot(x + 0.5 - W / 2.0, y + 0.5 - H / 2.0) < 30)
                light[y * W + x] = 0.49;
    assert_int_equal(draw_and_find_spots(&lamp, 1, 0, 0), 1);
    assert_in_range(spot[0].axis_q8[0], 0, 6 * 256);
}
