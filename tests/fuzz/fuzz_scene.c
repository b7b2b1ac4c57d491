/* SPDX-License-Identifier: MIT
 *
 * Parses random bytes as a scene text; the bytes after the first zero are the
 * text of any mesh that it names. An accepted scene must fulfil the conditions
 * of its header: numbers finite and in range, existing indices. After baking,
 * the run time must accept it.
 *
 *     make fuzz FUZZ=scene SECONDS=60
 */
#include <math.h>

#include "fuzz/fuzz.h"
#include "glint/scene/bake.h"
#include "glint/scene/model.h"

struct rest {
    const uint8_t *data;
    size_t size;
};

/* Returns, for any file name in the text, the bytes after the first zero as the
 * mesh or environment. */
static enum glint_status read_mesh_from_input(void *ctx, const char *name,
                                              uint8_t **data, size_t *bytes,
                                              struct glint_error *error)
{
    const struct rest *rest = ctx;

    (void)error;
    if (strchr(name, '!'))
        return GLINT_E_IO;
    /* The copy has exactly the size of the text, so that ASan detects
     * overreads. */
    *data = malloc(rest->size ? rest->size : 1);
    require(*data != NULL);
    memcpy(*data, rest->data, rest->size);
    *bytes = rest->size;
    return GLINT_OK;
}

static enum glint_status make_picture_for_texture(void *ctx, const char *name,
                                                  struct glint_image *image,
                                                  struct glint_error *error)
{
    const int side = (int)strlen(name) % 9 + 1;
    uint8_t *mem = calloc(3, (size_t)side * 3);

    (void)ctx;
    (void)error;
    require(mem != NULL);
    *image = glint_image_over(mem, GLINT_RGB24, side, 3);
    return GLINT_OK;
}

static void check_vector_range(const double x[3], double most)
{
    for (int i = 0; i < 3; i++)
        require(fabs(x[i]) <= most);
}

static void check_unit_vector(const double x[3])
{
    require(fabs(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1) < 1e-12);
}

static void check_scene_triangle(const struct glint_description *s,
                                 const struct glint_described_triangle *t)
{
    require(t->object >= 0 && t->object < s->n_objects);
    require(t->material >= 0 && t->material < s->n_materials);
    require(t->has_uv || s->material[t->material].texture < 0);
    for (int k = 0; k < 3; k++) {
        check_vector_range(t->place[k], GLINT_DESCRIPTION_REACH);
        if (t->has_normals)
            check_unit_vector(t->normal[k]);
    }
}

static void check_scene_object(const struct glint_description *s,
                               const struct glint_described_object *o)
{
    const double *q = o->turn;

    require(memchr(o->name, 0, sizeof o->name) != NULL);
    check_vector_range(o->at, GLINT_DESCRIPTION_REACH);
    require(fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) <
            1e-12);
    require(o->material < s->n_materials);
    require(o->first_triangle >= 0 && o->n_triangles >= 0 &&
            o->n_triangles <= s->n_triangles - o->first_triangle);
    if (o->kind == GLINT_DESCRIBED_PLANE) {
        check_unit_vector(o->normal);
        require((o->material >= 0) == (o->catcher <= 0));
    }
    if (o->kind == GLINT_DESCRIBED_SPHERE)
        require(o->radius >= GLINT_DESCRIPTION_LEAST && o->material >= 0);
}

static void check_baked_scene(const struct glint_description *s)
{
    require(s->n_objects >= 1);
    check_unit_vector(s->camera.right);
    check_unit_vector(s->camera.up);
    check_unit_vector(s->camera.forward);
    for (int i = 0; i < s->n_objects; i++)
        check_scene_object(s, &s->object[i]);
    for (int i = 0; i < s->n_triangles; i++)
        check_scene_triangle(s, &s->triangle[i]);
    for (int i = 0; i < s->n_materials; i++)
        require(s->material[i].texture < s->n_textures);
    for (int i = 0; i < s->n_lights; i++)
        if (s->light[i].kind == GLINT_DESCRIBED_SUN)
            check_unit_vector(s->light[i].at);
}

static void bake_and_check_scene(const struct glint_description *scene)
{
    struct glint_scene_bake_report report;
    struct glint_scene_model model;
    struct glint_error error;
    const char *reason;
    unsigned char *data;
    size_t bytes;

    if (glint_scene_bake(scene, "fuzz", 1, &data, &bytes, &report, &error) !=
        GLINT_OK) {
        require(error.text[0]);
        return;
    }
    require(glint_scene_open(&model, data, bytes, &reason) == GLINT_OK);
    free(data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct glint_description scene;
    const uint8_t *const zero = size ? memchr(data, 0, size) : NULL;
    const size_t bytes = zero ? (size_t)(zero - data) : size;
    struct rest rest = {data + bytes, size - bytes};
    const struct glint_description_files files = {&rest,
                                                  read_mesh_from_input,
                                                  make_picture_for_texture,
                                                  read_mesh_from_input,
                                                  read_mesh_from_input,
                                                  read_mesh_from_input};
    struct glint_error error;
    enum glint_status status;

    if (zero) {
        rest.data++;
        rest.size--;
    }
    memset(error.text, 0, sizeof error.text);
    status = glint_description_parse(&scene, (const char *)data, bytes,
                                     "fuzz.scene", &files, &error);
    if (status == GLINT_OK) {
        check_baked_scene(&scene);
        bake_and_check_scene(&scene);
        glint_description_free(&scene);
    } else {
        require(memchr(error.text, 0, sizeof error.text) != NULL &&
                error.text[0]);
    }
    return 0;
}
