/* SPDX-License-Identifier: MIT
 *
 * Checks a baked scene once, so that drawing need not check anything.
 *
 *   in   bytes that may hold anything
 *   out  a model that points into them, or the reason why not
 *
 * Drawing relies on this:
 *   - every table lies inside the file, and every index inside its table;
 *   - every point of space that a file or a pose can name is within
 *     GLINT_SCENE_SPAN, 2^28 steps, so that differences are below 2^29;
 *   - unit vectors are units to 2^-20;
 *   - weights and colours are 0 .. 1, and lights are not negative. */
#include "scene/model_check.h"

#include "base/compiler.h"
#include "base/q.h"

/* The file is used in place: its layout is what these structs are. */
STATIC_ASSERT(sizeof(struct glint_scene_camera) == 60);
STATIC_ASSERT(sizeof(struct glint_scene_light) == 88);
STATIC_ASSERT(sizeof(struct glint_scene_texture) == 12);
STATIC_ASSERT(sizeof(struct glint_scene_material) == 80);
STATIC_ASSERT(sizeof(struct glint_scene_triangle) == 16);
STATIC_ASSERT(sizeof(struct glint_scene_mesh) == 76);
STATIC_ASSERT(sizeof(struct glint_scene_object) == 84);
STATIC_ASSERT(sizeof(struct glint_scene_ward) == 24);
STATIC_ASSERT(sizeof(struct glint_scene_motion) == 96);
STATIC_ASSERT(sizeof(struct glint_scene_stone) == 16);
STATIC_ASSERT(sizeof(struct glint_scene_skin) == 16);
STATIC_ASSERT(sizeof(struct glint_scene_environment) == 56);
STATIC_ASSERT(sizeof(struct glint_scene_header) == 268);

/* The header begins as that of every baked file does. */
GLINT_BLOB_HEADER(struct glint_scene_header, variant);

enum { ONE_Q15 = 1 << 15, ONE_Q30 = 1 << 30, MAX_HIGHLIGHTS = 8 };

static const char *const fault_text[GLINT_BLOB_FAULTS] =
    GLINT_BLOB_FAULT_TEXT("scene", "scenes", "baked");

/* ------------------------------------------------------------------ tables */

static const char *check_light(const struct glint_scene_light *light)
{
    const int is_sun = light->kind == GLINT_LIGHT_SUN;

    if (!glint_scene_name_fits(light->name))
        return "a light's name is empty, endless or not printable";
    if (light->kind > GLINT_LIGHT_LAMP)
        return "a light's kind is unknown";
    if (!glint_scene_within(light->at, 3, is_sun ? 0 : GLINT_SCENE_SPAN - 1) ||
        !glint_scene_between(light->radius, 0,
                             is_sun ? 1 << 29 : GLINT_SCENE_SPAN))
        return "a light is too far out, or too large";
    if (is_sun ? !glint_scene_is_unit(light->toward_q30, 3)
               : !glint_scene_within(light->toward_q30, 3, 0))
        return "a light's direction is no unit vector";
    for (int k = 0; k < 3; k++)
        if (!glint_scene_is_light(&light->rgb[k]))
            return "a light is negative or not normalised";
    return NULL;
}

static const char *check_texture(struct glint_scene_check *c,
                                 const struct glint_scene_texture *t)
{
    uint32_t w = t->width_log2, h = t->height_log2;
    uint64_t texels = 1;

    if (w > GLINT_SCENE_TEXTURE_LOG2 || h > GLINT_SCENE_TEXTURE_LOG2)
        return "a texture is too large";
    for (; w || h; w -= w > 0, h -= h > 0)
        texels += UINT64_C(1) << (w + h);
    return glint_blob_section(&c->blob, t->texel_at, (3 * texels + 3) / 4, 4)
               ? NULL
               : OUTSIDE;
}

static const char *check_material(const struct glint_scene_check *c,
                                  const struct glint_scene_material *m)
{
    const int32_t weight[] = {m->ambient_q15, m->diffuse_q15, m->specular_q15,
                              m->reflect_q15, m->pass_q15,    m->rgb_q15[0],
                              m->rgb_q15[1],  m->rgb_q15[2]};

    if (!glint_scene_name_fits(m->name))
        return "a material's name is empty, endless or not printable";
    for (size_t k = 0; k < sizeof weight / sizeof *weight; k++)
        if (!glint_scene_between(weight[k], 0, ONE_Q15))
            return "a material's weight or colour is not 0 .. 1";
    if (m->ambient_q15 + m->diffuse_q15 + m->specular_q15 > ONE_Q15 ||
        m->reflect_q15 + m->pass_q15 > ONE_Q15)
        return "a material's weights sum to more than 1";
    if (!glint_scene_between(m->power_q8, 1 << 8, 1 << 20) ||
        !glint_scene_between(m->index_q16, 1 << 14, 1 << 18))
        return "a material's power or index is out of range";
    if (m->texture != GLINT_SCENE_NONE &&
        m->texture >= c->model.header->n_textures)
        return "a material's texture is out of range";
    if (m->ward != GLINT_SCENE_NONE && m->ward >= c->model.header->n_wards)
        return "a material's brushed metal is out of range";
    if (m->ward != GLINT_SCENE_NONE && m->specular_q15)
        return "a material is brushed metal and Phong's";
    return NULL;
}

/* The environment's own file is checked by who shows it. */
static const char *check_environment(struct glint_scene_check *c,
                                     const struct glint_scene_environment *e)
{
    if (!glint_scene_name_fits(e->name))
        return "an environment's name is empty, endless or not printable";
    if (!glint_scene_is_unit(e->turn_q30, 2) || e->scale.mantissa == 0 ||
        !glint_scene_is_light(&e->scale))
        return "the environment's turn or scale is out of range";
    return e->file_bytes % 4 == 0 && glint_blob_section(&c->blob, e->file_at,
                                                        e->file_bytes / 4, 4)
               ? NULL
               : OUTSIDE;
}

/* The last lights are suns, which those of environments become. */
static const char *check_suns(const struct glint_scene_model *m)
{
    const struct glint_scene_header *h = m->header;

    for (uint32_t k = 1; k <= h->n_environment_lights; k++)
        if (m->light[h->n_lights - k].kind != GLINT_LIGHT_SUN)
            return "a light of the environment is no sun";
    return NULL;
}

/* The motion's own file is checked by who plays it. */
static const char *check_motion(const struct glint_scene_header *h,
                                const struct glint_scene_motion *m)
{
    const int32_t length[] = {m->size, m->shell, m->line, m->box};
    const uint32_t material[] = {m->shell_material, m->line_material,
                                 m->box_material};

    if (!glint_scene_name_fits(m->name))
        return "a motion's name is empty, endless or not printable";
    for (int k = 0; k < 4; k++)
        if (!glint_scene_between(length[k], 0, GLINT_SCENE_SPAN / 4))
            return "a size of the motion is out of range";
    for (int k = 0; k < 3; k++)
        if (material[k] >= h->n_materials)
            return "a material of the motion is out of range";
    if (m->detect > GLINT_DETECT_BOTH || m->least > 255 || m->bytes % 4 ||
        m->zero)
        return "the motion's settings are unknown";
    return NULL;
}

static const char *check_header(const struct glint_scene_header *h)
{
    if (h->variant > GLINT_HAND_RIGHT)
        return "the scene's variant is unknown";
    if (!glint_scene_between(h->unit_log2, -28, 60))
        return "the scene's unit is out of range";
    if (h->shadow > 1 || h->flare > 1 || h->highlights > MAX_HIGHLIGHTS ||
        h->background > GLINT_BACKGROUND_ENVIRONMENT)
        return "the scene's settings are unknown";
    for (int k = 0; k < 3; k++)
        if (!glint_scene_between(
                h->background_q15[k], 0,
                h->background == GLINT_BACKGROUND_COLOUR ? ONE_Q30 : 0))
            return "the background's colour is out of range";
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
        return "the scene has too many of a kind";
    if (h->background == GLINT_BACKGROUND_ENVIRONMENT && !h->n_environments)
        return "the background's environment is not there";
    return glint_scene_camera_fault(&h->camera);
}

/* ------------------------------------------------------------------- whole */

static const char *find_tables(struct glint_scene_check *c)
{
    const struct glint_scene_header *h = c->model.header;
    struct glint_scene_model *m = &c->model;
    struct glint_blob *b = &c->blob;

    m->light =
        glint_blob_section(b, h->light_at, h->n_lights, sizeof *m->light);
    m->texture =
        glint_blob_section(b, h->texture_at, h->n_textures, sizeof *m->texture);
    m->material = glint_blob_section(b, h->material_at, h->n_materials,
                                     sizeof *m->material);
    m->mesh = glint_blob_section(b, h->mesh_at, h->n_meshes, sizeof *m->mesh);
    m->object =
        glint_blob_section(b, h->object_at, h->n_objects, sizeof *m->object);
    m->ward = glint_blob_section(b, h->ward_at, h->n_wards, sizeof *m->ward);
    m->stone =
        glint_blob_section(b, h->stone_at, h->n_stones, sizeof *m->stone);
    m->skin = glint_blob_section(b, h->skin_at, h->n_skins, sizeof *m->skin);
    m->environment = glint_blob_section(b, h->environment_at, h->n_environments,
                                        sizeof *m->environment);
    if (h->n_motions) {
        m->motion = glint_blob_section(b, h->motion_at, 1, sizeof *m->motion);
        if (!m->motion ||
            !glint_blob_section(b, h->motion_at + (uint32_t)sizeof *m->motion,
                                m->motion->bytes / 4, 4))
            return OUTSIDE;
    }
    return m->light && m->texture && m->material && m->mesh && m->object &&
                   m->ward && m->stone && m->skin && m->environment
               ? NULL
               : OUTSIDE;
}

static const char *check_contents(struct glint_scene_check *c)
{
    const struct glint_scene_model *m = &c->model;
    const struct glint_scene_header *h = m->header;
    const char *wrong = fault_text[glint_blob_check_name(&c->blob)];
    uint64_t triangles = 0;

    if (!wrong)
        wrong = check_header(h);
    if (!wrong)
        wrong = find_tables(c);
    for (uint32_t k = 0; !wrong && k < h->n_lights; k++)
        wrong = check_light(&m->light[k]);
    for (uint32_t k = 0; !wrong && k < h->n_environments; k++)
        wrong = check_environment(c, &m->environment[k]);
    if (!wrong)
        wrong = check_suns(m);
    for (uint32_t k = 0; !wrong && k < h->n_textures; k++)
        wrong = check_texture(c, &m->texture[k]);
    for (uint32_t k = 0; !wrong && k < h->n_wards; k++)
        wrong = glint_scene_ward_fault(&m->ward[k]);
    for (uint32_t k = 0; !wrong && k < h->n_materials; k++)
        wrong = check_material(c, &m->material[k]);
    for (uint32_t k = 0; !wrong && k < h->n_meshes; k++) {
        wrong = glint_scene_check_mesh(c, &m->mesh[k]);
        if (!wrong && c->blob.referred > c->blob.bytes)
            wrong = "tables share bytes";
    }
    for (uint32_t k = 0; !wrong && k < h->n_objects; k++) {
        wrong = glint_scene_check_object(c, &m->object[k]);
        if (!wrong && m->object[k].kind == GLINT_OBJECT_MESH)
            triangles += m->mesh[m->object[k].mesh].n_triangles;
    }
    if (!wrong && m->motion)
        wrong = check_motion(h, m->motion);
    if (!wrong && triangles > GLINT_SCENE_MAX_TRIANGLES)
        wrong = "the objects have too many triangles";
    return wrong ? wrong : glint_scene_check_stones(c);
}

enum glint_status glint_scene_open(struct glint_scene_model *model,
                                   const void *data, size_t bytes,
                                   const char **reason)
{
    static const struct glint_blob_kind kind = {
        GLINT_SCENE_MAGIC, GLINT_SCENE_VERSION,
        sizeof(struct glint_scene_header)};
    struct glint_scene_check c = {.model = {.header = data}};
    const char *wrong =
        fault_text[glint_blob_open(&c.blob, &kind, data, bytes)];

    if (!wrong)
        wrong = check_contents(&c);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_FORMAT;
    }
    *model = c.model;
    return GLINT_OK;
}

static int is_same(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

int glint_scene_find(const struct glint_scene_model *model, const char *name)
{
    for (uint32_t k = 0; k < model->header->n_objects; k++)
        if (is_same(model->object[k].name, name))
            return (int)k;
    return -1;
}

int glint_scene_find_material(const struct glint_scene_model *model,
                              const char *name)
{
    for (uint32_t k = 0; k < model->header->n_materials; k++)
        if (is_same(model->material[k].name, name))
            return (int)k;
    return -1;
}

int glint_scene_find_environment(const struct glint_scene_model *model,
                                 const char *name)
{
    for (uint32_t k = 0; k < model->header->n_environments; k++)
        if (is_same(model->environment[k].name, name))
            return (int)k;
    return -1;
}
