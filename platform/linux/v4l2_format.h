/* SPDX-License-Identifier: MIT
 *
 * linux/v4l2_format.h - the format that a camera and glint agree on: the
 * cheapest that gives size and rate, unless one is wished for. Part of
 * linux/v4l2_device.h.
 */
#ifndef GLINT_PLATFORM_LINUX_V4L2_FORMAT_H
#define GLINT_PLATFORM_LINUX_V4L2_FORMAT_H

#include "linux/v4l2_device.h"

/* Sets the format and believes what the device answers. Errors as of
 * glint_v4l2_device_open. */
enum glint_status glint_v4l2_set_format(struct glint_v4l2_device *device,
                                        struct glint_error *error);

/* Sets the rate. It is a wish even more than a size is: some inputs have
 * theirs. */
void glint_v4l2_set_rate(struct glint_v4l2_device *device);

#endif
