/* SPDX-License-Identifier: MIT */
#include "live/live_log.h"

#include <stdio.h>
#include <unistd.h>

#include "posix/clock.h"

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

/* Returns whether statistics overwrite one line of a terminal. */
static bool is_line(const struct live_log *log)
{
    return log->report == LIVE_REPORT_LINE && isatty(STDERR_FILENO);
}

void live_log_say(const struct live_log *log, const char *text)
{
    if (!log->tool->quiet)
        fprintf(stderr, "%sglint live: %s\n", is_line(log) ? "\r\033[K" : "",
                text);
}

int live_log_fail(const struct live_log *log, enum glint_status status,
                  const struct glint_error *error, const char *instead)
{
    char text[sizeof error->text + 80];

    if (status != GLINT_E_DEVICE || !instead)
        return tool_fail(log->tool, status, error->text);
    snprintf(text, sizeof text, "%s; without one: %s", error->text, instead);
    return tool_fail(log->tool, status, text);
}

void live_log_short(struct live_log *log, const struct glint_flare_stats *of)
{
    char text[160];

    if (of->dropped_bundles == 0 && of->need_primitives <= of->primitives)
        return;
    if (log->n_short++ > 0)
        return;
    snprintf(text, sizeof text,
             "a frame needs more than --memory allows: %d of %d bundles and %d "
             "of %d edges are left out",
             of->dropped_bundles, of->need_bundles,
             of->need_primitives - of->primitives, of->need_primitives);
    live_log_say(log, text);
}

static void print_report(const struct live_log *log, bool total)
{
    const int64_t now_us = glint_now_us();
    char text[LIVE_STATS_TEXT];

    if (log->report == LIVE_REPORT_JSON) {
        FILE *const out = log->is_piped ? stderr : stdout;

        fprintf(out, "%s\n", live_stats_json(&log->stats, now_us, total, text));
        fflush(out);
    } else if (log->report == LIVE_REPORT_LINE && !total)
        fputs(live_stats_line(&log->stats, now_us, is_line(log), text), stderr);
}

void live_log_second(struct live_log *log, bool is_asked)
{
    const int64_t now_us = glint_now_us();

    if (!live_stats_due(&log->stats, now_us) && !is_asked)
        return;
    print_report(log, false);
    live_stats_next(&log->stats, now_us);
}

void live_log_conclude(struct live_log *log, bool is_well, int n_shown,
                       long n_refused)
{
    const struct live_sums *t = &log->stats.total;
    char text[200];

    print_report(log, true);
    if (log->report != LIVE_REPORT_LINE || !is_well || n_shown == 0)
        return;
    snprintf(text, sizeof text,
             "%d frames, %ld of them not taken by the output; %llu dropped, "
             "%llu late, %llu corrupt; latency %.1f ms, 1 in 100 above %.1f",
             n_shown, n_refused, (unsigned long long)t->drops,
             (unsigned long long)t->late, (unsigned long long)t->corrupt,
             live_stats_latency_ms(t, 50), live_stats_latency_ms(t, 99));
    live_log_say(log, text);
    if (log->n_short) {
        snprintf(text, sizeof text,
                 "in %d frames something was left out for want of --memory",
                 log->n_short);
        live_log_say(log, text);
    }
}
