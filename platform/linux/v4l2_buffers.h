/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_buffers.h - the memory that frames come in, and its way to the
 * driver and back. Part of linux/v4l2.h; failures leave errno set.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_BUFFERS_H
#define GLINT_PLATFORM_LINUX_V4L2_BUFFERS_H

#include "linux/v4l2.h"

/* The outcome of asking for a frame. */
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

/* Gets buffers of the kind that the device allows. Returns NULL, or what
 * failed, for the user. */
const char *glint_v4l2_get_buffers(struct glint_v4l2 *v);
void glint_v4l2_release_buffers(struct glint_v4l2 *v);

/* Gives buffer INDEX to the driver. */
int glint_v4l2_queue(struct glint_v4l2 *v, int index);

/* Takes a filled one back. */
enum glint_v4l2_outcome glint_v4l2_take(struct glint_v4l2 *v,
                                        struct glint_v4l2_taken *t);

/* Returns whether frames could be handed on without a copy; for reports alone.
 */
bool glint_v4l2_can_export(const struct glint_v4l2 *v);

/* Returns whether buffers are read as fast as other memory. No driver says, so
 * it is tried. */
bool glint_v4l2_is_cached(const struct glint_v4l2 *v);

#endif
