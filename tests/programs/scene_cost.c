/* SPDX-License-Identifier: MIT
 *
 * scene_cost BAKED [FRAMES [EDGE_SAMPLES [SHADOW_POINTS [HALF]]]] - draws a
 * baked scene onto a grey picture of 640x360, YUYV, by one thread, for
 * tools/report/scene-cost-table, which counts instructions. Each frame is
 * prepared again. Prints how many pixels are covered, in thousandths of the
 * picture, what the scene's memory takes, and a hash of the last picture.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/kernels.h"
#include "glint/scene/scene.h"

enum { LIMIT = 1 << 24 };

/* Instructions of a frame are those from here to scene_cost_idle(). */
void scene_cost_frame(struct glint_scene *scene,
                      const struct glint_image *image);
void scene_cost_idle(const struct glint_image *image, int fills);

void scene_cost_frame(struct glint_scene *scene,
                      const struct glint_image *image)
{
    struct glint_scene_stats stats;

    glint_scene_begin(scene, &stats);
    glint_scene_draw(scene, image);
}

void scene_cost_idle(const struct glint_image *image, int fills)
{
    if (fills)
        memset(image->plane[0], 100,
               glint_image_bytes(image->format, image->width, image->height));
}

static uint64_t hash_of(const struct glint_image *image)
{
    const size_t n =
        glint_image_bytes(image->format, image->width, image->height);
    uint64_t hash = UINT64_C(14695981039346656037);

    for (size_t i = 0; i < n; i++)
        hash = (hash ^ image->plane[0][i]) * UINT64_C(1099511628211);
    return hash;
}

static int draw(const struct glint_scene_model *model, int argc, char **argv)
{
    static const struct glint_scene_parts parts = {
        &glint_scene_meshes, &glint_scene_textures, &glint_scene_bounces,
        &glint_scene_wards,  &glint_scene_stones,   NULL,
        &glint_scene_motions};
    struct glint_image image = {
        .format = GLINT_YUYV, .width = 640, .height = 360};
    /* Not inlined: counters look for their names. */
    void (*volatile idle)(const struct glint_image *, int) = scene_cost_idle;
    void (*volatile frame)(struct glint_scene *, const struct glint_image *) =
        scene_cost_frame;
    const int frames = argc > 2 ? atoi(argv[2]) : 1;
    struct glint_scene_config cfg;
    struct glint_scene *scene;
    void *mem = NULL, *px;
    size_t bytes;

    glint_scene_defaults(&cfg, image.width, image.height);
    cfg.parts = parts;
    cfg.sets = glint_sets_here();
    if (argc > 3)
        cfg.edge_samples = atoi(argv[3]);
    if (argc > 4)
        cfg.shadow_points = atoi(argv[4]);
    if (argc > 5)
        cfg.half_shading = atoi(argv[5]);
    bytes = glint_scene_bytes(&cfg, model);
    px = malloc(glint_image_bytes(image.format, image.width, image.height));
    if (!px || posix_memalign(&mem, 64, bytes) != 0 ||
        glint_scene_init(&scene, &cfg, model, mem, bytes) != GLINT_OK) {
        fprintf(stderr, "scene_cost: no memory, or the camera is no pinhole\n");
        free(px);
        free(mem);
        return 1;
    }
    glint_image_place(&image, px);
    for (int i = 0; i < frames; i++) {
        idle(&image, 1);
        frame(scene, &image);
    }
    idle(&image, 0);
    printf("%d thousandths, %zu bytes, %016llx\n",
           glint_scene_cover(scene, 128 * image.width, 128 * image.height,
                             1 << 20) *
               1000 / 256,
           bytes, (unsigned long long)hash_of(&image));
    free(px);
    free(mem);
    return 0;
}

int main(int argc, char **argv)
{
    FILE *file = argc > 1 ? fopen(argv[1], "rb") : NULL;
    struct glint_scene_model model;
    const char *reason = "it cannot be read";
    void *data = malloc(LIMIT);
    int code = 1;

    if (file && data &&
        glint_scene_open(&model, data, fread(data, 1, LIMIT, file), &reason) ==
            GLINT_OK)
        code = draw(&model, argc, argv);
    else
        fprintf(stderr, "scene_cost: %s\n", reason);
    if (file)
        fclose(file);
    free(data);
    return code;
}
