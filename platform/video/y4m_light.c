/* SPDX-License-Identifier: MIT */
#include "video/y4m_light.h"

#include <stdbool.h>
#include <string.h>

#include "video/y4m_divide.h"

#define WHITE_Q24 (INT32_C(1) << 24)
#define WHITE_Q20 (INT32_C(1) << 20)

/* ------------------------------------------------------------------- tables */

static uint64_t mul_q30(uint64_t a_q30, uint64_t b_q30)
{
    return (a_q30 * b_q30 + (UINT64_C(1) << 29)) >> 30;
}

/* Returns x^9, 0 <= x <= 1. */
static uint64_t power_q30(uint64_t x_q30)
{
    const uint64_t x2_q30 = mul_q30(x_q30, x_q30);
    const uint64_t x4_q30 = mul_q30(x2_q30, x2_q30);

    return mul_q30(mul_q30(x4_q30, x4_q30), x_q30);
}

/* Returns the largest r with r^9 <= x, 0 <= x <= 1. */
static uint64_t root_q30(uint64_t x_q30)
{
    uint64_t r_q30 = 0;

    for (uint64_t bit = UINT64_C(1) << 30; bit; bit >>= 1)
        if ((r_q30 | bit) <= UINT64_C(1) << 30 &&
            power_q30(r_q30 | bit) <= x_q30)
            r_q30 |= bit;
    return r_q30;
}

/* Returns the light of v = STEP / 4096 by BT.709: v / 4.5 below 0.081, else
 * u^(20/9), u = (v + 0.099) / 1.099. */
static int32_t light_q24(int step)
{
    const uint64_t divisor = UINT64_C(1099) * GLINT_Y4M_STEPS;
    uint64_t u_q30, u2_q30;

    if (step * 1000 < 81 * GLINT_Y4M_STEPS)
        return (
            int32_t)(((uint64_t)step * 20 * WHITE_Q24 + 45 * GLINT_Y4M_STEPS) /
                     (90 * GLINT_Y4M_STEPS));
    u_q30 =
        (((uint64_t)(1000 * step + 99 * GLINT_Y4M_STEPS) << 30) + divisor / 2) /
        divisor;
    u2_q30 = mul_q30(u_q30, u_q30);
    return (int32_t)((mul_q30(u2_q30, root_q30(u2_q30)) + (1 << 5)) >> 6);
}

/* Returns the R'G'B' code, _q20, at which the straight lines between the
 * entries of DECODE reach LIGHT, _q24. */
static int32_t place_q20(const int32_t *decode_q24, int32_t light)
{
    int low = 0, high = GLINT_Y4M_STEPS;
    int64_t over, step;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (decode_q24[middle] <= light)
            low = middle;
        else
            high = middle;
    }
    over = light - decode_q24[low];
    step = decode_q24[high] - decode_q24[low];
    return (int32_t)(((int64_t)low << 8) + ((over << 8) + step / 2) / step);
}

static void fill_tables(struct glint_y4m_light *l)
{
    for (int i = 0; i <= GLINT_Y4M_STEPS; i++)
        l->decode_q24[i] = light_q24(i);
    for (int o = 0; o < GLINT_Y4M_OCTAVES; o++)
        for (int i = 0; i <= GLINT_Y4M_IN_OCTAVE; i++) {
            const int64_t light =
                ((int64_t)(GLINT_Y4M_IN_OCTAVE + i) << o) / GLINT_Y4M_IN_OCTAVE;

            l->encode_q20[o][i] =
                light >= WHITE_Q24 ? WHITE_Q20
                                   : place_q20(l->decode_q24, (int32_t)light);
        }
}

void glint_y4m_light_init(struct glint_y4m_light *light,
                          const struct glint_y4m_header *header)
{
    struct glint_y4m_light *const l = light;
    const int up = header->layout.bits - 8;
    const bool full = header->range == GLINT_RANGE_FULL;
    const bool is_709 = header->matrix == GLINT_MATRIX_BT709;

    l->layout = header->layout;
    l->width = header->width;
    l->height = header->height;
    l->most = (1 << header->layout.bits) - 1;
    l->black = full ? 0 : 16 << up;
    l->y_span = full ? l->most : 219 << up;
    l->c_span = full ? l->most : 224 << up;
    l->kr_q16 = is_709 ? 13933 : 19595;
    l->kb_q16 = is_709 ? 4732 : 7471;
    l->kg_q16 = 65536 - l->kr_q16 - l->kb_q16;
    l->y_factor = y4m_share_factor(20, l->y_span);
    l->c_factor = y4m_share_factor(20, l->c_span);
    l->cb_factor = y4m_share_factor(15, 65536 - l->kb_q16);
    l->cr_factor = y4m_share_factor(15, 65536 - l->kr_q16);
    l->g_factor = y4m_part_factor(l->kg_q16);
    fill_tables(l);
}

static int32_t decode(const struct glint_y4m_light *l, int32_t v_q20)
{
    const int32_t *const at = l->decode_q24 + (v_q20 >> 8);

    if (v_q20 >= WHITE_Q20)
        return WHITE_Q24;
    return at[0] +
           (int32_t)(((int64_t)(at[1] - at[0]) * (v_q20 & 255) + 128) >> 8);
}

static int32_t encode(const struct glint_y4m_light *l, int64_t light)
{
    int octave = 0;
    int64_t place; /* place in the octave, with 16 fraction bits of an entry */
    const int32_t *at;

    if (light >= WHITE_Q24)
        return WHITE_Q20;
    if (light < 1)
        return 0;
    while (light >> (octave + 1))
        octave++;
    place = ((light - (INT64_C(1) << octave)) * GLINT_Y4M_IN_OCTAVE << 16) >>
            octave;
    at = l->encode_q20[octave] + (place >> 16);
    return at[0] +
           (int32_t)(((at[1] - at[0]) * (place & 0xffff) + 0x8000) >> 16);
}

/* ------------------------------------------------------------------ planes */

struct plane {
    uint8_t *at;
    int size[2];
    bool is_wide;
};

static void find_planes(const struct glint_y4m_layout *layout, int width,
                        int height, uint8_t *planes, struct plane plane[4])
{
    for (int p = 0; p < 4; p++) {
        glint_y4m_layout_size(layout, p, width, height, plane[p].size);
        plane[p].is_wide = layout->bits > 8;
        plane[p].at = planes;
        planes += (size_t)plane[p].size[0] * (size_t)plane[p].size[1] *
                  (plane[p].is_wide ? 2 : 1);
    }
}

static int32_t take(const struct plane *p, int x, int y)
{
    const size_t i = (size_t)y * (size_t)p->size[0] + (size_t)x;

    return p->is_wide ? p->at[2 * i] | p->at[2 * i + 1] << 8 : p->at[i];
}

static void put(const struct plane *p, int x, int y, int32_t code)
{
    const size_t i = (size_t)y * (size_t)p->size[0] + (size_t)x;

    if (p->is_wide) {
        p->at[2 * i] = (uint8_t)code;
        p->at[2 * i + 1] = (uint8_t)(code >> 8);
    } else {
        p->at[i] = (uint8_t)code;
    }
}

void glint_y4m_light_proxy(const struct glint_y4m_layout *layout,
                           const struct glint_image *image,
                           const uint8_t *planes)
{
    const int down = layout->bits - 8;
    struct plane plane[4];

    find_planes(layout, image->width, image->height, (uint8_t *)planes, plane);
    for (int p = 0; p < glint_image_planes(image->format); p++) {
        const int width =
            (int)glint_image_row_bytes(image->format, p, image->width);
        const int height =
            glint_image_plane_height(image->format, p, image->height);

        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const int from = layout->is_411 && p > 0 ? x / 2 : x;
                const int32_t code = take(&plane[p], from, y) >> down;

                image->plane[p][y * image->stride_bytes[p] + x] =
                    (uint8_t)(code < 255 ? code : 255);
            }
    }
}

void glint_y4m_light_blacken(const struct glint_y4m_light *light,
                             uint8_t *planes)
{
    struct plane plane[4];

    find_planes(&light->layout, light->width, light->height, planes, plane);
    for (int p = 0; p < 3; p++)
        for (int y = 0; y < plane[p].size[1]; y++)
            for (int x = 0; x < plane[p].size[0]; x++)
                put(&plane[p], x, y,
                    p ? 1 << (light->layout.bits - 1) : light->black);
}

/* ------------------------------------------------------------------- adding */

static int32_t held(int64_t v, int32_t most)
{
    return v < 0 ? 0 : v > most ? most : (int32_t)v;
}

/* Sets RGB to R', G', B', clamped to 0 .. 1, of YCC: the code of Y', and the
 * codes of Cb and Cr less their middle. */
static void to_rgb(const struct glint_y4m_light *l, const int32_t ycc[3],
                   int32_t rgb_q20[3])
{
    const int64_t y = y4m_share(ycc[0] - l->black, l->y_factor);
    const int64_t cb = y4m_share(ycc[1], l->c_factor);
    const int64_t cr = y4m_share(ycc[2], l->c_factor);
    const int64_t r = y + y4m_halve((65536 - l->kr_q16) * cr, 15);
    const int64_t b = y + y4m_halve((65536 - l->kb_q16) * cb, 15);

    rgb_q20[0] = held(r, WHITE_Q20);
    rgb_q20[1] = y4m_part(65536 * y - l->kr_q16 * r - l->kb_q16 * b, l->kg_q16,
                          l->g_factor);
    rgb_q20[2] = held(b, WHITE_Q20);
}

/* Sets the changes of Y', Cb and Cr, _q20, that the light of LAYER makes on a
 * pixel of YCC of which COVER_Q8 is hidden. */
static void change_of(const struct glint_y4m_light *l, const int32_t ycc[3],
                      const float *layer, int cover_q8, int64_t change_q20[3])
{
    int32_t rgb_q20[3];
    int64_t d[3], y;

    to_rgb(l, ycc, rgb_q20);
    for (int c = 0; c < 3; c++) {
        const float light = layer[c] > 4 ? 4 : layer[c] > 0 ? layer[c] : 0;

        const int32_t own = decode(l, rgb_q20[c]);
        const int64_t left =
            cover_q8 ? ((int64_t)own * (256 - cover_q8) + 128) >> 8 : own;

        d[c] = encode(l, left + (int64_t)(light * WHITE_Q24)) - rgb_q20[c];
        if (!cover_q8 && (d[c] < 0 || !(light > 0)))
            d[c] = 0;
    }
    y = y4m_halve(l->kr_q16 * d[0] + l->kg_q16 * d[1] + l->kb_q16 * d[2], 16);
    change_q20[0] = y;
    change_q20[1] = y4m_share((int32_t)(d[2] - y), l->cb_factor);
    change_q20[2] = y4m_share((int32_t)(d[0] - y), l->cr_factor);
}

static bool is_lit(const float *layer)
{
    return layer[0] > 0 || layer[1] > 0 || layer[2] > 0;
}

/* Returns SUM_Q20 / COUNT as a whole number. COUNT is 1 .. 4; 3 occurs only at
 * the right edge of 4:1:1. */
static int64_t mean_of(int64_t sum_q20, int count)
{
    const int64_t whole = 3 * (int64_t)WHITE_Q20;

    if (count != 3)
        return y4m_halve(sum_q20, 20 + count / 2);
    return sum_q20 < 0 ? -((2 * -sum_q20 + whole) / (2 * whole))
                       : (2 * sum_q20 + whole) / (2 * whole);
}

/* the pixels X0 .. X1 - 1, Y0 .. Y1 - 1 that share a chroma sample */
struct block {
    int x, y; /* place of the chroma sample */
    int x0, y0, x1, y1;
};

/* COVER_Q8: as LAYER, one of a pixel; NULL: nothing is hidden. */
static void add_to_block(const struct glint_y4m_light *l, struct plane plane[4],
                         const struct block *b, const float *layer,
                         const uint16_t *cover_q8)
{
    const bool is_grey = plane[1].size[0] == 0;
    const int32_t middle = 1 << (l->layout.bits - 1);
    const int count = (b->x1 - b->x0) * (b->y1 - b->y0);
    int64_t sum[2] = {0, 0};
    int32_t ycc[3] = {0, 0, 0};

    for (int c = 1; c < 3 && !is_grey; c++)
        ycc[c] = take(&plane[c], b->x, b->y) - middle;
    for (int y = b->y0; y < b->y1; y++)
        for (int x = b->x0; x < b->x1; x++) {
            const size_t at = (size_t)y * (size_t)l->width + (size_t)x;
            const float *const light = layer + 3 * at;
            const int cover = cover_q8 ? cover_q8[at] : 0;
            int64_t change[3];

            if (!cover && !is_lit(light))
                continue;
            ycc[0] = take(&plane[0], x, y);
            change_of(l, ycc, light, cover, change);
            put(&plane[0], x, y,
                held(ycc[0] + y4m_halve(change[0] * l->y_span, 20), l->most));
            sum[0] += change[1];
            sum[1] += change[2];
        }
    for (int c = 1; c < 3 && !is_grey; c++)
        put(&plane[c], b->x, b->y,
            held(middle + ycc[c] + mean_of(sum[c - 1] * l->c_span, count),
                 l->most));
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

void glint_y4m_light_add(const struct glint_y4m_light *light, uint8_t *planes,
                         const float *layer)
{
    glint_y4m_light_cover(light, planes, layer, NULL);
}

void glint_y4m_light_cover(const struct glint_y4m_light *light, uint8_t *planes,
                           const float *layer, const uint16_t *cover_q8)
{
    const struct glint_y4m_light *const l = light;
    const bool is_grey = l->layout.format == GLINT_GREY;
    const int across = l->layout.is_411                            ? 4
                       : l->layout.format == GLINT_I444 || is_grey ? 1
                                                                   : 2;
    const int down = l->layout.format == GLINT_I420 ? 2 : 1;
    struct plane plane[4];

    find_planes(&l->layout, l->width, l->height, planes, plane);
    for (int y = 0; y < l->height; y += down)
        for (int x = 0; x < l->width; x += across) {
            const struct block block = {x / across,
                                        y / down,
                                        x,
                                        y,
                                        least(x + across, l->width),
                                        least(y + down, l->height)};

            add_to_block(l, plane, &block, layer, cover_q8);
        }
}
