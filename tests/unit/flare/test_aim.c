/* SPDX-License-Identifier: MIT
 *
 * Frames made in integers: directions of pixels and weights of colours must be
 * those that the engine computes in doubles, within the bounds of flare.h.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/light.h"
#include "glint/flare.h"
#include "glint/setup.h"
#include "support/rng.h"
#include "support/test.h"

enum { N_PIXELS = 20000, NEAR_Q30 = 4 };

static struct glint_model_header header;
static const struct glint_lens lens = {.header = &header};

static void set_lens(double focal_mm, double width_mm, double height_mm)
{
    memset(&header, 0, sizeof header);
    header.focal_mm = glint_real_of(focal_mm);
    header.film_width_mm = glint_real_of(width_mm);
    header.film_height_mm = glint_real_of(height_mm);
    header.wave_lo_q24 = (int32_t)(0x1p24 / (0.7 * 0.7));
    header.wave_hi_q24 = (int32_t)(0x1p24 / (0.4 * 0.4));
}

static struct glint_light by_doubles(int width, int height, double focal_mm,
                                     double x, double y)
{
    const struct glint_view view =
        glint_view_fit(width, height, glint_real_value(header.film_width_mm),
                       glint_real_value(header.film_height_mm));
    struct glint_lamp lamp = {.power = 1, .rgb = {1, 1, 1}};

    glint_view_to_angles(&view, focal_mm, x, y, &lamp);
    return glint_light_of(&lamp, 1);
}

static void same(const struct glint_light *a, const struct glint_light *b)
{
    assert_in_range(labs((long)a->sine_q30 - b->sine_q30), 0, NEAR_Q30);
    assert_in_range(labs((long)a->cosine_q30 - b->cosine_q30), 0, NEAR_Q30);
    assert_in_range(labs((long)a->cos_q30 - b->cos_q30), 0, NEAR_Q30);
    assert_in_range(labs((long)a->sin_q30 - b->sin_q30), 0, NEAR_Q30);
    assert_true(glint_real_value(a->power) == glint_real_value(b->power));
    assert_memory_equal(a->rgb_q14, b->rgb_q14, sizeof a->rgb_q14);
}

/* Pixels of pictures of any shape, also far beside them, must have the right
 * direction through lenses from fisheyes to telescopes and through those that
 * mirror (negative focal lengths). */
TEST(pixels)
{
    uint32_t seed = 7;

    for (int i = 0; i < N_PIXELS; i++) {
        const int width = 1 + (int)(rng_xorshift(&seed) % GLINT_MAX_SIDE);
        const int height = 1 + (int)(rng_xorshift(&seed) % GLINT_MAX_SIDE);
        const int bits = (int)(rng_xorshift(&seed) % 25);
        const uint32_t mask = (UINT32_C(1) << bits) - 1;
        const int32_t x_q8 = width * 128 +
                             (int32_t)(rng_xorshift(&seed) & mask) -
                             (int32_t)mask / 2;
        const int32_t y_q8 = height * 128 +
                             (int32_t)(rng_xorshift(&seed) & mask) -
                             (int32_t)mask / 2;
        const double focal_mm = exp2(1 + rng_xorshift(&seed) % 10) *
                                (rng_xorshift(&seed) % 4 ? 1 : -1);
        struct glint_light integers, doubles;

        set_lens(focal_mm, 36, 24);
        integers = glint_light_from_pixel(&lens, width, height, x_q8, y_q8);
        doubles =
            by_doubles(width, height, focal_mm, x_q8 / 256.0, y_q8 / 256.0);
        if (x_q8 == width * 128 && y_q8 == height * 128)
            doubles.cos_q30 = 1 << 30; /* any azimuth will do here */
        same(&integers, &doubles);
    }
}

/* By hand: a pixel 45 degrees to the left. Pixels so far to the upper right
 * that their distance is clamped must all have one direction. */
TEST(by_hand)
{
    const int32_t half_q30 = 759250125; /* sqrt(2) / 2 */
    struct glint_light light, farther;

    set_lens(18, 36, 36);
    light = glint_light_from_pixel(&lens, 200, 200, 0, 100 * 256);
    assert_in_range(labs((long)light.sine_q30 - half_q30), 0, 1);
    assert_in_range(labs((long)light.cosine_q30 - half_q30), 0, 1);
    assert_int_equal(light.cos_q30, -(1 << 30));
    assert_int_equal(light.sin_q30, 0);
    light = glint_light_from_pixel(&lens, 200, 200, INT32_MAX, INT32_MIN);
    farther = glint_light_from_pixel(&lens, 200, 200, 25600 + (1 << 30),
                                     25600 - (1 << 30));
    assert_in_range(labs((long)light.cos_q30 - half_q30), 0, 1);
    assert_in_range(labs((long)light.sin_q30 - half_q30), 0, 1);
    same(&light, &farther);
}

TEST(pixels_per_mm)
{
    set_lens(50, 36, 24);
    assert_true(glint_real_value(glint_flare_pixels_per_mm(&lens, 720, 480)) ==
                20);
    assert_true(glint_real_value(glint_flare_pixels_per_mm(&lens, 72, 480)) ==
                20);
    assert_true(glint_real_value(glint_flare_pixels_per_mm(&lens, 720, 48)) ==
                20);
}

static void waves_are(const double flux[6])
{
    static const double nm[GLINT_FLARE_WAVES] = {650, 532, 450};
    static struct glint_setup setup;
    struct glint_wave wave[GLINT_FLARE_WAVES];
    struct glint_error error;

    for (int k = 0; k < 6; k++)
        header.direct_flux[k] = glint_real_of(flux[k]);
    assert_ok(glint_setup_from_model(&setup, &lens, 0, 0, nm, GLINT_FLARE_WAVES,
                                     &error));
    glint_setup_balance(&setup);
    glint_flare_waves(wave, &lens);
    for (int i = 0; i < GLINT_FLARE_WAVES; i++) {
        const struct glint_wave w =
            glint_wave_of(nm[i], setup.rgb[i], setup.unit_flux[i]);

        assert_int_equal(wave[i].wave_q24, w.wave_q24);
        assert_memory_equal(wave[i].rgb_q14, w.rgb_q14, sizeof w.rgb_q14);
        assert_true(
            fabs(glint_real_value(wave[i].weight) / glint_real_value(w.weight) -
                 1) < 0x1p-24);
    }
}

/* Weights of wavelengths must be those in doubles: for a flux polynomial as
 * lenses have it, for a flat one, and for wavelengths beyond the band, which
 * count as its nearer end. */
TEST(waves)
{
    static const double lens_flux[6] = {312.4, -41.2, -10.7, 2.9, -0.4, 0.01};
    static const double flat[6] = {1e-3};

    set_lens(50, 36, 24);
    waves_are(lens_flux);
    waves_are(flat);
    header.wave_hi_q24 = (int32_t)(0x1p24 / (0.5 * 0.5));
    header.wave_lo_q24 = (int32_t)(0x1p24 / (0.6 * 0.6));
    waves_are(lens_flux);
}

/* Where the model has no light, weights must be 0 and not undefined. */
TEST(no_light)
{
    struct glint_wave wave[GLINT_FLARE_WAVES];

    set_lens(50, 36, 24);
    glint_flare_waves(wave, &lens);
    for (int i = 0; i < GLINT_FLARE_WAVES; i++)
        assert_int_equal(wave[i].weight.mantissa, 0);
}
