/* SPDX-License-Identifier: MIT
 *
 * live_input.h - opens the sources of live frames, which have these names:
 *   /dev/videoN, N   a camera (linux/v4l2.h)
 *   FILE.y4m, -      a video, or a pipe of one; with a format and a size the
 *                    pipe has bare frames without headers
 *   test             a test image: a lamp over a night street
 *   none             black frames, as a background for scenes
 *
 * A video is shown at its own rate, and late frames are skipped as from a
 * camera; from a pipe every frame is shown as it arrives. After the last frame,
 * the source's next() returns GLINT_E_CLOSED. The test image has a night
 * street, a lamp with a halo that circles in eight seconds, and sensor noise.
 * Frame N depends only on seed and size. */
#ifndef GLINT_TOOLS_LIVE_LIVE_INPUT_H
#define GLINT_TOOLS_LIVE_LIVE_INPUT_H

#include "linux/v4l2.h"
#include "live/live_log.h"

/* A source without a device: frames are due at times of a clock, and the format
 * is known when the source is opened. */
struct live_timed {
    struct glint_source source;
    struct glint_source_format format;
    const char *name; /* name of the source, for errors */
    int timer;        /* timer descriptor; -1: a frame is due when it arrives */
    int64_t n;        /* number of the next frame */

    struct glint_y4m_reader reader;
    /* the last frame of the test image (I420, limited range) or of a pipe of
     * bare frames */
    struct glint_image image;
    struct glint_input pipe;    /* pipe of bare frames, each of FRAME_BYTES */
    size_t frame_bytes, n_read; /* n_read: of the next frame, so far */
    /* members of the test image: */
    uint32_t seed;
    bool is_black;
    uint8_t *still; /* luma of the street without lamp and noise */
    void *mem;
};

struct live_wish {
    /* device, size and rate; used for any source */
    struct glint_v4l2_config camera;
    enum glint_v4l2_io io; /* I/O method of a camera; other sources ignore it */
    int n_buffers;
    int stride_bytes; /* of rows of luma of bare frames; 0: no padding */
};

struct live_input {
    struct glint_source *source; /* NULL if closed */
    union {
        struct glint_v4l2 camera;
        struct live_timed timed;
    } as;
};

bool live_input_is_camera(const char *name);

/* Opens the source that WISH names; live_input_start() starts it. SEED seeds
 * the noise of the test image. */
enum glint_status live_input_open(struct live_input *input,
                                  const struct live_wish *wish, uint32_t seed,
                                  struct glint_error *error);

/* Starts INPUT, or closes it on failure. */
enum glint_status live_input_start(struct live_input *input,
                                   struct glint_error *error);

/* Prints why DEVICE cannot be opened or started. Returns an exit code. */
int live_input_report_error(const struct live_log *log, const char *device,
                            enum glint_status status,
                            const struct glint_error *error);

/* Closes INPUT, unless it is closed already. */
void live_input_close(struct live_input *input);

#endif
