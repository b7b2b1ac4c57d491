/* SPDX-License-Identifier: MIT
 *
 * glint live: camera in, flares on the panel.
 *
 * cmd_live.c takes the options, live_input.c opens the source of frames and
 * live_output.c their sink, and live_loop.c runs.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_H
#define GLINT_TOOLS_LIVE_LIVE_H

#include <signal.h>

#include "live/live_adapt.h"
#include "live/live_input.h"
#include "live/live_output.h"

enum { LIVE_NAME_BYTES = 1024 }; /* bytes of the name of a snapshot */

enum live_adaptive {
    /* Adapts for a camera without a budget, as its frames do not wait. Results
     * of a file must not depend on a clock. */
    LIVE_ADAPTIVE_CAMERA,
    LIVE_ADAPTIVE,
    LIVE_FIXED
};

struct live_options {
    /* Only its options are set before it is opened. */
    struct compositor compositor;
    struct live_wish input;
    const char *output, *snapshot;
    enum glint_panel_fit fit;
    /* frames to show (0: no end), and frames to skip before them */
    int count, skip;
    /* whether quality is lowered to hold the rate */
    enum live_adaptive adaptive;
    bool reconnect, list_devices, list_formats;
    enum live_report report;
};

/* Reads OPTIONS anew, as at the start; for SIGHUP. Returns -1, or an exit code
 * after reporting the failure. */
typedef int live_reread_fn(void *ctx, struct tool *tool,
                           struct live_options *options);

/* Runs until a signal, --count, the end of the input or an error. Returns an
 * exit code. */
int live_run(struct tool *tool, struct live_options *options,
             live_reread_fn *reread, void *ctx);

#endif
