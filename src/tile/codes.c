/* SPDX-License-Identifier: MIT */
#include "tile/codes.h"

static void gather(uint8_t *to, const uint8_t *from, int step, int n)
{
    if (step == 1)
        for (int i = 0; i < n; i++)
            to[i] = from[i];
    else if (step == 2)
        for (int i = 0; i < n; i++)
            to[i] = from[2 * i];
    else if (step == 4)
        for (int i = 0; i < n; i++)
            to[i] = from[4 * i];
    else
        for (int i = 0; i < n; i++)
            to[i] = from[3 * i];
    for (int i = n; i < GLINT_CODES_WIDTH; i++)
        to[i] = to[n - 1];
}

static void scatter(uint8_t *to, const uint8_t *from, int step, int n)
{
    for (int i = 0; i < n; i++)
        to[(ptrdiff_t)i * step] = from[i];
}

/* Samples of channel I across N_X pixels. */
static int across(const struct glint_layout *l, int i, int n_x)
{
    return i && l->log2_x ? (n_x + 1) / 2 : n_x;
}

static int rows(const struct glint_layout *l, int i, int n_y)
{
    return i && l->log2_y ? 1 : n_y;
}

static int channels(const struct glint_layout *l)
{
    return l->kind == GLINT_LAYOUT_GREY ? 1 : 3;
}

static void read_565(struct glint_codes *c, const struct glint_image *image,
                     int x, int y, int n_x, int row)
{
    const uint8_t *px =
        image->plane[0] + (y + row) * image->stride_bytes[0] + 2 * (ptrdiff_t)x;

    for (int i = 0; i < GLINT_CODES_WIDTH; i++) {
        const int bits = px[0] | px[1] << 8;
        const int r = bits >> 11, g = bits >> 5 & 63, b = bits & 31;

        c->sample[0][row][i] = (uint8_t)(r << 3 | r >> 2);
        c->sample[1][row][i] = (uint8_t)(g << 2 | g >> 4);
        c->sample[2][row][i] = (uint8_t)(b << 3 | b >> 2);
        px += i + 1 < n_x ? 2 : 0;
    }
}

/* CODE of 0 .. 255 as one of 0 .. MOST, rounded: those that were widened come
 * back. */
static int fewer(int code, int most)
{
    return (code * most + 127) / 255;
}

static void write_565(const struct glint_codes *c,
                      const struct glint_image *image, int x, int y, int n_x,
                      int row)
{
    uint8_t *px =
        image->plane[0] + (y + row) * image->stride_bytes[0] + 2 * (ptrdiff_t)x;

    for (int i = 0; i < n_x; i++, px += 2) {
        const int bits = fewer(c->sample[0][row][i], 31) << 11 |
                         fewer(c->sample[1][row][i], 63) << 5 |
                         fewer(c->sample[2][row][i], 31);

        px[0] = (uint8_t)(bits & 255);
        px[1] = (uint8_t)(bits >> 8);
    }
}

void glint_codes_read(struct glint_codes *codes,
                      const struct glint_image *image, int x, int y, int n_x,
                      int n_y)
{
    const struct glint_layout *l = glint_layout_of(image->format);

    if (l->kind == GLINT_LAYOUT_565) {
        for (int row = 0; row < n_y; row++)
            read_565(codes, image, x, y, n_x, row);
        return;
    }
    for (int i = 0; i < channels(l); i++)
        for (int row = 0; row < rows(l, i, n_y); row++)
            gather(codes->sample[i][row],
                   glint_layout_at(l, image, i, x, y + row), l->sample[i].step,
                   across(l, i, n_x));
}

void glint_codes_write(const struct glint_codes *codes,
                       const struct glint_image *image, int x, int y, int n_x,
                       int n_y)
{
    const struct glint_layout *l = glint_layout_of(image->format);

    if (l->kind == GLINT_LAYOUT_565) {
        for (int row = 0; row < n_y; row++)
            write_565(codes, image, x, y, n_x, row);
        return;
    }
    for (int i = 0; i < channels(l); i++)
        for (int row = 0; row < rows(l, i, n_y); row++)
            scatter(glint_layout_at(l, image, i, x, y + row),
                    codes->sample[i][row], l->sample[i].step,
                    across(l, i, n_x));
}

void glint_codes_spread(struct glint_codes *codes,
                        enum glint_pixel_format format, int row)
{
    const struct glint_layout *l = glint_layout_of(format);

    for (int i = 0; i < 2; i++) {
        const uint8_t *from = codes->sample[i + 1][l->log2_y ? 0 : row];
        uint8_t *to = codes->spread[i];

        if (l->kind == GLINT_LAYOUT_GREY)
            for (int x = 0; x < GLINT_CODES_WIDTH; x++)
                to[x] = 128;
        else if (l->log2_x)
            for (int x = 0; x < GLINT_CODES_WIDTH / 2; x++)
                to[2 * x] = to[2 * x + 1] = from[x];
        else
            for (int x = 0; x < GLINT_CODES_WIDTH; x++)
                to[x] = from[x];
    }
}
