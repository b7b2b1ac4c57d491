/* SPDX-License-Identifier: MIT
 *
 * Checks that the samples of image files are read as linear light, that adding
 * light changes them correctly, and that everything else is preserved.
 */
#include "formats/samples.h"
#include "support/test.h"

static struct glint_image proxy;

/* Returns a description of WIDTH x HEIGHT pixels at MEM: three channels of
 * type SAMPLE, or four with alpha. */
static struct glint_samples describe_samples(int width, int height,
                                             enum glint_sample sample,
                                             bool has_alpha, void *mem)
{
    const size_t bytes = glint_sample_get_bytes(sample);
    struct glint_samples s = {.width = width,
                              .height = height,
                              .window_width = width,
                              .window_height = height,
                              .orientation = 1,
                              .pixel_bytes = bytes * (has_alpha ? 4 : 3),
                              .n_colours = 3,
                              .has_alpha = has_alpha,
                              .alpha = {sample, 3 * bytes},
                              .maximum = bytes == 1 ? 255 : 65535,
                              .mem = mem};

    for (size_t c = 0; c < 3; c++)
        s.colour[c] = (struct glint_sample_place){sample, c * bytes};
    glint_colours_set_bt709(&s.colours,
                            glint_sample_is_float(sample) ? GLINT_TONE_IS_LINEAR
                                                          : GLINT_TONE_IS_SRGB,
                            0, "");
    return s;
}

TEST(half_floats_round_trip)
{
    for (unsigned i = 0; i < 65536; i++) {
        const float value = glint_half_decode((uint16_t)i);

        if (!isnan(value))
            assert_int_equal(glint_half_encode(value), i);
    }
    assert_int_equal(glint_half_encode(1), 0x3c00);
    assert_int_equal(glint_half_encode(65520), 0x7c00);
    /* ties round to even */
    assert_int_equal(glint_half_encode(1.00048828125F), 0x3c00);
    assert_int_equal(glint_half_encode(-0x1p-25F), 0x8000);
    assert_true(isnan(glint_half_decode(glint_half_encode(NAN))));
}

/* Checks results computed by hand: sRGB 0.5 is 0.21404 in linear light, BT.709
 * 0.5 is 0.25959. */
TEST(tone_curves_match_hand_computation)
{
    struct glint_tone_curve t;

    glint_tone_curve_set(&t, GLINT_TONE_IS_SRGB, 0);
    assert_true(fabs(glint_tone_curve_decode(&t, 0.5) - 0.21404) < 1e-5);
    assert_true(fabs(glint_tone_curve_decode(&t, 0.02) - 0.001548) < 1e-6);
    assert_true(fabs(glint_tone_curve_encode(&t, 0.21404) - 0.5) < 1e-5);
    glint_tone_curve_set(&t, GLINT_TONE_IS_BT709, 0);
    assert_true(fabs(glint_tone_curve_decode(&t, 0.5) - 0.25959) < 1e-5);
    glint_tone_curve_set(&t, GLINT_TONE_IS_GAMMA, 2);
    assert_true(fabs(glint_tone_curve_decode(&t, -0.5) + 0.25) < 1e-9);
    /* In PQ 203 cd/m2 are code 0.58069, and 1000 cd/m2 are 0.75183 [ITU-R
     * BT.2408]. */
    glint_tone_curve_set(&t, GLINT_TONE_IS_PQ, 0);
    assert_true(fabs(glint_tone_curve_decode(&t, 0.58069) - 1) < 1e-4);
    assert_true(fabs(glint_tone_curve_encode(&t, 1000 / 203.0) - 0.75183) <
                1e-4);
    assert_true(glint_tone_curve_decode(&t, 0) == 0);
    glint_tone_curve_set(&t, GLINT_TONE_IS_HLG, 0);
    assert_true(fabs(glint_tone_curve_decode(&t, 0.75) - 1) < 1e-6);
    assert_true(fabs(glint_tone_curve_encode(&t, 3.7741178) - 1) < 1e-6);
    assert_true(fabs(glint_tone_curve_decode(&t, 0.5) - 0.31451) < 1e-5);
}

static void write_be32(uint8_t *at, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(v >> (24 - 8 * i));
}

/* Writes an ICC profile with the primaries of Adobe RGB and a gamma of
 * GAMMA_Q8. Returns its size in bytes. */
static size_t write_icc_profile(uint8_t p[400], unsigned gamma_q8)
{
    static const char *const names[] = {"rXYZ", "gXYZ", "bXYZ",
                                        "rTRC", "gTRC", "bTRC"};
    static const int xyz_q16[3][3] = {
        {39965, 20399, 1275}, {13447, 41003, 3989}, {9781, 4134, 48787}};

    memset(p, 0, 400);
    memcpy(p + 16, "RGB XYZ ", 8);
    memcpy(p + 36, "acsp", 4);
    write_be32(p + 128, 6);
    for (int i = 0; i < 6; i++) {
        const int at = i < 3 ? 204 + 20 * i : 264;

        memcpy(p + 132 + 12 * i, names[i], 4);
        write_be32(p + 136 + 12 * i, (uint32_t)at);
        write_be32(p + 140 + 12 * i, i < 3 ? 20 : 14);
        memcpy(p + at, i < 3 ? "XYZ " : "curv", 4);
        for (int k = 0; k < 3 && i < 3; k++)
            write_be32(p + at + 8 + 4 * k, (uint32_t)xyz_q16[i][k]);
    }
    write_be32(p + 272, 1);
    p[276] = (uint8_t)(gamma_q8 >> 8);
    p[277] = (uint8_t)gamma_q8;
    return 400;
}

/* Checks results computed by hand: Adobe RGB 0.5 is 0.5^2.19922 = 0.21776 in
 * linear light, and Adobe green contributes -0.398 to sRGB red. */
TEST(icc_profile_matches_hand_computation)
{
    struct glint_colours c;
    uint8_t p[400];

    write_icc_profile(p, 563);
    assert_true(glint_icc_read_colours(&c, p, sizeof p));
    assert_false(c.is_srgb);
    assert_true(fabs(glint_tone_curve_decode(&c.transfer[1], 0.5) - 0.21776) <
                1e-4);
    assert_true(fabs(c.to_bt709[0][1] + 0.3983) < 2e-3);
    assert_true(fabs(c.to_bt709[0][0] + c.to_bt709[0][1] + c.to_bt709[0][2] -
                     1) < 2e-3);
    assert_false(glint_icc_read_colours(&c, p, 100));
    memcpy(p + 16, "CMYK", 4);
    assert_false(glint_icc_read_colours(&c, p, sizeof p));
    /* a truncated profile is not read beyond its end */
    for (size_t n = 0; n < 400; n++) {
        write_icc_profile(p, 563);
        uint8_t *const exact = malloc(n + 1);

        memcpy(exact, p, n);
        (void)glint_icc_read_colours(&c, exact, n);
        free(exact);
    }
}

/* Checks that the lookup table of a tone curve accepts any float, and continues
 * the curve outside its range. */
TEST(curve_table_accepts_any_float)
{
    struct glint_tone_curve t = {
        .gamma = 1, .a = 1, .n_entries = 3, .entry = {0, 16384, 65535}};

    assert_true(fabs(glint_tone_curve_decode(&t, 0.5) - 0.25) < 1e-4);
    assert_true(fabs(glint_tone_curve_decode(&t, -0.5) + 0.25) < 1e-4);
    assert_true(glint_tone_curve_decode(&t, 1) == 1);
    assert_true(glint_tone_curve_decode(&t, 2) > 1);
    assert_true(isinf(glint_tone_curve_decode(&t, HUGE_VAL)));
    assert_true(isnan(glint_tone_curve_decode(&t, (double)NAN)));
}

TEST(light_is_added)
{
    uint16_t mem[] = {0, 1000, 65535, 32768, 32768, 32768};
    uint16_t before[6];
    struct glint_samples s =
        describe_samples(2, 1, GLINT_SAMPLE_U16, false, mem);
    float layer[6] = {0};

    memcpy(before, mem, sizeof mem);
    glint_samples_add_light(&s, layer);
    assert_memory_equal(mem, before, sizeof mem);
    layer[0] = layer[2] = 0.5F;
    glint_samples_add_light(&s, layer);
    assert_int_equal(mem[0], 48192); /* 65535 * 0.735358 */
    assert_int_equal(mem[1], 1000);
    assert_int_equal(mem[2], 65535);
    assert_memory_equal(mem + 3, before + 3, 6);
}

/* Checks that float samples may exceed white, and that NaN is preserved. */
TEST(floats_keep_their_range)
{
    float mem[] = {2, -0.25F, NAN};
    struct glint_samples s =
        describe_samples(1, 1, GLINT_SAMPLE_FLOAT, false, mem);
    const float layer[] = {0.5F, 0.5F, 0.5F};
    double white;

    assert_ok(glint_samples_make_proxy(&s, &proxy, &white));
    assert_true(white >= 2); /* this pixel is the brightest 1 % */
    assert_int_equal(proxy.plane[0][1], 0);
    assert_int_equal(proxy.plane[0][2], 0);
    free(proxy.plane[0]);
    glint_samples_add_light(&s, layer);
    assert_true(mem[0] >= 2.5F && mem[0] <= 2.5F);
    assert_true(mem[1] >= 0.25F && mem[1] <= 0.25F);
    assert_true(isnan(mem[2]));
}

/* Checks that transparent pixels count as dark, unless their colours are
 * premultiplied by alpha, and that alpha is preserved. */
TEST(transparent_pixels_count_as_dark)
{
    uint8_t mem[] = {255, 255, 255, 0, 200, 200, 200, 255};
    struct glint_samples s = describe_samples(2, 1, GLINT_SAMPLE_U8, true, mem);
    const float layer[] = {1, 1, 1, 0.01F, 0.01F, 0.01F};
    double white;

    assert_ok(glint_samples_make_proxy(&s, &proxy, &white));
    assert_int_equal(proxy.plane[0][0], 0);
    assert_int_equal(proxy.plane[0][3], 200);
    free(proxy.plane[0]);
    s.is_premultiplied = true;
    assert_ok(glint_samples_make_proxy(&s, &proxy, &white));
    assert_int_equal(proxy.plane[0][0], 255);
    free(proxy.plane[0]);
    glint_samples_add_light(&s, layer);
    assert_int_equal(mem[3], 0);
    assert_int_equal(mem[7], 255);
    assert_in_range(mem[4], 201, 203);
}

static void expect_float_near(float is, double wanted)
{
    assert_true(fabs((double)is - wanted) < 1e-6);
}

/* An object of coverage 0.5 and light 0.5 is composited over a pixel of alpha
 * 0.25 and light 0.2. Checks the alpha and the light of the result, for
 * straight and for premultiplied alpha. */
TEST(compositing_updates_alpha)
{
    const double behind = 0.25 * 0.2, light = 0.5 * behind + 0.5 * 0.5;
    const double rgb[3] = {light, light, light}, alpha = 1 - 0.75 * 0.5;

    for (int premultiplied = 0; premultiplied < 2; premultiplied++) {
        float mem[8] = {0, 0, 0, 0.25F, 9, 9, 9, 0.5F}, seen[3];
        struct glint_samples s =
            describe_samples(2, 1, GLINT_SAMPLE_FLOAT, true, mem);

        s.is_premultiplied = premultiplied;
        mem[0] = mem[1] = mem[2] = premultiplied ? 0.05F : 0.2F;
        glint_samples_get_light(&s, 0, 0, seen);
        expect_float_near(seen[0], behind);
        glint_samples_set_pixel(&s, 0, 0, rgb, 0.5);
        expect_float_near(mem[3], alpha);
        expect_float_near(mem[0], premultiplied ? light : light / alpha);
        glint_samples_get_light(&s, 0, 0, seen);
        expect_float_near(seen[0], light);
        expect_float_near(mem[7], 0.5);
        /* Light of coverage 0 changes neither alpha nor the colour of a fully
         * transparent pixel. */
        mem[3] = 0;
        glint_samples_set_pixel(&s, 0, 0, rgb, 0);
        expect_float_near(mem[3], 0);
        expect_float_near(mem[0], light);
        glint_samples_set_pixel(&s, 0, 0, rgb, 1);
        expect_float_near(mem[3], 1);
    }
}

/* Checks the 8 EXIF orientations of an image stored as 2 x 3 pixels. Each
 * string contains the letters of the stored pixels in the order of the upright
 * image. */
TEST(every_exif_orientation_is_upright)
{
    static const char *const upright[] = {"abcdef", "badcfe", "fedcba",
                                          "efcdab", "acebdf", "ecafdb",
                                          "fdbeca", "bdface"};
    uint8_t mem[18];

    for (int i = 0; i < 18; i++)
        mem[i] = (uint8_t)("abcdef"[i / 3]);
    for (int o = 1; o <= 8; o++) {
        struct glint_samples s =
            describe_samples(2, 3, GLINT_SAMPLE_U8, false, mem);
        double white;

        s.orientation = o;
        assert_ok(glint_samples_make_proxy(&s, &proxy, &white));
        assert_int_equal(proxy.width, o < 5 ? 2 : 3);
        for (int i = 0; i < 6; i++)
            assert_int_equal(proxy.plane[0][3 * i], upright[o - 1][i]);
        free(proxy.plane[0]);
    }
}

/* Checks an EXR image whose data window (2 x 1 pixels) begins left of the
 * display window (1 x 2 pixels) and does not cover its second row. */
TEST(exr_data_window_may_differ)
{
    float mem[] = {1, 1, 1, 0.5F, 0.5F, 0.5F};
    struct glint_samples s =
        describe_samples(2, 1, GLINT_SAMPLE_FLOAT, false, mem);
    const float layer[] = {4, 4, 4, 4, 4, 4};
    struct glint_image image;
    float rgb[3];

    s.x = -1; /* the second pixel is the first one inside the display window */
    s.window_width = 1;
    s.window_height = 2;
    glint_samples_get_light(&s, 0, 0, rgb);
    assert_true(rgb[0] >= 0.5F && rgb[0] <= 0.5F);
    glint_samples_get_light(&s, 0, 1, rgb);
    assert_true(rgb[0] <= 0);
    assert_false(glint_samples_get_image(&s, &image));
    glint_samples_add_light(&s, layer);
    assert_true(mem[0] <= 1 && mem[3] >= 4.5F);
}

/* Checks conversion from 8 bits with straight alpha to floats with
 * premultiplied alpha, and back. If the destination has no alpha, pixels are
 * composited over black. */
TEST(straight_and_premultiplied_alpha_convert)
{
    uint8_t mem[] = {188, 0, 255, 128}, back[4], flat[3];
    float floats[4];
    struct glint_samples from =
        describe_samples(1, 1, GLINT_SAMPLE_U8, true, mem);
    struct glint_samples to =
        describe_samples(1, 1, GLINT_SAMPLE_FLOAT, true, floats);
    struct glint_samples again =
        describe_samples(1, 1, GLINT_SAMPLE_U8, true, back);
    struct glint_samples opaque =
        describe_samples(1, 1, GLINT_SAMPLE_U8, false, flat);

    to.is_premultiplied = true;
    glint_samples_convert(&to, &from);
    assert_true(fabsf(floats[0] - 0.50289F * 0.50196F) < 1e-4F);
    assert_true(fabsf(floats[3] - 0.50196F) < 1e-4F);
    glint_samples_convert(&again, &to);
    assert_memory_equal(back, mem, 4);
    glint_samples_convert(&opaque, &from);
    assert_int_equal(flat[2], 188); /* the sRGB code of half of white */
}
