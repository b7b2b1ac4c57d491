/* SPDX-License-Identifier: MIT */
#include "linux/v4l2_device.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "linux/request.h"
#include "linux/v4l2_format.h"
#include "posix/error.h"

/* ------------------------------------------------------------------- device */

static enum glint_status open_node(struct glint_v4l2_device *d,
                                   struct glint_error *error)
{
    struct stat st;

    if (stat(d->path, &st) < 0)
        return glint_error_report(
            error, GLINT_E_DEVICE, d->path, "%s",
            errno == ENOENT ? "no such device; --list-devices shows the cameras"
                            : strerror(errno));
    if (!S_ISCHR(st.st_mode))
        return glint_error_report(error, GLINT_E_DEVICE, d->path,
                                  "not a device");
    d->fd = open(d->path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return d->fd < 0 ? glint_ioctl_failed(error, d->path, "cannot be opened")
                     : GLINT_OK;
}

enum glint_status glint_v4l2_device_attach(struct glint_v4l2_device *d,
                                           const char *name,
                                           struct glint_error *error)
{
    struct v4l2_capability cap = {.driver = ""};
    enum glint_status status;

    *d = (struct glint_v4l2_device){.fd = -1, .has_signal = true};
    if (snprintf(d->path, sizeof d->path, "%s%s",
                 isdigit((unsigned char)*name) ? "/dev/video" : "",
                 name) >= GLINT_V4L2_PATH)
        return glint_error_report(error, GLINT_E_DEVICE, name,
                                  "the name is too long");
    status = open_node(d, error);
    if (status != GLINT_OK)
        return status;
    if (glint_ioctl(d->fd, VIDIOC_QUERYCAP, &cap) < 0) {
        status = errno == ENODEV
                     ? glint_ioctl_failed(error, d->path, "VIDIOC_QUERYCAP")
                     : glint_error_report(error, GLINT_E_DEVICE, d->path,
                                          "not a camera: does not speak V4L2");
        glint_v4l2_device_close(d);
        return status;
    }
    d->caps = cap.capabilities & V4L2_CAP_DEVICE_CAPS ? cap.device_caps
                                                      : cap.capabilities;
    d->type = d->caps & V4L2_CAP_VIDEO_CAPTURE
                  ? V4L2_BUF_TYPE_VIDEO_CAPTURE
                  : V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
    snprintf(d->card, sizeof d->card, "%s", (const char *)cap.card);
    d->is_loopback = strcmp((const char *)cap.driver, "v4l2 loopback") == 0;
    if (d->caps & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE))
        return GLINT_OK;
    glint_v4l2_device_close(d);
    return glint_error_report(error, GLINT_E_DEVICE, d->path,
                              "not a camera: '%s' captures no pictures here",
                              (const char *)cap.card);
}

void glint_v4l2_device_close(struct glint_v4l2_device *d)
{
    if (d->fd >= 0)
        close(d->fd);
    d->fd = -1;
}

/* -------------------------------------------------------------------- input */

static void note_input(struct glint_v4l2_device *d)
{
    struct v4l2_input input = {.index = 0};
    int index = 0;

    if (glint_ioctl(d->fd, VIDIOC_G_INPUT, &index) < 0)
        return;
    d->input = input.index = (uint32_t)index;
    if (glint_ioctl(d->fd, VIDIOC_ENUMINPUT, &input) == 0)
        d->is_dv = input.capabilities & V4L2_IN_CAP_DV_TIMINGS;
}

/* Subscribes to changes of the source. Drivers whose source never changes
 * refuse with EINVAL, which is ignored. */
static void subscribe(const struct glint_v4l2_device *d)
{
    struct v4l2_event_subscription wanted = {.type = V4L2_EVENT_SOURCE_CHANGE,
                                             .id = d->input};

    glint_ioctl(d->fd, VIDIOC_SUBSCRIBE_EVENT, &wanted);
}

static enum glint_status choose_input(struct glint_v4l2_device *d,
                                      struct glint_error *error)
{
    int index = d->wish.input;

    if (index >= 0 && glint_ioctl(d->fd, VIDIOC_S_INPUT, &index) < 0)
        return errno == EINVAL
                   ? glint_error_report(error, GLINT_E_DEVICE, d->path,
                                        "has no input %d", d->wish.input)
                   : glint_ioctl_failed(error, d->path, "VIDIOC_S_INPUT");
    note_input(d);
    subscribe(d);
    return GLINT_OK;
}

static bool same_timings(const struct v4l2_bt_timings *a,
                         const struct v4l2_bt_timings *b)
{
    return a->width == b->width && a->height == b->height &&
           a->pixelclock == b->pixelclock && a->interlaced == b->interlaced;
}

bool glint_v4l2_device_retimed(struct glint_v4l2_device *d)
{
    struct v4l2_dv_timings now, set;

    if (!d->is_dv)
        return false;
    d->has_signal = glint_ioctl(d->fd, VIDIOC_QUERY_DV_TIMINGS, &now) == 0;
    return d->has_signal &&
           glint_ioctl(d->fd, VIDIOC_G_DV_TIMINGS, &set) == 0 &&
           !same_timings(&now.bt, &set.bt);
}

/* Sets an HDMI input to the timings it receives, as it keeps old ones until it
 * is told. Notes whether it has a signal. */
static enum glint_status follow_timings(struct glint_v4l2_device *d,
                                        struct glint_error *error)
{
    struct v4l2_dv_timings now;

    if (!d->is_dv)
        return GLINT_OK;
    d->has_signal = glint_ioctl(d->fd, VIDIOC_QUERY_DV_TIMINGS, &now) == 0;
    if (d->has_signal && glint_ioctl(d->fd, VIDIOC_S_DV_TIMINGS, &now) < 0)
        return glint_ioctl_failed(error, d->path, "VIDIOC_S_DV_TIMINGS");
    return GLINT_OK;
}

enum glint_status glint_v4l2_device_negotiate(struct glint_v4l2_device *d,
                                              struct glint_error *error)
{
    enum glint_status status = follow_timings(d, error);

    if (status == GLINT_OK)
        status = glint_v4l2_set_format(d, error);
    if (status == GLINT_OK)
        glint_v4l2_set_rate(d);
    return status;
}

enum glint_status glint_v4l2_device_open(struct glint_v4l2_device *d,
                                         const struct glint_v4l2_config *wish,
                                         struct glint_error *error)
{
    enum glint_status status = glint_v4l2_device_attach(d, wish->device, error);

    if (status != GLINT_OK)
        return status;
    d->wish = *wish;
    status = choose_input(d, error);
    if (status == GLINT_OK)
        status = glint_v4l2_device_negotiate(d, error);
    if (status != GLINT_OK)
        glint_v4l2_device_close(d);
    return status;
}
