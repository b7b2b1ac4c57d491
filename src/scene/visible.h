/* SPDX-License-Identifier: MIT
 *
 * The samples of a tile. Whatever is drawn there first: the nearest stays, and
 * of two as near that of the lower number. */
#ifndef GLINT_SCENE_VISIBLE_H
#define GLINT_SCENE_VISIBLE_H

#include "scene/state.h"

/* Returns the place of pixel I, across (AXIS 0) or down (1), q8 from the
 * middle. */
static inline int32_t glint_place(const struct glint_scene *s, int i, int axis)
{
    return 256 * i - 128 * ((axis ? s->view.height : s->view.width) - 1);
}

/* Returns where sample K lies from a pixel's middle, q8, within half a pixel
 * each way: no two are in one row or column. */
static inline int32_t glint_sample(const struct glint_scene *s, int k, int axis)
{
    return s->sample_q8[k][axis];
}

static inline int glint_sample_index(const struct glint_scene_worker *w, int x,
                                     int y, int k)
{
    const struct glint_scene_config *cfg = &w->scene->cfg;

    return ((((y - w->tile.y0) << cfg->tile_log2) + x - w->tile.x0) *
            cfg->edge_samples) +
           k;
}

static inline void glint_put_sample(struct glint_scene_worker *w, int x, int y,
                                    int k, int32_t depth, uint32_t id)
{
    const int i = glint_sample_index(w, x, y, k);

    if (depth > w->depth[i] || (depth == w->depth[i] && id < w->id[i])) {
        w->depth[i] = depth;
        w->id[i] = id;
    }
}

#endif
