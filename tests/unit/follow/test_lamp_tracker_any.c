/* SPDX-License-Identifier: MIT
 *
 * Tests tracking with random input: results stay within limits and do not
 * depend on the order of spots (lamps found in one frame).
 */

#include "support/night.h"
#include "support/rng.h"
#include "support/test.h"

static struct night night;

static struct glint_spot make_random_spot(void)
{
    static const int32_t extremes[] = {INT32_MIN, -1, 0, 1, INT32_MAX};
    struct glint_spot s = {.x_q8 = rng_int_below(&night.seed, 640 << 8),
                           .y_q8 = rng_int_below(&night.seed, 480 << 8),
                           .size_q8 = rng_int_below(&night.seed, 40 << 8),
                           .area = rng_int_below(&night.seed, 4000),
                           .n_clipped = rng_int_below(&night.seed, 2000),
                           .flux_q16 = rng_int_below(&night.seed, 1 << 24) * 64,
                           .power_q16 =
                               rng_int_below(&night.seed, 1 << 24) * 64,
                           .axis_q8 = {rng_int_below(&night.seed, 40 << 8),
                                       rng_int_below(&night.seed, 40 << 8)},
                           .cos_q15 = rng_int_below(&night.seed, 32769),
                           .sin_q15 = rng_int_below(&night.seed, 65537) - 32768,
                           .faint = rng_int_below(&night.seed, 3) == 0};

    for (int i = 0; i < 3; i++)
        s.rgb_q15[i] = rng_int_below(&night.seed, 1 << 17);
    if (rng_int_below(&night.seed, 10) == 0)
        s.flux_q16 = rng_int_below(&night.seed, 2) ? INT64_MAX : INT64_MIN;
    if (rng_int_below(&night.seed, 10) == 0)
        s.power_q16 = rng_int_below(&night.seed, 2) ? INT64_MAX : INT64_MIN;
    if (rng_int_below(&night.seed, 10) == 0)
        s.axis_q8[0] = s.axis_q8[1] = s.cos_q15 = s.sin_q15 =
            extremes[rng_int_below(&night.seed, 5)];
    if (rng_int_below(&night.seed, 10) == 0)
        s.x_q8 = extremes[rng_int_below(&night.seed, 5)];
    if (rng_int_below(&night.seed, 10) == 0)
        s.y_q8 = extremes[rng_int_below(&night.seed, 5)];
    if (rng_int_below(&night.seed, 10) == 0)
        s.size_q8 = s.area = s.n_clipped = s.rgb_q15[1] =
            extremes[rng_int_below(&night.seed, 5)];
    return s;
}

static int32_t random_elapsed_us(void)
{
    static const int32_t times[] = {0,     1,       1000,      16667,
                                    33333, 1000000, INT32_MAX, -1};

    return times[rng_int_below(&night.seed, 8)];
}

static void assert_tracks_are_valid(int n)
{
    for (int i = 0; i < n; i++) {
        const struct glint_lamp_track *t = &night.track[i];

        assert_in_range(t->level_q15, 1, 1 << 15);
        assert_true(t->flux_q16 >= 0 && t->flux_q16 <= INT64_C(1) << 42);
        assert_true(t->power_q16 >= 0 && t->power_q16 <= INT64_C(1) << 42);
        assert_true(t->size_q8 >= 0 && t->axis_q8[0] >= 0 &&
                    t->axis_q8[1] >= 0);
        for (int c = 0; c < 3; c++)
            assert_true(t->rgb_q15[c] >= 0);
        for (int j = 0; j < i; j++)
            assert_true(night.track[j].id != t->id);
    }
}

/* Copies the spots SPOT[N] to MIXED in random order. */
static void shuffle_spots(struct glint_spot *mixed,
                          const struct glint_spot *spot, int n)
{
    for (int i = 0; i < n; i++) {
        const int j = rng_int_below(&night.seed, i + 1);

        mixed[i] = mixed[j];
        mixed[j] = spot[i];
    }
}

/* Checks that two trackers give the same tracks for the same spots in different
 * order. Some spots recur in the next step, slightly moved. */
TEST(order_of_spots_changes_nothing)
{
    static struct glint_spot spot[NIGHT_MAX], mixed[NIGHT_MAX];
    static struct glint_lamp_track track[NIGHT_MAX];
    struct glint_lamp_tracker *other;
    void *mem;

    for (int round = 0; round < 40; round++) {
        int n = 0;

        night_init_parameters(&night, 640, 480);
        night.seed = (uint32_t)round;
        night.cfg.max_tracks = 1 + rng_int_below(&night.seed, 64);
        night.cfg.max_shown =
            1 + rng_int_below(&night.seed, night.cfg.max_tracks);
        assert_true(night_open_tracker(&night));
        assert_int_equal(
            posix_memalign(&mem, 64, glint_lamp_tracker_bytes(&night.cfg)), 0);
        memset(mem, 0xa5, glint_lamp_tracker_bytes(&night.cfg));
        assert_ok(glint_lamp_tracker_init(
            &other, &night.cfg, mem, glint_lamp_tracker_bytes(&night.cfg)));
        for (int step = 0; step < 50; step++) {
            const int32_t us = random_elapsed_us();
            const int n_new =
                rng_int_below(&night.seed, round % 4 ? 100 : NIGHT_MAX);
            int n_tracks;

            for (int i = 0; i < n_new; i++) {
                if (i >= n || rng_int_below(&night.seed, 4) == 0)
                    spot[i] = make_random_spot();
                else if (spot[i].x_q8 > 0 && spot[i].x_q8 < 600 << 8)
                    spot[i].x_q8 += rng_int_below(&night.seed, 2048);
            }
            n = n_new;
            /* Some spots are equal, and one differs from them only in its flag
             * `faint`. */
            if (n > 3)
                spot[1] = spot[0], spot[2] = spot[0], spot[2].faint ^= 1;
            shuffle_spots(mixed, spot, n);
            night.n_tracks = glint_lamp_tracker_step(night.tracks, spot, n, us,
                                                     night.track, NIGHT_MAX);
            n_tracks =
                glint_lamp_tracker_step(other, mixed, n, us, track, NIGHT_MAX);
            assert_int_equal(n_tracks, night.n_tracks);
            assert_memory_equal(track, night.track,
                                (size_t)n_tracks * sizeof *track);
            assert_tracks_are_valid(n_tracks);
            if (rng_int_below(&night.seed, 20) == 0) {
                glint_lamp_tracker_restart(night.tracks);
                glint_lamp_tracker_restart(other);
            }
        }
        free(mem);
        night_close_tracker(&night);
    }
}
