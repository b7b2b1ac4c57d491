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
#include "linux/fbdev.h"
#include "linux/v4l2_sink.h"
#include "panel/sinks.h"
#include "sdl/sdl.h"

/* ------------------------------------------------------------------- output
 *
 * Where live frames go to, by name:
 *   fb[:/dev/fb0]     the panel of a framebuffer
 *   y4m:FILE | y4m:-  a video file or pipe; also FILE.y4m
 *   v4l2:/dev/videoN  an output node, as of v4l2loopback
 *   window            one on the desktop, where there is the SDL plug-in
 *   null              nowhere */

enum live_output_kind {
    LIVE_OUTPUT_FB,
    LIVE_OUTPUT_Y4M,
    LIVE_OUTPUT_V4L2,
    LIVE_OUTPUT_NULL,
    LIVE_OUTPUT_WINDOW
};

struct live_output {
    enum live_output_kind kind;
    const char *path; /* NULL: the default path */
    enum glint_panel_fit fit;
    bool dither;             /* dither on panels with 16 bits a pixel */
    struct glint_sink *sink; /* NULL: closed */
    union {
        struct glint_sink sink; /* the first member of all of these */
        struct glint_fbdev fb;
        struct glint_y4m_sink y4m;
        struct glint_v4l2_sink v4l2;
        struct glint_null_sink null;
        struct glint_window window;
    } as;
};

/* Sets kind and path of OUTPUT by NAME, which must outlive it. Returns false if
 * NAME is none of the above. */
bool live_output_parse(struct live_output *output, const char *name);

/* Returns whether the output can be opened before there is a picture. */
bool live_output_is_flexible(const struct live_output *output);

/* Opens OUTPUT for frames of IMAGE's format and size; a flexible output ignores
 * IMAGE. */
enum glint_status live_output_open(struct live_output *output,
                                   const struct glint_image *image, int fps_num,
                                   int fps_den, struct glint_error *error);

/* Describe an open output. The first writes to TEXT what it is, "" if its name
 * says all, and returns TEXT; the second returns a problem with it, or NULL. */
const char *live_output_text(const struct live_output *output, char *text,
                             size_t size);
const char *live_output_note(const struct live_output *output);

/* Returns the number of frames that OUTPUT could not take because it was
 * busy. */
long live_output_dropped(const struct live_output *output);

/* Closes OUTPUT, unless it is closed already, and puts its file in place. */
enum glint_status live_output_close(struct live_output *output,
                                    struct glint_error *error);

/* ---------------------------------------------------------------------- run */

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
    struct drawing drawing;
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

/* Reads OPTIONS again, as at the start; for SIGHUP. Returns -1, or an exit code
 * after reporting the failure. */
typedef int live_reread_fn(void *ctx, struct tool *tool,
                           struct live_options *options);

/* Runs until a signal, --count, the end of the input or an error. Returns an
 * exit code. */
int live_run(struct tool *tool, struct live_options *options,
             live_reread_fn *reread, void *ctx);

#endif
