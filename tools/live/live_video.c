/* SPDX-License-Identifier: MIT */
#include "live/live_video.h"

#include <string.h>

/* Of the frames that are due the last that there is is shown, also where the
 * video ends before; those before it are late. */
static enum glint_status next(struct glint_source *source,
                              struct glint_source_frame *frame,
                              struct glint_error *error)
{
    struct live_video *v = (struct live_video *)source;
    const uint64_t n = live_timed_due(&v->timed, frame);
    const struct glint_image *image = NULL, *after = NULL;
    uint64_t n_read = 0;

    while (n_read < n) {
        const enum glint_status status =
            glint_y4m_reader_next(&v->reader, &after, error);

        if (status != GLINT_OK)
            return status;
        if (!after)
            break;
        image = after;
        n_read++;
    }
    v->timed.n += (int64_t)n_read;
    if (image)
        live_timed_show(&v->timed, frame, image, n_read);
    return n > 0 && !image ? GLINT_E_CLOSED : GLINT_OK;
}

static void close_video(struct glint_source *source)
{
    struct live_video *v = (struct live_video *)source;

    live_timed_stop(&v->timed);
    glint_y4m_reader_close(&v->reader);
}

enum glint_status live_video_open(struct live_video *video,
                                  const struct glint_v4l2_config *wish,
                                  struct glint_error *error)
{
    const struct glint_y4m_header *h = &video->reader.header;
    const enum glint_status status =
        glint_y4m_reader_open(&video->reader, wish->device, error);

    if (status != GLINT_OK)
        return status;
    live_timed_init(
        &video->timed,
        &(struct glint_source_format){.image = {.format = h->format,
                                                .width = h->width,
                                                .height = h->height,
                                                .range = h->range,
                                                .matrix = h->matrix,
                                                .transfer = GLINT_TONE_BT709},
                                      .fps_num = h->fps_num,
                                      .fps_den = h->fps_den},
        wish, "a video");
    video->timed.source.next = next;
    video->timed.source.close = close_video;
    if (strcmp(wish->device, "-") == 0)
        video->timed.source.fd = video->reader.in.fd;
    return GLINT_OK;
}
