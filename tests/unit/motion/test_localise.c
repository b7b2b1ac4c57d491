/* SPDX-License-Identifier: MIT
 *
 * Tests how a body is localised by the foods (landmarks) that it observes, for
 * the four body motions of tests/support/tracks.
 */
#include "reference/motion/four.h"
#include "support/rng.h"
#include "support/test.h"
#include "support/tracks/tracks.h"

static struct glint_located located;

enum { FRAMES = 20000, SEED = 163635 };

struct errors {
    /* RMS error of the first and of the last tenth of the track */
    double first, last;
    double worst;
    /* correlation of the position error with the mean distance of the foods
     * (landmarks) from the body */
    double correlation;
    int n; /* number of frames until localisation failed */
};

/* Localises the body on a track. With FOUR, uses the method of four foods
 * (landmarks), otherwise the method of all foods, ALL. */
static struct errors measure_pose_errors(const struct track_options *options,
                                         struct glint_localiser *all,
                                         struct four *four)
{
    struct errors e = {.n = 0};
    struct track track;
    double s[5] = {0};

    track_begin_motion(&track, options);
    for (int i = 0; i < options->n_frames; i++) {
        struct track_frame f;
        const double(*const seen)[3] = (const double(*)[3])f.seen;
        double square = 0;

        track_next_frame(&track, &f);
        if (four ? four_localise_by_landmarks(four, options->n_foods, seen,
                                              f.is_new, &located)
                 : glint_localise_body(all, options->n_foods, seen, f.is_new,
                                       &located))
            break;
        for (int k = 0; k < 3; k++)
            square += (located.pose.at[k] - f.pose.at[k]) *
                      (located.pose.at[k] - f.pose.at[k]);
        if (i < options->n_frames / 10)
            e.first += square / (options->n_frames / 10);
        if (i >= options->n_frames / 10 * 9)
            e.last += square / (options->n_frames / 10);
        e.worst = fmax(e.worst, sqrt(square));
        s[0] += sqrt(square);
        s[1] += f.food_distance;
        s[2] += square;
        s[3] += f.food_distance * f.food_distance;
        s[4] += sqrt(square) * f.food_distance;
        e.n++;
    }
    e.first = sqrt(e.first);
    e.last = sqrt(e.last);
    e.correlation =
        (s[4] - s[0] * s[1] / e.n) /
        sqrt((s[2] - s[0] * s[0] / e.n) * (s[3] - s[1] * s[1] / e.n));
    return e;
}

static struct errors
measure_errors_of_four_foods(const struct track_options *options,
                             enum four_fit fit, enum four_arithmetic arithmetic)
{
    struct four four;

    four_init_localiser(&four, fit, arithmetic);
    return measure_pose_errors(options, NULL, &four);
}

static struct errors
measure_errors_of_all_foods(const struct track_options *options, bool average)
{
    struct glint_localiser all;

    glint_localiser_init(&all, average);
    return measure_pose_errors(options, &all, NULL);
}

static struct track_options make_track_options(int motion, int reset_every,
                                               int digits)
{
    return (struct track_options){
        motion, FRAMES, 5, reset_every, digits, (uint32_t)(SEED + motion)};
}

/* With the weights of four foods (landmarks), errors are about 1e-6 in float32
 * and do not grow with time. */
TEST(row_d1_four_foods_do_not_drift)
{
    for (int m = 0; m < TRACK_MOTIONS; m++) {
        const struct track_options o = make_track_options(m, 0, 0);
        const struct errors f =
            measure_errors_of_four_foods(&o, FOUR_FIRST, FOUR_FLOAT32);
        const struct errors d =
            measure_errors_of_four_foods(&o, FOUR_FIRST, FOUR_DOUBLE);

        print_message("  motion %d: float32 %.1e, double %.1e\n", m, f.last,
                      d.last);
        assert_int_equal(f.n, FRAMES);
        assert_true(f.last > 1e-7 && f.last < 1e-5);
        assert_true(f.last < 3 * f.first);
        assert_true(d.worst < 1e-12);
    }
}

/* If the motions from frame to frame are chained, the error grows with time. */
TEST(row_d2_the_chain_drifts)
{
    for (int m = 0; m < TRACK_MOTIONS; m++) {
        const struct track_options o = make_track_options(m, 0, 0);
        const struct errors c =
            measure_errors_of_four_foods(&o, FOUR_CHAIN, FOUR_FLOAT32);
        const struct errors f =
            measure_errors_of_four_foods(&o, FOUR_FIRST, FOUR_FLOAT32);

        print_message("  motion %d: %.1e, then %.1e\n", m, c.first, c.last);
        assert_int_equal(c.n, FRAMES);
        assert_true(c.first > 1e-5 && c.first < 1e-2);
        assert_true(c.last > 2 * c.first);
        assert_true(c.last > 100 * f.last);
    }
}

/* Some foods (landmarks) end and others appear. Rigid fits, and averages over a
 * food's lifetime, keep the error below 1e-4. The error of the published
 * solution is a thousand times as large. */
TEST(row_d5_resets_keep_the_error_small)
{
    for (int m = 0; m < TRACK_MOTIONS; m++) {
        const struct track_options o = make_track_options(m, 200, 6);
        const struct errors life = measure_errors_of_all_foods(&o, true);
        const struct errors all = measure_errors_of_all_foods(&o, false);
        const struct errors four =
            measure_errors_of_four_foods(&o, FOUR_FIRST, FOUR_DOUBLE);
        const struct errors best =
            measure_errors_of_four_foods(&o, FOUR_BEST, FOUR_DOUBLE);

        print_message("  motion %d: life mean %.1e, all %.1e, first4 %.1e, "
                      "best4 %.1e\n",
                      m, life.last, all.last, four.last, best.last);
        assert_true(life.last < 1e-4 && life.worst < 2e-4);
        assert_true(life.last < all.last && all.last < four.last);
        assert_true(best.last < 2 * four.last);
        assert_true(four.last < 15e-2);
    }
}

/* Errors correlate only weakly with the mean distance of the foods
 * (landmarks). */
TEST(row_d6_error_depends_weakly_on_food_distance)
{
    for (int m = 0; m < TRACK_MOTIONS; m++) {
        const struct track_options o = make_track_options(m, 0, 0);
        const struct errors e =
            measure_errors_of_four_foods(&o, FOUR_FIRST, FOUR_FLOAT32);

        print_message("  motion %d: %.2f\n", m, e.correlation);
        assert_true(e.correlation > .1 && e.correlation < .7);
    }
}

/* Checks that two foods (landmarks) may vanish in one frame if five were
 * detected, which leaves three, and one food if four were. */
TEST(two_foods_may_vanish_at_once)
{
    struct track_options o = make_track_options(0, 0, 0);
    struct glint_localiser l;
    struct four four;
    struct track track;
    struct track_frame f;
    const bool two[5] = {false, true, false, true, false};
    const bool three[5] = {true, true, false, true, false};

    glint_localiser_init(&l, true);
    track_begin_motion(&track, &o);
    for (int i = 0; i < 100; i++) {
        track_next_frame(&track, &f);
        assert_null(glint_localise_body(&l, 5, (const double(*)[3])f.seen,
                                        i == 50 ? two : f.is_new, &located));
        for (int k = 0; k < 3; k++)
            assert_true(fabs(located.pose.at[k] - f.pose.at[k]) < 1e-12);
    }
    assert_non_null(strstr(
        glint_localise_body(&l, 5, (const double(*)[3])f.seen, three, &located),
        "three food items"));
    four_init_localiser(&four, FOUR_FIRST, FOUR_DOUBLE);
    assert_null(four_localise_by_landmarks(&four, 5, (const double(*)[3])f.seen,
                                           f.is_new, &located));
    assert_non_null(
        strstr(four_localise_by_landmarks(&four, 5, (const double(*)[3])f.seen,
                                          two, &located),
               "four foods"));
}

/* Checks that collinear foods (landmarks) are rejected, and with the method of
 * four foods also coplanar ones. The limit must be exact to 2^-20. */
TEST(rejects_collinear_and_coplanar_foods)
{
    const double line[4][3] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}};
    double flat[5][3] = {
        {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 4, 1e-6}, {1, 1, 0}};
    const bool none[5] = {false};
    struct glint_localiser l;
    struct four four;

    glint_localiser_init(&l, true);
    assert_null(glint_localise_body(&l, 4, line, none, &located));
    assert_non_null(
        strstr(glint_localise_body(&l, 4, line, none, &located), "on a line"));
    for (int k = 0; k < 2; k++) {
        four_init_localiser(&four, FOUR_FIRST, FOUR_DOUBLE);
        assert_null(four_localise_by_landmarks(
            &four, 5, (const double(*)[3])flat, none, &located));
        if (k == 0)
            assert_non_null(
                strstr(four_localise_by_landmarks(
                           &four, 5, (const double(*)[3])flat, none, &located),
                       "in a plane"));
        else
            assert_null(four_localise_by_landmarks(
                &four, 5, (const double(*)[3])flat, none, &located));
        flat[3][2] = 1e-4;
    }
}

/* Checks that float arithmetic emulated by rounding doubles is bit-identical
 * with float. */
TEST(rounded_doubles_equal_floats)
{
    uint32_t seed = 3;

    for (int i = 0; i < 100000; i++) {
        const float a = (float)(rng_unit(&seed) * 30 - 15);
        const float b = (float)(rng_unit(&seed) * 30 - 15);
        const volatile float product = a * b, sum = a + b, ratio = a / b;

        assert_true(four_round_value(FOUR_FLOAT32, (double)a * (double)b) ==
                    (double)product);
        assert_true(four_round_value(FOUR_FLOAT32, (double)a + (double)b) ==
                    (double)sum);
        assert_true(four_round_value(FOUR_FLOAT32, (double)a / (double)b) ==
                    (double)ratio);
    }
}
