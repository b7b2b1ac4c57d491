/* SPDX-License-Identifier: MIT
 *
 * live_log.h - output of a live run: messages, and statistics every second, as
 * a line of text or as JSON.
 *
 *     live_stats_start(&stats, now);
 *     live_stats_add_frame(&stats, &times);                       each frame
 *     if (live_stats_is_second_over(&stats, now)) {
 *         fputs(live_stats_write_line(&stats, now, true, text), stderr);
 *         live_stats_begin_second(&stats, now);
 *     }
 *     puts(live_stats_write_json(&stats, now, true, text));       at the end
 *
 * Times are microseconds of the monotonic clock of the frames' time stamps.
 * Memory is fixed, about 80 KB: latencies are counted in bins of 0.1 ms up to
 * one second, so percentiles are exact to 0.1 ms; a percentile above one second
 * is reported as the longest latency. Nothing overflows: counters have 64 bits,
 * and all bins are halved before one is full. */
#ifndef GLINT_TOOLS_LIVE_LIVE_LOG_H
#define GLINT_TOOLS_LIVE_LIVE_LOG_H

#include "overlay/drawing.h"

enum live_stage {
    LIVE_CONVERT, /* conversion of frames into a format that glint can draw
                     on */
    LIVE_FIND,    /* finding and tracking of lamps */
    LIVE_PLAN,
    LIVE_BIN, /* tracing of rays, and listing of edges per image tile */
    LIVE_DRAW,
    LIVE_SHOW,  /* passing frames to the sink */
    LIVE_SCENE, /* drawing of a scene; reported if there is a scene */
    LIVE_N_STAGES
};

enum {
    LIVE_BINS = 10000, /* number of latency bins */
    LIVE_BIN_US = 100, /* width of a bin, microseconds */
    /* max bytes of a line of statistics, with terminator */
    LIVE_STATS_TEXT = 672
};

/* Times of a shown frame and number of frames lost before it; if no frame was
 * shown, only these numbers */
struct live_frame_times {
    bool shown; /* false: only the three counts below are set */
    int n_dropped, n_late, n_corrupt; /* see struct glint_source_frame */
    int64_t captured_us, shown_us;
    int64_t stage_us[LIVE_N_STAGES];
    int lights, ghosts;
    size_t bytes;   /* bytes of the arena in use */
    double quality; /* 1 - step / LIVE_MAX_STEP of the adaptive quality */
    bool reused;    /* whether the edges of the previous frame were reused */
};

/* Sums over one second, or over the run. */
struct live_sums {
    int64_t began_us;
    uint64_t frames, drops, late, corrupt;
    uint64_t stage_us[LIVE_N_STAGES];
    int64_t longest_us; /* longest latency, microseconds */
    int most_lights, most_ghosts;
    size_t most_bytes;
    double quality; /* sum of the quality over all frames */
    uint64_t reused;
    /* histogram of latencies; last bin: one second or more */
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
    bool is_piped;           /* whether frames are written to standard output */
    struct live_stats stats;
    int n_short; /* number of frames whose flare did not fit into memory */
};

void live_stats_start(struct live_stats *stats, int64_t now_us);

void live_stats_add_frame(struct live_stats *stats,
                          const struct live_frame_times *times);

/* Returns whether a second has passed since live_stats_start() or
 * live_stats_begin_second(). */
bool live_stats_is_second_over(const struct live_stats *stats, int64_t now_us);

void live_stats_begin_second(struct live_stats *stats, int64_t now_us);

/* Returns the latency in ms that PERCENT of the frames (1 .. 100) do not
 * exceed, or -1 if there are no frames. */
double live_stats_latency_ms(const struct live_sums *sums, int percent);

/* Writes the statistics of the last second to TEXT as a line for readers, and
 * returns TEXT. If TERMINAL, the line has at most 79 characters and overwrites
 * the previous one; else it also has the stages and ends with a line feed.
 * Numbers of dropped, late and corrupt frames are totals of the run. */
char *live_stats_write_line(const struct live_stats *stats, int64_t now_us,
                            bool terminal, char text[LIVE_STATS_TEXT]);

/* Writes the statistics of the last second, or of the run if TOTAL, to TEXT as
 * a JSON object without line feed. Returns TEXT. Members: "t" (seconds since
 * the start), "fps", "frames", "drops", "late", "corrupt", "latency_ms_p50",
 * "latency_ms_p99", "ms" (mean time of each stage), the maxima "lights",
 * "ghosts" and "bytes", the mean "quality", and for the run "total": true.
 * Latencies and means are null if there are no frames. */
char *live_stats_write_json(const struct live_stats *stats, int64_t now_us,
                            bool total, char text[LIVE_STATS_TEXT]);

/* Initialises LOG for reports of type ASKED, which may be LIVE_REPORT_AUTO. */
void live_log_init(struct live_log *log, const struct tool *tool,
                   enum live_report asked, bool is_piped);

/* Prints ERROR and, if a device is missing, the advice INSTEAD (may be NULL).
 * Returns an exit code. */
int live_log_print_error(const struct live_log *log, enum glint_status status,
                         const struct glint_error *error, const char *instead);

/* Prints TEXT on a line of its own, unless -q is given. */
void live_log_print_message(const struct live_log *log, const char *text);

/* Counts a frame if its statistics OF show that the memory limit made it
 * incomplete. Prints a warning for the first such frame. */
void live_log_warn_of_memory_limit(struct live_log *log,
                                   const struct glint_flare_stats *of);

/* Prints the statistics of the last second if the second has ended or IS_ASKED,
 * and begins the next second. */
void live_log_print_second(struct live_log *log, bool is_asked);

/* Prints the statistics of the run. As text they include how many of N_SHOWN
 * frames the output refused, N_REFUSED, and how many were incomplete. IS_WELL:
 * the run did not fail; otherwise no text is printed. */
void live_log_print_summary(struct live_log *log, bool is_well, int n_shown,
                            long n_refused);

#endif
