/* SPDX-License-Identifier: MIT
 *
 * embed_scene LENS SCENE IN.ppm >OUT.ppm - draws a baked scene over a picture,
 * then the flare of the picture's lamps and the scene's lights, like glint
 * overlay --scene --stop polygon:8. LENS is a baked model.
 */
#include "glint/engine.h"
#include "glint/kernels.h"
#include "glint/scene/scene.h"
#include "ppm.h"

enum { LIMIT = 1 << 24, LAMPS = 64 };

static size_t read_whole_file(const char *path, void *data)
{
    FILE *file = fopen(path, "rb");
    const size_t n = file ? fread(data, 1, LIMIT, file) : 0;

    if (file)
        fclose(file);
    return n;
}

static struct glint_scene *make_scene(const struct glint_engine *engine,
                                      const struct glint_scene_model *model,
                                      const struct glint_image *image,
                                      void **mem)
{
    struct glint_scene *scene = NULL;
    struct glint_scene_config cfg;

    glint_scene_defaults(&cfg, image->width, image->height);
    cfg.parts.meshes = &glint_scene_meshes;
    cfg.parts.textures = &glint_scene_textures;
    cfg.parts.bounces = &glint_scene_bounces;
    cfg.parts.wards = &glint_scene_wards;
    cfg.parts.stones = &glint_scene_stones;
    cfg.sets = glint_sets_here();
    cfg.focal_q16 = (int64_t)(65536 * glint_engine_focal_px(engine));
    cfg.shadow_points = 16;
    if (posix_memalign(mem, 64, glint_scene_bytes(&cfg, model)) == 0)
        glint_scene_init(&scene, &cfg, model, *mem,
                         glint_scene_bytes(&cfg, model));
    return scene;
}

int main(int argc, char **argv)
{
    static struct glint_engine_lamp lamp[LAMPS + GLINT_SCENE_MAX_LIGHTS];
    static uint64_t baked[LIMIT / 8], objects[LIMIT / 8];
    struct glint_engine_config cfg;
    struct glint_engine_report report;
    struct glint_error error = {"cannot open a file, or out of memory"};
    struct glint_engine *engine = NULL;
    struct glint_scene_model model;
    struct glint_scene_stats stats;
    struct glint_scene *scene = NULL;
    struct glint_image image = {.plane = {NULL}};
    struct glint_lens lens;
    const char *reason;
    int n, hidden, bad = 1;
    void *mem = NULL;

    if (argc == 4 && ppm_read(argv[3], &image) == 0 &&
        glint_lens_open(&lens, baked, read_whole_file(argv[1], baked),
                        &reason) == GLINT_OK &&
        glint_scene_open(&model, objects, read_whole_file(argv[2], objects),
                         &reason) == GLINT_OK) {
        glint_engine_defaults(&cfg, image.width, image.height);
        cfg.model = &lens;
        cfg.search.more_lamps = GLINT_SCENE_MAX_LIGHTS;
        if (glint_engine_create(&engine, &cfg, &error) == GLINT_OK)
            scene = make_scene(engine, &model, &image, &mem);
        if (scene) {
            n = glint_engine_find(engine, &image, 0, lamp, LAMPS);
            glint_scene_begin(scene, &stats);
            glint_scene_draw(scene, &image);
            n = glint_engine_add_scene(engine, scene, lamp, n, &hidden);
            glint_engine_apply_shares(lamp, n, 1);
            bad = !!glint_engine_draw(engine, lamp, n, &image, &report);
        }
    }
    glint_engine_destroy(engine);
    if (bad || ppm_write(&image) != 0)
        fprintf(stderr, "embed_scene: %s\n", error.text);
    free(image.plane[0]);
    free(mem);
    return bad;
}
