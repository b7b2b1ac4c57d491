/* SPDX-License-Identifier: MIT
 *
 * glint live: draws flares on camera frames and shows them on a panel.
 *
 * cmd_live.c parses the options, live_input.c opens the source of frames,
 * live_output.c opens their sink, and live_loop.c runs the loop.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_H
#define GLINT_TOOLS_LIVE_LIVE_H

#include <signal.h>

#include "live/live_adapt.h"
#include "live/live_input.h"
#include "linux/fbdev.h"
#include "linux/kms.h"
#include "linux/v4l2_sink.h"
#include "panel/sinks.h"
#include "sdl/sdl.h"

/* ------------------------------------------------------------------- output
 *
 * The outputs of live frames, by name:
 *   fb[:/dev/fb0]     the panel of a framebuffer
 *   kms[:HDMI-A-1]    a display, by the kernel's mode setting interface
 * Without a device's name, each of the two replaces the other if it is missing.
 *   y4m:FILE | y4m:-  a video file or pipe; also FILE.y4m
 *   v4l2:/dev/videoN  an output node, as of v4l2loopback
 *   window            a desktop window; needs the SDL plug-in
 *   null              nowhere */

enum live_output_kind {
    LIVE_OUTPUT_FB,
    LIVE_OUTPUT_KMS,
    LIVE_OUTPUT_Y4M,
    LIVE_OUTPUT_V4L2,
    LIVE_OUTPUT_NULL,
    LIVE_OUTPUT_WINDOW
};

struct live_output {
    enum live_output_kind kind;
    const char *path; /* device or file; NULL: the default */
    enum glint_panel_fit fit;
    struct glint_sink *sink; /* open sink; NULL: closed */
    union {
        /* the common first member of all types of output */
        struct glint_sink sink;
        struct glint_fbdev fb;
        struct glint_kms kms;
        struct glint_y4m_sink y4m;
        struct glint_v4l2_sink v4l2;
        struct glint_null_sink null;
        struct glint_window window;
    } as;
};

/* Sets type and path of OUTPUT by NAME, which must outlive OUTPUT. Returns
 * false if NAME is not one of the names above. */
bool live_output_parse(struct live_output *output, const char *name);

/* Returns whether the output can be opened before the image size is known. */
bool live_output_accepts_any_size(const struct live_output *output);

/* Opens OUTPUT for frames of IMAGE's format and size; IMAGE is ignored if
 * live_output_accepts_any_size(). */
enum glint_status live_output_open(struct live_output *output,
                                   const struct glint_image *image, int fps_num,
                                   int fps_den, struct glint_error *error);

/* Describe an open output. live_output_describe() writes a description to TEXT
 * and returns TEXT, which is "" for outputs other than displays and V4L2
 * nodes. live_output_get_console_note() returns why the text console of a
 * framebuffer could not be switched off, or NULL if it could. */
const char *live_output_describe(const struct live_output *output, char *text,
                                 size_t size);
const char *live_output_get_console_note(const struct live_output *output);

/* Returns the number of frames that OUTPUT dropped because the device was
 * busy. */
long live_output_count_dropped_frames(const struct live_output *output);

/* Closes OUTPUT, unless it is closed already. Renames its temporary file, if
 * any, to the output path. */
enum glint_status live_output_close(struct live_output *output,
                                    struct glint_error *error);

/* ---------------------------------------------------------------------- run */

enum { LIVE_NAME_BYTES = 1024 }; /* max bytes of the name of a snapshot */

enum live_adaptive {
    /* adaptive if the input is a camera, whose frames do not wait, and --budget
     * is not given; the result for a file must not depend on the clock */
    LIVE_ADAPTIVE_CAMERA,
    LIVE_ADAPTIVE,
    LIVE_FIXED
};

struct live_options {
    /* options and state of the drawing; only its member LINE is set before
     * live_run() */
    struct drawing drawing;
    struct live_wish input;
    const char *output, *snapshot;
    enum glint_panel_fit fit;
    /* number of frames to show (0: no limit), and number of frames to skip
     * first */
    int count, skip;
    /* whether quality is reduced to keep the frame rate */
    enum live_adaptive adaptive;
    bool reconnect, list_devices, list_formats;
    enum live_report report;
};

/* Called on SIGHUP: parses the configuration file and the command line again,
 * into OPTIONS. Returns -1, or an exit code after printing the error. */
typedef int live_reread_fn(void *ctx, struct tool *tool,
                           struct live_options *options);

/* Draws and shows frames until a signal, --count, the end of the input or an
 * error. Returns an exit code. */
int live_run(struct tool *tool, struct live_options *options,
             live_reread_fn *reread, void *ctx);

#endif
