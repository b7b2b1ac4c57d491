/* SPDX-License-Identifier: MIT */
#include "live/live_picture.h"

#include <stdlib.h>
#include <string.h>

#include "panel/panel.h"
#include "formats/picture.h"

const struct glint_image *live_copy_image(struct live_copy *c,
                                          const struct glint_image *from)
{
    const size_t bytes =
        glint_image_bytes(from->format, from->width, from->height);

    if (bytes > c->bytes) {
        free(c->mem);
        c->mem = malloc(bytes);
        c->bytes = c->mem ? bytes : 0;
        if (!c->mem)
            return NULL;
    }
    c->image = *from;
    glint_image_place(&c->image, c->mem);
    for (int p = 0; p < glint_image_planes(from->format); p++)
        for (int y = 0;
             y < glint_image_plane_height(from->format, p, from->height); y++)
            memcpy(c->image.plane[p] + y * c->image.stride_bytes[p],
                   from->plane[p] + y * from->stride_bytes[p],
                   glint_image_row_bytes(from->format, p, from->width));
    return &c->image;
}

void live_copy_free(struct live_copy *c)
{
    free(c->mem);
    *c = (struct live_copy){.mem = NULL};
}

enum glint_status live_save_image(const char *name,
                                  const struct glint_image *from,
                                  struct glint_error *error)
{
    const struct glint_panel_config as_rgb = {
        .width = from->width,
        .height = from->height,
        .layout = {3, {0, 8}, {8, 8}, {16, 8}, {0, 0}},
        .image_width = from->width,
        .image_height = from->height};
    struct glint_image rgb = {
        .format = GLINT_RGB24, .width = from->width, .height = from->height};
    struct glint_panel panel;
    enum glint_status status = glint_panel_open(&panel, &as_rgb, error);
    void *mem;

    if (status != GLINT_OK)
        return status;
    mem = malloc(glint_image_bytes(rgb.format, rgb.width, rgb.height));
    if (mem) {
        glint_image_place(&rgb, mem);
        glint_panel_draw(&panel, from, mem, rgb.stride_bytes[0]);
        status = glint_picture_save(name, &rgb, error);
    } else
        status = GLINT_E_MEMORY;
    free(mem);
    glint_panel_close(&panel);
    return status;
}
