/* SPDX-License-Identifier: MIT */
#include "glint/scene/account.h"
#include "scene/visible.h"

/* Counts, for each type of overlay (shell, line, box), the pixels in row Y of
 * W's tile that overlays of this type cover. */
static void
count_overlay_pixels_in_row(struct glint_scene_worker *w, int y,
                            struct glint_scene_layered of[GLINT_KINDS])
{
    w->scene->cfg.parts.motions->list(w, y);
    for (int i = 0; i < w->n_spans; i++)
        of[w->span[i].kind].pixels += w->span[i].x1 - w->span[i].x0;
}

void glint_scene_account_layers(struct glint_scene *scene,
                                struct glint_scene_layered of[GLINT_KINDS])
{
    struct glint_scene_worker *w = &scene->worker[0];
    const int n_tiles = scene->bins.tiles_x * scene->bins.tiles_y;

    for (int i = 0; i < GLINT_KINDS; i++)
        of[i] = (struct glint_scene_layered){0, 0};
    if (!scene->motion)
        return;
    for (int kind = 0; kind < GLINT_KINDS; kind++)
        of[kind].n =
            scene->cfg.parts.motions->count(scene, (enum glint_scene_kind)kind);
    for (int tile = 0; tile < n_tiles; tile++) {
        w->tile = glint_bins_compute_tile_box(&scene->bins, tile);
        for (int y = w->tile.y0; y < w->tile.y1; y++)
            count_overlay_pixels_in_row(w, y, of);
    }
}
