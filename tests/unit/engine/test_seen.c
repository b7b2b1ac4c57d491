/* SPDX-License-Identifier: MIT
 *
 * Checks the predicted visibility of a flare on the image below it, and the
 * exposure chosen from it.
 */
#include "engine/strength.h"
#include "support/canvas.h"
#include "support/test.h"

enum { WIDTH = 64, HEIGHT = 36 };

static struct glint_ground ground;
static float light[HEIGHT][WIDTH][3];

static void fill_background(int code)
{
    memset(&ground, code, sizeof ground);
}

/* Sets the green light of the flare to OF (1 = white) in its first ROWS rows,
 * and to 0 elsewhere. */
static void set_flare_rows(int rows, double of)
{
    memset(light, 0, sizeof light);
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < WIDTH; x++)
            light[y][x][1] = (float)of;
}

static struct glint_seen visibility(void)
{
    struct glint_seen seen;

    glint_seen_measure_visibility(&seen, &ground, light[0][0], WIDTH, HEIGHT);
    return seen;
}

/* Checks that added light of 32 codes has the visibility 1 on black, 1/9 on a
 * background of code 120, and 0 on code 240. */
TEST(bright_background_lowers_visibility)
{
    struct glint_seen dark, lit;
    const double each = canvas_decode_srgb(32);

    fill_background(0);
    set_flare_rows(4, each);
    dark = visibility();
    assert_true(fabs(log2(dark.few)) <= 0.126);
    assert_true(dark.many == 0);
    fill_background(120);
    lit = visibility();
    assert_true(fabs(log2(lit.few *
                          (canvas_decode_srgb(152) - canvas_decode_srgb(120)) /
                          each)) <= 0.126);
    fill_background(240);
    assert_true(visibility().few == 0); /* nothing is visible on white */
}

TEST(visibility_ignores_single_pixels)
{
    fill_background(0);
    set_flare_rows(0, 1);
    assert_true(visibility().few == 0 && visibility().many == 0);
    set_flare_rows(HEIGHT / 3, 4 * canvas_decode_srgb(32));
    assert_true(visibility().few == visibility().many);
    assert_true(fabs(log2(visibility().many) - 2) <= 0.126);
    light[0][0][0] = 1; /* a single bright pixel is ignored */
    assert_true(fabs(log2(visibility().few) - 2) <= 0.126);
}

/* Checks the measure `white`: the light of a flare divided by the light that
 * makes all channels of the background white. On code 200, it is 1 for a small
 * ghost of exactly this light. On a darker background, and on code 250, where a
 * white ghost has no visible edge, it is 0. */
TEST(only_all_channels_make_white)
{
    const float room = (float)(1 - canvas_decode_srgb(200));

    fill_background(200);
    set_flare_rows(1, 1);
    assert_true(visibility().white ==
                0); /* green light alone does not make a pixel white */
    for (int x = 0; x < WIDTH; x++)
        for (int c = 0; c < 3; c++)
            light[0][x][c] = x < 4 ? room : 0;
    assert_true(fabs(log2(visibility().white)) <= 0.126);
    fill_background(250);
    assert_true(visibility().white == 0);
    fill_background(159);
    assert_true(visibility().white == 0);
}

/* Checks the background (struct ground) that is sampled from an image: if the
 * left half of the image is white, so is the left half of the background. */
TEST(background_is_sampled_from_the_image)
{
    struct glint_image image = canvas_allocate_image(GLINT_GREY, 100, 50);

    canvas_fill_grey_box(&image, 0, 0, 50, 50, 255);
    glint_ground_sample_picture(&ground, &image);
    assert_int_equal(ground.rgb[90][159][0], 255);
    assert_int_equal(ground.rgb[90][160][2], 0);
    free(image.plane[0]);
}

/* ----------------------------------------------------------------- exposure */

/* Corrects the exposure of a flare at the strength ASKED. Before the
 * correction, the flare has the peak PEAK, the mean MEAN and the visibility
 * SEEN. Returns the corrected peak. */
static double exposed_peak(double asked, double peak, double mean,
                           struct glint_seen seen)
{
    const struct glint_response_light drawn = {{peak, 0, 0}, {mean, 0, 0}};
    struct glint_strength s;

    glint_strength_set_defaults(&s);
    s.asked = asked;
    s.scale = 1;
    glint_strength_correct_exposure(&s, &drawn, &seen);
    return s.light.peak[0];
}

TEST(hidden_flares_are_exposed_brighter)
{
    const double peak = 1 / 32.0, mean = peak / 300;
    const struct glint_seen plain = {1, 0, 0}, hidden = {0, 0, 0},
                            half = {0.0625, 0, 0};

    /* a flare that is fully visible gets a peak of a quarter of white */
    assert_true(fabs(exposed_peak(0.5, peak, mean, plain) - 0.25) < 0.001);
    /* An invisible flare is brightened until it is visible. The limit of its
     * peak is 0.6 of white. */
    assert_true(fabs(exposed_peak(0.5, peak, mean, half) - 0.5) < 0.001);
    assert_true(fabs(exposed_peak(0.5, peak, mean, hidden) - 0.6) < 0.001);
    /* Half of the strength darkens the flare to a quarter, as for visible
     * flares. */
    assert_true(fabs(exposed_peak(0.25, peak, mean, half) - 0.125) < 0.001);
    assert_true(fabs(exposed_peak(0.25, peak, mean, plain) - 0.0625) < 0.001);
    /* The mean of the flare is limited to 0.04 of white. */
    assert_true(fabs(exposed_peak(0.5, peak, peak / 10, hidden) - 0.4) < 0.001);
}

TEST(veils_and_skies_are_exposed_darker)
{
    const double peak = 1 / 32.0, mean = peak / 20;
    const struct glint_seen veil = {0.5, 0.125, 0}, thick = {9, 9, 0},
                            thin = {1, 0.05, 0}, sky = {0, 0, peak / 0.4},
                            haze = {0, 0, peak / 0.05};

    assert_true(fabs(exposed_peak(0.5, peak, mean, veil) - 0.125) < 0.001);
    assert_true(fabs(exposed_peak(0.5, peak, mean, thick) - 0.1) < 0.001);
    assert_true(exposed_peak(0.5, peak, mean, thin) > 0.24);
    /* On a sky that becomes white when light of 0.4 is added, the peak of
     * ghosts is two fifths of 0.4, and at least 0.1. */
    assert_true(fabs(exposed_peak(0.5, peak, peak / 300, sky) - 0.16) < 0.001);
    assert_true(fabs(exposed_peak(0.5, peak, peak / 300, haze) - 0.1) < 0.001);
}
