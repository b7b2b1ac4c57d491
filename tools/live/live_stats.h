/* SPDX-License-Identifier: MIT
 *
 * live_stats.h - what a live run does: each second and in all.
 *
 *     live_stats_start(&stats, now);
 *     live_stats_add(&stats, &times);                       each frame
 *     if (live_stats_due(&stats, now)) {
 *         fputs(live_stats_line(&stats, now, true, text), stderr);
 *         live_stats_next(&stats, now);
 *     }
 *     puts(live_stats_json(&stats, now, true, text));       at the end
 *
 * Times are microseconds of one clock that does not jump, the one frames are
 * stamped with. Memory is fixed, some 80 KB: latencies go into bins of 0.1 ms
 * up to one second, so percentiles are right to 0.1 ms, and to the longest one
 * beyond a second. Nothing wraps: counters have 64 bits, and bins are halved
 * together before one is full.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_STATS_H
#define GLINT_TOOLS_LIVE_LIVE_STATS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum live_stage {
    LIVE_CONVERT, /* the source's format is turned into one that is drawn into
                   */
    LIVE_FIND,    /* lights, and their tracks */
    LIVE_PLAN,
    LIVE_BIN, /* rays, edges and where they go */
    LIVE_DRAW,
    LIVE_SHOW, /* into the sink */
    LIVE_N_STAGES
};

enum {
    LIVE_BINS = 10000,    /* bins of latency */
    LIVE_BIN_US = 100,    /* the width of one */
    LIVE_STATS_TEXT = 640 /* characters that any line fits in */
};

/* One frame, or what was lost while there was none. */
struct live_frame_times {
    bool shown; /* false: only the three counts are there */
    int n_dropped, n_late, n_corrupt; /* before it, as of a source's frame */
    int64_t captured_us, shown_us;
    int64_t stage_us[LIVE_N_STAGES];
    int lights, ghosts;
    size_t bytes;   /* bytes of the arena in use */
    double quality; /* 0 .. 1 */
};

/* The sums over some span of time. */
struct live_sums {
    int64_t began_us;
    uint64_t frames, drops, late, corrupt;
    uint64_t stage_us[LIVE_N_STAGES];
    int64_t longest_us; /* latency */
    int most_lights, most_ghosts;
    size_t most_bytes;
    double quality;              /* sum */
    uint32_t bin[LIVE_BINS + 1]; /* the last: a second and more */
};

struct live_stats {
    struct live_sums second, total;
};

void live_stats_start(struct live_stats *stats, int64_t now_us);

void live_stats_add(struct live_stats *stats,
                    const struct live_frame_times *times);

/* Returns whether a second has passed since start or next. */
bool live_stats_due(const struct live_stats *stats, int64_t now_us);

/* Begins the next second. */
void live_stats_next(struct live_stats *stats, int64_t now_us);

/* The latency, ms, that PERCENT of the frames (1 .. 100) do not exceed; -1 of
 * no frames. */
double live_stats_latency_ms(const struct live_sums *sums, int percent);

/* Writes the second as a line for people into TEXT, which it returns. For a
 * TERMINAL it has at most 79 characters and takes the place of the one before;
 * else it ends with a line feed and has the stages, too. Drops, late and
 * corrupt frames are those since the start. */
char *live_stats_line(const struct live_stats *stats, int64_t now_us,
                      bool terminal, char text[LIVE_STATS_TEXT]);

/* Writes the second, or the TOTAL, as a JSON object without line feed into
 * TEXT, which it returns: "t" (seconds since the start), "fps", "frames",
 * "drops", "late", "corrupt", "latency_ms_p50", "latency_ms_p99", "ms" (mean of
 * each stage), the most "lights", "ghosts" and "bytes", mean "quality"; of the
 * total also "total": true. What no frame was there to tell is null. */
char *live_stats_json(const struct live_stats *stats, int64_t now_us,
                      bool total, char text[LIVE_STATS_TEXT]);

#endif
