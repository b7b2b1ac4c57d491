/* SPDX-License-Identifier: MIT */
#include "tile/resolve.h"

#include "base/compiler.h"
#include "base/q.h"

/* Part of a picture that one tile covers, and its sums. */
struct patch {
    int x0, y0, x1, y1;
    int stride;
    const int32_t *acc_q20[3]; /* R, G, B */
};

/* Rank of (x, y) among the 64 thresholds of the recursive ordered dither: the
 * bits of x ^ y and y, interleaved, lowest first. */
static int bayer_rank(int x, int y)
{
    int rank = 0;

    for (int bit = 0; bit < 3; bit++)
        rank = rank * 4 + ((x ^ y) >> bit & 1) * 2 + (y >> bit & 1);
    return rank;
}

void glint_resolve_init(struct glint_resolve *resolve,
                        const struct glint_image *image, int dither)
{
    glint_curve_init(&resolve->curve, image->transfer);
    glint_ycc_init(&resolve->ycc, image->matrix, image->range);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            resolve->round_q7[y][x] = dither ? 2 * bayer_rank(x, y) + 1 : 64;
}

/* Light to add: 0 .. white, since more saturates whatever is there. Twice white
 * lifts a channel below black, too. */
static int32_t light_of_sum_q20(int32_t sum_q20)
{
    return q_clamp_sat(sum_q20, 0, 2 * LINEAR_WHITE_Q20);
}

static uint8_t code_plus_light(const struct glint_curve *curve, uint8_t code,
                               int32_t sum_q20, int32_t round_q7)
{
    const int32_t light_q20 =
        curve->decode_q20[code] + light_of_sum_q20(sum_q20);

    if (sum_q20 <= 0)
        return code;
    return (uint8_t)((curve_encode(curve, light_q20) + round_q7) >> 7);
}

static void resolve_rgb24(const struct glint_resolve *r,
                          const struct glint_image *image,
                          const struct patch *p)
{
    for (int y = p->y0; y < p->y1; y++) {
        const int row = (y - p->y0) * p->stride;
        uint8_t *px = image->plane[0] + y * image->stride_bytes[0] + 3 * p->x0;

        for (int x = p->x0; x < p->x1; x++, px += 3)
            for (int i = 0; i < 3; i++)
                px[i] = code_plus_light(&r->curve, px[i],
                                        p->acc_q20[i][row + x - p->x0],
                                        r->round_q7[y & 7][x & 7]);
    }
}

/* Change of the full-range code CODE_Q7 under LIGHT_Q20: never below 0. */
static int32_t change_q7(const struct glint_curve *curve, int32_t code_q7,
                         int32_t light_q20)
{
    const int32_t held_q7 = q_clamp_sat(code_q7, -CODE_WHITE_Q7, CODE_WHITE_Q7);

    return curve_encode(curve, curve_decode(curve, held_q7) + light_q20) -
           held_q7;
}

static uint8_t to_code(int code)
{
    return (uint8_t)q_clamp_sat(code, 0, 255);
}

/* Luminance of what is added at sum I, BT.709: weights of sum 1. */
static int32_t luminance_q20(const struct patch *p, int i)
{
    const int64_t sum_q35 =
        light_of_sum_q20(p->acc_q20[0][i]) * (int64_t)Q_CONST(0.2126, 15) +
        light_of_sum_q20(p->acc_q20[1][i]) * (int64_t)Q_CONST(0.7152, 15) +
        light_of_sum_q20(p->acc_q20[2][i]) * (int64_t)Q_CONST(0.0722, 15);

    return q_narrow(q_shift(sum_q35, 15));
}

static uint8_t grey_plus_light(const struct glint_resolve *r, uint8_t code,
                               int32_t light_q20, int32_t round_q7)
{
    const int32_t code_q7 =
        ((code - r->ycc.black) * r->ycc.to_rgb_q16[0][0] + (1 << 8)) >> 9;
    const int32_t *y_q15 = r->ycc.to_ycc_q15[0];
    const int64_t change_q22 =
        (int64_t)change_q7(&r->curve, code_q7, light_q20) *
        (y_q15[0] + y_q15[1] + y_q15[2]);

    return to_code(code + (int)((change_q22 + (round_q7 << 15)) >> 22));
}

static void resolve_grey(const struct glint_resolve *r,
                         const struct glint_image *image, const struct patch *p)
{
    for (int y = p->y0; y < p->y1; y++) {
        const int row = (y - p->y0) * p->stride;
        uint8_t *px = image->plane[0] + y * image->stride_bytes[0];

        for (int x = p->x0; x < p->x1; x++) {
            const int32_t light_q20 = luminance_q20(p, row + x - p->x0);

            if (light_q20 > 0)
                px[x] = grey_plus_light(r, px[x], light_q20,
                                        r->round_q7[y & 7][x & 7]);
        }
    }
}

/* Change of channel J (0 Y, 1 Cb, 2 Cr) where R', G', B' change by CHANGE. */
static int64_t ycc_change_q22(const struct glint_ycc *ycc, int j,
                              const int32_t change[3])
{
    return (int64_t)change[0] * ycc->to_ycc_q15[j][0] +
           (int64_t)change[1] * ycc->to_ycc_q15[j][1] +
           (int64_t)change[2] * ycc->to_ycc_q15[j][2];
}

/* Adds sum I to one pixel's *LUMA; its change of R', G', B' goes to TOTAL_Q7.
 * Returns whether there was light. */
static int luma_plus_light(const struct glint_resolve *r, const struct patch *p,
                           int i, uint8_t *luma, int cb, int cr,
                           int32_t round_q7, int32_t total_q7[3])
{
    int32_t rgb_q7[3], added_q7[3];
    int64_t luma_q22;

    if (p->acc_q20[0][i] <= 0 && p->acc_q20[1][i] <= 0 && p->acc_q20[2][i] <= 0)
        return 0;
    ycc_to_rgb(&r->ycc, *luma, cb, cr, rgb_q7);
    for (int k = 0; k < 3; k++) {
        added_q7[k] =
            change_q7(&r->curve, rgb_q7[k], light_of_sum_q20(p->acc_q20[k][i]));
        total_q7[k] += added_q7[k];
    }
    luma_q22 = ycc_change_q22(&r->ycc, 0, added_q7) + (round_q7 << 15);
    *luma = to_code(*luma + (int)(luma_q22 >> 22));
    return 1;
}

/* One Cb, Cr pair and the 1, 2 or 4 pixels that share it. */
struct block {
    int x, y;             /* first pixel */
    int log2_nx, log2_ny; /* pixels that exist */
    uint8_t *cb, *cr;
    int32_t chroma_round_q7;
};

static void resolve_block(const struct glint_resolve *r,
                          const struct glint_image *image,
                          const struct patch *p, const struct block *b)
{
    const int log2_n = b->log2_nx + b->log2_ny;
    const int64_t round_q22 = (int64_t)b->chroma_round_q7 << (15 + log2_n);
    int32_t total_q7[3] = {0, 0, 0};
    int lit = 0;

    for (int y = b->y; y < b->y + (1 << b->log2_ny); y++) {
        const int row = (y - p->y0) * p->stride;
        uint8_t *luma = image->plane[0] + y * image->stride_bytes[0];

        for (int x = b->x; x < b->x + (1 << b->log2_nx); x++)
            lit |= luma_plus_light(r, p, row + x - p->x0, luma + x, *b->cb,
                                   *b->cr, r->round_q7[y & 7][x & 7], total_q7);
    }
    if (!lit)
        return;
    *b->cb = to_code(*b->cb +
                     (int)((ycc_change_q22(&r->ycc, 1, total_q7) + round_q22) >>
                           (22 + log2_n)));
    *b->cr = to_code(*b->cr +
                     (int)((ycc_change_q22(&r->ycc, 2, total_q7) + round_q22) >>
                           (22 + log2_n)));
}

/* Chroma halved LOG2_X times across and LOG2_Y times down: 0 or 1. */
static void resolve_ycc(const struct glint_resolve *r,
                        const struct glint_image *image, const struct patch *p,
                        int log2_x, int log2_y)
{
    for (int y = p->y0; y < p->y1; y += 1 << log2_y) {
        const int cy = y >> log2_y;
        uint8_t *cb = image->plane[1] + cy * image->stride_bytes[1];
        uint8_t *cr = image->plane[2] + cy * image->stride_bytes[2];

        for (int x = p->x0; x < p->x1; x += 1 << log2_x) {
            const int cx = x >> log2_x;
            const struct block b = {.x = x,
                                    .y = y,
                                    .log2_nx = x + 1 < p->x1 ? log2_x : 0,
                                    .log2_ny = y + 1 < p->y1 ? log2_y : 0,
                                    .cb = cb + cx,
                                    .cr = cr + cx,
                                    .chroma_round_q7 =
                                        r->round_q7[cy & 7][cx & 7]};

            resolve_block(r, image, p, &b);
        }
    }
}

static void resolve_linear(const struct glint_image *image,
                           const struct patch *p)
{
    for (int y = p->y0; y < p->y1; y++) {
        const int row = (y - p->y0) * p->stride;
        int32_t *px_q20 =
            (int32_t *)(void *)(image->plane[0] + y * image->stride_bytes[0]) +
            3 * p->x0;

        for (int x = p->x0; x < p->x1; x++, px_q20 += 3)
            for (int i = 0; i < 3; i++)
                px_q20[i] = q_clamp_sat((int64_t)px_q20[i] +
                                            p->acc_q20[i][row + x - p->x0],
                                        INT32_MIN, INT32_MAX);
    }
}

void glint_resolve_tile(const struct glint_resolve *resolve,
                        const struct glint_image *image, int x0, int y0, int x1,
                        int y1, const struct glint_resolve_light *light)
{
    const struct patch p = {
        .x0 = x0,
        .y0 = y0,
        .x1 = x1,
        .y1 = y1,
        .stride = light->stride,
        .acc_q20 = {light->rgb_q20[0], light->rgb_q20[1], light->rgb_q20[2]}};

    switch (image->format) {
    case GLINT_RGB24:
        resolve_rgb24(resolve, image, &p);
        break;
    case GLINT_GREY:
        resolve_grey(resolve, image, &p);
        break;
    case GLINT_I420:
        resolve_ycc(resolve, image, &p, 1, 1);
        break;
    case GLINT_I422:
        resolve_ycc(resolve, image, &p, 1, 0);
        break;
    case GLINT_I444:
        resolve_ycc(resolve, image, &p, 0, 0);
        break;
    case GLINT_LINEAR_Q20:
        resolve_linear(image, &p);
        break;
    }
}
