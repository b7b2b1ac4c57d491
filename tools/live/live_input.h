/* SPDX-License-Identifier: MIT
 *
 * live_input.h - where live frames come from, by name:
 *   /dev/videoN, N   a camera (linux/v4l2.h)
 *   FILE.y4m, -      a video, or a pipe of one (live_video.h)
 *   test             a lamp over a night street (live_test.h)
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_INPUT_H
#define GLINT_TOOLS_LIVE_LIVE_INPUT_H

#include "linux/v4l2.h"
#include "live/live_log.h"
#include "live/live_test.h"
#include "live/live_video.h"

struct live_wish {
    struct glint_v4l2_config camera; /* device, size and rate of any source */
    enum glint_v4l2_io io;           /* way to read a camera */
    int n_buffers;                   /* buffers of a camera */
};

struct live_input {
    struct glint_source *source; /* NULL: closed */
    union {
        struct glint_v4l2 camera;
        struct live_video video;
        struct live_test test;
    } as;
};

/* Returns whether NAME stands for a camera. */
bool live_input_is_camera(const char *name);

/* Opens the source that WISH names, which live_input_start() starts; SEED is
 * for the noise of the test. */
enum glint_status live_input_open(struct live_input *input,
                                  const struct live_wish *wish, uint32_t seed,
                                  struct glint_error *error);

/* Starts INPUT, or closes it on failure. */
enum glint_status live_input_start(struct live_input *input,
                                   struct glint_error *error);

/* Reports why DEVICE cannot be opened or started. Returns an exit code. */
int live_input_fail(const struct live_log *log, const char *device,
                    enum glint_status status, const struct glint_error *error);

/* Closes INPUT, unless it is closed already. */
void live_input_close(struct live_input *input);

#endif
