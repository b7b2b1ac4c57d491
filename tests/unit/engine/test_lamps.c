/* SPDX-License-Identifier: MIT
 *
 * Checks that lamps in an image or a list become lights at infinity with the
 * right direction and power.
 */
#include "engine/detector.h"
#include "lamp_files/lamp_list.h"
#include "support/canvas.h"
#include "support/lens_check.h"

enum { WIDTH = 320, HEIGHT = 200, SIDE = 10, X0 = 220, Y0 = 40 };

/* Checks the lamp found in a white square of 10 x 10 pixels on black: centre
 * (225, 45), flux 100. A clipped pixel counts as 2^3 times white. */
TEST(finds_a_white_square)
{
    static uint8_t rgb[3 * WIDTH * HEIGHT];
    const struct glint_view view = glint_view_fit(WIDTH, HEIGHT, 36, 24);
    struct glint_image image =
        glint_image_over(rgb, GLINT_RGB24, WIDTH, HEIGHT);
    struct glint_lamp_detector finder = {.headroom_ev = 3, .max = 8};
    struct glint_lamp_finder_config cfg;
    static struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX];
    double x, y;

    for (int i = 0; i < SIDE; i++)
        memset(rgb + 3 * ((Y0 + i) * WIDTH + X0), 255, 3 * SIDE);
    glint_lamp_finder_defaults(&cfg, WIDTH, HEIGHT);
    assert_ok(glint_lamp_detector_open(&finder, &cfg));
    assert_int_equal(
        glint_lamp_detector_find_lamps(&finder, &image, 0, &view, 50, lamp), 1);
    glint_lamp_detector_close(&finder);
    glint_view_to_pixel(&view, 50, &lamp[0], &x, &y);
    assert_near(x, 225, 0.02);
    assert_near(y, 45, 0.02);
    assert_near(lamp[0].power, 800, 1);
    /* 65 pixels right of and 55 above the image centre; 320 pixels are 36 mm */
    assert_near(lamp[0].phi_deg, 40.236, 0.01);
    assert_near(lamp[0].theta_deg, 10.845, 0.01);
}

enum { W = 320, H = 200 };

static void draw_white_square(struct glint_image *image, int x0, int y0,
                              int side)
{
    for (int y = y0; y < y0 + side; y++)
        memset(image->plane[0] + y * W + x0, 255, (size_t)side);
}

/* Checks tracking in a video: a stationary lamp equals that of a still image
 * bit by bit, a new lamp fades in, and after a restart all lamps have full
 * power at once. */
TEST(tracked_stationary_lamp_equals_a_still)
{
    static uint8_t grey[W * H];
    static struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX],
        still[GLINT_LAMP_DETECTOR_MAX];
    const struct glint_view view = glint_view_fit(W, H, 36, 24);
    struct glint_image image = glint_image_over(grey, GLINT_GREY, W, H);
    struct glint_lamp_detector finder = {.headroom_ev = 12, .max = 8};
    struct glint_lamp_finder_config cfg;

    draw_white_square(&image, 50, 60, 9);
    glint_lamp_finder_defaults(&cfg, W, H);
    assert_ok(glint_lamp_detector_open(&finder, &cfg));
    for (int frame = 0; frame < 5; frame++)
        assert_int_equal(glint_lamp_detector_find_lamps(&finder, &image, 40000,
                                                        &view, 50, lamp),
                         1);
    assert_int_equal(
        glint_lamp_detector_find_lamps(&finder, &image, 0, &view, 50, still),
        1);
    assert_memory_equal(lamp, still, sizeof *lamp);

    draw_white_square(&image, 200, 100, 9);
    assert_int_equal(
        glint_lamp_detector_find_lamps(&finder, &image, 40000, &view, 50, lamp),
        2);
    assert_int_equal(finder.n_tracks, 2);
    /* 40 ms are a fifth of the fade-in of 200 ms. */
    assert_near(lamp[1].power, still[0].power / 5, 10);
    assert_int_equal(finder.track[1].state, GLINT_LAMP_RISING);

    glint_lamp_detector_restart_tracking(&finder);
    glint_lamp_detector_find_lamps(&finder, &image, 40000, &view, 50, lamp);
    assert_true(lamp[1].power == still[0].power);
    glint_lamp_detector_close(&finder);
    glint_lamp_detector_close(&finder);
}

/* Checks a lamp in glare whose clipped core has a rim as wide as the core's
 * radius. In a video the lamp may become a point; in a still image its axes are
 * at least a sixth of the core's. */
TEST(lamp_in_glare_may_become_a_point)
{
    static uint8_t grey[W * H];
    static struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX];
    const struct glint_view view = glint_view_fit(W, H, 36, 24);
    struct glint_image image = glint_image_over(grey, GLINT_GREY, W, H);
    struct glint_lamp_detector finder = {.headroom_ev = -1, .max = 8};
    struct glint_lamp_finder_config cfg;
    double least;

    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double r2 = pow(x - 150, 2) + pow(y - 90, 2);

            grey[y * W + x] =
                (uint8_t)canvas_encode_srgb(fmin(1, 80 / (1 + r2)));
        }
    glint_lamp_finder_defaults(&cfg, W, H);
    assert_ok(glint_lamp_detector_open(&finder, &cfg));
    assert_int_equal(
        glint_lamp_detector_find_lamps(&finder, &image, 40000, &view, 50, lamp),
        1);
    assert_true(finder.track[0].axis_q8[0] < finder.track[0].size_q8 / 6);
    assert_int_equal(
        glint_lamp_detector_find_lamps(&finder, &image, 0, &view, 50, lamp), 1);
    least = finder.track[0].size_q8 / 256.0 / 6;
    assert_true(least > 0.5);
    for (int k = 0; k < 2; k++)
        assert_near(lamp[0].axis[k] / (36.0 / W / 50), least, 0.01);
    assert_true(lamp[0].turn_deg == 0);
    glint_lamp_detector_close(&finder);
}

/* Checks that of twelve lamps the four with the most light are returned, with
 * and without tracking. */
TEST(largest_lamps_are_returned)
{
    static uint8_t grey[W * H];
    static struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX];
    const struct glint_view view = glint_view_fit(W, H, 36, 24);
    struct glint_image image = glint_image_over(grey, GLINT_GREY, W, H);
    struct glint_lamp_detector finder = {.headroom_ev = 0, .max = 4};
    struct glint_lamp_finder_config cfg;

    for (int i = 0; i < 12; i++)
        draw_white_square(&image, 20 + 50 * (i % 6), 40 + 100 * (i / 6),
                          3 + i * 5 % 12);
    glint_lamp_finder_defaults(&cfg, W, H);
    assert_ok(glint_lamp_detector_open(&finder, &cfg));
    for (int us = 0; us <= 40000; us += 40000) {
        assert_int_equal(glint_lamp_detector_find_lamps(&finder, &image, us,
                                                        &view, 50, lamp),
                         4);
        for (int i = 0; i < 4; i++)
            assert_true(lamp[i].power == (14 - i) * (14 - i));
    }
    glint_lamp_detector_close(&finder);
}

static void read_lamp_list_text(struct lamp_list *list, const char *text)
{
    char path[] = "/tmp/glint-lamps-XXXXXX";
    struct glint_error error;
    FILE *file = fdopen(mkstemp(path), "w");

    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    assert_ok(lamp_list_read(list, path, &error));
    remove(path);
}

/* Checks that a lamp is preferred to a larger flat window with the same clipped
 * codes: its halo shows that the lamp has more light. */
TEST(lamp_is_preferred_to_a_flat_window)
{
    static uint8_t grey[W * H];
    static struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX];
    const struct glint_view view = glint_view_fit(W, H, 36, 24);
    struct glint_image image = glint_image_over(grey, GLINT_GREY, W, H);
    struct glint_lamp_detector finder = {.headroom_ev = -1, .max = 1};
    struct glint_lamp_finder_config cfg;
    double x, y;

    for (int i = 0; i < W * H; i++) {
        const double r2 = pow(i % W - 80, 2) + pow(i / W - 80, 2);

        grey[i] = (uint8_t)canvas_encode_srgb(fmin(1, 80 / (1 + r2)));
    }
    draw_white_square(&image, 240, 140, 18);
    glint_lamp_finder_defaults(&cfg, W, H);
    cfg.judge = 0;
    assert_ok(glint_lamp_detector_open(&finder, &cfg));
    assert_int_equal(
        glint_lamp_detector_find_lamps(&finder, &image, 0, &view, 50, lamp), 1);
    glint_view_to_pixel(&view, 50, &lamp[0], &x, &y);
    assert_near(x, 80, 1);
    assert_near(y, 80, 1);
    glint_lamp_detector_close(&finder);
}

/* Checks that lists in CSV and in JSON lines give the same lamps; a row belongs
 * to one frame, or to all frames. */
TEST(csv_and_json_lists_give_the_same_lamps)
{
    static const char *const texts[2] = {
        "frame,x,y,power\n# a lamp\n0,10,20,5\r\n\n*,-30,40,6,1,0.5,0.25\n"
        "2,1,2,3,1,1,1,4\n",
        "{\"frame\": 0, \"x\": 10, \"y\": 20, \"power\": 5}\n"
        "{\"x\":-30,\"y\":40,\"power\":6,\"r\":1,\"g\":0.5,\"b\":0.25}\n"
        "{\"frame\":2,\"x\":1,\"y\":2,\"power\":3,\"size\":4}\n"};
    const struct glint_view view = {
        .width = WIDTH, .height = HEIGHT, .sensor_width_mm = 36};

    for (int k = 0; k < 2; k++) {
        struct lamp_list list;
        struct glint_engine_lamp lamp[4];
        double x, y;

        read_lamp_list_text(&list, texts[k]);
        assert_int_equal(list.n, 3);
        assert_int_equal(lamp_list_get_frame(&list, 1, &view, 50, lamp, 4), 1);
        glint_view_to_pixel(&view, 50, &lamp[0].lamp, &x, &y);
        assert_near(x, -30, 1e-9);
        assert_near(y, 40, 1e-9);
        assert_true(lamp[0].lamp.power == 6 && lamp[0].lamp.rgb[1] == 0.5);
        assert_int_equal(lamp_list_get_frame(&list, 2, &view, 50, lamp, 4), 2);
        assert_true(lamp[1].lamp.power == 3 && list.row[2].size == 4);
        assert_true(lamp[1].lamp.axis[0] > 0 &&
                    lamp[1].lamp.axis[0] == lamp[1].lamp.axis[1]);
        assert_true(lamp[0].lamp.axis[0] == 0);
        lamp_list_free(&list);
    }
}

/* Checks that text that is not a list of lamps is rejected with the number of
 * the wrong line. In the third text, power times colour is too large for an
 * image. */
TEST(rejects_texts_that_are_not_lamp_lists)
{
    static const char *const text_and_error[][2] = {
        {"0,1,2,nan\n", "list:1: expected 4, 7 or 8 numbers"},
        {"*,1,2,3\n0,1,2,-3\n", "list:2: power, also times r, g or b"},
        {"0,1,2,1e20,1,2e10,1\n", "list:1: power, also times r, g or b"},
        {"0,1,2,0,1,1e31,1\n", "list:1: power, also times r, g or b"},
        {"0,1,2,3,1,-1,1\n", "list:1: r, g and b must not be negative"},
        {"0,1,2,3,1,1,1,-1\n", "list:1: size must be 0 to a million pixels"},
        {"0,1,2,3,1,1,1,1e308\n", "list:1: size must be 0 to a million"},
        {"{\"x\":1,\"y\":2}\n", "list:1: x, y and power are needed"}};
    struct lamp_list list;
    struct glint_error error;

    for (size_t k = 0; k < sizeof text_and_error / sizeof *text_and_error;
         k++) {
        const char *const text = text_and_error[k][0];
        const char *const wanted = text_and_error[k][1];

        assert_int_equal(
            lamp_list_parse(&list, text, strlen(text), "list", &error),
            GLINT_E_FORMAT);
        assert_memory_equal(error.text, wanted, strlen(wanted));
        assert_null(list.row);
    }
    assert_int_equal(lamp_list_parse(&list, "0,1,2,3\0", 8, "list", &error),
                     GLINT_E_FORMAT);
    assert_string_equal(error.text, "list: not a text file");
    assert_ok(lamp_list_parse(&list, NULL, 0, "list", &error));
    assert_int_equal(list.n, 0);
}
