/* SPDX-License-Identifier: MIT
 *
 * live_log.h - output of a live run: messages for people, and statistics each
 * second, as a line or as JSON.
 *
 *     live_stats_start(&stats, now);
 *     live_stats_add(&stats, &times);                       each frame
 *     if (live_stats_due(&stats, now)) {
 *         fputs(live_stats_line(&stats, now, true, text), stderr);
 *         live_stats_next(&stats, now);
 *     }
 *     puts(live_stats_json(&stats, now, true, text));       at the end
 *
 * Times are microseconds of the clock that frames are stamped with, which does
 * not jump. Memory is fixed, some 80 KB: latencies go into bins of 0.1 ms up to
 * one second, so percentiles are right to 0.1 ms; above a second they are the
 * longest latency. Nothing wraps: counters have 64 bits, and all bins are
 * halved before one overflows.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_LOG_H
#define GLINT_TOOLS_LIVE_LIVE_LOG_H

#include "overlay/drawing.h"

enum live_stage {
    LIVE_CONVERT, /* conversion of frames into a format that can be drawn into
                   */
    LIVE_FIND,    /* finding and following of lamps */
    LIVE_PLAN,
    LIVE_BIN, /* rays, edges, and their lists for tiles */
    LIVE_DRAW,
    LIVE_SHOW,  /* putting frames to the sink */
    LIVE_SCENE, /* drawing of a scene; said where there is one */
    LIVE_N_STAGES
};

enum {
    LIVE_BINS = 10000,    /* bins of latency */
    LIVE_BIN_US = 100,    /* width of a bin */
    LIVE_STATS_TEXT = 672 /* room for any line, bytes */
};

/* Times of one frame, or only counts of lost frames. */
struct live_frame_times {
    bool shown; /* false: only the three counts below are set */
    int n_dropped, n_late, n_corrupt; /* as in struct glint_source_frame */
    int64_t captured_us, shown_us;
    int64_t stage_us[LIVE_N_STAGES];
    int lights, ghosts;
    size_t bytes;   /* bytes of the arena in use */
    double quality; /* 0 .. 1 */
    bool reused;    /* true: with the edges of the frame before */
};

/* Sums over a second, or over the run. */
struct live_sums {
    int64_t began_us;
    uint64_t frames, drops, late, corrupt;
    uint64_t stage_us[LIVE_N_STAGES];
    int64_t longest_us; /* longest latency */
    int most_lights, most_ghosts;
    size_t most_bytes;
    double quality; /* sum over the frames */
    uint64_t reused;
    /* latencies; the last bin: a second and more */
    uint32_t bin[LIVE_BINS + 1];
};

struct live_stats {
    struct live_sums second, total;
};

enum live_report {
    LIVE_REPORT_AUTO,
    LIVE_REPORT_LINE,
    LIVE_REPORT_JSON,
    LIVE_REPORT_NONE
};

struct live_log {
    const struct tool *tool;
    enum live_report report; /* not LIVE_REPORT_AUTO */
    bool is_piped;           /* frames go to standard output */
    struct live_stats stats;
    int n_short; /* frames of which something did not fit into memory */
};

void live_stats_start(struct live_stats *stats, int64_t now_us);

void live_stats_add(struct live_stats *stats,
                    const struct live_frame_times *times);

/* Returns whether a second has passed since live_stats_start() or
 * live_stats_next(). */
bool live_stats_due(const struct live_stats *stats, int64_t now_us);

/* Begins the next second. */
void live_stats_next(struct live_stats *stats, int64_t now_us);

/* Returns the latency in ms that PERCENT of the frames (1 .. 100) do not
 * exceed, or -1 if there are no frames. */
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
 * total also "total": true. Latencies and means of no frames are null. */
char *live_stats_json(const struct live_stats *stats, int64_t now_us,
                      bool total, char text[LIVE_STATS_TEXT]);

/* Prepares LOG for reports as Requested, which may be LIVE_REPORT_AUTO. */
void live_log_init(struct live_log *log, const struct tool *tool,
                   enum live_report asked, bool is_piped);

/* Reports ERROR, and if a device is missing what to use INSTEAD, unless NULL.
 * Returns an exit code. */
int live_log_fail(const struct live_log *log, enum glint_status status,
                  const struct glint_error *error, const char *instead);

/* Prints TEXT on a line of its own, unless -q is given. */
void live_log_say(const struct live_log *log, const char *text);

/* Counts a frame that did not completely fit into memory, by OF, and reports
 * the first such frame. */
void live_log_short(struct live_log *log, const struct glint_flare_stats *of);

/* Prints the statistics of the second and begins the next one, if it is over or
 * IS_ASKED. */
void live_log_second(struct live_log *log, bool is_asked);

/* Prints the statistics of the whole run, and what was left out of N_SHOWN
 * frames, N_REFUSED of which the output did not take. IS_WELL: the run did not
 * fail. */
void live_log_conclude(struct live_log *log, bool is_well, int n_shown,
                       long n_refused);

#endif
