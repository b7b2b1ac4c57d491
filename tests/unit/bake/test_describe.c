/* SPDX-License-Identifier: MIT
 *
 * Checks that the parser of scene texts reads valid texts, and reports the
 * position and cause of each mistake.
 */
#include "glint/scene/description.h"
#include "glint/view.h"
#include "bake/scene/mesh.h"
#include "support/test.h"

/* A valid text. Each wrong text below replaces one of its lines. */
static const char *const good[] = {
    "hand left   # as the tutorial",                            /* line 1 */
    "camera fov 60 at 0 1 -4 toward 0 1 0",                     /* line 2 */
    "background colour .1 .2 .3",                               /* line 3 */
    "light sun direction 0 3 -4 colour 5e4 4e4 3e4 radius .27", /* line 4 */
    "light lamp at 0 3 -2 colour 8 7 6",                        /* line 5 */
    "texture wood wood.ppm",                                    /* line 6 */
    "material red phong .1 .7 .2 colour 1 0 0 power 20",        /* line 7 */
    "material oak phong 0 1 0 texture wood",                    /* line 8 */
    "material glass phong 0 .1 .2 pass .9 refract 1.5",         /* line 9 */
    "sphere ball at 0 .5 0 radius .5 material red",             /* line 10 */
    "triangle t 0 0 0 1 0 0 0 1 0 uv 0 0 1 0 0 1 material oak", /* line 11 */
    "plane floor at 0 0 0 normal 0 2 0 catcher .6",             /* line 12 */
    /* line 13 */
    "mesh cup cup.obj scale .5 at 1 0 0 turn 0 2 0 90 material red shadow .25",
    "shadow on",                 /* line 14 */
    "flare lights highlights 3", /* line 15 */
};

#define N_GOOD 15

static struct glint_description scene;
static struct glint_error fault;

/* A quad, whose second half has another material, and a triangle. */
static const char cup[] = "# a cup\n"
                          "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\n"
                          "vn 0 0 -3\n"
                          "o cup\n"
                          "f 1/1/1 2/2/1 3/3/1 4/1/1\n"
                          "usemtl oak\n"
                          "f -4/1 -3/2 -2/3\n";

static enum glint_status read_scene_file(void *ctx, const char *name,
                                         uint8_t **data, size_t *bytes,
                                         struct glint_error *error)
{
    (void)ctx;
    if (strcmp(name, "cup.obj") != 0) {
        snprintf(error->text, sizeof error->text, "%s: no such file", name);
        return GLINT_E_IO;
    }
    *bytes = sizeof cup - 1;
    *data = malloc(*bytes);
    assert_non_null(*data);
    memcpy(*data, cup, *bytes);
    return GLINT_OK;
}

/* Returns a picture of 6 x 2 pixels, a third of them black, the others white;
 * for the name big.ppm, a black picture of the largest texture size. */
static enum glint_status make_scene_picture(void *ctx, const char *name,
                                            struct glint_image *image,
                                            struct glint_error *error)
{
    uint8_t *mem = malloc(3 * 6 * 2);

    (void)ctx;
    (void)error;
    assert_non_null(mem);
    if (strcmp(name, "big.ppm") == 0) {
        const int side = GLINT_DESCRIPTION_MAX_SIDE;

        free(mem);
        mem = calloc(3 * (size_t)side, (size_t)side);
        assert_non_null(mem);
        *image = glint_image_over(mem, GLINT_RGB24, side, side);
        return GLINT_OK;
    }
    assert_string_equal(name, "wood.ppm");
    for (int i = 0; i < 36; i++)
        mem[i] = i % 18 < 6 ? 0 : 255;
    *image = glint_image_over(mem, GLINT_RGB24, 6, 2);
    return GLINT_OK;
}

static const struct glint_description_files files = {
    NULL, read_scene_file, make_scene_picture, NULL, NULL, NULL};

/* Parses the valid text with its line NUMBER (from 1) replaced by LINE; NUMBER
 * 0: no replacement. */
static enum glint_status parse_text_with_line(int number, const char *line)
{
    char text[4096] = "", *copy;
    enum glint_status status;
    size_t bytes;

    for (int i = 0; i < N_GOOD; i++) {
        strcat(text, i + 1 == number ? line : good[i]);
        strcat(text, "\n");
    }
    /* The copy has exactly the size of the text, so that ASan detects
     * overreads. */
    bytes = strlen(text);
    copy = test_free_later(malloc(bytes));
    memcpy(copy, text, bytes);
    glint_description_free(&scene);
    fault.text[0] = '\0';
    status =
        glint_description_parse(&scene, copy, bytes, "x.scene", &files, &fault);
    return status;
}

static void check_vector_is_near(const double *a, double x, double y, double z)
{
    assert_true(fabs(a[0] - x) < 1e-12);
    assert_true(fabs(a[1] - y) < 1e-12);
    assert_true(fabs(a[2] - z) < 1e-12);
}

TEST(parses_every_line)
{
    if (parse_text_with_line(0, NULL) != GLINT_OK)
        fail_msg("%s", fault.text);
    assert_true(scene.left_handed && scene.has_shadows);
    check_vector_is_near(scene.camera.right, 1, 0, 0);
    check_vector_is_near(scene.camera.up, 0, 1, 0);
    check_vector_is_near(scene.camera.forward, 0, 0, 1);
    assert_true(scene.camera.fov_deg == 60);
    check_vector_is_near(scene.background_colour, .1, .2, .3);
    assert_int_equal(scene.n_lights, 2);
    check_vector_is_near(scene.light[0].at, 0, .6, -.8);
    assert_string_equal(scene.light[1].name, "lamp");
    assert_int_equal(scene.n_materials, 3);
    assert_true(scene.material[0].power == 20 && scene.material[1].power == 32);
    assert_int_equal(scene.material[1].texture, 0);
    assert_true(scene.material[2].pass == .9 && scene.material[2].index == 1.5);
    assert_int_equal(scene.n_objects, 4);
    check_vector_is_near(scene.object[2].normal, 0, 1, 0);
    assert_true(scene.object[2].catcher == .6 &&
                scene.object[2].material == -1);
    assert_int_equal(scene.flare, GLINT_DESCRIBED_FLARE_HIGHLIGHTS);
    assert_int_equal(scene.n_highlights, 3);
    assert_string_equal(scene.warning, "");
}

/* Checks that a quad becomes two triangles, scaled by 1/2, and that the name
 * "oak" in the mesh file refers to the material "oak" of the scene. */
TEST(quad_becomes_two_scaled_triangles)
{
    const struct glint_described_object *o;

    assert_ok(parse_text_with_line(0, NULL));
    o = &scene.object[3];
    assert_int_equal(o->first_triangle, 1);
    assert_int_equal(o->n_triangles, 3);
    assert_true(o->shadow == .25 && scene.object[0].shadow == 1);
    assert_true(fabs(o->turn[0] - sqrt(.5)) < 1e-12 &&
                fabs(o->turn[2] - sqrt(.5)) < 1e-12);
    check_vector_is_near(scene.triangle[2].place[1], 1, 1, 0);
    check_vector_is_near(scene.triangle[2].place[2], 0, 1, 0);
    assert_true(scene.triangle[2].has_normals && scene.triangle[2].has_uv);
    check_vector_is_near(scene.triangle[2].normal[0], 0, 0, -1);
    assert_int_equal(scene.triangle[2].material, 0);
    assert_int_equal(scene.triangle[3].material, 1);
    assert_false(scene.triangle[3].has_normals);
}

/* Checks that a texture of six columns is resampled to eight, the power of two
 * with the nearest ratio, and that its mean light is preserved. */
TEST(texture_is_resampled_to_a_power_of_two)
{
    const uint8_t *row;

    assert_ok(parse_text_with_line(0, NULL));
    assert_int_equal(scene.texture[0].image.width, 8);
    assert_int_equal(scene.texture[0].image.height, 2);
    row = scene.texture[0].image.plane[0];
    assert_int_equal(row[3 * 1], 0);
    /* code 156 is a third of the light of white */
    assert_int_equal(row[3 * 2], 156);
    assert_int_equal(row[3 * 3], 255);
}

static const struct mistake {
    int line;
    const char *text, *error;
} mistakes[] = {
    {1, "hand up", "1:6: hand accepts right or left, not 'up'"},
    {1, "hand", "1:5: hand needs right or left"},
    {1, "hand left over", "1:11: 'over' is one value too many for hand"},
    {2, "camera fov 60 at 0 1 -4", "2:8: camera needs 'at X Y Z toward"},
    {2, "camera fov 60 at 0 1 toward 0 1 0",
     "2:22: at 'toward' is not a number"},
    {2, "camera fov 60 at 0 1", "2:21: at needs 3 numbers, got 2"},
    {2, "camera fov 200 at 0 1 -4 toward 0 1 0",
     "2:12: fov must be 0.1 .. 170, not 200"},
    {2, "camera at 0 1 0 toward 0 1 0",
     "2:8: the camera's position equals the point that it looks at"},
    {2, "camera at 0 1 0 toward 0 2 0",
     "2:8: the camera's direction is parallel to 'up'"},
    {2, "camera at 0 1 0 toward 0 2 2 up 0 0 0", "2:8: 'up' must not be 0 0 0"},
    {2, "camera fov 50 orbit 0 0 0 distance 3 at 0 0 0",
     "2:38: 'at' and 'orbit' cannot be combined"},
    {2, "camera orbit 0 0 0 yaw 3", "2:8: an orbit needs 'distance'"},
    {2, "camera at 0 1 0 toward 0 1 1 yaw 5",
     "2:30: 'yaw' may only be used with 'orbit'"},
    {2, "camera sensor 3", "2:8: the scene has no motion, and so no sensors"},
    {2, "camera corners 3",
     "2:16: '3' is one value too many for camera corners"},
    {2, "hand left", "2:1: a second hand; the first is on line 1"},
    {3, "background environment",
     "3:12: 'background environment' needs a line 'environment FILE'"},
    {3, "background sky", "3:12: background accepts camera, colour R G B or"},
    {3, "environment", "3:12: the file name is missing: environment FILE"},
    {3, "environment night.env turn 400",
     "3:28: turn must be -360 .. 360, not 400"},
    {3, "environment night.env",
     "3:13: this program cannot read environment files"},
    {3, "motion run", "3:11: the file name is missing: motion NAME FILE"},
    {3, "motion run x.motion", "3:12: this program cannot read motion files"},
    {3, "motion run x.motion shells 2", "3:21: 'shells' needs 'foods'"},
    {3, "motion run x.motion box 1", "3:21: 'box' is a factor on the width"},
    {3, "motion run x.motion detect", "3:21: 'detect' needs 'angle', or"},
    {3, "motion run x.motion both .3",
     "3:21: 'angle' and 'both' may only follow"},
    {3, "light lamp at 0 0 0 colour 1 1 1 on run",
     "3:34: the motion 'run' is not defined"},
    {3, "sphree b", "3:1: unknown word 'sphree'; did you mean 'sphere'?"},
    {3, "xyzzy", "3:1: unknown word 'xyzzy'"},
    {4, "light sun colour 1 1 1", "4:23: light sun needs 'direction'"},
    {4, "light sun direction 0 1 0 radius 1",
     "4:11: light sun needs 'colour' or 'white'"},
    {4, "light sun direction 0 1 0 colour 1 1 1 white 1 1 1",
     "4:40: light sun needs 'colour' or 'white', not both"},
    {4, "light sun direction 0 0 0 colour 1 1 1",
     "4:11: the direction to the sun must not be 0 0 0"},
    {4, "light bulb at 0 0 0",
     "4:7: a light must be a sun or a lamp, not 'bulb'"},
    {5, "light lamp at 0 3 -2 color 8 7 6",
     "5:22: light lamp accepts at, colour, radius, on and name, not 'color'; "
     "did you mean 'colour'?"},
    {5, "light lamp at 0 3 -2 colour 1 1 1 name 1",
     "5:40: a name must be a letter followed by at most 30"},
    {5, "light lamp at 0 3 -2 colour 1 1 1 name camera",
     "5:40: the name is that of another light or object"},
    {5, "light lamp at 0 3 -2 colour 1 1 1 name environment2",
     "5:40: the name is that of another light or object, or begins with "
     "'environment'"},
    {5, "light lamp at 0 3 -2 colour 1 1 1 name sun",
     "5:40: the name is that of another light or object"},
    {5, "light lamp at 0 3 -2 colour 1 1 1 name ball",
     "10:8: a light of this name is already defined"},
    {11, "light lamp at 0 3 -2 colour 1 1 1 name ball",
     "11:40: the name is that of another light or object"},
    {5, "light lamp at 0 3 -2 at 8 7 6", "5:22: a second 'at'"},
    {5, "light lamp at 0 3 2e6 colour 8 7 6",
     "5:19: at must be -1000000 .. 1000000, not 2e+06"},
    {6, "texture wood", "6:13: the file name is missing: texture NAME FILE"},
    {6,
     "texture a big.ppm\ntexture b big.ppm\ntexture c big.ppm\n"
     "texture d big.ppm\ntexture wood wood.ppm",
     "10:14: more than 67108864 texels in all textures"},
    {7, "material red phong .1 .8 .2",
     "7:14: the weights of phong sum to 1.1; above 1 the surface would reflect "
     "more light than it receives"},
    {7, "material red phong .1 .7 .2 reflect .6 pass .5",
     "7:29: 'reflect' and 'pass' sum to 1.1"},
    {7, "material red phong .1 .7 .2 refract 1.5",
     "7:29: 'refract' needs a 'pass' above 0"},
    {7, "material red ward alpha .1 .1", "7:30: material needs 'specular'"},
    {7, "material red ward specular .9 .9 .9 alpha .1 .1 reflect .5",
     "7:49: material accepts ward, specular, alpha, diffuse, norm and texture"},
    {7, "material red ward specular .9 .9 .9 alpha .1 .1 diffuse 0 .2 0",
     "7:19: 'diffuse' and 'specular' sum to 1.1; above 1 the surface would "
     "reflect more light than it receives"},
    {7, "material red ward specular .9 .9 .9 alpha .0001 .1",
     "7:43: alpha must be 0.001 .. 1, not 0.0001"},
    {7, "material red ward specular .9 .9 .9 alpha .1 .1 norm 2010",
     "7:54: 'norm' must be bounded or 1992, not '2010'"},
    {7, "material red translucent",
     "7:25: the file name is missing: translucent FILE"},
    {7, "material red translucent a.glint",
     "7:26: this program cannot read translucent materials"},
    {7, "material red translucent a.glint fresnel", "7:41: the name of a"},
    {7, "material red translucent a.glint fresnel no",
     "7:42: 'fresnel' must be on or off, not 'no'"},
    {7, "material red translucent a.glint colour 1 1",
     "7:44: colour needs 3 numbers, got 2"},
    {7, "material red translucent a.glint reflect .1",
     "7:34: material accepts coat, specular, alpha, norm, fresnel and colour"},
    {7, "material 7up phong 0 1 0",
     "7:10: a name must be a letter followed by"},
    {8, "material oak phong 0 1 0 texture wod",
     "8:34: no texture 'wod' is defined above this line; did you mean 'wood'"},
    {8, "material red phong 0 1 0",
     "8:10: a material of this name is already defined"},
    {10, "sphere ball at 0 0 0 radius 0 material red",
     "10:29: radius must be 1e-06 .. 1000000, not 0"},
    {10, "sphere ball at 0 0 0 radius 1 material rad",
     "10:40: no material 'rad' is defined above this line; did you mean 'red'"},
    {10, "sphere ball at 0 0 0 radius 1 turn 0 0 0 1 material red",
     "10:31: the axis of a rotation must not be 0 0 0"},
    {11, "triangle t 0 0 0 1 0 0 0 1 0 uv 0 0 1 0 0 251 material oak",
     "11:30: a texture may repeat at most 250 times over a triangle"},
    {4, "light sun direction 0 1 0 colour 1 1 1 radius 31",
     "4:47: radius must be 0.01 .. 30, not 31"},
    {10, "sphere ball at 0 0 0 radius 1", "10:30: sphere needs 'material'"},
    {10, "sphere camera at 0 0 0 radius 1 material red",
     "10:8: the name 'camera'"},
    {11, "triangle ball 0 0 0 1 0 0 0 1 0 material red",
     "11:10: an object of this name is already defined"},
    {11, "triangle t 0 0 0 1 0 0 0 1 material red",
     "11:28: triangle 'material' is not a number"},
    {11, "triangle t 0 0 0 1 0 0 0 1 0 material oak",
     "11:30: a material with a texture needs 'uv'"},
    {12, "plane floor at 0 0 0 normal 0 1 0",
     "12:13: a plane needs a material or the word 'catcher'"},
    {12, "plane floor at 0 0 0 normal 0 1 0 catcher .5 material red",
     "12:46: a plane needs a material or the word 'catcher', not both"},
    {12, "plane floor at 0 0 0 normal 0 0 0 catcher .6",
     "12:22: a normal must not be 0 0 0"},
    {13, "mesh cup", "13:9: the file name is missing: mesh NAME FILE"},
    {13, "mesh cup pot.obj at 0 0 0", "13:10: pot.obj: no such file"},
    {13, "mesh cup cup.obj at 0 0 0", "13:10: the mesh has faces without"},
    {13, "mesh cup cup.obj at 0 0 0 turn 0 0 0 9 material red",
     "13:27: the axis of a rotation must not be 0 0 0"},
    {13, "mesh cup cup.obj at 0 0 0 scale 1e9 material red",
     "13:10: the mesh extends 2e+09 from its origin; the limit is 1e+06"},
    {10, "sphere ball at 0 .5 0 radius .5 material red shadow 2",
     "10:53: shadow must be 0 .. 1, not 2"},
    {14, "shadow soft", "14:8: shadow accepts on or off, not 'soft'"},
    {15, "flare lights highlights 2.5",
     "15:14: 'highlights' must be a whole number, 0 to 8"},
    {15, "flare lights highlights 9",
     "15:25: highlights must be 0 .. 8, not 9"},
    {15, "flare stars",
     "15:7: flare accepts off or lights [highlights N], not"},
};

TEST(rejects_wrong_lines)
{
    for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++) {
        const struct mistake *m = &mistakes[i];
        char wanted[200];

        snprintf(wanted, sizeof wanted, "x.scene:%s", m->error);
        assert_int_not_equal(parse_text_with_line(m->line, m->text), GLINT_OK);
        if (strncmp(fault.text, wanted, strlen(wanted)) != 0)
            fail_msg("'%s': %s", m->text, fault.text);
    }
}

/* Checks that the same numbers with the other handedness give the mirrored
 * scene: the x axis of the camera is reversed. */
TEST(handedness_mirrors_the_camera)
{
    assert_ok(parse_text_with_line(1, "hand right"));
    check_vector_is_near(scene.camera.right, -1, 0, 0);
    check_vector_is_near(scene.camera.up, 0, 1, 0);
    assert_ok(parse_text_with_line(
        2, "camera orbit 0 1 0 distance 2 yaw 90 pitch 0"));
    check_vector_is_near(scene.camera.at, 2, 1, 0);
    /* here x points right and z away from the viewer */
    check_vector_is_near(scene.camera.right, 0, 0, 1);
    assert_ok(parse_text_with_line(2, "camera corners"));
    check_vector_is_near(scene.camera.forward, 0, 0, 1);
    check_vector_is_near(scene.camera.right, 1, 0, 0);
}

static const struct mesh_text {
    const char *text;
    int n; /* number of triangles; 0: the text is rejected with ERROR */
    const char *error;
} mesh_texts[] = {
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", 1, ""},
    {"v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0\nf 1// 2// 3//\r\n", 1, ""},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n 2 \\\n3\n", 1, ""},
    {"v 0.12345678901234567890 1e-300 0\nv 1 0 0\nv 0 1 0\nv 2 2 2\n"
     "v 3 3 3\ng x\nf -5 -4 -3 -2 -1\n",
     3, ""},
    {"", 0, "1:1: there is no face"},
    {"v 0 0\n", 0, "1:6: v needs 3 numbers, got 2"},
    {"v 0 0 x\n", 0, "1:7: 'x' is not a number"},
    {"v 0 0 nan\n", 0, "1:7: 'nan' is not a number"},
    {"v 0 0 1e13\n", 0, "1:7: numbers of a mesh must be at most 1e12"},
    {"v 0 0 0\nf 1 1\n", 0,
     "2:1: a face needs 3 or more corners; this face has 2"},
    {"v 0 0 0\nf 1 1 2\n", 0,
     "2:7: vertex 2 does not exist; 1 are defined above"},
    {"v 0 0 0\nf 1 1 0\n", 0,
     "2:7: vertex 0 does not exist; 1 are defined above"},
    {"v 0 0 0\nf 1 1 -2\n", 0,
     "2:7: vertex -2 does not exist; 1 are defined above"},
    {"v 0 0 0\nf 1 1 99999999999999999999\n", 0, "2:7: vertex 9999"},
    {"v 0 0 0\nf 1 1 1/1\n", 0, "2:7: texture coordinate 1 does not exist; 0"},
    {"v 0 0 0\nf 1 1 1//1\n", 0, "2:7: normal 1 does not exist; 0"},
    {"v 0 0 0\nf 1 1 1x\n", 0, "2:7: '1x' is not a corner; expected V, V/T"},
    {"v 0 0 0\nf 1 1 /1\n", 0, "2:7: a corner needs a vertex index (V)"},
    {"v 0 0 0\nf 1 1 1///\n", 0,
     "2:7: a corner has at most three indices, V/T/N"},
    {"v 0 0 0\nf 1 1 -\n", 0, "2:7: '-' is not a corner; expected V, V/T"},
};

TEST(parses_or_rejects_mesh_texts)
{
    static struct glint_mesh mesh;

    for (size_t i = 0; i < sizeof mesh_texts / sizeof *mesh_texts; i++) {
        const struct mesh_text *m = &mesh_texts[i];
        char wanted[200];
        const enum glint_status status =
            glint_mesh_read(&mesh, m->text, strlen(m->text), "m.obj", &fault);

        if (m->n) {
            if (status != GLINT_OK)
                fail_msg("'%s': %s", m->text, fault.text);
            assert_int_equal(mesh.n_triangles, m->n);
            free(mesh.triangle);
            continue;
        }
        assert_int_equal(status, GLINT_E_LENS);
        snprintf(wanted, sizeof wanted, "m.obj:%s", m->error);
        if (strncmp(fault.text, wanted, strlen(wanted)) != 0)
            fail_msg("'%s': %s", m->text, fault.text);
    }
}

/* Checks that a sun of given 'white' lights a surface to that value, whatever
 * its radius. */
TEST(white_of_a_sun_does_not_depend_on_its_radius)
{
    static const char *const text[] = {
        "light sun direction 0 1 0 white 1 .5 .25",
        "light sun direction 0 1 0 white 1 .5 .25 radius 5"};

    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        double sine;

        assert_ok(parse_text_with_line(4, text[i]));
        sine = sin(scene.light[0].radius_deg * GLINT_PI / 180);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(scene.light[0].colour[c] * sine * sine -
                             1. / (1 << c)) < 1e-12);
    }
}

/* Checks names of lights: those of `name`, and otherwise the first free one of
 * the kind. */
TEST(lights_have_distinct_names)
{
    static const char *const name[] = {"sun", "lamp2", "lamp", "lamp3",
                                       "key-light"};

    assert_ok(parse_text_with_line(
        5, "light lamp at 0 3 -2 colour 8 7 6 name lamp2\n"
           "light lamp at 0 3 -2 colour 8 7 6\n"
           "light lamp at 0 3 -2 colour 8 7 6\n"
           "light sun direction 0 1 0 white 1 1 1 name key-light"));
    assert_int_equal(scene.n_lights, 5);
    for (int i = 0; i < 5; i++)
        assert_string_equal(scene.light[i].name, name[i]);
}

/* Checks that the parser warns of a sun too faint for any code or far above
 * white, and of weights that make objects dark, but not of usual values. */
TEST(warns_of_invisible_settings)
{
    static const struct {
        int line;
        const char *text, *warning;
    } odd[] = {
        {4, "light sun direction 0 1 0 colour 3 2 1 radius .27", "4.5e+04"},
        {4, "light sun direction 0 1 0 colour 500 2 1 radius .27", ""},
        {4, "light sun direction 0 1 0 colour 0 0 0", ""},
        {4, "light sun direction 0 1 0 colour 5e4 5e4 5e4 radius 5",
         "surface to 3.8e+02 times display white; a colour of 132"},
        {4, "light sun direction 0 1 0 white 9 9 9 radius 5", ""},
        {4, "light sun direction 0 1 0 white 11 9 9", "surface to 11 times"},
        {7, "material red phong .1 .2 .1", "0.4; the surface absorbs"}};

    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        assert_ok(parse_text_with_line(odd[i].line, odd[i].text));
        assert_int_equal(!scene.warning[0], !odd[i].warning[0]);
        assert_non_null(strstr(scene.warning, odd[i].warning));
    }
}

TEST_CLOSE
{
    glint_description_free(&scene);
}
