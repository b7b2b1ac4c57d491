/* SPDX-License-Identifier: MIT
 *
 * Changes materials and environments between frames. A scene owns copies of the
 * model's tables and draws with these. */
#include "scene/valid.h"
#include "scene/parts.h"
#include "scene/state.h"

void glint_scene_copy_materials(struct glint_scene *scene)
{
    const struct glint_scene_header *h = scene->model.header;

    for (uint32_t i = 0; i < h->n_materials; i++)
        scene->material[i] = scene->model.material[i];
    for (uint32_t i = 0; i < h->n_wards; i++)
        scene->ward[i] = scene->model.ward[i];
    scene->model.material = scene->material;
    scene->model.ward = scene->ward;
}

/* Returns the metal parameters of material M, or NULL if M is not a metal. */
static struct glint_scene_ward *
get_metal_parameters(const struct glint_scene *s,
                     const struct glint_scene_material *m)
{
    return m->ward == GLINT_SCENE_NONE ? NULL : &s->ward[m->ward];
}

enum glint_status glint_scene_get_look(const struct glint_scene *scene,
                                       int material,
                                       struct glint_scene_look *look)
{
    const struct glint_scene_material *m;
    const struct glint_scene_ward *ward;

    if (material < 0 || material >= (int)scene->model.header->n_materials)
        return GLINT_E_ARGUMENT;
    m = &scene->material[material];
    ward = get_metal_parameters(scene, m);
    *look = (struct glint_scene_look){.rgb_q15 = {0}};
    for (int k = 0; k < 3; k++) {
        look->rgb_q15[k] = m->rgb_q15[k];
        look->specular_q15[k] = ward ? ward->specular_q15[k] : 0;
    }
    for (int k = 0; ward && k < 2; k++)
        look->alpha_q24[k] = ward->alpha_q24[k];
    return GLINT_OK;
}

/* Returns whether all members of LOOK are in range, and copies its metal
 * parameters to WARD. Unless IS_METAL is set, these must be 0. */
static int is_valid_look(const struct glint_scene_look *look, int is_metal,
                         struct glint_scene_ward *ward)
{
    int any = 0;

    for (int k = 0; k < 3; k++) {
        if (look->rgb_q15[k] < 0 || look->rgb_q15[k] > GLINT_SCENE_ONE_Q15)
            return 0;
        ward->specular_q15[k] = look->specular_q15[k];
        any |= look->specular_q15[k];
    }
    for (int k = 0; k < 2; k++) {
        ward->alpha_q24[k] = look->alpha_q24[k];
        any |= look->alpha_q24[k];
    }
    return is_metal ? glint_scene_check_metal(ward) == NULL : any == 0;
}

enum glint_status glint_scene_set_look(struct glint_scene *scene, int material,
                                       const struct glint_scene_look *look)
{
    struct glint_scene_ward changed = {.norm = 0}, *ward;
    struct glint_scene_material *m;

    if (material < 0 || material >= (int)scene->model.header->n_materials)
        return GLINT_E_ARGUMENT;
    m = &scene->material[material];
    ward = get_metal_parameters(scene, m);
    if (ward)
        changed.norm = ward->norm;
    if (!is_valid_look(look, ward != NULL, &changed))
        return GLINT_E_ARGUMENT;
    for (int k = 0; k < 3; k++)
        m->rgb_q15[k] = look->rgb_q15[k];
    if (ward) {
        *ward = changed;
        scene->cfg.parts.wards->change(scene, m->ward);
    }
    return GLINT_OK;
}

/* Returns whether object P may get material MATERIAL: a translucent medium
 * needs a map that was baked for the object, unless P is a shadow catcher. */
static int has_translucency_map(const struct glint_scene_model *m,
                                const struct glint_placed *p, uint32_t material)
{
    for (uint32_t k = 0; k < m->header->n_stones; k++)
        if (m->stone[k].material == material && !p->is_catcher)
            return p->skin >= 0 && m->skin[p->skin].stone == k;
    return 1;
}

enum glint_status glint_scene_set_material(struct glint_scene *scene,
                                           int object, int material)
{
    const struct glint_scene_header *h = scene->model.header;
    const struct glint_scene_material *m;
    struct glint_placed *p;

    if (object < 0 || object >= (int)h->n_objects || material < 0 ||
        material >= (int)h->n_materials)
        return GLINT_E_ARGUMENT;
    m = &scene->model.material[material];
    p = &scene->placed[object];
    if (!has_translucency_map(&scene->model, p, (uint32_t)material))
        return GLINT_E_ARGUMENT;
    p->material = (uint32_t)material;
    p->is_split = !p->is_catcher && (m->reflect_q15 || m->pass_q15);
    scene->has_split |= p->is_split;
    return GLINT_OK;
}

enum glint_status glint_scene_set_radius(struct glint_scene *scene, int object,
                                         int32_t radius)
{
    struct glint_placed *p;

    if (object < 0 || object >= (int)scene->model.header->n_objects)
        return GLINT_E_ARGUMENT;
    p = &scene->placed[object];
    if (p->object->kind != GLINT_OBJECT_SPHERE || radius < 1 ||
        radius > GLINT_SCENE_SPAN / 2 ||
        !glint_scene_is_vector_within(p->at, 3, GLINT_SCENE_SPAN - 1 - radius))
        return GLINT_E_ARGUMENT;
    p->radius = p->reach = radius;
    glint_scene_invalidate_shadows(scene);
    return GLINT_OK;
}

/* ------------------------------------------------------------- environments */

/* Marks the lighting that is cached over several frames as outdated. */
static enum glint_status invalidate_cached_light(struct glint_scene *scene)
{
    if (scene->stones)
        scene->cfg.parts.stones->relight(scene);
    glint_scene_invalidate_shadows(scene);
    return GLINT_OK;
}

enum glint_status glint_scene_set_environment(struct glint_scene *scene,
                                              int environment)
{
    if (environment < 0 ||
        environment >= (int)scene->model.header->n_environments)
        return GLINT_E_ARGUMENT;
    scene->cfg.parts.wards->show(scene, (uint32_t)environment);
    return invalidate_cached_light(scene);
}

enum glint_status glint_scene_scale_environment(struct glint_scene *scene,
                                                struct glint_real scale)
{
    if (!scene->model.header->n_environments || scale.mantissa == 0 ||
        !glint_scene_is_valid_intensity(&scale))
        return GLINT_E_ARGUMENT;
    scene->cfg.parts.wards->scale(scene, scale);
    return invalidate_cached_light(scene);
}

enum glint_status glint_scene_turn_environment(struct glint_scene *scene,
                                               const int32_t turn_q30[2])
{
    if (!scene->model.header->n_environments ||
        !glint_scene_is_unit_vector(turn_q30, 2))
        return GLINT_E_ARGUMENT;
    scene->cfg.parts.wards->turn(scene, turn_q30);
    return invalidate_cached_light(scene);
}
