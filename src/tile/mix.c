/* SPDX-License-Identifier: MIT */
#include "tile/mix.h"

#include "base/q.h"
#include "tile/curve.h"

#define ALL(x)                                                                \
    {                                                                         \
        (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x), \
            (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x),           \
            (int16_t)(x), (int16_t)(x), (int16_t)(x), (int16_t)(x),           \
            (int16_t)(x), (int16_t)(x), (int16_t)(x)                          \
    }
#define TWICE(a, b, c, d, e, f, g, h)                                         \
    {                                                                         \
        (int16_t)(a), (int16_t)(b), (int16_t)(c), (int16_t)(d), (int16_t)(e), \
            (int16_t)(f), (int16_t)(g), (int16_t)(h), (int16_t)(a),           \
            (int16_t)(b), (int16_t)(c), (int16_t)(d), (int16_t)(e),           \
            (int16_t)(f), (int16_t)(g), (int16_t)(h)                          \
    }

/* clang-format off */
static const struct glint_tone16 srgb = {
    ALL(1320), ALL(5092),
    {TWICE(73, 948, 3361, 7667, 14147, 23039, 34545, 48851),
     TWICE(192, 1548, 3283, 5328, 7632, 10148, 12863, 15745),
     TWICE(680, 862, 1020, 1150, 1258, 1357, 1441, 1525)},
    ALL(205), ALL(52714),
    {ALL(26939), ALL(17886), ALL(-8206), ALL(9008), ALL(-10306)},
    TWICE(1, 4, 16, 64, 256, 0, 0, 0),
    TWICE(34435, 19326, 10846, 6087, 3416, 0, 0, 0),
    ALL(1795), ALL(0x0202)};

static const struct glint_tone16 bt709 = {
    ALL(2644), ALL(14620),
    {TWICE(333, 1922, 5154, 10183, 17136, 26118, 37216, 50506),
     TWICE(793, 2371, 4097, 5963, 7946, 10019, 12173, 14401),
     TWICE(795, 860, 931, 990, 1035, 1078, 1116, 1149)},
    ALL(1180), ALL(18360),
    {ALL(26520), ALL(19025), ALL(-8236), ALL(8791), ALL(-9924)},
    TWICE(1, 4, 16, 64, 256, 0, 0, 0),
    TWICE(35871, 19223, 10301, 5520, 2958, 0, 0, 0),
    ALL(3231), ALL(0x0202)};
/* clang-format on */

const struct glint_tone16 *glint_tone16_of(enum glint_tone transfer)
{
    return transfer == GLINT_TONE_SRGB ? &srgb : &bt709;
}

/* EVEN and ODD by turns. */
static void set_pairs(int16_t *lanes, int64_t even, int64_t odd)
{
    for (int i = 0; i < GLINT_LANES; i++)
        lanes[i] =
            (int16_t)q_clamp_sat(i & 1 ? odd : even, -INT16_MAX, INT16_MAX);
}

static void set(int16_t *lanes, int64_t x)
{
    set_pairs(lanes, x, x);
}

void glint_mix_init(struct glint_mix *mix, const struct glint_image *image)
{
    struct glint_ycc ycc;

    glint_ycc_init(&ycc, image->matrix, image->range);
    mix->tone = *glint_tone16_of(image->transfer);
    set(mix->black, ycc.black);
    set(mix->luma_q15, q_shift(ycc.to_rgb_q16[0][0] - (1 << 16), 1));
    set(mix->red_cr_q15, q_shift(ycc.to_rgb_q16[0][2], 3));
    set(mix->green_cb_q15, q_shift(ycc.to_rgb_q16[1][1], 3));
    set(mix->green_cr_q15, q_shift(ycc.to_rgb_q16[1][2], 3));
    set(mix->blue_cb_q15, q_shift(ycc.to_rgb_q16[2][1], 3));
    for (int c = 0; c < 3; c++) {
        set(mix->to_luma_q15[c], ycc.to_ycc_q15[0][c]);
        set_pairs(mix->to_chroma_q15[c], ycc.to_ycc_q15[1][c],
                  ycc.to_ycc_q15[2][c]);
    }
}
