/* SPDX-License-Identifier: MIT */
#include "live/live_timed.h"

#include <errno.h>
#include <string.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "posix/clock.h"
#include "posix/error.h"

static void done(struct glint_source *source, struct glint_source_frame *frame)
{
    (void)source, (void)frame;
}

static void describe(const struct glint_source *source,
                     struct glint_source_format *format)
{
    *format = ((const struct live_timed *)source)->format;
}

/* Starts the timer, unless the source has an fd of its own. */
static enum glint_status start(struct glint_source *source,
                               struct glint_error *error)
{
    struct live_timed *timed = (struct live_timed *)source;
    const struct glint_source_format *f = &timed->format;
    const int64_t stated = 1000000000LL * f->fps_den / f->fps_num;
    /* 0 would stop the timer */
    const int64_t ns = stated > 1000 ? stated : 1000;
    const struct timespec period = {(time_t)(ns / 1000000000),
                                    (long)(ns % 1000000000)};
    const struct itimerspec times = {period, period};

    if (source->fd >= 0)
        return GLINT_OK;
    timed->timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
    if (timed->timer < 0 || timerfd_settime(timed->timer, 0, &times, NULL) < 0)
        return glint_error_report(error, GLINT_E_DEVICE, timed->name,
                                  "no timer: %s", strerror(errno));
    source->fd = timed->timer;
    return GLINT_OK;
}

void live_timed_init(struct live_timed *timed,
                     const struct glint_source_format *format,
                     const struct glint_v4l2_config *wish, const char *card)
{
    struct glint_source_format *f = &timed->format;

    *timed = (struct live_timed){.source = {.fd = -1,
                                            .has_signal = true,
                                            .start = start,
                                            .done = done,
                                            .describe = describe},
                                 .format = *format,
                                 .name = wish->device,
                                 .timer = -1};
    if (f->fps_num == 0)
        f->fps_num = 30, f->fps_den = 1;
    if (wish->fps_num) {
        f->fps_num = wish->fps_num;
        f->fps_den = wish->fps_den;
    }
    if (wish->range >= 0)
        f->image.range = (enum glint_range)wish->range;
    if (wish->matrix >= 0)
        f->image.matrix = (enum glint_matrix)wish->matrix;
    snprintf(f->text, sizeof f->text, "%.256s (%s): %dx%d, %.5g fps",
             wish->device, card, f->image.width, f->image.height,
             (double)f->fps_num / f->fps_den);
}

/* Returns how many frames are due now. The first is due at once; without a
 * timer one is due at every call. */
static uint64_t count_due(struct live_timed *timed)
{
    uint64_t n = 0;

    if (timed->timer < 0 || timed->n == 0)
        return 1;
    return read(timed->timer, &n, sizeof n) == (ssize_t)sizeof n ? n : 0;
}

uint64_t live_timed_due(struct live_timed *timed,
                        struct glint_source_frame *frame)
{
    const uint64_t n = count_due(timed);

    *frame = (struct glint_source_frame){.is_drawable = true};
    if (n > 0)
        frame->time_us = glint_now_us();
    return n;
}

void live_timed_show(struct live_timed *timed, struct glint_source_frame *frame,
                     const struct glint_image *image, uint64_t n)
{
    frame->image = *image;
    frame->image.range = timed->format.image.range;
    frame->image.matrix = timed->format.image.matrix;
    frame->sequence = (uint32_t)timed->n;
    frame->n_late = (int)(n - 1);
}

void live_timed_stop(struct live_timed *timed)
{
    if (timed->timer >= 0)
        close(timed->timer);
    timed->timer = -1;
    timed->source.fd = -1;
}
