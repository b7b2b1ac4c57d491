/* SPDX-License-Identifier: MIT
 *
 * Access to the tables of meshes in a baked scene, and functions that mesh.c
 * and quick_mesh.c share. */
#ifndef GLINT_SCENE_MESH_H
#define GLINT_SCENE_MESH_H

#include "scene/state.h"

static inline const void *glint_mesh_get_table(const struct glint_scene *s,
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
    return (const struct glint_scene_triangle *)glint_mesh_get_table(
               s, m->triangle_at) +
           i;
}

/* Sets AT to the addresses of the three vertices of triangle I, in the
 * mesh's own coordinates. */
static inline void glint_mesh_get_vertices(const struct glint_scene *s,
                                           const struct glint_scene_mesh *m,
                                           uint32_t i, const int32_t *at[3])
{
    const struct glint_scene_triangle *t = glint_mesh_triangle(s, m, i);
    const int32_t *vertex = glint_mesh_get_table(s, m->vertex_at);

    for (int k = 0; k < 3; k++)
        at[k] = vertex + 3 * (size_t)t->vertex[k];
}

/* Implements find of struct glint_scene_meshes, in quick_mesh.c. */
int glint_quick_find_mesh_surface(struct glint_scene_worker *w, uint32_t id,
                                  int32_t x_q8, int32_t y_q8,
                                  struct glint_met_surface *surface);

#endif
