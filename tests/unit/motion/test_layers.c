/* SPDX-License-Identifier: MIT
 *
 * Tests the layers of recorded motion: shells (transparent spheres) and lines
 * (trajectories). They are compared with their definition in double precision,
 * pixel by pixel. Nearer objects must occlude them.
 */
#include "scene/motion/play.h"
#include "support/rng.h"
#include "support/test.h"
#include "support/tracks/moving.h"

enum { WIDTH = MOVING_WIDTH, HEIGHT = MOVING_HEIGHT, SAMPLES = 4 };

/* Returns the cosine between the surface normal of a ball and the ray through
 * (X, Y), Q8 pixels from the image centre, where the ray enters the ball; -1 if
 * the ray misses it. The ball has the radius RADIUS and the centre C in camera
 * coordinates. */
static double cosine_to_normal(const struct glint_scene *s, const int32_t c[3],
                               double radius, double x_q8, double y_q8)
{
    const double per_tan = (double)s->view.per_tan_q8;
    const double d[3] = {x_q8 / per_tan, -y_q8 / per_tan, 1};
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
    double along = 0, square = 0;

    for (int k = 0; k < 3; k++) {
        along += c[k] * d[k] / length;
        square += (double)c[k] * c[k];
    }
    square = (square - along * along) / (radius * radius);
    return square > 1 || along <= 0 ? -1 : sqrt(1 - square);
}

/* Returns the coverage of pixel (X, Y) by shell L (a transparent sphere), 0 ..
 * 1. */
static double compute_shell_coverage(const struct glint_scene *s,
                                     const struct glint_motion_layer *l, int x,
                                     int y)
{
    const double share =
        1 - s->material[l->material].pass_q15 / (double)GLINT_SCENE_ONE_Q15;
    const double x_q8 = glint_pixel_position_q8(s, x, 0),
                 y_q8 = glint_pixel_position_q8(s, y, 1);
    int32_t c[3];
    int hits = 0;

    glint_view_convert_to_camera(&s->view, l->ball->at, c);
    for (int k = 0; k < SAMPLES; k++)
        hits += cosine_to_normal(s, c, l->ball->radius,
                                 x_q8 + glint_sample_offset_q8(s, k, 0),
                                 y_q8 + glint_sample_offset_q8(s, k, 1)) >= 0;
    return share * hits / SAMPLES *
           (1 -
            fmax(0, cosine_to_normal(s, c, l->ball->radius, x_q8, y_q8)) / 2);
}

/* Returns the coverage of pixel (X, Y) by line L (a trajectory), 0 .. 1. */
static double compute_line_coverage(const struct glint_scene *s,
                                    const struct glint_motion_layer *l, int x,
                                    int y)
{
    const double dx = (glint_pixel_position_q8(s, x, 0) - l->x_q8) / 256.;
    const double dy = (glint_pixel_position_q8(s, y, 1) - l->y_q8) / 256.;
    const double u = l->along_q14[0] / 16384., v = l->along_q14[1] / 16384.;
    const double along = dx * u + dy * v, across = fabs(dx * v - dy * u);
    const double length = l->length_q8 / 256.;
    const double part = fmin(1, fmax(0, along / length));
    const double half =
        (l->half_q8[0] + (l->half_q8[1] - l->half_q8[0]) * part) / 256;

    return fmax(0, fmin(1, fmin(along, length - along) + .5)) *
           fmax(0, fmin(fmin(1, 2 * half), half + .5 - across));
}

/* Draws only shells (spheres), lines and box edges, and compares them with
 * their definition. */
static void compare_layers_with_definition(struct moving *d)
{
    const struct glint_scene *s = d->frame.scene;
    const struct glint_motion_state *m = s->motion;
    double worst = 0;

    moving_draw_frame(d);
    assert_true(m->n_layers > 0);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double rgb[3] = {0, 0, 0};

            for (int i = 0; i < m->n_layers; i++) {
                const struct glint_motion_layer *l = &m->layer[i];
                const double a = l->ball ? compute_shell_coverage(s, l, x, y)
                                         : compute_line_coverage(s, l, x, y);

                for (int c = 0; c < 3; c++)
                    rgb[c] += a * (s->material[l->material].rgb_q15[c] /
                                       (double)GLINT_SCENE_ONE_Q15 -
                                   rgb[c]);
            }
            for (int c = 0; c < 3; c++)
                worst = fmax(
                    worst,
                    fabs(rgb[c] -
                         ldexp(d->light_q20[3 * (y * WIDTH + x) + c], -20)));
        }
    /* Each layer is rounded to 1/256, and the coverage of a rim pixel to one
     * sample. */
    if (worst > (m->n_layers + 2) / 256.)
        fail_msg("%d layers, off by %.4f", m->n_layers, worst);
}

TEST(layers_are_as_defined)
{
    double food[4][3] = {{5, 0, 0}, {0, 5, .5}, {0, 0, 5}, {-5, -1, 0}};
    static const char *const camera[] = {
        "camera fov 53 at -4 12 16 toward 0 0 0\n",
        "camera fov 70 at 9 1 1 toward 0 0 0\n",
        "camera fov 30 at 0 3 30 toward 0 1 0\n",
        "camera fov 53 at 1 14 0 toward 0 0 0.5\n"};

    moving_bake_foods(food, 4, 50);
    for (int i = 0; i < 4; i++)
        for (int tile_log2 = 4; tile_log2 <= 6; tile_log2++) {
            char text[400];
            struct moving *d;

            strcpy(text, camera[i]);
            strcat(text, "material shells phong 1 0 0 colour 0 .5 1 pass .4\n"
                         "motion run x size .6 sensors .2 foods .5 shells 1.8 "
                         "lines .3 box .1\n");
            d = moving_open_scene(text, tile_log2, SAMPLES);
            glint_scene_show_kind(d->frame.scene, GLINT_KIND_FOODS, 0);
            glint_scene_show_kind(d->frame.scene, GLINT_KIND_BODY, 0);
            glint_scene_show_kind(d->frame.scene, GLINT_KIND_SENSORS, 0);
            compare_layers_with_definition(d);
            moving_close_scene(d);
        }
}

/* Checks a food (landmark) that no sensor detects, in front of the shell
 * (transparent sphere) of a detected food or inside it: the food occludes the
 * shell. */
TEST(nearer_objects_hide_layers)
{
    double food[3][3] = {{5, 0, 0}, {5, 3, 3}, {0, -9, 9}};
    const int middle = 3 * (HEIGHT / 2 * WIDTH + WIDTH / 2);

    moving_bake_foods(food, 3, 50);
    for (int i = 0; i < 2; i++) {
        struct moving *d =
            moving_open_scene(i ? "camera fov 30 at 5 12 12 toward 5 0 0\n"
                                  "motion run x size .6 foods 1 shells 2\n"
                                : "camera fov 30 at 5 12 12 toward 5 0 0\n"
                                  "motion run x size .6 foods 1 shells 5.4\n",
                              5, SAMPLES);
        int32_t with[2][3];

        for (int k = 0; k < 2; k++) {
            glint_scene_show_kind(d->frame.scene, GLINT_KIND_SHELLS, k);
            moving_draw_frame(d);
            memcpy(with[k], d->light_q20 + middle, sizeof with[k]);
        }
        assert_int_equal(d->frame.scene->motion->n_layers, 1);
        if (i)
            assert_memory_equal(with[0], with[1], sizeof with[0]);
        else /* the shell is so wide that the food (landmark) is inside it */
            assert_memory_not_equal(with[0], with[1], sizeof with[0]);
        moving_close_scene(d);
    }
}
