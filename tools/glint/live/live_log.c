/* SPDX-License-Identifier: MIT */
#include "live/live_log.h"

#include <inttypes.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

#include "posix/clock.h"

#define SECOND_US 1000000
/* width of a terminal line, without one column for the cursor */
#define COLUMNS 79

static const char *const stage_names[LIVE_N_STAGES] = {
    [LIVE_CONVERT] = "convert", [LIVE_FIND] = "find", [LIVE_PLAN] = "plan",
    [LIVE_BIN] = "bin",         [LIVE_DRAW] = "draw", [LIVE_SHOW] = "show",
    [LIVE_SCENE] = "scene"};

/* ---------------------------------------------------------------- counting */

static void reset_frame_sums(struct live_sums *sums, int64_t now_us)
{
    memset(sums, 0, sizeof *sums);
    sums->began_us = now_us;
}

void live_stats_start(struct live_stats *stats, int64_t now_us)
{
    reset_frame_sums(&stats->second, now_us);
    reset_frame_sums(&stats->total, now_us);
}

bool live_stats_is_second_over(const struct live_stats *stats, int64_t now_us)
{
    return now_us - stats->second.began_us >= SECOND_US;
}

void live_stats_begin_second(struct live_stats *stats, int64_t now_us)
{
    reset_frame_sums(&stats->second, now_us);
}

/* Counts a latency of US microseconds in S. If the latency's bin is full,
 * halves all bins, but none to 0, which preserves percentiles. */
static void add_latency_to_histogram(struct live_sums *s, int64_t us)
{
    const int64_t at = us < 0 ? 0 : us / LIVE_BIN_US;
    uint32_t *const bin = &s->bin[at < LIVE_BINS ? at : LIVE_BINS];

    if (*bin == UINT32_MAX)
        for (int i = 0; i <= LIVE_BINS; i++)
            s->bin[i] -= s->bin[i] / 2;
    ++*bin;
    s->longest_us = us > s->longest_us ? us : s->longest_us;
}

static void add_frame_to_sums(struct live_sums *s,
                              const struct live_frame_times *t)
{
    s->frames++;
    for (int i = 0; i < LIVE_N_STAGES; i++)
        s->stage_us[i] += (uint64_t)(t->stage_us[i] > 0 ? t->stage_us[i] : 0);
    add_latency_to_histogram(s, t->shown_us - t->captured_us);
    s->most_lights = t->lights > s->most_lights ? t->lights : s->most_lights;
    s->most_ghosts = t->ghosts > s->most_ghosts ? t->ghosts : s->most_ghosts;
    s->most_bytes = t->bytes > s->most_bytes ? t->bytes : s->most_bytes;
    s->quality += t->quality;
    s->reused += t->reused;
}

static void add_frame_to_all_sums(struct live_sums *s,
                                  const struct live_frame_times *t)
{
    s->drops += (unsigned)t->n_dropped;
    s->late += (unsigned)t->n_late;
    s->corrupt += (unsigned)t->n_corrupt;
    if (t->shown)
        add_frame_to_sums(s, t);
}

void live_stats_add_frame(struct live_stats *stats,
                          const struct live_frame_times *times)
{
    add_frame_to_all_sums(&stats->second, times);
    add_frame_to_all_sums(&stats->total, times);
}

/* --------------------------------------------------------------- evaluating */

double live_stats_latency_ms(const struct live_sums *sums, int percent)
{
    uint64_t all = 0, below = 0, rank;
    int at = 0;

    for (int i = 0; i <= LIVE_BINS; i++)
        all += sums->bin[i];
    if (all == 0)
        return -1;
    rank = (all * (unsigned)percent + 99) / 100; /* all < 2^46 */
    while ((below += sums->bin[at]) < rank)
        at++;
    return (double)(at == LIVE_BINS ? sums->longest_us
                                    : at * LIVE_BIN_US + LIVE_BIN_US / 2) /
           1e3;
}

static double compute_seconds_since(int64_t began_us, int64_t now_us)
{
    return 1e-6 * (double)(now_us - began_us);
}

static double compute_fps(const struct live_sums *s, int64_t now_us)
{
    const double seconds = compute_seconds_since(s->began_us, now_us);

    return seconds > 0 ? (double)s->frames / seconds : 0;
}

/* ------------------------------------------------------------------ writing */

/* A text of at most ROOM bytes; longer text is truncated. */
struct writer {
    char *text;
    size_t used, room;
};

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
append(struct writer *w, const char *format, ...)
{
    va_list args;
    int n;

    va_start(args, format);
    n = vsnprintf(w->text + w->used, w->room - w->used, format, args);
    va_end(args);
    w->used += n > 0 ? (size_t)n : 0;
    w->used = w->used < w->room ? w->used : w->room - 1;
}

/* Appends SUM / number of frames, with DIGITS decimals, or null if there are no
 * frames. */
static void append_mean_ms(struct writer *w, const struct live_sums *s,
                           double sum, int digits)
{
    if (s->frames)
        append(w, "%.*f", digits, sum / (double)s->frames);
    else
        append(w, "null");
}

static void append_latency_ms(struct writer *w, const struct live_sums *s,
                              int percent)
{
    if (s->frames)
        append(w, "%.2f", live_stats_latency_ms(s, percent));
    else
        append(w, "null");
}

/* Returns whether the time of STAGE is reported; LIVE_SCENE is reported only
 * with a scene. */
static bool is_stage_reported(const struct live_stats *stats, int stage)
{
    return stage != LIVE_SCENE || stats->total.stage_us[LIVE_SCENE] > 0;
}

char *live_stats_write_json(const struct live_stats *stats, int64_t now_us,
                            bool total, char text[LIVE_STATS_TEXT])
{
    const struct live_sums *const s = total ? &stats->total : &stats->second;
    struct writer w = {text, 0, LIVE_STATS_TEXT};

    append(&w,
           "{\"t\":%.3f,\"fps\":%.2f,\"frames\":%" PRIu64 ",\"drops\":%" PRIu64
           ",\"late\":%" PRIu64 ",\"corrupt\":%" PRIu64 ",\"latency_ms_p50\":",
           compute_seconds_since(stats->total.began_us, now_us),
           compute_fps(s, now_us), s->frames, s->drops, s->late, s->corrupt);
    append_latency_ms(&w, s, 50);
    append(&w, ",\"latency_ms_p99\":");
    append_latency_ms(&w, s, 99);
    append(&w, ",\"ms\":{");
    for (int i = 0; i < LIVE_N_STAGES; i++) {
        if (!is_stage_reported(stats, i))
            continue;
        append(&w, "%s\"%s\":", i ? "," : "", stage_names[i]);
        append_mean_ms(&w, s, 1e-3 * (double)s->stage_us[i], 3);
    }
    append(&w, "},\"lights\":%d,\"ghosts\":%d,\"bytes\":%zu,\"quality\":",
           s->most_lights, s->most_ghosts, s->most_bytes);
    append_mean_ms(&w, s, s->quality, 3);
    append(&w, ",\"reused\":%" PRIu64, s->reused);
    append(&w, "%s}", total ? ",\"total\":true" : "");
    return text;
}

static void append_summary_text(struct writer *w,
                                const struct live_stats *stats, int64_t now_us)
{
    const struct live_sums *const s = &stats->second;
    const struct live_sums *const t = &stats->total;

    append(w, "%.1f fps", compute_fps(s, now_us));
    if (s->frames)
        append(w, "  %.1f ms, p99 %.1f", live_stats_latency_ms(s, 50),
               live_stats_latency_ms(s, 99));
    append(w, "  %" PRIu64 " dropped %" PRIu64 " late", t->drops, t->late);
    if (t->corrupt)
        append(w, " %" PRIu64 " corrupt", t->corrupt);
    append(w, "  %d light%s %d ghost%s", s->most_lights,
           s->most_lights == 1 ? "" : "s", s->most_ghosts,
           s->most_ghosts == 1 ? "" : "s");
    if (s->frames)
        append(w, "  q %.2f", s->quality / (double)s->frames);
}

static void append_stage_times(struct writer *w, const struct live_stats *stats)
{
    const struct live_sums *const s = &stats->second;

    append(w, "  ms:");
    for (int i = 0; i < LIVE_N_STAGES; i++) {
        if (!is_stage_reported(stats, i))
            continue;
        append(w, " %s ", stage_names[i]);
        append_mean_ms(w, s, 1e-3 * (double)s->stage_us[i], 2);
    }
    append(w, "  %zu bytes\n", s->most_bytes);
}

char *live_stats_write_line(const struct live_stats *stats, int64_t now_us,
                            bool terminal, char text[LIVE_STATS_TEXT])
{
    struct writer w = {text, 0, LIVE_STATS_TEXT};

    if (!terminal) {
        append_summary_text(&w, stats, now_us);
        append_stage_times(&w, stats);
        return text;
    }
    append(&w, "\r");
    /* Limits the text to one terminal line, as a line that wraps could not be
     * overwritten. The two more bytes are the carriage return and the
     * terminator. */
    w.room = 1 + COLUMNS + 1;
    append_summary_text(&w, stats, now_us);
    w.room = LIVE_STATS_TEXT;
    append(&w, "\033[K");
    return text;
}

void live_log_init(struct live_log *log, const struct tool *tool,
                   enum live_report asked, bool is_piped)
{
    log->tool = tool;
    log->is_piped = is_piped;
    log->n_short = 0;
    log->report = asked != LIVE_REPORT_AUTO ? asked
                  : tool->json              ? LIVE_REPORT_JSON
                  : tool->quiet             ? LIVE_REPORT_NONE
                                            : LIVE_REPORT_LINE;
}

static bool is_terminal_line_overwritten(const struct live_log *log)
{
    return log->report == LIVE_REPORT_LINE && isatty(STDERR_FILENO);
}

void live_log_print_message(const struct live_log *log, const char *text)
{
    if (!log->tool->quiet)
        fprintf(stderr, "%sglint live: %s\n",
                is_terminal_line_overwritten(log) ? "\r\033[K" : "", text);
}

int live_log_print_error(const struct live_log *log, enum glint_status status,
                         const struct glint_error *error, const char *instead)
{
    char text[sizeof error->text + 112];

    if (status != GLINT_E_DEVICE || !instead)
        return tool_fail(log->tool, status, error->text);
    snprintf(text, sizeof text, "%s; without one: %s", error->text, instead);
    return tool_fail(log->tool, status, text);
}

void live_log_warn_of_memory_limit(struct live_log *log,
                                   const struct glint_flare_stats *of)
{
    char text[160];

    if (of->dropped_bundles == 0 && of->need_primitives <= of->primitives)
        return;
    if (log->n_short++ > 0)
        return;
    snprintf(
        text, sizeof text,
        "a frame needs more than --memory allows: %d of %d ray bundles and %d "
        "of %d edges are left out",
        of->dropped_bundles, of->need_bundles,
        of->need_primitives - of->primitives, of->need_primitives);
    live_log_print_message(log, text);
}

static void print_statistics(const struct live_log *log, bool total)
{
    const int64_t now_us = glint_get_time_us();
    char text[LIVE_STATS_TEXT];

    if (log->report == LIVE_REPORT_JSON) {
        FILE *const out = log->is_piped ? stderr : stdout;

        fprintf(out, "%s\n",
                live_stats_write_json(&log->stats, now_us, total, text));
        fflush(out);
    } else if (log->report == LIVE_REPORT_LINE && !total)
        fputs(live_stats_write_line(&log->stats, now_us,
                                    is_terminal_line_overwritten(log), text),
              stderr);
}

void live_log_print_second(struct live_log *log, bool is_asked)
{
    const int64_t now_us = glint_get_time_us();

    if (!live_stats_is_second_over(&log->stats, now_us) && !is_asked)
        return;
    print_statistics(log, false);
    live_stats_begin_second(&log->stats, now_us);
}

void live_log_print_summary(struct live_log *log, bool is_well, int n_shown,
                            long n_refused)
{
    const struct live_sums *t = &log->stats.total;
    char text[200];

    print_statistics(log, true);
    if (log->report != LIVE_REPORT_LINE || !is_well || n_shown == 0)
        return;
    snprintf(
        text, sizeof text,
        "%d frames, %ld of them refused by the output; %llu dropped, %llu "
        "late, %llu corrupt; latency: median %.1f ms, 99th percentile %.1f ms",
        n_shown, n_refused, (unsigned long long)t->drops,
        (unsigned long long)t->late, (unsigned long long)t->corrupt,
        live_stats_latency_ms(t, 50), live_stats_latency_ms(t, 99));
    live_log_print_message(log, text);
    if (log->n_short) {
        snprintf(text, sizeof text,
                 "%d frames are incomplete because --memory is too small",
                 log->n_short);
        live_log_print_message(log, text);
    }
}
