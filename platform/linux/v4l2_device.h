/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_device.h - a camera before it streams: identity, capabilities, and
 * the negotiated format.
 *
 * A configuration is a request: the device answers with what it supports, and
 * glint uses that, including strides and sizes.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_DEVICE_H
#define GLINT_PLATFORM_LINUX_V4L2_DEVICE_H

#include <stdbool.h>
#include <stdio.h>

#include "glint/image.h"
#include "glint/status.h"

#define GLINT_V4L2_PATH 256 /* bytes; names by udev have 80 and more */

struct glint_v4l2_config {
    const char *device;   /* "/dev/video0", or "0" for short */
    int width, height;    /* 0, both: as the device is set */
    int fps_num, fps_den; /* frames a second; 0: as the device is set */
    uint32_t fourcc;      /* 0: the cheapest format that gives size and rate */
    int input;            /* -1: the input that is selected */
    /* Range and matrix to use in place of the device's; -1: the device's. */
    int range, matrix;
};

/* The format that the device delivers. */
struct glint_v4l2_format {
    uint32_t fourcc;
    bool is_jpeg;
    enum glint_pixel_format pixels; /* unused if is_jpeg */
    int width, height;
    int n_blocks; /* blocks of memory a frame lies in, 1 .. 3 */
    size_t block_bytes[3];
    struct {
        int block; /* number of the block that the plane lies in */
        size_t offset;
        ptrdiff_t stride_bytes;
        size_t bytes; /* bytes of the plane, from its offset on */
    } plane[3];
    enum glint_range range;
    enum glint_matrix matrix;
    enum glint_tone transfer;
    int fps_num, fps_den; /* 0: the device does not say */
};

struct glint_v4l2_device {
    char path[GLINT_V4L2_PATH];
    int fd; /* -1: closed */
    uint32_t caps;
    uint32_t type; /* type of the device's buffers */
    bool is_dv;    /* the input has timings of its own: HDMI */
    bool has_signal;
    uint32_t input;
    bool is_loopback; /* v4l2loopback: its writer continues writing into frames
                         that were handed out */
    char card[33];
    struct glint_v4l2_config wish;
    struct glint_v4l2_format format;
};

/* Opens the camera and agrees on a format. On failure DEVICE is closed.
 * GLINT_E_DEVICE: there is no such device, no permission, it is not a camera,
 * or in use. GLINT_E_UNSUPPORTED: it has no format that glint reads. */
enum glint_status glint_v4l2_device_open(struct glint_v4l2_device *device,
                                         const struct glint_v4l2_config *wish,
                                         struct glint_error *error);

/* Agrees on a format again, after the source changed or the stream broke. */
enum glint_status glint_v4l2_device_negotiate(struct glint_v4l2_device *device,
                                              struct glint_error *error);

/* Returns whether an HDMI input receives other timings than it is set to; false
 * for other inputs. Sets has_signal. */
bool glint_v4l2_device_retimed(struct glint_v4l2_device *device);

void glint_v4l2_device_close(struct glint_v4l2_device *device);

/* Writes FORMAT as "YUYV 640x480 at 30 fps, BT.601 limited, sRGB". */
void glint_v4l2_format_text(const struct glint_v4l2_format *format,
                            char text[96]);

/* Print all cameras, or the formats, sizes and rates of DEVICE, as JSON if
 * JSON. */
enum glint_status glint_v4l2_list_devices(FILE *out, bool json);

enum glint_status glint_v4l2_list_formats(FILE *out, const char *device,
                                          bool json, struct glint_error *error);

#endif
