/* SPDX-License-Identifier: MIT */
#include "overlay/overlay_y4m.h"

#include <stdlib.h>
#include <string.h>

#include "overlay/drawing.h"

/* Memory that is used again for each frame of a video */
struct overlay_y4m {
    struct glint_y4m_light light;
    uint8_t *planes;
    float *layer;
};

size_t overlay_y4m_frame_bytes(const struct glint_y4m_reader *in)
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

static enum glint_status draw_scene_on_planes(struct overlay_y4m *y,
                                              struct drawing *drawing)
{
    struct over_scene_layer layer;
    enum glint_status status;

    if (!drawing->files.scene.is_open)
        return GLINT_OK;
    status = over_scene_make_layer(&drawing->files.scene, &layer);
    if (status != GLINT_OK)
        return status;
    glint_y4m_light_cover(&y->light, y->planes, layer.rgb, layer.cover_q8);
    over_scene_layer_free(&layer);
    return GLINT_OK;
}

static enum glint_status draw_flare_on_planes(void *ctx,
                                              struct drawing *drawing,
                                              const struct glint_image *image,
                                              int32_t elapsed_us)
{
    struct overlay_y4m *const y = ctx;
    enum glint_status status =
        drawing_detect_and_draw_scene(drawing, image, elapsed_us);

    if (status == GLINT_OK)
        status = draw_scene_on_planes(y, drawing);
    if (status == GLINT_OK && drawing->files.has_lens)
        status = drawing_set_exposure(drawing, image);
    drawing->run.n_frames++;
    if (status != GLINT_OK || !drawing->files.has_lens)
        return status;
    if (drawing->line.settings.options.layer != GLINT_LAYER_COMPOSITE)
        glint_y4m_light_set_black(&y->light, y->planes);
    if (drawing->run.n_lamps == 0 &&
        !glint_engine_has_veil(drawing->run.engine))
        return GLINT_OK;
    status = drawing_draw_layer(
        &drawing->run,
        y->light.layout.bits > 12 ? GLINT_ENGINE_CODES_16 : GLINT_ENGINE_CODES,
        y->layer);
    if (status == GLINT_OK && (drawing_get_exposure_factor(&drawing->run) > 0 ||
                               glint_engine_has_veil(drawing->run.engine)))
        glint_y4m_light_add(&y->light, y->planes, y->layer);
    return status;
}

static struct overlay_y4m *
make_overlay_y4m(const struct glint_y4m_header *header)
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
    if (glint_y4m_is_8_bit_bt709(&in->header))
        return overlay_draw_frame(tool, o, image);
    if (drawing_has_marks(&o->drawing.line))
        return tool_usage(tool,
                          "--show lights needs frames of 8 bits in BT.709, not "
                          "C%s with transfer %s",
                          *in->header.colour ? in->header.colour : "420jpeg",
                          glint_transfer_words[in->header.transfer]);
    if (!o->y4m)
        o->y4m = make_overlay_y4m(&in->header);
    if (!o->y4m)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    o->y4m->planes = in->planes;
    return overlay_draw_frame_by_callback(tool, o, image, draw_flare_on_planes,
                                          o->y4m);
}
