/* SPDX-License-Identifier: MIT */
#include "live/live_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HOUSES = 14, DARKEST = 22, BRIGHTEST = 235 };

/* Well mixed bits of X. */
static uint32_t mixed(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* A house from the bottom up, some of its windows lit, none so bright that it
 * would be a lamp. */
static void build_house(struct live_scene *s, int house)
{
    const int w = s->image.width, h = s->image.height;
    const int left = house * w / HOUSES, right = (house + 1) * w / HOUSES;
    const int tall = h / 5 + (int)(mixed((uint32_t)house + 7) % 100) * h / 400;
    const int pane = 2 + h / 120;

    for (int y = h - tall; y < h; y++)
        for (int x = left; x < right; x++) {
            const int column = (x - left) / (2 * pane),
                      row = (y - h + tall) / (3 * pane);
            const uint32_t bits =
                mixed((uint32_t)(house * 997 + column * 31 + row * 7));
            const int is_pane = (x - left) % (2 * pane) < pane &&
                                (y - h + tall) % (3 * pane) < 2 * pane;

            s->still[y * w + x] =
                (uint8_t)(is_pane && bits % 5 == 0 ? 70 + bits % 40 : 30);
        }
}

static void build(struct live_scene *s)
{
    const int w = s->image.width, h = s->image.height;

    for (int y = 0; y < h; y++)
        memset(s->still + (size_t)y * (size_t)w, DARKEST + 14 * y / h,
               (size_t)w);
    for (int house = 0; house < HOUSES; house++)
        build_house(s, house);
}

enum glint_status live_scene_open(struct live_scene *scene, int width,
                                  int height, uint32_t seed)
{
    struct live_scene *s = scene;
    const size_t luma = (size_t)width * (size_t)height;

    *s = (struct live_scene){.image = {.format = GLINT_I420,
                                       .width = width,
                                       .height = height,
                                       .range = GLINT_RANGE_LIMITED,
                                       .matrix = height < 720
                                                     ? GLINT_MATRIX_BT601
                                                     : GLINT_MATRIX_BT709,
                                       .transfer = GLINT_TONE_BT709},
                             .seed = seed};
    s->mem = malloc(glint_image_bytes(GLINT_I420, width, height) + luma);
    if (!s->mem)
        return GLINT_E_MEMORY;
    s->still = s->mem;
    glint_image_place(&s->image, s->still + luma);
    build(s);
    return GLINT_OK;
}

/* The still picture with noise of two codes either way. */
static void expose(struct live_scene *s, int64_t n)
{
    const int w = s->image.width;
    uint32_t bits = mixed(s->seed * 2654435761u + (uint32_t)n) | 1;

    for (int y = 0; y < s->image.height; y++) {
        uint8_t *row = s->image.plane[0] + y * s->image.stride_bytes[0];
        const uint8_t *from = s->still + (size_t)y * (size_t)w;

        for (int x = 0; x < w; x++) {
            bits ^= bits << 13; /* [Marsaglia03] */
            bits ^= bits >> 17;
            bits ^= bits << 5;
            row[x] = (uint8_t)(from[x] + (bits >> 8 & 3) - 1);
        }
    }
}

/* A disc with a halo that falls with the square of the distance. */
static void light(struct live_scene *s, double cx, double cy, double radius)
{
    const int reach = (int)(12 * radius) + 1;

    for (int y = (int)cy - reach; y <= (int)cy + reach; y++)
        for (int x = (int)cx - reach; x <= (int)cx + reach; x++) {
            const double r = hypot(x - cx, y - cy) / radius;
            const double halo = 60 / (1 + r * r) - 60 / 145.0;
            const double add = r < 1 ? 255 : r < 2 ? 255 * (2 - r) : 0;
            uint8_t *at;
            double code;

            if (x < 0 || y < 0 || x >= s->image.width || y >= s->image.height)
                continue;
            at = s->image.plane[0] + y * s->image.stride_bytes[0] + x;
            code = *at + fmax(halo, 0) + add;
            *at = (uint8_t)(code < BRIGHTEST ? code : BRIGHTEST);
        }
}

void live_scene_draw(struct live_scene *scene, int64_t n, double per_second)
{
    const struct glint_image *i = &scene->image;
    const double turn = fmod((double)n / (8 * per_second), 1);
    const double angle = 6.283185307179586 * turn;

    expose(scene, n);
    for (int p = 1; p < 3; p++) /* a bluish night */
        for (int y = 0; y < glint_image_plane_height(i->format, p, i->height);
             y++)
            memset(i->plane[p] + y * i->stride_bytes[p], p == 1 ? 134 : 125,
                   glint_image_row_bytes(i->format, p, i->width));
    light(scene, i->width * (0.5 + 0.32 * cos(angle)),
          i->height * (0.38 + 0.25 * sin(angle)), fmax(1.5, i->height / 120.0));
}

void live_scene_close(struct live_scene *scene)
{
    free(scene->mem);
    scene->mem = NULL;
}
