/* SPDX-License-Identifier: MIT
 *
 * live_log.h - what a live run says: lines for people, and each second how it
 * goes, as a line or as JSON.
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
    int n_short; /* frames that did not fit into memory */
};

/* ASKED may be LIVE_REPORT_AUTO. */
void live_log_init(struct live_log *log, const struct tool *tool,
                   enum live_report asked, bool is_piped);

/* Says TEXT on a line of its own; nothing after -q. */
void live_log_say(const struct live_log *log, const char *text);

/* Says that memory was short, if it was: once, as it is likely to be so in
 * every frame. */
void live_log_short(struct live_log *log, const struct glint_flare_stats *of);

/* Reports the second, if it is over or IS_ASKED. */
void live_log_second(struct live_log *log, bool is_asked);

/* The last word: how it went, and what was left out of N_SHOWN frames,
 * N_REFUSED of which the output did not take. IS_WELL: the run did not fail. */
void live_log_conclude(struct live_log *log, bool is_well, int n_shown,
                       long n_refused);

#endif
