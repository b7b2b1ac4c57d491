/* SPDX-License-Identifier: MIT */
#include "image/resolve.h"

#include "base/q.h"
#include "image/mix.h"

/* Returns the rank of pixel (X, Y), 0 .. 63, among the thresholds of an 8 x 8
 * recursive ordered dither: the bits of x ^ y and y, interleaved, in reverse
 * order. */
static int compute_dither_rank(int x, int y)
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
    glint_mix_set_factors(&resolve->mix, image);
    resolve->kernels = glint_choose_pixel_kernels(sets);
    resolve->sets = sets;
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            resolve->round_q7[y][x] =
                (int16_t)(dither ? 2 * compute_dither_rank(x, y) + 1 : 64);
}

static int round_up_to_lanes(int n)
{
    return (n + GLINT_LANES - 1) & -GLINT_LANES;
}

static void add_light_to_rgb(const struct glint_resolve *r, int y, int n_x,
                             int n_y, const struct glint_light_rows *light,
                             struct glint_codes *codes)
{
    for (int row = 0; row < n_y; row++)
        for (int c = 0; c < 3; c++)
            r->kernels->add_code(codes->sample[c][row], light->rgb_q16[c][row],
                                 round_up_to_lanes(n_x), &r->mix.tone,
                                 r->round_q7[(y + row) & 7]);
}

/* Sets GREY to the luminance of N pixels, with the weights of BT.709, whose sum
 * is 1. */
static void compute_luminance(const struct glint_light_rows *light, int row,
                              int n, uint16_t *grey_q16)
{
    for (int i = 0; i < n; i++)
        grey_q16[i] = (uint16_t)((light->rgb_q16[0][row][i] * UINT32_C(13933) +
                                  light->rgb_q16[1][row][i] * UINT32_C(46871) +
                                  light->rgb_q16[2][row][i] * UINT32_C(4732)) >>
                                 16);
}

/* Adds light to a row CODE of chroma that has one sample per pixel. OWN is the
 * change of B' for Cb, of R' for Cr; LUMA that of Y'; FACTOR[2] converts both
 * to the change of chroma. */
static void add_change_to_chroma(uint8_t *code, const int16_t *own,
                                 const int16_t *luma, const int16_t *factor_q15,
                                 int n, const int16_t *round)
{
    for (int i = 0; i < n; i++) {
        const int32_t change_q7 = q_mul(own[i], factor_q15[0], 15) -
                                  q_mul(luma[i], factor_q15[1], 15);

        code[i] = (uint8_t)q_clamp_sat(
            code[i] + ((change_q7 + round[i & 7]) >> 7), 0, 255);
    }
}

/* Adds light to a row in which each pixel has its own chroma, or to a row of a
 * grey picture. */
static void add_light_to_unpaired_pixels(const struct glint_resolve *r,
                                         const struct glint_image *image, int y,
                                         int n, int row,
                                         const struct glint_light_rows *light,
                                         struct glint_resolve_rows *rows)
{
    const int grey = image->format == GLINT_GREY;
    const uint16_t *rgb[3] = {light->rgb_q16[0][row], light->rgb_q16[1][row],
                              light->rgb_q16[2][row]};
    int16_t *const change[3] = {rows->change[0], rows->change[1],
                                rows->change[2]};
    const int16_t *round = r->round_q7[y & 7];
    uint8_t *code[3] = {rows->codes.sample[0][row], rows->codes.sample[1][row],
                        rows->codes.sample[2][row]};

    if (grey) {
        compute_luminance(light, row, round_up_to_lanes(n), rows->grey_q16);
        rgb[0] = rgb[1] = rgb[2] = rows->grey_q16;
    }
    r->kernels->add_luma(code[0], code[1], code[2], rgb, change,
                         round_up_to_lanes(n), &r->mix, round);
    for (int k = 0; k < 2 && !grey; k++)
        add_change_to_chroma(code[1 + k], change[1 - k], change[2],
                             r->mix.to_ycc.one +
                                 (k ? GLINT_MIX_CR_RED : GLINT_MIX_CB_BLUE),
                             n, round);
}

/* Completes the last pair of a run of odd width: copies the light of the last
 * pixel to the missing pixel. */
static void repeat_last_pixel_in_pair(struct glint_light_rows *light, int n_x,
                                      int n_y)
{
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < n_y; row++)
            light->rgb_q16[c][row][n_x] = light->rgb_q16[c][row][n_x - 1];
}

static void add_light_to_chroma_pairs(const struct glint_resolve *r,
                                      const struct glint_layout *l, int y,
                                      int n_x, int n_y,
                                      struct glint_light_rows *light,
                                      struct glint_resolve_rows *rows)
{
    int16_t *const mean[3] = {rows->change[0], rows->change[1],
                              rows->change[2]};

    if (n_x & 1)
        repeat_last_pixel_in_pair(light, n_x, n_y);
    for (int row = 0; row < n_y; row++) {
        const uint16_t *const rgb[3] = {light->rgb_q16[0][row],
                                        light->rgb_q16[1][row],
                                        light->rgb_q16[2][row]};
        const enum glint_pair_step step = !l->log2_y || n_y == 1
                                              ? GLINT_PAIRS_ALONE
                                          : row == 0 ? GLINT_PAIRS_FIRST
                                                     : GLINT_PAIRS_SECOND;
        const int cy = (y + row) >> l->log2_y;

        r->kernels->add_pairs(rows->codes.sample[0][row],
                              rows->codes.chroma[l->log2_y ? 0 : row], rgb,
                              mean, round_up_to_lanes(n_x), step, &r->mix,
                              r->round_q7[(y + row) & 7], r->round_q7[cy & 7]);
    }
}

/* Adds light in place to packed pictures like YUYV. Pixels after the last
 * whole vector are copied, changed and copied back. */
static void add_light_to_packed_pixels(const struct glint_resolve *r,
                                       const struct glint_layout *l,
                                       const struct glint_image *image, int x,
                                       int y, int n, int row,
                                       struct glint_light_rows *light,
                                       struct glint_resolve_rows *rows)
{
    uint8_t *px =
        image->plane[0] + y * image->stride_bytes[0] + 2 * (ptrdiff_t)x;
    uint8_t *rest = rows->codes.sample[0][0];
    const int luma_at = l->sample[0].offset, whole = n & -GLINT_LANES;
    const int16_t *round = r->round_q7[y & 7];
    const uint16_t *rgb[3] = {light->rgb_q16[0][row], light->rgb_q16[1][row],
                              light->rgb_q16[2][row]};

    r->kernels->add_packed(px, rgb, whole, luma_at, &r->mix, round, round);
    if (whole == n)
        return;
    for (int c = 0; c < 3; c++) {
        rgb[c] += whole;
        for (int i = n; i < whole + GLINT_LANES; i++)
            light->rgb_q16[c][row][i] = 0;
    }
    for (int i = 0; i < 2 * GLINT_LANES; i++)
        rest[i] = i < 2 * (n - whole) ? px[2 * whole + i] : 0;
    r->kernels->add_packed(rest, rgb, GLINT_LANES, luma_at, &r->mix, round,
                           round);
    for (int i = 0; i < 2 * (n - whole); i++)
        px[2 * whole + i] = rest[i];
}

void glint_resolve_add_to_codes(const struct glint_resolve *resolve,
                                const struct glint_image *image, int y, int n_x,
                                int n_y, struct glint_light_rows *light,
                                struct glint_resolve_rows *rows)
{
    const struct glint_layout *l = glint_get_layout(image->format);

    if (l->kind == GLINT_LAYOUT_RGB || l->kind == GLINT_LAYOUT_565)
        add_light_to_rgb(resolve, y, n_x, n_y, light, &rows->codes);
    else if (l->log2_x)
        add_light_to_chroma_pairs(resolve, l, y, n_x, n_y, light, rows);
    else
        for (int row = 0; row < n_y; row++)
            add_light_to_unpaired_pixels(resolve, image, y + row, n_x, row,
                                         light, rows);
}

void glint_resolve_add_to_run(const struct glint_resolve *resolve,
                              const struct glint_image *image, int x, int y,
                              int n_x, int n_y, struct glint_light_rows *light,
                              struct glint_resolve_rows *rows)
{
    const struct glint_layout *l = glint_get_layout(image->format);

    if (glint_layout_is_packed(l) && n_x % 2 == 0) {
        for (int row = 0; row < n_y; row++)
            add_light_to_packed_pixels(resolve, l, image, x, y + row, n_x, row,
                                       light, rows);
        return;
    }
    glint_codes_read_pixels(&rows->codes, image, x, y, n_x, n_y);
    glint_resolve_add_to_codes(resolve, image, y, n_x, n_y, light, rows);
    glint_codes_write_pixels(&rows->codes, image, x, y, n_x, n_y);
}

int glint_resolve_add_to_linear(const struct glint_image *image, int x, int y,
                                int n, const int32_t *const light_q20[3])
{
    int32_t *px_q20 =
        (int32_t *)(void *)(image->plane[0] + y * image->stride_bytes[0]) +
        3 * x;

    int n_held = 0;

    for (int i = 0; i < n; i++, px_q20 += 3)
        for (int c = 0; c < 3; c++) {
            px_q20[c] = q_clamp_sat((int64_t)px_q20[c] + light_q20[c][i],
                                    INT32_MIN, INT32_MAX);
            n_held += px_q20[c] == INT32_MAX || px_q20[c] == INT32_MIN;
        }
    return n_held;
}
