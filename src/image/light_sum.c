/* SPDX-License-Identifier: MIT */
#include "image/light_sum.h"

#include "base/q.h"

void glint_light_curve_init(struct glint_light_curve *curve,
                            enum glint_tone transfer)
{
    const int32_t *at_q20 = curve->curve.decode_q20;

    glint_curve_init(&curve->curve, transfer);
    for (int i = 0; i < GLINT_LIGHT_CODES; i++) {
        const int code = q_clamp_sat(i - GLINT_LIGHT_BELOW, 0, 255);
        const int is_within = code == i - GLINT_LIGHT_BELOW && code < 255;

        curve->code[i] = (struct glint_light_code){
            at_q20[code], is_within ? at_q20[code + 1] - at_q20[code] : 0};
    }
}

void glint_light_sum_init(struct glint_light_sum *sum,
                          const struct glint_image *image,
                          const struct glint_light_curve *curve)
{
    *sum = (struct glint_light_sum){.image = image,
                                    .layout = glint_get_layout(image->format),
                                    .curve = curve};
    glint_ycc_init(&sum->ycc, image->matrix, image->range);
}

void glint_light_sum_read_pixels(struct glint_light_sum *sum,
                                 struct glint_codes *codes, int x, int y,
                                 int n_x, int n_y)
{
    sum->x = x;
    sum->y = y;
    if (sum->layout->kind != GLINT_LAYOUT_LINEAR &&
        sum->layout->kind != GLINT_LAYOUT_RGB)
        glint_codes_read_pixels(codes, sum->image, x, y, n_x, n_y);
}

/* Clamps CODE to the range of the table and returns its linear light. */
static inline int32_t look_up_light(const struct glint_light_code *code,
                                    int32_t code_q7)
{
    const struct glint_light_code *at =
        code + (code_q7 >> 7) + GLINT_LIGHT_BELOW;

    return at->light_q20 + ((at->rise_q20 * (code_q7 & 127) + 64) >> 7);
}

/* The contribution of Cb and Cr to R', G' and B'. */
struct chroma {
    int32_t r_q16, g_q16, b_q16;
};

static inline struct chroma compute_chroma_offsets(const struct glint_ycc *ycc,
                                                   int cb, int cr)
{
    const int32_t(*by_q16)[3] = ycc->to_rgb_q16;
    const int u = cb - 128, v = cr - 128, half = 1 << 8;

    return (struct chroma){u * by_q16[0][1] + v * by_q16[0][2] + half,
                           u * by_q16[1][1] + v * by_q16[1][2] + half,
                           u * by_q16[2][1] + v * by_q16[2][2] + half};
}

/* Adds the light of a row of a Y'CbCr picture to RGB. Sums stay below 2^27,
 * because a call adds at most GLINT_CODES_WIDTH pixels. The chroma terms are
 * computed once for all pixels that share Cb and Cr. */
static void add_ycc_light(const struct glint_light_sum *s,
                          const struct glint_codes *codes, int row, int from,
                          int to, int64_t rgb_q20[3])
{
    const struct glint_light_code *code = s->curve->code;
    const uint8_t *shared = codes->chroma[s->layout->log2_y ? 0 : row];
    const uint8_t *luma = codes->sample[0][row];
    const int32_t r_q16 = s->ycc.to_rgb_q16[0][0];
    const int32_t g_q16 = s->ycc.to_rgb_q16[1][0];
    const int32_t b_q16 = s->ycc.to_rgb_q16[2][0];
    const int is_shared = s->layout->log2_x, black = s->ycc.black;
    int32_t r_q20 = 0, g_q20 = 0, b_q20 = 0;

    for (int x = from, next; x < to; x = next) {
        const struct chroma part =
            is_shared
                ? compute_chroma_offsets(&s->ycc, shared[x & ~1], shared[x | 1])
                : compute_chroma_offsets(&s->ycc, codes->sample[1][row][x],
                                         codes->sample[2][row][x]);

        next = is_shared ? q_smaller((x | 1) + 1, to) : x + 1;
        for (int i = x; i < next; i++) {
            const int y = luma[i] - black;

            r_q20 += look_up_light(code, (y * r_q16 + part.r_q16) >> 9);
            g_q20 += look_up_light(code, (y * g_q16 + part.g_q16) >> 9);
            b_q20 += look_up_light(code, (y * b_q16 + part.b_q16) >> 9);
        }
    }
    rgb_q20[0] += r_q20;
    rgb_q20[1] += g_q20;
    rgb_q20[2] += b_q20;
}

static void add_565_light(const struct glint_light_sum *s,
                          const struct glint_codes *codes, int row, int from,
                          int to, int64_t rgb_q20[3])
{
    for (int x = from; x < to; x++)
        for (int c = 0; c < 3; c++)
            rgb_q20[c] += s->curve->curve.decode_q20[codes->sample[c][row][x]];
}

/* Adds the light of a row of an R'G'B' picture to RGB. Sums stay below 2^27,
 * because a call adds at most GLINT_CODES_WIDTH pixels. */
static void add_rgb_light(const struct glint_light_sum *s, int y, int from,
                          int to, int64_t rgb_q20[3])
{
    const int32_t *decode_q20 = s->curve->curve.decode_q20;
    const uint8_t *r =
        glint_layout_get_sample_address(s->layout, s->image, 0, from, y);
    const uint8_t *g =
        glint_layout_get_sample_address(s->layout, s->image, 1, from, y);
    const uint8_t *b =
        glint_layout_get_sample_address(s->layout, s->image, 2, from, y);
    const ptrdiff_t end = (ptrdiff_t)(to - from) * s->layout->sample[0].step;
    int32_t r_q20 = 0, g_q20 = 0, b_q20 = 0;

    for (ptrdiff_t i = 0; i < end; i += s->layout->sample[0].step) {
        r_q20 += decode_q20[r[i]];
        g_q20 += decode_q20[g[i]];
        b_q20 += decode_q20[b[i]];
    }
    rgb_q20[0] += r_q20;
    rgb_q20[1] += g_q20;
    rgb_q20[2] += b_q20;
}

static void add_linear_light(const struct glint_light_sum *s, int y, int from,
                             int to, int64_t rgb_q20[3])
{
    for (int c = 0; c < 3; c++)
        for (int x = from; x < to; x++) {
            const int32_t *at_q20 =
                (const int32_t *)(const void *)glint_layout_get_sample_address(
                    s->layout, s->image, c, x, y);

            rgb_q20[c] += *at_q20 > 0 ? *at_q20 : 0;
        }
}

void glint_light_sum_add_row(const struct glint_light_sum *sum,
                             const struct glint_codes *codes, int row, int from,
                             int to, int64_t rgb_q20[3])
{
    switch (sum->layout->kind) {
    case GLINT_LAYOUT_LINEAR:
        add_linear_light(sum, sum->y + row, from, to, rgb_q20);
        break;
    case GLINT_LAYOUT_YCC:
    case GLINT_LAYOUT_GREY:
        add_ycc_light(sum, codes, row, from - sum->x, to - sum->x, rgb_q20);
        break;
    case GLINT_LAYOUT_RGB:
        add_rgb_light(sum, sum->y + row, from, to, rgb_q20);
        break;
    default:
        add_565_light(sum, codes, row, from - sum->x, to - sum->x, rgb_q20);
        break;
    }
}
