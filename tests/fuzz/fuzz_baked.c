/* SPDX-License-Identifier: MIT
 *
 * Opens random bytes as a baked scene, with valid magic, version, size and
 * checksum so that the other checks are reached. An accepted scene must be
 * drawable onto a small image: from its camera or, depending on its checksum,
 * with camera or objects moved. Sanitizers and range traps detect errors.
 *
 *     make fuzz FUZZ=baked SECONDS=120
 */
#include "fuzz/fuzz.h"
#include "glint/scene/scene.h"

enum { SIDE = 10, ROOM = 1 << 22, ONE_Q30 = 1 << 30 };

/* Draws the scene in its present state. The visible fraction of each light
 * must be 0 .. 16 sixteenths. */
static void draw_scene(struct glint_scene *scene,
                       enum glint_pixel_format format)
{
    static uint8_t pixels[12 * SIDE * SIDE];
    struct glint_image image = glint_image_over(pixels, format, SIDE, SIDE);
    struct glint_scene_lamp lamps[GLINT_SCENE_MAX_LIGHTS];
    struct glint_scene_stats stats;
    int n;

    glint_scene_begin(scene, &stats);
    glint_scene_draw(scene, &image);
    n = glint_scene_lights(scene, lamps);
    require(n >= 0 && n <= GLINT_SCENE_MAX_LIGHTS);
    for (int i = 0; i < n; i++)
        require(lamps[i].share >= 0 && lamps[i].share <= 16);
    n = glint_scene_cover(scene, SIDE << 7, SIDE << 7, 5 << 8);
    require(n >= 0 && n <= 256);
}

/* Draws the scene unchanged, or with the camera at the first object, or with
 * that object rotated or hidden. */
static void draw_scene_variant(struct glint_scene *scene,
                               const struct glint_scene_model *model, int which)
{
    static const int32_t axis_q30[3][3] = {
        {0, 0, -ONE_Q30}, {0, ONE_Q30, 0}, {ONE_Q30, 0, 0}};
    static const int32_t turn_q30[4] = {0, 644245094, 0, 858993459};
    static const enum glint_pixel_format format[4] = {
        GLINT_RGB24, GLINT_RGB24, GLINT_YUYV, GLINT_LINEAR_Q20};
    const int is_empty = model->header->n_objects < 1;

    if (!is_empty && which == 1 &&
        glint_scene_set_camera(scene, model->object->at, axis_q30) != GLINT_OK)
        return;
    if (!is_empty && which == 2 &&
        glint_scene_set_pose(scene, 0, model->header->camera.at, turn_q30) !=
            GLINT_OK)
        return;
    if (!is_empty && which == 3)
        glint_scene_show(scene, 0, 0);
    draw_scene(scene, format[which]);
}

static void draw_scene_model(const struct glint_scene_model *model, int which)
{
    static uint8_t mem[ROOM] __attribute__((aligned(64)));
    struct glint_scene_config cfg;
    struct glint_scene *scene;
    size_t bytes;

    glint_scene_defaults(&cfg, SIDE, SIDE);
    cfg.tile_log2 = 3;
    cfg.max_refs = 4000;
    cfg.focal_q16 = 20 << 16;
    cfg.shadow_points = model->header->shadow ? 4 : 1;
    cfg.parts = (struct glint_scene_parts){
        &glint_scene_meshes, &glint_scene_textures, &glint_scene_bounces,
        &glint_scene_wards,  &glint_scene_stones,   NULL,
        &glint_scene_motions};
    bytes = glint_scene_bytes(&cfg, model);
    if (!bytes || bytes > sizeof mem)
        return;
    if (glint_scene_init(&scene, &cfg, model, mem, bytes) != GLINT_OK)
        return;
    if (model->header->n_environments)
        require(glint_scene_set_environment(
                    scene, (int)model->header->n_environments - 1) == GLINT_OK);
    draw_scene_variant(scene, model, which);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char *copy =
        fuzz_blob(data, size, GLINT_SCENE_MAGIC, GLINT_SCENE_VERSION);
    struct glint_scene_model model;
    const char *reason = NULL;

    if (glint_scene_open(&model, copy, size, &reason) != GLINT_OK)
        require(reason && *reason);
    else if (model.header->n_objects <= 16)
        draw_scene_model(&model,
                         (int)(glint_blob_compute_crc32(copy, size) & 3));
    free(copy);
    return 0;
}
