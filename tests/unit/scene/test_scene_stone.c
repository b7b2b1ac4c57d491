/* SPDX-License-Identifier: MIT
 *
 * Tests translucent objects in scenes. Images are compared with the reference
 * renderer in double precision, and must be bit-identical for all workers and
 * tiles. Also tests incremental updates of light maps, extreme values, and
 * errors.
 */
#include "glint/scene/environment_bake.h"
#include "support/models/drawn_scene.h"
#include "support/models/scene_builder.h"
#include "support/models/stone_builder.h"
#include "support/shuffle.h"
#include "reference/scenes/twin.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

/* Parameters of the medium that build_medium_by_name() builds, and the mesh of
 * the scene. */
static int side = 64, kernel = 15;
static double albedo = .9;
static const char *mesh_text;

/* A cube with one texture chart per face; gutters separate the charts. */
static const char cube_text[] =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
    "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "vt .02 .02\nvt .31 .02\nvt .31 .31\nvt .02 .31\n"
    "vt .35 .02\nvt .64 .02\nvt .64 .31\nvt .35 .31\n"
    "vt .68 .02\nvt .97 .02\nvt .97 .31\nvt .68 .31\n"
    "vt .02 .35\nvt .31 .35\nvt .31 .64\nvt .02 .64\n"
    "vt .35 .35\nvt .64 .35\nvt .64 .64\nvt .35 .64\n"
    "vt .68 .35\nvt .97 .35\nvt .97 .64\nvt .68 .64\n"
    "f 5/1 6/2 7/3 8/4\nf 6/5 2/6 3/7 7/8\nf 2/9 1/10 4/11 3/12\n"
    "f 1/13 5/14 8/15 4/16\nf 8/17 7/18 3/19 4/20\nf 1/21 2/22 6/23 5/24\n";

static const char quad_text[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
                                "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                "f 1/1 2/2 3/3 4/4\n";

/* Builds the translucent medium of a scene text, with the parameters above.
 * NAME is the file name in the scene text. */
static enum glint_status build_medium_by_name(void *ctx, const char *name,
                                              uint8_t **data, size_t *bytes,
                                              struct glint_error *error)
{
    struct built_stone b;

    (void)ctx;
    (void)error;
    build_translucent_model(&b,
                            name[0] == 'f'   ? GLINT_SCATTER_FACTORED
                            : name[0] == 'c' ? GLINT_SCATTER_CLUSTERED
                                             : GLINT_SCATTER_ALBEDO,
                            side, kernel, albedo);
    *data = b.data;
    *bytes = b.bytes;
    b.data = NULL;
    free_translucent_model(&b);
    return GLINT_OK;
}

/* Bakes a sky that is brighter at the top. */
static enum glint_status bake_sky(void *ctx, const char *name, uint8_t **data,
                                  size_t *bytes, struct glint_error *error)
{
    static float sky[32][64][3];
    const struct glint_float_image picture = {64, 32, (float *)sky};
    struct glint_environment_options options;
    struct glint_environment_report report;

    (void)ctx;
    (void)name;
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 64; x++)
            for (int c = 0; c < 3; c++)
                sky[y][x][c] = (float)((y < 16 ? .5 : .15) +
                                       .2 * sin(x * .2) * (c + 1) / 3);
    glint_environment_defaults(&options);
    options.side_log2 = 5;
    options.max_lights = 0;
    return glint_environment_bake(&picture, &options, "sky", 1, data, bytes,
                                  &report, error);
}

static const struct glint_description_files files = {
    &mesh_text, scene_read_mesh_text, NULL, bake_sky,
    NULL,       build_medium_by_name};

static enum glint_status parse_scene_text(const char *text,
                                          struct glint_description *s,
                                          struct glint_error *error)
{
    error->text[0] = '\0';
    return glint_description_parse(s, text, strlen(text), "x.scene", &files,
                                   error);
}

static void open_scene_text(struct drawn *d, const char *text,
                            const struct scene_dials *dials, struct tool *tool)
{
    drawn_open_scene(d, text, &files, dials, tool);
}

static void draw_translucent_scene(struct drawn *d, int32_t *light_q20)
{
    drawn_draw_image(d, WIDTH, HEIGHT, light_q20);
}

static const struct scene_dials one_sample = {
    .width = WIDTH, .height = HEIGHT, .edge_samples = 1, .shadow_points = 1};

#define LOOKS                                                                 \
    "material c translucent c.glint\n"                                        \
    "material f translucent f.glint coat ward specular .05 .05 .05 alpha .1 " \
    ".2\n"                                                                    \
    "material a translucent a.glint fresnel off colour 1 .8 .6\n"             \
    "material grey phong .05 .6 .35\n"

/* Camera and sun of STAGE mirrored to negative z. */
#define STAGE_LEFT                                \
    "camera fov 40 at 0 1.4 -4.5 toward 0 .4 0\n" \
    "light sun direction .5 .7 -.6 colour 4e4 3.6e4 3e4\n" LOOKS

#define STAGE                                               \
    "camera fov 40 at 0 1.4 4.5 toward 0 .4 0\nshadow on\n" \
    "light sun direction .5 .7 .6 colour 4e4 3.6e4 3e4\n"   \
    "light lamp at -1.5 2 1.5 colour 1 1.2 2 radius .1\n" LOOKS

#define BALLS                                                      \
    "sphere a at -1.1 .5 0 radius .5 turn 1 1 0 40 material c\n"   \
    "sphere b at 0 .5 0 radius .5 material f\n"                    \
    "sphere c at 1.1 .5 .2 radius .5 turn 0 1 0 -100 material a\n" \
    "plane p at 0 0 0 normal 0 1 0 material grey\n"

/* ------------------------------------------- comparison with the reference */

/* Material with a coat whose reflectance would exceed 1 at grazing angles. */
#define BRIGHT(specular)                                                 \
    STAGE "material b translucent f.glint coat ward specular " #specular \
          " " #specular " " #specular " alpha .1 .1\nenvironment sky\n"
#define BRIGHT_BALL "sphere a at 0 .6 0 radius .8 material b\n"

TEST(image_equals_the_reference)
{
    static const struct {
        const char *what, *text, *mesh;
    } row[] = {
        {"balls", STAGE BALLS, NULL},
        {"balls under a sky", STAGE "environment sky turn 30\n" BALLS, NULL},
        {"balls, left",
         "hand left\n" STAGE_LEFT
         "sphere a at -.6 .5 0 radius .5 turn 0 0 1 20 material f\nsphere b at "
         ".6 .5 0 radius .5 material c\n",
         NULL},
        {"mirrors all at the rim", BRIGHT(.7) BRIGHT_BALL, NULL},
        {"cube",
         STAGE "mesh m cube.obj scale .5 at 0 .5 0 turn 0 1 0 30 material "
               "c\nplane p at 0 0 0 normal 0 1 0 material grey\n",
         cube_text},
        {"on a catcher",
         STAGE "sphere b at 0 .5 0 radius .5 material f\n"
               "plane p at 0 0 0 normal 0 1 0 catcher .5\n",
         NULL},
        {"quad",
         STAGE "mesh m quad.obj at 0 .2 0 material f\n"
               "sphere b at 0 .7 0 radius .3 material grey\n",
         quad_text}};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        double db;

        mesh_text = row[i].mesh;
        db = drawn_psnr_to_reference(row[i].text, &files);
        print_message("%s: %.1f dB\n", row[i].what, db);
        assert_true(db >= 60);
    }
}

/* -------------------------------------------------------------- light maps */

/* Returns the PSNR between A and B, dB. */
static double compute_psnr(const int32_t *a, const int32_t *b)
{
    double square = 0;

    for (int i = 0; i < 3 * PIXELS; i++)
        square += pow((a[i] - b[i]) * 0x1p-20, 2);
    return -10 * log10(square / (3 * PIXELS) + 1e-12);
}

/* Checks the seams of light maps. The texture repeats twice around a ball, and
 * each repetition is symmetric. So quarter turns of the ball, which show the
 * seam of the map or its interior, must not change the image. */
TEST(seams)
{
    static int32_t first[3 * PIXELS], light[3 * PIXELS];
    static const char model[] = "cfa";
    struct tool tool = {.name = "test"};

    for (int k = 0; k < 3 * 4; k++) {
        char text[900];
        struct drawn d;

        snprintf(text, sizeof text,
                 STAGE
                 "sphere s at 0 .5 0 radius .9 turn 0 1 0 %d material %c\n",
                 90 * (k % 4), model[k / 4]);
        open_scene_text(&d, text, &one_sample, &tool);
        draw_translucent_scene(&d, k % 4 ? light : first);
        drawn_close_scene(&d);
        if (k % 4)
            assert_true(compute_psnr(light, first) > 75);
    }
}

/* Checks texture charts that are stretched, sheared or mirrored: each texel
 * must be lit and drawn at its position on the surface. */
TEST(stretch)
{
    static const char *const places[] = {
        "vt 0 .4\nvt 1 .4\nvt 1 .6\nvt 0 .6\n",
        "vt .3 0\nvt .8 .1\nvt .7 1\nvt .2 .9\n",
        "vt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\n"};

    for (int i = 0; i < 3; i++) {
        char mesh[200];
        double db;

        snprintf(
            mesh, sizeof mesh,
            "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n%sf 1/1 2/2 3/3 4/4\n",
            places[i]);
        mesh_text = mesh;
        db = drawn_psnr_to_reference(
            STAGE "mesh m quad.obj at 0 .2 0 material c\n"
                  "sphere b at 0 .7 0 radius .3 material grey\n",
            &files);
        print_message("stretched %d: %.1f dB\n", i, db);
        assert_true(db >= 60);
    }
}

/* Checks a kernel of 63 x 63 texels on a map of 32 x 32 texels. The kernel
 * extends across all edges of the map, and twice around the pole of a ball. */
TEST(kernel_beyond_map)
{
    side = 32;
    kernel = 63;
    mesh_text = quad_text;
    for (int i = 0; i < 3; i++) {
        char text[900];
        double db;

        snprintf(text, sizeof text,
                 STAGE "mesh m quad.obj at 0 .2 0 material %c\n"
                       "sphere b at 0 .9 0 radius .5 material %c\n",
                 "cfa"[i], "cfa"[i]);
        db = drawn_psnr_to_reference(text, &files);
        print_message("beyond the map, %c: %.1f dB\n", "cfa"[i], db);
        assert_true(db >= 60);
    }
    side = 64;
    kernel = 15;
}

/* -------------------------------------------------------------- scheduling */

#define MIXED                       \
    STAGE "environment sky\n" BALLS \
          "mesh m cube.obj scale .2 at .5 .2 .9 turn 0 1 0 30 material c\n"

/* Checks that threads, tiles, kernels and the order of updates do not change
 * any bit of the image. */
TEST(image_is_bit_identical)
{
    static int32_t want[3 * PIXELS], got[3 * PIXELS];
    struct shuffle shuffle;
    struct tool tool = {.name = "test", .sets_off = ~0U};
    struct drawn d;

    init_shuffled_workers(&shuffle, 3, 7);
    mesh_text = cube_text;
    open_scene_text(&d, MIXED, &one_sample, &tool);
    draw_translucent_scene(&d, want);
    drawn_close_scene(&d);
    for (int k = 0; k < 3; k++) {
        struct scene_dials dials = one_sample;

        tool.sets_off = k == 1 ? ~0U : 0;
        tool.workers = k ? &shuffle.workers : NULL;
        dials.tile_log2 = 4 + k;
        open_scene_text(&d, MIXED, &dials, &tool);
        draw_translucent_scene(&d, got);
        drawn_close_scene(&d);
        assert_memory_equal(got, want, sizeof want);
    }
}

/* ----------------------------------------------------- incremental updates */

/* Rotates the camera about the origin by ANGLE, radians, and draws the
 * scene. */
static void draw_from_rotated_camera(struct drawn *d, double angle,
                                     int32_t *light_q20)
{
    const double unit = ldexp(1, d->model.header->unit_log2);
    const int32_t s = (int32_t)lrint(0x1p30 * sin(angle));
    const int32_t c = (int32_t)lrint(0x1p30 * cos(angle));
    const int32_t axis_q30[3][3] = {{c, 0, -s}, {0, 1 << 30, 0}, {s, 0, c}};
    const int32_t at[3] = {(int32_t)(-4 * unit * sin(angle)),
                           (int32_t)(.6 * unit),
                           (int32_t)(-4 * unit * cos(angle))};

    assert_ok(glint_scene_set_camera(d->frame.scene, at, axis_q30));
    draw_translucent_scene(d, light_q20);
}

/* Rotates the camera step by step. Checks that each texel is computed once,
 * when it becomes visible, and that all images equal those of a newly opened
 * scene. */
TEST(updates)
{
    static int32_t turned[3 * PIXELS], fresh[3 * PIXELS];
    struct tool tool = {.name = "test"};
    struct drawn d, other;
    int first, sum = 0;

    mesh_text = cube_text;
    side = 128;
    open_scene_text(&d, MIXED, &one_sample, &tool);
    draw_from_rotated_camera(&d, 0, turned);
    first = d.frame.map_texels;
    for (int k = 1; k <= 12; k++) {
        draw_from_rotated_camera(&d, k * .5, turned);
        sum += d.frame.map_texels;
        open_scene_text(&other, MIXED, &one_sample, &tool);
        draw_from_rotated_camera(&other, k * .5, fresh);
        assert_memory_equal(turned, fresh, sizeof fresh);
        assert_true(other.frame.map_texels >= d.frame.map_texels);
        drawn_close_scene(&other);
    }
    print_message("texels: %d at first, %d in a turn\n", first, sum);
    /* light maps of the three balls have 256 x 128 texels, that of the cube has
     * 128 x 128 */
    assert_true(first < 75000 && sum > 20000 && first + sum <= 7 << 14);
    draw_translucent_scene(&d, turned);
    assert_int_equal(d.frame.map_texels, 0);
    drawn_close_scene(&d);
    side = 64;
}

/* Checks that replacing a coat gives the image of a scene that had the new coat
 * from the start. */
TEST(changed_coat_equals_a_new_scene)
{
    static int32_t changed[3 * PIXELS], fresh[3 * PIXELS];
    /* index of the material that follows the materials of LOOKS */
    enum { MATERIAL = 4 };
    struct tool tool = {.name = "test"};
    struct glint_scene_look look;
    struct drawn d;

    open_scene_text(&d, BRIGHT(.75) BRIGHT_BALL, &one_sample, &tool);
    draw_translucent_scene(&d, fresh);
    assert_ok(glint_scene_get_look(d.frame.scene, MATERIAL, &look));
    drawn_close_scene(&d);
    open_scene_text(&d, BRIGHT(.25) BRIGHT_BALL, &one_sample, &tool);
    draw_translucent_scene(&d, changed);
    assert_true(memcmp(changed, fresh, sizeof fresh) != 0);
    assert_ok(glint_scene_set_look(d.frame.scene, MATERIAL, &look));
    draw_translucent_scene(&d, changed);
    assert_memory_equal(changed, fresh, sizeof fresh);
    drawn_close_scene(&d);
}

/* Checks that the frame statistics count the cost of a light map in the frame
 * that computes it, and not again. */
TEST(light_maps_are_counted_once)
{
    static int32_t light[3 * PIXELS];
    static int16_t seen[PIXELS];
    struct tool tool = {.name = "test"};
    struct glint_scene_part object[2], all;
    struct drawn d;

    open_scene_text(&d,
                    "camera fov 30 at 0 0 4 toward 0 0 0\nlight lamp at 3 3 9 "
                    "colour 9 9 9\nmaterial m translucent c.glint\nmaterial g "
                    "phong .1 .7 .2\nsphere s at 0 0 0 radius .5 material m\n"
                    "sphere t at .8 0 0 radius .2 material g\n",
                    &one_sample, &tool);
    draw_from_rotated_camera(&d, 0, light);
    glint_scene_account(d.frame.scene, object, &all, seen);
    assert_int_equal(object[0].count[GLINT_SCENE_TEXELS],
                     4 * object[0].count[GLINT_SCENE_SHADED]);
    assert_int_equal(object[0].count[GLINT_SCENE_SHADOWS], 0);
    assert_true(d.frame.map_texels > 0);
    draw_translucent_scene(&d, light);
    assert_int_equal(d.frame.map_texels, 0);
    drawn_close_scene(&d);
}

/* ---------------------------------------------------------------- extremes */

static double find_max_light(const int32_t *light_q20)
{
    double most = 0;

    for (int i = 0; i < 3 * PIXELS; i++)
        most = fmax(most, light_q20[i] * 0x1p-20);
    return most;
}

/* Checks that a fully absorbing medium is black, and that a medium without
 * absorption returns at most the light that it receives, for any power of the
 * light. */
TEST(albedo_0_and_1)
{
    static int32_t light[3 * PIXELS];
    static const char *const model[] = {"c", "f", "a"};
    struct tool tool = {.name = "test"};

    for (int k = 0; k < 3 * 8; k++) {
        const double power = pow(10, 2 * (k % 8) - 6);
        char text[400];
        struct drawn d;

        albedo = k % 2;
        kernel = k % 3 ? 63 : 1;
        side = 32 << k % 3;
        snprintf(
            text, sizeof text,
            "camera fov 30 at 0 0 4 toward 0 0 0\nlight lamp at 0 0 40 colour "
            "%.9g %.9g %.9g\nmaterial m translucent %s.glint fresnel off\n"
            "sphere s at 0 0 0 radius 1 material m\n",
            fmin(1600 * power, 1e9), fmin(1600 * power, 1e9),
            fmin(1600 * power, 1e9), model[k / 8]);
        open_scene_text(&d, text, &one_sample, &tool);
        draw_translucent_scene(&d, light);
        if (albedo == 0) {
            assert_true(find_max_light(light) == 0);
        } else {
            /* near the poles, where texels are narrow, light accumulates */
            assert_true(find_max_light(light) <=
                        fmin(1.3 * 1.06 * fmin(power, 6.2e5), 32768) + 1e-4);
            if (power > 1e-2)
                assert_true(find_max_light(light) > .3 * fmin(power, 1000));
        }
        drawn_close_scene(&d);
    }
    albedo = .9;
    kernel = 15;
    side = 64;
}

/* --------------------------------------------------------- rejected scenes */

static void expect_scene_is_rejected(const char *text, const char *reason)
{
    struct glint_description *s = test_free_later(malloc(sizeof *s));
    struct glint_scene_bake_report report;
    struct glint_error error;
    unsigned char *data = NULL;
    size_t bytes;

    if (parse_scene_text(text, s, &error) == GLINT_OK) {
        if (glint_scene_bake(s, "x", 1, &data, &bytes, &report, &error) ==
            GLINT_OK) {
            snprintf(error.text, sizeof error.text, "%s", s->warning);
            free(data);
        }
        glint_description_free(s);
    }
    if (!strstr(error.text, reason))
        fail_msg("'%s' is not in '%s'", reason, error.text);
}

TEST(rejects_unsuitable_meshes)
{
    static const char stretched[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
                                    "vt 0 0\nvt .4 0\nvt .4 1\nvt 0 1\n"
                                    "f 1/1 2/2 3/3 4/4\n";
    static const char outside[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\n"
                                  "vt 0 0\nvt 2 0\nvt 1 1\nf 1/1 2/2 3/3\n";
    static const char twice[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
                                "vt 0 0\nvt 1 0\nvt 1 1\n"
                                "f 1/1 2/2 3/3\nf 3/1 4/2 1/3\n";
    static const char bare[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\n";
    static const char point[] = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nvt .5 .5\n"
                                "f 1/1 2/1 3/1\n";

    expect_scene_is_rejected(STAGE "plane p at 0 0 0 normal 0 1 0 material c\n",
                             "an infinite plane cannot");
    expect_scene_is_rejected(STAGE "triangle t 0 0 0 1 0 0 0 1 0 material c\n",
                             "has no texture coordinates");
    mesh_text = bare;
    expect_scene_is_rejected(
        STAGE "mesh m a.obj at 0 0 0 material c\n",
        "x.scene:9:8: material c is translucent, but a face has no");
    mesh_text = outside;
    expect_scene_is_rejected(STAGE "mesh m a.obj at 0 0 0 material c\n",
                             "must be 0 to 1, not 2");
    mesh_text = twice;
    expect_scene_is_rejected(STAGE "mesh m a.obj at 0 0 0 material c\n",
                             "belong to two places");
    mesh_text = point;
    expect_scene_is_rejected(STAGE "mesh m a.obj at 0 0 0 material c\n",
                             "covers no texel");
    mesh_text = stretched;
    expect_scene_is_rejected(STAGE "mesh m a.obj at 0 0 0 material c\n",
                             "stretched up to 1.58");
}

/* Checks that the error of a program without the required module names the
 * module. */
TEST(missing_module_is_named)
{
    struct tool tool = {.name = "test"};
    struct glint_scene_config cfg;
    struct drawn d;

    open_scene_text(&d, STAGE BALLS, &one_sample, &tool);
    cfg = d.frame.cfg;
    assert_true(glint_scene_bytes(&cfg, &d.model) > 0);
    cfg.parts.stones = NULL;
    assert_string_equal(glint_scene_lacks(&cfg.parts, &d.model), "stones");
    assert_int_equal(glint_scene_bytes(&cfg, &d.model), 0);
    drawn_close_scene(&d);
}
