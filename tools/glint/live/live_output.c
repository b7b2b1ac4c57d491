/* SPDX-License-Identifier: MIT */
#include "live/live.h"

#include <string.h>
#include <unistd.h>

bool live_output_parse(struct live_output *o, const char *name)
{
    static const char *const kinds[] = {"fb",   "kms",  "y4m",
                                        "v4l2", "null", "window"};
    const char *colon = strchr(name, ':');
    const size_t length = colon ? (size_t)(colon - name) : strlen(name);

    o->sink = NULL;
    o->path = colon ? colon + 1 : NULL;
    for (int k = 0; k < 6; k++)
        if (strlen(kinds[k]) == length && memcmp(kinds[k], name, length) == 0) {
            o->kind = (enum live_output_kind)k;
            return k == LIVE_OUTPUT_NULL || k == LIVE_OUTPUT_WINDOW ? !colon
                   : k == LIVE_OUTPUT_FB || k == LIVE_OUTPUT_KMS
                       ? !colon || *o->path
                       : colon && *o->path;
        }
    if (!glint_y4m_has_extension(name))
        return false;
    o->kind = LIVE_OUTPUT_Y4M;
    o->path = name;
    return true;
}

bool live_output_accepts_any_size(const struct live_output *o)
{
    return o->kind == LIVE_OUTPUT_FB || o->kind == LIVE_OUTPUT_KMS ||
           o->kind == LIVE_OUTPUT_NULL || o->kind == LIVE_OUTPUT_WINDOW;
}

/* Systems have a framebuffer, a device of KMS, or both. If no device is named,
 * the other one replaces one that is missing. */
static void choose_display(struct live_output *o)
{
    const bool has_kms = glint_kms_is_present();

    if (o->path || (o->kind != LIVE_OUTPUT_FB && o->kind != LIVE_OUTPUT_KMS) ||
        has_kms == (access("/dev/fb0", F_OK) == 0))
        return;
    o->kind = has_kms ? LIVE_OUTPUT_KMS : LIVE_OUTPUT_FB;
}

enum glint_status live_output_open(struct live_output *o,
                                   const struct glint_image *image, int fps_num,
                                   int fps_den, struct glint_error *error)
{
    const struct glint_fbdev_options panel = {.fit = o->fit, .console = true};
    enum glint_status status = GLINT_OK;

    choose_display(o);
    switch (o->kind) {
    case LIVE_OUTPUT_KMS:
        status = glint_kms_open(&o->as.kms, o->path, o->fit, error);
        break;
    case LIVE_OUTPUT_FB:
        status = glint_fbdev_open(&o->as.fb, o->path, &panel, error);
        break;
    case LIVE_OUTPUT_V4L2:
        status = glint_v4l2_sink_open(&o->as.v4l2, o->path, image, fps_num,
                                      fps_den, error);
        break;
    case LIVE_OUTPUT_Y4M:
        glint_y4m_sink_open(&o->as.y4m, o->path, fps_num, fps_den);
        break;
    case LIVE_OUTPUT_WINDOW:
        status = glint_window_open(&o->as.window, "glint live", error);
        break;
    default:
        glint_null_sink_open(&o->as.null);
        break;
    }
    o->sink = status == GLINT_OK ? &o->as.sink : NULL;
    return status;
}

const char *live_output_describe(const struct live_output *o, char *text,
                                 size_t size)
{
    const struct glint_fbdev *fb = &o->as.fb;
    const struct glint_kms *kms = &o->as.kms;

    *text = '\0';
    if (o->kind == LIVE_OUTPUT_FB)
        snprintf(text, size, "%s: %dx%d, %d bits a pixel%s", fb->id, fb->width,
                 fb->height, 8 * fb->layout.bytes,
                 fb->n_pages > 1 ? ", double-buffered" : "");
    else if (o->kind == LIVE_OUTPUT_KMS)
        snprintf(text, size,
                 "%s: %dx%d, %d Hz, %d bits a pixel, double-buffered",
                 kms->connector, kms->width, kms->height, kms->refresh_hz,
                 8 * kms->layout.bytes);
    else if (o->kind == LIVE_OUTPUT_V4L2)
        snprintf(text, size, "%s", o->as.v4l2.card);
    return text;
}

const char *live_output_get_console_note(const struct live_output *o)
{
    return o->kind == LIVE_OUTPUT_FB && o->as.fb.has_note ? o->as.fb.note.text
                                                          : NULL;
}

long live_output_count_dropped_frames(const struct live_output *o)
{
    return !o->sink                      ? 0
           : o->kind == LIVE_OUTPUT_Y4M  ? o->as.y4m.n_dropped
           : o->kind == LIVE_OUTPUT_KMS  ? o->as.kms.n_dropped
           : o->kind == LIVE_OUTPUT_V4L2 ? o->as.v4l2.n_dropped
                                         : 0;
}

enum glint_status live_output_close(struct live_output *o,
                                    struct glint_error *error)
{
    enum glint_status status = GLINT_OK;

    if (o->sink && o->kind == LIVE_OUTPUT_Y4M)
        status = glint_y4m_sink_finish(&o->as.y4m, error);
    else if (o->sink)
        o->sink->close(o->sink);
    o->sink = NULL;
    return status;
}
