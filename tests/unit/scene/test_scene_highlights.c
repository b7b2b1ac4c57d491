/* SPDX-License-Identifier: MIT
 *
 * Tests highlights, the bright reflections that get flares. They are compared
 * with the reference renderer in double precision at subpixel positions, and
 * must be equal for all tiles and workers. Also tests which bright objects are
 * not highlights, which highlights are merged, and extreme values.
 */
#include "glint/pool.h"
#include "glint/scene/bake.h"
#include "glint/scene/highlights.h"
#include "glint/view.h"
#include "scene/parts.h"
#include "scenes/scene_frame.h"
#include "reference/scenes/twin_highlights.h"
#include "support/test.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE, MOST = GLINT_SCENE_MAX_HIGHLIGHTS };

static struct glint_description description;
static unsigned char *data;
static struct glint_scene_model model;
static struct scene_frame frame;
static struct glint_scene_highlight found[MOST];
static int n;

static const struct scene_dials dials = {
    .width = SIDE, .height = SIDE, .edge_samples = 4, .shadow_points = 1};
static struct tool tool = {.name = "test"};

static void open_scene_text(const char *text, const struct scene_dials *with)
{
    const struct glint_description_files files = {NULL, NULL, NULL,
                                                  NULL, NULL, NULL};
    struct glint_scene_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";
    size_t bytes = 0;

    if (glint_description_parse(&description, text, strlen(text), "x.scene",
                                &files, &error) != GLINT_OK ||
        glint_scene_bake(&description, "x", 1, &data, &bytes, &report,
                         &error) != GLINT_OK)
        fail_msg("%s", error.text);
    if (glint_scene_open(&model, data, bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
    assert_ok(scene_frame_open(&frame, &tool, &model, with));
}

static void close_scene(void)
{
    scene_frame_close(&frame);
    free(data);
    glint_description_free(&description);
}

static void draw_and_find_highlights(void)
{
    static int32_t light_q20[3 * PIXELS];
    struct glint_image image =
        glint_image_over(light_q20, GLINT_LINEAR_Q20, SIDE, SIDE);

    memset(light_q20, 0, sizeof light_q20);
    memset(found, 0x55, sizeof found);
    assert_ok(scene_frame_draw(&frame, &image));
    n = glint_scene_find_highlights(frame.scene, found);
}

static double highlight_power(int i)
{
    return (double)found[i].spot.power_q16 * 0x1p-16;
}

#define CAMERA \
    "camera fov 20 at 0 0 4 toward 0 0 0\nflare lights highlights 8\n"
#define STEEL(alpha) "material m ward specular .9 .8 .7 alpha " alpha "\n"
#define SUN          "light sun direction .5 .6 1 colour 2e4 2e4 1e4\n"
/* a sun for scenes with small balls, whose highlights would barely exceed white
 * with less light */
#define BRIGHT "light sun direction .5 .6 1 colour 2e6 2e6 1e6\n"
#define BALL   "sphere s at 0 0 0 radius .44 material m\n"

/* ------------------------------------------- comparison with the reference */

TEST(highlights_equal_the_reference)
{
    static const struct {
        const char *what, *text;
        double off; /* max relative error of the power */
    } row[] = {{"a point", CAMERA STEEL(".002 .002") SUN BALL, .02},
               {"brushed", CAMERA STEEL(".03 .2") SUN BALL, .02},
               {"a lamp",
                CAMERA STEEL(".1 .1") BALL
                "light lamp at 1 1 2 colour 40 20 10 radius .1\n",
                .02},
               {"two lights",
                CAMERA STEEL(".05 .05") SUN BALL
                "light sun direction -1 0 1 colour 1e4 1e4 1e4\n",
                .02},
               {"Phong",
                CAMERA "material m phong .1 .2 .7 power 200\n" BALL
                       "light sun direction .5 .6 1 colour 3e5 2e5 1e5\n",
                .03}};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct twin_view view = {SIDE, SIDE, 0, 1};
        struct twin_highlight exact[TWIN_HIGHLIGHTS];
        struct twin twin;
        int all;

        open_scene_text(row[i].text, &dials);
        draw_and_find_highlights();
        assert_ok(reference_open(&twin, &description));
        all = reference_find_highlights(&twin, &view, exact);
        reference_close(&twin);
        assert_int_equal(n, all);
        for (int k = 0; k < n; k++) {
            const struct glint_spot *s = &found[k].spot;
            const double variance =
                (pow(s->axis_q8[0], 2) + pow(s->axis_q8[1], 2)) / 65536;

            print_message("%s: power %.2f, exact %.2f; off %.3f %.3f px\n",
                          row[i].what, highlight_power(k), exact[k].power,
                          s->x_q8 / 256. - exact[k].x,
                          s->y_q8 / 256. - exact[k].y);
            assert_true(fabs(highlight_power(k) / exact[k].power - 1) <
                        row[i].off);
            assert_true(fabs(s->x_q8 / 256. - exact[k].x) < .05);
            assert_true(fabs(s->y_q8 / 256. - exact[k].y) < .05);
            assert_true(fabs(variance - fmax(exact[k].variance, .5)) <
                        .05 * exact[k].variance + .3);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(s->rgb_q15[c] / 32768. - exact[k].rgb[c]) <
                            .02);
        }
        close_scene();
    }
}

/* ------------------------------------------------------- moving highlights */

/* Moves the ball by (DX, DY) pixels from its original position. */
static void move_ball_by_pixels(double dx, double dy)
{
    const double pixel = 2 * tan(10 * GLINT_PI / 180) * 4 / SIDE;
    const struct glint_scene_object *o = &model.object[0];
    const double steps = ldexp(pixel, model.header->unit_log2);
    const int32_t at[3] = {o->at[0] + (int32_t)(dx * steps),
                           o->at[1] - (int32_t)(dy * steps), o->at[2]};

    assert_ok(glint_scene_set_pose(frame.scene, 0, at, o->turn_q30));
}

/* Moves a ball by steps smaller than a pixel. Checks that the power of the
 * ball's highlight varies by at most 5 %, and that its position follows the
 * ball. In the last text, the highlight is barely above white and may vary
 * more, as it is too faint for a visible flare. */
TEST(highlights_are_steady_in_motion)
{
    enum { TEXTS = 5 };
    static const char *const text[TEXTS] = {
        CAMERA STEEL(".002 .002") SUN BALL, CAMERA STEEL(".05 .05") SUN BALL,
        CAMERA STEEL(".05 .2") SUN BALL,
        CAMERA STEEL(".002 .002") BRIGHT
        "sphere s at 0 0 0 radius .1 material m\n",
        CAMERA STEEL(".002 .002") SUN
        "sphere s at 0 0 0 radius .1 material m\n"};

    for (int i = 0; i < TEXTS; i++)
        for (int samples = 1; samples <= 4; samples += 3) {
            struct scene_dials with = dials;
            double least = HUGE_VAL, most = 0, off = 0, from[2] = {0, 0};

            with.edge_samples = samples;
            open_scene_text(text[i], &with);
            for (int k = 0; k < 81; k++) {
                const double x = k % 9 / 8., y = k / 9 / 8.;

                move_ball_by_pixels(x, y);
                draw_and_find_highlights();
                assert_int_equal(n, 1);
                least = fmin(least, highlight_power(0));
                most = fmax(most, highlight_power(0));
                if (k == 0) {
                    from[0] = found[0].spot.x_q8 / 256.;
                    from[1] = found[0].spot.y_q8 / 256.;
                }
                off = fmax(off, fabs(found[0].spot.x_q8 / 256. - x - from[0]));
                off = fmax(off, fabs(found[0].spot.y_q8 / 256. - y - from[1]));
            }
            print_message("text %d, %d samples: power %.2f to %.2f, %.3f px\n",
                          i, samples, least, most, off);
            assert_true(most < (i == TEXTS - 1 ? 1.5 : 1.05) * least);
            assert_true(off < .15);
            close_scene();
        }
}

TEST(highlights_are_bit_identical)
{
    static const char text[] = CAMERA STEEL(".03 .2") SUN BALL
        "light sun direction -1 -.3 1 colour 1e4 1e4 1e4\n"
        "sphere t at .3 .3 .4 radius .12 material m\n";
    struct glint_scene_highlight first[MOST];
    /* power of the brightest highlight when every pixel is shaded */
    double full = 0;
    int n_first = 0;

    for (int half = 0; half < 2; half++)
        for (int tile = 3; tile <= 6; tile++)
            for (int threads = 1; threads <= 3; threads += 2) {
                struct scene_dials with = dials;

                with.tile_log2 = tile;
                with.half_shading = half;
                assert_ok(glint_pool_create(&tool.workers, threads));
                open_scene_text(text, &with);
                draw_and_find_highlights();
                if (tile == 3 && threads == 1) {
                    memcpy(first, found, sizeof first);
                    n_first = n;
                    assert_true(n >= 3);
                    full = half ? full : highlight_power(0);
                    assert_true(fabs(highlight_power(0) / full - 1) < .1);
                }
                assert_int_equal(n, n_first);
                assert_memory_equal(found, first, sizeof first);
                /* drawing again gives the same highlights */
                draw_and_find_highlights();
                assert_memory_equal(found, first, sizeof first);
                close_scene();
                glint_pool_destroy(tool.workers);
                tool.workers = NULL;
            }
}

/* -------------------------------------------- which objects are highlights */

static int count_found_highlights(const char *text)
{
    open_scene_text(text, &dials);
    draw_and_find_highlights();
    close_scene();
    return n;
}

/* Checks bright objects that are not highlights: visible lights, backgrounds,
 * shadow catchers and pixels below white. Without a request for highlights,
 * none must be found. */
TEST(other_bright_objects_are_no_highlights)
{
    assert_int_equal(count_found_highlights(CAMERA STEEL(".05 .05") SUN BALL),
                     1);
    assert_int_equal(
        count_found_highlights(
            "camera fov 20 at 0 0 4 toward 0 0 0\nflare lights\n" STEEL(
                ".05 .05") SUN BALL),
        0);
    assert_int_equal(
        count_found_highlights(
            "camera fov 20 at 0 0 4 toward 0 0 0\n" STEEL(".05 .05") SUN BALL),
        0);
    assert_int_equal(count_found_highlights(
                         CAMERA STEEL(".05 .05") BALL
                         "light sun direction .1 .1 -1 colour 1e5 1e5 1e5\n"),
                     0);
    assert_int_equal(count_found_highlights(
                         CAMERA "background colour 9 9 9\n" STEEL(".3 .3") BALL
                         "plane p at 0 0 -1 normal 0 0 1 catcher .5\n"
                         "light lamp at 0 4 1 colour 1 1 1\nshadow on\n"),
                     0);
    assert_int_equal(
        count_found_highlights(CAMERA "material m phong 1 0 0\n" BALL), 0);
}

/* Checks that highlights are merged if their squares touch or their centres are
 * within 12 pixels. If there are too many, the brightest must be returned. */
TEST(near_highlights_are_merged)
{
    static const char two[] = CAMERA STEEL(".01 .01") BRIGHT
        "sphere a at -.01 0 0 radius .012 material m\n"
        "sphere b at %s 0 0 radius .012 material m\n";
    static char text[2000];
    double before = HUGE_VAL;

    snprintf(text, sizeof text, two, ".1");
    assert_int_equal(count_found_highlights(text), 1);
    assert_int_equal(found[0].object, 0);
    snprintf(text, sizeof text, two, ".4");
    assert_int_equal(count_found_highlights(text), 2);
    assert_int_equal(found[0].object + found[1].object, 1);
    for (int i = 0; i < 40; i++) {
        snprintf(text, sizeof text,
                 CAMERA STEEL(".01 .01") BRIGHT
                 "sphere a at %g 0 0 radius .012 material m\n"
                 "sphere b at %g 0 0 radius .012 material m\n"
                 "sphere c at -.5 0 0 radius .0145 material m\n",
                 .1 + .002 * i, .2 + .002 * i);
        assert_in_range(count_found_highlights(text), 2, 3);
        assert_true(highlight_power(0) > highlight_power(1));
    }
    strcpy(text, CAMERA STEEL(".01 .01") BRIGHT);
    for (int i = 0; i < 16; i++)
        snprintf(text + strlen(text), 100,
                 "sphere b%d at %g %g 0 radius %g material m\n", i,
                 .32 * (i % 4) - .48, .32 * (i / 4) - .48, .02 + .001 * i);
    assert_int_equal(count_found_highlights(text), 8);
    for (int i = 0; i < n; i++) {
        assert_int_equal(found[i].object, 15 - i);
        assert_true(highlight_power(i) < before);
        before = highlight_power(i);
    }
}

/* ---------------------------------------------------------------- extremes */

/* Checks that the power of a highlight grows with the light, up to saturation.
 * Highlights on a ball of one pixel, or at the image border, must lie in the
 * image. */
TEST(power_is_linear_up_to_saturation)
{
    static char text[400];
    double last = 0;

    for (int e = -6; e <= 9; e++) {
        snprintf(text, sizeof text,
                 CAMERA STEEL(".1 .1") BALL
                 "light lamp at 1 1 2 colour 1e%d 1e%d 1e%d\n",
                 e, e, e);
        open_scene_text(text, &dials);
        draw_and_find_highlights();
        assert_true(n <= 1 && (n == 1) == (e >= 0));
        if (n == 1) {
            print_message("colour 1e%d: power %.4g\n", e, highlight_power(0));
            assert_true(highlight_power(0) >= last &&
                        highlight_power(0) <= 0x1p26);
            assert_true(found[0].spot.axis_q8[1] >= 128);
            if (last > 500 && highlight_power(0) < 1e5)
                assert_true(highlight_power(0) / last > 9 &&
                            highlight_power(0) / last < 25);
            last = highlight_power(0);
        }
        close_scene();
    }
    assert_true(last > 1e6);
    count_found_highlights(CAMERA STEEL(".05 .05") SUN BALL);
    last = found[0].spot.x_q8 / 256.;
    /* the highlight crosses the left border */
    for (int e = -20; e <= 20; e++) {
        open_scene_text(CAMERA STEEL(".05 .05") SUN BALL, &dials);
        move_ball_by_pixels(e / 2. - last, 0);
        draw_and_find_highlights();
        for (int i = 0; i < n; i++)
            assert_true(found[i].spot.x_q8 >= 0 && found[i].spot.y_q8 >= 0 &&
                        found[i].spot.x_q8 < 256 * SIDE &&
                        highlight_power(i) > 0);
        assert_int_equal(n, e > 4 ? 1 : e < -18 ? 0 : n);
        close_scene();
    }
    assert_int_equal(
        count_found_highlights(CAMERA STEEL(
            ".05 .05") "light sun direction .5 .6 1 colour 2e8 2e8 1e8\n"
                       "sphere s at 0 0 0 radius .0073 material m\n"),
        1);
    print_message("a ball of a pixel: power %.3f\n", highlight_power(0));
    assert_true(fabs(found[0].spot.x_q8 / 256. - SIDE / 2) < 1);
}

/* Highlights are summed over squares of pixels. Checks the brightest light that
 * such a sum can represent: the highlight must be white. */
TEST(brightest_highlight_is_white)
{
    static const int32_t max_q15[3] = {1 << 30, 1 << 30, 1 << 30};

    open_scene_text(CAMERA STEEL(".05 .05") SUN BALL, &dials);
    draw_and_find_highlights();
    glint_scene_highlights.begin(frame.scene->bright);
    for (int i = 0; i < 2; i++)
        glint_scene_highlights.note(frame.scene->bright, 0, 0, 0, max_q15,
                                    1 << 28);
    assert_int_equal(glint_scene_find_highlights(frame.scene, found), 1);
    for (int c = 0; c < 3; c++)
        assert_true(abs(found[0].spot.rgb_q15[c] - (1 << 15)) <= 8);
    close_scene();
}
