/* SPDX-License-Identifier: MIT
 *
 * Checks that the image metrics (PSNR and others) give known results for
 * constructed images.
 */
#include "glint/measure.h"
#include "support/test.h"

enum { SIDE = 64, N = 3 * SIDE * SIDE };

static float a[N], b[N];
static const struct glint_float_image image_a = {SIDE, SIDE, a};
static const struct glint_float_image image_b = {SIDE, SIDE, b};

static void fill_both_images(float value)
{
    for (int i = 0; i < N; i++)
        a[i] = b[i] = value;
}

TEST(equal_images_have_no_difference)
{
    struct glint_measure m;

    for (int i = 0; i < N; i++)
        a[i] = b[i] = (float)(i % 37);
    assert_true(glint_measure_compare(&image_a, &image_b, false, &m));
    assert_true(m.psnr_db == 999 && m.p99 == 0 && m.flux == 1);
    assert_true(fabs(m.ssim - 1) < 1e-12);
}

/* Checks that white and linear 0.5 (sRGB code 188) differ by 67 codes. */
TEST(measures_a_known_difference)
{
    struct glint_measure m;

    fill_both_images(2);
    for (int i = 0; i < N; i++)
        b[i] = 1;
    assert_true(glint_measure_compare(&image_a, &image_b, false, &m));
    assert_true(fabs(m.exposure - 0.5) < 1e-6);
    assert_true(fabs(m.psnr_db - 20 * log10(255.0 / 67)) < 1e-9);
    assert_true(m.p99 == 67 && fabs(m.flux - 0.5) < 1e-6);
    assert_true(glint_measure_compare(&image_a, &image_b, true, &m));
    assert_true(m.psnr_db == 999 && fabs(m.factor - 2) < 1e-6);
}

TEST(measures_differences_below_a_code)
{
    struct glint_measure m;

    fill_both_images(0.5f);
    b[0] = 0.50001f;
    assert_true(glint_measure_at(&image_a, &image_b, false, 1, &m));
    assert_true(m.same_codes && m.psnr_db > 100 && m.psnr_db < 999);
    b[0] = 0.6f;
    assert_true(glint_measure_at(&image_a, &image_b, false, 1, &m));
    assert_true(!m.same_codes && m.psnr_db < 100);
    fill_both_images(1.5f); /* differences above white are ignored */
    b[0] = 2;
    assert_true(glint_measure_at(&image_a, &image_b, false, 1, &m));
    assert_true(m.same_codes && m.psnr_db == 999);
}

/* Checks that the brightest 0.1 % of the pixels do not affect the exposure. */
TEST(exposure_is_a_percentile)
{
    fill_both_images(0.25f);
    for (int i = 0; i < 3 * 4; i++) /* 4 of 4096 pixels are less than 0.1 % */
        a[i] = 1000;
    assert_true(fabs(glint_measure_exposure(&image_a) - 4) < 1e-6);
    fill_both_images(0);
    assert_true(glint_measure_exposure(&image_a) == 1);
}

/* Encoding pixels by a table rounds like the transfer function, also next to
 * the light at which a code ends. */
TEST(codes_are_those_of_the_transfer_function)
{
    enum { SAMPLES = 3 * 8192 };
    static float rgb[SAMPLES];
    const struct glint_float_image image = {SAMPLES / 3, 1, rgb};
    uint8_t *codes;

    for (int i = 0; i < SAMPLES; i++) {
        const double v = (i % 255 + 0.5) / 255;
        const double end =
            v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);

        rgb[i] = i < SAMPLES / 2 ? (float)i / (SAMPLES / 2) * 1.1F - 0.05F
                                 : nextafterf((float)end, (float)(i % 3 - 1));
    }
    codes = glint_measure_encode(&image, 1);
    assert_non_null(codes);
    for (int i = 0; i < SAMPLES; i++)
        assert_int_equal(codes[i], lrint(glint_measure_code((double)rgb[i])));
    free(codes);
}
