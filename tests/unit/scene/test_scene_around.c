/* SPDX-License-Identifier: MIT
 *
 * Tests scenes that reflect and refract the camera's own image, used as a
 * 360-degree environment. Values are compared with double precision in every
 * pixel format. Scenes that do not show the environment must not compute it.
 */
#include "scene/around.h"
#include "scene/state.h"
#include "support/models/scene_builder.h"
#include "support/shuffle.h"
#include "support/test.h"

enum { UNIT = 1 << 16, WIDTH = 96, HEIGHT = 64, BYTES = 3 * WIDTH * HEIGHT };

static struct scene_file file;
static size_t bytes;
static int32_t light_q20[BYTES], drawn_q20[BYTES];

/* Returns the value of the test image at (X, Y), each -1 .. 1. The image is
 * linear, so that the cells of the environment interpolate it exactly. */
static double compute_test_image_value(int channel, double x, double y)
{
    static const double across[3] = {.4, -.3, 0}, down[3] = {0, .2, -.4};

    return .5 + across[channel] * x + down[channel] * y;
}

static struct glint_image make_linear_image_over(int32_t *q20)
{
    return glint_image_over(q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);
}

static void fill_linear_image(void)
{
    for (int i = 0; i < BYTES; i++) {
        const int x = i / 3 % WIDTH, y = i / 3 / WIDTH; /* NOLINT: rows */

        light_q20[i] = (int32_t)lrint(
            0x1p20 * compute_test_image_value(i % 3, 2 * (x + .5) / WIDTH - 1,
                                              2 * (y + .5) / HEIGHT - 1));
    }
}

static struct glint_scene *start_scene_renderer(struct glint_workers *workers)
{
    const struct glint_scene_model model = scene_open_model(&file);
    struct glint_scene_config cfg;

    glint_scene_defaults(&cfg, WIDTH, HEIGHT);
    cfg.workers = workers;
    cfg.parts = scene_parts;
    bytes = glint_scene_bytes(&cfg, &model);
    return scene_init_renderer(&file, &cfg, NULL);
}

static void draw_scene(struct glint_scene *s)
{
    struct glint_image image = make_linear_image_over(drawn_q20);

    memcpy(drawn_q20, light_q20, sizeof drawn_q20);
    glint_scene_look_around(s, &image);
    glint_scene_draw(s, &image);
}

/* Adds a ball of radius 1.5 at z = 4 with the reflectance REFLECT, the
 * transmittance PASS and the refractive index INDEX. */
static void add_reflecting_ball(double reflect, double pass, double index)
{
    uint32_t m;

    scene_begin_header(&file);
    m = scene_add_material(&file, "m");
    file.material[m].ambient_q15 = file.material[m].diffuse_q15 = 0;
    file.material[m].reflect_q15 = (int32_t)(reflect * 32768);
    file.material[m].pass_q15 = (int32_t)(pass * 32768);
    file.material[m].index_q16 = (int32_t)(index * 65536);
    scene_add_sphere(&file, "ball", m, 0, 0, 4 * UNIT, 3 * UNIT / 2);
}

/* Sets D to the direction of the ray through the centre of pixel (I, K) in an
 * image 90 degrees wide. Returns the distance to the ball, or 0 if the ray
 * misses it. */
static double intersect_ball_at_pixel(int i, int k, double d[3])
{
    double length, along, off2;

    d[0] = 2 * (i + .5) / WIDTH - 1;
    d[1] = -(2 * (k + .5) - HEIGHT) / WIDTH;
    d[2] = 1;
    length = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
    for (int c = 0; c < 3; c++)
        d[c] /= length;
    along = 4 * d[2];
    off2 = 16 - along * along;
    return off2 < 2.1 ? along - sqrt(2.25 - off2) : 0; /* excludes the rim */
}

/* Sets AT to the position in the image that shows the direction D: x to the
 * right, y down, each -1 .. 1. A direction off-screen is mirrored at the image
 * border. */
static void find_image_position(const double d[3], double at[2])
{
    const double x = d[0], y = -d[1] * WIDTH / HEIGHT;
    const double edge = fmax(fabs(x), fabs(y));
    const double over = d[2] > edge ? d[2] : 2 * edge - d[2];

    at[0] = over > 0 ? x / over : 0;
    at[1] = over > 0 ? y / over : 0;
}

TEST(mirror_shows_the_image_around_the_scene)
{
    int n = 0, behind = 0;
    double worst = 0;

    add_reflecting_ball(1, 0, 1);
    fill_linear_image();
    draw_scene(start_scene_renderer(NULL));
    for (int i = 0; i < BYTES; i++) {
        double d[3], normal[3], at[2], dot = 0;
        const int x = i / 3 % WIDTH, y = i / 3 / WIDTH; /* NOLINT: rows */
        const double t = intersect_ball_at_pixel(x, y, d);

        if (t == 0)
            continue;
        for (int c = 0; c < 3; c++) {
            normal[c] = (t * d[c] - (c == 2 ? 4 : 0)) / 1.5;
            dot += d[c] * normal[c];
        }
        for (int c = 0; c < 3; c++)
            d[c] -= 2 * dot * normal[c];
        find_image_position(d, at);
        worst =
            fmax(worst, fabs(drawn_q20[i] * 0x1p-20 -
                             compute_test_image_value(i % 3, at[0], at[1])));
        behind += d[2] < 0;
        n++;
    }
    assert_true(n > 1000 && behind > 100 && behind < n);
    /* the cells of the environment end half a cell inside the image, and
     * samples are not at pixel centres */
    assert_true(worst < .02);
}

TEST(glass_of_index_1_shows_the_image_behind_it)
{
    double worst = 0;
    int n = 0;

    add_reflecting_ball(0, 1, 1.0001);
    fill_linear_image();
    draw_scene(start_scene_renderer(NULL));
    for (int i = 0; i < BYTES; i++) {
        double d[3];

        if (intersect_ball_at_pixel(i / 3 % WIDTH, i / 3 / WIDTH, d) ==
            0) /* NOLINT: rows */
            continue;
        worst = fmax(worst, fabs(drawn_q20[i] - (double)light_q20[i]));
        n++;
    }
    assert_true(n > 1000);
    assert_true(worst < .01 * 0x1p20);
}

TEST(image_is_bit_identical_for_all_workers)
{
    static int32_t serial_q20[BYTES];
    struct shuffle shuffle;

    add_reflecting_ball(.7, .3, 1.5);
    fill_linear_image();
    draw_scene(start_scene_renderer(NULL));
    memcpy(serial_q20, drawn_q20, sizeof serial_q20);
    for (uint32_t order = 1; order < 4; order++) {
        init_shuffled_workers(&shuffle, 3, order);
        draw_scene(start_scene_renderer(&shuffle.workers));
        assert_memory_equal(serial_q20, drawn_q20, sizeof serial_q20);
    }
}

/* Checks that the image is sampled only for scenes in which surfaces reflect or
 * refract it. A scene without sampling shows black instead. */
TEST(only_scenes_that_show_the_image_pay_for_it)
{
    struct glint_image image = make_linear_image_over(drawn_q20);
    struct glint_scene *s;
    size_t without;

    add_reflecting_ball(0, .5, 1);
    s = start_scene_renderer(NULL);
    without = bytes;
    assert_null(s->around.light_q15);
    add_reflecting_ball(1, 0, 1);
    s = start_scene_renderer(NULL);
    assert_true(bytes >= without + WIDTH / 2 * (HEIGHT / 2) * 6);
    fill_linear_image();
    memcpy(drawn_q20, light_q20, sizeof drawn_q20);
    glint_scene_draw(s, &image);
    assert_int_equal(drawn_q20[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 0);
    draw_scene(s);
    assert_int_not_equal(drawn_q20[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 0);
    glint_scene_look_around(s, NULL);
    memcpy(drawn_q20, light_q20, sizeof drawn_q20);
    glint_scene_draw(s, &image);
    assert_int_equal(drawn_q20[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 0);
}

/* Checks that a uniform grey image of any format and size is reflected as the
 * same grey everywhere. */
TEST(grey_image_of_each_format_is_even)
{
    static const int side[][2] = {{2, 2}, {8, 4}, {66, 34}, {700, 6}, {2, 642}};
    static uint8_t picture[1 << 17], block[1 << 20];

    for (int format = 0; format <= GLINT_RGB565; format++)
        for (size_t i = 0; i < sizeof side / sizeof *side; i++) {
            struct glint_image image = {.format = (uint8_t)format,
                                        .width = side[i][0],
                                        .height = side[i][1]};
            struct glint_arena arena =
                glint_arena_init_in_memory(block, sizeof block);
            struct glint_around around;
            int32_t rgb_q15[3];

            /* in these formats, pixels of bytes 128 are not grey */
            if (format == GLINT_RGB565 || format == GLINT_LINEAR_Q20)
                continue;
            memset(picture, 128, sizeof picture);
            assert_true(glint_image_bytes(image.format, image.width,
                                          image.height) <= sizeof picture);
            glint_image_place(&image, picture);
            glint_background_allocate(&around, &arena, image.width,
                                      image.height);
            assert_true(around.n_x <= 320 && around.n_y <= 321);
            glint_background_store(&around, &image, NULL);
            for (int32_t at = 0; at <= 1 << 16; at += 1 << 12) {
                glint_background_sample(&around, at, (1 << 16) - at, rgb_q15);
                for (int c = 0; c < 3; c++)
                    assert_in_range(rgb_q15[c], 6900, 7500);
            }
        }
}
