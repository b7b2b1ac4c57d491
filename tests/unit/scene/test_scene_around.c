/* SPDX-License-Identifier: MIT
 *
 * The camera's picture all around: what mirrors and glass show of it, against
 * doubles, of every format; and that nothing pays for it who has none.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/around.h"
#include "scene/state.h"
#include "support/models/scene_builder.h"
#include "support/shuffle.h"
#include "support/test.h"

enum { UNIT = 1 << 16, WIDTH = 96, HEIGHT = 64, BYTES = 3 * WIDTH * HEIGHT };

static struct scene_file file;
static size_t bytes;
static int32_t light_q20[BYTES], drawn_q20[BYTES];

/* The picture: straight between its corners, so that cells lose nothing. X and
 * Y are -1 .. 1. */
static double slope(int channel, double x, double y)
{
    static const double across[3] = {.4, -.3, 0}, down[3] = {0, .2, -.4};

    return .5 + across[channel] * x + down[channel] * y;
}

static struct glint_image linear_of(int32_t *q20)
{
    return glint_image_over(q20, GLINT_LINEAR_Q20, WIDTH, HEIGHT);
}

static void fill(void)
{
    for (int i = 0; i < BYTES; i++) {
        const int x = i / 3 % WIDTH, y = i / 3 / WIDTH; /* NOLINT: rows */

        light_q20[i] =
            (int32_t)lrint(0x1p20 * slope(i % 3, 2 * (x + .5) / WIDTH - 1,
                                          2 * (y + .5) / HEIGHT - 1));
    }
}

static struct glint_scene *start(struct glint_workers *workers)
{
    const struct glint_scene_model model = scene_open(&file);
    struct glint_scene_config cfg;

    glint_scene_defaults(&cfg, WIDTH, HEIGHT);
    cfg.workers = workers;
    cfg.parts = scene_parts;
    bytes = glint_scene_bytes(&cfg, &model);
    return scene_start(&file, &cfg, NULL);
}

static void draw(struct glint_scene *s)
{
    struct glint_image image = linear_of(drawn_q20);

    memcpy(drawn_q20, light_q20, sizeof drawn_q20);
    glint_scene_look_around(s, &image);
    glint_scene_draw(s, &image);
}

/* A ball ahead, at z = 4, of radius 1.5, that mirrors or lets through. */
static void put_ball(double reflect, double pass, double index)
{
    uint32_t m;

    scene_begin(&file);
    m = scene_material(&file, "m");
    file.material[m].ambient_q15 = file.material[m].diffuse_q15 = 0;
    file.material[m].reflect_q15 = (int32_t)(reflect * 32768);
    file.material[m].pass_q15 = (int32_t)(pass * 32768);
    file.material[m].index_q16 = (int32_t)(index * 65536);
    scene_sphere(&file, "ball", m, 0, 0, 4 * UNIT, 3 * UNIT / 2);
}

/* The ray of a pixel's middle in a picture 90 degrees wide; returns the
 * distance at which it meets the ball, or 0. */
static double meet(int i, int k, double d[3])
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
    return off2 < 2.1 ? along - sqrt(2.25 - off2) : 0; /* not at the rim */
}

/* Where direction D is in the picture, x to the right and y down, -1 .. 1: as
 * it is seen, or mirrored at the picture's edge. */
static void place(const double d[3], double at[2])
{
    const double x = d[0], y = -d[1] * WIDTH / HEIGHT;
    const double edge = fmax(fabs(x), fabs(y));
    const double over = d[2] > edge ? d[2] : 2 * edge - d[2];

    at[0] = over > 0 ? x / over : 0;
    at[1] = over > 0 ? y / over : 0;
}

TEST(mirror)
{
    int n = 0, behind = 0;
    double worst = 0;

    put_ball(1, 0, 1);
    fill();
    draw(start(NULL));
    for (int i = 0; i < BYTES; i++) {
        double d[3], normal[3], at[2], dot = 0;
        const double t = meet(i / 3 % WIDTH, i / 3 / WIDTH, d); /* NOLINT */

        if (t == 0)
            continue;
        for (int c = 0; c < 3; c++) {
            normal[c] = (t * d[c] - (c == 2 ? 4 : 0)) / 1.5;
            dot += d[c] * normal[c];
        }
        for (int c = 0; c < 3; c++)
            d[c] -= 2 * dot * normal[c];
        place(d, at);
        worst = fmax(worst,
                     fabs(drawn_q20[i] * 0x1p-20 - slope(i % 3, at[0], at[1])));
        behind += d[2] < 0;
        n++;
    }
    assert_true(n > 1000 && behind > 100 && behind < n);
    /* Cells end half a cell inside the picture; samples are not its middle. */
    assert_true(worst < .02);
}

/* Glass that hardly bends shows what is behind it. */
TEST(glass)
{
    double worst = 0;
    int n = 0;

    put_ball(0, 1, 1.0001);
    fill();
    draw(start(NULL));
    for (int i = 0; i < BYTES; i++) {
        double d[3];

        if (meet(i / 3 % WIDTH, i / 3 / WIDTH, d) == 0) /* NOLINT: rows */
            continue;
        worst = fmax(worst, fabs(drawn_q20[i] - (double)light_q20[i]));
        n++;
    }
    assert_true(n > 1000);
    assert_true(worst < .01 * 0x1p20);
}

TEST(same_bits)
{
    static int32_t serial_q20[BYTES];
    struct shuffle shuffle;

    put_ball(.7, .3, 1.5);
    fill();
    draw(start(NULL));
    memcpy(serial_q20, drawn_q20, sizeof serial_q20);
    for (uint32_t order = 1; order < 4; order++) {
        shuffle_init(&shuffle, 3, order);
        draw(start(&shuffle.workers));
        assert_memory_equal(serial_q20, drawn_q20, sizeof serial_q20);
    }
}

/* Only those pay that show it; without it they show black. */
TEST(pay_for_use)
{
    struct glint_image image = linear_of(drawn_q20);
    struct glint_scene *s;
    size_t without;

    put_ball(0, .5, 1);
    s = start(NULL);
    without = bytes;
    assert_null(s->around.light_q15);
    put_ball(1, 0, 1);
    s = start(NULL);
    assert_true(bytes >= without + WIDTH / 2 * (HEIGHT / 2) * 6);
    fill();
    memcpy(drawn_q20, light_q20, sizeof drawn_q20);
    glint_scene_draw(s, &image);
    assert_int_equal(drawn_q20[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 0);
    draw(s);
    assert_int_not_equal(drawn_q20[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 0);
    glint_scene_look_around(s, NULL);
    memcpy(drawn_q20, light_q20, sizeof drawn_q20);
    glint_scene_draw(s, &image);
    assert_int_equal(drawn_q20[3 * (HEIGHT / 2 * WIDTH + WIDTH / 2)], 0);
}

/* A grey picture of each format gives that grey everywhere, of any size. */
TEST(formats)
{
    static const int side[][2] = {{2, 2}, {8, 4}, {66, 34}, {700, 6}, {2, 642}};
    static uint8_t picture[1 << 17], block[1 << 20];

    for (int format = 0; format <= GLINT_RGB565; format++)
        for (size_t i = 0; i < sizeof side / sizeof *side; i++) {
            struct glint_image image = {.format = (uint8_t)format,
                                        .width = side[i][0],
                                        .height = side[i][1]};
            struct glint_arena arena = glint_arena_over(block, sizeof block);
            struct glint_around around;
            int32_t rgb_q15[3];

            /* Bytes of 128 are not grey there. */
            if (format == GLINT_RGB565 || format == GLINT_LINEAR_Q20)
                continue;
            memset(picture, 128, sizeof picture);
            assert_true(glint_image_bytes(image.format, image.width,
                                          image.height) <= sizeof picture);
            glint_image_place(&image, picture);
            glint_around_carve(&around, &arena, image.width, image.height);
            assert_true(around.n_x <= 320 && around.n_y <= 321);
            glint_around_look(&around, &image, NULL);
            for (int32_t at = 0; at <= 1 << 16; at += 1 << 12) {
                glint_around_at(&around, at, (1 << 16) - at, rgb_q15);
                for (int c = 0; c < 3; c++)
                    assert_in_range(rgb_q15[c], 6900, 7500);
            }
        }
}
