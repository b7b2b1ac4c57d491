/* SPDX-License-Identifier: MIT
 *
 * Tests frames set up in integers: pixel directions and colour weights differ
 * from those that the engine computes in double precision by at most the
 * bounds stated in flare.h.
 */
#include "engine/frame/light.h"
#include "glint/flare.h"
#include "glint/setup.h"
#include "support/rng.h"
#include "support/test.h"

enum { N_PIXELS = 20000, NEAR_Q30 = 4 };

static struct glint_model_header header;
static const struct glint_lens lens = {.header = &header};

static void set_lens_header(double focal_mm, double width_mm, double height_mm)
{
    memset(&header, 0, sizeof header);
    header.focal_mm = glint_real_of(focal_mm);
    header.film_width_mm = glint_real_of(width_mm);
    header.film_height_mm = glint_real_of(height_mm);
    header.wave_lo_q24 = (int32_t)(0x1p24 / (0.7 * 0.7));
    header.wave_hi_q24 = (int32_t)(0x1p24 / (0.4 * 0.4));
}

static struct glint_light compute_direction_in_double(int width, int height,
                                                      double focal_mm, double x,
                                                      double y)
{
    const struct glint_view view =
        glint_view_fit(width, height, glint_real_value(header.film_width_mm),
                       glint_real_value(header.film_height_mm));
    struct glint_lamp lamp = {.power = 1, .rgb = {1, 1, 1}};

    glint_view_to_angles(&view, focal_mm, x, y, &lamp);
    return glint_light_from_lamp(&lamp, 1);
}

static void assert_same_direction_and_power(const struct glint_light *a,
                                            const struct glint_light *b)
{
    assert_in_range(labs((long)a->sine_q30 - b->sine_q30), 0, NEAR_Q30);
    assert_in_range(labs((long)a->cosine_q30 - b->cosine_q30), 0, NEAR_Q30);
    assert_in_range(labs((long)a->cos_q30 - b->cos_q30), 0, NEAR_Q30);
    assert_in_range(labs((long)a->sin_q30 - b->sin_q30), 0, NEAR_Q30);
    assert_true(glint_real_value(a->power) == glint_real_value(b->power));
    assert_memory_equal(a->rgb_q14, b->rgb_q14, sizeof a->rgb_q14);
}

/* Checks the directions of pixels, also far off-screen, of images of any shape,
 * for lenses from fisheyes to telephotos and mirroring ones (negative focal
 * length). */
TEST(pixel_directions_match_double_precision)
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

        set_lens_header(focal_mm, 36, 24);
        integers = glint_light_from_pixel(&lens, width, height, x_q8, y_q8);
        doubles = compute_direction_in_double(width, height, focal_mm,
                                              x_q8 / 256.0, y_q8 / 256.0);
        if (x_q8 == width * 128 && y_q8 == height * 128)
            /* at the image centre the azimuth is arbitrary */
            doubles.cos_q30 = 1 << 30;
        assert_same_direction_and_power(&integers, &doubles);
    }
}

/* Checks the direction of the pixel 45 degrees to the left, which was computed
 * by hand. Pixels far off to the upper right, whose distance is clamped, must
 * all have the same direction. */
TEST(direction_matches_hand_computation)
{
    const int32_t half_q30 = 759250125; /* sqrt(2) / 2 */
    struct glint_light light, farther;

    set_lens_header(18, 36, 36);
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
    assert_same_direction_and_power(&light, &farther);
}

TEST(pixels_per_mm_of_the_film)
{
    set_lens_header(50, 36, 24);
    assert_true(glint_real_value(glint_flare_pixels_per_mm(&lens, 720, 480)) ==
                20);
    assert_true(glint_real_value(glint_flare_pixels_per_mm(&lens, 72, 480)) ==
                20);
    assert_true(glint_real_value(glint_flare_pixels_per_mm(&lens, 720, 48)) ==
                20);
}

static void check_wavelength_fluxes(const double flux[6])
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
            glint_wave_from_nm(nm[i], setup.rgb[i], setup.unit_flux[i]);

        assert_int_equal(wave[i].wave_q24, w.wave_q24);
        assert_memory_equal(wave[i].rgb_q14, w.rgb_q14, sizeof w.rgb_q14);
        assert_true(
            fabs(glint_real_value(wave[i].weight) / glint_real_value(w.weight) -
                 1) < 0x1p-24);
    }
}

/* Checks the weights of wavelengths against double precision, for the flux
 * polynomial of a real lens and for a constant one. Wavelengths outside the
 * model's band must get the weight at its nearer end. */
TEST(wavelength_weights_match_double_precision)
{
    static const double lens_flux[6] = {312.4, -41.2, -10.7, 2.9, -0.4, 0.01};
    static const double flat[6] = {1e-3};

    set_lens_header(50, 36, 24);
    check_wavelength_fluxes(lens_flux);
    check_wavelength_fluxes(flat);
    header.wave_hi_q24 = (int32_t)(0x1p24 / (0.5 * 0.5));
    header.wave_lo_q24 = (int32_t)(0x1p24 / (0.6 * 0.6));
    check_wavelength_fluxes(lens_flux);
}

/* Checks that weights are 0, not undefined, if the model has no light. */
TEST(weights_without_light_are_0)
{
    struct glint_wave wave[GLINT_FLARE_WAVES];

    set_lens_header(50, 36, 24);
    glint_flare_waves(wave, &lens);
    for (int i = 0; i < GLINT_FLARE_WAVES; i++)
        assert_int_equal(wave[i].weight.mantissa, 0);
}
