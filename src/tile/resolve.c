/* SPDX-License-Identifier: MIT */
#include "tile/resolve.h"

#include "base/q.h"
#include "tile/mix.h"

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
                        const struct glint_image *image, int dither,
                        unsigned sets)
{
    glint_mix_init(&resolve->mix, image);
    glint_kernels_init(&resolve->kernels, sets);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            resolve->round_q7[y][x] =
                (int16_t)(dither ? 2 * bayer_rank(x, y) + 1 : 64);
}

static int padded(int n)
{
    return (n + GLINT_LANES - 1) / GLINT_LANES * GLINT_LANES;
}

static void resolve_rgb(const struct glint_resolve *r, int y, int n_x, int n_y,
                        const struct glint_light_rows *light,
                        struct glint_codes *codes)
{
    for (int row = 0; row < n_y; row++)
        for (int c = 0; c < 3; c++)
            r->kernels.add_code(codes->sample[c][row], light->rgb_q16[c][row],
                                padded(n_x), &r->mix.tone,
                                r->round_q7[(y + row) & 7]);
}

/* BT.709: weights of sum 1. */
static void luminance(const struct glint_light_rows *light, int row, int n,
                      uint16_t *grey_q16)
{
    for (int i = 0; i < n; i++)
        grey_q16[i] = (uint16_t)((light->rgb_q16[0][row][i] * UINT32_C(13933) +
                                  light->rgb_q16[1][row][i] * UINT32_C(46871) +
                                  light->rgb_q16[2][row][i] * UINT32_C(4732)) >>
                                 16);
}

static void resolve_luma(const struct glint_resolve *r, int y, int n,
                         const uint16_t *const light[3], int row,
                         struct glint_resolve_rows *rows)
{
    struct glint_codes *c = &rows->codes;
    int16_t *const change[3] = {rows->change_q7[0][row],
                                rows->change_q7[1][row],
                                rows->change_q7[2][row]};

    r->kernels.add_luma(c->sample[0][row], c->spread[0], c->spread[1], light,
                        change, padded(n), &r->mix, r->round_q7[y & 7]);
}

/* The mean change of a channel over the 2^LOG2 pixels that share a sample. */
static int32_t mean_q7(const int16_t (*change)[GLINT_CODES_WIDTH], int i,
                       int n_x, int n_y)
{
    const int log2 = (n_x > 1) + (n_y > 1);
    int32_t sum = 0;

    for (int y = 0; y < n_y; y++)
        for (int x = 0; x < n_x; x++)
            sum += change[y][i + x];
    return log2 ? (sum + (1 << (log2 - 1))) >> log2 : sum;
}

static uint8_t chroma_plus(const int16_t *weight_q15, int code,
                           const int32_t mean[3], int round_q7)
{
    const int32_t change_q22 = mean[0] * weight_q15[0] +
                               mean[1] * weight_q15[1] +
                               mean[2] * weight_q15[2];

    return (uint8_t)q_clamp_sat(code + ((change_q22 + (round_q7 << 15)) >> 22),
                                0, 255);
}

/* Cb and Cr of one row of samples, the changes of whose pixels begin with row
 * ROW; CY is its place in the picture. */
static void resolve_chroma(const struct glint_resolve *r,
                           const struct glint_layout *l, int x, int cy, int n_x,
                           int n_y, int row, struct glint_resolve_rows *rows)
{
    const int16_t *round = r->round_q7[cy & 7];
    const int step = 1 << l->log2_x;

    for (int i = 0; i < n_x; i += step) {
        const int k = i >> l->log2_x, wide = i + step <= n_x ? step : 1;
        const int round_q7 = round[((x >> l->log2_x) + k) & 7];
        int32_t mean[3];

        for (int c = 0; c < 3; c++)
            mean[c] = mean_q7((const int16_t(*)[GLINT_CODES_WIDTH]) &
                                  rows->change_q7[c][row],
                              i, wide, n_y);
        if (!(mean[0] | mean[1] | mean[2]))
            continue;
        for (int c = 0; c < 2; c++) {
            uint8_t *code = &rows->codes.sample[c + 1][row][k];

            *code = chroma_plus(r->mix.to_chroma_q15[c], *code, mean, round_q7);
        }
    }
}

static void resolve_ycc(const struct glint_resolve *r,
                        const struct glint_image *image, int x, int y, int n_x,
                        int n_y, const struct glint_light_rows *light,
                        struct glint_resolve_rows *rows)
{
    const struct glint_layout *l = glint_layout_of(image->format);
    const int grey = l->kind == GLINT_LAYOUT_GREY;

    for (int row = 0; row < n_y; row++) {
        const uint16_t *rgb[3] = {light->rgb_q16[0][row],
                                  light->rgb_q16[1][row],
                                  light->rgb_q16[2][row]};

        if (grey) {
            luminance(light, row, padded(n_x), rows->grey_q16);
            rgb[0] = rgb[1] = rgb[2] = rows->grey_q16;
        }
        glint_codes_spread(&rows->codes, image->format, row);
        resolve_luma(r, y + row, n_x, rgb, row, rows);
        if (!grey && !l->log2_y)
            resolve_chroma(r, l, x, y + row, n_x, 1, row, rows);
    }
    if (!grey && l->log2_y)
        resolve_chroma(r, l, x, y >> 1, n_x, n_y, 0, rows);
}

void glint_resolve_stretch(const struct glint_resolve *resolve,
                           const struct glint_image *image, int x, int y,
                           int n_x, int n_y,
                           const struct glint_light_rows *light,
                           struct glint_resolve_rows *rows)
{
    const struct glint_layout *l = glint_layout_of(image->format);

    glint_codes_read(&rows->codes, image, x, y, n_x, n_y);
    if (l->kind == GLINT_LAYOUT_RGB || l->kind == GLINT_LAYOUT_565)
        resolve_rgb(resolve, y, n_x, n_y, light, &rows->codes);
    else
        resolve_ycc(resolve, image, x, y, n_x, n_y, light, rows);
    glint_codes_write(&rows->codes, image, x, y, n_x, n_y);
}

void glint_resolve_linear(const struct glint_image *image, int x, int y, int n,
                          const int32_t *const light_q20[3])
{
    int32_t *px_q20 =
        (int32_t *)(void *)(image->plane[0] + y * image->stride_bytes[0]) +
        3 * x;

    for (int i = 0; i < n; i++, px_q20 += 3)
        for (int c = 0; c < 3; c++)
            px_q20[c] = q_clamp_sat((int64_t)px_q20[c] + light_q20[c][i],
                                    INT32_MIN, INT32_MAX);
}
