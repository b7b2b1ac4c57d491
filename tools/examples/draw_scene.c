/* SPDX-License-Identifier: MIT
 *
 * draw_scene SCENE IN.ppm >OUT.ppm - draws balls and planes of a baked scene
 * onto a picture. The program contains no code for meshes, textures,
 * reflections, lenses or flares, because it does not refer to these modules. It
 * rejects scenes that need them.
 */
#include "glint/kernels.h"
#include "glint/scene/scene.h"
#include "ppm.h"

enum { LIMIT = 1 << 24 };

/* Reads at most BYTES bytes of PATH. Returns the number read, 0 on failure. */
static size_t read_file(const char *path, void *data, size_t bytes)
{
    FILE *file = fopen(path, "rb");
    size_t n = 0;

    if (file) {
        n = fread(data, 1, bytes, file);
        fclose(file);
    }
    return n;
}

static int print_error(const char *path, const char *cause)
{
    fprintf(stderr, "%s: %s\n", path, cause);
    return 5;
}

static int draw_scene(const char *path, const struct glint_scene_model *model,
                      const struct glint_image *image)
{
    struct glint_scene_config cfg;
    struct glint_scene_stats stats;
    struct glint_scene *scene;
    void *mem = NULL;
    size_t bytes;
    int code = 0;

    glint_scene_defaults(&cfg, image->width, image->height);
    cfg.sets = glint_sets_here();
    if (glint_scene_lacks(&cfg.parts, model))
        return print_error(path, glint_scene_lacks(&cfg.parts, model));
    bytes = glint_scene_bytes(&cfg, model);
    if (posix_memalign(&mem, 64, bytes) != 0)
        return print_error(path, "out of memory");
    if (glint_scene_init(&scene, &cfg, model, mem, bytes) == GLINT_OK) {
        glint_scene_begin(scene, &stats);
        glint_scene_draw(scene, image);
    } else {
        code = print_error(path, "the scene's camera needs a lens, or its "
                                 "field of view is too wide");
    }
    free(mem);
    return code;
}

int main(int argc, char **argv)
{
    struct glint_scene_model model;
    struct glint_image image;
    const char *reason = NULL;
    void *data;
    int code;

    if (argc != 3) {
        fprintf(stderr, "draw_scene SCENE IN.ppm >OUT.ppm\n");
        return 2;
    }
    data = malloc(LIMIT);
    if (!data)
        return print_error(argv[1], "out of memory");
    if (glint_scene_open(&model, data, read_file(argv[1], data, LIMIT),
                         &reason) != GLINT_OK) {
        free(data);
        return print_error(argv[1], reason);
    }
    code = ppm_read(argv[2], &image);
    if (code == 0) {
        code = draw_scene(argv[1], &model, &image);
        if (code == 0)
            code = ppm_write(&image);
        free(image.plane[0]);
    }
    free(data);
    return code;
}
