/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_format.h - the format that a camera and glint agree on: the
 * cheapest that gives size and rate, unless one is wished for. Part of
 * linux/v4l2_device.h.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_FORMAT_H
#define GLINT_PLATFORM_LINUX_V4L2_FORMAT_H

#include "linux/v4l2_device.h"

/* Sets the format wished for and takes over the one that the device answers.
 * Errors are those of glint_v4l2_device_open(). */
enum glint_status glint_v4l2_set_format(struct glint_v4l2_device *device,
                                        struct glint_error *error);

/* Asks for the rate wished for, if any, and notes the rate that the device has;
 * some inputs have one of their own. */
void glint_v4l2_set_rate(struct glint_v4l2_device *device);

#endif
