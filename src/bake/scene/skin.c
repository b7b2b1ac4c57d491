/* SPDX-License-Identifier: MIT */
#include "bake/scene/write_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/translucent.h"
#include "glint/view.h"

/* Max fraction of texels whose centre lies inside two triangles. A mesh with a
 * larger fraction is rejected. */
#define MOST_SHARED .02

int glint_skin_find_material(const struct glint_description *scene,
                             const struct glint_described_object *object)
{
    if (object->material >= 0 && object->n_triangles == 0)
        return scene->material[object->material].is_stone ? object->material
                                                          : -1;
    for (int i = 0; i < object->n_triangles; i++) {
        const int m = scene->triangle[object->first_triangle + i].material;

        if (scene->material[m].is_stone)
            return m;
    }
    return -1;
}

/* State of assigning the texels of an object's map to triangles of its mesh. */
struct painter {
    const struct glint_draft *draft;
    const struct glint_scene_mesh *mesh;
    int side;
    /* index of the object's material, which triangles without a material of
     * their own have */
    uint32_t own;
    /* index of the translucent material; other triangles are ignored */
    uint32_t material;
    /* [side][side]: index of the texel's triangle, or GLINT_SCENE_NONE */
    uint32_t *texel;
    /* [side][side]: 1: the texel's centre is strictly inside its triangle */
    uint8_t *inside;
    int shared, painted;
};

static const void *get_draft_table(const struct painter *p, uint32_t at)
{
    return p->draft->data + at;
}

static const struct glint_scene_triangle *
get_mesh_triangle(const struct painter *p, uint32_t i)
{
    return (const struct glint_scene_triangle *)get_draft_table(
               p, p->mesh->triangle_at) +
           i;
}

/* ----------------------------------------------------------------- painting */

/* Returns twice the signed area of the triangle A, B, (U, V). */
static int64_t compute_double_area(const int32_t *a, const int32_t *b,
                                   int64_t u, int64_t v)
{
    return (a[0] - u) * (b[1] - v) - (a[1] - v) * (b[0] - u);
}

static void assign_texel_to_triangle(struct painter *p, uint32_t triangle,
                                     const int32_t *const uv[3], int64_t all,
                                     int x, int y)
{
    const int64_t u = (2 * x + 1) * (INT64_C(32768) / p->side);
    const int64_t v = (2 * y + 1) * (INT64_C(32768) / p->side);
    const size_t at = (size_t)y * (size_t)p->side + (size_t)x;
    int holds = 1, inside = 1;

    for (int k = 0; k < 3; k++) {
        int64_t e = compute_double_area(uv[(k + 1) % 3], uv[(k + 2) % 3], u, v);

        e = all < 0 ? -e : e;
        holds &= e >= 0;
        inside &= e > 0;
    }
    if (!holds)
        return;
    if (p->texel[at] == GLINT_SCENE_NONE) {
        p->texel[at] = triangle;
        p->inside[at] = (uint8_t)inside;
        p->painted++;
    } else {
        p->shared += inside && p->inside[at];
    }
}

static int find_texel_coordinate(const struct painter *p, int32_t uv_q16)
{
    const double x = floor(uv_q16 * (p->side / 65536.));

    return (int)fmin(fmax(x, 0), p->side - 1);
}

static void assign_triangle_texels(struct painter *p, uint32_t triangle)
{
    const struct glint_scene_triangle *t = get_mesh_triangle(p, triangle);
    const int32_t *uv_q16 = get_draft_table(p, p->mesh->uv_at), *uv[3];
    int lo[2], hi[2];
    int64_t all;

    if (!p->mesh->uv_at ||
        (t->material == GLINT_SCENE_NONE ? p->own : t->material) != p->material)
        return;
    for (int k = 0; k < 3; k++)
        uv[k] = uv_q16 + 2 * (size_t)t->vertex[k];
    for (int i = 0; i < 2; i++) {
        lo[i] = hi[i] = find_texel_coordinate(p, uv[0][i]);
        for (int k = 1; k < 3; k++) {
            const int at = find_texel_coordinate(p, uv[k][i]);

            lo[i] = at < lo[i] ? at : lo[i];
            hi[i] = at > hi[i] ? at : hi[i];
        }
    }
    all = compute_double_area(uv[0], uv[1], uv[2][0], uv[2][1]);
    for (int y = lo[1]; all && y <= hi[1]; y++)
        for (int x = lo[0]; x <= hi[0]; x++)
            assign_texel_to_triangle(p, triangle, uv, all, x, y);
}

/* ----------------------------------------------------------------- gutters */

/* If texel (X, Y) has no triangle, assigns it the triangle that one of its
 * neighbours has in BEFORE. */
static void assign_triangle_of_neighbour_texel(struct painter *p,
                                               const uint32_t *before, int x,
                                               int y)
{
    uint32_t *to = &p->texel[(ptrdiff_t)y * p->side + x];

    for (int k = 0; k < 9 && *to == GLINT_SCENE_NONE; k++) {
        const int i = x + k % 3 - 1, j = y + k / 3 - 1;

        if (i >= 0 && i < p->side && j >= 0 && j < p->side)
            *to = before[(ptrdiff_t)j * p->side + i];
    }
}

/* Extends each chart of the map by RINGS texels, which get the triangle of a
 * neighbour. So kernels carry light across the borders of charts. Returns false
 * if there is no memory. */
static bool dilate_texture_charts(struct painter *p, int rings)
{
    const size_t bytes = (size_t)p->side * (size_t)p->side * sizeof *p->texel;
    uint32_t *before = malloc(bytes);

    for (int i = 0; before && i < rings; i++) {
        memcpy(before, p->texel, bytes);
        for (int y = 0; y < p->side; y++)
            for (int x = 0; x < p->side; x++)
                assign_triangle_of_neighbour_texel(p, before, x, y);
    }
    free(before);
    return before != NULL;
}

/* ------------------------------------------------------------------ closed */

/* An edge as a pair of vertex positions, the smaller one first. */
struct edge {
    int32_t place[2][3];
};

static int compare_edges(const void *a, const void *b)
{
    const int32_t *x = a, *y = b;

    for (int i = 0; i < 6; i++)
        if (x[i] != y[i])
            return x[i] < y[i] ? -1 : 1;
    return 0;
}

static void set_triangle_edge(const struct painter *p,
                              const struct glint_scene_triangle *t, int k,
                              struct edge *e)
{
    const int32_t *vertex = get_draft_table(p, p->mesh->vertex_at);
    const int32_t *a = vertex + 3 * (size_t)t->vertex[k];
    const int32_t *b = vertex + 3 * (size_t)t->vertex[(k + 1) % 3];
    int first = 0;

    for (int i = 2; i >= 0; i--)
        first = a[i] != b[i] ? a[i] > b[i] : first;
    memcpy(e->place[first], a, sizeof e->place[0]);
    memcpy(e->place[1 - first], b, sizeof e->place[0]);
}

/* Sets CLOSED to 1 if the mesh is closed, that is, each edge belongs to exactly
 * two triangles; else to 0. Returns false if there is no memory. */
static bool find_whether_mesh_is_closed(const struct painter *p,
                                        uint32_t *closed)
{
    const size_t n = 3 * (size_t)p->mesh->n_triangles;
    struct edge *edge = malloc((n ? n : 1) * sizeof *edge);
    bool is = true;

    if (!edge)
        return false;
    for (uint32_t i = 0; i < p->mesh->n_triangles; i++)
        for (int k = 0; k < 3; k++)
            set_triangle_edge(p, get_mesh_triangle(p, i), k,
                              &edge[3 * i + (uint32_t)k]);
    qsort(edge, n, sizeof *edge, compare_edges);
    for (size_t i = 0, same; is && i < n; i += same) {
        for (same = 1;
             i + same < n && compare_edges(&edge[i], &edge[i + same]) == 0;)
            same++;
        is = same == 2;
    }
    *closed = is;
    free(edge);
    return true;
}

/* --------------------------------------------------------------- whole map */

static bool check_texel_coverage(const struct painter *p, const char *name,
                                 struct glint_error *error)
{
    if (p->painted == 0)
        snprintf(error->text, sizeof error->text,
                 "mesh %s is translucent, but covers no texel of its map",
                 name);
    else if (p->shared > MOST_SHARED * p->painted)
        snprintf(error->text, sizeof error->text,
                 "mesh %s is translucent, but %.3g %% of its texels belong to "
                 "two places of the mesh: texture coordinates must not overlap",
                 name, 100. * p->shared / p->painted);
    return error->text[0] == '\0';
}

static bool assign_mesh_texels(struct painter *p, const char *name, int kernel,
                               struct glint_scene_skin *skin,
                               struct glint_error *error)
{
    const size_t n = (size_t)p->side * (size_t)p->side;

    p->texel = malloc(n * sizeof *p->texel);
    p->inside = calloc(n, 1);
    if (!p->texel || !p->inside)
        return false;
    memset(p->texel, 0xff, n * sizeof *p->texel);
    for (uint32_t i = 0; i < p->mesh->n_triangles; i++)
        assign_triangle_texels(p, i);
    return check_texel_coverage(p, name, error) &&
           dilate_texture_charts(p, kernel / 2 + 2) &&
           find_whether_mesh_is_closed(p, &skin->closed);
}

/* Writes cosine and sine of longitude and latitude for the columns and rows of
 * a sphere's map. */
static void write_sphere_map(struct glint_draft *draft, int side,
                             struct glint_scene_skin *skin)
{
    int32_t turn_q30[3 << GLINT_TRANSLUCENT_MOST_LOG2][2];

    for (int i = 0; i < 3 * side; i++) {
        const double angle = i < 2 * side
                                 ? GLINT_PI * ((i + .5) / side - 1)
                                 : GLINT_PI * (i - 2 * side + .5) / side;

        turn_q30[i][0] = (int32_t)lrint(0x1p30 * cos(angle));
        turn_q30[i][1] = (int32_t)lrint(0x1p30 * sin(angle));
    }
    skin->texel_at = glint_draft_append(draft, turn_q30,
                                        3 * (size_t)side * sizeof *turn_q30);
}

bool glint_skin_write_map(struct glint_draft *draft,
                          const struct glint_description *scene,
                          const struct glint_described_object *object,
                          const struct glint_scene_mesh *mesh, int material,
                          struct glint_scene_skin *skin,
                          struct glint_error *error)
{
    const struct glint_described_stone *stone =
        &scene->stone[scene->material[material].stone];
    struct painter p = {.draft = draft,
                        .mesh = mesh,
                        .own = (uint32_t)object->material,
                        .material = (uint32_t)material};
    struct glint_translucent t;
    const char *reason;
    bool good;

    if (draft->out_of_memory ||
        glint_translucent_open(&t, stone->data, stone->bytes, &reason) !=
            GLINT_OK)
        return false;
    p.side = 1 << t.header->side_log2;
    if (!mesh) {
        write_sphere_map(draft, p.side, skin);
        return true;
    }
    good = assign_mesh_texels(&p, object->name, (int)t.header->kernel, skin,
                              error);
    if (good)
        skin->texel_at = glint_draft_append(
            draft, p.texel, (size_t)p.side * (size_t)p.side * sizeof *p.texel);
    free(p.texel);
    free(p.inside);
    return good;
}
