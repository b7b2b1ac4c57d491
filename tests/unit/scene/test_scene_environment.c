/* SPDX-License-Identifier: MIT
 *
 * Tests environment maps and brushed metal in scenes. Images are compared with
 * the reference renderer in double precision. The lines for them in scene texts
 * and the brightness of highlights are checked, too.
 */
#include "base/blob.h"
#include "glint/scene/environment_bake.h"
#include "scenes/account.h"
#include "support/models/drawn_scene.h"
#include "reference/scenes/twin.h"
#include "support/test.h"

enum {
    SKY_WIDTH = 128,
    SKY_HEIGHT = 64,
    WIDTH = 160,
    HEIGHT = 90,
    PIXELS = WIDTH * HEIGHT
};

/* Paints the light of a sky over ground: the sky is smooth, with a lamp by a
 * window and a sun. With IS_DUSK, there are two more lamps. */
static void paint_sky(float sky[SKY_HEIGHT][SKY_WIDTH][3], bool is_dusk)
{
    for (int y = 0; y < SKY_HEIGHT; y++)
        for (int x = 0; x < SKY_WIDTH; x++) {
            const double a = x * .1, b = y * .1;
            const int is_sun = abs(x - 90) < 2 && abs(y - 14) < 2;
            const int is_lamp = (abs(x - 50) < 1 && abs(y - 24) < 1) ||
                                (is_dusk && (x == 20 || x == 110) && y == 28);
            const double light = (y < 32 ? .6 - .3 * is_dusk : .2) +
                                 .2 * sin(3 * a) * sin(4 * b) +
                                 (is_sun ? 400 : 0) + (is_lamp ? 150 : 0);

            for (int c = 0; c < 3; c++)
                sky[y][x][c] = (float)(light * (is_dusk ? 2 + c : 4 - c) / 4);
        }
}

/* Bakes the sky NAME, "9e5" or "dusk". */
static enum glint_status bake_sky(void *ctx, const char *name, uint8_t **data,
                                  size_t *bytes, struct glint_error *error)
{
    static float sky[SKY_HEIGHT][SKY_WIDTH][3];
    const struct glint_float_image picture = {SKY_WIDTH, SKY_HEIGHT,
                                              (float *)sky};
    struct glint_environment_options options;
    struct glint_environment_report report;

    (void)ctx;
    paint_sky(sky, strstr(name, "dusk") != NULL);
    glint_environment_defaults(&options);
    options.side_log2 = 6;
    return glint_environment_bake(&picture, &options, "sky", 1, data, bytes,
                                  &report, error);
}

static const struct glint_description_files files = {NULL,     NULL, NULL,
                                                     bake_sky, NULL, NULL};

static enum glint_status parse_scene_text(const char *text,
                                          struct glint_description *scene,
                                          struct glint_error *error)
{
    error->text[0] = '\0';
    return glint_description_parse(scene, text, strlen(text), "x.scene", &files,
                                   error);
}

static void open_scene_text(struct drawn *d, const char *text,
                            const struct scene_dials *dials)
{
    static const struct tool tool = {.name = "test"};

    drawn_open_scene(d, text, &files, dials, &tool);
}

/* ------------------------------------------- comparison with the reference */

#define STAGE                                                     \
    "camera fov 50 at 0 1 4 toward 0 .3 0\n"                      \
    "material steel ward specular .9 .8 .7 alpha .1 .1 diffuse "  \
    ".05 .05 .1\n"                                                \
    "material brushed ward specular .9 .9 .9 alpha .05 .3\n"      \
    "material old ward specular .5 .5 .5 alpha .2 .1 norm 1992\n" \
    "material white phong .1 .9 0\n"                              \
    "material mirror phong 0 .1 0 reflect .9\n"                   \
    "material glass phong 0 .1 0 pass .9 refract 1.5\n"

#define BALLS                                                       \
    "sphere a at -1.2 .5 0 radius .5 material steel\n"              \
    "sphere b at 0 .5 0 radius .5 turn 0 0 1 40 material brushed\n" \
    "sphere c at 1.2 .5 0 radius .5 material old\n"                 \
    "plane p at 0 0 0 normal .1 1 0 material "

TEST(image_equals_the_reference)
{
    static const struct {
        const char *what, *text;
    } row[] = {
        {"metals", STAGE "environment 9e5\n" BALLS "brushed\n"},
        {"metals, turned", STAGE "environment 9e5 turn 70 scale .6\n"
                                 "background environment\n" BALLS "white\n"},
        {"left", "hand left\n" STAGE "environment 9e5 turn -200 scale 1.7\n"
                 "background environment\nshadow on\n"
                 "sphere a at -1 .5 9 radius .5 material steel\n"
                 "sphere b at 1 .5 9 radius .5 material brushed\n"},
        {"mirrors", STAGE "environment 9e5\nbackground environment\n"
                          "sphere a at -1 .5 0 radius .5 material mirror\n"
                          "sphere b at 1 .5 0 radius .5 material glass\n"},
        {"inside glass",
         STAGE "material water phong 0 0 0 pass 1 refract 1.2\n"
               "material air phong 0 0 0 pass 1\n"
               "environment 9e5\nbackground environment\n"
               "sphere a at -1.2 .5 0 radius .7 material glass\n"
               "sphere b at -1.1 .6 0 radius .4 material steel\n"
               "sphere c at .4 .5 0 radius .8 material glass\n"
               "sphere d at .3 .6 .1 radius .5 material water\n"
               "sphere e at .3 .7 .2 radius .2 material air\n"
               "sphere f at 1.7 .5 0 radius .5 material air\n"
               "sphere g at 1.7 .7 0 radius .4 material glass\n"
               "plane p at 0 -.3 0 normal 0 1 0 material white\n"},
        {"shadows of glass",
         STAGE "light lamp at 1 3 2 colour 8 8 8\nshadow on\n"
               "light sun direction -1 1 .5 white .5 .5 .5\n"
               "background colour .2 .3 .4\n"
               "sphere a at -1.2 .5 0 radius .5 material glass shadow .2\n"
               "sphere b at -1.2 .5 0 radius .3 material mirror shadow 0\n"
               "sphere c at 1.2 .7 0 radius .5 material white\n"
               "plane p at 0 0 0 normal 0 1 0 material white\n"},
        {"lights alone", STAGE "light lamp at 1 3 2 colour 4 4 4 radius .2\n"
                               "light sun direction -1 1 .5 colour 2e4 2e4 "
                               "2e4\n" BALLS "old\n"}};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const double db = drawn_psnr_to_reference(row[i].text, &files);

        print_message("%s: %.1f dB\n", row[i].what, db);
        assert_true(db >= 60);
    }
}

/* ----------------------------------------- scene texts, changes of a scene */

/* Checks that an anisotropy ratio above 10 is clamped to 10, and that the
 * parser warns of this. */
TEST(clamped_anisotropy_is_warned_of)
{
    struct glint_description *s = test_free_later(malloc(sizeof *s));
    struct glint_error error;

    assert_ok(parse_scene_text(
        "material m ward specular .9 .9 .9 alpha .002 .4 norm 1992\n"
        "environment 9e5\nsphere s at 0 0 -3 radius 1 material m\n",
        s, &error));
    assert_non_null(strstr(s->warning, "limited to 10"));
    assert_true(fabs(s->material[0].alpha[0] - .04) < 1e-12);
    assert_true(s->material[0].norm == GLINT_DESCRIBED_1992);
    assert_true(s->n_lights > 0 &&
                strcmp(s->light[0].name, "environment") == 0);
    glint_description_free(s);
}

/* Checks that a scene is rejected if the program lacks the module that the
 * scene needs, or if the scene's environment is damaged. */
TEST(missing_module_is_rejected)
{
    static const struct scene_dials dials = {
        .width = 16, .height = 9, .edge_samples = 1, .shadow_points = 1};
    struct glint_scene_config cfg;
    struct glint_scene *scene;
    struct drawn d;
    void *mem;

    open_scene_text(&d, STAGE "environment 9e5\n" BALLS "white\n", &dials);
    cfg = d.frame.cfg;
    assert_int_equal(posix_memalign(&mem, 64, d.frame.bytes), 0);
    assert_ok(glint_scene_init(&scene, &cfg, &d.model, mem, d.frame.bytes));
    cfg.parts.wards = NULL;
    assert_string_equal(glint_scene_lacks(&cfg.parts, &d.model), "wards");
    assert_int_equal(glint_scene_bytes(&cfg, &d.model), 0);
    assert_int_equal(
        glint_scene_init(&scene, &cfg, &d.model, mem, d.frame.bytes),
        GLINT_E_UNSUPPORTED);
    cfg.parts.wards = &glint_scene_wards;
    cfg.ward_samples = 33;
    assert_int_equal(glint_scene_bytes(&cfg, &d.model), 0);
    cfg.ward_samples = 1;
    d.data[d.model.environment->file_at + 999] ^= 1;
    assert_int_equal(
        glint_scene_init(&scene, &cfg, &d.model, mem, d.frame.bytes),
        GLINT_E_FORMAT);
    free(mem);
    drawn_close_scene(&d);
}

/* Changes colours and alphas between frames. Checks that the image equals that
 * of a scene baked with the new values. */
TEST(b2_changed_materials_equal_a_new_scene)
{
    static const char *const text[2] = {
        STAGE "environment 9e5\nlight sun direction 1 1 1 colour 1e4 1e4 1e4\n"
              "material m ward specular .25 .5 .75 alpha .3 .06 diffuse .125 0 "
              ".125\nsphere a at 0 .5 0 radius .5 material m\n",
        STAGE "environment 9e5\nlight sun direction 1 1 1 colour 1e4 1e4 1e4\n"
              "material m ward specular .9 .9 .9 alpha .01 .01\n"
              "sphere a at 0 .5 0 radius .5 material m\n"};
    static const struct scene_dials dials = {
        .width = 64, .height = 36, .edge_samples = 4, .shadow_points = 1};
    static int32_t want[3 * 64 * 36], got[3 * 64 * 36];
    struct glint_scene_look look, now;
    struct drawn d;
    int material;

    open_scene_text(&d, text[0], &dials);
    drawn_draw_image(&d, 64, 36, want);
    material = glint_scene_find_material(&d.model, "m");
    assert_ok(glint_scene_get_look(d.frame.scene, material, &look));
    drawn_close_scene(&d);
    open_scene_text(&d, text[1], &dials);
    drawn_draw_image(&d, 64, 36, got);
    assert_memory_not_equal(got, want, sizeof want);
    assert_ok(glint_scene_set_look(d.frame.scene, material, &look));
    drawn_draw_image(&d, 64, 36, got);
    assert_memory_equal(got, want, sizeof want);
    assert_ok(glint_scene_get_look(d.frame.scene, material, &now));
    assert_memory_equal(&now, &look, sizeof now);
    look.alpha_q24[0] = 1 << 13;
    assert_int_equal(glint_scene_set_look(d.frame.scene, material, &look),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_look(d.frame.scene, -1, &now),
                     GLINT_E_ARGUMENT);
    material = glint_scene_find_material(&d.model, "white");
    assert_int_equal(glint_scene_set_look(d.frame.scene, material, &now),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_find_material(&d.model, "none"), -1);
    drawn_close_scene(&d);
}

#define STEERED(turn, radius, material)                            \
    STAGE "environment 9e5 turn " turn "\nshadow on\n"             \
          "background environment\nplane p at 0 0 0 normal 0 1 0 " \
          "material white\nsphere a at 0 .5 0 radius " radius      \
          " material " material "\n"

/* Changes material and radius of an object and rotates the environment between
 * frames. Checks that the image equals that of a scene baked with the new
 * values. */
TEST(b8_changed_objects_equal_a_new_scene)
{
    static const struct scene_dials dials = {
        .width = 64, .height = 36, .edge_samples = 4, .shadow_points = 4};
    static const int32_t right_q30[2] = {0, 1 << 30}, none_q30[2] = {9, 9};
    static int32_t want[3 * 64 * 36], got[3 * 64 * 36];
    struct glint_scene *s;
    struct drawn d;

    open_scene_text(&d, STEERED("90", ".25", "mirror"), &dials);
    drawn_draw_image(&d, 64, 36, want);
    drawn_close_scene(&d);
    open_scene_text(&d, STEERED("0", ".5", "steel"), &dials);
    s = d.frame.scene;
    drawn_draw_image(&d, 64, 36, got);
    assert_memory_not_equal(got, want, sizeof want);
    assert_ok(glint_scene_turn_environment(s, right_q30));
    assert_ok(glint_scene_set_radius(s, 1, d.model.object[1].radius / 2));
    assert_ok(glint_scene_set_material(
        s, 1, glint_scene_find_material(&d.model, "mirror")));
    drawn_draw_image(&d, 64, 36, got);
    assert_memory_equal(got, want, sizeof want);
    assert_int_equal(glint_scene_turn_environment(s, none_q30),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_radius(s, 0, 9), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_radius(s, 1, 0), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_radius(s, 2, 9), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_radius(s, 1, GLINT_SCENE_SPAN / 2 + 1),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_material(s, 1, 99), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_material(s, -1, 0), GLINT_E_ARGUMENT);
    drawn_draw_image(&d, 64, 36, got);
    assert_memory_equal(got, want, sizeof want);
    drawn_close_scene(&d);
    open_scene_text(
        &d, STAGE "light sun direction 1 1 1 colour 1 1 1\n" BALLS "white\n",
        &dials);
    assert_int_equal(glint_scene_turn_environment(d.frame.scene, right_q30),
                     GLINT_E_ARGUMENT);
    drawn_close_scene(&d);
}

#define UNDER(environments) \
    STAGE environments "shadow on\nbackground environment\n" BALLS "white\n"

/* Changes the visible environment and its brightness between frames. Checks
 * that the image equals that of a scene that has only this environment. */
TEST(b8_changed_environment_equals_a_new_scene)
{
    static const struct scene_dials dials = {
        .width = 64, .height = 36, .edge_samples = 4, .shadow_points = 4};
    static const char *const alone[3] = {UNDER("environment 9e5 turn 30\n"),
                                         UNDER("environment dusk scale .5\n"),
                                         UNDER("environment dusk scale 3\n")};
    static int32_t want[3][3 * 64 * 36], got[3 * 64 * 36];
    const struct glint_real three = {3 << 29, -29}, none = {0, 0};
    struct glint_scene *s;
    struct drawn d;

    for (int i = 0; i < 3; i++) {
        open_scene_text(&d, alone[i], &dials);
        assert_int_equal(d.model.header->n_lights, i ? 4 : 2);
        drawn_draw_image(&d, 64, 36, want[i]);
        drawn_close_scene(&d);
    }
    open_scene_text(&d,
                    UNDER("environment 9e5 turn 30\n"
                          "environment sub/dusk.exr scale .5\n"),
                    &dials);
    s = d.frame.scene;
    assert_int_equal(d.model.header->n_lights, 4);
    assert_int_equal(glint_scene_find_environment(&d.model, "dusk"), 1);
    for (int round = 0; round < 2; round++) {
        assert_ok(glint_scene_set_environment(s, 0));
        drawn_draw_image(&d, 64, 36, got);
        assert_memory_equal(got, want[0], sizeof got);
        assert_ok(glint_scene_set_environment(s, 1));
        drawn_draw_image(&d, 64, 36, got);
        assert_memory_equal(got, want[1], sizeof got);
        assert_ok(glint_scene_scale_environment(s, three));
        drawn_draw_image(&d, 64, 36, got);
        assert_memory_equal(got, want[2], sizeof got);
    }
    assert_int_equal(glint_scene_set_environment(s, 2), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_set_environment(s, -1), GLINT_E_ARGUMENT);
    assert_int_equal(glint_scene_scale_environment(s, none), GLINT_E_ARGUMENT);
    drawn_draw_image(&d, 64, 36, got);
    assert_memory_equal(got, want[2], sizeof got);
    drawn_close_scene(&d);
}

/* Opens the file of D again after it was modified. Returns the error, or
 * NULL. */
static const char *find_error_of_modified_file(struct drawn *d)
{
    struct glint_scene_model model;
    const char *reason = "";

    glint_blob_set_size_and_checksum(d->data, d->bytes);
    assert_int_equal(glint_scene_open(&model, d->data, d->bytes, &reason),
                     GLINT_E_FORMAT);
    return reason;
}

/* Sets FIELD to VALUE, checks that opening fails with REASON, and restores
 * FIELD. */
#define REFUSES(field, value, reason)                                 \
    do {                                                              \
        const int32_t was = (int32_t)(field);                         \
        (field) = (value);                                            \
        assert_string_equal(find_error_of_modified_file(&d), reason); \
        memcpy(&(field), &was, sizeof(field));                        \
    } while (0)

TEST(rejects_invalid_environment_tables)
{
    static const struct scene_dials dials = {.width = 16, .height = 9};
    static const char range[] = "damaged scene: the environment's rotation or "
                                "intensity scale is invalid";
    struct glint_scene_environment *e;
    struct glint_scene_light *light;
    struct drawn d;

    open_scene_text(&d, UNDER("environment 9e5\n"), &dials);
    e = (void *)(d.data + d.model.header->environment_at);
    light = (void *)(d.data + d.model.header->light_at);
    REFUSES(e->name[0], '\0',
            "damaged scene: an environment's name is empty, unterminated or "
            "not printable");
    REFUSES(e->turn_q30[0], 1 << 29, range);
    REFUSES(e->scale.mantissa, 0, range);
    REFUSES(e->scale.mantissa, -e->scale.mantissa, range);
    REFUSES(e->file_bytes, 1 << 28,
            "damaged scene: a table lies outside the file");
    REFUSES(e->file_bytes, e->file_bytes - 1,
            "damaged scene: a table lies outside the file");
    memset(light[1].toward_q30, 0, sizeof light[1].toward_q30);
    light[1].radius = 0;
    REFUSES(light[1].kind, GLINT_LIGHT_LAMP,
            "damaged scene: a light of the environment is not of the type sun");
    drawn_close_scene(&d);
}

/* Checks that environments with the same name are rejected, and too many
 * environments. */
TEST(rejects_ambiguous_environment_names)
{
    char text[32 * 17 + 1] = "";
    struct glint_description description;
    struct glint_error error;

    assert_int_equal(
        parse_scene_text("environment a/9e5.hdr\nenvironment 9e5\n",
                         &description, &error),
        GLINT_E_LENS);
    assert_string_equal(error.text,
                        "x.scene:2:13: environment '9e5' is already "
                        "defined; rename one of both files");
    for (int i = 0; i < 17; i++)
        sprintf(text + strlen(text), "environment sky%d\n", i);
    assert_int_equal(parse_scene_text(text, &description, &error),
                     GLINT_E_LENS);
    assert_string_equal(error.text, "x.scene:17:13: more than 16 environments");
}

/* -------------------------------------------------------------- highlights */

/* Returns the total light of an image of a ball 40 pixels wide, moved by (DX,
 * DY) pixels. The ball is of almost mirror-like metal and lit by a sun. */
static double sum_light_of_metal_ball(struct drawn *d, double dx, double dy)
{
    enum { SIDE = 64 };
    static int32_t light_q20[3 * SIDE * SIDE];
    const double pixel = 2 * tan(10 * GLINT_PI / 180) * 4 / SIDE;
    const struct glint_scene_object *o = &d->model.object[0];
    const double steps = ldexp(pixel, d->model.header->unit_log2);
    const int32_t at[3] = {o->at[0] + (int32_t)(dx * steps),
                           o->at[1] + (int32_t)(dy * steps), o->at[2]};
    double sum = 0;

    assert_ok(glint_scene_set_pose(d->frame.scene, 0, at, o->turn_q30));
    drawn_draw_image(d, SIDE, SIDE, light_q20);
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += light_q20[3 * i + 1] * 0x1p-20;
    return sum;
}

/* Checks that the light of a sun's highlight smaller than a pixel is steady: it
 * changes by at most 5 % while the highlight moves by fractions of a pixel. */
TEST(subpixel_highlight_is_steady)
{
    static const struct scene_dials dials = {
        .width = 64, .height = 64, .edge_samples = 1, .shadow_points = 1};
    double least = HUGE_VAL, most = 0;
    struct drawn d;

    open_scene_text(&d,
                    "camera fov 20 at 0 0 4 toward 0 0 0\n"
                    "material m ward specular .9 .9 .9 alpha .002 .002\n"
                    "light sun direction .5 .6 1 colour 2e4 2e4 2e4\n"
                    "sphere s at 0 0 0 radius .44 material m\n",
                    &dials);
    for (int k = 0; k < 49; k++) {
        const double sum = sum_light_of_metal_ball(&d, k % 7 / 7., k / 7 / 7.);

        least = fmin(least, sum);
        most = fmax(most, sum);
    }
    drawn_close_scene(&d);
    print_message("highlight: %.4f to %.4f\n", least, most);
    assert_true(least > 0 && most < 1.05 * least);
}

/* Checks the number of environment lookups per metal object in the scene
 * statistics. */
TEST(lookups_are_counted_per_object)
{
    static const struct scene_dials dials = {.width = 32,
                                             .height = 32,
                                             .edge_samples = 1,
                                             .shadow_points = 1,
                                             .ward_samples = 9};
    static int32_t light_q20[3 * 32 * 32];
    struct scene_account account;
    struct drawn d;

    open_scene_text(&d, STAGE "environment 9e5\n" BALLS "white\n", &dials);
    drawn_draw_image(&d, 32, 32, light_q20);
    assert_ok(scene_account_collect_costs(&account, &d.frame));
    /* objects 0 .. 3: steel, brushed, old, white */
    for (int i = 0; i < 4; i++) {
        const int64_t *n = account.objects[i].count;

        assert_true(n[GLINT_SCENE_SHADED] > 0);
        assert_int_equal(n[GLINT_SCENE_LOOKUPS] % 9, 0);
        /* At the rim of a ball, a pixel may count as shaded although the ray
         * through its centre misses the ball. */
        assert_true(i == 3 ? n[GLINT_SCENE_LOOKUPS] == 0
                           : 20 * n[GLINT_SCENE_LOOKUPS] >
                                 9 * 19 * n[GLINT_SCENE_SHADED]);
    }
    scene_account_free(&account);
    drawn_close_scene(&d);
}
