/* SPDX-License-Identifier: MIT
 *
 * live_log.h - output of a live run: messages for people, and statistics each
 * second, as a line or as JSON.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_LOG_H
#define GLINT_TOOLS_LIVE_LIVE_LOG_H

#include "live/live_stats.h"
#include "overlay/compositor.h"

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

/* Prepares LOG for reports as ASKED for, which may be LIVE_REPORT_AUTO. */
void live_log_init(struct live_log *log, const struct tool *tool,
                   enum live_report asked, bool is_piped);

/* Reports ERROR, and if a device is missing what to use INSTEAD, unless NULL.
 * Returns an exit code. */
int live_log_fail(const struct live_log *log, enum glint_status status,
                  const struct glint_error *error, const char *instead);

/* Prints TEXT on a line of its own, unless -q is given. */
void live_log_say(const struct live_log *log, const char *text);

/* Counts a frame of which something did not fit into memory, as OF tells, and
 * reports the first such frame. */
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
