/* SPDX-License-Identifier: MIT
 *
 * Loops here are plain so that compilers turn them into vectors: bytes in,
 * products of 16 bits summed in 32, bytes out.
 */
#include "panel/row_rgb.h"

void glint_split_pairs(uint8_t *restrict a, uint8_t *restrict b,
                       const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[2 * i];
        b[i] = from[2 * i + 1];
    }
}

/* Splits N pairs of pixels whose first luma is byte LUMA_AT, 0 or 1. */
static inline void split_packed(uint8_t *restrict luma, uint8_t *restrict cb,
                                uint8_t *restrict cr,
                                const uint8_t *restrict from, int n,
                                int luma_at)
{
    for (int i = 0; i < n; i++) {
        luma[2 * i] = from[4 * i + luma_at];
        luma[2 * i + 1] = from[4 * i + 2 + luma_at];
        cb[i] = from[4 * i + 1 - luma_at];
        cr[i] = from[4 * i + 3 - luma_at];
    }
}

void glint_split_packed(enum glint_pixel_format format, uint8_t *luma,
                        uint8_t *cb, uint8_t *cr, const uint8_t *from, int n)
{
    if (format == GLINT_YUYV)
        split_packed(luma, cb, cr, from, n, 0);
    else
        split_packed(luma, cb, cr, from, n, 1);
}

/* Splits N groups of BYTES, the first three of which are taken. */
static inline void split_groups(uint8_t *restrict a, uint8_t *restrict b,
                                uint8_t *restrict c,
                                const uint8_t *restrict from, int n, int bytes)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[bytes * i];
        b[i] = from[bytes * i + 1];
        c[i] = from[bytes * i + 2];
    }
}

/* Splits N pixels of GLINT_RGB565 into codes of 8 bits. */
static void split_565(uint8_t *restrict r, uint8_t *restrict g,
                      uint8_t *restrict b, const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t low = from[2 * i], high = from[2 * i + 1];
        const uint8_t green = (uint8_t)((high & 7) << 3 | low >> 5);

        r[i] = (uint8_t)((high & 0xf8) | high >> 5);
        g[i] = (uint8_t)(green << 2 | green >> 4);
        b[i] = (uint8_t)(low << 3 | (low >> 2 & 7));
    }
}

enum { HALF_Q13 = 1 << 12 };

struct mix {
    int black; /* code of Y' = 0 */
    int16_t luma_q13, red_cr_q13, green_cb_q13, green_cr_q13, blue_cb_q13;
};

/* clang-format off */
#define Q13(x) ((int16_t)((x) * 8192 + ((x) < 0 ? -0.5 : 0.5)))
#define MIX(black, luma, chroma, kr, kb) {                                     \
    black, Q13(luma), Q13((chroma) * 2 * (1 - (kr))),                          \
    Q13(-(chroma) * 2 * (1 - (kb)) * (kb) / (1 - (kr) - (kb))),                \
    Q13(-(chroma) * 2 * (1 - (kr)) * (kr) / (1 - (kr) - (kb))),                \
    Q13((chroma) * 2 * (1 - (kb))) }

static const struct mix mixes[2][2] = {
    [GLINT_MATRIX_BT601] = {
        [GLINT_RANGE_FULL] = MIX(0, 1., 1., .299, .114),
        [GLINT_RANGE_LIMITED] = MIX(16, 255. / 219, 255. / 224, .299, .114)},
    [GLINT_MATRIX_BT709] = {
        [GLINT_RANGE_FULL] = MIX(0, 1., 1., .2126, .0722),
        [GLINT_RANGE_LIMITED] = MIX(16, 255. / 219, 255. / 224, .2126, .0722)},
};
/* clang-format on */

/* Terms to add to the products of raw codes: the constants times minus the
 * codes of zero, and a half for rounding. */
struct bias {
    int32_t red, green, blue, grey;
};

static struct bias bias_of(const struct mix *m)
{
    const int32_t grey = HALF_Q13 - m->black * m->luma_q13;

    return (struct bias){
        .red = grey - 128 * m->red_cr_q13,
        .green = grey - 128 * (m->green_cb_q13 + m->green_cr_q13),
        .blue = grey - 128 * m->blue_cb_q13,
        .grey = grey,
    };
}

/* Returns SUM as a code, clamped to 0 .. 255. |SUM| < 2^23, so that the code
 * fits 16 bits even before it is clamped: in vectors half the work of 32
 * bits. */
static inline uint8_t code_of(int32_t sum_q13)
{
    const int16_t code = (int16_t)(sum_q13 >> 13);

    return (uint8_t)(code < 0 ? 0 : code > 255 ? 255 : code);
}

/* Mixes R', G', B' of N pixels, each with Y', Cb and Cr of its own. */
static void mix_pixels(const struct mix *m, uint8_t *restrict r,
                       uint8_t *restrict g, uint8_t *restrict b,
                       const uint8_t *restrict luma, const uint8_t *restrict cb,
                       const uint8_t *restrict cr, int n)
{
    const int16_t ky = m->luma_q13, r_cr = m->red_cr_q13,
                  g_cb = m->green_cb_q13, g_cr = m->green_cr_q13,
                  b_cb = m->blue_cb_q13;
    const struct bias bias = bias_of(m);

    for (int i = 0; i < n; i++) {
        const int32_t y = luma[i] * ky;

        r[i] = code_of(y + cr[i] * r_cr + bias.red);
        g[i] = code_of(y + cb[i] * g_cb + cr[i] * g_cr + bias.green);
        b[i] = code_of(y + cb[i] * b_cb + bias.blue);
    }
}

/* Mixes R', G', B' of N pairs of pixels that share Cb and Cr. */
static void mix_pairs(const struct mix *m, uint8_t *restrict r,
                      uint8_t *restrict g, uint8_t *restrict b,
                      const uint8_t *restrict luma, const uint8_t *restrict cb,
                      const uint8_t *restrict cr, int n)
{
    const int16_t ky = m->luma_q13, r_cr = m->red_cr_q13,
                  g_cb = m->green_cb_q13, g_cr = m->green_cr_q13,
                  b_cb = m->blue_cb_q13;
    const struct bias bias = bias_of(m);

    for (int i = 0; i < n; i++) {
        const int32_t y0 = luma[2 * i] * ky, y1 = luma[2 * i + 1] * ky;
        const int32_t to_r = cr[i] * r_cr + bias.red;
        const int32_t to_g = cb[i] * g_cb + cr[i] * g_cr + bias.green;
        const int32_t to_b = cb[i] * b_cb + bias.blue;

        r[2 * i] = code_of(y0 + to_r);
        r[2 * i + 1] = code_of(y1 + to_r);
        g[2 * i] = code_of(y0 + to_g);
        g[2 * i + 1] = code_of(y1 + to_g);
        b[2 * i] = code_of(y0 + to_b);
        b[2 * i + 1] = code_of(y1 + to_b);
    }
}

static void mix_greys(const struct mix *m, uint8_t *restrict grey,
                      const uint8_t *restrict luma, int n)
{
    const int16_t ky = m->luma_q13;
    const int32_t bias = bias_of(m).grey;

    for (int i = 0; i < n; i++)
        grey[i] = code_of(luma[i] * ky + bias);
}

/* -------------------------------------------------------------------- rows */

struct samples {
    const uint8_t *luma, *cb, *cr;
};

static const uint8_t *row_at(const struct glint_image *image, int plane, int y)
{
    return image->plane[plane] + y * image->stride_bytes[plane];
}

/* Returns Y', Cb, Cr of N pixels of row Y from X on: in the picture itself, or
 * moved apart into ROW if they are interleaved. */
static struct samples find_samples(struct glint_row_rgb *row,
                                   const struct glint_image *image, int x,
                                   int y, int n)
{
    const int half = (n + 1) / 2;
    const int cx = image->format == GLINT_I444 ? x : x / 2;
    const int cy =
        glint_image_plane_height(image->format, 1, 2) == 1 ? y / 2 : y;
    const struct samples moved = {row->luma, row->cb, row->cr};

    switch (image->format) {
    case GLINT_YUYV:
    case GLINT_UYVY:
        glint_split_packed(image->format, row->luma, row->cb, row->cr,
                           row_at(image, 0, y) + 2 * x, half);
        return moved;
    case GLINT_NV12:
        glint_split_pairs(row->cb, row->cr, row_at(image, 1, cy) + x, half);
        return (struct samples){row_at(image, 0, y) + x, row->cb, row->cr};
    case GLINT_NV21:
        glint_split_pairs(row->cr, row->cb, row_at(image, 1, cy) + x, half);
        return (struct samples){row_at(image, 0, y) + x, row->cb, row->cr};
    default:
        return (struct samples){row_at(image, 0, y) + x,
                                row_at(image, 1, cy) + cx,
                                row_at(image, 2, cy) + cx};
    }
}

static void read_ycc(struct glint_row_rgb *row, const struct glint_image *image,
                     int x, int y, int n)
{
    const struct mix *const m = &mixes[image->matrix][image->range];
    const struct samples s = find_samples(row, image, x, y, n);
    uint8_t *const r = row->rgb[0], *const g = row->rgb[1],
                   *const b = row->rgb[2];
    const int even = n & ~1;

    if (image->format == GLINT_I444) {
        mix_pixels(m, r, g, b, s.luma, s.cb, s.cr, n);
        return;
    }
    mix_pairs(m, r, g, b, s.luma, s.cb, s.cr, n / 2);
    if (n > even) /* The second pixel of the last pair may have no luma. */
        mix_pixels(m, r + even, g + even, b + even, s.luma + even,
                   s.cb + even / 2, s.cr + even / 2, 1);
}

void glint_row_rgb_read(struct glint_row_rgb *row,
                        const struct glint_image *image, int x, int y, int n)
{
    uint8_t *const *const c = row->rgb;
    const uint8_t *const from = row_at(image, 0, y);

    for (int i = 0; i < 3; i++)
        row->channel[i] = c[i];
    switch (image->format) {
    case GLINT_GREY:
        mix_greys(&mixes[GLINT_MATRIX_BT601][image->range], c[0], from + x, n);
        row->channel[1] = row->channel[2] = c[0];
        return;
    case GLINT_RGB24:
        split_groups(c[0], c[1], c[2], from + 3 * x, n, 3);
        return;
    case GLINT_BGR24:
        split_groups(c[2], c[1], c[0], from + 3 * x, n, 3);
        return;
    case GLINT_XRGB8888:
        split_groups(c[2], c[1], c[0], from + 4 * x, n, 4);
        return;
    case GLINT_XBGR8888:
        split_groups(c[0], c[1], c[2], from + 4 * x, n, 4);
        return;
    case GLINT_RGB565:
        split_565(c[0], c[1], c[2], from + 2 * x, n);
        return;
    default:
        read_ycc(row, image, x, y, n);
    }
}

/* ------------------------------------------------------------------- memory */

size_t glint_row_rgb_bytes(int width)
{
    return 6 * ((size_t)width + 1);
}

void glint_row_rgb_init(struct glint_row_rgb *row, void *mem, int width)
{
    const ptrdiff_t each = (ptrdiff_t)width + 1; /* room for whole pairs */
    uint8_t *const at = mem;

    for (int i = 0; i < 3; i++)
        row->rgb[i] = at + i * each;
    row->luma = at + 3 * each;
    row->cb = at + 4 * each;
    row->cr = at + 5 * each;
}
