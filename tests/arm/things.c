/* SPDX-License-Identifier: MIT
 *
 * things SET N SCENE... - draws N images of baked scenes and prints a hash of
 * all output, which is the same on every CPU, compiler target and set of
 * kernels. SET is c, sse41, avx2, neon or best.
 *
 *     240 pictures, 236 with objects, 1b3f...
 *
 * Sizes, tiles, formats, samples, poses and lights are random, by integers
 * only, as are the order of jobs and their workers. Lights and their coverage
 * are added to the hash. With GLINT_EACH set, the hash after each image is
 * printed as well. Exit code 3: a scene is invalid.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arm/kinds.h"
#include "glint/scene/scene.h"
#include "posix/input.h"
#include "support/rng.h"
#include "support/shuffle.h"

enum { MAX_SCENES = 16 };

static struct glint_scene_model model[MAX_SCENES];
static int n_models;
static unsigned sets;
static uint32_t seed = 2026;

/* Returns a random number of 0 .. BELOW - 1. A statement may call it only
 * once, as C does not define the order in which arguments are evaluated. */
static int random_number(int below)
{
    return (int)(rng_xorshift(&seed) % (uint32_t)below);
}

static struct glint_scene_config make_random_config(struct shuffle *shuffle)
{
    static const int points[3] = {1, 4, 16}, samples[4] = {1, 4, 8, 16};
    struct glint_scene_config c;
    const int width = 1 + random_number(200), height = 1 + random_number(150);

    glint_scene_defaults(&c, width, height);
    init_shuffled_workers(shuffle, 1 + (int)(seed % 4), seed);
    c.workers = &shuffle->workers;
    c.sets = sets;
    c.tile_log2 = 3 + random_number(4);
    c.edge_samples = samples[random_number(4)];
    c.half_shading = random_number(2);
    c.shadow_points = points[random_number(3)];
    c.focal_q16 = (int64_t)(1 + random_number(400)) << 16;
    c.max_refs = 200000;
    c.parts = (struct glint_scene_parts){
        &glint_scene_meshes, &glint_scene_textures, &glint_scene_bounces,
        &glint_scene_wards,  &glint_scene_stones,   NULL,
        &glint_scene_motions};
    return c;
}

/* Moves an object and the camera, or neither. Positions out of range are
 * rejected, on every machine alike. */
static void move_objects(struct glint_scene *scene,
                         const struct glint_scene_model *m)
{
    static const int32_t turn_q30[3][4] = {{1 << 30, 0, 0, 0},
                                           {858993459, 0, 644245094, 0},
                                           {0, 644245094, 0, 858993459}};
    static const int32_t axis_q30[2][3][3] = {{{1 << 30, 0, 0},
                                               {0, 858993459, -644245094},
                                               {0, 644245094, 858993459}},
                                              {{858993459, 0, -644245094},
                                               {0, 1 << 30, 0},
                                               {644245094, 0, 858993459}}};
    const int n = (int)m->header->n_objects, which = n ? random_number(n) : 0;
    int32_t at[3];
    enum glint_status status = GLINT_OK;

    if (n && random_number(2)) {
        for (int k = 0; k < 3; k++)
            at[k] = m->object[which].at[k] / 4 * random_number(8);
        status =
            glint_scene_set_pose(scene, which, at, turn_q30[random_number(3)]);
    }
    if (status == GLINT_OK && random_number(3) == 0) {
        for (int k = 0; k < 3; k++)
            at[k] = m->header->camera.at[k] / 4 * (1 + random_number(5));
        status = glint_scene_set_camera(scene, at, axis_q30[random_number(2)]);
    }
    if (status == GLINT_OK && n && random_number(4) == 0)
        glint_scene_show(scene, which, 0);
}

static uint64_t hash_scene_lights(uint64_t h, struct glint_scene *scene,
                                  int width)
{
    struct glint_scene_lamp lamp[GLINT_SCENE_MAX_LIGHTS];
    const int n = glint_scene_lights(scene, lamp);

    h = kinds_hash_number(h, n);
    for (int i = 0; i < n; i++) {
        h = kinds_hash_number(h, lamp[i].x_q8);
        h = kinds_hash_number(h, lamp[i].y_q8);
        h = kinds_hash_number(h, lamp[i].share);
        h = kinds_hash_number(
            h, glint_scene_cover(scene, lamp[i].x_q8, lamp[i].y_q8, 5 << 8));
    }
    return kinds_hash_number(
        h, glint_scene_cover(scene, width << 7, width << 6, width << 5));
}

/* Draws a random image and adds it to the hash *H. Returns whether objects
 * changed the image. */
static int draw_and_hash_image(uint64_t *h)
{
    struct shuffle shuffle;
    const struct glint_scene_config c = make_random_config(&shuffle);
    const struct glint_scene_model *const m = &model[random_number(n_models)];
    struct glint_image image = {
        .format = (enum glint_pixel_format)random_number(GLINT_RGB565 + 1),
        .width = c.width,
        .height = c.height};
    const size_t bytes = glint_image_bytes(image.format, c.width, c.height);
    const size_t room = glint_scene_bytes(&c, m);
    struct glint_scene_stats stats;
    struct glint_scene *scene;
    uint8_t *pixels = malloc(bytes);
    uint64_t before, after;
    void *mem;

    /* 0: the configuration is out of range or lacks a module that the model
     * needs, on every machine alike */
    if (!room) {
        free(pixels);
        return 0;
    }
    if (!pixels || posix_memalign(&mem, 64, room) != 0 ||
        glint_scene_init(&scene, &c, m, mem, room) != GLINT_OK)
        exit(1);
    kinds_fill_image(&image, pixels, bytes, &seed);
    before = hash_bytes(HASH_START, pixels, bytes);
    move_objects(scene, m);
    glint_scene_begin(scene, &stats);
    glint_scene_draw(scene, &image);
    after = hash_bytes(HASH_START, pixels, bytes);
    *h = hash_scene_lights(kinds_hash_number(*h, (int64_t)(after >> 1)), scene,
                           c.width);
    *h = kinds_hash_number(*h, stats.need_refs);
    free(mem);
    free(pixels);
    return before != after;
}

static void open_scene(const char *path)
{
    struct glint_error error = {""};
    const char *reason = "";
    uint8_t *data;
    size_t bytes;

    if (glint_input_read_whole_file(&data, &bytes, path, 1 << 28, &error) !=
            GLINT_OK ||
        glint_scene_open(&model[n_models], data, bytes, &reason) != GLINT_OK) {
        fprintf(stderr, "things: %s: %s%s\n", path, error.text, reason);
        exit(3);
    }
    n_models++;
}

int main(int argc, char **argv)
{
    const int n = argc > 3 ? atoi(argv[2]) : 0;
    uint64_t h = HASH_START;
    int changed = 0;

    if (n < 1 || argc - 3 > MAX_SCENES) {
        fputs("things SET N SCENE...\n", stderr);
        return 2;
    }
    sets = kinds_parse_sets("things", argv[1]);
    for (int i = 3; i < argc; i++)
        open_scene(argv[i]);
    for (int i = 0; i < n; i++) {
        changed += draw_and_hash_image(&h);
        /* With the hash of every image, the first different line identifies the
         * image. */
        if (getenv("GLINT_EACH"))
            printf("%d %08lx\n", i, (unsigned long)(h >> 32));
    }
    printf("%d pictures, %d with objects, %08lx%08lx\n", n, changed,
           (unsigned long)(h >> 32), (unsigned long)(h & 0xffffffff));
    return 0;
}
