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
    resolve->kernels = glint_kernels_of(sets);
    resolve->sets = sets;
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            resolve->round_q7[y][x] =
                (int16_t)(dither ? 2 * bayer_rank(x, y) + 1 : 64);
}

static int padded(int n)
{
    return (n + GLINT_LANES - 1) & -GLINT_LANES;
}

struct glint_stretch glint_stretch_of(const struct glint_resolve *resolve,
                                      const struct glint_image *image, int x,
                                      int y, int n_x, int n_y)
{
    const struct glint_layout *l = glint_layout_of(image->format);
    const int in_place = glint_layout_is_packed(l) && n_x % 2 == 0;
    const struct glint_stretch s = {resolve, image, l,   x,
                                    y,       n_x,   n_y, in_place};

    return s;
}

void glint_stretch_read(const struct glint_stretch *s,
                        struct glint_codes *codes)
{
    if (!s->in_place)
        glint_codes_read(codes, s->image, s->x, s->y, s->n_x, s->n_y);
}

void glint_stretch_write(const struct glint_stretch *s,
                         const struct glint_codes *codes)
{
    if (!s->in_place)
        glint_codes_write(codes, s->image, s->x, s->y, s->n_x, s->n_y);
}

/* So many pixels of it, from AT on. */
struct part {
    const struct glint_stretch *of;
    int at, n;
    struct glint_light_rows *light; /* the stretch's */
};

static void light_of(const struct part *p, int row, const uint16_t *rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = p->light->rgb_q16[c][row] + p->at;
}

static void resolve_rgb(const struct part *p, struct glint_codes *codes)
{
    const struct glint_resolve *r = p->of->resolve;

    for (int row = 0; row < p->of->n_y; row++)
        for (int c = 0; c < 3; c++)
            r->kernels->add_code(codes->sample[c][row] + p->at,
                                 p->light->rgb_q16[c][row] + p->at,
                                 padded(p->n), &r->mix.tone,
                                 r->round_q7[(p->of->y + row) & 7]);
}

/* BT.709: weights of sum 1. */
static void luminance(const uint16_t *const rgb[3], int n, uint16_t *grey_q16)
{
    for (int i = 0; i < n; i++)
        grey_q16[i] = (uint16_t)((rgb[0][i] * UINT32_C(13933) +
                                  rgb[1][i] * UINT32_C(46871) +
                                  rgb[2][i] * UINT32_C(4732)) >>
                                 16);
}

/* One row of chroma for whole pixels. OWN: what B' or R' changes by, LUMA: what
 * Y' does, and two factors of them. */
static void add_chroma(uint8_t *code, const int16_t *own, const int16_t *luma,
                       const int16_t *factor_q15, int n, const int16_t *round)
{
    for (int i = 0; i < n; i++) {
        const int32_t change_q7 = q_mul(own[i], factor_q15[0], 15) -
                                  q_mul(luma[i], factor_q15[1], 15);

        code[i] = (uint8_t)q_clamp_sat(
            code[i] + ((change_q7 + round[i & 7]) >> 7), 0, 255);
    }
}

/* Chroma of its own for every pixel, or none. */
static void resolve_whole(const struct part *p, int row,
                          struct glint_resolve_rows *rows)
{
    const struct glint_resolve *r = p->of->resolve;
    const int grey = p->of->image->format == GLINT_GREY, n = p->n;
    const int16_t *round = r->round_q7[(p->of->y + row) & 7];
    int16_t *const change[3] = {rows->change[0], rows->change[1],
                                rows->change[2]};
    uint8_t *code[3];
    const uint16_t *rgb[3];

    light_of(p, row, rgb);
    for (int c = 0; c < 3; c++)
        code[c] = rows->codes.sample[c][row] + p->at;
    if (grey) {
        luminance(rgb, padded(n), rows->grey_q16);
        rgb[0] = rgb[1] = rgb[2] = rows->grey_q16;
    }
    r->kernels->add_luma(code[0], code[1], code[2], rgb, change, padded(n),
                         &r->mix, round);
    for (int k = 0; k < 2 && !grey; k++)
        add_chroma(code[1 + k], change[1 - k], change[2],
                   r->mix.to_ycc.one +
                       (k ? GLINT_MIX_CR_RED : GLINT_MIX_CB_BLUE),
                   n, round);
}

/* A stretch of odd width ends with half a pair: the other half is the same. */
static void mirror_last(const struct part *p)
{
    const int end = p->at + p->n;

    for (int c = 0; c < 3; c++)
        for (int row = 0; row < p->of->n_y; row++)
            p->light->rgb_q16[c][row][end] = p->light->rgb_q16[c][row][end - 1];
}

static void resolve_pairs(const struct part *p, struct glint_resolve_rows *rows)
{
    const struct glint_resolve *r = p->of->resolve;
    const int log2_y = p->of->layout->log2_y;
    int16_t *const mean[3] = {rows->change[0], rows->change[1],
                              rows->change[2]};

    if (p->n & 1)
        mirror_last(p);
    for (int row = 0; row < p->of->n_y; row++) {
        const enum glint_pair_step step = !log2_y || p->of->n_y == 1
                                              ? GLINT_PAIRS_ALONE
                                          : row == 0 ? GLINT_PAIRS_FIRST
                                                     : GLINT_PAIRS_SECOND;
        const int y = p->of->y + row, cy = y >> log2_y;
        const uint16_t *rgb[3];

        light_of(p, row, rgb);
        r->kernels->add_pairs(rows->codes.sample[0][row] + p->at,
                              rows->codes.chroma[log2_y ? 0 : row] + p->at, rgb,
                              mean, padded(p->n), step, &r->mix,
                              r->round_q7[y & 7], r->round_q7[cy & 7]);
    }
}

/* YUYV and the like, in place; what is left of whole vectors on the side. */
static void resolve_packed(const struct part *p, int row,
                           struct glint_resolve_rows *rows)
{
    const struct glint_resolve *r = p->of->resolve;
    const struct glint_image *image = p->of->image;
    const int y = p->of->y + row, whole = p->n & -GLINT_LANES;
    const int n_rest = 2 * (p->n - whole);
    const int luma_at = p->of->layout->sample[0].offset;
    uint8_t *px = image->plane[0] + y * image->stride_bytes[0] +
                  2 * (ptrdiff_t)(p->of->x + p->at);
    uint8_t *rest = rows->codes.sample[0][0];
    const int16_t *round = r->round_q7[y & 7];
    const uint16_t *rgb[3];

    light_of(p, row, rgb);
    r->kernels->add_packed(px, rgb, whole, luma_at, &r->mix, round, round);
    if (n_rest == 0)
        return;
    for (int c = 0; c < 3; c++) {
        rgb[c] += whole;
        for (int i = p->n; i < whole + GLINT_LANES; i++)
            p->light->rgb_q16[c][row][p->at + i] = 0;
    }
    for (int i = 0; i < 2 * GLINT_LANES; i++)
        rest[i] = i < n_rest ? px[2 * whole + i] : 0;
    r->kernels->add_packed(rest, rgb, GLINT_LANES, luma_at, &r->mix, round,
                           round);
    for (int i = 0; i < n_rest; i++)
        px[2 * whole + i] = rest[i];
}

void glint_resolve_part(const struct glint_stretch *stretch, int at, int n,
                        struct glint_light_rows *light,
                        struct glint_resolve_rows *rows)
{
    const struct glint_layout *l = stretch->layout;
    const struct part p = {stretch, at, n, light};

    if (glint_layout_is_rgb(l))
        resolve_rgb(&p, &rows->codes);
    else if (l->log2_x && !stretch->in_place)
        resolve_pairs(&p, rows);
    else
        for (int row = 0; row < stretch->n_y; row++)
            if (stretch->in_place)
                resolve_packed(&p, row, rows);
            else
                resolve_whole(&p, row, rows);
}

void glint_resolve_stretch(const struct glint_resolve *resolve,
                           const struct glint_image *image, int x, int y,
                           int n_x, int n_y, struct glint_light_rows *light,
                           struct glint_resolve_rows *rows)
{
    const struct glint_stretch s =
        glint_stretch_of(resolve, image, x, y, n_x, n_y);

    glint_stretch_read(&s, &rows->codes);
    glint_resolve_part(&s, 0, n_x, light, rows);
    glint_stretch_write(&s, &rows->codes);
}

int glint_resolve_linear(const struct glint_image *image, int x, int y, int n,
                         const int32_t *const light_q20[3])
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
