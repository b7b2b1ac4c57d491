/* SPDX-License-Identifier: MIT
 *
 * Place, normals, u and v of a mesh where a ray meets it. */
#include "scene/mesh.h"

#include "base/log2.h"

/* Returns the mean of three rows of N numbers by weights that sum to 1. */
static void mean(const struct glint_spot_on *spot, const int32_t *const row[3],
                 int n, int32_t *to)
{
    for (int k = 0; k < n; k++) {
        int64_t sum = 0;

        for (int i = 0; i < 3; i++)
            sum += (int64_t)spot->part_q30[i] * row[i][k];
        to[k] = q_narrow(q_shift(sum, 30));
    }
}

static void rows_of(const struct glint_scene *s,
                    const struct glint_scene_triangle *t, uint32_t at, int n,
                    const int32_t *row[3])
{
    for (int k = 0; k < 3; k++)
        row[k] =
            (const int32_t *)glint_mesh_table(s, at) + (size_t)n * t->vertex[k];
}

/* Returns log2 of the length of V, q16, -2^24 if it is 0. */
static int32_t log2_length_q16(const int64_t v[3])
{
    const uint64_t any =
        q_magnitude(v[0]) | q_magnitude(v[1]) | q_magnitude(v[2]);
    const int down = q_larger(0, bit_length(any) - 31);
    uint64_t square = 0;

    for (int k = 0; k < 3; k++)
        square += (uint64_t)((v[k] >> down) * (v[k] >> down));
    return square ? q_log2_q16(square) / 2 + down * 65536 : -(1 << 24);
}

/* Sets u, v, and how large the triangle is in them. */
static void map(const struct glint_scene *s, const struct glint_scene_mesh *m,
                const struct glint_scene_triangle *t,
                const int32_t *const vertex[3], const struct glint_met *met,
                struct glint_met_surface *surface)
{
    const int32_t *uv_q16[3];
    int32_t first[3] = {0}, second[3] = {0}, uv[2][3] = {{0}};
    int64_t area[3], uv_area[3];

    rows_of(s, t, m->uv_at, 2, uv_q16);
    mean(&met->spot, uv_q16, 2, surface->uv_q16);
    v3_minus(vertex[1], vertex[0], first);
    v3_minus(vertex[2], vertex[0], second);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 2; i++)
            uv[i][k] = uv_q16[i + 1][k] - uv_q16[0][k];
    v3_cross(first, second, area);
    v3_cross(uv[0], uv[1], uv_area);
    surface->uv_log2_q16 =
        log2_length_q16(uv_area) - (32 << 16) - log2_length_q16(area);
}

int glint_mesh_surface(const struct glint_scene *scene,
                       const struct glint_met *met,
                       struct glint_met_surface *surface)
{
    const struct glint_placed *p = &scene->placed[met->object];
    const struct glint_scene_mesh *m = glint_mesh_of(scene, met->object);
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(scene, m, met->triangle);
    const int32_t *vertex[3], *row[3];
    int32_t place[3], normal_q30[3];

    glint_mesh_vertices(scene, m, met->triangle, vertex);
    mean(&met->spot, vertex, 3, place);
    v3_turn(&p->turn, place, surface->place);
    for (int k = 0; k < 3; k++)
        surface->place[k] += p->at[k];
    if (!glint_triangle_normal(vertex, normal_q30))
        return 0;
    v3_turn(&p->turn, normal_q30, surface->face_q30);
    if (m->normal_at) {
        int64_t sum[3];

        rows_of(scene, t, m->normal_at, 3, row);
        mean(&met->spot, row, 3, normal_q30);
        for (int k = 0; k < 3; k++)
            sum[k] = normal_q30[k];
        if (!glint_unit(sum, normal_q30))
            return 0;
    }
    v3_turn(&p->turn, normal_q30, surface->normal_q30);
    if (t->material != GLINT_SCENE_NONE)
        surface->material = &scene->model.material[t->material];
    if (m->uv_at &&
        (surface->material->texture != GLINT_SCENE_NONE || p->skin >= 0))
        map(scene, m, t, vertex, met, surface);
    return 1;
}

int glint_mesh_joins(const struct glint_scene *scene, uint32_t a, uint32_t b)
{
    const struct glint_scene_mesh *m = glint_mesh_of(scene, a >> 20);
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(scene, m, a & 0xfffff);
    const struct glint_scene_triangle *u =
        glint_mesh_triangle(scene, m, b & 0xfffff);
    int shared = 0;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            shared |= t->vertex[i] == u->vertex[k];
    return shared && m->normal_at && t->material == u->material;
}
