/* SPDX-License-Identifier: MIT
 *
 * Checks that the image metrics (PSNR and others) give known results for
 * constructed images.
 */
#include <math.h>
#include <stdlib.h>

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
