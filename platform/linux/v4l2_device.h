/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_device.h - a camera before it streams: identity, capabilities, and
 * the negotiated format.
 *
 * A configuration is only a request. The device answers with a format that it
 * supports, and glint uses this format, including its strides and sizes.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_DEVICE_H
#define GLINT_PLATFORM_LINUX_V4L2_DEVICE_H

#include <stdbool.h>
#include <stdio.h>

#include "glint/image.h"
#include "glint/status.h"

/* Max length of a path, bytes; udev's names have 80 and more. */
#define GLINT_V4L2_PATH 256

struct glint_v4l2_config {
    /* path of the device, such as "/dev/video0", or its number, such as "0" */
    const char *device;
    int width, height; /* requested size; 0, 0: the device's current size */
    /* requested frames per second; 0: the device's current rate */
    int fps_num, fps_den;
    /* requested format; 0: of the formats with this size and rate, the one in
     * which drawing costs the least */
    uint32_t fourcc;
    int input; /* index of the input; -1: the input that is
                  selected */
    /* range and matrix that replace those that the device states; -1: not
     * replaced */
    int range, matrix;
};

/* The format that the device delivers. */
struct glint_v4l2_format {
    uint32_t fourcc;
    bool is_jpeg;
    enum glint_pixel_format pixels; /* unused if is_jpeg */
    int width, height;
    int n_blocks; /* blocks of memory per frame, 1 .. 3 */
    size_t block_bytes[3];
    struct {
        int block; /* index of the block that holds the plane */
        size_t offset;
        ptrdiff_t stride_bytes;
        size_t bytes; /* bytes of the plane, from its offset on */
    } plane[3];
    enum glint_range range;
    enum glint_matrix matrix;
    enum glint_tone transfer;
    int fps_num, fps_den; /* frames per second; 0: unknown */
};

struct glint_v4l2_device {
    char path[GLINT_V4L2_PATH];
    int fd; /* -1: closed */
    uint32_t caps;
    uint32_t type; /* type of the device's buffers */
    bool is_dv;    /* true: an HDMI input, whose source sets the timings */
    bool has_signal;
    uint32_t input;
    bool is_loopback; /* v4l2loopback: the writer may overwrite a frame that is
                         being read */
    char card[33];
    struct glint_v4l2_config wish;
    struct glint_v4l2_format format;
};

/* Opens the camera and negotiates a format. On failure DEVICE is closed.
 * Returns GLINT_E_DEVICE if there is no such device, permission is missing, it
 * is not a camera, or it is in use; GLINT_E_UNSUPPORTED if it has no format
 * that glint reads. */
enum glint_status glint_v4l2_device_open(struct glint_v4l2_device *device,
                                         const struct glint_v4l2_config *wish,
                                         struct glint_error *error);

/* Negotiates the format again, after the source changed or the stream broke. */
enum glint_status glint_v4l2_device_negotiate(struct glint_v4l2_device *device,
                                              struct glint_error *error);

/* Returns whether the timings that an HDMI input receives differ from its
 * settings; false for other inputs. Sets has_signal. */
bool glint_v4l2_device_has_new_timings(struct glint_v4l2_device *device);

void glint_v4l2_device_close(struct glint_v4l2_device *device);

/* Writes FORMAT as text, such as "YUYV 640x480 at 30 fps, BT.601 limited,
 * sRGB". */
void glint_v4l2_format_text(const struct glint_v4l2_format *format,
                            char text[96]);

/* Print to OUT all cameras, or the formats, sizes and rates of DEVICE; as JSON
 * if JSON is set, else without formats that glint does not read. */
enum glint_status glint_v4l2_list_devices(FILE *out, bool json);

enum glint_status glint_v4l2_list_formats(FILE *out, const char *device,
                                          bool json, struct glint_error *error);

#endif
