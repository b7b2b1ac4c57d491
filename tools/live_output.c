/* SPDX-License-Identifier: MIT */
#include "live_output.h"

#include <string.h>

bool live_output_parse(struct live_output *o, const char *name)
{
    static const char *const kinds[] = {"fb", "y4m", "v4l2", "null"};
    const char *colon = strchr(name, ':');
    const size_t length = colon ? (size_t)(colon - name) : strlen(name);

    o->sink = NULL;
    o->path = colon ? colon + 1 : NULL;
    for (int k = 0; k < 4; k++)
        if (strlen(kinds[k]) == length && memcmp(kinds[k], name, length) == 0) {
            o->kind = (enum live_output_kind)k;
            return k == LIVE_OUTPUT_NULL ? !colon
                   : k == LIVE_OUTPUT_FB ? !colon || *o->path
                                         : colon && *o->path;
        }
    return false;
}

bool live_output_is_flexible(const struct live_output *o)
{
    return o->kind == LIVE_OUTPUT_FB || o->kind == LIVE_OUTPUT_NULL;
}

static enum glint_status open_fb(struct live_output *o,
                                 enum glint_panel_fit fit,
                                 struct glint_error *error)
{
    const struct glint_fbdev_options options = {
        .fit = fit, .vsync = false, .console = true};
    const enum glint_status status =
        glint_fbdev_open(&o->as.fb, o->path, &options, error);

    o->sink = status == GLINT_OK ? &o->as.fb.sink : NULL;
    return status;
}

static enum glint_status nput(struct glint_sink *s, const struct glint_image *i,
                              struct glint_error *e)
{
    (void)s;
    (void)i;
    (void)e;
    return GLINT_OK;
}
static void nclose(struct glint_sink *s)
{
    (void)s;
}
static enum glint_status open_null(struct live_output *o)
{
    o->as.null = (struct glint_sink){nput, nclose};
    o->sink = &o->as.null;
    return GLINT_OK;
}

enum glint_status live_output_open(struct live_output *o,
                                   const struct glint_image *image, int fps_num,
                                   int fps_den, enum glint_panel_fit fit,
                                   struct glint_error *error)
{
    switch (o->kind) {
    case LIVE_OUTPUT_FB:
        return open_fb(o, fit, error);
    default:
        return open_null(o);
    }
}

void live_output_close(struct live_output *o)
{
    if (o->sink)
        o->sink->close(o->sink);
    o->sink = NULL;
}
