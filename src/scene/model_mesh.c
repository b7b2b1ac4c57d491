/* SPDX-License-Identifier: MIT
 *
 * Checks of meshes, objects, and what is translucent. */
#include "scene/model_check.h"

#include "base/q.h"
#include "glint/scene/translucent.h"

enum { SPAN = GLINT_SCENE_SPAN, UV_LIMIT = 1 << 24 };

/* ------------------------------------------------------------------ meshes */

static const char *check_vertices(struct glint_scene_check *c,
                                  const struct glint_scene_mesh *m)
{
    const int32_t *at = glint_blob_section(&c->blob, m->vertex_at,
                                           m->n_vertices, 3 * sizeof *at);
    const int64_t reach = (int64_t)m->radius + 2;

    if (!at)
        return OUTSIDE;
    if (!glint_scene_within(m->centre, 3, SPAN / 2) || m->radius < 0 ||
        glint_scene_length(m->centre) + m->radius > SPAN / 2)
        return "a mesh is too large or too far out";
    for (size_t i = 0; i < m->n_vertices; i++) {
        int32_t off[3];

        if (!glint_scene_within(at + 3 * i, 3, SPAN))
            return "a vertex is too far out";
        for (int k = 0; k < 3; k++)
            off[k] = at[3 * i + (size_t)k] - m->centre[k];
        if (glint_scene_length(off) > reach)
            return "a vertex is outside of its mesh's ball";
    }
    return NULL;
}

static const char *check_attributes(struct glint_scene_check *c,
                                    const struct glint_scene_mesh *m)
{
    const int32_t *uv_q16 = NULL, *normal_q30 = NULL;

    if (m->uv_at &&
        !(uv_q16 = glint_blob_section(&c->blob, m->uv_at, m->n_vertices,
                                      2 * sizeof *uv_q16)))
        return OUTSIDE;
    if (m->normal_at &&
        !(normal_q30 = glint_blob_section(&c->blob, m->normal_at, m->n_vertices,
                                          3 * sizeof *normal_q30)))
        return OUTSIDE;
    for (size_t i = 0; i < m->n_vertices; i++) {
        if (uv_q16 && !glint_scene_within(uv_q16 + 2 * i, 2, UV_LIMIT))
            return "a vertex's u or v is out of range";
        if (normal_q30 && !glint_scene_is_unit(normal_q30 + 3 * i, 3))
            return "a vertex's normal is no unit vector";
    }
    return NULL;
}

static const char *check_triangles(struct glint_scene_check *c,
                                   const struct glint_scene_mesh *m)
{
    const struct glint_scene_triangle *t =
        glint_blob_section(&c->blob, m->triangle_at, m->n_triangles, sizeof *t);

    if (!t)
        return OUTSIDE;
    for (uint32_t i = 0; i < m->n_triangles; i++) {
        for (int k = 0; k < 3; k++)
            if (t[i].vertex[k] >= m->n_vertices)
                return "a triangle's vertex is out of range";
        if (t[i].material != GLINT_SCENE_NONE &&
            t[i].material >= c->model.header->n_materials)
            return "a triangle's material is out of range";
    }
    return NULL;
}

/* The cells, FIRST to LAST along each axis, that the box of triangle T reaches
 * into. */
static void cells_of(const struct glint_scene_mesh *m, const int32_t *vertex,
                     const struct glint_scene_triangle *t, int32_t first[3],
                     int32_t last[3])
{
    for (size_t k = 0; k < 3; k++) {
        const int32_t a = vertex[3 * (size_t)t->vertex[0] + k];
        const int32_t b = vertex[3 * (size_t)t->vertex[1] + k];
        const int32_t c = vertex[3 * (size_t)t->vertex[2] + k];
        const int64_t lo = (int64_t)q_smaller(a, q_smaller(b, c)) -
                           GLINT_SCENE_MARGIN - m->origin[k];
        const int64_t hi = (int64_t)q_larger(a, q_larger(b, c)) +
                           GLINT_SCENE_MARGIN - m->origin[k];

        first[k] = q_clamp_sat(lo >> m->cell_log2, 0, (int32_t)m->cells[k] - 1);
        last[k] =
            q_clamp_sat((hi - 1) >> m->cell_log2, 0, (int32_t)m->cells[k] - 1);
    }
}

/* Returns whether cell C is one of those that T reaches into. */
static int is_needed(const struct glint_scene_mesh *m, const int32_t *vertex,
                     const struct glint_scene_triangle *t, const uint32_t c[3])
{
    int32_t first[3], last[3];
    int is = 1;

    cells_of(m, vertex, t, first, last);
    for (int k = 0; k < 3; k++)
        is &= (int32_t)c[k] >= first[k] && (int32_t)c[k] <= last[k];
    return is;
}

/* Checks that each triangle is in the list of each cell that it reaches into:
 * lists rise, so that there are as many entries of this kind as there have to
 * be only where none is missing. */
static const char *check_lists(const struct glint_scene_check *check,
                               const struct glint_scene_mesh *m,
                               const uint32_t *start, const uint32_t *ref)
{
    const unsigned char *data = (const unsigned char *)check->model.header;
    const int32_t *vertex = (const void *)(data + m->vertex_at);
    const struct glint_scene_triangle *t =
        (const void *)(data + m->triangle_at);
    uint32_t c[3] = {0, 0, 0};
    uint64_t missing = 0;

    for (uint32_t i = 0; i < m->n_triangles; i++) {
        int32_t first[3], last[3];

        cells_of(m, vertex, &t[i], first, last);
        missing += (uint64_t)(last[0] - first[0] + 1) *
                   (uint64_t)(last[1] - first[1] + 1) *
                   (uint64_t)(last[2] - first[2] + 1);
    }
    for (; c[2] < m->cells[2]; start++) {
        for (uint32_t i = start[0]; i < start[1]; i++) {
            if (i > start[0] && ref[i] <= ref[i - 1])
                return "a grid's list does not rise";
            missing -= (uint64_t)is_needed(m, vertex, &t[ref[i]], c);
        }
        c[0]++;
        for (int k = 0; k < 2 && c[k] == m->cells[k]; k++) {
            c[k] = 0;
            c[k + 1]++;
        }
    }
    return missing ? "a grid's list lacks a triangle" : NULL;
}

static const char *check_grid(struct glint_scene_check *c,
                              const struct glint_scene_mesh *m)
{
    const uint32_t *start, *ref;
    uint64_t cells = 1;

    if (m->cell_log2 < 2 || m->cell_log2 > 28 ||
        !glint_scene_within(m->origin, 3, SPAN))
        return "a mesh's grid is out of range";
    for (int k = 0; k < 3; k++) {
        if (m->cells[k] < 1 || m->cells[k] > GLINT_SCENE_MAX_CELLS ||
            m->origin[k] + ((int64_t)m->cells[k] << m->cell_log2) > SPAN)
            return "a mesh's grid is out of range";
        cells *= m->cells[k];
    }
    start = glint_blob_section(&c->blob, m->start_at, cells + 1, sizeof *start);
    if (!start)
        return OUTSIDE;
    if (start[0] != 0)
        return "a grid's lists do not begin at 0";
    for (uint64_t i = 0; i < cells; i++)
        if (start[i] > start[i + 1])
            return "a grid's lists do not rise";
    ref = glint_blob_section(&c->blob, m->ref_at, start[cells], sizeof *ref);
    if (!ref)
        return OUTSIDE;
    for (uint32_t i = 0; i < start[cells]; i++)
        if (ref[i] >= m->n_triangles)
            return "a grid's triangle is out of range";
    return check_lists(c, m, start, ref);
}

const char *glint_scene_check_mesh(struct glint_scene_check *check,
                                   const struct glint_scene_mesh *mesh)
{
    const char *wrong = check_vertices(check, mesh);

    if (!wrong)
        wrong = check_attributes(check, mesh);
    if (!wrong)
        wrong = check_triangles(check, mesh);
    return wrong ? wrong : check_grid(check, mesh);
}

/* ----------------------------------------------------------------- objects */

const char *glint_scene_check_object(const struct glint_scene_check *check,
                                     const struct glint_scene_object *o)
{
    const struct glint_scene_header *h = check->model.header;
    const int is_sphere = o->kind == GLINT_OBJECT_SPHERE;
    const int is_plane = o->kind == GLINT_OBJECT_PLANE;

    if (!glint_scene_name_fits(o->name))
        return "an object's name is empty, endless or not printable";
    if (o->kind > GLINT_OBJECT_MESH)
        return "an object's kind is unknown";
    if (o->material >= h->n_materials)
        return "an object's material is out of range";
    if (!is_sphere && !is_plane ? o->mesh >= h->n_meshes : o->mesh != 0)
        return "an object's mesh is out of range";
    if (o->radius < is_sphere || o->radius > (is_sphere ? SPAN / 2 : 0))
        return "a sphere's radius is out of range";
    if (o->catcher_q15 < 0 || o->catcher_q15 > (is_plane ? 1 << 15 : 0))
        return "a plane's share of shadow is out of range";
    if (o->hidden > 1 || !glint_scene_is_unit(o->turn_q30, 4))
        return "an object's pose is out of range";
    return glint_scene_fits(&check->model, o, o->at)
               ? NULL
               : "an object is too far out";
}

/* ------------------------------------------------------------------ stones */

static const char *check_stone(struct glint_scene_check *c,
                               const struct glint_scene_stone *s)
{
    const struct glint_scene_material *m;

    if (s->material >= c->model.header->n_materials || s->fresnel > 1)
        return "a stone's material is out of range";
    m = &c->model.material[s->material];
    if (m->ambient_q15 || m->diffuse_q15 || m->specular_q15 || m->reflect_q15 ||
        m->pass_q15 || m->texture != GLINT_SCENE_NONE)
        return "a stone is Phong's, too";
    if (s->file_bytes < sizeof(struct glint_translucent_header) ||
        s->file_bytes % 4 ||
        !glint_blob_section(&c->blob, s->file_at, s->file_bytes / 4, 4))
        return OUTSIDE;
    return NULL;
}

/* Returns log2 of the side of the stone of SKIN, of which the header alone was
 * seen; 0: it is out of range. */
static uint32_t side_log2_of(const struct glint_scene_model *m,
                             const struct glint_scene_skin *skin)
{
    const unsigned char *file = (const unsigned char *)m->header;
    const struct glint_translucent_header *h =
        (const void *)(file + m->stone[skin->stone].file_at);

    return h->side_log2 < GLINT_TRANSLUCENT_LEAST_LOG2 ||
                   h->side_log2 > GLINT_TRANSLUCENT_MOST_LOG2
               ? 0
               : h->side_log2;
}

static const char *check_ball_map(struct glint_scene_check *c,
                                  const struct glint_scene_skin *skin,
                                  uint32_t side)
{
    const int32_t *turn_q30 =
        glint_blob_section(&c->blob, skin->texel_at, 3 * side, 8);

    if (!turn_q30)
        return OUTSIDE;
    for (uint32_t i = 0; i < 3 * side; i++)
        if (!glint_scene_is_unit(turn_q30 + 2 * (size_t)i, 2))
            return "a column or row of a ball's map is out of range";
    return NULL;
}

static const char *check_mesh_map(struct glint_scene_check *c,
                                  const struct glint_scene_skin *skin,
                                  const struct glint_scene_mesh *mesh,
                                  uint32_t side)
{
    const uint32_t *texel =
        glint_blob_section(&c->blob, skin->texel_at, side * side, 4);

    if (!texel)
        return OUTSIDE;
    if (!mesh->uv_at)
        return "a mesh of stone has no uv";
    for (uint32_t i = 0; i < side * side; i++)
        if (texel[i] != GLINT_SCENE_NONE && texel[i] >= mesh->n_triangles)
            return "a texel's triangle is out of range";
    return NULL;
}

static const char *check_skin(struct glint_scene_check *c, uint32_t i)
{
    const struct glint_scene_model *m = &c->model;
    const struct glint_scene_skin *skin = &m->skin[i];
    const struct glint_scene_object *o;
    uint32_t log2;

    if (skin->object >= m->header->n_objects ||
        skin->stone >= m->header->n_stones || skin->closed > 1)
        return "a map's object or stone is out of range";
    for (uint32_t k = 0; k < i; k++)
        if (m->skin[k].object == skin->object)
            return "an object has two maps";
    o = &m->object[skin->object];
    log2 = side_log2_of(m, skin);
    if (log2 == 0)
        return "the stone's side or kernel is out of range";
    if (o->kind == GLINT_OBJECT_PLANE)
        return "a plane has a map";
    return o->kind == GLINT_OBJECT_SPHERE
               ? check_ball_map(c, skin, UINT32_C(1) << log2)
               : check_mesh_map(c, skin, &m->mesh[o->mesh],
                                UINT32_C(1) << log2);
}

/* Returns whether object I, if it is of a stone, has the map for that. */
static int has_map(const struct glint_scene_model *m, uint32_t i)
{
    for (uint32_t k = 0; k < m->header->n_stones; k++) {
        int has = m->stone[k].material != m->object[i].material ||
                  m->object[i].catcher_q15 > 0; /* which shows no material */

        for (uint32_t j = 0; j < m->header->n_skins; j++)
            has |= m->skin[j].object == i && m->skin[j].stone == k;
        if (!has)
            return 0;
    }
    return 1;
}

const char *glint_scene_check_stones(struct glint_scene_check *c)
{
    const struct glint_scene_header *h = c->model.header;
    const char *wrong = NULL;

    for (uint32_t i = 0; !wrong && i < h->n_stones; i++)
        wrong = check_stone(c, &c->model.stone[i]);
    for (uint32_t i = 0; !wrong && i < h->n_skins; i++)
        wrong = check_skin(c, i);
    for (uint32_t i = 0; !wrong && i < h->n_objects; i++)
        if (!has_map(&c->model, i))
            wrong = "an object of stone has no map";
    return wrong;
}
