/* SPDX-License-Identifier: MIT
 *
 * linux/request.h - requests to devices, and what their failure means.
 */
#ifndef GLINT_PLATFORM_LINUX_REQUEST_H
#define GLINT_PLATFORM_LINUX_REQUEST_H

#include "glint/status.h"

/* ioctl(2), again while signals interrupt it. */
int glint_ioctl(int fd, unsigned long request, void *arg);

/* Fills ERROR with "PATH: REQUEST: why", for errno and with what to do about it
 * where that is known; returns GLINT_E_DEVICE. */
enum glint_status glint_ioctl_failed(struct glint_error *error,
                                     const char *path, const char *request);

#endif
