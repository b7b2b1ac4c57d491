/* SPDX-License-Identifier: MIT
 *
 * Tests baked scenes: the run time accepts them, and they contain the values
 * of the scene text, rounded to steps of the scene's unit.
 */
#include "glint/scene/bake.h"
#include "support/models/scene_builder.h"
#include "support/rng.h"
#include "support/test.h"

static char mesh_text[1 << 18];
static const char *mesh = mesh_text;

static enum glint_status make_texture_picture(void *ctx, const char *name,
                                              struct glint_image *image,
                                              struct glint_error *error)
{
    uint8_t *mem = malloc(3 * 8 * 2);

    (void)ctx;
    (void)name;
    (void)error;
    assert_non_null(mem);
    for (int i = 0; i < 48; i++)
        mem[i] = i % 24 < 12 ? 0 : 255;
    *image = glint_image_over(mem, GLINT_RGB24, 8, 2);
    return GLINT_OK;
}

struct baked {
    unsigned char *data;
    size_t bytes;
    struct glint_scene_bake_report report;
    struct glint_scene_model model;
};

/* Bakes the scene of TEXT. On failure sets ERROR to the reason. */
static enum glint_status bake_scene_text(struct baked *b, const char *text,
                                         struct glint_error *error)
{
    const struct glint_description_files files = {
        &mesh, scene_read_mesh_text, make_texture_picture, NULL, NULL, NULL};
    static struct glint_description scene;
    enum glint_status status;
    const char *reason = "";

    status = glint_description_parse(&scene, text, strlen(text), "t.scene",
                                     &files, error);
    if (status != GLINT_OK)
        fail_msg("%s", error->text);
    status = glint_scene_bake(&scene, "a shop!", UINT64_C(0x123456789),
                              &b->data, &b->bytes, &b->report, error);
    glint_description_free(&scene);
    if (status == GLINT_OK)
        test_free_later(b->data);
    if (status == GLINT_OK &&
        glint_scene_open(&b->model, b->data, b->bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
    return status;
}

static void bake_valid_scene_text(struct baked *b, const char *text)
{
    struct glint_error error = {""};

    if (bake_scene_text(b, text, &error) != GLINT_OK)
        fail_msg("%s", error.text);
}

static const void *address_of_baked_table(const struct baked *b, uint32_t at)
{
    return b->data + at;
}

static void check_vector(const int32_t *v, double x, double y, double z,
                         double scale)
{
    assert_true(fabs(v[0] - x * scale) <= .5001);
    assert_true(fabs(v[1] - y * scale) <= .5001);
    assert_true(fabs(v[2] - z * scale) <= .5001);
}

#define PLAIN                                                         \
    "camera fov 90 at 0 1 4 toward 0 1 0\nbackground colour .5 0 2\n" \
    "light sun direction .6 0 .8 colour 4 8 0 radius 30\n"            \
    "light lamp at 1 2 3 colour 8 7 6 radius .25\n"                   \
    "material red phong .1 .7 .2 colour 1 .5 0 power 20 reflect .3\n" \
    "material glass phong 0 .1 .2 pass .9 refract 1.5\n"              \
    "sphere ball at 0 .5 1 radius .5 material red\n"                  \
    "plane floor at 0 0 0 normal 0 0 1 material glass\n"              \
    "plane table at 0 0 0 normal 0 1 0 catcher .5\n"                  \
    "triangle t 0 0 1 1 0 1 0 1 1 material glass\n"                   \
    "shadow on\nflare lights highlights 3\n"

/* Checks the header, lights, materials and objects of a right-handed scene; the
 * bake mirrors its z axis. */
TEST(right_handed_scene_is_mirrored)
{
    struct baked b;
    const struct glint_scene_header *h;
    double unit;

    bake_valid_scene_text(&b, PLAIN);
    h = b.model.header;
    unit = ldexp(1, h->unit_log2);
    assert_string_equal(h->name, "ashop");
    assert_true(h->key[0] == 0x23456789 && h->key[1] == 1);
    /* the plane sets the unit: the camera's distance of 4 must be less than
     * 2^28 / 64 steps */
    assert_int_equal(h->unit_log2, 19);
    assert_true(b.report.step == ldexp(1, -19) && b.report.reach == 4);
    assert_true(h->shadow == 1 && h->flare == 1 && h->highlights == 3);
    assert_int_equal(h->background_q15[0], 16384);
    assert_int_equal(h->background_q15[2], 65536);
    check_vector(h->camera.at, 0, 1, -4, unit);
    check_vector(h->camera.axis_q30[0], 1, 0, 0, 0x1p30);
    check_vector(h->camera.axis_q30[1], 0, 1, 0, 0x1p30);
    check_vector(h->camera.axis_q30[2], 0, 0, 1, 0x1p30);
    assert_int_equal(h->camera.tan_x_q24, 1 << 24);
    assert_int_equal(h->n_lights, 2);
    check_vector(b.model.light[0].toward_q30, .6, 0, -.8, 0x1p30);
    assert_int_equal(b.model.light[0].radius, 1 << 29);
    assert_true(fabs(glint_real_value(b.model.light[0].rgb[0]) - 1) < 1e-9);
    assert_true(glint_real_value(b.model.light[0].rgb[2]) == 0);
    check_vector(b.model.light[1].at, 1, 2, -3, unit);
    assert_int_equal(b.model.light[1].radius, 1 << 17);
    assert_true(glint_real_value(b.model.light[1].rgb[1]) == 7);
    /* Each of the weights .1, .7 and .2 would be rounded up, but their sum must
     * stay 1. */
    assert_int_equal(b.model.material[0].ambient_q15, 3277);
    assert_int_equal(b.model.material[0].diffuse_q15, 22937);
    assert_int_equal(b.model.material[0].specular_q15, 6554);
    assert_int_equal(b.model.material[0].rgb_q15[1], 16384);
    assert_int_equal(b.model.material[0].power_q8, 20 << 8);
    assert_int_equal(b.model.material[1].index_q16, 3 << 15);
    assert_int_equal(b.model.object[0].kind, GLINT_OBJECT_SPHERE);
    check_vector(b.model.object[0].at, 0, .5, -1, unit);
    assert_int_equal(b.model.object[0].radius, 1 << 18);
    /* This rotation takes y to +z in the text, which is -z in the baked scene:
     * -90 degrees about x. */
    check_vector(b.model.object[1].turn_q30, sqrt(.5), -sqrt(.5), 0, 0x1p30);
    assert_int_equal(b.model.object[2].catcher_q15, 16384);
    assert_int_equal(glint_scene_find(&b.model, "t"), 3);
}

/* Checks that refractive index 1 is baked as no refraction, and that the index
 * 1.001 is kept. */
TEST(a12_index_1_is_not_refracted)
{
    static const char *const refract[3] = {"", " refract 1", " refract 1.001"};
    struct baked b[3];

    for (int i = 0; i < 3; i++) {
        char text[200];

        snprintf(text, sizeof text,
                 "material m phong 0 .1 .2 pass .9%s\n"
                 "sphere s at 0 0 0 radius 1 material m\n",
                 refract[i]);
        bake_valid_scene_text(&b[i], text);
    }
    assert_int_equal(b[0].bytes, b[1].bytes);
    assert_memory_equal(b[0].data, b[1].data, b[0].bytes);
    assert_int_equal(b[0].model.material->index_q16, 1 << 16);
    assert_int_equal(b[2].model.material->index_q16, 65602);
}

/* Checks that for both handednesses the corners of baked triangles are
 * clockwise as seen from outside, and that left-handed coordinates are
 * unchanged. */
TEST(both_handednesses_give_the_same_mesh)
{
    struct baked b;
    const struct glint_scene_mesh *m;
    const struct glint_scene_triangle *t;
    const int32_t *v;

    for (int left = 0; left < 2; left++) {
        char text[400];
        double unit;

        snprintf(text, sizeof text,
                 "hand %s\nmaterial m phong 0 1 0\n"
                 "triangle t 0 0 1 1 0 1 0 1 1 material m\n",
                 left ? "left" : "right");
        bake_valid_scene_text(&b, text);
        unit = ldexp(1, b.model.header->unit_log2);
        m = &b.model.mesh[0];
        t = address_of_baked_table(&b, m->triangle_at);
        v = address_of_baked_table(&b, m->vertex_at);
        assert_int_equal(m->n_vertices, 3);
        assert_true(m->uv_at == 0 && m->normal_at == 0);
        check_vector(v + 3 * t->vertex[0], 0, 0, left ? 1 : -1, unit);
        check_vector(v + 3 * t->vertex[1], left, !left, left ? 1 : -1, unit);
        check_vector(v + 3 * t->vertex[2], !left, left, left ? 1 : -1, unit);
        assert_true(t->material == GLINT_SCENE_NONE);
    }
}

/* Checks that textures have mipmap levels down to one texel, averaged in linear
 * light; that V points down in baked textures; and that the integer part of
 * large U and V is removed. */
TEST(textures_have_averaged_mipmaps)
{
    struct baked b;
    const struct glint_scene_texture *t;
    const struct glint_scene_triangle *tri;
    const int32_t *uv;
    const uint8_t *texel;

    bake_valid_scene_text(&b,
                          "texture t x.ppm\nmaterial m phong 0 1 0 texture t\n"
                          "triangle t 0 0 0 1 0 0 0 1 0 "
                          "uv 1000 -7 1000.5 -7 1001 -6.5 material m\n");
    assert_int_equal(b.model.header->n_textures, 1);
    t = b.model.texture;
    assert_true(t->width_log2 == 3 && t->height_log2 == 1);
    texel = address_of_baked_table(&b, t->texel_at);
    assert_true(texel[0] == 0 && texel[23] == 255);
    texel += 3 * 16; /* mipmap level of 4 x 1 texels */
    assert_true(texel[0] == 0 && texel[5] == 0 && texel[6] == 255);
    texel += 3 * 4; /* mipmap level of 2 x 1 texels */
    assert_true(texel[0] == 0 && texel[5] == 255);
    texel += 3 * 2; /* code 188 is half of the light */
    assert_true(texel[0] == 188 && texel[2] == 188);
    uv = address_of_baked_table(&b, b.model.mesh[0].uv_at);
    tri = address_of_baked_table(&b, b.model.mesh[0].triangle_at);
    assert_int_equal(uv[2 * tri->vertex[0]], 0);
    assert_int_equal(uv[2 * tri->vertex[0] + 1], 1 << 16);
    /* the bake swaps the second and third corner of each triangle */
    assert_int_equal(uv[2 * tri->vertex[2]], 1 << 15);
    assert_int_equal(uv[2 * tri->vertex[1] + 1], 1 << 15);
}

/* Writes a bumpy sheet of N x N quads as an OBJ file, with one repeated corner
 * and one triangle without area. */
static void write_bumpy_sheet(int n)
{
    char *at = mesh_text;
    uint32_t seed = 3;

    for (int i = 0; i <= n; i++)
        for (int k = 0; k <= n; k++)
            at += sprintf(at, "v %d %.3f %d\n", i, .4 * rng_signed(&seed), k);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            at += sprintf(at, "f %d %d %d %d\n", i * (n + 1) + k + 1,
                          i * (n + 1) + k + 2, (i + 1) * (n + 1) + k + 2,
                          (i + 1) * (n + 1) + k + 1);
    sprintf(at, "f 1 2 1\n");
}

/* Checks that every triangle of the first mesh is listed in exactly those grid
 * cells that its bounding box, enlarged by the margin, touches. */
static void check_triangle_lists_of_cells(const struct baked *b)
{
    const struct glint_scene_mesh *m = b->model.mesh;
    const uint32_t *start = address_of_baked_table(b, m->start_at),
                   *ref = address_of_baked_table(b, m->ref_at);
    const int32_t *v = address_of_baked_table(b, m->vertex_at);
    const struct glint_scene_triangle *t =
        address_of_baked_table(b, m->triangle_at);

    for (uint32_t cell = 0; cell < m->cells[0] * m->cells[1] * m->cells[2];
         cell++) {
        const uint32_t place[3] = {cell % m->cells[0],
                                   cell / m->cells[0] % m->cells[1],
                                   cell / m->cells[0] / m->cells[1]};
        uint32_t at = start[cell];

        for (uint32_t i = 0; i < m->n_triangles; i++) {
            bool touches = true;

            for (int k = 0; k < 3; k++) {
                const int64_t from =
                    m->origin[k] + ((int64_t)place[k] << m->cell_log2);
                const int64_t to = from + (INT64_C(1) << m->cell_log2);
                int64_t low = INT64_MAX, high = INT64_MIN;

                for (int c = 0; c < 3; c++) {
                    const int64_t x = v[3 * t[i].vertex[c] + (uint32_t)k];

                    low = x < low ? x : low;
                    high = x > high ? x : high;
                }
                touches = touches && low - GLINT_SCENE_MARGIN < to &&
                          high + GLINT_SCENE_MARGIN >= from;
            }
            if (touches) {
                assert_true(at < start[cell + 1]);
                assert_int_equal(ref[at++], i);
            }
        }
        assert_int_equal(at, start[cell + 1]);
    }
}

/* Checks that each vertex is stored once, and that triangles without area are
 * omitted. */
TEST(vertices_are_stored_once)
{
    enum { N = 20 };
    struct baked b;
    const struct glint_scene_mesh *m;

    write_bumpy_sheet(N);
    bake_valid_scene_text(
        &b, "material m phong 0 1 0\n"
            "mesh s s.obj at 3 0 0 scale .1 turn 0 0 1 30 material m\n");
    m = b.model.mesh;
    assert_int_equal(m->n_vertices, (N + 1) * (N + 1));
    assert_int_equal(m->n_triangles, 2 * N * N);
    assert_int_equal(b.report.flat, 1);
    assert_int_equal(b.report.triangles, 2 * N * N);
    assert_true(m->cells[0] * m->cells[1] * m->cells[2] >= N * N / 4);
    check_triangle_lists_of_cells(&b);
}

/* Checks a triangle with a vertex 10 steps inside or outside the side of a grid
 * cell: triangles must be listed in all cells that they touch when enlarged by
 * the margin. */
TEST(triangles_are_listed_in_all_cells_they_touch)
{
    for (int k = -10; k <= 10; k += 20) {
        const char *const text = "material m phong 0 1 0\n"
                                 "mesh s s.obj at 0 0 0 material m\n";
        struct baked b;
        char *end;

        write_bumpy_sheet(16);
        end = mesh_text + strlen(mesh_text);
        sprintf(end, "v -1 0 0\nf -1 1 2\n");
        bake_valid_scene_text(&b, text);
        sprintf(end, "v %.17g 0 0\nf -1 1 2\n", -1 + k * b.report.step);
        bake_valid_scene_text(&b, text);
        check_triangle_lists_of_cells(&b);
    }
}

/* Checks that equal texts give equal bytes, that objects too small for the
 * extent of the scene are rejected, and that extreme scenes can be opened. */
TEST(extreme_scenes_can_be_opened)
{
    static const char *const texts[] = {
        "material m phong 0 1 0\nsphere s at 0 0 0 radius 1e-6 material m\n",
        "material m phong 0 1 0\nsphere s at 0 0 0 radius 1e6 material m\n",
        "material m phong 0 1 0\n"
        "sphere s at 1e6 -1e6 1e6 radius 1e6 material m\n"
        "light lamp at 1e6 1e6 1e6 colour 1e9 0 1e-6 radius 1e6\n",
        "plane p at 0 0 0 normal 0 -1 0 catcher 1\n",
        "camera fov 170 at 1e6 0 0 toward 0 0 0\nmaterial m phong 0 1 0\n"
        "triangle t 1e6 1e6 1e6 -1e6 -1e6 -1e6 1e6 -1e6 0 material m\n",
        "material m phong 0 1 0\n"
        "triangle t 1e-6 0 0 0 1e-6 0 0 0 1e-6 material m\n",
        "material m phong 0 1 0\ntriangle t 1 1 1 1 1 1 1 1 1 material m\n",
        "camera fov .1 orbit 0 0 0 distance 1e6 pitch -89.9\n"
        "material m phong 0 1 0\nsphere s at 0 0 0 radius 1 material m\n",
    };
    struct glint_error error = {""};
    struct baked a, b;

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        bake_valid_scene_text(&a, texts[i]);
        bake_valid_scene_text(&b, texts[i]);
        assert_int_equal(a.bytes, b.bytes);
        assert_memory_equal(a.data, b.data, b.bytes);
    }
    assert_int_equal(
        bake_scene_text(&a,
                        "material m phong 0 1 0\n"
                        "sphere big at 0 0 0 radius 1e6 material m\n"
                        "sphere dot at 0 0 0 radius 1e-6 material m\n",
                        &error),
        GLINT_E_LENS);
    assert_non_null(
        strstr(error.text, "sphere dot, radius 1e-06, is too small"));
}
