/* SPDX-License-Identifier: MIT
 *
 * Checks the automatic exposure: it gives the flare of one lamp or of many the
 * expected brightness, changes gradually from frame to frame, and uses the
 * lens's response.
 */
#include "engine/setup/spectrum.h"
#include "engine/strength.h"
#include "support/settings_frame.h"
#include "support/test.h"

static struct glint_frame frame;

static struct tool tool = {.name = "test", .quiet = true, .n_threads = 1};

enum { PIXELS = 1000000, FRAME_US = 40000 };

/* Power of a lamp, in units of one white pixel, whose flare gets a peak of a
 * quarter of white by default, with the lens responses made below. */
static const double common = PIXELS / 8.0;

/* factors by which the last exposure has limited the ghosts of each lamp */
static double part[16];

/* Returns a lens response (flare per lamp power) whose peak falls by a factor
 * of 2^SLOPE from the axis to 20 degrees, and whose mean is 2^-MEAN of the
 * peak. */
static struct glint_response make_lens_response(double slope, double mean)
{
    struct glint_response r = {.n = 3, .theta_deg = {0, 10, 20}};

    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) {
            r.log2_of[i].peak[c] = -2 - slope * i / 2;
            r.log2_of[i].mean[c] = r.log2_of[i].peak[c] - mean;
        }
    return r;
}

static struct glint_engine_lamp make_lamp_at_angle(double theta_deg,
                                                   double power)
{
    const struct glint_lamp lamp = {theta_deg, 30, power, {1, 1, 1}, {0, 0}, 0};

    return glint_engine_lamp_of(&lamp, 1);
}

/* Returns the peak of the flare of N lamps after exposure, US microseconds
 * after the previous frame. level[i], 0 .. 1, is the fade level of lamp i. */
static double exposed_peak(struct glint_strength *s,
                           const struct glint_response *r,
                           struct glint_engine_lamp *lamps, const double *level,
                           int n, int us)
{
    const struct glint_strength_lamps all = {lamps, part, n, PIXELS};

    for (int i = 0; i < n; i++)
        lamps[i].level = level ? level[i] : 1;
    glint_strength_expose_frame(s, r, &all, us);
    return glint_largest_channel(s->light.peak);
}

static double peak_of_still(double asked, const struct glint_response *r,
                            double theta, double power)
{
    struct glint_engine_lamp lamp = make_lamp_at_angle(theta, power);
    struct glint_strength s;

    glint_strength_set_defaults(&s);
    s.asked = asked;
    return exposed_peak(&s, r, &lamp, NULL, 1, 0);
}

/* ------------------------------------------------------------ still images */

static struct glint_strength strength;

TEST_BEFORE
{
    glint_strength_set_defaults(&strength);
}

TEST(peak_is_a_quarter_of_white_by_default)
{
    const struct glint_response r = make_lens_response(0, 7);

    assert_true(fabs(peak_of_still(0.5, &r, 5, common) - 0.25) < 1e-4);
    assert_true(fabs(peak_of_still(1, &r, 5, common) - 1) < 1e-3);
    assert_true(fabs(peak_of_still(0.25, &r, 5, common) - 0.0625) < 1e-4);
    assert_true(peak_of_still(0, &r, 5, common) == 0);
}

TEST(peak_rises_with_strength)
{
    const struct glint_response r = make_lens_response(3, 4);
    double last = 0;

    for (double asked = 0.01; asked < 4; asked *= 1.1) {
        const double peak = peak_of_still(asked, &r, 12, 1e5);

        assert_true(peak > last);
        last = peak;
    }
}

/* Checks that for any lamp power the peak of the flare is within a factor of
 * two of a quarter of white, and increases with the power. */
TEST(any_lamp_power_gives_a_visible_flare)
{
    const struct glint_response r = make_lens_response(8, 7);
    double last = 0;

    for (double stops = -4; stops <= 40; stops++) {
        const double peak = peak_of_still(0.5, &r, 12, exp2(stops));

        assert_true(peak >= 0.124 && peak <= 0.501);
        assert_true(peak > last);
        last = peak;
    }
}

TEST(veil_is_limited_by_its_mean)
{
    const struct glint_response r = make_lens_response(0, 0.5);
    struct glint_engine_lamp lamp = make_lamp_at_angle(5, PIXELS);
    const struct glint_strength_lamps all = {&lamp, part, 1, PIXELS};

    glint_strength_expose_frame(&strength, &r, &all, 0);
    assert_true(fabs(glint_largest_channel(strength.light.mean) - 0.015) <
                1e-6);
}

TEST(power_ratios_between_lamps_are_kept)
{
    const struct glint_response r = make_lens_response(5, 7);
    struct glint_engine_lamp lamps[2] = {make_lamp_at_angle(5, 1e6),
                                         make_lamp_at_angle(9, 1e3)};
    const struct glint_strength_lamps all = {lamps, part, 2, PIXELS};

    glint_strength_expose_frame(&strength, &r, &all, 0);
    assert_true(part[0] == 1 && part[1] == 1);
}

TEST(many_equal_lamps_share_the_exposure)
{
    const struct glint_response r = make_lens_response(0, 9);
    struct glint_engine_lamp lamps[16];
    double one, each;

    for (int i = 0; i < 16; i++)
        lamps[i] = make_lamp_at_angle(i, 1e4);
    one = peak_of_still(0.5, &r, 1, 1e4);
    each =
        exposed_peak(&strength, &r, lamps, NULL, 16, 0) / 2; /* 2 = 16^(1/4) */
    assert_true(each > one / 2.2 && each < one);
}

TEST(exposure_matches_hand_computation)
{
    const struct glint_response r = make_lens_response(0, 7);
    struct glint_engine_lamp lamp = make_lamp_at_angle(5, common);
    const struct glint_strength_lamps all = {&lamp, part, 1, PIXELS};

    strength.is_physical = true;
    strength.exposure_ev = 3;
    strength.gain = 0.5;
    glint_strength_expose_frame(&strength, &r, &all, 0);
    assert_true(strength.scale == 4);
    assert_true(fabs(glint_largest_channel(strength.light.peak) - 0.125) <
                1e-9);
    strength.gain = 0;
    glint_strength_expose_frame(&strength, &r, &all, 0);
    assert_true(strength.scale == 0);
    strength = (struct glint_strength){.asked = 0.5, .gain = 2};
    glint_strength_expose_frame(&strength, &r, &all, 0);
    assert_true(fabs(glint_largest_channel(strength.light.peak) - 0.5) < 1e-3);
}

TEST(lamps_without_light_give_a_finite_exposure)
{
    const struct glint_response r = make_lens_response(0, 7);
    struct glint_engine_lamp lamp = make_lamp_at_angle(5, 0);
    const struct glint_strength_lamps all = {&lamp, part, 1, PIXELS};
    const struct glint_strength_lamps none = {NULL, NULL, 0, PIXELS};

    glint_strength_expose_frame(&strength, &r, &all, 0);
    assert_true(isfinite(strength.scale));
    assert_true(glint_largest_channel(strength.light.peak) == 0);
    glint_strength_expose_frame(&strength, &r, &none, 0);
    assert_true(strength.scale == 0);
}

/* Corrects the exposure of a still image whose flare is 2^STOPS times as bright
 * as the response predicts and has a mean of 2^-MEAN_STOPS of its peak. Returns
 * the corrected peak. */
static double compute_corrected_flare_peak(double asked, double stops,
                                           double mean_stops)
{
    const struct glint_response r = make_lens_response(0, 7);
    struct glint_response_light drawn = {{0}, {0}};
    struct glint_strength s;
    struct glint_engine_lamp lamp = make_lamp_at_angle(5, common);

    glint_strength_set_defaults(&s);
    s.asked = asked;
    exposed_peak(&s, &r, &lamp, NULL, 1, 0);
    assert_false(s.is_drawn);
    drawn.peak[1] = exp2(stops - 5);
    drawn.mean[1] = exp2(stops - 5 - mean_stops);
    glint_strength_correct_exposure(&s, &drawn, NULL);
    assert_true(s.is_drawn == (asked > 0));
    assert_true(s.light.mean[1] < 0.0151);
    assert_true(asked <= 0 ||
                fabs(s.light.peak[1] / (s.scale * drawn.peak[1]) - 1) < 1e-9);
    return s.light.peak[1];
}

TEST(exposure_is_corrected_to_the_drawn_flare)
{
    assert_true(fabs(compute_corrected_flare_peak(0.5, 0, 7) - 0.25) < 1e-4);
    for (double stops = -12; stops <= 12; stops++) {
        const double peak = compute_corrected_flare_peak(0.5, stops, 7);

        assert_true(peak > 0.124 && peak < 0.501);
        /* the mean of a veil is limited */
        assert_true(fabs(compute_corrected_flare_peak(0.5, stops, 0.5) -
                         0.015 * exp2(0.5)) < 1e-6);
    }
    assert_true(compute_corrected_flare_peak(0, 3, 7) == 0);
}

/* Checks that a physical exposure is not corrected, nor a flare without
 * light. */
TEST(physical_exposure_is_not_corrected)
{
    const struct glint_response_light bright = {{9, 9, 9}, {1, 1, 1}};
    const struct glint_response_light none = {{0}, {0}};
    const struct glint_response r = make_lens_response(0, 7);
    struct glint_engine_lamp lamp = make_lamp_at_angle(5, common);
    double scale;

    exposed_peak(&strength, &r, &lamp, NULL, 1, 0);
    scale = strength.scale;
    glint_strength_correct_exposure(&strength, &none, NULL);
    assert_true(strength.scale == scale && !strength.is_drawn);
    strength.is_physical = true;
    glint_strength_correct_exposure(&strength, &bright, NULL);
    assert_true(strength.scale == scale && !strength.is_drawn);
}

/* ------------------------------------------------------------------- videos */

/* Moves a lamp across the image in 200 frames. Checks that per frame the lamp's
 * flare changes by at most the change of the lens response plus the max step of
 * the exposure factor. */
TEST(crossing_lamp_changes_gradually)
{
    const struct glint_response r = make_lens_response(7, 7);
    double last = 0;

    for (int i = 0; i <= 200; i++) {
        struct glint_engine_lamp lamp =
            make_lamp_at_angle(fabs(20 - i * 0.2), 1e5);
        const double peak =
            exposed_peak(&strength, &r, &lamp, NULL, 1, FRAME_US);

        assert_true(peak > 0.1 && peak < 0.5);
        if (i > 0)
            assert_true(fabs(log2(peak / last)) < 0.07 + 0.125);
        last = peak;
    }
}

/* Checks a sun that appears among lamps: the exposure factor of all lamps falls
 * gradually; meanwhile the light of the sun is limited. */
TEST(rising_sun_lowers_the_factor_gradually)
{
    const struct glint_response r = make_lens_response(0, 7);
    double scale = 0;

    for (int i = 0; i < 250; i++) {
        struct glint_engine_lamp lamps[2] = {make_lamp_at_angle(5, 1e3),
                                             make_lamp_at_angle(8, 1e6)};
        const double level[2] = {1, fmin(1, (i - 49) / 5.0)};
        const double peak =
            exposed_peak(&strength, &r, lamps, level, i < 50 ? 1 : 2, FRAME_US);

        assert_true(peak > 0.1 && peak < 0.8);
        if (i > 0)
            assert_true(fabs(log2(strength.scale / scale)) < 0.126);
        scale = strength.scale;
        if (i == 50) /* The sun's ghosts are limited to 1/100. */
            assert_true(part[1] < 0.01);
        if (i == 249)
            assert_true(part[1] > 0.99);
        assert_true(lamps[1].lamp.power == 1e6);
    }
}

/* Checks that the exposure factor rises again after the sun has left, more
 * slowly than it fell. */
TEST(leaving_sun_raises_the_factor_slowly)
{
    const struct glint_response r = make_lens_response(0, 7);
    double scale, first;

    {
        struct glint_engine_lamp lamps[2] = {make_lamp_at_angle(5, 1e3),
                                             make_lamp_at_angle(8, 1e6)};

        exposed_peak(&strength, &r, lamps, NULL, 2, 0);
        first = scale = strength.scale;
    }
    for (int i = 0; i < 250; i++) {
        struct glint_engine_lamp lamp = make_lamp_at_angle(5, 1e3);

        exposed_peak(&strength, &r, &lamp, NULL, 1, FRAME_US);
        assert_true(strength.scale >= scale &&
                    strength.scale / scale < exp2(0.081));
        scale = strength.scale;
    }
    assert_true(scale > 300 * first);
}

/* Checks that the flare of a single lamp fades with the lamp: the exposure does
 * not compensate for the fading. */
TEST(single_lamp_follows_its_level)
{
    const struct glint_response r = make_lens_response(0, 7);
    double last = 0;

    for (int i = 1; i <= 8; i++) {
        const double level = i / 8.0;
        struct glint_engine_lamp lamp = make_lamp_at_angle(5, level * common);
        const double peak =
            exposed_peak(&strength, &r, &lamp, &level, 1, FRAME_US);

        assert_true(fabs(peak - 0.25 * level) < 0.01);
        assert_true(peak > last);
        last = peak;
    }
}

/* Checks that the exposure adapts without delay after a cut and after frames
 * without a lamp. */
TEST(exposure_adapts_at_once_after_a_cut)
{
    const struct glint_response r = make_lens_response(0, 7);
    struct glint_engine_lamp faint = make_lamp_at_angle(5, 10),
                             bright = make_lamp_at_angle(5, common);

    exposed_peak(&strength, &r, &faint, NULL, 1, FRAME_US);
    assert_true(exposed_peak(&strength, &r, &bright, NULL, 1, FRAME_US) > 0.3);
    assert_true(part[0] < 1);
    bright = make_lamp_at_angle(5, common);
    assert_true(fabs(exposed_peak(&strength, &r, &bright, NULL, 1, 0) - 0.25) <
                1e-4);
    exposed_peak(&strength, &r, &faint, NULL, 0, FRAME_US);
    assert_true(exposed_peak(&strength, &r, &faint, NULL, 1, FRAME_US) > 0.1);
}

/* Checks that a strength set in a key frame applies in this frame, also after
 * frames of strength 0, during which the exposure continues to adapt. */
TEST(strength_of_key_frames_applies_at_once)
{
    static const double asked[] = {0.5, 1, 0.05, 0, 0, 2, 0.5};
    const struct glint_response r = make_lens_response(0, 7);
    struct glint_strength s;

    glint_strength_set_defaults(&s);
    for (int i = 0; i < 7; i++) {
        struct glint_engine_lamp lamp = make_lamp_at_angle(5, common);

        s.asked = asked[i];
        assert_true(fabs(exposed_peak(&s, &r, &lamp, NULL, 1, FRAME_US) -
                         asked[i] * asked[i]) < 1e-3);
    }
    s.asked = 0;
    for (int i = 0; i < 250; i++) {
        struct glint_engine_lamp lamp = make_lamp_at_angle(5, 64 * common);

        exposed_peak(&s, &r, &lamp, NULL, 1, FRAME_US);
        assert_true(s.scale == 0);
    }
    {
        struct glint_engine_lamp lamp = make_lamp_at_angle(5, 64 * common);

        s.asked = 0.5;
        assert_true(fabs(exposed_peak(&s, &r, &lamp, NULL, 1, FRAME_US) -
                         peak_of_still(0.5, &r, 5, 64 * common)) < 1e-3);
        assert_true(part[0] > 0.998);
    }
}

/* ------------------------------------------------------------------- lenses */

/* Draws one lamp at several angles and powers with automatic exposure, and
 * checks that the response of LENS predicts the peak of each flare. */
static void check_automatic_exposure_of_lens(const char *lens,
                                             double corner_deg)
{
    struct opened opened = {.lens = {.tints = NULL}};
    struct glint_response r;

    settings_set_defaults(&opened.settings);
    opened.settings.coating.kind = COATING_TABLE;
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings, lens));
    assert_ok(make_frame_from_settings(&tool, &opened, 640, 360, &frame));
    assert_ok(glint_response_measure(&frame, 0, HUGE_VAL, &r));
    assert_true(r.n == GLINT_RESPONSE_ANGLES);
    for (int i = 0; i < 6; i++) {
        struct glint_engine_lamp lamp =
            make_lamp_at_angle(corner_deg * i / 6, exp2(5 * i - 4) * 100);
        const struct glint_strength_lamps all = {&lamp, part, 1, 640 * 360};
        struct glint_response_light drawn;
        struct glint_strength s;

        /* at these azimuths the lamp is inside the image */
        lamp.lamp.phi_deg = 29 + 180 * (i % 2);
        glint_strength_set_defaults(&s);
        glint_strength_expose_frame(&s, &r, &all, 0);
        assert_ok(glint_response_draw_and_measure(
            &frame, &lamp.lamp, 1, GLINT_RESPONSE_FINE, NULL, &drawn, NULL));
        /* The bounds are wide because FINE measures the brightest 1e-4 of the
         * pixels, the response the brightest 1e-3. */
        assert_true(s.scale * glint_largest_channel(drawn.peak) > 1 / 16.0 ||
                    s.scale * glint_largest_channel(drawn.mean) > 0.01);
        assert_true(s.scale * glint_largest_channel(drawn.peak) < 2);
        assert_true(s.scale * glint_largest_channel(drawn.mean) < 0.02);
    }
    glint_frame_finish(&frame);
    opened_lens_close(&opened.lens);
}

TEST(automatic_exposure_suits_real_lenses)
{
    check_automatic_exposure_of_lens("lenses/heliar-tronnier.lens", 11.8);
    check_automatic_exposure_of_lens("lenses/double-gauss-angenieux.lens",
                                     22.4);
    check_automatic_exposure_of_lens("lenses/nikon-zoom-mid.lens", 12.5);
}

/* Checks that the lens response measured within the memory limits of glint live
 * equals the response without limits. */
TEST(response_is_the_same_in_little_memory)
{
    struct opened opened = {.lens = {.tints = NULL}};
    struct glint_response r, free;

    settings_set_defaults(&opened.settings);
    opened.settings.coating.kind = COATING_TABLE;
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
    assert_ok(make_frame_from_settings(&tool, &opened, 640, 360, &frame));
    assert_ok(glint_response_measure(&frame, 2 << 20, HUGE_VAL, &r));
    assert_ok(glint_response_measure(&frame, 0, HUGE_VAL, &free));
    glint_frame_finish(&frame);
    for (int i = 0; i < r.n; i++)
        assert_memory_equal(&r.log2_of[i], &free.log2_of[i],
                            sizeof r.log2_of[i]);
    opened_lens_close(&opened.lens);
}

/* Checks a response by exact rays that was measured for lamps up to an extent:
 * it equals the complete one up to there, reports larger extents as missing,
 * and has for them the softening of the largest measured extent. */
TEST(exact_response_is_measured_as_far_as_lamps_need)
{
    struct opened opened = {.lens = {.tints = NULL}};
    struct glint_response all, few;
    struct glint_lamp lamp = {0, 0, 1, {1, 1, 1}, {0, 0}, 0};

    settings_set_defaults(&opened.settings);
    opened.settings.coating.kind = COATING_TABLE;
    opened.settings.options.rays = GLINT_RAYS_EXACT;
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
    assert_ok(make_frame_from_settings(&tool, &opened, 640, 360, &frame));
    assert_ok(glint_response_measure(&frame, 0, HUGE_VAL, &all));
    assert_ok(glint_response_measure(&frame, 0, all.extent[2], &few));
    glint_frame_finish(&frame);
    assert_true(all.extent[2] > 0 && all.softened_log2[3] < 0);
    assert_true(glint_response_has_extent(&all, 1));
    assert_true(glint_response_has_extent(&few, all.extent[2]));
    assert_false(glint_response_has_extent(&few, 1.01 * all.extent[2]));
    for (int i = 0; i < GLINT_RESPONSE_EXTENTS; i++) {
        const int k = i < 2 ? i : 2;

        lamp.axis[0] = all.extent[i];
        assert_true(fabs(log2(glint_response_compute_softening(&all, &lamp)) -
                         all.softened_log2[i]) < 1e-9);
        assert_true(fabs(log2(glint_response_compute_softening(&few, &lamp)) -
                         all.softened_log2[k]) < 1e-9);
    }
    opened_lens_close(&opened.lens);
}

TEST(response_is_interpolated_between_angles)
{
    const struct glint_response r = make_lens_response(4, 6);
    struct glint_response_light light;

    glint_response_interpolate_light(&r, 10, &light);
    assert_true(fabs(log2(light.peak[0]) + 4) < 1e-9);
    glint_response_interpolate_light(&r, 15, &light);
    assert_true(fabs(log2(light.peak[1]) + 5) < 1e-9);
    assert_true(fabs(log2(light.mean[1]) + 11) < 1e-9);
    glint_response_interpolate_light(&r, 60, &light);
    assert_true(fabs(log2(light.peak[2]) + 6) < 1e-9);
}

TEST(response_peak_skips_the_brightest_pixels)
{
    float rgb[3 * 4000];
    struct glint_response_light light;

    for (int i = 0; i < 4000; i++) {
        rgb[3 * i] = (float)i;
        rgb[3 * i + 1] = i == 7 ? 8 : 0;
        rgb[3 * i + 2] = 2;
    }
    /* the peak is the mean of the brightest 1e-3, here four of 4000 pixels */
    glint_response_around(rgb, 4000, &light);
    assert_true(light.peak[0] == 3997.5 && light.mean[0] == 1999.5);
    assert_true(light.peak[1] == 2 && light.mean[1] == 0.002);
    assert_true(light.peak[2] == 2 && light.mean[2] == 2);
}

TEST_OPEN
{
    assert_ok(tool_start_threads(&tool));
}
