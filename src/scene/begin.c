/* SPDX-License-Identifier: MIT
 *
 * Prepares a frame: moves objects to their positions, finds the objects that
 * may be visible, and computes the direction and light of each light source. */
#include "scene/quick.h"
#include "scene/visible.h"
#include "scene/parts.h"

enum { ONE_Q30 = 1 << 30 };

/* Returns the box of pixels that a ball may cover: the projection of its
 * bounding box. SEEN: centre of the ball in camera coordinates; REACH: its
 * radius, steps. */
static struct glint_box compute_ball_box(const struct glint_scene *s,
                                         const int32_t seen[3], int32_t reach)
{
    int32_t v[8][3];

    for (int k = 0; k < 8; k++)
        for (int i = 0; i < 3; i++)
            v[k][i] = seen[i] + (k >> i & 1 ? reach : -reach);
    return glint_view_find_box_of_points(&s->view, (const int32_t(*)[3])v, 8);
}

/* Returns the max distance, at the far side of a ball, between the ray through
 * a pixel's middle and a ray through one of its samples, steps, rounded up.
 * Samples are up to 104/256 pixel from the middle, or 184/256 with more than
 * four per pixel. */
static int32_t compute_max_sample_ray_distance(const struct glint_scene *s,
                                               const int32_t seen[3],
                                               int32_t reach)
{
    const struct glint_scene_view *v = &s->view;
    const int64_t step_q56 =
        v->step_q56[0] > v->step_q56[1] ? v->step_q56[0] : v->step_q56[1];
    const int64_t far =
        (int64_t)glint_compute_square_root((uint64_t)v3_dot(seen, seen)) +
        reach;
    const int64_t off_q30 =
        (step_q56 >> 26) * (s->cfg.edge_samples > 4 ? 184 : 104);

    if (off_q30 >= ONE_Q30)
        return GLINT_SCENE_SPAN;
    return (int32_t)q_clamp_sat((far * off_q30 >> 30) + 2, 0, GLINT_SCENE_SPAN);
}

int32_t glint_scene_find_object_box(const struct glint_scene *s,
                                    struct glint_placed *p)
{
    int32_t seen[3], off[3];

    p->is_seen = p->is_only_shadow = p->is_behind_catcher = 0;
    p->flat_depth = 0;
    p->z[0] = -GLINT_FAR;
    p->z[1] = GLINT_FAR;
    p->box = (struct glint_box){0, 0, s->view.width, s->view.height};
    if (!p->is_shown)
        return GLINT_FAR;
    if (p->object->kind == GLINT_OBJECT_PLANE) {
        v3_subtract(p->at, s->view.at, off);
        p->is_seen = 1;
        return (int32_t)(q_magnitude(q_shift(v3_dot(off, p->centre), 30)) / 4);
    }
    glint_view_convert_to_camera(&s->view, p->centre, seen);
    if (seen[2] + p->reach <= 0)
        return GLINT_FAR;
    p->z[0] = seen[2] - p->reach;
    p->z[1] = seen[2] + p->reach;
    p->box = compute_ball_box(s, seen, p->reach + 2);
    p->margin = compute_max_sample_ray_distance(s, seen, p->reach);
    p->is_seen = !glint_box_is_empty(p->box);
    return p->is_seen ? seen[2] - p->reach : GLINT_FAR;
}

/* Sets 1 / z of all planes as functions of the position in the picture.
 * s->nearest must be set before. */
static void set_plane_depth_functions(struct glint_scene *s)
{
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        struct glint_placed *p = &s->placed[i];
        int32_t seen[3], normal_q30[3];

        if (p->object->kind != GLINT_OBJECT_PLANE || !p->is_seen)
            continue;
        glint_view_convert_to_camera(&s->view, p->at, seen);
        v3_rotate(&s->view.turn, p->centre, normal_q30);
        p->is_seen = glint_view_set_plane_depth(&s->view, seen, normal_q30,
                                                s->nearest, &p->depth);
    }
}

/* Counts the planes that cast shadows, and rebuilds outdated shadow grids of
 * suns. */
static void rebuild_shadow_grids(struct glint_scene *s)
{
    s->n_planes = 0;
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_scene_object *o = s->placed[i].object;

        if (!s->placed[i].is_shown || o->kind != GLINT_OBJECT_PLANE ||
            o->catcher_q15)
            continue;
        s->n_planes++;
        s->plane = i;
    }
    for (uint32_t i = 0; i < s->n_lit; i++)
        if (s->lit[i].shadow && !s->lit[i].shadow->is_ready)
            glint_shadow_build_grid(s, &s->lit[i], s->lit[i].shadow);
}

void glint_scene_begin(struct glint_scene *scene,
                       struct glint_scene_stats *stats)
{
    const uint32_t n = scene->model.header->n_objects;
    int32_t nearest = GLINT_FAR, farthest = 1;

    *stats = (struct glint_scene_stats){0};
    for (uint32_t i = 0; i < n; i++) {
        const int32_t z = glint_scene_find_object_box(scene, &scene->placed[i]);

        nearest = q_smaller(nearest, z);
        if (z < GLINT_FAR)
            farthest = q_larger(farthest, z + 2 * scene->placed[i].reach);
    }
    /* Lines of a recorded motion may be nearer than all objects. */
    if (scene->motion)
        nearest = q_smaller(nearest, farthest >> 13);
    /* All points nearer than 2^-14 times the max z get the same depth. */
    scene->nearest =
        q_clamp_sat(q_larger(nearest, farthest >> 14), 1, GLINT_SCENE_SPAN);
    set_plane_depth_functions(scene);
    glint_quick_prepare_balls(scene);
    if (scene->motion)
        scene->cfg.parts.motions->project(scene);
    else
        /* With a recorded motion, shells and lines need exact depths of
         * balls. */
        glint_scene_set_single_depths_of_balls(scene);
    scene->has_triangles = scene->is_spread = 0;
    if (scene->bins.start)
        scene->cfg.parts.meshes->project(scene, stats);
    for (uint32_t i = 0; i < n; i++)
        stats->objects += scene->placed[i].is_seen;
    if (stats->objects > 0)
        rebuild_shadow_grids(scene);
    glint_scene_shrink_catcher_boxes(scene);
}
