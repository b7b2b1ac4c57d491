/* SPDX-License-Identifier: MIT */
#include "tile/mix.h"

#include "base/q.h"
#include "tile/curve.h"

/* clang-format off */
static const struct glint_tone16 srgb = {
    1320, 5092,
    {{57, 947, 3360, 7666, 14146, 23038, (int16_t)34544, (int16_t)48850},
     {284, 1578, 3307, 5350, 7649, 10167, 12877, 15762},
     {521, 775, 953, 1091, 1208, 1310, 1401, 1484},
     {85, 60, 47, 39, 34, 30, 28, 26}},
    205, 52714,
    {26939, 17886, -8206, 9008, -10306},
    {1, 4, 16, 64, 256, 0, 0, 0},
    {34435, 19326, 10846, 6087, 3416, 0, 0, 0},
    1795};

static const struct glint_tone16 bt709 = {
    2644, 14620,
    {{314, 1921, 5154, 10183, 17136, 26118, (int16_t)37215, (int16_t)50505},
     {865, 2386, 4106, 5972, 7952, 10026, 12182, 14409},
     {706, 818, 901, 964, 1015, 1059, 1097, 1131},
     {37, 28, 21, 17, 15, 13, 11, 10}},
    1180, 18360,
    {26520, 19025, -8236, 8791, -9924},
    {1, 4, 16, 64, 256, 0, 0, 0},
    {35871, 19223, 10301, 5520, 2958, 0, 0, 0},
    3231};
/* clang-format on */

const struct glint_tone16 *glint_tone16_of(enum glint_tone transfer)
{
    return transfer == GLINT_TONE_SRGB ? &srgb : &bt709;
}

static int16_t narrow(int64_t x)
{
    return (int16_t)q_clamp_sat(x, -INT16_MAX, INT16_MAX);
}

void glint_mix_init(struct glint_mix *mix, const struct glint_image *image)
{
    struct glint_ycc ycc;

    glint_ycc_init(&ycc, image->matrix, image->range);
    mix->tone = *glint_tone16_of(image->transfer);
    mix->black = (int16_t)ycc.black;
    mix->luma_q15 = narrow(q_shift(ycc.to_rgb_q16[0][0] - (1 << 16), 1));
    mix->red_cr_q15 = narrow(q_shift(ycc.to_rgb_q16[0][2], 3));
    mix->green_cb_q15 = narrow(q_shift(ycc.to_rgb_q16[1][1], 3));
    mix->green_cr_q15 = narrow(q_shift(ycc.to_rgb_q16[1][2], 3));
    mix->blue_cb_q15 = narrow(q_shift(ycc.to_rgb_q16[2][1], 3));
    for (int c = 0; c < 3; c++) {
        mix->to_luma_q15[c] = narrow(ycc.to_ycc_q15[0][c]);
        mix->to_chroma_q15[0][c] = narrow(ycc.to_ycc_q15[1][c]);
        mix->to_chroma_q15[1][c] = narrow(ycc.to_ycc_q15[2][c]);
    }
}
