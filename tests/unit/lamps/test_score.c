/* SPDX-License-Identifier: MIT
 *
 * Tests which bright regions of drawn images count as lamps: coloured lamps in
 * three formats, underexposed nights, lamps in front of walls and in haze; and
 * paper, text, snow, skies and noise, which contain no lamp.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/canvas.h"
#include "support/rng.h"
#include "glint/lamps.h"
#include "lamps/score.h"
#include "support/test.h"

enum { MOST = 64 };

struct settings {
    int width, height;
    double *light; /* linear light, R, G, B per pixel */
};

static struct glint_spot spot[MOST];
static uint32_t seed;
/* number of video frames that draw_and_find_lamps() gives to the finder before
 * the image */
static int n_before;
/* number of lamps found in the last of these video frames */
static int n_video;
/* log2 of the factor by which draw_and_find_lamps() lowers the thresholds,
 * Q8 */
static int n_lower;

static struct settings make_settings(int width, int height, double light)
{
    const size_t n = 3 * (size_t)width * (size_t)height;
    struct settings s = {width, height, malloc(n * sizeof *s.light)};

    assert_non_null(s.light);
    seed = 1;
    for (size_t i = 0; i < n; i++)
        s.light[i] = light;
    return s;
}

/* Adds a lamp at (X, Y) with light LIGHT inside RADIUS; outside, the light
 * falls by a factor e per FALL. All lengths are fractions of the image
 * width. */
static void add_lamp_with_glare(const struct settings *s, double x, double y,
                                double radius, double fall,
                                const double light[3])
{
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++) {
            const double r =
                hypot((i + 0.5) / s->width - x, (j + 0.5) / s->width - y);
            const double part = exp(-fmax(r - radius, 0) / fall);

            for (int c = 0; c < 3; c++)
                s->light[3 * (j * s->width + i) + c] += light[c] * part;
        }
}

/* Fills a box with uniform LIGHT; coordinates are fractions of the image
 * width. */
static void fill_box_with_light(const struct settings *s, double x0, double y0,
                                double x1, double y1, double light)
{
    for (int j = (int)(y0 * s->width); j < (int)(y1 * s->width); j++)
        for (int i = (int)(x0 * s->width); i < (int)(x1 * s->width); i++)
            for (int c = 0; c < 3; c++)
                s->light[3 * (j * s->width + i) + c] = light;
}

static int clamp_code(double code)
{
    return (int)fmax(0, fmin(255, floor(code + 0.5)));
}

/* Converts the codes RGB to full-range BT.601 codes YCC. */
static void convert_rgb_to_ycc(const double rgb[3], double ycc[3])
{
    ycc[0] = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
    ycc[1] = 128 + (rgb[2] - ycc[0]) / 1.772;
    ycc[2] = 128 + (rgb[0] - ycc[0]) / 1.402;
}

static void write_pixel_of_format(const struct glint_image *image, int x, int y,
                                  const double rgb[3])
{
    uint8_t *const row = image->plane[0] + y * image->stride_bytes[0];
    double ycc[3];

    convert_rgb_to_ycc(rgb, ycc);
    if (image->format == GLINT_RGB24) {
        for (int c = 0; c < 3; c++)
            row[3 * x + c] = (uint8_t)clamp_code(rgb[c]);
    } else if (image->format == GLINT_YUYV) {
        row[2 * x] = (uint8_t)clamp_code(ycc[0]);
        row[2 * x + 1] = (uint8_t)clamp_code(ycc[1 + x % 2]);
    } else {
        row[x] = (uint8_t)clamp_code(ycc[0]);
        for (int i = 1; i < 3; i++)
            image->plane[i][y * image->stride_bytes[i] + x] =
                (uint8_t)clamp_code(ycc[i]);
    }
}

/* Draws S as an image of FORMAT with noise of SIGMA codes. Returns the
 * number of lamps found. */
static int draw_and_find_lamps(const struct settings *s,
                               enum glint_pixel_format format, double sigma)
{
    struct glint_image image = {
        .format = format, .width = s->width, .height = s->height};
    struct glint_lamp_finder_config cfg;
    struct glint_lamp_finder *finder;
    void *mem;
    int n;

    glint_image_place(&image,
                      malloc(glint_image_bytes(format, s->width, s->height)));
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            const double noise =
                sigma *
                (rng_unit(&seed) + rng_unit(&seed) + rng_unit(&seed) - 1.5) * 2;
            double rgb[3];

            for (int c = 0; c < 3; c++)
                rgb[c] = canvas_encode_srgb_exactly(
                             s->light[3 * (y * s->width + x) + c]) +
                         noise;
            write_pixel_of_format(&image, x, y, rgb);
        }
    glint_lamp_finder_defaults(&cfg, s->width, s->height);
    cfg.threshold_high_q8 -= n_lower;
    cfg.threshold_low_q8 -= n_lower;
    assert_int_equal(posix_memalign(&mem, 64, glint_lamp_finder_bytes(&cfg)),
                     0);
    assert_ok(glint_lamp_finder_init(&finder, &cfg, mem,
                                     glint_lamp_finder_bytes(&cfg)));
    for (int i = 0; i < n_before; i++) {
        glint_lamp_finder_keep_white(finder, 0);
        n_video = glint_lamp_finder_find(finder, &image, spot, MOST);
    }
    n = glint_lamp_finder_find(finder, &image, spot, MOST);
    free(mem);
    free(image.plane[0]);
    return n;
}

static void assert_spot_near(const struct settings *s, double x, double y)
{
    double least = HUGE_VAL;

    for (int i = 0; i < MOST; i++)
        least = fmin(least, hypot(spot[i].x_q8 / 256.0 / s->width - x,
                                  spot[i].y_q8 / 256.0 / s->width - y));
    assert_true(least < 0.01);
}

static void assert_no_lamp_is_found(struct settings *s)
{
    for (double sigma = 0; sigma < 3; sigma += 1.5)
        assert_int_equal(draw_and_find_lamps(s, GLINT_RGB24, sigma), 0);
    free(s->light);
}

/* -------------------------------------------------------------------- lamps */

/* Checks that a lamp of any colour is found, and nothing else. Most colours
 * clip one or two channels; only yellow and white have a luma near white. */
TEST(finds_lamps_of_every_colour)
{
    static const double colours[][3] = {
        {3, 0.1, 0.05}, {0.05, 3, 0.3}, {0.1, 0.15, 3}, {3, 1.2, 0.2},
        {3, 0.2, 3},    {0.2, 3, 3},    {3, 3, 0.3},    {3, 3, 3}};
    static const enum glint_pixel_format formats[] = {GLINT_RGB24, GLINT_YUYV,
                                                      GLINT_I444};

    for (size_t i = 0; i < sizeof colours / sizeof *colours; i++) {
        struct settings s = make_settings(400, 260, 0.01);

        add_lamp_with_glare(&s, 0.3, 0.35, 0.015, 0.01, colours[i]);
        for (int f = 0; f < 3; f++) {
            assert_int_equal(draw_and_find_lamps(&s, formats[f], 1), 1);
            assert_spot_near(&s, 0.3, 0.35);
        }
        free(s.light);
    }
}

/* Checks that two lamps whose light is 0.1 to 0.4 of white are found in an
 * image without clipping. */
TEST(finds_lamps_in_an_underexposed_night)
{
    static const double colour[3] = {0.25, 0.22, 0.15};

    for (double gain = 0.5; gain <= 1.5; gain += 0.5) {
        const double light[3] = {gain * colour[0], gain * colour[1],
                                 gain * colour[2]};
        struct settings s = make_settings(400, 260, 0.002);

        add_lamp_with_glare(&s, 0.3, 0.35, 0.02, 0.01, light);
        add_lamp_with_glare(&s, 0.8, 0.15, 0.02, 0.01, light);
        assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, 1), 2);
        assert_spot_near(&s, 0.3, 0.35);
        assert_spot_near(&s, 0.8, 0.15);
        free(s.light);
    }
}

TEST(finds_a_lamp_before_a_bright_wall)
{
    static const double white[3] = {4, 4, 4};
    struct settings s = make_settings(400, 260, 0.35);

    add_lamp_with_glare(&s, 0.4, 0.3, 0.03, 0.02, white);
    assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, 1), 1);
    assert_spot_near(&s, 0.4, 0.3);
    free(s.light);
}

/* Checks that the sun is found in haze: the sky is brighter than the glow of
 * any lamp, and the sky's red is clipped far around the sun. */
TEST(finds_the_sun_in_haze)
{
    static const double sun[3] = {3, 3, 3}, haze[3] = {0.8, 0.35, 0.1};
    struct settings s = make_settings(400, 260, 0.25);

    add_lamp_with_glare(&s, 0.5, 0.25, 0.04, 0.02, sun);
    add_lamp_with_glare(&s, 0.5, 0.25, 0.04, 0.2, haze);
    assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, 1), 1);
    assert_spot_near(&s, 0.5, 0.25);
    free(s.light);
}

/* Checks that the same lamps are found in a scene drawn at widths of 320 to
 * 2000 pixels. */
TEST(finds_the_same_lamps_at_every_resolution)
{
    static const double lamp[3] = {4, 3, 1.5};

    for (int width = 320; width <= 2000; width = width * 5 / 2) {
        struct settings s = make_settings(width, width * 5 / 8, 0.02);

        add_lamp_with_glare(&s, 0.2, 0.2, 0.008, 0.006, lamp);
        add_lamp_with_glare(&s, 0.5, 0.4, 0.012, 0.008, lamp);
        add_lamp_with_glare(&s, 0.8, 0.3, 0.03, 0.01, lamp);
        assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, 1), 3);
        assert_spot_near(&s, 0.2, 0.2);
        assert_spot_near(&s, 0.5, 0.4);
        assert_spot_near(&s, 0.8, 0.3);
        free(s.light);
    }
}

/* ---------------------------------------------------- images without lamps */

/* Draws lines of words whose ink has LIGHT. */
static void draw_lines_of_text(const struct settings *s, double light)
{
    for (int line = 0; line < 18; line++)
        for (double x = 0.05; x < 0.9; x += 0.012) {
            const double y = 0.04 + line * 0.03;
            const double tall = 0.008 + 0.008 * rng_unit(&seed);

            if (rng_unit(&seed) < 0.15)
                continue;
            fill_box_with_light(s, x, y, x + 0.003, y + tall, light);
            fill_box_with_light(s, x, y, x + 0.008, y + 0.003, light);
            if (rng_unit(&seed) < 0.5)
                fill_box_with_light(s, x + 0.006, y, x + 0.009, y + tall,
                                    light);
        }
}

TEST(paper_and_text_give_no_lamp)
{
    struct settings page = make_settings(600, 400, 1);
    struct settings terminal = make_settings(600, 400, 0.0);
    struct settings desk = make_settings(600, 400, 0.12);

    draw_lines_of_text(&page, 0.02);
    draw_lines_of_text(&terminal, 1);
    fill_box_with_light(&desk, 0.1, 0.1, 0.6, 0.5, 0.85);
    assert_no_lamp_is_found(&page);
    assert_no_lamp_is_found(&terminal);
    assert_no_lamp_is_found(&desk);
}

/* Draws the eight bars of a test pattern into the first ROWS rows: white, then
 * yellow to black with codes of 75 % (0.52 in linear light). */
static void draw_colour_bars(const struct settings *s, int rows)
{
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < s->width; x++) {
            const int bar = 8 * x / s->width;

            for (int c = 0; c < 3; c++)
                s->light[3 * (y * s->width + x) + c] =
                    bar == 0                   ? 1
                    : (7 - bar) >> (2 - c) & 1 ? 0.52
                                               : 0;
        }
}

/* Checks that neither the white bar of a test pattern nor a white box below
 * the bars is taken for a lamp, but that a round lamp in place of the box is
 * found. */
TEST(test_patterns_give_no_lamp)
{
    static const double white[3] = {1, 1, 1};

    for (int width = 320; width <= 1280; width += 320) {
        struct settings bars = make_settings(width, width * 9 / 16, 0);
        struct settings box = make_settings(width, width * 9 / 16, 0.005);
        struct settings lamp = make_settings(width, width * 9 / 16, 0.005);

        draw_colour_bars(&bars, bars.height);
        draw_colour_bars(&box, box.height / 2);
        draw_colour_bars(&lamp, lamp.height / 2);
        fill_box_with_light(&box, 0.8, 0.375, 0.85, 0.425, 1);
        add_lamp_with_glare(&lamp, 0.825, 0.4, 0.025, 0.003, white);
        assert_int_equal(draw_and_find_lamps(&bars, GLINT_RGB24, 0), 0);
        assert_int_equal(draw_and_find_lamps(&box, GLINT_RGB24, 0), 0);
        assert_int_equal(draw_and_find_lamps(&lamp, GLINT_RGB24, 0), 1);
        assert_spot_near(&lamp, 0.825, 0.4);
        free(bars.light);
        free(box.light);
        free(lamp.light);
    }
}

/* Checks that snow, drawn as grains of every brightness, many of them white,
 * gives no lamp. */
TEST(snow_gives_no_lamp)
{
    struct settings s = make_settings(600, 400, 0.7);

    for (int i = 0; i < 3 * 600 * 400; i += 3) {
        const double light = 0.45 + 0.7 * rng_unit(&seed);

        s.light[i] = s.light[i + 1] = s.light[i + 2] = light;
    }
    assert_no_lamp_is_found(&s);
}

/* Checks that no lamp is found in a sky from blue to white at the horizon over
 * dark ground, nor in a uniform sky. */
TEST(skies_give_no_lamp)
{
    struct settings s = make_settings(600, 400, 0.03);
    struct settings overcast = make_settings(600, 400, 0.95);

    for (int y = 0; y < 260; y++)
        for (int x = 0; x < 600; x++) {
            double *const px = &s.light[3 * (y * 600 + x)];

            px[0] = 0.2 + y * 0.9 / 260;
            px[1] = 0.35 + y * 0.75 / 260;
            px[2] = 0.8 + y * 0.3 / 260;
        }
    assert_no_lamp_is_found(&s);
    assert_no_lamp_is_found(&overcast);
}

/* Checks that noise of up to 9 codes, as with the lens cap on, gives no
 * lamp. */
TEST(noise_in_the_dark_gives_no_lamp)
{
    struct settings s = make_settings(600, 400, 0.001);

    for (double sigma = 0; sigma < 10; sigma += 3)
        assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, sigma), 0);
    free(s.light);
}

/* ------------------------------------------------------ limit of the score */

/* Returns a candidate with the score SCORE_Q8, found at the threshold level
 * LEVEL: a box of 4 x 4 pixels at X, inside the boxes of candidates of lower
 * levels at the same X. */
static struct glint_candidate make_scored_candidate(int x, int level,
                                                    int32_t score_q8)
{
    return (struct glint_candidate){
        .sum = {.first = x, .x0 = x, .y0 = 0, .x1 = x + 4, .y1 = 4},
        .score_q8 = score_q8,
        .level = (int16_t)level};
}

enum { ALONE = 40 };

static int32_t find_score_limit(struct glint_candidate *candidate, int n)
{
    const struct glint_level level[2] = {{.low = 1}, {.low = 2}};
    const struct glint_score score = {.level = level, .alone_q8 = ALONE};
    int32_t order[4] = {0, 1, 2, 3};
    const int32_t least_q8 =
        glint_score_find_min_lamp_score(&score, candidate, order, n);

    for (int i = 0; i < n; i++)
        assert_int_equal(candidate[i].gone, 0);
    return least_q8;
}

/* Checks that two sure lamps lower the score limit for other candidates, but
 * that one lamp does not, nor a lamp with its own core, nor a lamp with a faint
 * one. */
TEST(two_sure_lamps_lower_the_limit)
{
    struct glint_candidate c[4] = {
        make_scored_candidate(0, 0, -50), make_scored_candidate(10, 0, 80),
        make_scored_candidate(20, 0, -300), make_scored_candidate(30, 0, -1)};

    assert_int_equal(find_score_limit(c, 4), 0);
    c[3] = make_scored_candidate(10, 1, 60);
    assert_int_equal(find_score_limit(c, 4), 0);
    c[3] = make_scored_candidate(30, 0, 60);
    c[3].faint = 1;
    assert_int_equal(find_score_limit(c, 4), 0);
    c[3].faint = 0;
    assert_int_equal(find_score_limit(c, 4), -SCORE_COMPANY);
}

/* Checks that if no lamp is sure, the best candidate may be slightly below the
 * score limit, unless it is faint. The second best may not, nor a candidate
 * next to a sure lamp. */
TEST(best_candidate_passes_slightly_below_the_limit)
{
    struct glint_candidate c[4] = {make_scored_candidate(0, 0, -300),
                                   make_scored_candidate(10, 0, -ALONE - 1),
                                   make_scored_candidate(20, 0, -ALONE),
                                   make_scored_candidate(30, 0, -ALONE + 1)};

    assert_int_equal(find_score_limit(c, 2), 0);
    assert_int_equal(find_score_limit(c, 3), -ALONE);
    assert_int_equal(find_score_limit(c, 4), -ALONE + 1);
    c[3].faint = 1;
    assert_int_equal(find_score_limit(c, 4), -ALONE);
    c[3] = make_scored_candidate(30, 0, 0);
    assert_int_equal(find_score_limit(c, 4), 0);
    assert_int_equal(find_score_limit(c, 0), 0);
}

/* Makes the wall behind a lamp brighter step by step. Checks that a still image
 * shows the lamp up to a brighter wall than a video does, and that video frames
 * before a still image do not matter. */
TEST(video_needs_a_higher_score)
{
    static const double white[3] = {4, 4, 4};
    int n_alone = 0, n_after = 0, n_of_video = 0;

    for (double wall = 0.2; wall < 0.9; wall += 0.01) {
        struct settings s = make_settings(300, 200, wall);

        add_lamp_with_glare(&s, 0.4, 0.3, 0.03, 0.02, white);
        n_before = 0;
        n_alone += draw_and_find_lamps(&s, GLINT_RGB24, 0);
        n_before = 1;
        n_after += draw_and_find_lamps(&s, GLINT_RGB24, 0);
        n_of_video += n_video;
        free(s.light);
    }
    n_before = 0;
    assert_int_equal(n_after, n_alone);
    assert_in_range(n_of_video, 1, n_alone - 1);
}

/* Checks that lower thresholds find a dim lamp besides two brighter ones. With
 * these thresholds alone, the glow of both would be one region. */
TEST(lower_thresholds_find_more)
{
    static const double white[3] = {4, 4, 4}, dim[3] = {0.7, 0.7, 0.7};
    struct settings s = make_settings(400, 260, 0.002);

    add_lamp_with_glare(&s, 0.3, 0.3, 0.05, 0.002, dim);
    add_lamp_with_glare(&s, 0.27, 0.3, 0.012, 0.001, white);
    add_lamp_with_glare(&s, 0.33, 0.3, 0.012, 0.001, white);
    add_lamp_with_glare(&s, 0.8, 0.4, 0.02, 0.002, dim);
    assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, 0), 2);
    n_lower = 128;
    assert_int_equal(draw_and_find_lamps(&s, GLINT_RGB24, 0), 3);
    n_lower = 0;
    assert_spot_near(&s, 0.27, 0.3);
    assert_spot_near(&s, 0.33, 0.3);
    assert_spot_near(&s, 0.8, 0.4);
    free(s.light);
}

/* Checks that a region that differs from a lamp in a single measure gets doubts
 * for that measure. */
TEST(differing_measure_is_doubted)
{
    static const struct {
        int measure, value_q8;
        enum glint_doubt doubt;
    } poor[] = {{EVIDENCE_AROUND, 0, GLINT_DOUBT_AROUND},
                {EVIDENCE_SPREAD, 9999, GLINT_DOUBT_GLOW},
                {EVIDENCE_FILL, 0, GLINT_DOUBT_SHAPE},
                {EVIDENCE_SIZE, -9999, GLINT_DOUBT_SIZE},
                {EVIDENCE_WHITE, -999, GLINT_DOUBT_GREY},
                {EVIDENCE_CROWD, 9999, GLINT_DOUBT_CROWD},
                {EVIDENCE_DARK_4, 0, GLINT_DOUBT_DAY},
                {EVIDENCE_HIGH, 0, GLINT_DOUBT_LOW},
                {EVIDENCE_DRAWN, 256, GLINT_DOUBT_DRAWN}};
    static const int32_t lamp_q8[EVIDENCES] = {
        [EVIDENCE_AROUND] = 1200,   [EVIDENCE_HALO] = 512,
        [EVIDENCE_FILL] = 224,      [EVIDENCE_BOX] = 200,
        [EVIDENCE_SIZE] = -2000,    [EVIDENCE_COLOUR] = 256,
        [EVIDENCE_CLOSE] = 300,     [EVIDENCE_HIGH] = 160,
        [EVIDENCE_WIDE_HALO] = 512, [EVIDENCE_WIDE_HOT] = 256,
        [EVIDENCE_DARK_2] = 700,    [EVIDENCE_DARK_4] = 500,
        [EVIDENCE_DARK_32] = 1600};

    for (size_t i = 0; i < sizeof poor / sizeof *poor; i++) {
        struct glint_candidate c = {.level = 0};

        memcpy(c.evidence_q8, lamp_q8, sizeof lamp_q8);
        c.evidence_q8[poor[i].measure] = poor[i].value_q8;
        assert_int_equal(glint_score_choose_doubt(&c), poor[i].doubt);
    }
}
