/* SPDX-License-Identifier: MIT
 *
 * The samples of a tile: each keeps the nearest object, and of two equally near
 * the one with the lower index, in any order of drawing. */
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

/* Returns log2 of N samples of a pixel: 0, 2, 3 or 4. */
static inline int glint_samples_log2(int n)
{
    return n == 1 ? 0 : n == 4 ? 2 : n == 8 ? 3 : 4;
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

/* ------------------------------------------------------------------- balls */

/* Balls in the middle of pixels, the quick way (quick.h). */

/* Prepares ball P, which is placed. */
void glint_quick_ball(const struct glint_scene *scene, struct glint_placed *p);

/* Sets RAY to the ray through (X, Y), and SEEN_Q30 to its direction in camera
 * coordinates, each element off by 2^-24. */
void glint_quick_ray(const struct glint_scene_view *view, int32_t x_q8,
                     int32_t y_q8, struct glint_scene_ray *ray,
                     int32_t seen_q30[3]);

/* Sets COSINE_Q30 to that between RAY and the normal of P, where P->over_up is
 * not 0, and ACROSS_Q30 to the middle's distance from the ray, in radii, turned
 * to a right angle. Returns 0 beside P and near its rim. */
int glint_quick_meet(const struct glint_placed *p,
                     const struct glint_scene_ray *ray, int32_t across_q30[3],
                     int32_t *cosine_q30);

/* Returns how far along RAY that is, steps, to 2^-13 of a radius. */
int32_t glint_quick_away(const struct glint_placed *p,
                         const struct glint_scene_ray *ray, int32_t cosine_q30);

/* ------------------------------------------------------------------ layers */

/* Overlays of a recorded motion.
 */

/* Pixels X0 .. X1 - 1 of a row that a layer may touch. */
struct glint_layer_span {
    int layer;
    enum glint_scene_kind kind;
    int x0, x1;
};

struct glint_scene_motions {
    /* carve allocates the state of motions from ARENA and returns NULL while
     * ARENA only counts bytes; carve_worker allocates the arrays of one
     * WORKER. */
    struct glint_motion_state *(*carve)(const struct glint_scene *scene,
                                        struct glint_arena *arena);
    void (*carve_worker)(const struct glint_scene *scene,
                         struct glint_arena *arena,
                         struct glint_scene_worker *worker);
    /* Opens the motion and seeks frame 0. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Finds where shells, lines and box are in the picture. */
    void (*project)(struct glint_scene *scene);
    /* Returns how many of KIND are in the picture. */
    int (*count)(const struct glint_scene *scene, enum glint_scene_kind kind);
    /* Returns the pixels of TILE that they may touch. */
    struct glint_box (*touch)(const struct glint_scene *scene,
                              struct glint_box tile);
    /* Lists in W those that may touch its row Y, from back to front. */
    void (*list)(struct glint_scene_worker *w, int y);
    /* Sets W->over to the layers of the list over pixel X. Returns the end of
     * the pixels that the same layers are over. */
    int (*next)(struct glint_scene_worker *w, int x);
    /* Draws W->over over pixel (X, Y), whose light so far is SUM. */
    void (*over)(const struct glint_scene_worker *w, int x, int y,
                 struct glint_scene_sum *sum);
};

/* Sets TO to the turn by the unit quaternion Q_Q30. */
void glint_scene_turn_of(const int32_t q_q30[4], struct glint_scene_turn *to);

/* Finds where P, whose centre and reach are known, is in the picture; returns
 * its least z, or GLINT_FAR if it is not seen. */
int32_t glint_scene_place(const struct glint_scene *scene,
                          struct glint_placed *p);

#endif
