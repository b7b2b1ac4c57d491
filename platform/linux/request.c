/* SPDX-License-Identifier: MIT */
#include "linux/request.h"

#include <errno.h>
#include <string.h>
#include <sys/ioctl.h>

#include "posix/error.h"

int glint_ioctl(int fd, unsigned long request, void *arg)
{
    int r;

    do
        r = ioctl(fd, request, arg);
    while (r < 0 && errno == EINTR);
    return r;
}

static const char *get_error_advice(int number)
{
    switch (number) {
    case EACCES:
    case EPERM:
        return "; its users must be in the group 'video'";
    case EBUSY:
        return "; another program is using it";
    case ENODEV:
    case ENXIO:
        return "; the device was removed";
    }
    return "";
}

enum glint_status glint_report_ioctl_error(struct glint_error *error,
                                           const char *path,
                                           const char *request)
{
    const int number = errno;

    return glint_error_report(error, GLINT_E_DEVICE, path, "%s: %s%s", request,
                              strerror(number), get_error_advice(number));
}
