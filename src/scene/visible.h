/* SPDX-License-Identifier: MIT
 *
 * Writes the visible object to samples of a tile. A sample stores the nearest
 * object. Of two equally near objects it stores that of lower index, so that
 * the order of drawing does not change the result. */
#ifndef GLINT_SCENE_VISIBLE_H
#define GLINT_SCENE_VISIBLE_H

#include "scene/state.h"

/* Returns the middle of pixel column I (AXIS 0) or row I (AXIS 1), q8 pixels
 * from the picture's middle. */
static inline int32_t glint_pixel_position_q8(const struct glint_scene *s,
                                              int i, int axis)
{
    return 256 * i - 128 * ((axis ? s->view.height : s->view.width) - 1);
}

/* Returns the offset of sample K from its pixel's middle along AXIS, q8, within
 * half a pixel. No two samples of a pixel have the same x or the same y. */
static inline int32_t glint_sample_offset_q8(const struct glint_scene *s, int k,
                                             int axis)
{
    return s->sample_q8[k][axis];
}

/* Returns log2 of the number N of samples of a pixel: 0, 2, 3 or 4. */
static inline int glint_get_samples_log2(int n)
{
    return n == 1 ? 0 : n == 4 ? 2 : n == 8 ? 3 : 4;
}

static inline int glint_get_sample_index(const struct glint_scene_worker *w,
                                         int x, int y, int k)
{
    const struct glint_scene_config *cfg = &w->scene->cfg;

    return ((((y - w->tile.y0) << cfg->tile_log2) + x - w->tile.x0) *
            cfg->edge_samples) +
           k;
}

static inline void glint_write_sample_if_nearer(struct glint_scene_worker *w,
                                                int x, int y, int k,
                                                int32_t depth, uint32_t id)
{
    const int i = glint_get_sample_index(w, x, y, k);

    if (depth > w->depth[i] || (depth == w->depth[i] && id < w->id[i])) {
        w->depth[i] = depth;
        w->id[i] = id;
    }
}

/* ------------------------------------------------------------------- balls */

/* Prepares ball P for the fast path (quick.h), after its position is set. */
void glint_quick_prepare_ball(const struct glint_scene *scene,
                              struct glint_placed *p);

/* Sets RAY to the ray through position (X, Y), and SEEN_Q30 to the ray's
 * direction in camera coordinates. Components have an error of 2^-24. */
void glint_quick_compute_ray(const struct glint_scene_view *view, int32_t x_q8,
                             int32_t y_q8, struct glint_scene_ray *ray,
                             int32_t seen_q30[3]);

/* Sets COSINE_Q30 to the cosine between RAY and the normal of ball P. Sets
 * ACROSS_Q30 to the shortest vector from the ball's middle to the ray, in
 * radii, rotated by a right angle about the ray. P->over_up must not be 0.
 * Returns 1, or 0 if the ray misses P or passes near its rim. */
int glint_quick_intersect_ball(const struct glint_placed *p,
                               const struct glint_scene_ray *ray,
                               int32_t across_q30[3], int32_t *cosine_q30);

/* Returns the distance along RAY of the intersection that
 * glint_quick_intersect_ball() found, steps, with an error of 2^-13 radii. */
int32_t glint_quick_get_ball_distance(const struct glint_placed *p,
                                      const struct glint_scene_ray *ray,
                                      int32_t cosine_q30);

/* ------------------------------------------------------------------ layers */

/* The pixels X0 .. X1 - 1 of a row that an overlay of a recorded motion may
 * cover. */
struct glint_layer_span {
    int layer;
    enum glint_scene_kind kind;
    int x0, x1;
};

struct glint_scene_motions {
    /* carve allocates the state of a recorded motion from ARENA, and returns
     * NULL if ARENA only counts bytes. carve_worker allocates the arrays of one
     * WORKER. */
    struct glint_motion_state *(*carve)(const struct glint_scene *scene,
                                        struct glint_arena *arena);
    void (*carve_worker)(const struct glint_scene *scene,
                         struct glint_arena *arena,
                         struct glint_scene_worker *worker);
    /* Opens the motion's file and seeks frame 0. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Projects all overlays to the picture: shells, lines and the box. */
    void (*project)(struct glint_scene *scene);
    /* Returns the number of overlays of type KIND in the picture. */
    int (*count)(const struct glint_scene *scene, enum glint_scene_kind kind);
    /* Returns the box of pixels of TILE that overlays may cover. */
    struct glint_box (*touch)(const struct glint_scene *scene,
                              struct glint_box tile);
    /* Lists in W the overlays that may cover row Y of its tile, from back to
     * front. */
    void (*list)(struct glint_scene_worker *w, int y);
    /* Sets W->over to the overlays in the row's list that cover pixel X.
     * Returns the end of the run of pixels, from X on, that the same overlays
     * cover. */
    int (*next)(struct glint_scene_worker *w, int x);
    /* Composites the overlays W->over over pixel (X, Y), whose light so far is
     * SUM. */
    void (*over)(const struct glint_scene_worker *w, int x, int y,
                 struct glint_scene_sum *sum);
};

/* Sets TO to the rotation matrix of the unit quaternion Q_Q30. */
void glint_scene_quaternion_to_rotation(const int32_t q_q30[4],
                                        struct glint_scene_turn *to);

/* Sets the box of pixels that object P may cover; its centre and reach must be
 * set. Returns the object's min z, steps (for a plane, a quarter of its
 * distance from the camera), or GLINT_FAR if it is not visible. */
int32_t glint_scene_find_object_box(const struct glint_scene *scene,
                                    struct glint_placed *p);

#endif
