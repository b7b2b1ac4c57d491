/* SPDX-License-Identifier: MIT
 *
 * Tests the statistics of a live run: percentiles against sorted latencies,
 * sums against hand-computed values, exact output lines, counts above 32 bits.
 */
#include <limits.h>

#include "support/rng.h"
#include "live/live_log.h"
#include "support/test.h"

static struct live_stats stats;
static char text[LIVE_STATS_TEXT];

static void add_frame_of_latency(int64_t us)
{
    const struct live_frame_times t = {.shown = true, .shown_us = us};

    live_stats_add_frame(&stats, &t);
}

static int compare_int64(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;

    return (x > y) - (x < y);
}

/* ------------------------------------------------------------- percentiles */

static void check_latency_percentiles(int n, int64_t low_us, int64_t span_us)
{
    static int64_t us[1000];
    uint32_t seed = (uint32_t)n;

    live_stats_start(&stats, 0);
    for (int i = 0; i < n; i++) {
        const int64_t r = (rng_bits32(&seed) >> 8) % span_us;

        us[i] = low_us + r * r / span_us; /* most latencies are short */
        add_frame_of_latency(us[i]);
    }
    qsort(us, (size_t)n, sizeof *us, compare_int64);
    for (int percent = 1; percent <= 100; percent++) {
        /* rank of the percentile (nearest-rank method), counted from 1 */
        const int rank = (n * percent + 99) / 100;
        const double want = 1e-3 * (double)us[rank - 1];
        const double is = live_stats_latency_ms(&stats.second, percent);

        if (is < want - 0.0501 || is > want + 0.0501)
            fail_msg("%d of %d: %g is not %g", percent, n, is, want);
    }
}

TEST(percentiles_match_sorted_latencies)
{
    for (int n = 1; n <= 1000; n = n < 120 ? n + 1 : n + 97) {
        check_latency_percentiles(n, 0, 1000);
        check_latency_percentiles(n, 12345, 50000);
        check_latency_percentiles(n, 0, 999999);
    }
}

TEST(extreme_latencies_stay_in_range)
{
    live_stats_start(&stats, 0);
    assert_true(live_stats_latency_ms(&stats.second, 50) == -1);
    add_frame_of_latency(-5000);
    assert_true(live_stats_latency_ms(&stats.second, 50) == 0.05);
    add_frame_of_latency(999999);
    assert_true(live_stats_latency_ms(&stats.second, 50) == 0.05);
    assert_true(live_stats_latency_ms(&stats.second, 51) == 999.95);
    for (int i = 0; i < 98; i++)
        add_frame_of_latency(0);
    assert_true(live_stats_latency_ms(&stats.second, 99) == 0.05);
    assert_true(live_stats_latency_ms(&stats.second, 100) == 999.95);
    add_frame_of_latency(INT64_C(3000000000000));
    assert_true(live_stats_latency_ms(&stats.second, 98) == 0.05);
    assert_true(live_stats_latency_ms(&stats.second, 99) == 999.95);
    assert_true(live_stats_latency_ms(&stats.second, 100) == 3e9);
}

/* Checks that when the counter of one bin is full, the counts of all bins are
 * halved. Percentiles and rare latencies must be preserved. */
TEST(full_bin_halves_all_bins)
{
    live_stats_start(&stats, 0);
    stats.total.bin[50] = UINT32_MAX;
    stats.total.bin[60] = UINT32_MAX - 1;
    stats.total.bin[70] = 1;
    add_frame_of_latency(5050);
    assert_int_equal(stats.total.bin[50], 0x80000001);
    assert_int_equal(stats.total.bin[60], 0x7fffffff);
    assert_int_equal(stats.total.bin[70], 1);
    assert_true(live_stats_latency_ms(&stats.total, 50) == 5.05);
    assert_true(live_stats_latency_ms(&stats.total, 51) == 6.05);
    assert_int_equal(stats.second.bin[50], 1);
    /* the sum of all counts exceeds 32 bits, too */
    add_frame_of_latency(2000000);
    stats.total.bin[50] = stats.total.bin[60] = UINT32_MAX;
    stats.total.bin[LIVE_BINS] = UINT32_MAX;
    assert_true(live_stats_latency_ms(&stats.total, 33) == 5.05);
    assert_true(live_stats_latency_ms(&stats.total, 34) == 6.05);
    assert_true(live_stats_latency_ms(&stats.total, 66) == 6.05);
    assert_true(live_stats_latency_ms(&stats.total, 67) == 2000);
}

/* ----------------------------------------------------- sums, printed lines */

static const struct live_frame_times frames[] = {
    {.shown = true,
     .n_dropped = 2,
     .captured_us = 5000000,
     .shown_us = 5012340,
     .stage_us = {100, 1200, 300, 4000, 5000, 600},
     .lights = 3,
     .ghosts = 39,
     .bytes = 1000,
     .quality = 0.5},
    {.shown = true,
     .n_late = 1,
     .captured_us = 5033000,
     .shown_us = 5053000,
     .stage_us = {200, 1400, 500, 4002, 5003, -7},
     .lights = 2,
     .ghosts = 26,
     .bytes = 3000,
     .quality = 0.25,
     .reused = true},
    {.shown = false, .n_corrupt = 4, .stage_us = {99, 99, 99, 99, 99, 99}},
};

static void add_recorded_frames(void)
{
    live_stats_start(&stats, 5000000);
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++)
        live_stats_add_frame(&stats, &frames[i]);
}

TEST(prints_json)
{
    add_recorded_frames();
    assert_string_equal(
        live_stats_write_json(&stats, 6000000, false, text),
        "{\"t\":1.000,\"fps\":2.00,\"frames\":2,\"drops\":2,\"late\":1,"
        "\"corrupt\":4,\"latency_ms_p50\":12.35,\"latency_ms_p99\":20.05,"
        "\"ms\":{\"convert\":0.150,\"find\":1.300,\"plan\":0.400,\"bin\":4.001,"
        "\"draw\":5.002,\"show\":0.300},\"lights\":3,\"ghosts\":39,\"bytes\":"
        "3000,\"quality\":0.375,\"reused\":1}");
}

/* Checks that the statistics of the last second restart each second, while
 * those of the whole run continue. */
TEST(statistics_restart_each_second)
{
    add_recorded_frames();
    assert_false(live_stats_is_second_over(&stats, 5999999));
    assert_true(live_stats_is_second_over(&stats, 6000000));
    live_stats_begin_second(&stats, 6000250);
    assert_false(live_stats_is_second_over(&stats, 7000000));
    live_stats_add_frame(&stats, &frames[1]);
    assert_string_equal(
        live_stats_write_json(&stats, 6500250, false, text),
        "{\"t\":1.500,\"fps\":2.00,\"frames\":1,\"drops\":0,\"late\":1,"
        "\"corrupt\":0,\"latency_ms_p50\":20.05,\"latency_ms_p99\":20.05,"
        "\"ms\":{\"convert\":0.200,\"find\":1.400,\"plan\":0.500,\"bin\":4.002,"
        "\"draw\":5.003,\"show\":0.000},\"lights\":2,\"ghosts\":26,\"bytes\":"
        "3000,\"quality\":0.250,\"reused\":1}");
    assert_string_equal(
        live_stats_write_json(&stats, 9000000, true, text),
        "{\"t\":4.000,\"fps\":0.75,\"frames\":3,\"drops\":2,\"late\":2,"
        "\"corrupt\":4,\"latency_ms_p50\":20.05,\"latency_ms_p99\":20.05,"
        "\"ms\":{\"convert\":0.167,\"find\":1.333,\"plan\":0.433,\"bin\":4.001,"
        "\"draw\":5.002,\"show\":0.200},\"lights\":3,\"ghosts\":39,\"bytes\":"
        "3000,\"quality\":0.333,\"reused\":2,\"total\":true}");
}

TEST(prints_no_frames)
{
    live_stats_start(&stats, 7);
    live_stats_add_frame(&stats, &frames[2]);
    assert_string_equal(
        live_stats_write_json(&stats, 7, true, text),
        "{\"t\":0.000,\"fps\":0.00,\"frames\":0,\"drops\":0,\"late\":0,"
        "\"corrupt\":4,\"latency_ms_p50\":null,\"latency_ms_p99\":null,\"ms\":{"
        "\"convert\":null,\"find\":null,\"plan\":null,\"bin\":null,\"draw\":"
        "null,\"show\":null},\"lights\":0,\"ghosts\":0,\"bytes\":0,\"quality\":"
        "null,\"reused\":0,\"total\":true}");
    assert_string_equal(
        live_stats_write_line(&stats, 1000007, true, text),
        "\r0.0 fps  0 dropped 0 late 4 corrupt  0 lights 0 ghosts\033[K");
}

TEST(prints_a_line)
{
    add_recorded_frames();
    assert_string_equal(live_stats_write_line(&stats, 6000000, true, text),
                        "\r2.0 fps  12.3 ms, p99 20.1  2 dropped 1 late 4 "
                        "corrupt  3 lights 39 ghosts  q 0\033[K");
    live_stats_begin_second(&stats, 6000000);
    live_stats_add_frame(&stats, &frames[1]);
    assert_string_equal(
        live_stats_write_line(&stats, 6250000, false, text),
        "4.0 fps  20.1 ms, p99 20.1  2 dropped 2 late 4 corrupt  2 lights 26 "
        "ghosts  q 0.25  ms: convert 0.20 find 1.40 plan 0.50 bin 4.00 draw "
        "5.00 show 0.00  3000 bytes\n");
}

/* Checks that counts and times at their max values are printed without
 * truncation. */
TEST(prints_large_counts)
{
    struct live_frame_times t = {.shown = true,
                                 .n_dropped = INT_MAX,
                                 .n_late = INT_MAX,
                                 .n_corrupt = INT_MAX,
                                 .shown_us = INT64_C(4000000000000000),
                                 .lights = INT_MAX,
                                 .ghosts = INT_MAX,
                                 .bytes = SIZE_MAX,
                                 .quality = 1};
    size_t n;

    for (int i = 0; i < LIVE_N_STAGES; i++)
        t.stage_us[i] = INT64_C(1) << 60;
    live_stats_start(&stats, 0);
    for (int i = 0; i < 5; i++)
        live_stats_add_frame(&stats, &t);
    live_stats_write_json(&stats, 1, true, text);
    assert_non_null(strstr(text, "\"drops\":10737418235,"));
    assert_non_null(strstr(text, "\"late\":10737418235,"));
    assert_non_null(strstr(text, "\"corrupt\":10737418235,"));
    assert_non_null(strstr(text, "\"find\":1152921504606847."));
    assert_int_equal(text[strlen(text) - 1], '}');
    live_stats_write_line(&stats, 1, true, text);
    assert_int_equal(strlen(text), 1 + 79 + 3);
    assert_string_equal(text + 80, "\033[K");
    live_stats_write_line(&stats, 1, false, text);
    n = strlen(text);
    assert_true(n < sizeof text - 1 && text[n - 1] == '\n');
}
