/* SPDX-License-Identifier: MIT
 *
 * Tests merging many lights into few: the result does not depend on their
 * order, light is preserved, bright lights do not move, and the result has at
 * most the requested number.
 */
#include "base/real.h"
#include "glint/flare.h"
#include "support/shuffle.h"
#include "support/test.h"

/* NEAR_Q30: the distance up to which lights are merged. It is about 1/8 pixel
 * if the tangent 1 is 2000 pixels wide. */
enum { MANY = 3000, NEAR_Q30 = 60000 };

static struct glint_real convert_double_to_real(double x)
{
    int exponent;
    const double fraction = frexp(x, &exponent);

    return real_of((int64_t)(fraction * 0x1p40), exponent - 40);
}

static int32_t encode_q30(double x)
{
    return (int32_t)lrint(x * 0x1p30);
}

/* Returns a light of power POWER. Its direction has the sines X and Y along the
 * axes of the image. */
static struct glint_light make_light(double x, double y, double power)
{
    const double sine = hypot(x, y);

    return (struct glint_light){
        .sine_q30 = encode_q30(sine),
        .cosine_q30 = encode_q30(sqrt(1 - sine * sine)),
        .cos_q30 = sine > 0 ? encode_q30(x / sine) : 1 << 30,
        .sin_q30 = sine > 0 ? encode_q30(y / sine) : 0,
        .power = convert_double_to_real(power),
        .rgb_q14 = {16384, 16384, 16384},
    };
}

static double random_unit_q30(uint32_t *state)
{
    return rng_xorshift(state) * 0x1p-32;
}

/* Fills B with lights of powers 1e-6 to 1e9, most of them weak. Some lights
 * coincide; some are on the axis and have random azimuths. */
static void fill_with_random_lights(struct glint_light *b, int n, uint32_t seed)
{
    for (int i = 0; i < n; i++) {
        const double x = 0.6 * (random_unit_q30(&seed) - 0.5);
        const double y = 0.4 * (random_unit_q30(&seed) - 0.5);
        const double power = pow(10, -6 + 15 * pow(random_unit_q30(&seed), 4));

        b[i] = make_light(x, y, power);
        for (int c = 0; c < 3; c++)
            b[i].rgb_q14[c] = (int32_t)(rng_xorshift(&seed) % 16385);
        b[i].rgb_q14[rng_xorshift(&seed) % 3] = 16384;
        if (i % 100 == 7)
            b[i] = b[i - 1];
        if (i % 100 == 9) {
            b[i].sine_q30 = 0;
            b[i].cosine_q30 = 1 << 30;
        }
    }
}

static void shuffle_lights(struct glint_light *b, int n, uint32_t seed)
{
    for (int i = n - 1; i > 0; i--) {
        const int j = (int)(rng_xorshift(&seed) % (uint32_t)(i + 1));
        const struct glint_light old = b[i];

        b[i] = b[j];
        b[j] = old;
    }
}

static void sum_light_flux(const struct glint_light *b, int n, double flux[3])
{
    flux[0] = flux[1] = flux[2] = 0;
    for (int i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            flux[c] += glint_real_value(b[i].power) * b[i].rgb_q14[c] / 16384;
}

/* Checks the invariants of a light that drawing relies on: unit vectors, a
 * normalised power, a largest colour component of 1. */
static void assert_light_is_valid(const struct glint_light *b)
{
    const double off = hypot(b->sine_q30, b->cosine_q30) * 0x1p-30;
    const double round = hypot(b->cos_q30, b->sin_q30) * 0x1p-30;
    int32_t most = 0;

    assert_true(b->sine_q30 >= 0 && b->cosine_q30 >= 0);
    assert_true(fabs(off - 1) < 0x1p-27 && fabs(round - 1) < 0x1p-27);
    assert_true(b->power.mantissa >= 1 << 30);
    for (int c = 0; c < 3; c++)
        most = b->rgb_q14[c] > most ? b->rgb_q14[c] : most;
    assert_int_equal(most, 16384);
}

/* ----------------------------------------------------------------- merging */

TEST(no_light_and_one_light_are_unchanged)
{
    struct glint_light b = make_light(0.1, -0.2, 3), was = b;
    int apart = 7;

    b.rgb_q14[1] = 12345;
    was = b;
    assert_int_equal(glint_lights_merge(&b, 0, NEAR_Q30, 5, &apart), 0);
    assert_int_equal(apart, 0);
    assert_int_equal(glint_lights_merge(&b, 1, NEAR_Q30, 1, &apart), 1);
    assert_int_equal(apart, 1);
    assert_memory_equal(&b, &was, sizeof b);
    b.power = real_of(0, 0);
    assert_int_equal(glint_lights_merge(&b, 1, NEAR_Q30, 1, &apart), 0);
    b = was;
    memset(b.rgb_q14, 0, sizeof b.rgb_q14);
    assert_int_equal(glint_lights_merge(&b, 1, NEAR_Q30, 1, &apart), 0);
}

/* Merges two lights at the same position, in either order. Checks that the
 * merged light keeps the larger of their two merge distances. */
TEST(merge_distance_is_the_larger_of_two)
{
    for (int order = 0; order < 2; order++) {
        struct glint_light b[2] = {make_light(0.1, 0, 3),
                                   make_light(0.1, 0, 3)};
        int apart;

        b[order].apart_q30 = 77;
        assert_int_equal(glint_lights_merge(b, 2, NEAR_Q30, 2, &apart), 1);
        assert_int_equal(b[0].apart_q30, 77);
    }
}

/* Checks that lights are unchanged bit by bit if their number is within the
 * limit and they are too far apart to be merged. */
TEST(distant_lights_are_unchanged)
{
    static struct glint_light b[200], was[200];
    int apart, found = 0;

    for (int i = 0; i < 200; i++) {
        b[i] = make_light(0.001 * (i % 20), 0.003 * (i / 20) - 0.01, 1 + i);
        b[i].rgb_q14[i % 3] = i;
    }
    memcpy(was, b, sizeof b);
    assert_int_equal(glint_lights_merge(b, 200, NEAR_Q30, 200, &apart), 200);
    assert_int_equal(apart, 200);
    for (int i = 0; i < 200; i++) {
        assert_true(i == 0 || !real_less(b[i - 1].power, b[i].power));
        for (int j = 0; j < 200; j++)
            found += !memcmp(&b[i], &was[j], sizeof *b);
    }
    assert_int_equal(found, 200);
}

TEST(identical_lights_are_merged)
{
    static struct glint_light b[MANY];
    const struct glint_light one = make_light(-0.11, 0.23, 0.5);
    int apart;

    for (int i = 0; i < MANY; i++)
        b[i] = one;
    assert_int_equal(glint_lights_merge(b, MANY, 0, MANY, &apart), 1);
    assert_int_equal(apart, 1);
    assert_light_is_valid(b);
    assert_true(abs(b->sine_q30 - one.sine_q30) < 64 &&
                abs(b->cos_q30 - one.cos_q30) < 256);
    assert_true(fabs(glint_real_value(b->power) - 0.5 * MANY) < 1e-5 * MANY);
}

/* Returns the chord (length of the difference) between the unit vectors with
 * the sines (X, Y) and (P, Q). */
static double compute_chord_between_directions(double x, double y, double p,
                                               double q)
{
    const double z = sqrt(1 - x * x - y * y) - sqrt(1 - p * p - q * q);

    return sqrt((x - p) * (x - p) + (y - q) * (y - q) + z * z);
}

/* Checks that two lights nearer than NEAR_Q30 are merged at their centroid,
 * weighted by power, and that lights further apart are not merged. */
TEST(near_lights_merge_at_their_centroid)
{
    const double near = NEAR_Q30 * 0x1p-30;
    uint32_t seed = 5;
    int apart, n_merged = 0;

    for (int k = 0; k < 2000; k++) {
        const double x = random_unit_q30(&seed) - 0.5,
                     y = random_unit_q30(&seed) - 0.5;
        const double dx = 2 * near * (random_unit_q30(&seed) - 0.5);
        const double dy = 2 * near * (random_unit_q30(&seed) - 0.5);
        const double d = compute_chord_between_directions(x, y, x + dx, y + dy);
        struct glint_light b[2] = {make_light(x, y, 1),
                                   make_light(x + dx, y + dy, 3)};
        const int left = glint_lights_merge(b, 2, NEAR_Q30, 2, &apart);

        if (fabs(d - near) > 0.001 * near)
            assert_int_equal(left, d < near ? 1 : 2);
        assert_int_equal(apart, left);
        if (left == 2)
            continue;
        n_merged++;
        assert_light_is_valid(b);
        assert_true(fabs(glint_real_value(b->power) - 4) < 1e-8);
        assert_true(fabs(b->sine_q30 * 0x1p-60 * b->cos_q30 - x - 0.75 * dx) <
                    1e-8);
        assert_true(fabs(b->sine_q30 * 0x1p-60 * b->sin_q30 - y - 0.75 * dy) <
                    1e-8);
    }
    assert_true(n_merged > 500 && n_merged < 1800);
}

TEST(lights_on_the_axis_are_merged)
{
    struct glint_light b[4] = {make_light(0, 0, 1), make_light(0, 0, 1),
                               make_light(2e-9, 0, 1), make_light(-2e-9, 0, 1)};
    struct glint_light far[2] = {make_light(0.1, 0, 1), make_light(-0.1, 0, 1)};
    struct glint_light aside[2] = {make_light(2e-9, 0, 1),
                                   make_light(0, 2e-9, 1)};
    int apart;

    b[1].cos_q30 = -(1 << 29);
    b[1].sin_q30 = 929887697; /* sine of an azimuth of 120 degrees, Q30 */
    assert_int_equal(glint_lights_merge(b, 4, NEAR_Q30, 4, &apart), 1);
    assert_light_is_valid(b);
    assert_true(b->sine_q30 <= 2);
    assert_true(fabs(glint_real_value(b->power) - 4) < 1e-8);
    assert_int_equal(glint_lights_merge(far, 2, NEAR_Q30, 1, &apart), 1);
    assert_int_equal(apart, 2);
    assert_light_is_valid(far);
    assert_true(far->sine_q30 <= 2);
    assert_int_equal(glint_lights_merge(aside, 2, NEAR_Q30, 1, &apart), 1);
    assert_light_is_valid(aside);
}

TEST(lights_at_the_horizon_merge_to_valid_ones)
{
    struct glint_light b[3] = {make_light(1, 0, 1), make_light(-1, 0, 1),
                               make_light(0, 1, 1)};
    int apart;

    assert_int_equal(glint_lights_merge(b, 2, 1 << 30, 1, &apart), 1);
    assert_light_is_valid(b);
    b[0] = make_light(1, 0, 1);
    b[1] = make_light(-1, 0, 1);
    assert_int_equal(glint_lights_merge(b, 3, NEAR_Q30, 1, &apart), 1);
    assert_light_is_valid(b);
}

/* Checks that the result is bit-identical for any order of the lights, whatever
 * the max number of merged lights. */
TEST(merging_does_not_depend_on_order)
{
    static struct glint_light want[MANY], got[MANY];

    for (uint32_t k = 0; k < 24; k++) {
        const int n = k < 12 ? MANY : 400, most = 1 + (int)(k * k) % n;
        int apart, apart_again, left;

        fill_with_random_lights(want, n, 77 + k / 3);
        memcpy(got, want, sizeof got);
        shuffle_lights(got, n, 1000 + k);
        left = glint_lights_merge(want, n, NEAR_Q30, most, &apart);
        assert_int_equal(
            glint_lights_merge(got, n, NEAR_Q30, most, &apart_again), left);
        assert_int_equal(apart, apart_again);
        assert_memory_equal(got, want, (size_t)left * sizeof *got);
    }
}

TEST(limit_of_lights_keeps_the_flux)
{
    static struct glint_light b[MANY];

    for (int most = 1; most <= 4096; most *= 2) {
        double before[3], after[3];
        int apart, left;

        fill_with_random_lights(b, MANY, 9);
        sum_light_flux(b, MANY, before);
        left = glint_lights_merge(b, MANY, NEAR_Q30, most, &apart);
        assert_true(apart <= MANY - MANY / 100 && apart > MANY * 9 / 10);
        assert_int_equal(left, most < apart ? most : apart);
        sum_light_flux(b, left, after);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(after[c] - before[c]) < 1e-4 * before[c]);
        for (int i = 0; i < left; i++)
            assert_light_is_valid(&b[i]);
    }
}

/* Checks that when many faint lights are merged with a bright one, rounding the
 * bright light's colour does not lose theirs. */
TEST(colour_of_faint_lights_is_kept)
{
    static struct glint_light b[MANY];
    double flux[3];
    int apart;

    for (int i = 0; i < MANY; i++) {
        b[i] = make_light(0.1, 0.1, 1e-5);
        b[i].rgb_q14[1] = b[i].rgb_q14[2] = 0;
    }
    b[0] = make_light(0.1, 0.1, 1);
    assert_int_equal(glint_lights_merge(b, MANY, NEAR_Q30, 1, &apart), 1);
    sum_light_flux(b, 1, flux);
    assert_true(fabs(flux[0] - 1 - 1e-5 * (MANY - 1)) < 1e-5);
    assert_true(fabs(flux[1] - 1) < 1e-4 && fabs(flux[2] - 1) < 1e-4);
}

/* Checks sums of powers at the ends of their range, far outside it, and of
 * large and small powers together. */
TEST(sums_of_extreme_powers_are_right)
{
    static const double powers[] = {1e-6, 1e9, 1e-55, 1e55};

    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            struct glint_light b[3] = {make_light(0.1, 0.1, powers[i]),
                                       make_light(0.2, 0.1, powers[j]),
                                       make_light(0.1, 0.3, powers[i])};
            const double sum = 2 * powers[i] + powers[j];
            int apart;

            assert_int_equal(glint_lights_merge(b, 3, NEAR_Q30, 1, &apart), 1);
            assert_light_is_valid(b);
            assert_true(fabs(glint_real_value(b->power) - sum) < 1e-8 * sum);
        }
}

/* Checks that merging many faint lights does not move the few bright lights
 * among them. */
TEST(bright_lights_do_not_move)
{
    static struct glint_light b[MANY];
    int apart;

    fill_with_random_lights(b, MANY, 4);
    for (int i = 0; i < MANY; i++)
        b[i].power = convert_double_to_real(0.01);
    for (int i = 0; i < 20; i++)
        b[150 * i] = make_light(0.02 * i - 0.2, 0.15 - 0.01 * i, 100);
    assert_int_equal(glint_lights_merge(b, MANY, NEAR_Q30, 128, &apart), 128);
    for (int i = 0; i < 20; i++) {
        double nearest = 1;

        for (int j = 0; j < 20; j++)
            nearest =
                fmin(nearest, hypot(b[j].sine_q30 * 0x1p-60 * b[j].cos_q30 -
                                        (0.02 * i - 0.2),
                                    b[j].sine_q30 * 0x1p-60 * b[j].sin_q30 -
                                        (0.15 - 0.01 * i)));
        assert_true(nearest < 1e-5);
    }
}
