/* SPDX-License-Identifier: MIT
 *
 * Tests extreme scenes: grazing views and lights, sizes from 1e-6 to 1e6,
 * light powers from 1e-6 to 1e9, objects behind and around the camera, images
 * of one pixel and of 8192 pixels in a row. The integer renderer is compared
 * with the reference renderer at one sample per pixel, except on silhouettes
 * and shadow edges.
 */
#include "glint/scene/bake.h"
#include "scenes/scene_frame.h"
#include "reference/scenes/twin.h"
#include "support/extreme.h"
#include "support/test.h"

/* light at which the run time saturates */
#define MOST_LIGHT 2047.0

/* Errors of one image, or the largest errors of several images. */
struct outcome {
    /* PSNR of the light, clamped to 1, in pixels whose neighbours show the same
     * object */
    double db;
    double wrong; /* fraction of all pixels that show another object */
    double share; /* max error of the light divided by (light + 1/255) */
};

static void parse_scene_text(struct glint_description *scene, const char *text)
{
    static const struct glint_description_files none = {NULL, NULL, NULL,
                                                        NULL, NULL, NULL};
    struct glint_error error = {""};

    if (glint_description_parse(scene, text, strlen(text), "x.scene", &none,
                                &error) != GLINT_OK)
        fail_msg("%s", error.text);
}

/* Draws SCENE with the integer renderer in linear light. */
static void draw_scene_linear(const struct glint_description *scene, int width,
                              int height, int32_t *light_q20)
{
    const struct tool tool = {.name = "extremes"};
    const struct scene_dials dials = {.width = width,
                                      .height = height,
                                      .edge_samples = 1,
                                      .shadow_points = 1};
    struct glint_image image =
        glint_image_over(light_q20, GLINT_LINEAR_Q20, width, height);
    struct glint_scene_bake_report report;
    struct glint_scene_model model;
    struct scene_frame frame;
    struct glint_error error;
    const char *reason;
    unsigned char *data;
    size_t bytes;

    if (glint_scene_bake(scene, "x", 1, &data, &bytes, &report, &error) !=
        GLINT_OK)
        fail_msg("%s", error.text);
    assert_ok(glint_scene_open(&model, data, bytes, &reason));
    assert_ok(scene_frame_open(&frame, &tool, &model, &dials));
    assert_ok(scene_frame_draw(&frame, &image));
    scene_frame_close(&frame);
    free(data);
}

/* Returns whether the reference shows the same object at pixel (X, Y) and at
 * its neighbours. */
static int is_inside_object(const struct twin_pixel *p, int width, int height,
                            int x, int y)
{
    const struct twin_pixel *const here = &p[y * width + x];

    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            const struct twin_pixel *there;

            if (u < 0 || v < 0 || u >= width || v >= height)
                continue;
            there = &p[v * width + u];
            if ((there->cover > 0) != (here->cover > 0) ||
                fabs((double)there->rgb[1] - (double)here->rgb[1]) >
                    .1 * (double)here->rgb[1] + .01)
                return 0;
        }
    return 1;
}

/* Draws TEXT at WIDTH x HEIGHT with both renderers. Raises the errors in WORST
 * to the errors of this image if these are larger. */
static void compare_renderers(const char *text, int width, int height,
                              struct outcome *worst)
{
    const struct twin_view view = {width, height, 0, 1};
    const size_t n = (size_t)width * (size_t)height;
    struct glint_description *scene = malloc(sizeof *scene);
    struct twin_pixel *exact = malloc(n * sizeof *exact);
    int32_t *light_q20 = calloc(3 * n, sizeof *light_q20);
    double square = 0, db;
    int inside = 0, wrong = 0;
    struct twin twin;

    assert_true(scene && exact && light_q20);
    parse_scene_text(scene, text);
    draw_scene_linear(scene, width, height, light_q20);
    assert_ok(reference_open(&twin, scene));
    reference_render_image(&twin, &view, NULL, exact);
    reference_close(&twin);
    for (size_t i = 0; i < n; i++) {
        const int x = (int)i % width, y = (int)i / width;
        const double want = fmin((double)exact[i].rgb[1], MOST_LIGHT);
        const double got = ldexp(light_q20[3 * i + 1], -20);

        wrong += (want > .004) != (got > .004) && fabs(want - got) > .004;
        if (!is_inside_object(exact, width, height, x, y))
            continue;
        inside++;
        square += pow(fmin(got, 1) - fmin(want, 1), 2);
        worst->share = fmax(worst->share, fabs(got - want) / (want + 1. / 255));
    }
    db = -10 * log10((square + 1e-12) / (inside + 1e-12));
    if (inside)
        worst->db = fmin(worst->db, db);
    worst->wrong = fmax(worst->wrong, wrong / (double)n);
    glint_description_free(scene);
    free(scene);
    free(exact);
    free(light_q20);
}

/* Prints and checks the errors in WORST against their limits, for scenes of
 * type WHAT. */
static void check_worst_errors(const char *what, const struct outcome *worst)
{
    char name[96];

    snprintf(name, sizeof name, "scenes: %s, against the reference", what);
    assert_at_least(name, worst->db, 60, "dB");
    snprintf(name, sizeof name, "scenes: %s, other objects seen", what);
    assert_at_most(name, 100 * worst->wrong, 1, "%");
}

#define NOTHING_YET    \
    {                  \
        .db = HUGE_VAL \
    }

/* Checks a floor that is seen and lit at increasingly grazing angles, and a
 * ball hit by grazing rays. */
TEST(grazing_rays_match_the_reference)
{
    struct outcome worst = NOTHING_YET;
    char text[600];

    for (double flat = 1; flat > 1e-5; flat /= 10) {
        snprintf(text, sizeof text,
                 "camera fov 53 at 0 %.9f 0 toward 0 0 -1\n"
                 "light sun direction 1 %.9f 0 colour 4e4 4e4 4e4 radius .27\n"
                 "light lamp at 0 2 -4 colour 4 4 4\n"
                 "material m phong .05 .8 .15 power 16\n"
                 "plane floor at 0 0 0 normal 0 1 0 material m\nshadow on\n",
                 flat, flat);
        compare_renderers(text, 96, 54, &worst);
        snprintf(text, sizeof text,
                 "camera fov %.9f at 0 0 10 toward 1 0 0\n"
                 "light sun direction 1 %.9f 0 colour 4e4 4e4 4e4\n"
                 "material m phong .05 .8 .15 power 16\n"
                 "sphere ball at 0 0 0 radius 1 material m\nshadow on\n",
                 fmax(10 * flat, .1), flat);
        compare_renderers(text, 96, 54, &worst);
    }
    check_worst_errors("floors and balls that graze, to 1e-5", &worst);
}

/* Checks the same ball and pyramid at sizes from 1e-6 to 1e3. */
TEST(tiny_and_huge_objects_match_the_reference)
{
    struct outcome worst = NOTHING_YET;
    char text[900];

    for (double r = 1e-6; r < 2e5; r *= 10) {
        snprintf(text, sizeof text,
                 "camera fov 53 at 0 %.9g %.9g toward 0 0 0\n"
                 "light lamp at %.9g %.9g %.9g colour %.9g %.9g %.9g\n"
                 "material m phong .05 .8 .15 power 16\n"
                 "material n phong .1 .9 0 reflect .2\n"
                 "sphere ball at %.9g 0 0 radius %.9g material m\n"
                 "triangle a %.9g 0 0 %.9g 0 %.9g %.9g %.9g 0 material n\n"
                 "shadow on\n",
                 r, 4 * r, -r, 4 * r, 4 * r, 25 * r * r, 25 * r * r, 25 * r * r,
                 -r, r, 0.1 * r, 2 * r, r, r, 2 * r);
        if (25 * r * r > 1e9 || 4 * r > 1e6)
            break;
        compare_renderers(text, 96, 54, &worst);
    }
    check_worst_errors("sizes 1e-6 to 1e3", &worst);
}

/* Checks objects of sizes up to 5e5. They are lit by a sun, whose light is the
 * same everywhere. */
TEST(large_objects_in_sunlight_match_the_reference)
{
    struct outcome worst = NOTHING_YET;
    char text[600];

    for (double r = 1e3; r < 5e5; r *= 5) {
        snprintf(text, sizeof text,
                 "camera fov 53 at 0 %.9g %.9g toward 0 0 0\n"
                 "light sun direction 1 2 2 colour 4e4 4e4 4e4\n"
                 "material m phong .05 .8 .15 power 16\n"
                 "sphere ball at %.9g 0 0 radius %.9g material m\n"
                 "sphere moon at %.9g %.9g %.9g radius %.9g material m\n"
                 "shadow on\n",
                 r / 2, 2 * r, -r / 4, r / 2, r / 3, r / 3, r / 2, r / 5);
        compare_renderers(text, 96, 54, &worst);
    }
    assert_at_least("scenes: sizes 1e3 to 5e5, against the reference", worst.db,
                    60, "dB");
}

/* Checks lamps and suns of any power: the brightness of objects is proportional
 * to it up to saturation. */
TEST(extreme_light_powers_match_the_reference)
{
    struct outcome worst = NOTHING_YET;
    char text[600];

    for (double c = 1e-6; c < 2e9; c *= 10) {
        snprintf(text, sizeof text,
                 "light lamp at 0 2 2 colour %.9g %.9g %.9g\n"
                 "material m phong .0 .8 .2 power 4096\n"
                 "sphere ball at 0 0 -3 radius 1 material m\n",
                 c, c, c);
        compare_renderers(text, 96, 54, &worst);
        snprintf(text, sizeof text,
                 "light sun direction 0 2 2 colour %.9g %.9g %.9g radius .01\n"
                 "material m phong 0 .8 .2 power 1\n"
                 "sphere ball at 0 0 -3 radius 1 material m\n",
                 c, c, c);
        compare_renderers(text, 96, 54, &worst);
    }
    assert_at_most("scenes: lights 1e-6 to 1e9, light shown", worst.share, .05,
                   "");
}

/* Checks objects behind, around and across the camera. */
TEST(objects_behind_the_camera_match_the_reference)
{
    static const char head[] = "light lamp at 0 3 1 colour 6 6 6\nlight lamp "
                               "at 1 1 9 colour 50 50 50\n"
                               "material m phong .1 .7 .2 power 8\n";
    static const char *const things[] = {
        "sphere s at 0 0 3 radius 1 material m\n",
        "sphere s at 0 0 0 radius 1 material m\n",
        "sphere s at .3 0 .4 radius .5 material m\n",
        "sphere s at 0 0 1 radius 1.001 material m\n",
        "triangle t -1 -1 2  1 -1 2  0 1 2 material m\n",
        "triangle t -9 -1 9  9 -1 9  0 -1 -40 material m\n",
        "triangle t -9 -1e-3 9  9 -1e-3 9  0 -1e-3 -40 material m\n",
        /* At a size of 1e5, all corners would lie within 1/512 pixel of the
         * horizon. So large a floor must be a plane instead. */
        "triangle t -2e4 -1 2e4  2e4 -1 2e4  0 -1 -2e4 material m\n",
        "plane p at 0 0 2 normal 0 0 1 material m\n",
        "plane p at 0 -1e-3 0 normal 0 1 .001 material m\n"};
    struct outcome worst = NOTHING_YET;

    for (size_t i = 0; i < sizeof things / sizeof *things; i++) {
        char text[400];

        snprintf(text, sizeof text, "%s%s", head, things[i]);
        compare_renderers(text, 96, 54, &worst);
    }
    check_worst_errors("behind, around and across the camera", &worst);
}

/* Checks images of one pixel, and of max width and height. */
TEST(extreme_image_sizes_match_the_reference)
{
    static const int size[][2] = {{1, 1},    {1, 2},    {2, 1},
                                  {8192, 8}, {8, 4096}, {1, 333}};
    struct outcome worst = NOTHING_YET;

    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        compare_renderers(
            "camera fov 3 at 0 1 4 toward 0 .5 0\n"
            "light sun direction .35 .55 .75 colour 4e4 4e4 4e4\n"
            "material m phong .1 .7 .2 power 32\n"
            "sphere ball at 0 .5 0 radius .5 material m\n"
            "plane floor at 0 0 0 normal 0 1 0 material m\nshadow on\n",
            size[i][0], size[i][1], &worst);
    check_worst_errors("one pixel to 8192 wide and 4096 high", &worst);
}

/* Checks Phong powers of 1 and 4096, glass of index 1/4 to 4, and mirrors in
 * mirrors. */
TEST(extreme_materials_match_the_reference)
{
    static const char *const materials[] = {
        "0 0 1 power 1",
        "0 0 1 power 4096",
        "0 0 0 reflect 1",
        "0 0 0 pass 1",
        "0 0 0 pass 1 refract .25",
        "0 0 0 pass 1 refract .999",
        "0 0 0 pass 1 refract 4",
        "0 0 0 reflect .5 pass .5 refract 1.5"};
    struct outcome worst = NOTHING_YET;

    for (size_t i = 0; i < sizeof materials / sizeof *materials; i++) {
        char text[500];

        snprintf(text, sizeof text,
                 "background colour .2 .4 .3\n"
                 "light sun direction .35 .55 .75 colour 4e4 4e4 4e4\n"
                 "material m phong %s\nmaterial w phong .2 .8 0\n"
                 "sphere ball at 0 0 -4 radius 1 material m\n"
                 "sphere side at 1.5 0 -5 radius .9 material w\n"
                 "plane floor at 0 -1 0 normal 0 1 0 material w\n",
                 materials[i]);
        compare_renderers(text, 160, 90, &worst);
        /* the same materials seen from inside the ball, close to its rim */
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "camera fov 90 at .9 0 -4 toward .9 0 -9\n");
        compare_renderers(text, 160, 90, &worst);
    }
    assert_at_least("scenes: powers 1 to 4096, glass 1/4 to 4, also from "
                    "within, against the reference",
                    worst.db, 60, "dB");
}
