/* SPDX-License-Identifier: MIT
 *
 * Compares connected regions of every shape with a flood fill, and checks the
 * colours of lamps in every format.
 */
#include "glint/lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/canvas.h"
#include "support/finder.h"
#include "support/rng.h"
#include "support/test.h"

/* ------------------------------------------------------------------- shapes */

static void assert_one_region(const struct glint_image *image)
{
    struct glint_lamp_finder_config cfg =
        finder_config_without_filters(image, 200, 250);
    int area = 0;

    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            area += canvas_read_grey_pixel(image, x, y) == 255;
    assert_int_equal(finder_find_lamps(&cfg, image), 1);
    assert_int_equal(finder_spot[0].area, area);
    free(image->plane[0]);
}

/* Checks that a pixel is connected to its diagonal neighbours on both sides,
 * and to no pixel further away. This must hold across the borders of the blocks
 * in which runs are searched. */
TEST(corner_pixels_are_connected)
{
    for (int x = 4; x < 68; x++)
        for (int off = -3; off <= 3; off++) {
            struct glint_image image = canvas_allocate_image(GLINT_GREY, 72, 8);
            const struct glint_lamp_finder_config cfg =
                finder_config_without_filters(&image, 200, 250);

            canvas_set_grey_pixel(&image, x, 3, 255);
            canvas_set_grey_pixel(&image, x + off, 4, 255);
            assert_int_equal(finder_find_lamps(&cfg, &image),
                             abs(off) > 1 ? 2 : 1);
            free(image.plane[0]);
        }
}

TEST(u_shape_is_one_region)
{
    struct glint_image image = canvas_allocate_image(GLINT_GREY, 20, 20);

    canvas_fill_grey_box(&image, 2, 2, 4, 18, 255);
    canvas_fill_grey_box(&image, 15, 2, 17, 18, 255);
    canvas_fill_grey_box(&image, 2, 17, 17, 18, 255);
    assert_one_region(&image);
}

/* Checks that a spiral with walls 1 pixel wide and 1 pixel apart is one
 * region. */
TEST(spiral_is_one_region)
{
    static const int step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    struct glint_image image = canvas_allocate_image(GLINT_GREY, 43, 41);
    int x = 0, y = 0, left = 42, down = 40;

    canvas_set_grey_pixel(&image, 0, 0, 255);
    for (int turn = 0; left > 0 && down > 0; turn++) {
        for (int n = turn & 1 ? down : left; n > 0; n--) {
            x += step[turn & 3][0];
            y += step[turn & 3][1];
            canvas_set_grey_pixel(&image, x, y, 255);
        }
        if (turn > 0 && (turn & 1) == 0)
            left -= 2;
        if (turn & 1)
            down -= 2;
    }
    assert_one_region(&image);
}

/* Checks rows with the max number of runs: a checkerboard, connected only by
 * corners, and a comb, connected by its last row, must each be one region. */
TEST(checkerboard_and_comb_are_one_region)
{
    for (int width = 254; width <= 255; width++) {
        struct glint_image board =
            canvas_allocate_image(GLINT_GREY, width, 100);
        struct glint_image comb = canvas_allocate_image(GLINT_GREY, width, 100);

        for (int y = 0; y < 100; y++)
            for (int x = 0; x < width; x++) {
                canvas_set_grey_pixel(&board, x, y, (x + y) & 1 ? 255 : 0);
                canvas_set_grey_pixel(&comb, x, y, x & 1 && y < 99 ? 0 : 255);
            }
        assert_one_region(&board);
        assert_one_region(&comb);
    }
}

/* Clears the region connected to (X, Y) and returns its area, pixels. */
static int clear_and_measure_region(const struct glint_image *image, int x,
                                    int y)
{
    static int stack[64 * 64 * 8][2];
    int n = 0, area = 0;

    stack[n][0] = x, stack[n++][1] = y;
    while (n > 0) {
        x = stack[--n][0], y = stack[n][1];
        if (x < 0 || y < 0 || x >= image->width || y >= image->height ||
            canvas_read_grey_pixel(image, x, y) == 0)
            continue;
        canvas_set_grey_pixel(image, x, y, 0);
        area++;
        for (int k = 0; k < 9; k++)
            if (k != 4)
                stack[n][0] = x + k % 3 - 1, stack[n++][1] = y + k / 3 - 1;
    }
    return area;
}

static void check_regions_by_flood_fill(int width, int height, int percent)
{
    struct finder_case f =
        finder_open_case(GLINT_GREY, width, height, 250, 250);
    int of_area[64 * 64 + 1] = {0};
    int n, regions = 0;

    for (int i = 0; i < width * height; i++)
        f.image.plane[0][i] =
            rng_int_below(&finder_seed, 100) < percent ? 255 : 0;
    n = finder_find_lamps(&f.cfg, &f.image);
    for (int i = 0; i < n; i++)
        of_area[finder_spot[i].area]--;
    for (int i = 0; i < width * height; i++)
        if (f.image.plane[0][i]) {
            of_area[clear_and_measure_region(&f.image, i % width, i / width)]++;
            regions++;
        }
    assert_int_equal(regions, n);
    for (int i = 0; i <= 64 * 64; i++)
        assert_int_equal(of_area[i], 0);
    free(f.image.plane[0]);
}

TEST(random_regions_match_flood_fill)
{
    for (int round = 0; round < 300; round++)
        check_regions_by_flood_fill(1 + rng_int_below(&finder_seed, 64),
                                    1 + rng_int_below(&finder_seed, 64),
                                    10 + rng_int_below(&finder_seed, 70));
}

/* ------------------------------------------------------------------- colour */

static void assert_spot_colour(int i, double r, double g, double b)
{
    const int32_t *c = finder_spot[i].rgb_q15;

    assert_true(fabs(c[0] / 32768.0 - r) < 0.01);
    assert_true(fabs(c[1] / 32768.0 - g) < 0.01);
    assert_true(fabs(c[2] / 32768.0 - b) < 0.01);
    assert_true(fabs(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2] - 32768) <
                4);
}

static void fill_rgb_box(const struct glint_image *image, int x0, int y0,
                         int x1, int y1, int r, int g, int b)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            canvas_set_rgb_pixel(image, x, y, r, g, b);
}

/* Checks the colour of a lamp that is not clipped. Its codes (240, 200, 120)
 * are (0.8714, 0.5776, 0.1878) in linear light, luminance 0.6119. */
TEST(unclipped_lamp_has_its_colour)
{
    struct finder_case f = finder_open_case(GLINT_RGB24, 40, 40, 150, 200);

    fill_rgb_box(&f.image, 10, 10, 20, 20, 240, 200, 120);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_true(fabs((double)finder_spot[0].flux_q16 / 65536 - 61.19) < 0.05);
    assert_spot_colour(0, 1.4241, 0.9440, 0.3069);
    free(f.image.plane[0]);
}

/* Checks that a core clipped to white gets the colour of its rim; without a rim
 * it is white. */
TEST(clipped_core_gets_the_colour_of_its_rim)
{
    struct finder_case f = finder_open_case(GLINT_RGB24, 60, 40, 150, 200);

    fill_rgb_box(&f.image, 9, 9, 21, 21, 240, 200, 120);
    fill_rgb_box(&f.image, 10, 10, 20, 20, 255, 255, 255);
    fill_rgb_box(&f.image, 30, 10, 39, 19, 255, 255, 255);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 2);
    /* red of the rim is 1.42 (46531 in Q15) */
    assert_true(finder_spot[0].rgb_q15[0] > 45000);
    /* blue of the rim is 0.31 (10158 in Q15) */
    assert_true(finder_spot[0].rgb_q15[2] < 13000);
    assert_spot_colour(1, 1, 1, 1);
    free(f.image.plane[0]);
}

/* Checks a lamp with the same clipped channel in all pixels: its colour is the
 * mean of its pixels. */
TEST(partly_clipped_lamp_has_its_mean_colour)
{
    struct finder_case f = finder_open_case(GLINT_RGB24, 40, 40, 50, 50);

    fill_rgb_box(&f.image, 10, 10, 20, 20, 255, 0, 0);
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_spot_colour(0, 1 / 0.2126, 0, 0);
    free(f.image.plane[0]);
}

/* Checks YCbCr formats in limited range, where white is code 235 and the
 * full-range code 200 is 16 + 219 * 200 / 255 = 187.8. */
TEST(ycc_formats_in_limited_range)
{
    static const enum glint_pixel_format formats[3] = {GLINT_I420, GLINT_I422,
                                                       GLINT_I444};

    for (int f = 0; f < 3; f++) {
        struct glint_image image = canvas_allocate_image(formats[f], 41, 31);
        struct glint_lamp_finder_config cfg =
            finder_config_without_filters(&image, 200, 250);

        image.range = GLINT_RANGE_LIMITED;
        image.transfer = GLINT_TONE_BT709;
        /* light of the full-range codes C = 199.5 and 249.5: ((C / 255 + 0.099)
         * / 1.099)^(1 / 0.45) */
        cfg.threshold_low_q8 = (int32_t)floor(256 * log2(0.6124) + 0.5);
        cfg.threshold_high_q8 = (int32_t)floor(256 * log2(0.9569) + 0.5);
        canvas_fill_grey_box(&image, 0, 0, 41, 31, 16);
        for (int i = 1; i < 3; i++)
            memset(image.plane[i], 128,
                   glint_image_row_bytes(formats[f], i, 41) *
                       (size_t)glint_image_plane_height(formats[f], i, 31));
        /* Code 187 in limited range equals 199.1 in full range, which is below
         * the threshold. */
        canvas_fill_grey_box(&image, 36, 26, 41, 31, 187);
        canvas_fill_grey_box(&image, 38, 28, 41, 31, 188);
        canvas_fill_grey_box(&image, 39, 29, 41, 31, 235);
        assert_int_equal(finder_find_lamps(&cfg, &image), 1);
        assert_int_equal(finder_spot[0].area, 9);
        assert_int_equal(finder_spot[0].n_clipped, 4);
        assert_spot_colour(0, 1, 1, 1);
        /* linear light of the region: ((172 / 219 + 0.099) / 1.099)^(1 / 0.45)
         * = 0.6171 */
        assert_true(fabs((double)finder_spot[0].flux_q16 / 65536 -
                         (4 + 5 * 0.6171)) < 0.005);
        free(image.plane[0]);
    }
}

/* Checks the colour of a region of Y, Cb, Cr = 169, 90, 166 (BT.601, limited
 * range), which is R'G'B' = 238.8, 162.1, 101.5. */
TEST(ycc_colour_matches_hand_computation)
{
    struct finder_case f = finder_open_case(GLINT_I444, 20, 20, 150, 170);

    f.image.range = GLINT_RANGE_LIMITED;
    for (int i = 0; i < 3; i++) {
        struct glint_image plane = f.image;

        plane.plane[0] = f.image.plane[i];
        canvas_fill_grey_box(&plane, 0, 0, 20, 20, i ? 128 : 16);
        canvas_fill_grey_box(&plane, 5, 5, 10, 10,
                             i == 0   ? 169
                             : i == 1 ? 90
                                      : 166);
    }
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    /* linear R, G, B = 0.8615, 0.3620, 0.1315; luminance 0.4515 */
    assert_spot_colour(0, 1.908, 0.802, 0.291);
    free(f.image.plane[0]);
}

TEST(finds_lamps_with_negative_stride)
{
    struct finder_case f = finder_open_case(GLINT_GREY, 40, 30, 200, 250);

    canvas_fill_grey_box(&f.image, 5, 2, 8, 5, 255);
    f.image.plane[0] += 29 * 40;
    f.image.stride_bytes[0] = -40;
    assert_int_equal(finder_find_lamps(&f.cfg, &f.image), 1);
    assert_true(finder_centroid_x_of_spot(0) == 6.5 &&
                finder_centroid_y_of_spot(0) == 30 - 3.5);
    free(f.image.plane[0] - 29 * 40);
}
