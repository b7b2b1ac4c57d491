/* SPDX-License-Identifier: MIT
 *
 * Checks that the lamp finder finds drawn lamps at stable subpixel positions
 * and rejects bright areas that are not lamps.
 */
#include "glint/lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lamps/regions.h"
#include "support/canvas.h"
#include "support/finder.h"
#include "support/region_pixels.h"
#include "support/rng.h"
#include "support/test.h"

/* Returns nearly Gaussian noise of standard deviation SIGMA: a sum of eight
 * uniform numbers. */
static double random_noise(double sigma)
{
    double sum = 0;

    for (int i = 0; i < 8; i++)
        sum += rng_int_below(&finder_seed, 1 << 20) * 0x1p-20 - 0.5;
    return sigma * sum / sqrt(8 / 12.0);
}
/* ------------------------------------------------------------ configuration */

TEST(needs_exactly_the_stated_memory)
{
    struct glint_lamp_finder *finder;
    struct glint_lamp_finder_config cfg;
    size_t bytes;
    void *mem;

    glint_lamp_finder_defaults(&cfg, 1302, 953);
    bytes = glint_lamp_finder_bytes(&cfg);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_ok(glint_lamp_finder_init(&finder, &cfg, mem, bytes));
    assert_int_equal(glint_lamp_finder_init(&finder, &cfg, mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_int_equal(glint_lamp_finder_init(&finder, &cfg, mem, 1),
                     GLINT_E_MEMORY);
    assert_int_equal(
        glint_lamp_finder_init(&finder, &cfg, (char *)mem + 8, bytes - 8),
        GLINT_E_ARGUMENT);
    free(mem);
}

static void assert_config_is_rejected(struct glint_lamp_finder_config cfg)
{
    static uint64_t mem[16];
    struct glint_lamp_finder *finder;

    assert_true(glint_lamp_finder_bytes(&cfg) == 0);
    assert_int_equal(glint_lamp_finder_init(&finder, &cfg, mem, sizeof mem),
                     GLINT_E_ARGUMENT);
}

TEST(rejects_invalid_configurations)
{
    struct glint_lamp_finder_config good, bad;

    glint_lamp_finder_defaults(&good, 640, 480);
    assert_true(glint_lamp_finder_bytes(&good) > 0);
    bad = good, bad.width = 0, assert_config_is_rejected(bad);
    bad = good, bad.width = GLINT_MAX_SIDE + 1, assert_config_is_rejected(bad);
    bad = good, bad.height = 0, assert_config_is_rejected(bad);
    bad = good, bad.threshold_low_q8 = -20 * 256 - 1,
    assert_config_is_rejected(bad);
    bad = good, bad.threshold_high_q8 = 1, assert_config_is_rejected(bad);
    bad = good, bad.threshold_low_q8 = good.threshold_high_q8 + 1,
    assert_config_is_rejected(bad);
    bad = good, bad.white_code = 256, assert_config_is_rejected(bad);
    bad = good, bad.white_code = -1, assert_config_is_rejected(bad);
    bad = good, bad.judge = 2, assert_config_is_rejected(bad);
    bad = good, bad.min_area = 0, assert_config_is_rejected(bad);
    bad = good, bad.max_share_q15 = -1, assert_config_is_rejected(bad);
    bad = good, bad.max_share_q15 = 32769, assert_config_is_rejected(bad);
    bad = good, bad.merge_q15 = -1, assert_config_is_rejected(bad);
    bad = good, bad.merge_q15 = 32769, assert_config_is_rejected(bad);
    bad = good, bad.keep_faint = 2, assert_config_is_rejected(bad);
}

TEST(defaults_are_valid_for_every_size)
{
    static const int sides[] = {1, 2, 100, 1080, GLINT_MAX_SIDE};

    for (int i = 0; i < 25; i++) {
        struct glint_lamp_finder_config cfg;

        glint_lamp_finder_defaults(&cfg, sides[i % 5], sides[i / 5]);
        assert_true(glint_lamp_finder_bytes(&cfg) > 0);
    }
}

/* ---------------------------------------------------------------- one light */

TEST(finds_a_lamp_in_an_image_of_one_pixel)
{
    struct finder_case f = finder_open_case(GLINT_RGB24, 1, 1, 200, 250);

    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 0);
    canvas_set_rgb_pixel(&f.image, 0, 0, 255, 255, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_int_equal(finder_spot[0].x_q8, 128);
    assert_int_equal(finder_spot[0].y_q8, 128);
    assert_int_equal(finder_spot[0].size_q8, 0);
    assert_int_equal(finder_spot[0].area, 1);
    assert_int_equal(finder_spot[0].n_clipped, 1);
    assert_int_equal(finder_spot[0].flux_q16, 65536);
    for (int i = 0; i < 3; i++)
        assert_int_equal(finder_spot[0].rgb_q15[i], 32768);
    free(f.image.plane[0]);
}

/* Checks the moments of a white pixel and three adjacent pixels of sRGB code
 * 188 (linear 0.5029) against values computed by hand. */
TEST(moments_match_hand_computation)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 16, 8, 180, 250);

    canvas_set_grey_pixel(&f.image, 10, 5, 188);
    canvas_set_grey_pixel(&f.image, 11, 5, 255);
    canvas_set_grey_pixel(&f.image, 12, 5, 188);
    canvas_set_grey_pixel(&f.image, 11, 6, 188);
    /* a pixel below the upper threshold is not a seed */
    canvas_set_grey_pixel(&f.image, 0, 0, 188);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_int_equal(finder_spot[0].area, 4);
    assert_int_equal(finder_spot[0].n_clipped, 1);
    assert_true(fabs((double)finder_spot[0].flux_q16 / 65536 - 2.5087) < 1e-3);
    assert_true(fabs(finder_centroid_x_of_spot(0) - 11.5) < 1.0 / 256);
    assert_true(fabs(finder_centroid_y_of_spot(0) - (5.5 + 0.5029 / 2.5087)) <
                1.0 / 256);
    /* Variance along x: 2 * 0.5029 / 2.5087; along y: 0.2005 - 0.2005^2. */
    assert_true(fabs(finder_spot[0].size_q8 / 256.0 - sqrt(0.4009 + 0.1603)) <
                1.0 / 128);
    free(f.image.plane[0]);
}

TEST(finds_discs_within_a_sixteenth_pixel)
{
    for (int round = 0; round < 100; round++) {
        struct finder_case f = finder_open_case(GLINT_GREY, 64, 48, 2, 250);
        const double radius = 1.5 + rng_int_below(&finder_seed, 600) / 100.0;
        const double cx = 20 + rng_int_below(&finder_seed, 2000) / 100.0;
        const double cy = 20 + rng_int_below(&finder_seed, 1000) / 100.0;

        canvas_draw_disc(&f.image, cx, cy, radius, 1);
        assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
        assert_true(fabs(finder_centroid_x_of_spot(0) - cx) < 1.0 / 16);
        assert_true(fabs(finder_centroid_y_of_spot(0) - cy) < 1.0 / 16);
        assert_true(fabs(finder_spot[0].size_q8 / 256.0 - radius / sqrt(2)) <
                    0.1);
        assert_true(fabs((double)finder_spot[0].flux_q16 / 65536 -
                         3.14159265 * radius * radius) <
                    0.02 * 3.14159265 * radius * radius);
        free(f.image.plane[0]);
    }
}

/* Draws a lamp at (CX, CY) onto a grey image: four times the light of white
 * inside RADIUS; outside, the light falls by a factor e per FALL pixels. */
static void draw_lamp_with_glare(const struct glint_image *image, double cx,
                                 double cy, double radius, double fall)
{
    const double reach = radius + 8 * fall;

    for (int y = (int)fmax(cy - reach, 0); y < image->height; y++)
        for (int x = (int)fmax(cx - reach, 0); x < image->width; x++) {
            const double r = hypot(x + 0.5 - cx, y + 0.5 - cy);
            const double light = 4 * exp(-fmax(r - radius, 0) / fall);
            const double under =
                canvas_decode_srgb(canvas_read_grey_pixel(image, x, y));

            if (r < reach)
                canvas_set_grey_pixel(
                    image, x, y, canvas_encode_srgb(fmin(under + light, 1)));
        }
}

/* Checks that the default configuration finds a lamp within 0.35 pixels: it
 * cuts the lamp's rim off at the same light on all sides. */
TEST(finds_discs_with_default_configuration)
{
    for (int round = 0; round < 100; round++) {
        struct glint_image image = canvas_allocate_image(GLINT_GREY, 640, 480);
        struct glint_lamp_finder_config cfg = finder_default_config(&image);
        const double radius = 3 + rng_int_below(&finder_seed, 900) / 100.0;
        const double cx = 20 + rng_int_below(&finder_seed, 60000) / 100.0;
        const double cy = 20 + rng_int_below(&finder_seed, 44000) / 100.0;

        draw_lamp_with_glare(&image, cx, cy, radius, 1.5);
        assert_int_equal(finder_find_lamps(&cfg, &image), 1);
        assert_true(hypot(finder_centroid_x_of_spot(0) - cx,
                          finder_centroid_y_of_spot(0) - cy) < 0.35);
        free(image.plane[0]);
    }
}

/* --------------------------------------------------------------- stability */

/* Checks that the position of a lamp with a blurred rim is right within 0.25
 * pixels RMS, in 100 frames with camera noise of 3 codes. */
TEST(noise_does_not_move_a_light)
{
    double square = 0;

    for (int frame = 0; frame < 100; frame++) {
        struct glint_image image = canvas_allocate_image(GLINT_GREY, 100, 80);
        struct glint_lamp_finder_config cfg = finder_default_config(&image);

        cfg.max_share_q15 = 1 << 15;
        for (int y = 0; y < 80; y++)
            for (int x = 0; x < 100; x++) {
                const double r = hypot(x + 0.5 - 47.3, y + 0.5 - 38.9);
                const double light = r < 3 ? 2 : 2 * exp(-(r - 3) / 2.5);
                const double code = canvas_encode_srgb(light) + random_noise(3);

                canvas_set_grey_pixel(&image, x, y,
                                      (int)fmax(0, fmin(255, code + 0.5)));
            }
        assert_int_equal(finder_find_lamps(&cfg, &image), 1);
        square += pow(finder_centroid_x_of_spot(0) - 47.3, 2) +
                  pow(finder_centroid_y_of_spot(0) - 38.9, 2);
        free(image.plane[0]);
    }
    print_message("noise of 3 codes: %.3f px rms\n", sqrt(square / 100));
    assert_true(sqrt(square / 100) < 0.25);
}

/* Checks a lamp of 8 x 8 pixels in which any one pixel flickers to white: its
 * position changes by less than 0.1 pixels. */
TEST(sparkle_does_not_move_a_light)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 64, 64, 150, 200);
    double furthest = 0;

    for (int k = 0; k < 64; k++) {
        canvas_fill_grey_box(&f.image, 20, 30, 28, 38, 200);
        canvas_set_grey_pixel(&f.image, 20 + k % 8, 30 + k / 8, 255);
        assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
        furthest = fmax(furthest, hypot(finder_centroid_x_of_spot(0) - 24,
                                        finder_centroid_y_of_spot(0) - 34));
    }
    print_message("sparkle in 8 x 8: %.3f px at most\n", furthest);
    assert_true(furthest < 0.1);
    free(f.image.plane[0]);
}

/* Checks the darkest lamp that can be found, in which one hot pixel is 40 times
 * brighter than the other 63 pixels. The hot pixel changes the lamp's position
 * by less than a pixel. */
TEST(hot_pixel_hardly_moves_a_dim_lamp)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 64, 64, 40, 43);

    canvas_fill_grey_box(&f.image, 20, 30, 28, 38, 43); /* linear 0.0242 */
    canvas_set_grey_pixel(&f.image, 24, 34, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_true(hypot(finder_centroid_x_of_spot(0) - 24,
                      finder_centroid_y_of_spot(0) - 34) < 1);
    free(f.image.plane[0]);
}

TEST(repeated_search_gives_the_same_lamps)
{
    struct finder_case f = finder_open_case(GLINT_RGB24, 300, 200, 200, 250);
    static struct glint_spot first[FINDER_SPOTS];
    int n, dropped;

    f.cfg.merge_q15 = 300;
    for (int i = 0; i < 3 * 300 * 200; i++)
        f.image.plane[0][i] = (uint8_t)rng_int_below(&finder_seed, 256);
    n = finder_find_at_most_n_lamps(&f.cfg, &f.image, 100, &dropped);
    memcpy(first, finder_spot, sizeof first);
    for (int round = 0; round < 3; round++) {
        assert_int_equal(
            finder_find_at_most_n_lamps(&f.cfg, &f.image, 100, &dropped), n);
        assert_memory_equal(finder_spot, first,
                            (size_t)n * sizeof *finder_spot);
    }
    free(f.image.plane[0]);
}

/* --------------------------------------------- lamps and other bright areas */

TEST(black_and_white_images_have_no_lamp)
{
    struct glint_image image = canvas_allocate_image(GLINT_GREY, 100, 50);
    struct glint_lamp_finder_config cfg = finder_default_config(&image);

    assert_int_equal(finder_find_lamps(&cfg, &image), 0);
    canvas_fill_grey_box(&image, 0, 0, 100, 50, 255);
    assert_int_equal(finder_find_lamps(&cfg, &image), 0);
    cfg.judge = 0;
    cfg.max_share_q15 = 1 << 15;
    assert_int_equal(finder_find_lamps(&cfg, &image), 1);
    assert_int_equal(finder_spot[0].x_q8, 50 * 256);
    assert_int_equal(finder_spot[0].y_q8, 25 * 256);
    assert_int_equal(finder_spot[0].area, 5000);
    assert_true(finder_spot[0].flux_q16 == INT64_C(5000) << 16);
    /* the squared RMS radius is (100^2 + 50^2 - 2) / 12 */
    assert_true(fabs(finder_spot[0].size_q8 / 256.0 - 32.2723) < 1.0 / 128);
    free(image.plane[0]);
}

/* Checks a large all-white image, the worst case for sums of moments. */
TEST(large_white_image_does_not_overflow)
{
    enum { SIDE = 8192 };
    struct finder_case f = finder_open_case(GLINT_GREY, SIDE, SIDE, 200, 250);

    memset(f.image.plane[0], 255, (size_t)SIDE * SIDE);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_int_equal(finder_spot[0].x_q8, 4096 * 256);
    assert_int_equal(finder_spot[0].y_q8, 4096 * 256);
    assert_int_equal(finder_spot[0].area, 1 << 26);
    assert_true(finder_spot[0].flux_q16 == INT64_C(1) << 42);
    assert_true(fabs(finder_spot[0].size_q8 / 256.0 - 8192 / sqrt(6)) <
                1.0 / 128);
    assert_int_equal(finder_spot[0].rgb_q15[2], 32768);
    free(f.image.plane[0]);
}

static struct glint_region make_white_region(int x0, int y0, int x1, int y1)
{
    const struct glint_region_light white = {1 << 14,
                                             {1 << 14, 1 << 14, 1 << 14}};
    struct glint_region r = {
        .first = y0 * GLINT_MAX_SIDE + x0, .x0 = x0, .y0 = y0, .x1 = x0};

    for (int y = y0; y < y1; y++) {
        region_add_pixels(&r, &white, x0, x1, y);
        glint_region_add_run(&r, x0, x1, y);
    }
    return r;
}

/* Checks position, size and light of white rectangles in the largest image,
 * and of the whole image. */
TEST(largest_regions_are_measured_right)
{
    enum { S = GLINT_MAX_SIDE };
    static const int box[][4] = {{0, 0, S, S},          {0, 0, S, S / 2},
                                 {S - 3, S - 3, S, S},  {0, S - 1, S, S},
                                 {S - 1, 0, S, S},      {S - 4096, 0, S, 4096},
                                 {S - 4097, 0, S, 4097}};

    for (size_t k = 0; k < sizeof box / sizeof *box; k++) {
        const int *b = box[k];
        const double w = b[2] - b[0], h = b[3] - b[1];
        const struct glint_region r = make_white_region(b[0], b[1], b[2], b[3]);
        int32_t x_q8, y_q8, rgb_q15[3];

        glint_region_compute_centroid(&r, &x_q8, &y_q8);
        glint_region_compute_colour(&r, rgb_q15);
        assert_int_equal(x_q8, (b[0] + b[2] - 1) * 128);
        assert_int_equal(y_q8, (b[1] + b[3] - 1) * 128);
        assert_int_equal(r.area, (int)(w * h));
        assert_true(r.w_q14 == (int64_t)(w * h) << 14);
        assert_int_equal(rgb_q15[1], 32768);
        assert_true(fabs(glint_region_compute_rms_radius_q8(&r) / 256.0 -
                         sqrt((w * w + h * h - 2) / 12)) < 1.0 / 128);
    }
}

/* Checks that lamps at both ends of the longest possible images are found at
 * their positions. */
TEST(finds_lamps_at_both_ends_of_long_images)
{
    enum { LONG = GLINT_MAX_SIDE, SHORT = 64, OFF = 20, SIDE = 6 };

    for (int turned = 0; turned < 2; turned++) {
        const int width = turned ? SHORT : LONG, height = turned ? LONG : SHORT;
        struct glint_image image =
            canvas_allocate_image(GLINT_GREY, width, height);
        struct glint_lamp_finder_config cfg =
            finder_config_without_filters(&image, 200, 250);

        memset(image.plane[0], 0, (size_t)width * (size_t)height);
        for (int end = 0; end < 2; end++)
            for (int k = 0; k < SIDE * SIDE; k++) {
                const int x = (end ? width - OFF - SIDE : OFF) + k % SIDE;
                const int y = (end ? height - OFF - SIDE : OFF) + k / SIDE;

                image.plane[0][(ptrdiff_t)y * image.stride_bytes[0] + x] =
                    (uint8_t)(255 - end);
            }
        assert_int_equal(finder_find_lamps(&cfg, &image), 2);
        for (int end = 0; end < 2; end++) {
            const int64_t low = OFF * 256 + SIDE * 128;

            assert_int_equal(finder_spot[end].area, SIDE * SIDE);
            assert_int_equal(finder_spot[end].x_q8,
                             end ? width * 256 - low : low);
            assert_int_equal(finder_spot[end].y_q8,
                             end ? height * 256 - low : low);
        }
        free(image.plane[0]);
    }
}

TEST(sky_is_not_a_lamp)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 100, 100, 200, 250);

    /* max area: 32768 / 10 of the image, 999.8 pixels, rounded up */
    f.cfg.max_share_q15 = 32768 / 10;
    canvas_fill_grey_box(&f.image, 0, 0, 100, 10, 255);
    canvas_fill_grey_box(&f.image, 40, 50, 44, 54, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 2);
    canvas_set_grey_pixel(&f.image, 7, 10, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_int_equal(finder_spot[0].area, 16);
    free(f.image.plane[0]);
}

/* Checks that a lit surface is not a lamp if fewer than one in 8 of its pixels
 * reach the upper threshold. In the glow of a lamp at least one in 8 does. */
TEST(surface_with_few_bright_pixels_is_not_a_lamp)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 100, 100, 200, 250);

    canvas_fill_grey_box(&f.image, 10, 10, 42, 42, 240); /* 1024 pixels */
    /* Only 128 pixels of the box are bright. */
    canvas_fill_grey_box(&f.image, 10, 10, 42, 14, 255);
    canvas_set_grey_pixel(&f.image, 41, 13, 240);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 0);
    canvas_set_grey_pixel(&f.image, 41, 13, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    free(f.image.plane[0]);
}

/* Checks a core with three rings around it. The first, bright ring belongs to
 * the lamp; the second, darker one does not. The third is bright but not a
 * lamp, as no pixel of it is above the upper threshold. */
TEST(ring_around_a_core_belongs_to_the_lamp)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 60, 60, 200, 250);
    int area = 0;

    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 60; x++) {
            const double r = hypot(x + 0.5 - 30, y + 0.5 - 30);

            area += r < 10;
            canvas_set_grey_pixel(&f.image, x, y,
                                  r < 5    ? 250
                                  : r < 10 ? 200
                                  : r < 15 ? 199
                                  : r < 20 ? 249
                                           : 0);
        }
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_int_equal(finder_spot[0].area, area);
    free(f.image.plane[0]);
}

/* Requests faint regions, too. Checks that the lamps do not change, and that
 * the faint regions follow them in the list, marked as faint. */
TEST(faint_regions_come_last)
{
    static struct glint_spot light[FINDER_SPOTS];
    int most_faint = 0;

    for (int round = 0; round < 50; round++) {
        struct finder_case f = finder_open_case(GLINT_GREY, 256, 256, 100, 200);
        int n_lights, n, max = round % 2 ? FINDER_SPOTS : 20, dropped;

        f.cfg.min_area = 4;
        f.cfg.merge_q15 = 6 * 32768 / 256;
        for (int i = 0; i < 200; i++) {
            const int x = rng_int_below(&finder_seed, 250),
                      y = rng_int_below(&finder_seed, 250);

            canvas_fill_grey_box(&f.image, x, y,
                                 x + 1 + rng_int_below(&finder_seed, 4),
                                 y + 1 + rng_int_below(&finder_seed, 4),
                                 100 + rng_int_below(&finder_seed, 156));
        }
        n_lights = finder_find_at_most_n_lamps(&f.cfg, &f.image, max, &dropped);
        memcpy(light, finder_spot, sizeof light);
        f.cfg.keep_faint = 1;
        n = finder_find_at_most_n_lamps(&f.cfg, &f.image, max, &dropped);
        assert_in_range(n, n_lights, max);
        assert_memory_equal(light, finder_spot,
                            (size_t)n_lights * sizeof *finder_spot);
        for (int i = n_lights; i < n; i++) {
            assert_int_equal(finder_spot[i].faint, 1);
            assert_true(finder_spot[i].area >= 2); /* half of min_area */
            assert_true(finder_spot[i].area < 4 ||
                        finder_spot[i].n_clipped <= finder_spot[i].area / 8 ||
                        finder_spot[i].n_clipped == 0);
            assert_true(i == n_lights ||
                        finder_spot[i].flux_q16 <= finder_spot[i - 1].flux_q16);
        }
        most_faint = n - n_lights > most_faint ? n - n_lights : most_faint;
        free(f.image.plane[0]);
    }
    assert_true(most_faint > 20);
}

/* Checks the sums of a region that fills the image and consists of noise and
 * uniform patches, against double precision. */
TEST(sums_of_a_large_region_match_doubles)
{
    for (int round = 0; round < 20; round++) {
        struct finder_case f = finder_open_case(GLINT_GREY, 320, 200, 1, 1);
        double flux = 0, x_sum = 0, y_sum = 0, r2 = 0;

        for (int i = 0; i < 320 * 200; i++)
            f.image.plane[0][i] =
                (uint8_t)(100 + rng_int_below(&finder_seed, 156));
        for (int i = 0; i < 30; i++) {
            const int x = rng_int_below(&finder_seed, 250),
                      y = rng_int_below(&finder_seed, 150);

            canvas_fill_grey_box(&f.image, x, y, x + 70, y + 50,
                                 rng_int_below(&finder_seed, 2) ? 255 : 40);
        }
        for (int i = 0; i < 320 * 200; i++) {
            const double w = canvas_decode_srgb(f.image.plane[0][i]);
            const double x = i % 320 + 0.5, y = i / 320 + 0.5;

            flux += w, x_sum += w * x, y_sum += w * y;
            r2 += w * (x * x + y * y);
        }
        assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
        assert_true(fabs((double)finder_spot[0].flux_q16 / 65536 / flux - 1) <
                    1e-4);
        assert_true(fabs(finder_centroid_x_of_spot(0) - x_sum / flux) < 0.01);
        assert_true(fabs(finder_centroid_y_of_spot(0) - y_sum / flux) < 0.01);
        assert_true(fabs(finder_spot[0].size_q8 / 256.0 -
                         sqrt(r2 / flux - pow(x_sum / flux, 2) -
                              pow(y_sum / flux, 2))) < 0.02);
        free(f.image.plane[0]);
    }
}

TEST(small_regions_are_noise)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 60, 60, 200, 250);

    f.cfg.min_area = 5;
    canvas_fill_grey_box(&f.image, 10, 10, 12, 12, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 0);
    /* a fifth pixel at a corner of the square of four */
    canvas_set_grey_pixel(&f.image, 12, 12, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    free(f.image.plane[0]);
}

/* ----------------------------------------------------------- several lights */

TEST(lamps_are_sorted_by_flux)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 100, 60, 100, 250);

    canvas_draw_disc(&f.image, 20.5, 20.5, 4, 1);
    canvas_draw_disc(&f.image, 70.5, 40.5, 6, 1);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 2);
    assert_true(hypot(finder_centroid_x_of_spot(0) - 70.5,
                      finder_centroid_y_of_spot(0) - 40.5) < 1.0 / 16);
    assert_true(hypot(finder_centroid_x_of_spot(1) - 20.5,
                      finder_centroid_y_of_spot(1) - 20.5) < 1.0 / 16);
    assert_true(finder_spot[0].flux_q16 > finder_spot[1].flux_q16);
    free(f.image.plane[0]);
}

TEST(ties_are_sorted_by_position)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 100, 60, 100, 250);

    canvas_fill_grey_box(&f.image, 50, 20, 52, 22, 255);
    canvas_fill_grey_box(&f.image, 80, 10, 82, 12, 255);
    canvas_fill_grey_box(&f.image, 10, 20, 12, 22, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 3);
    assert_true(finder_centroid_x_of_spot(0) == 81 &&
                finder_centroid_x_of_spot(1) == 11 &&
                finder_centroid_x_of_spot(2) == 51);
    free(f.image.plane[0]);
}

/* Checks that regions of nine and of three white pixels, 4 pixels apart, are
 * merged into one lamp, centred 1 pixel from the centre of the larger
 * region. */
TEST(near_regions_are_merged)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 128, 64, 100, 250);

    canvas_fill_grey_box(&f.image, 20, 20, 23, 23, 255);
    canvas_fill_grey_box(&f.image, 25, 20, 26, 23, 255);
    f.cfg.merge_q15 = 4 * 32768 / 128;
    /* a merge distance of less than 4 pixels merges nothing */
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 2);
    f.cfg.merge_q15 = 5 * 32768 / 128;
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_true(finder_centroid_x_of_spot(0) == 22.5 &&
                finder_centroid_y_of_spot(0) == 21.5);
    assert_int_equal(finder_spot[0].area, 12);
    assert_true(finder_spot[0].flux_q16 == 12 << 16);
    /* the squared RMS radius is (9 * (1^2 + 2 / 3) + 3 * 3^2) / 12 = 3.5 along
     * x, and 2 / 3 along y */
    assert_true(fabs(finder_spot[0].size_q8 / 256.0 - sqrt(3.5 + 0.6667)) <
                0.01);
    free(f.image.plane[0]);
}

TEST(merged_regions_keep_the_merge_distance)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 256, 256, 100, 250);
    int n, area = 0;

    f.cfg.merge_q15 = 12 * 32768 / 256;
    for (int i = 0; i < 1000; i++)
        canvas_set_grey_pixel(&f.image, rng_int_below(&finder_seed, 256),
                              rng_int_below(&finder_seed, 256), 255);
    for (int i = 0; i < 256 * 256; i++)
        area += f.image.plane[0][i] > 0;
    n = finder_find_lamps(&f.cfg, &f.image);
    for (int i = 0; i < n; i++) {
        area -= finder_spot[i].area;
        for (int j = 0; j < i; j++)
            assert_true(hypot(finder_centroid_x_of_spot(i) -
                                  finder_centroid_x_of_spot(j),
                              finder_centroid_y_of_spot(i) -
                                  finder_centroid_y_of_spot(j)) > 11.99);
    }
    assert_int_equal(area, 0);
    free(f.image.plane[0]);
}

/* Checks a limit of two lights for an image of four: the third, near the first,
 * is merged with it; the fourth, far from all, is dropped. */
TEST(limit_keeps_the_brightest)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 256, 64, 100, 250);
    int dropped;

    f.cfg.merge_q15 = 4 * 32768 / 256;
    canvas_fill_grey_box(&f.image, 20, 20, 26, 26, 255);   /* 36 px */
    canvas_fill_grey_box(&f.image, 100, 20, 105, 25, 255); /* 25 px */
    /* This region has 12 pixels and is 13 pixels from the others. */
    canvas_fill_grey_box(&f.image, 35, 20, 37, 26, 255);
    canvas_fill_grey_box(&f.image, 200, 20, 202, 22, 255); /* 4 px */
    assert_int_equal(finder_find_at_most_n_lamps(&f.cfg, &f.image, 2, &dropped),
                     2);
    assert_int_equal(dropped, 1);
    assert_int_equal(finder_spot[0].area, 48);
    assert_true(finder_centroid_x_of_spot(0) == 23 + 13 * 12 / 48.0);
    assert_int_equal(finder_spot[1].area, 25);
    free(f.image.plane[0]);
}

TEST(merging_can_change_the_order)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 256, 64, 100, 250);
    int dropped;

    f.cfg.merge_q15 = 4 * 32768 / 256;
    canvas_fill_grey_box(&f.image, 20, 20, 26, 26, 255);   /* 36 px */
    canvas_fill_grey_box(&f.image, 100, 20, 105, 25, 255); /* 25 px */
    canvas_fill_grey_box(&f.image, 110, 20, 114, 25, 255); /* 20 px */
    assert_int_equal(finder_find_at_most_n_lamps(&f.cfg, &f.image, 2, &dropped),
                     2);
    assert_int_equal(dropped, 0);
    assert_int_equal(finder_spot[0].area, 45);
    assert_int_equal(finder_spot[1].area, 36);
    free(f.image.plane[0]);
}

/* Checks an image of 4096 lights: the finder stores the 2048 brightest and
 * returns 1024. */
TEST(stores_the_brightest_of_4096_lights)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 256, 256, 100, 150);
    int dropped, bright = 0;

    for (int y = 0; y < 256; y += 4)
        for (int x = 0; x < 256; x += 4)
            canvas_set_grey_pixel(&f.image, x, y,
                                  150 + rng_int_below(&finder_seed, 106));
    assert_int_equal(
        finder_find_at_most_n_lamps(&f.cfg, &f.image, 1024, &dropped), 1024);
    assert_int_equal(dropped, 4096 - 1024);
    for (int i = 1; i < 1024; i++)
        assert_true(finder_spot[i].flux_q16 <= finder_spot[i - 1].flux_q16);
    for (int y = 0; y < 256; y += 4)
        for (int x = 0; x < 256; x += 4) {
            const int last =
                canvas_read_grey_pixel(&f.image, finder_spot[1023].x_q8 >> 8,
                                       finder_spot[1023].y_q8 >> 8);

            bright += canvas_read_grey_pixel(&f.image, x, y) > last;
        }
    assert_true(bright < 1024);
    free(f.image.plane[0]);
}
