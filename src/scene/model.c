/* SPDX-License-Identifier: MIT
 *
 * Checks a baked scene once, so that drawing need not check anything.
 *
 *    in   bytes with any contents
 *    out  a model that points into them, or the text of an error
 *
 * Drawing relies on this:
 *   - every table lies inside the file, and every index inside its table;
 *   - every point that a file or a pose can specify is within
 *     GLINT_SCENE_SPAN, 2^28 steps, so that differences are below 2^29;
 *   - unit vectors have length 1 to within 2^-20;
 *   - weights and colours are 0 .. 1, and lights are not negative.
 */
#include "base/blob.h"
#include "base/compiler.h"
#include "base/q.h"
#include "glint/scene/model.h"
#include "glint/scene/translucent.h"
#include "scene/valid.h"

struct check {
    struct glint_blob blob;
    struct glint_scene_model model;
};

#define OUTSIDE "damaged scene: a table lies outside the file"

enum { SPAN = GLINT_SCENE_SPAN, UV_LIMIT = 1 << 24 };

/* ------------------------------------------------------------------ meshes */

static const char *check_vertices(struct check *c,
                                  const struct glint_scene_mesh *m)
{
    const int32_t *at = glint_blob_find_section(&c->blob, m->vertex_at,
                                                m->n_vertices, 3 * sizeof *at);
    const int64_t reach = (int64_t)m->radius + 2;

    if (!at)
        return OUTSIDE;
    if (!glint_scene_is_vector_within(m->centre, 3, SPAN / 2) ||
        m->radius < 0 ||
        glint_scene_compute_vector_length(m->centre) + m->radius > SPAN / 2)
        return "damaged scene: a mesh is too large, or outside the scene's "
               "coordinate range";
    for (size_t i = 0; i < m->n_vertices; i++) {
        int32_t off[3];

        if (!glint_scene_is_vector_within(at + 3 * i, 3, SPAN))
            return "damaged scene: a vertex is outside the scene's coordinate "
                   "range";
        for (int k = 0; k < 3; k++)
            off[k] = at[3 * i + (size_t)k] - m->centre[k];
        if (glint_scene_compute_vector_length(off) > reach)
            return "damaged scene: a vertex is outside the bounding sphere of "
                   "its mesh";
    }
    return NULL;
}

static const char *check_attributes(struct check *c,
                                    const struct glint_scene_mesh *m)
{
    const int32_t *uv_q16 = NULL, *normal_q30 = NULL;

    if (m->uv_at &&
        !(uv_q16 = glint_blob_find_section(&c->blob, m->uv_at, m->n_vertices,
                                           2 * sizeof *uv_q16)))
        return OUTSIDE;
    if (m->normal_at &&
        !(normal_q30 = glint_blob_find_section(
              &c->blob, m->normal_at, m->n_vertices, 3 * sizeof *normal_q30)))
        return OUTSIDE;
    for (size_t i = 0; i < m->n_vertices; i++) {
        if (uv_q16 &&
            !glint_scene_is_vector_within(uv_q16 + 2 * i, 2, UV_LIMIT))
            return "damaged scene: a vertex's texture coordinate is out of "
                   "range";
        if (normal_q30 && !glint_scene_is_unit_vector(normal_q30 + 3 * i, 3))
            return "damaged scene: a vertex's normal is not a unit vector";
    }
    return NULL;
}

static const char *check_triangles(struct check *c,
                                   const struct glint_scene_mesh *m)
{
    const struct glint_scene_triangle *t = glint_blob_find_section(
        &c->blob, m->triangle_at, m->n_triangles, sizeof *t);

    if (!t)
        return OUTSIDE;
    for (uint32_t i = 0; i < m->n_triangles; i++) {
        for (int k = 0; k < 3; k++)
            if (t[i].vertex[k] >= m->n_vertices)
                return "damaged scene: a triangle refers to a vertex that does "
                       "not exist";
        if (t[i].material != GLINT_SCENE_NONE &&
            t[i].material >= c->model.header->n_materials)
            return "damaged scene: a triangle refers to a material that does "
                   "not exist";
    }
    return NULL;
}

/* Sets FIRST and LAST, along each axis, to the first and last cell that the
 * bounding box of triangle T overlaps. */
static void find_overlapped_cells(const struct glint_scene_mesh *m,
                                  const int32_t *vertex,
                                  const struct glint_scene_triangle *t,
                                  int32_t first[3], int32_t last[3])
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

/* Returns whether the bounding box of triangle T overlaps cell C. */
static int triangle_overlaps_cell(const struct glint_scene_mesh *m,
                                  const int32_t *vertex,
                                  const struct glint_scene_triangle *t,
                                  const uint32_t c[3])
{
    int32_t first[3], last[3];
    int is = 1;

    find_overlapped_cells(m, vertex, t, first, last);
    for (int k = 0; k < 3; k++)
        is &= (int32_t)c[k] >= first[k] && (int32_t)c[k] <= last[k];
    return is;
}

/* Checks that each triangle is listed in each cell that its bounding box
 * overlaps. Lists are sorted and have no duplicates. So it suffices that each
 * entry is justified and the number of entries is right. */
static const char *check_cell_lists(const struct check *check,
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

        find_overlapped_cells(m, vertex, &t[i], first, last);
        missing += (uint64_t)(last[0] - first[0] + 1) *
                   (uint64_t)(last[1] - first[1] + 1) *
                   (uint64_t)(last[2] - first[2] + 1);
    }
    for (; c[2] < m->cells[2]; start++) {
        for (uint32_t i = start[0]; i < start[1]; i++) {
            if (i > start[0] && ref[i] <= ref[i - 1])
                return "damaged scene: a grid cell lists its triangles out of "
                       "order";
            missing -=
                (uint64_t)triangle_overlaps_cell(m, vertex, &t[ref[i]], c);
        }
        c[0]++;
        for (int k = 0; k < 2 && c[k] == m->cells[k]; k++) {
            c[k] = 0;
            c[k + 1]++;
        }
    }
    return missing ? "damaged scene: a grid cell does not list a triangle that "
                     "overlaps it"
                   : NULL;
}

static const char *check_mesh_grid(struct check *c,
                                   const struct glint_scene_mesh *m)
{
    const uint32_t *start, *ref;
    uint64_t cells = 1;

    if (m->cell_log2 < 2 || m->cell_log2 > 28 ||
        !glint_scene_is_vector_within(m->origin, 3, SPAN))
        return "damaged scene: the grid of a mesh is outside the scene's "
               "coordinate range";
    for (int k = 0; k < 3; k++) {
        if (m->cells[k] < 1 || m->cells[k] > GLINT_SCENE_MAX_CELLS ||
            m->origin[k] + ((int64_t)m->cells[k] << m->cell_log2) > SPAN)
            return "damaged scene: the grid of a mesh is outside the scene's "
                   "coordinate range";
        cells *= m->cells[k];
    }
    start = glint_blob_find_section(&c->blob, m->start_at, cells + 1,
                                    sizeof *start);
    if (!start)
        return OUTSIDE;
    if (start[0] != 0)
        return "damaged scene: the triangle lists of a grid do not begin at "
               "entry 0";
    for (uint64_t i = 0; i < cells; i++)
        if (start[i] > start[i + 1])
            return "damaged scene: the triangle lists of a grid overlap";
    ref =
        glint_blob_find_section(&c->blob, m->ref_at, start[cells], sizeof *ref);
    if (!ref)
        return OUTSIDE;
    for (uint32_t i = 0; i < start[cells]; i++)
        if (ref[i] >= m->n_triangles)
            return "damaged scene: a grid cell refers to a triangle that does "
                   "not exist";
    return check_cell_lists(c, m, start, ref);
}

/* Checks one mesh. Returns the text of an error, or NULL. */
static const char *check_mesh(struct check *check,
                              const struct glint_scene_mesh *mesh)
{
    const char *wrong = check_vertices(check, mesh);

    if (!wrong)
        wrong = check_attributes(check, mesh);
    if (!wrong)
        wrong = check_triangles(check, mesh);
    return wrong ? wrong : check_mesh_grid(check, mesh);
}

/* ----------------------------------------------------------------- objects */

static const char *check_object(const struct check *check,
                                const struct glint_scene_object *o)
{
    const struct glint_scene_header *h = check->model.header;
    const int is_sphere = o->kind == GLINT_OBJECT_SPHERE;
    const int is_plane = o->kind == GLINT_OBJECT_PLANE;

    if (!glint_scene_is_valid_name(o->name))
        return "damaged scene: an object's name is empty, unterminated or not "
               "printable";
    if (o->kind > GLINT_OBJECT_MESH)
        return "damaged scene: an object is of an unknown type";
    if (o->material >= h->n_materials)
        return "damaged scene: an object refers to a material that does not "
               "exist";
    if (!is_sphere && !is_plane ? o->mesh >= h->n_meshes : o->mesh != 0)
        return "damaged scene: an object refers to a mesh that does not exist";
    if (o->radius < is_sphere || o->radius > (is_sphere ? SPAN / 2 : 0))
        return "damaged scene: a sphere's radius is out of range";
    if (o->catcher_q15 < 0 || o->catcher_q15 > (is_plane ? 1 << 15 : 0))
        return "damaged scene: the shadow strength of a plane is not 0 .. 1";
    if (!glint_scene_is_number_in_range(o->unblocked_q15, 0, 1 << 15))
        return "damaged scene: the light in an object's shadow is not 0 .. 1";
    if (o->hidden > 1 || !glint_scene_is_unit_vector(o->turn_q30, 4))
        return "damaged scene: an object's rotation is not a unit quaternion";
    return glint_scene_is_object_in_range(&check->model, o, o->at)
               ? NULL
               : "damaged scene: an object is outside the scene's coordinate "
                 "range";
}

/* ------------------------------------------------------------------
 * translucent media */

static const char *check_translucent_medium(struct check *c,
                                            const struct glint_scene_stone *s)
{
    const struct glint_scene_material *m;

    if (s->material >= c->model.header->n_materials || s->fresnel > 1)
        return "damaged scene: a translucent medium refers to a material that "
               "does not exist";
    m = &c->model.material[s->material];
    if (m->ambient_q15 || m->diffuse_q15 || m->specular_q15 || m->reflect_q15 ||
        m->pass_q15 || m->texture != GLINT_SCENE_NONE)
        return "damaged scene: a translucent material also has Phong shading "
               "or a texture";
    if (s->file_bytes < sizeof(struct glint_translucent_header) ||
        s->file_bytes % 4 ||
        !glint_blob_find_section(&c->blob, s->file_at, s->file_bytes / 4, 4))
        return OUTSIDE;
    return NULL;
}

/* Returns log2 of the side, in texels, of the map that SKIN describes. Reads it
 * from the medium's header, which is not checked yet; returns 0 if it is out of
 * range. */
static uint32_t read_map_side_log2(const struct glint_scene_model *m,
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

static const char *check_ball_map(struct check *c,
                                  const struct glint_scene_skin *skin,
                                  uint32_t side)
{
    const int32_t *turn_q30 =
        glint_blob_find_section(&c->blob, skin->texel_at, 3 * side, 8);

    if (!turn_q30)
        return OUTSIDE;
    for (uint32_t i = 0; i < 3 * side; i++)
        if (!glint_scene_is_unit_vector(turn_q30 + 2 * (size_t)i, 2))
            return "damaged scene: the texel map of a translucent sphere has "
                   "an invalid direction";
    return NULL;
}

static const char *check_mesh_map(struct check *c,
                                  const struct glint_scene_skin *skin,
                                  const struct glint_scene_mesh *mesh,
                                  uint32_t side)
{
    const uint32_t *texel =
        glint_blob_find_section(&c->blob, skin->texel_at, side * side, 4);

    if (!texel)
        return OUTSIDE;
    if (!mesh->uv_at)
        return "damaged scene: a translucent mesh has no texture coordinates";
    for (uint32_t i = 0; i < side * side; i++)
        if (texel[i] != GLINT_SCENE_NONE && texel[i] >= mesh->n_triangles)
            return "damaged scene: a texel refers to a triangle that does not "
                   "exist";
    return NULL;
}

static const char *check_translucency_map(struct check *c, uint32_t i)
{
    const struct glint_scene_model *m = &c->model;
    const struct glint_scene_skin *skin = &m->skin[i];
    const struct glint_scene_object *o;
    uint32_t log2;

    if (skin->object >= m->header->n_objects ||
        skin->stone >= m->header->n_stones || skin->closed > 1)
        return "damaged scene: a texel map refers to an object or medium that "
               "does not exist";
    for (uint32_t k = 0; k < i; k++)
        if (m->skin[k].object == skin->object)
            return "damaged scene: an object has two texel maps";
    o = &m->object[skin->object];
    log2 = read_map_side_log2(m, skin);
    if (log2 == 0)
        return "damaged scene: the texel count of a translucent medium is out "
               "of range";
    if (o->kind == GLINT_OBJECT_PLANE)
        return "damaged scene: a plane has a texel map of a translucent medium";
    return o->kind == GLINT_OBJECT_SPHERE
               ? check_ball_map(c, skin, UINT32_C(1) << log2)
               : check_mesh_map(c, skin, &m->mesh[o->mesh],
                                UINT32_C(1) << log2);
}

/* Returns 0 if object I is translucent but has no light map, else 1. */
static int has_map_if_translucent(const struct glint_scene_model *m, uint32_t i)
{
    for (uint32_t k = 0; k < m->header->n_stones; k++) {
        int has = m->stone[k].material != m->object[i].material ||
                  m->object[i].catcher_q15 > 0; /* a shadow catcher shows no
                                                   material, so it needs no
                                                   map */

        for (uint32_t j = 0; j < m->header->n_skins; j++)
            has |= m->skin[j].object == i && m->skin[j].stone == k;
        if (!has)
            return 0;
    }
    return 1;
}

/* Checks the tables of translucent media and of their maps (skins). The module
 * that draws translucent media checks their files when it opens them. */
static const char *check_translucent_tables(struct check *c)
{
    const struct glint_scene_header *h = c->model.header;
    const char *wrong = NULL;

    for (uint32_t i = 0; !wrong && i < h->n_stones; i++)
        wrong = check_translucent_medium(c, &c->model.stone[i]);
    for (uint32_t i = 0; !wrong && i < h->n_skins; i++)
        wrong = check_translucency_map(c, i);
    for (uint32_t i = 0; !wrong && i < h->n_objects; i++)
        if (!has_map_if_translucent(&c->model, i))
            wrong = "damaged scene: a translucent object has no texel map";
    return wrong;
}

/* The program reads the file in place: these structs are the file's layout. */
STATIC_ASSERT(sizeof(struct glint_scene_camera) == 60);
STATIC_ASSERT(sizeof(struct glint_scene_light) == 88);
STATIC_ASSERT(sizeof(struct glint_scene_texture) == 12);
STATIC_ASSERT(sizeof(struct glint_scene_material) == 80);
STATIC_ASSERT(sizeof(struct glint_scene_triangle) == 16);
STATIC_ASSERT(sizeof(struct glint_scene_mesh) == 76);
STATIC_ASSERT(sizeof(struct glint_scene_object) == 88);
STATIC_ASSERT(sizeof(struct glint_scene_ward) == 24);
STATIC_ASSERT(sizeof(struct glint_scene_motion) == 96);
STATIC_ASSERT(sizeof(struct glint_scene_stone) == 16);
STATIC_ASSERT(sizeof(struct glint_scene_skin) == 16);
STATIC_ASSERT(sizeof(struct glint_scene_environment) == 56);
STATIC_ASSERT(sizeof(struct glint_scene_header) == 268);

/* checks that the members that all baked files share have the same offsets */
GLINT_BLOB_HEADER(struct glint_scene_header, variant);

enum { ONE_Q15 = 1 << 15, ONE_Q30 = 1 << 30, MAX_HIGHLIGHTS = 8 };

static const char *const fault_text[GLINT_BLOB_FAULTS] =
    GLINT_BLOB_FAULT_TEXT("scene", "scenes", "baked");

/* ------------------------------------------------------------------ tables */

static const char *check_light(const struct glint_scene_light *light)
{
    const int is_sun = light->kind == GLINT_LIGHT_SUN;

    if (!glint_scene_is_valid_name(light->name))
        return "damaged scene: a light's name is empty, unterminated or not "
               "printable";
    if (light->kind > GLINT_LIGHT_LAMP)
        return "damaged scene: a light is of an unknown type";
    if (!glint_scene_is_vector_within(light->at, 3,
                                      is_sun ? 0 : GLINT_SCENE_SPAN - 1) ||
        !glint_scene_is_number_in_range(light->radius, 0,
                                        is_sun ? 1 << 29 : GLINT_SCENE_SPAN))
        return "damaged scene: a light is too large, or outside the scene's "
               "coordinate range";
    if (is_sun ? !glint_scene_is_unit_vector(light->toward_q30, 3)
               : !glint_scene_is_vector_within(light->toward_q30, 3, 0))
        return "damaged scene: a light's direction is not a unit vector";
    for (int k = 0; k < 3; k++)
        if (!glint_scene_is_valid_intensity(&light->rgb[k]))
            return "damaged scene: a light's intensity is negative or not "
                   "normalised";
    return NULL;
}

static const char *check_texture(struct check *c,
                                 const struct glint_scene_texture *t)
{
    uint32_t w = t->width_log2, h = t->height_log2;
    uint64_t texels = 1;

    if (w > GLINT_SCENE_TEXTURE_LOG2 || h > GLINT_SCENE_TEXTURE_LOG2)
        return "damaged scene: a texture is too large";
    for (; w || h; w -= w > 0, h -= h > 0)
        texels += UINT64_C(1) << (w + h);
    return glint_blob_find_section(&c->blob, t->texel_at, (3 * texels + 3) / 4,
                                   4)
               ? NULL
               : OUTSIDE;
}

static const char *check_material(const struct check *c,
                                  const struct glint_scene_material *m)
{
    const int32_t weight[] = {m->ambient_q15, m->diffuse_q15, m->specular_q15,
                              m->reflect_q15, m->pass_q15,    m->rgb_q15[0],
                              m->rgb_q15[1],  m->rgb_q15[2]};

    if (!glint_scene_is_valid_name(m->name))
        return "damaged scene: a material's name is empty, unterminated or not "
               "printable";
    for (size_t k = 0; k < sizeof weight / sizeof *weight; k++)
        if (!glint_scene_is_number_in_range(weight[k], 0, ONE_Q15))
            return "damaged scene: a material's weight or colour is not 0 .. 1";
    if (m->ambient_q15 + m->diffuse_q15 + m->specular_q15 > ONE_Q15 ||
        m->reflect_q15 + m->pass_q15 > ONE_Q15)
        return "damaged scene: a material's weights sum to more than 1";
    if (!glint_scene_is_number_in_range(m->power_q8, 1 << 8, 1 << 20) ||
        !glint_scene_is_number_in_range(m->index_q16, 1 << 14, 1 << 18))
        return "damaged scene: a material's Phong exponent or refractive index "
               "is out of range";
    if (m->texture != GLINT_SCENE_NONE &&
        m->texture >= c->model.header->n_textures)
        return "damaged scene: a material refers to a texture that does not "
               "exist";
    if (m->ward != GLINT_SCENE_NONE && m->ward >= c->model.header->n_wards)
        return "damaged scene: a material refers to a brushed metal that does "
               "not exist";
    if (m->ward != GLINT_SCENE_NONE && m->specular_q15)
        return "damaged scene: a brushed metal also has a Phong highlight";
    return NULL;
}

/* Checks an entry of the table of environments. The module that draws
 * environments checks the files of environments. */
static const char *check_environment(struct check *c,
                                     const struct glint_scene_environment *e)
{
    if (!glint_scene_is_valid_name(e->name))
        return "damaged scene: an environment's name is empty, unterminated or "
               "not printable";
    if (!glint_scene_is_unit_vector(e->turn_q30, 2) || e->scale.mantissa == 0 ||
        !glint_scene_is_valid_intensity(&e->scale))
        return "damaged scene: the environment's rotation or intensity scale "
               "is invalid";
    return e->file_bytes % 4 == 0 &&
                   glint_blob_find_section(&c->blob, e->file_at,
                                           e->file_bytes / 4, 4)
               ? NULL
               : OUTSIDE;
}

/* Checks that the last lights of the table, whose values the environment
 * replaces, are suns. */
static const char *check_environment_suns(const struct glint_scene_model *m)
{
    const struct glint_scene_header *h = m->header;

    for (uint32_t k = 1; k <= h->n_environment_lights; k++)
        if (m->light[h->n_lights - k].kind != GLINT_LIGHT_SUN)
            return "damaged scene: a light of the environment is not of the "
                   "type sun";
    return NULL;
}

/* Checks the parameters of a motion. The module that plays motions checks the
 * motion's file. */
static const char *check_motion(const struct glint_scene_header *h,
                                const struct glint_scene_motion *m)
{
    const int32_t length[] = {m->size, m->shell, m->line, m->box};
    const uint32_t material[] = {m->shell_material, m->line_material,
                                 m->box_material};

    if (!glint_scene_is_valid_name(m->name))
        return "damaged scene: the motion's name is empty, unterminated or not "
               "printable";
    for (int k = 0; k < 4; k++)
        if (!glint_scene_is_number_in_range(length[k], 0, GLINT_SCENE_SPAN / 4))
            return "damaged scene: a size of the motion's body or markers is "
                   "out of range";
    for (int k = 0; k < 3; k++)
        if (material[k] >= h->n_materials)
            return "damaged scene: the motion refers to a material that does "
                   "not exist";
    if (m->detect > GLINT_DETECT_BOTH || m->least > 255 || m->bytes % 4 ||
        m->zero)
        return "damaged scene: the motion's detection settings are out of "
               "range";
    return NULL;
}

static const char *check_header(const struct glint_scene_header *h)
{
    if (h->variant > GLINT_HAND_RIGHT)
        return "the scene file is of a variant that this glint does not know";
    if (!glint_scene_is_number_in_range(h->unit_log2, -28, 60))
        return "damaged scene: the unit of length is out of range";
    if (h->shadow > 1 || h->flare > 1 || h->highlights > MAX_HIGHLIGHTS ||
        h->background > GLINT_BACKGROUND_ENVIRONMENT)
        return "damaged scene: the settings of shadow, flare or background are "
               "out of range";
    for (int k = 0; k < 3; k++)
        if (!glint_scene_is_number_in_range(
                h->background_q15[k], 0,
                h->background == GLINT_BACKGROUND_COLOUR ? ONE_Q30 : 0))
            return "damaged scene: the background's colour is out of range";
    if (h->n_lights > GLINT_SCENE_MAX_LIGHTS ||
        h->n_textures > GLINT_SCENE_MAX_TEXTURES ||
        h->n_materials > GLINT_SCENE_MAX_MATERIALS ||
        h->n_meshes > GLINT_SCENE_MAX_MESHES ||
        h->n_objects > GLINT_SCENE_MAX_OBJECTS ||
        h->n_wards > GLINT_SCENE_MAX_MATERIALS ||
        h->n_stones > GLINT_SCENE_MAX_SKINS ||
        h->n_skins > GLINT_SCENE_MAX_SKINS || h->n_motions > 1 ||
        h->n_environments > GLINT_SCENE_MAX_ENVIRONMENTS ||
        h->n_environment_lights > (h->n_environments ? h->n_lights : 0))
        return "damaged scene: it has too many objects, lights, materials or "
               "meshes";
    if (h->background == GLINT_BACKGROUND_ENVIRONMENT && !h->n_environments)
        return "damaged scene: the background needs an environment, but there "
               "is none";
    return glint_scene_check_camera(&h->camera);
}

/* -------------------------------------------------------------------- file */

static const char *locate_tables_in_file(struct check *c)
{
    const struct glint_scene_header *h = c->model.header;
    struct glint_scene_model *m = &c->model;
    struct glint_blob *b = &c->blob;

    m->light =
        glint_blob_find_section(b, h->light_at, h->n_lights, sizeof *m->light);
    m->texture = glint_blob_find_section(b, h->texture_at, h->n_textures,
                                         sizeof *m->texture);
    m->material = glint_blob_find_section(b, h->material_at, h->n_materials,
                                          sizeof *m->material);
    m->mesh =
        glint_blob_find_section(b, h->mesh_at, h->n_meshes, sizeof *m->mesh);
    m->object = glint_blob_find_section(b, h->object_at, h->n_objects,
                                        sizeof *m->object);
    m->ward =
        glint_blob_find_section(b, h->ward_at, h->n_wards, sizeof *m->ward);
    m->stone =
        glint_blob_find_section(b, h->stone_at, h->n_stones, sizeof *m->stone);
    m->skin =
        glint_blob_find_section(b, h->skin_at, h->n_skins, sizeof *m->skin);
    m->environment = glint_blob_find_section(
        b, h->environment_at, h->n_environments, sizeof *m->environment);
    if (h->n_motions) {
        m->motion =
            glint_blob_find_section(b, h->motion_at, 1, sizeof *m->motion);
        if (!m->motion || !glint_blob_find_section(
                              b, h->motion_at + (uint32_t)sizeof *m->motion,
                              m->motion->bytes / 4, 4))
            return OUTSIDE;
    }
    return m->light && m->texture && m->material && m->mesh && m->object &&
                   m->ward && m->stone && m->skin && m->environment
               ? NULL
               : OUTSIDE;
}

static const char *check_all_tables(struct check *c)
{
    const struct glint_scene_model *m = &c->model;
    const struct glint_scene_header *h = m->header;
    const char *wrong = fault_text[glint_blob_check_name(&c->blob)];
    uint64_t triangles = 0;

    if (!wrong)
        wrong = check_header(h);
    if (!wrong)
        wrong = locate_tables_in_file(c);
    for (uint32_t k = 0; !wrong && k < h->n_lights; k++)
        wrong = check_light(&m->light[k]);
    for (uint32_t k = 0; !wrong && k < h->n_environments; k++)
        wrong = check_environment(c, &m->environment[k]);
    if (!wrong)
        wrong = check_environment_suns(m);
    for (uint32_t k = 0; !wrong && k < h->n_textures; k++)
        wrong = check_texture(c, &m->texture[k]);
    for (uint32_t k = 0; !wrong && k < h->n_wards; k++)
        wrong = glint_scene_check_metal(&m->ward[k]);
    for (uint32_t k = 0; !wrong && k < h->n_materials; k++)
        wrong = check_material(c, &m->material[k]);
    for (uint32_t k = 0; !wrong && k < h->n_meshes; k++) {
        wrong = check_mesh(c, &m->mesh[k]);
        if (!wrong && c->blob.referred > c->blob.bytes)
            wrong = "damaged scene: tables overlap";
    }
    for (uint32_t k = 0; !wrong && k < h->n_objects; k++) {
        wrong = check_object(c, &m->object[k]);
        if (!wrong && m->object[k].kind == GLINT_OBJECT_MESH)
            triangles += m->mesh[m->object[k].mesh].n_triangles;
    }
    if (!wrong && m->motion)
        wrong = check_motion(h, m->motion);
    if (!wrong && triangles > GLINT_SCENE_MAX_TRIANGLES)
        wrong = "damaged scene: the objects have too many triangles";
    return wrong ? wrong : check_translucent_tables(c);
}

enum glint_status glint_scene_open(struct glint_scene_model *model,
                                   const void *data, size_t bytes,
                                   const char **reason)
{
    static const struct glint_blob_kind kind = {
        GLINT_SCENE_MAGIC, GLINT_SCENE_VERSION,
        sizeof(struct glint_scene_header)};
    struct check c = {.model = {.header = data}};
    const char *wrong =
        fault_text[glint_blob_open(&c.blob, &kind, data, bytes)];

    if (!wrong)
        wrong = check_all_tables(&c);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_FORMAT;
    }
    *model = c.model;
    return GLINT_OK;
}

static int are_names_equal(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

/* Returns the index of NAME among N names that are STRIDE bytes apart, or -1 if
 * none of them is NAME. */
static int find_name_index(const char *names, size_t stride, uint32_t n,
                           const char *name)
{
    for (uint32_t k = 0; k < n; k++, names += stride)
        if (are_names_equal(names, name))
            return (int)k;
    return -1;
}

int glint_scene_find(const struct glint_scene_model *model, const char *name)
{
    return find_name_index(model->object->name, sizeof *model->object,
                           model->header->n_objects, name);
}

int glint_scene_find_material(const struct glint_scene_model *model,
                              const char *name)
{
    return find_name_index(model->material->name, sizeof *model->material,
                           model->header->n_materials, name);
}

int glint_scene_find_environment(const struct glint_scene_model *model,
                                 const char *name)
{
    return find_name_index(model->environment->name, sizeof *model->environment,
                           model->header->n_environments, name);
}
