/* SPDX-License-Identifier: MIT
 *
 * Opens baked scenes and prints their contents and sizes.
 */
#include "scenes/baked_scene.h"

#include <math.h>
#include <stdlib.h>

#include "glint/scene/translucent.h"
#include "posix/input.h"

#define MAX_SCENE_BYTES ((size_t)1 << 30)

bool baked_scene_is_file(const char *argument)
{
    return tool_is_scene_text(argument) ||
           tool_has_magic(argument, GLINT_SCENE_MAGIC);
}

int baked_scene_open(const struct tool *tool, const char *path,
                     struct baked_scene *scene)
{
    struct glint_error error = {""};
    enum glint_status status;
    const char *reason = "";
    uint8_t *data = NULL;
    int code = EXIT_OK;

    *scene = (struct baked_scene){.data = NULL};
    if (tool_is_scene_text(path)) {
        code =
            tool_bake_scene(tool, path, &data, &scene->bytes, &scene->report);
        if (code != EXIT_OK)
            return code;
        scene->data = data;
        scene->is_text = true;
        status = GLINT_OK;
    } else {
        code = tool_check_scene_not_overwritten(tool, path);
        if (code != EXIT_OK)
            return code;
        status = glint_input_read_whole_file(&data, &scene->bytes, path,
                                             MAX_SCENE_BYTES, &error);
        /* malloc() has aligned the data, as baked scenes require */
        scene->data = data;
    }
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (glint_scene_open(&scene->model, scene->data, scene->bytes, &reason) ==
        GLINT_OK)
        return EXIT_OK;
    snprintf(error.text, sizeof error.text, "%.180s: %.70s", path, reason);
    tool_fail(tool, GLINT_E_LENS, error.text);
    baked_scene_close(scene);
    return EXIT_LENS;
}

void baked_scene_close(struct baked_scene *scene)
{
    free(scene->data);
    *scene = (struct baked_scene){.data = NULL};
}

/* Sections of a baked scene whose bytes are counted. */
enum {
    HEADER,
    LIGHT,
    TEXTURE,
    MATERIAL,
    ENVIRONMENT,
    STONE,
    OBJECT,
    MESH, /* sum of the sections below, with the headers of meshes */
    VERTICES,
    NORMALS,
    UV,
    TRIANGLES,
    GRID,
    N_PARTS
};

static const char *const part_names[N_PARTS] = {
    "header", "light",     "texture", "material", "environment",
    "stone",  "object",    "mesh",    "vertices", "normals",
    "uv",     "triangles", "grid"};

struct scene_counts {
    size_t bytes[N_PARTS];
    int spheres, planes, catchers, meshes;
    unsigned vertices, triangles, cells, refs;
};

static size_t count_texture_bytes(const struct glint_scene_texture *t)
{
    uint32_t w = t->width_log2, h = t->height_log2;
    size_t texels = 1;

    for (; w || h; w -= w > 0, h -= h > 0)
        texels += (size_t)1 << (w + h);
    return (3 * texels + 3) / 4 * 4 + sizeof *t;
}

static void count_mesh_bytes(const struct glint_scene_model *model,
                             const struct glint_scene_mesh *m,
                             struct scene_counts *n)
{
    size_t *const b = n->bytes;
    const unsigned cells = m->cells[0] * m->cells[1] * m->cells[2];
    const uint32_t *start =
        (const void *)((const unsigned char *)model->header + m->start_at);

    n->vertices += m->n_vertices;
    n->triangles += m->n_triangles;
    n->cells += cells;
    n->refs += start[cells];
    b[VERTICES] += 12 * (size_t)m->n_vertices;
    b[NORMALS] += m->normal_at ? 12 * (size_t)m->n_vertices : 0;
    b[UV] += m->uv_at ? 8 * (size_t)m->n_vertices : 0;
    b[TRIANGLES] += 16 * (size_t)m->n_triangles;
    b[GRID] += 4 * ((size_t)cells + 1 + start[cells]);
    b[MESH] += sizeof *m;
}

/* Returns the bytes of all translucent media, and of the light maps of objects
 * made of them. */
static size_t count_medium_bytes(const struct glint_scene_model *model)
{
    const struct glint_scene_header *h = model->header;
    size_t bytes =
        h->n_stones * sizeof *model->stone + h->n_skins * sizeof *model->skin;

    for (uint32_t i = 0; i < h->n_stones; i++)
        bytes += model->stone[i].file_bytes;
    for (uint32_t i = 0; i < h->n_skins; i++) {
        const struct glint_scene_stone *stone =
            &model->stone[model->skin[i].stone];
        const struct glint_translucent_header *t =
            (const void *)((const unsigned char *)h + stone->file_at);
        const size_t side = (size_t)1 << t->side_log2;

        bytes +=
            model->object[model->skin[i].object].kind == GLINT_OBJECT_SPHERE
                ? 3 * side * 8
                : side * side * 4;
    }
    return bytes;
}

static size_t count_environment_bytes(const struct glint_scene_model *model)
{
    size_t bytes = 0;

    for (uint32_t i = 0; i < model->header->n_environments; i++)
        bytes += sizeof *model->environment + model->environment[i].file_bytes;
    return bytes;
}

static struct scene_counts
count_scene_contents(const struct glint_scene_model *model)
{
    const struct glint_scene_header *h = model->header;
    struct scene_counts n = {
        .bytes = {[HEADER] = sizeof *h,
                  [LIGHT] = h->n_lights * sizeof *model->light,
                  [MATERIAL] = h->n_materials * sizeof *model->material +
                               h->n_wards * sizeof *model->ward,
                  [ENVIRONMENT] = count_environment_bytes(model),
                  [STONE] = count_medium_bytes(model),
                  [OBJECT] = h->n_objects * sizeof *model->object}};

    for (uint32_t i = 0; i < h->n_textures; i++)
        n.bytes[TEXTURE] += count_texture_bytes(&model->texture[i]);
    for (uint32_t i = 0; i < h->n_meshes; i++)
        count_mesh_bytes(model, &model->mesh[i], &n);
    for (int k = MESH + 1; k < N_PARTS; k++)
        n.bytes[MESH] += n.bytes[k];
    for (uint32_t i = 0; i < h->n_objects; i++) {
        n.spheres += model->object[i].kind == GLINT_OBJECT_SPHERE;
        n.planes += model->object[i].kind == GLINT_OBJECT_PLANE;
        n.meshes += model->object[i].kind == GLINT_OBJECT_MESH;
        n.catchers += model->object[i].catcher_q15 > 0;
    }
    return n;
}

void baked_scene_write_byte_counts(struct json_writer *json,
                                   const struct glint_scene_model *model)
{
    const struct scene_counts n = count_scene_contents(model);

    json_write(json, "bytes: {");
    for (int k = 0; k <= MESH; k++)
        json_write(json, "%s: %zu", part_names[k], n.bytes[k]);
}

static void print_scene_json(const struct baked_scene *scene,
                             const struct scene_counts *n)
{
    const struct glint_scene_header *h = scene->model.header;
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{name: %s, scene: {objects: %u, spheres: %d, planes: %d, "
               "catchers: %d, meshes: %d, lights: %u, environments: %u, "
               "materials: %u, textures: %u, vertices: %u, triangles: %u, "
               "cells: %u, refs: %u, step: %.9g",
               h->name, h->n_objects, n->spheres, n->planes, n->catchers,
               n->meshes, h->n_lights, h->n_environments, h->n_materials,
               h->n_textures, n->vertices, n->triangles, n->cells, n->refs,
               ldexp(1, -h->unit_log2));
    if (scene->is_text)
        json_write(&json, "reach: %.9g, flat: %d", scene->report.reach,
                   scene->report.flat);
    baked_scene_write_byte_counts(&json, &scene->model);
    json_write(&json, "all: %zu}}}\n", scene->bytes);
}

static void print_scene_camera(const struct glint_scene_camera *c)
{
    if (c->kind == GLINT_CAMERA_FIELD)
        printf("camera       %.4g degrees across the picture\n",
               360 / GLINT_PI * atan(ldexp(c->tan_x_q24, -24)));
    else
        printf("camera       %s\n", c->kind == GLINT_CAMERA_LENS
                                        ? "the field of the flare's lens"
                                        : "16 x 9 at a distance of 10");
}

static void print_scene_text(const struct baked_scene *scene,
                             const struct scene_counts *n)
{
    const struct glint_scene_header *h = scene->model.header;

    printf("%s, a %sscene\n\n", h->name, scene->is_text ? "" : "baked ");
    print_scene_camera(&h->camera);
    printf("objects      %u: spheres %d, planes %d (catchers %d), meshes %d\n",
           h->n_objects, n->spheres, n->planes, n->catchers, n->meshes);
    printf("lights       %u%s\n", h->n_lights,
           h->shadow ? ", with shadows" : "");
    for (uint32_t i = 0; i < h->n_environments; i++)
        printf("%s %s\n", i ? "            " : "environment ",
               scene->model.environment[i].name);
    printf("materials    %u, textures %u\n", h->n_materials, h->n_textures);
    printf("triangles    %u on %u vertices, %u grid cells with %u entries\n",
           n->triangles, n->vertices, n->cells, n->refs);
    if (scene->report.flat)
        printf("left out     %d triangles without area\n", scene->report.flat);
    printf("step         %.3g units; coordinates are rounded to it, at most "
           "half a step off\n",
           ldexp(1, -h->unit_log2));
    if (scene->is_text)
        printf(
            "extent       %.4g units from the origin; poses may reach %.4g\n",
            scene->report.reach, ldexp(1, 28 - h->unit_log2));
    printf("bytes        %zu\n", scene->bytes);
    for (int k = 0; k < N_PARTS; k++)
        if (n->bytes[k])
            printf("  %s%-*s %8zu\n", k > MESH ? "  " : "", k > MESH ? 10 : 12,
                   part_names[k], n->bytes[k]);
}

void baked_scene_print_contents(const struct tool *tool,
                                const struct baked_scene *scene)
{
    const struct scene_counts counts = count_scene_contents(&scene->model);

    (tool->json ? print_scene_json : print_scene_text)(scene, &counts);
}
