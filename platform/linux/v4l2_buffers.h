/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_buffers.h - the buffers of frames, and their exchange with the
 * driver. Part of linux/v4l2.h; failures leave errno set.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_BUFFERS_H
#define GLINT_PLATFORM_LINUX_V4L2_BUFFERS_H

#include "linux/v4l2.h"

/* outcome of glint_v4l2_take() */
enum glint_v4l2_outcome {
    GLINT_V4L2_TAKEN,
    GLINT_V4L2_NOTHING,
    GLINT_V4L2_BROKEN,
    GLINT_V4L2_GONE
};

struct glint_v4l2_taken {
    int index;
    /* Bytes of each block, and the place where its data begin. */
    size_t bytes[3], start[3];
    uint32_t sequence;
    int64_t time_us;
    bool damaged;
};

/* Gets buffers of the first kind that wish and device allow. Returns NULL, or
 * the call that failed, as text. */
const char *glint_v4l2_get_buffers(struct glint_v4l2 *v);
void glint_v4l2_release_buffers(struct glint_v4l2 *v);

/* Gives buffer INDEX to the driver. Returns 0, or -1 with errno set. */
int glint_v4l2_queue(struct glint_v4l2 *v, int index);

/* Takes a filled buffer from the driver and describes it in T. */
enum glint_v4l2_outcome glint_v4l2_take(struct glint_v4l2 *v,
                                        struct glint_v4l2_taken *t);

/* Returns whether buffers could be handed on without a copy; for reports
 * only. */
bool glint_v4l2_can_export(const struct glint_v4l2 *v);

/* Measures whether buffers are read about as fast as other memory, as no driver
 * says it. */
bool glint_v4l2_is_cached(const struct glint_v4l2 *v);

#endif
