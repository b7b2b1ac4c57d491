/* SPDX-License-Identifier: MIT */
#include "live/live_input.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "linux/v4l2_buffers.h"
#include "posix/error.h"

enum live_input_kind live_input_kind(const char *device)
{
    const char *dot = strrchr(device, '.');

    return strcmp(device, "test") == 0       ? LIVE_INPUT_TEST
           : strcmp(device, "-") == 0        ? LIVE_INPUT_PIPE
           : dot && strcmp(dot, ".y4m") == 0 ? LIVE_INPUT_FILE
                                             : LIVE_INPUT_CAMERA;
}

enum glint_status live_input_look(const char *name, struct glint_error *error)
{
    const enum live_input_kind kind = live_input_kind(name);
    struct glint_v4l2_device device;
    enum glint_status status;

    if (kind == LIVE_INPUT_FILE && access(name, R_OK) != 0)
        return glint_error_report(error, GLINT_E_IO, name, "%s",
                                  strerror(errno));
    if (kind != LIVE_INPUT_CAMERA)
        return GLINT_OK;
    status = glint_v4l2_device_attach(&device, name, error);
    if (status == GLINT_OK)
        glint_v4l2_device_close(&device);
    return status;
}

/* ------------------------------------------------------------------- frames */

/* Frames that are due since the last time, at least 1; 0: none yet. A pipe's
 * are due when they come. */
static uint64_t due(struct live_input *in)
{
    uint64_t n = 0;

    if (in->timer < 0 || in->n == 0)
        return 1;
    return read(in->timer, &n, sizeof n) == (ssize_t)sizeof n ? n : 0;
}

static enum glint_status read_frame(struct live_input *in,
                                    struct glint_source_frame *frame,
                                    struct glint_error *error)
{
    const struct glint_image *image;
    const enum glint_status status =
        glint_y4m_reader_next(&in->y4m, &image, error);

    if (status != GLINT_OK)
        return status;
    if (!image)
        return GLINT_E_CLOSED;
    frame->image = *image;
    return GLINT_OK;
}

static enum glint_status next(struct glint_source *source,
                              struct glint_source_frame *frame,
                              struct glint_error *error)
{
    struct live_input *in = (struct live_input *)source;
    const struct glint_v4l2_format *f = &in->camera.device.format;
    const uint64_t n = due(in);

    *frame = (struct glint_source_frame){.cached = true};
    if (n == 0)
        return GLINT_OK;
    frame->time_us = glint_v4l2_now_us();
    if (in->kind == LIVE_INPUT_TEST) {
        in->n += (int64_t)n;
        live_scene_draw(&in->scene, in->n - 1, (double)f->fps_num / f->fps_den);
        frame->image = in->scene.image;
    }
    for (uint64_t i = 0; in->kind != LIVE_INPUT_TEST && i < n; i++) {
        const enum glint_status status = read_frame(in, frame, error);

        if (status != GLINT_OK)
            return status;
        in->n++;
    }
    frame->image.range = f->range;
    frame->image.matrix = f->matrix;
    frame->sequence = (uint32_t)in->n;
    frame->n_late = (int)(n - 1);
    return GLINT_OK;
}

static void done(struct glint_source *source, struct glint_source_frame *frame)
{
    (void)source, (void)frame;
}

static void close_input(struct glint_source *source)
{
    struct live_input *in = (struct live_input *)source;

    if (source->fd < 0)
        return;
    source->fd = -1;
    if (in->timer >= 0)
        close(in->timer);
    in->timer = -1;
    if (in->kind == LIVE_INPUT_TEST)
        live_scene_close(&in->scene);
    else
        glint_y4m_reader_close(&in->y4m);
}

/* ------------------------------------------------------------------ opening */

static enum glint_status open_timer(struct live_input *in,
                                    struct glint_error *error)
{
    const struct glint_v4l2_format *f = &in->camera.device.format;
    const int64_t stated = 1000000000LL * f->fps_den / f->fps_num;
    const int64_t ns = stated > 1000 ? stated : 1000; /* 0 would stop it */
    const struct timespec period = {(time_t)(ns / 1000000000),
                                    (long)(ns % 1000000000)};
    const struct itimerspec times = {period, period};

    in->timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
    if (in->timer < 0 || timerfd_settime(in->timer, 0, &times, NULL) < 0)
        return glint_error_report(error, GLINT_E_DEVICE, in->camera.device.path,
                                  "no timer: %s", strerror(errno));
    return GLINT_OK;
}

static enum glint_status open_video(struct live_input *in,
                                    const struct glint_v4l2_config *wish,
                                    struct glint_error *error)
{
    struct glint_v4l2_format *f = &in->camera.device.format;
    const struct glint_y4m_header *h = &in->y4m.header;
    const enum glint_status status =
        glint_y4m_reader_open(&in->y4m, wish->device, error);

    if (status != GLINT_OK)
        return status;
    f->pixels = h->format;
    f->width = h->width;
    f->height = h->height;
    f->range = h->range;
    f->matrix = h->matrix;
    f->transfer = GLINT_TONE_BT709;
    if (h->fps_num > 0) {
        f->fps_num = h->fps_num;
        f->fps_den = h->fps_den;
    }
    return GLINT_OK;
}

static enum glint_status open_test(struct live_input *in,
                                   const struct glint_v4l2_config *wish,
                                   uint32_t seed, struct glint_error *error)
{
    struct glint_v4l2_format *f = &in->camera.device.format;

    f->width = wish->width ? wish->width : 640;
    f->height = wish->width ? wish->height : 360;
    if (f->width < 16 || f->height < 16 || f->width > GLINT_PANEL_SIDE ||
        f->height > GLINT_PANEL_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "test",
                                  "has sides of 16 to %d pixels",
                                  GLINT_PANEL_SIDE);
    if (live_scene_open(&in->scene, f->width, f->height, seed) != GLINT_OK)
        return glint_error_report(error, GLINT_E_MEMORY, "test",
                                  "no memory for %d x %d pixels", f->width,
                                  f->height);
    f->pixels = in->scene.image.format;
    f->range = in->scene.image.range;
    f->matrix = in->scene.image.matrix;
    f->transfer = in->scene.image.transfer;
    return GLINT_OK;
}

static enum glint_status open_stand_in(struct live_input *in,
                                       const struct glint_v4l2_config *wish,
                                       uint32_t seed, struct glint_error *error)
{
    struct glint_v4l2_device *d = &in->camera.device;
    enum glint_status status;

    d->format = (struct glint_v4l2_format){.fps_num = 30, .fps_den = 1};
    status = in->kind == LIVE_INPUT_TEST ? open_test(in, wish, seed, error)
                                         : open_video(in, wish, error);
    if (status != GLINT_OK)
        return status;
    if (wish->fps_num) {
        d->format.fps_num = wish->fps_num;
        d->format.fps_den = wish->fps_den;
    }
    if (wish->range >= 0)
        d->format.range = (enum glint_range)wish->range;
    if (wish->matrix >= 0)
        d->format.matrix = (enum glint_matrix)wish->matrix;
    in->camera.source = (struct glint_source){0, next, done, close_input};
    if (in->kind != LIVE_INPUT_PIPE)
        status = open_timer(in, error);
    in->camera.source.fd = in->kind == LIVE_INPUT_PIPE ? in->y4m.in.fd
                           : in->timer >= 0            ? in->timer
                                                       : 0;
    if (status != GLINT_OK)
        close_input(&in->camera.source);
    return status;
}

enum glint_status live_input_open(struct live_input *input,
                                  const struct glint_v4l2_config *wish,
                                  enum glint_v4l2_io io, int n_buffers,
                                  uint32_t seed, struct glint_error *error)
{
    struct glint_v4l2_device *d = &input->camera.device;

    input->kind = live_input_kind(wish->device);
    input->timer = -1;
    input->n = 0;
    if (input->kind == LIVE_INPUT_CAMERA)
        return glint_v4l2_open(&input->camera, wish, io, n_buffers, error);
    memset(&input->camera, 0, sizeof input->camera);
    input->camera.source.fd = d->fd = -1;
    input->camera.is_cached = d->has_signal = true;
    snprintf(d->path, sizeof d->path, "%s", wish->device);
    snprintf(d->card, sizeof d->card, "%s",
             input->kind == LIVE_INPUT_TEST ? "a lamp over a night street"
                                            : "a video");
    return open_stand_in(input, wish, seed, error);
}
