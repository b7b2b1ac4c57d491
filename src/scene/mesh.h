/* SPDX-License-Identifier: MIT
 *
 * The tables of meshes in a baked scene, and the parts of the part for them. */
#ifndef GLINT_SCENE_MESH_H
#define GLINT_SCENE_MESH_H

#include "scene/state.h"

static inline const void *glint_mesh_table(const struct glint_scene *s,
                                           uint32_t at)
{
    return (const unsigned char *)s->model.header + at;
}

static inline const struct glint_scene_mesh *
glint_mesh_of(const struct glint_scene *s, uint32_t object)
{
    return &s->model.mesh[s->placed[object].object->mesh];
}

static inline const struct glint_scene_triangle *
glint_mesh_triangle(const struct glint_scene *s,
                    const struct glint_scene_mesh *m, uint32_t i)
{
    return (const struct glint_scene_triangle *)glint_mesh_table(
               s, m->triangle_at) +
           i;
}

/* Points AT to the vertices of a triangle, in the mesh's own space. */
static inline void glint_mesh_vertices(const struct glint_scene *s,
                                       const struct glint_scene_mesh *m,
                                       uint32_t i, const int32_t *at[3])
{
    const struct glint_scene_triangle *t = glint_mesh_triangle(s, m, i);
    const int32_t *vertex = glint_mesh_table(s, m->vertex_at);

    for (int k = 0; k < 3; k++)
        at[k] = vertex + 3 * (size_t)t->vertex[k];
}

/* quick_mesh.c */
int glint_quick_mesh_find(struct glint_scene_worker *w, uint32_t id,
                          int32_t x_q8, int32_t y_q8,
                          struct glint_met_surface *surface);

/* The line through two corners: at place (x, y) it is across x + down y + at,
 * above 0 on one side. */
struct glint_line {
    int64_t across, down, at;
};

static inline int64_t glint_line_at(const struct glint_line *l, int64_t x,
                                    int64_t y)
{
    return l->across * x + l->down * y + l->at;
}

/* mesh_small.c: returns whether triangle T, ID, small as below, is
 * certain not to be seen at samples of B; at least one pixel. */
int glint_mesh_is_hidden(const struct glint_scene_worker *w, uint32_t id,
                         const struct glint_scene_triangle *t,
                         struct glint_box b);

/* Draws triangle T, ID, whose corners are all in the
 * picture or near it and whose lines are below 2^30 at places of B, in 32 bits;
 * returns 0 if its depths need more. */
int glint_mesh_look_small(struct glint_scene_worker *w, uint32_t id,
                          const struct glint_scene_triangle *t,
                          const struct glint_line line[3], struct glint_box b);

#endif
