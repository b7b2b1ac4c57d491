/* SPDX-License-Identifier: MIT
 *
 * Writes a baked scene: header, lights, textures, materials, meshes, objects.
 */
#include "glint/scene/bake.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/scene/write_scene.h"
#include "bake/scene/texels.h"
#include "glint/scene/ward.h"
#include "glint/view.h"

enum { ONE_Q15 = 1 << 15 };

struct writer {
    const struct glint_description *scene;
    struct glint_draft draft;
    struct glint_steps steps;
    struct glint_scene_header header;
    struct glint_scene_bake_report *report;
    struct glint_error *error;
    /* meshes of all objects with triangles; owned */
    struct glint_scene_mesh *mesh;
};

/* ------------------------------------------------------------------ lights */

static struct glint_scene_light
convert_scene_light(const struct writer *w,
                    const struct glint_described_light *light)
{
    struct glint_scene_light l = {.kind = GLINT_LIGHT_LAMP};
    double scale = 1;

    memcpy(l.name, light->name, sizeof l.name);
    if (light->kind == GLINT_DESCRIBED_SUN) {
        const double sine = sin(light->radius_deg * GLINT_PI / 180);

        l.kind = GLINT_LIGHT_SUN;
        glint_steps_convert_unit_vector(&w->steps, light->at, l.toward_q30);
        l.radius = (int32_t)lrint(sine * 0x1p30);
        scale = sine * sine;
    } else {
        glint_steps_convert_position(&w->steps, light->at, l.at);
        l.radius = (int32_t)lrint(light->radius * w->steps.scale);
    }
    for (int c = 0; c < 3; c++)
        l.rgb[c] = glint_real_of(scale * light->colour[c]);
    return l;
}

static void write_scene_lights(struct writer *w)
{
    w->header.n_lights = (uint32_t)w->scene->n_lights;
    w->header.light_at = (uint32_t)w->draft.bytes;
    for (int i = 0; i < w->scene->n_lights; i++) {
        const struct glint_scene_light l =
            convert_scene_light(w, &w->scene->light[i]);

        glint_draft_append(&w->draft, &l, sizeof l);
    }
}

/* ---------------------------------------------------------------- textures */

static int compute_log2_of_power(int power)
{
    int n = 0;

    while (power >> n > 1)
        n++;
    return n;
}

/* Writes all mipmap levels of IMAGE, each averaged from level 0. Returns false
 * if there is no memory. */
static bool write_mipmap_levels(struct writer *w,
                                const struct glint_image *image)
{
    int width = image->width, height = image->height;
    size_t bytes = 0;
    uint8_t *mem, *at;
    bool good = true;

    for (int a = width, b = height;; a = (a + 1) / 2, b = (b + 1) / 2) {
        bytes += 3 * (size_t)a * (size_t)b;
        if (a == 1 && b == 1)
            break;
    }
    at = mem = malloc(bytes);
    if (!mem)
        return false;
    memcpy(at, image->plane[0], 3 * (size_t)width * (size_t)height);
    while (good && (width > 1 || height > 1)) {
        at += 3 * (size_t)width * (size_t)height;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        good = glint_texels_resize_picture(at, width, height, image->plane[0],
                                           image->width,
                                           image->height) == GLINT_OK;
    }
    glint_draft_append(&w->draft, mem, bytes);
    free(mem);
    return good;
}

static bool write_textures(struct writer *w)
{
    const int n = w->scene->n_textures;
    struct glint_scene_texture t[GLINT_DESCRIPTION_MAX_TEXTURES];

    for (int i = 0; i < n; i++) {
        const struct glint_image *image = &w->scene->texture[i].image;

        t[i] = (struct glint_scene_texture){
            (uint32_t)compute_log2_of_power(image->width),
            (uint32_t)compute_log2_of_power(image->height),
            (uint32_t)w->draft.bytes};
        if (!write_mipmap_levels(w, image))
            return false;
    }
    w->header.n_textures = (uint32_t)n;
    w->header.texture_at =
        glint_draft_append(&w->draft, t, (size_t)n * sizeof *t);
    return true;
}

/* --------------------------------------------------------------- materials */

static int32_t convert_to_q15(double x)
{
    return (int32_t)lrint(x * ONE_Q15);
}

/* Decreases the largest one of N weights if rounding has raised their sum above
 * 1, so that the sum is at most 1. */
static void limit_weight_sum(int32_t *const weight_q15[], int n)
{
    int32_t sum = 0;
    int most = 0;

    for (int i = 0; i < n; i++) {
        sum += *weight_q15[i];
        most = *weight_q15[i] > *weight_q15[most] ? i : most;
    }
    if (sum > ONE_Q15)
        *weight_q15[most] -= sum - ONE_Q15;
}

static struct glint_scene_material
convert_material(const struct glint_described_material *from)
{
    struct glint_scene_material m = {
        .ambient_q15 = convert_to_q15(from->ambient),
        .diffuse_q15 = convert_to_q15(from->diffuse),
        .specular_q15 = convert_to_q15(from->specular),
        .reflect_q15 = convert_to_q15(from->reflect),
        .pass_q15 = convert_to_q15(from->pass),
        .rgb_q15 = {convert_to_q15(from->colour[0]),
                    convert_to_q15(from->colour[1]),
                    convert_to_q15(from->colour[2])},
        .power_q8 = (int32_t)lrint(256 * from->power),
        .index_q16 = (int32_t)lrint(0x1p16 * from->index),
        .texture =
            from->texture < 0 ? GLINT_SCENE_NONE : (uint32_t)from->texture,
        .ward = GLINT_SCENE_NONE};
    int32_t *const phong[] = {&m.ambient_q15, &m.diffuse_q15, &m.specular_q15};
    int32_t *const next[] = {&m.reflect_q15, &m.pass_q15};

    memcpy(m.name, from->name, sizeof m.name);
    limit_weight_sum(phong, 3);
    limit_weight_sum(next, 2);
    return m;
}

static struct glint_scene_ward
convert_ward_lobe(const struct glint_described_material *from)
{
    struct glint_scene_ward w = {.norm = from->norm == GLINT_DESCRIBED_1992
                                             ? GLINT_WARD_1992
                                             : GLINT_WARD_BOUNDED};

    for (int c = 0; c < 3; c++)
        w.specular_q15[c] = convert_to_q15(from->metal[c]);
    for (int k = 0; k < 2; k++)
        w.alpha_q24[k] = (int32_t)ceil(0x1p24 * from->alpha[k]);
    return w;
}

static void write_materials(struct writer *w)
{
    /* written if the scene has no materials, as then its objects only receive
     * shadows */
    const struct glint_scene_material none = {.name = "none",
                                              .power_q8 = 256,
                                              .index_q16 = 1 << 16,
                                              .texture = GLINT_SCENE_NONE,
                                              .ward = GLINT_SCENE_NONE};
    const int n = w->scene->n_materials;
    uint32_t n_wards = 0;

    w->header.n_materials = (uint32_t)(n ? n : 1);
    w->header.material_at = (uint32_t)w->draft.bytes;
    for (int i = 0; i < n; i++) {
        struct glint_scene_material m =
            convert_material(&w->scene->material[i]);

        if (w->scene->material[i].is_metal)
            m.ward = n_wards++;
        glint_draft_append(&w->draft, &m, sizeof m);
    }
    if (!n)
        glint_draft_append(&w->draft, &none, sizeof none);
    w->header.n_wards = n_wards;
    w->header.ward_at = (uint32_t)w->draft.bytes;
    for (int i = 0; i < n; i++)
        if (w->scene->material[i].is_metal) {
            const struct glint_scene_ward ward =
                convert_ward_lobe(&w->scene->material[i]);

            glint_draft_append(&w->draft, &ward, sizeof ward);
        }
}

/* ----------------------------------------------------------------- objects */

static bool write_meshes(struct writer *w)
{
    const struct glint_description *s = w->scene;
    bool good = true;
    uint32_t n = 0;

    for (int i = 0; good && i < s->n_objects; i++)
        if (s->object[i].n_triangles)
            good = glint_grid_write_mesh(&w->draft, s, &s->object[i], &w->steps,
                                         &w->mesh[n++], w->report, w->error);
    w->header.n_meshes = n;
    if (good)
        w->header.mesh_at =
            glint_draft_append(&w->draft, w->mesh, n * sizeof *w->mesh);
    return good;
}

/* Converts object FROM to O. MESH: index of its mesh, if it has triangles.
 * Returns false if it is a sphere smaller than a step. */
static bool convert_object(const struct writer *w,
                           const struct glint_described_object *from,
                           uint32_t mesh, struct glint_scene_object *o)
{
    double upright[4], turn[4];

    memcpy(o->name, from->name, sizeof o->name);
    memcpy(turn, from->turn, sizeof turn);
    o->material = (uint32_t)(from->material < 0 ? 0 : from->material);
    o->unblocked_q15 = ONE_Q15 - convert_to_q15(from->shadow);
    glint_steps_convert_position(&w->steps, from->at, o->at);
    switch (from->kind) {
    case GLINT_DESCRIBED_SPHERE:
        o->kind = GLINT_OBJECT_SPHERE;
        o->radius = (int32_t)lrint(from->radius * w->steps.scale);
        if (o->radius < 1) {
            snprintf(
                w->error->text, sizeof w->error->text,
                "sphere %s, radius %g, is too small for a scene of extent %g",
                from->name, from->radius, w->report->reach);
            return false;
        }
        break;
    case GLINT_DESCRIBED_PLANE:
        o->kind = GLINT_OBJECT_PLANE;
        o->catcher_q15 = convert_to_q15(from->catcher);
        glint_described_upright(from->normal, upright);
        glint_turn_multiply_quaternions(from->turn, upright, turn);
        break;
    default:
        o->kind = GLINT_OBJECT_MESH;
        o->mesh = mesh;
        /* an object without a material uses that of its first triangle */
        if (from->material < 0)
            o->material =
                (uint32_t)w->scene->triangle[from->first_triangle].material;
    }
    glint_steps_convert_rotation(&w->steps, turn, o->turn_q30);
    return true;
}

static bool write_objects(struct writer *w)
{
    uint32_t mesh = 0;

    w->header.n_objects = (uint32_t)w->scene->n_objects;
    w->header.object_at = (uint32_t)w->draft.bytes;
    for (int i = 0; i < w->scene->n_objects; i++) {
        struct glint_scene_object o = {.kind = 0};

        if (!convert_object(w, &w->scene->object[i], mesh, &o))
            return false;
        mesh += w->scene->object[i].n_triangles > 0;
        glint_draft_append(&w->draft, &o, sizeof o);
    }
    return true;
}

/* -------------------------------------------------------------------
 * translucent media */

/* Writes all translucent media, and the texture maps of objects made of
 * them. */
static bool write_translucent_media(struct writer *w)
{
    const struct glint_description *s = w->scene;
    struct glint_scene_stone stone[GLINT_DESCRIPTION_MAX_STONES];
    struct glint_scene_skin skin[GLINT_SCENE_MAX_SKINS];
    uint32_t n = 0, mesh = 0;

    for (int i = 0; i < s->n_materials; i++) {
        const struct glint_described_material *m = &s->material[i];

        if (!m->is_stone)
            continue;
        stone[m->stone] = (struct glint_scene_stone){
            (uint32_t)i,
            glint_draft_append(&w->draft, s->stone[m->stone].data,
                               s->stone[m->stone].bytes),
            (uint32_t)s->stone[m->stone].bytes, m->fresnel};
    }
    for (int i = 0; i < s->n_objects; i++) {
        const struct glint_described_object *o = &s->object[i];
        const struct glint_scene_mesh *of =
            o->n_triangles ? &w->mesh[mesh++] : NULL;
        const int material = glint_skin_find_material(s, o);

        if (material < 0)
            continue;
        if (n == GLINT_SCENE_MAX_SKINS) {
            snprintf(w->error->text, sizeof w->error->text,
                     "more than %d translucent objects", GLINT_SCENE_MAX_SKINS);
            return false;
        }
        skin[n] = (struct glint_scene_skin){
            .object = (uint32_t)i,
            .stone = (uint32_t)s->material[material].stone};
        if (!glint_skin_write_map(&w->draft, s, o, of, material, &skin[n],
                                  w->error))
            return false;
        n++;
    }
    w->header.n_stones = (uint32_t)s->n_stones;
    w->header.stone_at = glint_draft_append(
        &w->draft, stone, (size_t)s->n_stones * sizeof *stone);
    w->header.n_skins = n;
    w->header.skin_at = glint_draft_append(&w->draft, skin, n * sizeof *skin);
    return true;
}

/* ------------------------------------------------------------------ header */

static struct glint_scene_camera convert_camera(const struct writer *w)
{
    const struct glint_described_camera *from = &w->scene->camera;
    struct glint_scene_camera c = {.kind = GLINT_CAMERA_LENS};

    glint_steps_convert_position(&w->steps, from->at, c.at);
    glint_steps_convert_unit_vector(&w->steps, from->right, c.axis_q30[0]);
    glint_steps_convert_unit_vector(&w->steps, from->up, c.axis_q30[1]);
    glint_steps_convert_unit_vector(&w->steps, from->forward, c.axis_q30[2]);
    if (from->field == GLINT_DESCRIBED_FIELD) {
        c.kind = GLINT_CAMERA_FIELD;
        c.tan_x_q24 =
            (int32_t)lrint(0x1p24 * tan(from->fov_deg * GLINT_PI / 360));
    } else if (from->field == GLINT_DESCRIBED_CORNERS) {
        c.kind = GLINT_CAMERA_CORNERS;
        /* The field of GLINT_DESCRIBED_CORNERS is 16 x 9 units at a distance of
         * 10 units; these are the tangents of half of it. */
        c.tan_x_q24 = (int32_t)lrint(0x1p24 * .8);
        c.tan_y_q24 = (int32_t)lrint(0x1p24 * .45);
    }
    return c;
}

static void write_environments(struct writer *w)
{
    struct glint_scene_environment to[GLINT_DESCRIPTION_MAX_ENVIRONMENTS];
    const int n = w->scene->n_environments;

    for (int i = 0; i < n; i++) {
        const struct glint_described_environment *e = &w->scene->environment[i];
        const double angle = e->turn_deg * GLINT_PI / 180;

        to[i] = (struct glint_scene_environment){
            .file_at = glint_draft_append(&w->draft, e->data, e->bytes),
            .file_bytes = (uint32_t)e->bytes,
            .turn_q30 = {(int32_t)lrint(0x1p30 * cos(angle)),
                         (int32_t)lrint(0x1p30 * sin(angle))},
            .scale = glint_real_of(e->scale)};
        memcpy(to[i].name, e->name, sizeof e->name);
    }
    w->header.n_environments = (uint32_t)n;
    w->header.n_environment_lights = (uint32_t)w->scene->n_environment_lights;
    w->header.environment_at =
        glint_draft_append(&w->draft, to, (size_t)n * sizeof *to);
}

static uint32_t convert_object_index(int object)
{
    return object < 0 ? GLINT_SCENE_NONE : (uint32_t)object;
}

static int32_t convert_length_to_steps(const struct writer *w, double length)
{
    return length > 0 ? (int32_t)fmax(1, rint(length * w->steps.scale)) : 0;
}

static void write_motion(struct writer *w)
{
    const struct glint_described_motion *from = &w->scene->motion;
    struct glint_scene_motion m = {
        .body = convert_object_index(from->body),
        .sensor = convert_object_index(from->sensor),
        .food = convert_object_index(from->food),
        .size = (int32_t)lrint(from->size * w->steps.scale),
        .shell = convert_length_to_steps(w, from->shells * from->foods),
        .line = convert_length_to_steps(w, from->lines),
        .box = convert_length_to_steps(w, from->box),
        .shell_material = (uint32_t)from->shell_material,
        .line_material = (uint32_t)from->line_material,
        .box_material = (uint32_t)from->box_material,
        .detect = from->both ? GLINT_DETECT_BOTH : GLINT_DETECT_ANGLE,
        .least = (uint32_t)lrint(255 * from->least),
        .camera = convert_object_index(from->camera),
        .riders = from->riders,
        .bytes = (uint32_t)from->bytes};

    w->header.motion_at = (uint32_t)w->draft.bytes;
    if (!from->data)
        return;
    memcpy(m.name, from->name, sizeof m.name);
    w->header.n_motions = 1;
    glint_draft_append(&w->draft, &m, sizeof m);
    glint_draft_append(&w->draft, from->data, from->bytes);
}

static void set_scene_header(struct writer *w, const char *name, uint64_t key)
{
    static const struct glint_blob_kind kind = {.magic = GLINT_SCENE_MAGIC,
                                                .version = GLINT_SCENE_VERSION};
    const struct glint_description *s = w->scene;
    struct glint_scene_header *h = &w->header;

    glint_draft_begin_header(
        h, &kind, s->left_handed ? GLINT_HAND_LEFT : GLINT_HAND_RIGHT, key,
        name, "scene");
    h->unit_log2 = w->steps.unit_log2;
    h->shadow = s->has_shadows;
    h->background = s->background == GLINT_BEHIND_ENVIRONMENT
                        ? GLINT_BACKGROUND_ENVIRONMENT
                        : GLINT_BACKGROUND_CAMERA;
    if (s->background == GLINT_BEHIND_COLOUR) {
        h->background = GLINT_BACKGROUND_COLOUR;
        for (int c = 0; c < 3; c++)
            h->background_q15[c] = convert_to_q15(s->background_colour[c]);
    }
    h->camera = convert_camera(w);
    h->flare = s->flare != GLINT_DESCRIBED_FLARE_OFF;
    h->highlights = (uint32_t)s->n_highlights;
}

enum glint_status glint_scene_bake(const struct glint_description *scene,
                                   const char *name, uint64_t key,
                                   unsigned char **data, size_t *bytes,
                                   struct glint_scene_bake_report *report,
                                   struct glint_error *error)
{
    struct writer w = {.scene = scene, .report = report, .error = error};
    bool good;

    *report = (struct glint_scene_bake_report){0};
    error->text[0] = '\0';
    w.steps = glint_steps_choose_size(scene, &report->reach);
    report->step = 1 / w.steps.scale;
    glint_draft_append(&w.draft, NULL, sizeof w.header);
    write_scene_lights(&w);
    w.mesh = malloc(((size_t)scene->n_objects + 1) * sizeof *w.mesh);
    good = write_textures(&w);
    write_materials(&w);
    good = good && w.mesh && write_meshes(&w) && write_objects(&w) &&
           write_translucent_media(&w);
    free(w.mesh);
    write_environments(&w);
    write_motion(&w);
    set_scene_header(&w, name, key);
    if (glint_draft_finish_file(&w.draft, &w.header, sizeof w.header, good,
                                data, bytes))
        return GLINT_OK;
    return error->text[0] ? GLINT_E_LENS : GLINT_E_MEMORY;
}
