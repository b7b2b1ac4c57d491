/* SPDX-License-Identifier: MIT
 *
 * Checks a baked environment once, so that lookups need not. */
#include "glint/scene/environment.h"

#include "base/blob.h"
#include "base/compiler.h"
#include "scene/valid.h"

/* The program reads the file in place: these structs are the file's layout. */
STATIC_ASSERT(sizeof(struct glint_environment_level) == 16);
STATIC_ASSERT(sizeof(struct glint_environment_light) == 40);
STATIC_ASSERT(sizeof(struct glint_environment_header) == 124);
STATIC_ASSERT(sizeof(struct glint_real) == 8);
STATIC_ASSERT((int)GLINT_TEXELS_LEVELS == (int)GLINT_ENVIRONMENT_MAX_LEVELS);

/* checks that the members that all baked files share have the same offsets */
GLINT_BLOB_HEADER(struct glint_environment_header, variant);

static const char outside[] =
    "damaged environment: a table lies outside the file";

static const char *const fault_text[GLINT_BLOB_FAULTS] =
    GLINT_BLOB_FAULT_TEXT("environment", "environments", "baked");

uint32_t glint_environment_side_log2(uint32_t levels, uint32_t side_log2,
                                     uint32_t level)
{
    if (levels == GLINT_ENVIRONMENT_MIP)
        return side_log2 - level;
    if (level == 0)
        return side_log2;
    if (side_log2 + 1 - level < GLINT_ENVIRONMENT_COARSEST_LOG2)
        return GLINT_ENVIRONMENT_COARSEST_LOG2;
    return side_log2 + 1 - level;
}

static const char *
check_environment_header(const struct glint_environment_header *h)
{
    if (h->variant > GLINT_ENVIRONMENT_MIP || h->code != GLINT_ENVIRONMENT_9E5)
        return "the environment's mip levels or pixel codes are unknown: bake "
               "it again";
    if (h->side_log2 < GLINT_ENVIRONMENT_LEAST_LOG2 ||
        h->side_log2 > GLINT_ENVIRONMENT_MOST_LOG2 ||
        h->n_levels != h->side_log2 + 1 ||
        h->n_lights > GLINT_ENVIRONMENT_MAX_LIGHTS)
        return "damaged environment: its size, or its number of mip levels or "
               "lights is out of range";
    if (h->unit_log2 < -160 || h->unit_log2 > 100)
        return "damaged environment: the scale of its pixel codes is out of "
               "range";
    return NULL;
}

static const char *check_mip_level(struct glint_environment *e,
                                   struct glint_blob *blob, uint32_t k)
{
    const struct glint_environment_header *h = e->header;
    const struct glint_environment_level *l = &e->level[k];

    if (l->side_log2 !=
            glint_environment_side_log2(h->variant, h->side_log2, k) ||
        l->zero[0] || l->zero[1])
        return "damaged environment: the size of a mip level is wrong";
    e->texel[k] = glint_blob_find_section(blob, l->texel_at,
                                          UINT64_C(1) << (2 * l->side_log2), 4);
    return e->texel[k] ? NULL : outside;
}

static void set_level_address(struct glint_environment *e, uint32_t k)
{
    const struct glint_environment_level *l = &e->level[k];

    e->texels.level[k] =
        (struct glint_texels_level){(int32_t)l->side_log2, l->texel_at / 4};
    e->texels.level[k + 1] = e->texels.level[k];
}

static const char *
check_bright_light(const struct glint_environment_light *light)
{
    if (!glint_scene_is_unit_vector(light->toward_q30, 3))
        return "damaged environment: a light's direction is not a unit vector";
    if (light->radius_q30 < 0 || light->radius_q30 > 1 << 29)
        return "damaged environment: a light is too large";
    for (int c = 0; c < 3; c++)
        if (!glint_scene_is_valid_intensity(&light->rgb[c]))
            return "damaged environment: a light's intensity is negative or "
                   "not normalised";
    return NULL;
}

static const char *check_environment_contents(struct glint_environment *e,
                                              struct glint_blob *blob)
{
    const struct glint_environment_header *h = e->header;
    const char *wrong = fault_text[glint_blob_check_name(blob)];

    if (!wrong)
        wrong = check_environment_header(h);
    if (wrong)
        return wrong;
    e->level = glint_blob_find_section(blob, h->level_at, h->n_levels,
                                       sizeof *e->level);
    e->irradiance = glint_blob_find_section(
        blob, h->irradiance_at, 1 << (2 * GLINT_ENVIRONMENT_IRRADIANCE_LOG2),
        4);
    e->light = glint_blob_find_section(blob, h->light_at, h->n_lights,
                                       sizeof *e->light);
    if (!e->level || !e->irradiance || !e->light)
        return outside;
    e->texels = (struct glint_texels){.code = (const uint32_t *)(const void *)h,
                                      .last = (int32_t)h->n_levels - 1};
    for (uint32_t k = 0; !wrong && k < h->n_levels; k++) {
        wrong = check_mip_level(e, blob, k);
        if (!wrong)
            set_level_address(e, k);
    }
    for (uint32_t k = 0; !wrong && k < h->n_lights; k++)
        wrong = check_bright_light(&e->light[k]);
    return wrong;
}

enum glint_status glint_environment_open(struct glint_environment *environment,
                                         const void *data, size_t bytes,
                                         const char **reason)
{
    static const struct glint_blob_kind kind = {
        GLINT_ENVIRONMENT_MAGIC, GLINT_ENVIRONMENT_VERSION,
        sizeof(struct glint_environment_header)};
    struct glint_environment e = {.header = data};
    struct glint_blob blob;
    const char *wrong = fault_text[glint_blob_open(&blob, &kind, data, bytes)];

    if (!wrong)
        wrong = check_environment_contents(&e, &blob);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_FORMAT;
    }
    *environment = e;
    return GLINT_OK;
}
