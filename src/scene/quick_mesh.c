/* SPDX-License-Identifier: MIT
 *
 * The fast path for shading (quick.h) of triangles. Each worker caches a few
 * prepared triangles. */
#include "base/divide.h"
#include "scene/quick.h"
#include "scene/mesh.h"

/* --------------------------------------------------------------- triangles */

/* Sets the edge functions of triangle T in the picture; returns 0 if a corner
 * cannot be projected or the triangle has no area there. */
static int project_triangle_corners(const struct glint_scene *s,
                                    uint32_t object,
                                    const struct glint_scene_triangle *of,
                                    struct glint_quick_triangle *t)
{
    const struct glint_placed *p = &s->placed[object];
    const struct glint_corner *c[3];
    int32_t z[3], nearest;
    int64_t sum = 0;

    for (int k = 0; k < 3; k++) {
        c[k] = &s->corner[p->first_vertex + of->vertex[k]];
        z[k] = s->seen[p->first_vertex + of->vertex[k]][2];
        if (c[k]->w != 1)
            return 0;
    }
    nearest = q_smaller(z[0], q_smaller(z[1], z[2]));
    t->x_q8 = c[0]->x;
    t->y_q8 = c[0]->y;
    for (int k = 0; k < 3; k++) {
        const struct glint_corner *a = c[(k + 1) % 3], *b = c[(k + 2) % 3];

        t->across[k] = a->y - b->y;
        t->down[k] = b->x - a->x;
        t->at[k] = (int64_t)(c[0]->x - a->x) * t->across[k] +
                   (int64_t)(c[0]->y - a->y) * t->down[k];
        t->nearer_q30[k] =
            q_divide_to_fraction_q30((uint64_t)nearest, (uint64_t)z[k]);
        sum += t->at[k];
    }
    if (sum == 0)
        return 0;
    for (int k = 0; k < 3 && sum < 0; k++) {
        t->across[k] = -t->across[k];
        t->down[k] = -t->down[k];
        t->at[k] = -t->at[k];
    }
    t->up = q_count_normalising_shift(q_magnitude(sum));
    t->one_over = q_reciprocal(q_shift_to_32_bits(q_magnitude(sum), t->up));
    return 1;
}

/* Sets the vertices and normals of triangle T; normals are flipped to the
 * camera's side. Returns 0 if the triangle has no area. */
static int
set_triangle_vertices_and_normals(const struct glint_scene *s, uint32_t object,
                                  const struct glint_scene_triangle *of,
                                  struct glint_quick_triangle *t)
{
    const struct glint_placed *p = &s->placed[object];
    const struct glint_scene_mesh *m = glint_mesh_of(s, object);
    const int32_t *vertex = glint_mesh_get_table(s, m->vertex_at);
    const int32_t *normal =
        m->normal_at ? glint_mesh_get_table(s, m->normal_at) : NULL;
    const int32_t *at[3];
    int32_t place[3], off[3], n_q30[3][3], sign;

    for (int k = 0; k < 3; k++)
        at[k] = vertex + 3 * (size_t)of->vertex[k];
    if (!glint_set_triangle_normal(at, off))
        return 0;
    v3_rotate(&p->turn, off, t->face_q30);
    for (int i = 0; i < 3; i++) {
        v3_rotate(&p->turn, at[i], place);
        for (int k = 0; k < 3; k++)
            t->place[i][k] =
                i ? place[k] + p->at[k] - t->place[0][k] : place[k] + p->at[k];
        if (normal)
            v3_rotate(&p->turn, normal + 3 * (size_t)of->vertex[i], n_q30[i]);
        else
            for (int k = 0; k < 3; k++)
                n_q30[i][k] = t->face_q30[k];
    }
    v3_subtract(t->place[0], s->view.at, off);
    t->is_inside = v3_dot(off, t->face_q30) > 0;
    sign = t->is_inside ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        t->face_q30[k] *= sign;
        t->normal_q29[0][k] = sign * n_q30[0][k] / 2;
        for (int i = 1; i < 3; i++)
            t->normal_q29[i][k] =
                sign * (n_q30[i][k] / 2) - t->normal_q29[0][k];
    }
    t->is_smooth = normal != NULL;
    return 1;
}

/* Returns the prepared triangle ID from the worker's cache; if the cache does
 * not have it, prepares it first. Returns NULL if it cannot be prepared. */
static struct glint_quick_triangle *
prepare_triangle(struct glint_scene_worker *w, uint32_t id)
{
    const struct glint_scene *s = w->scene;
    struct glint_quick_triangle *t =
        &w->quick[(id ^ id >> 5) & (GLINT_QUICK_TRIANGLES - 1)];
    const struct glint_scene_triangle *of;

    if (t->id == id)
        return t->is_there ? t : NULL;
    of = glint_mesh_triangle(s, glint_mesh_of(s, id >> 20), id & 0xfffff);
    t->id = id;
    t->material = &s->model.material[of->material == GLINT_SCENE_NONE
                                         ? s->placed[id >> 20].material
                                         : of->material];
    t->is_there = t->material->texture == GLINT_SCENE_NONE &&
                  s->placed[id >> 20].skin < 0 &&
                  project_triangle_corners(s, id >> 20, of, t) &&
                  set_triangle_vertices_and_normals(s, id >> 20, of, t);
    return t->is_there ? t : NULL;
}

/* Sets PART to the barycentric weights of the second and third corner at
 * position (X, Y): perspective-correct, clamped to the triangle. */
static void compute_vertex_weights(const struct glint_quick_triangle *t,
                                   int32_t x_q8, int32_t y_q8,
                                   int64_t part_q30[2])
{
    const int64_t x = x_q8 - t->x_q8, y = y_q8 - t->y_q8;
    uint64_t weight_q30[3], sum = 0;
    uint32_t one_over;
    int up;

    for (int k = 0; k < 3; k++) {
        int64_t edge = t->at[k] + x * t->across[k] + y * t->down[k];

        edge = edge < 0 ? 0 : edge;
        /* up scales the sum of the weights to 2^31 .. 2^32 */
        edge = t->up < 0 ? edge >> -t->up : edge * (INT64_C(1) << t->up);
        edge = edge > UINT32_MAX ? UINT32_MAX : edge;
        weight_q30[k] =
            ((uint64_t)edge * t->one_over >> 33) * (uint32_t)t->nearer_q30[k] >>
            30;
        sum += weight_q30[k];
    }
    if (sum == 0) {
        part_q30[0] = part_q30[1] = 0;
        return;
    }
    up = q_count_normalising_shift(sum);
    one_over = q_reciprocal(q_shift_to_32_bits(sum, up));
    for (int k = 0; k < 2; k++)
        part_q30[k] =
            (int64_t)((uint64_t)q_shift_to_32_bits(weight_q30[k + 1], up) *
                          one_over >>
                      33);
}

static int find_triangle_surface(const struct glint_quick_triangle *t,
                                 int32_t x_q8, int32_t y_q8,
                                 struct glint_met_surface *surface)
{
    int64_t part_q30[2];
    int32_t normal_q29[3];

    compute_vertex_weights(t, x_q8, y_q8, part_q30);
    for (int k = 0; k < 3; k++) {
        surface->place[k] =
            t->place[0][k] + (int32_t)q_shift(part_q30[0] * t->place[1][k] +
                                                  part_q30[1] * t->place[2][k],
                                              30);
        surface->face_q30[k] = surface->normal_q30[k] = t->face_q30[k];
    }
    surface->is_inside = t->is_inside;
    surface->material = t->material;
    if (!t->is_smooth)
        return 1;
    for (int k = 0; k < 3; k++)
        normal_q29[k] = t->normal_q29[0][k] +
                        (int32_t)((part_q30[0] * t->normal_q29[1][k] +
                                   part_q30[1] * t->normal_q29[2][k]) >>
                                  30);
    if (v3_dot(normal_q29, normal_q29) < INT64_C(1) << 44)
        return 0;
    glint_quick_normalise(normal_q29, surface->normal_q30);
    return 1;
}

int glint_quick_find_mesh_surface(struct glint_scene_worker *w, uint32_t id,
                                  int32_t x_q8, int32_t y_q8,
                                  struct glint_met_surface *surface)
{
    const struct glint_quick_triangle *t = prepare_triangle(w, id);

    return t && find_triangle_surface(t, x_q8, y_q8, surface);
}
