/* SPDX-License-Identifier: MIT
 *
 * live_timed.h - the common part of sources without a device: frames that are
 * due by a clock, and a format that is known when the source is opened.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_TIMED_H
#define GLINT_TOOLS_LIVE_LIVE_TIMED_H

#include "linux/v4l2_device.h"
#include "source_sink.h"

struct live_timed {
    struct glint_source source;
    struct glint_source_format format;
    const char *name; /* of the source, in errors */
    int timer;        /* -1: each frame is due when it comes */
    int64_t n;        /* number of the next frame */
};

/* Prepares TIMED for frames of FORMAT, with the rate, range and matrix of WISH
 * if it gives any. CARD says what the source is. start begins a timer and makes
 * it the source's fd. The implementation sets next and close. */
void live_timed_init(struct live_timed *timed,
                     const struct glint_source_format *format,
                     const struct glint_v4l2_config *wish, const char *card);

/* Begins FRAME. Returns how many frames have come due since the last call, of
 * which the last is to be shown; 0 if none has. */
uint64_t live_timed_due(struct live_timed *timed,
                        struct glint_source_frame *frame);

/* Completes FRAME with IMAGE, the last of N frames that were due. */
void live_timed_show(struct live_timed *timed, struct glint_source_frame *frame,
                     const struct glint_image *image, uint64_t n);

void live_timed_stop(struct live_timed *timed);

#endif
