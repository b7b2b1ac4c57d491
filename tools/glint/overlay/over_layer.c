/* SPDX-License-Identifier: MIT
 *
 * The scene that was drawn last by itself. */
#include <math.h>
#include <stdlib.h>

#include "overlay/over_scene.h"

void over_scene_layer_free(struct over_scene_layer *layer)
{
    free(layer->rgb);
    free(layer->cover_q8);
    *layer = (struct over_scene_layer){NULL, NULL};
}

/* Draws over a picture of LIGHT_Q20, n samples at LINEAR_Q20. */
static void draw_over(struct over_scene *over, int32_t light, size_t n,
                      int32_t *linear_q20)
{
    struct glint_image image = {.format = GLINT_LINEAR_Q20,
                                .width = over->frame.cfg.width,
                                .height = over->frame.cfg.height};

    for (size_t i = 0; i < n; i++)
        linear_q20[i] = light;
    glint_image_place(&image, linear_q20);
    glint_scene_draw(over->frame.scene, &image);
}

/* What a thing hides of white is what it is over black less what it is over
 * white. */
enum glint_status over_scene_layer(struct over_scene *over,
                                   struct over_scene_layer *layer)
{
    const size_t n =
        (size_t)over->frame.cfg.width * (size_t)over->frame.cfg.height;
    int32_t *const linear_q20 = calloc(3 * n, sizeof *linear_q20);

    layer->rgb = malloc(3 * n * sizeof *layer->rgb);
    layer->cover_q8 = malloc(n * sizeof *layer->cover_q8);
    if (!linear_q20 || !layer->rgb || !layer->cover_q8) {
        free(linear_q20);
        over_scene_layer_free(layer);
        return GLINT_E_MEMORY;
    }
    draw_over(over, 0, 3 * n, linear_q20);
    for (size_t i = 0; i < n; i++)
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            layer->rgb[c] = (float)linear_q20[c] * 0x1p-20F;
    draw_over(over, 1 << 20, 3 * n, linear_q20);
    for (size_t i = 0; i < n; i++)
        layer->cover_q8[i] =
            (uint16_t)lrintf(256 + 256 * layer->rgb[3 * i] -
                             0x1p-12F * (float)linear_q20[3 * i]);
    free(linear_q20);
    return GLINT_OK;
}

void over_scene_again(struct over_scene *over, const struct glint_image *image)
{
    glint_scene_draw(over->frame.scene, image);
}
