/* SPDX-License-Identifier: MIT
 *
 * Tests how glint live adapts the quality to the frame rate, on simulated
 * machines with a given frame time per quality step.
 */
#include "glint/quality.h"
#include "live/live_adapt.h"
#include "support/test.h"

#define PERIOD_MS (1000. / 30)

static struct live_adapt adapt;

/* Counters and times of a simulated run. */
static struct seen {
    int n_frames, n_missed;
    int n_down, n_up;
    double first_down_s, last_change_s;
} seen;

/* Simulates SECONDS on a machine that draws a frame of quality step S in
 * cost_ms[S]. A frame that takes longer than a frame period misses the frames
 * that arrive meanwhile. */
static void simulate_machine_for_seconds(const double *cost_ms, double seconds)
{
    double now_s = 0;

    seen = (struct seen){.first_down_s = -1, .last_change_s = -1};
    while (now_s < seconds) {
        const int before = adapt.step;
        const double cost = cost_ms[before];
        const int n_missed = cost > PERIOD_MS ? (int)(cost / PERIOD_MS) : 0;
        const bool changed =
            live_adapt_add_frame(&adapt, cost, PERIOD_MS, n_missed);

        now_s += 1e-3 * PERIOD_MS * (1 + n_missed);
        seen.n_frames++;
        seen.n_missed += n_missed;
        assert_in_range(adapt.step, 0, LIVE_MAX_STEP);
        assert_int_equal(changed, adapt.step != before);
        if (!changed)
            continue;
        if (adapt.step > before) {
            const int by = adapt.step - before;

            assert_in_range(by, 1, cost <= 2 * PERIOD_MS ? 1 : 4);
            seen.n_down += by;
        } else {
            const int by = before - adapt.step;

            assert_in_range(
                by, 1, adapt.futile_s > 0 || cost < PERIOD_MS / 3.6 ? 7 : 1);
            seen.n_up += by;
        }
        seen.last_change_s = now_s;
        if (seen.first_down_s < 0 && adapt.step > before)
            seen.first_down_s = now_s;
    }
}

TEST_BEFORE
{
    live_adapt_init(&adapt);
}

TEST(enough_time_keeps_step_0)
{
    static const double cost[8] = {25, 20, 15, 10, 8, 6, 5, 4};

    simulate_machine_for_seconds(cost, 600);
    assert_int_equal(adapt.step, 0);
    assert_true(seen.last_change_s < 0); /* the step never changed */
}

/* Checks that missed frames of less than half a second lower the quality by one
 * step, or by several steps if a frame takes more than two frame periods. */
TEST(misses_reduce_the_quality)
{
    static const double cost[8] = {80, 70, 45, 26, 20, 15, 10, 5};

    simulate_machine_for_seconds(cost, 3);
    assert_int_equal(adapt.step, 3);
    assert_true(seen.first_down_s > 0.2 && seen.first_down_s < 0.5);
    assert_true(seen.last_change_s < 1.5);
    simulate_machine_for_seconds(
        /* The step must not change, as there is no spare time for a finer
         * step. */
        cost, 600);
    assert_int_equal(adapt.step, 3);
    assert_int_equal(seen.n_down, 0);
    assert_int_equal(seen.n_missed, 0);
}

TEST(too_slow_machine_stays_at_the_last_step)
{
    static const double cost[8] = {900, 800, 700, 600, 500, 400, 300, 200};
    static const double none[8] = {0, 0, 0, 0, 0, 0, 0, 0};

    simulate_machine_for_seconds(cost, 600);
    assert_int_equal(adapt.step, LIVE_MAX_STEP);
    assert_int_equal(seen.n_down, LIVE_MAX_STEP);
    simulate_machine_for_seconds(none, 600);
    assert_int_equal(adapt.step, 0);
    assert_int_equal(seen.n_up, LIVE_MAX_STEP);
}

/* Returns the number of seconds of ten minutes that do not end at STEP. */
static int count_seconds_off_step(const double *cost, int step)
{
    int n = 0;

    live_adapt_init(&adapt);
    for (int i = 0; i < 600; i++) {
        simulate_machine_for_seconds(cost, 1);
        n += adapt.step != step;
    }
    return n;
}

/* Checks that quality returns to the finest step if lower ones save no time, as
 * with exact rays, and that this is tried less and less. */
TEST(futile_steps_are_taken_back)
{
    static const double cost[8] = {55, 54, 55, 53, 54, 52, 54, 53};

    assert_in_range(count_seconds_off_step(cost, 0), 1, 60);
}

/* Checks that quality returns to the step from which on lower ones save no
 * time. */
TEST(useful_steps_stay)
{
    static const double cost[8] = {150, 100, 70, 50, 51, 49, 50, 50};

    assert_in_range(count_seconds_off_step(cost, 3), 1, 30);
}

/* Checks that a load with which lowering saved no time does not keep a greater
 * load from lowering quality. */
TEST(load_that_grows_lowers_the_quality)
{
    static const double flat[8] = {55, 54, 55, 53, 54, 52, 54, 53};
    static const double heavy[8] = {90, 80, 60, 26, 20, 15, 10, 5};

    simulate_machine_for_seconds(flat, 300);
    assert_int_equal(adapt.step, 0);
    simulate_machine_for_seconds(heavy, 3);
    assert_int_equal(adapt.step, 3);
}

/* Checks that the first frame, however long it takes, is ignored. */
TEST(slow_first_frame_changes_nothing)
{
    assert_false(live_adapt_add_frame(&adapt, 12000, PERIOD_MS, 0));
    assert_false(live_adapt_add_frame(&adapt, 9, PERIOD_MS, 360));
    assert_int_equal(adapt.step, 0);
}

/* Checks that frames that the camera loses do not lower the quality if drawing
 * takes little time. */
TEST(frames_lost_by_the_camera_change_nothing)
{
    for (int i = 0; i < 100; i++)
        assert_false(live_adapt_add_frame(&adapt, 5, PERIOD_MS, 2));
}

/* Checks that quality rises by several steps if there is much time. */
TEST(quality_recovers_fast_from_idle_load)
{
    static const double heavy[8] = {900, 800, 700, 600, 500, 400, 300, 200};
    static const double light[8] = {4, 4, 3, 3, 2, 2, 1, 1};

    simulate_machine_for_seconds(heavy, 10);
    assert_int_equal(adapt.step, LIVE_MAX_STEP);
    simulate_machine_for_seconds(light, 5);
    assert_int_equal(adapt.step, 0);
}

/* Checks that a single slow frame, as when an image is saved, does not change
 * the quality step. */
TEST(single_slow_frame_changes_nothing)
{
    static const double cost[8] = {20, 15, 10, 8, 6, 5, 4, 3};

    simulate_machine_for_seconds(cost, 0.2);
    assert_false(live_adapt_add_frame(&adapt, 30, PERIOD_MS, 0));
    simulate_machine_for_seconds(cost, 10);
    assert_int_equal(adapt.step, 0);
    assert_int_equal(seen.n_down, 0);
}

/* Checks that after a burst of many lights the quality returns to the first
 * step, within a few seconds per step. */
TEST(quality_recovers_after_a_burst)
{
    static const double heavy[8] = {150, 120, 90, 70, 50, 29, 20, 10};
    static const double light[8] = {10, 9, 8, 7, 6, 5, 4, 3};

    simulate_machine_for_seconds(heavy, 4);
    assert_int_equal(adapt.step, 5);
    simulate_machine_for_seconds(light, 15);
    assert_int_equal(adapt.step, 0);
    assert_int_equal(seen.n_down, 0);
}

/* Checks that a finer step that is too slow is tried at increasing
 * intervals. */
TEST(slow_step_is_tried_less_and_less)
{
    static const double cost[8] = {70, 50, 40, 12, 8, 6, 5, 4};
    int n_early;

    simulate_machine_for_seconds(cost, 60);
    n_early = seen.n_up;
    assert_int_equal(adapt.step, 3);
    assert_in_range(n_early, 1, 6);
    simulate_machine_for_seconds(cost, 600);
    assert_in_range(seen.n_up, 5, 12); /* once per minute */
    assert_true(seen.n_missed < seen.n_frames / 100);
}

TEST(slow_step_is_tried_again_later)
{
    static const double heavy[8] = {70, 50, 40, 12, 8, 6, 5, 4};
    static const double light[8] = {10, 9, 8, 7, 6, 5, 4, 3};

    simulate_machine_for_seconds(heavy, 300);
    /* the wait before a retry grows to at most a minute, and starts again at
     * its first value */
    simulate_machine_for_seconds(light, 75);
    assert_int_equal(adapt.step, 0);
}

/* Checks that step 0 has the requested quality parameters, and that no step is
 * finer than the one before. */
TEST(steps_become_coarser)
{
    static const struct glint_dials ask[] = {
        {64, 69, 1024, 256, 128, 0, 0.125, 7, 0, 0, 10, {0}},
        {8, 1, 0, 0, 1, 0, 0, 1, 0, 0.5, 10, {0}},
        {4, 2, 0, 0, 2, 0, 40, 1, 0, 2, 10, {0}},
        {1024, 4096, 0, 64, 9, 0, 1, 61, 0, 0, 10, {0}},
        {64, 0, 1024, 0, 128, 0, 0.5, 7, 0, 0, 10, {0}},
        {17, 3, 1, 256, 64, 0, 0.2, 2, 0, 0.1, 10, {0}}};

    for (size_t i = 0; i < sizeof ask / sizeof *ask; i++) {
        struct glint_dials last = ask[i];

        for (int s = 0; s <= LIVE_MAX_STEP; s++) {
            struct glint_dials d;

            adapt.step = s;
            d = live_adapt_coarsen_parameters(&adapt, ask[i]);
            if (s == 0)
                assert_memory_equal(&d, &ask[i], sizeof d);
            /* steps above 3 draw at half resolution */
            assert_int_equal(glint_dials_half(&d), s > 3);
            assert_in_range(d.fineness, 1, last.fineness);
            assert_in_range(d.max_lights, 1, last.max_lights);
            assert_in_range(d.snap_codes_q8, last.snap_codes_q8, 1 << 15);
            assert_true(d.cull_codes >= last.cull_codes);
            assert_true(d.area_points <= last.area_points);
            assert_true(d.still_px >= last.still_px);
            assert_true(d.irradiance_steps <= last.irradiance_steps);
            assert_int_equal(d.irradiance_steps == 0,
                             ask[i].irradiance_steps == 0);
            last = d;
        }
    }
}
