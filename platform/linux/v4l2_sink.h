/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_sink.h - a sink that writes frames to a V4L2 output node. With
 * v4l2loopback, other programs see glint's frames as a camera.
 *
 *     glint_v4l2_sink_open(&out, "/dev/video9", &like, 30, 1, &error);
 *     out.sink.put(&out.sink, &image, &error); each frame
 *     out.sink.close(&out.sink);
 *
 * Frames are sent by write(2), in the format, size and colours of LIKE, with
 * the row stride that the driver answers. A frame for which the driver has no
 * free buffer is dropped and counted. Multi-planar nodes, and nodes that only
 * support streaming, are rejected. */
#ifndef GLINT_PLATFORM_LINUX_V4L2_SINK_H
#define GLINT_PLATFORM_LINUX_V4L2_SINK_H

#include "source_sink.h"

struct glint_v4l2_sink {
    struct glint_sink sink;
    char card[33];  /* name of the device */
    long n_frames;  /* number of frames that the device accepted so far */
    long n_dropped; /* number of frames that the device did not accept so far */

    /* Private members. */
    const char *name; /* path of the device; not owned */
    int fd;           /* -1: closed */
    /* frame in the device's format and layout, in mem */
    struct glint_image frame;
    uint8_t *mem;
    size_t bytes;
};

/* Opens the output node PATH; the string must outlive OUT. LIKE has format,
 * size and colours of all frames; its planes are not read. A rate of 0, 0 is
 * not passed to the device. On failure OUT is closed. Returns GLINT_E_DEVICE if
 * PATH does not exist, is not an output, is busy, or does not accept this
 * format; GLINT_E_UNSUPPORTED if V4L2 has no FOURCC for the format; or
 * GLINT_E_MEMORY. */
enum glint_status glint_v4l2_sink_open(struct glint_v4l2_sink *out,
                                       const char *path,
                                       const struct glint_image *like,
                                       int fps_num, int fps_den,
                                       struct glint_error *error);

#endif
