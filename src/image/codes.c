/* SPDX-License-Identifier: MIT */
#include "image/codes.h"

enum { WIDTH = GLINT_CODES_WIDTH };

/* Copies N samples. TO_STEP and FROM_STEP are the distances between samples in
 * bytes. Common steps have loops of their own, which compilers can
 * vectorise. */
static inline void copy_strided_samples(uint8_t *restrict to, int to_step,
                                        const uint8_t *restrict from,
                                        int from_step, int n)
{
    if (to_step == 1 && from_step == 1)
        for (int i = 0; i < n; i++)
            to[i] = from[i];
    else if (to_step == 1 && from_step == 2)
        for (int i = 0; i < n; i++)
            to[i] = from[2 * i];
    else if (to_step == 2 && from_step == 1)
        for (int i = 0; i < n; i++)
            to[2 * i] = from[i];
    else
        for (int i = 0; i < n; i++)
            to[(ptrdiff_t)i * to_step] = from[(ptrdiff_t)i * from_step];
}

/* Copies N pixels of three interleaved samples, STEP bytes apart, to one row
 * per channel. */
static inline void split_pixels_by_channel(uint8_t (*sample)[2][WIDTH], int row,
                                           const uint8_t *const from[3],
                                           int step, int n)
{
    for (int i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            sample[c][row][i] = from[c][(ptrdiff_t)i * step];
}

/* Copies one row per channel back to N pixels of three interleaved samples. */
static inline void join_channels_to_pixels(const struct glint_codes *codes,
                                           int row, uint8_t *const to[3],
                                           int step, int n)
{
    for (int i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            to[c][(ptrdiff_t)i * step] = codes->sample[c][row][i];
}

/* Repeats the last of N groups of SIZE samples until the row is full. */
static void repeat_last_group(uint8_t *to, int n, int size)
{
    for (int i = n * size; i < WIDTH; i++)
        to[i] = to[i - size];
}

/* --------------------------------------------------------------------- RGB */

static void read_565_row(struct glint_codes *c, const uint8_t *px, int n,
                         int row)
{
    for (int i = 0; i < n; i++) {
        const int bits = px[2 * i] | px[2 * i + 1] << 8;
        const int r = bits >> 11, g = bits >> 5 & 63, b = bits & 31;

        c->sample[0][row][i] = (uint8_t)(r << 3 | r >> 2);
        c->sample[1][row][i] = (uint8_t)(g << 2 | g >> 4);
        c->sample[2][row][i] = (uint8_t)(b << 3 | b >> 2);
    }
    for (int k = 0; k < 3; k++)
        repeat_last_group(c->sample[k][row], n, 1);
}

/* Returns CODE, 0 .. 255, scaled to 0 .. MOST and rounded. read_565_row()
 * expands codes of 0 .. MOST to 8 bits; this function is the exact inverse. */
static int scale_code_to_max(int code, int most)
{
    return (code * most + 127) / 255;
}

static void write_565_row(const struct glint_codes *c, uint8_t *px, int n,
                          int row)
{
    for (int i = 0; i < n; i++) {
        const int bits = scale_code_to_max(c->sample[0][row][i], 31) << 11 |
                         scale_code_to_max(c->sample[1][row][i], 63) << 5 |
                         scale_code_to_max(c->sample[2][row][i], 31);

        px[2 * i] = (uint8_t)(bits & 255);
        px[2 * i + 1] = (uint8_t)(bits >> 8);
    }
}

static void read_rgb_row(struct glint_codes *c, const struct glint_layout *l,
                         const struct glint_image *image, int x, int y, int n,
                         int row)
{
    const uint8_t *const from[3] = {
        glint_layout_get_sample_address(l, image, 0, x, y),
        glint_layout_get_sample_address(l, image, 1, x, y),
        glint_layout_get_sample_address(l, image, 2, x, y)};

    if (l->sample[0].step == 3)
        split_pixels_by_channel(c->sample, row, from, 3, n);
    else
        split_pixels_by_channel(c->sample, row, from, 4, n);
    for (int k = 0; k < 3; k++)
        repeat_last_group(c->sample[k][row], n, 1);
}

static void write_rgb_row(const struct glint_codes *c,
                          const struct glint_layout *l,
                          const struct glint_image *image, int x, int y, int n,
                          int row)
{
    uint8_t *const to[3] = {glint_layout_get_sample_address(l, image, 0, x, y),
                            glint_layout_get_sample_address(l, image, 1, x, y),
                            glint_layout_get_sample_address(l, image, 2, x, y)};

    if (l->sample[0].step == 3)
        join_channels_to_pixels(c, row, to, 3, n);
    else
        join_channels_to_pixels(c, row, to, 4, n);
}

/* ------------------------------------------------------------------ chroma */

/* Returns whether Cb and Cr alternate in memory. */
static int is_chroma_interleaved(const struct glint_layout *l)
{
    return l->planes == 2 && l->sample[1].offset == 0;
}

static void read_chroma_row(const struct glint_layout *l,
                            const struct glint_image *image, int x, int y,
                            int n, uint8_t *to)
{
    const uint8_t *cb = glint_layout_get_sample_address(l, image, 1, x, y);
    const uint8_t *cr = glint_layout_get_sample_address(l, image, 2, x, y);

    if (glint_layout_is_packed(l))
        copy_strided_samples(to, 1, cb, 2, 2 * n);
    else if (is_chroma_interleaved(l))
        copy_strided_samples(to, 1, cb, 1, 2 * n);
    else {
        copy_strided_samples(to, 2, cb, l->sample[1].step, n);
        copy_strided_samples(to + 1, 2, cr, l->sample[2].step, n);
    }
    repeat_last_group(to, n, 2);
}

static void write_chroma_row(const struct glint_layout *l,
                             const struct glint_image *image, int x, int y,
                             int n, const uint8_t *from)
{
    uint8_t *cb = glint_layout_get_sample_address(l, image, 1, x, y);
    uint8_t *cr = glint_layout_get_sample_address(l, image, 2, x, y);

    if (glint_layout_is_packed(l))
        copy_strided_samples(cb, 2, from, 1, 2 * n);
    else if (is_chroma_interleaved(l))
        copy_strided_samples(cb, 1, from, 1, 2 * n);
    else {
        copy_strided_samples(cb, l->sample[1].step, from, 2, n);
        copy_strided_samples(cr, l->sample[2].step, from + 1, 2, n);
    }
}

/* -------------------------------------------------------------------- rows */

/* Returns the number of channels that have one sample per pixel. These channels
 * come first; channels of lower resolution follow. */
static int count_full_resolution_channels(const struct glint_layout *l)
{
    return l->kind == GLINT_LAYOUT_GREY || l->log2_x ? 1 : 3;
}

static void read_pixel_row(struct glint_codes *c, const struct glint_layout *l,
                           const struct glint_image *image, int x, int y, int n,
                           int row)
{
    for (int i = 0; i < count_full_resolution_channels(l); i++) {
        copy_strided_samples(c->sample[i][row], 1,
                             glint_layout_get_sample_address(l, image, i, x, y),
                             l->sample[i].step, n);
        repeat_last_group(c->sample[i][row], n, 1);
    }
    if (l->kind == GLINT_LAYOUT_GREY)
        for (int i = 0; i < WIDTH; i++)
            c->sample[1][row][i] = c->sample[2][row][i] = 128;
    if (l->log2_x && (row == 0 || !l->log2_y))
        read_chroma_row(l, image, x, y, (n + 1) / 2, c->chroma[row]);
}

static void write_pixel_row(const struct glint_codes *c,
                            const struct glint_layout *l,
                            const struct glint_image *image, int x, int y,
                            int n, int row)
{
    for (int i = 0; i < count_full_resolution_channels(l); i++)
        copy_strided_samples(glint_layout_get_sample_address(l, image, i, x, y),
                             l->sample[i].step, c->sample[i][row], 1, n);
    if (l->log2_x && (row == 0 || !l->log2_y))
        write_chroma_row(l, image, x, y, (n + 1) / 2, c->chroma[row]);
}

void glint_codes_read_pixels(struct glint_codes *codes,
                             const struct glint_image *image, int x, int y,
                             int n_x, int n_y)
{
    const struct glint_layout *l = glint_get_layout(image->format);

    for (int row = 0; row < n_y; row++)
        if (l->kind == GLINT_LAYOUT_565)
            read_565_row(
                codes, glint_layout_get_sample_address(l, image, 0, x, y + row),
                n_x, row);
        else if (l->kind == GLINT_LAYOUT_RGB)
            read_rgb_row(codes, l, image, x, y + row, n_x, row);
        else
            read_pixel_row(codes, l, image, x, y + row, n_x, row);
}

void glint_codes_write_pixels(const struct glint_codes *codes,
                              const struct glint_image *image, int x, int y,
                              int n_x, int n_y)
{
    const struct glint_layout *l = glint_get_layout(image->format);

    for (int row = 0; row < n_y; row++)
        if (l->kind == GLINT_LAYOUT_565)
            write_565_row(
                codes, glint_layout_get_sample_address(l, image, 0, x, y + row),
                n_x, row);
        else if (l->kind == GLINT_LAYOUT_RGB)
            write_rgb_row(codes, l, image, x, y + row, n_x, row);
        else
            write_pixel_row(codes, l, image, x, y + row, n_x, row);
}
