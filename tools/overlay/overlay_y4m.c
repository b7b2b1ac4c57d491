/* SPDX-License-Identifier: MIT */
#include "overlay/overlay_y4m.h"

#include <stdlib.h>
#include <string.h>

#include "overlay/look_layer.h"
#include "video/y4m_light.h"

/* What all frames of a stream share. */
struct overlay_y4m {
    struct glint_y4m_light light;
    uint8_t *planes; /* of the frame */
    float *layer;
};

size_t overlay_y4m_bytes(const struct glint_y4m_reader *in)
{
    return glint_y4m_layout_bytes(&in->header.layout, in->header.width,
                                  in->header.height);
}

void overlay_y4m_close(struct overlay *o)
{
    if (o->y4m)
        free(o->y4m->layer);
    free(o->y4m);
    o->y4m = NULL;
}

static enum glint_status draw(void *ctx, struct look *look,
                              const struct glint_image *image,
                              int32_t elapsed_us)
{
    struct overlay_y4m *const y = ctx;
    enum glint_status status;

    look_find(look, image, elapsed_us);
    look_expose(look, elapsed_us);
    look->n_frames++;
    if (look->flare_only)
        glint_y4m_light_blacken(&y->light, y->planes);
    if (look->n_lamps == 0)
        return GLINT_OK;
    status = look_draw_layer(look, y->light.layout.bits > 12, y->layer);
    if (status == GLINT_OK && look_scale(look) > 0)
        glint_y4m_light_add(&y->light, y->planes, y->layer);
    return status;
}

static struct overlay_y4m *make(const struct glint_y4m_header *header)
{
    struct overlay_y4m *const y = calloc(1, sizeof *y);

    if (!y)
        return NULL;
    y->layer = malloc(3 * (size_t)header->width * (size_t)header->height *
                      sizeof *y->layer);
    glint_y4m_light_init(&y->light, header);
    if (y->layer)
        return y;
    free(y);
    return NULL;
}

int overlay_y4m_draw(struct tool *tool, struct overlay *o,
                     struct glint_y4m_reader *in,
                     const struct glint_image *image)
{
    if (glint_y4m_layout_is_plain(&in->header.layout))
        return overlay_draw(tool, o, image);
    if (o->look.show_lights)
        return tool_usage(tool,
                          "--show lights marks frames of 8 bits, and "
                          "these are C%s",
                          in->header.colour);
    if (!o->y4m)
        o->y4m = make(&in->header);
    if (!o->y4m)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    o->y4m->planes = in->planes;
    return overlay_draw_by(tool, o, image, draw, o->y4m);
}
