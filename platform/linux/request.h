/* SPDX-License-Identifier: MIT
 *
 * linux/request.h - ioctl requests to devices, and their error messages.
 */
#ifndef GLINT_PLATFORM_LINUX_REQUEST_H
#define GLINT_PLATFORM_LINUX_REQUEST_H

#include "glint/status.h"

/* Calls ioctl(2), and calls it again whenever a signal interrupts it. */
int glint_ioctl(int fd, unsigned long request, void *arg);

/* Sets ERROR to "PATH: REQUEST: cause" by errno, with advice for some causes.
 * Returns GLINT_E_DEVICE. */
enum glint_status glint_report_ioctl_error(struct glint_error *error,
                                           const char *path,
                                           const char *request);

#endif
