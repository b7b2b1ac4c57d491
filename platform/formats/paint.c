/* SPDX-License-Identifier: MIT */
#include "formats/paint.h"

#include <stdbool.h>
#include <string.h>

/* ------------------------------------------------------------------- colour */

static uint8_t round_to_code(double value)
{
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value + 0.5);
}

void paint_set_colour(struct paint *p, uint8_t r, uint8_t g, uint8_t b)
{
    const bool hd = p->image->matrix == GLINT_MATRIX_BT709;
    const bool full = p->image->range == GLINT_RANGE_FULL;
    const double kr = hd ? 0.2126 : 0.299, kb = hd ? 0.0722 : 0.114;
    const double y = kr * r + (1 - kr - kb) * g + kb * b;
    const double chroma = full ? 0.5 : 112.0 / 255;

    p->rgb[0] = r;
    p->rgb[1] = g;
    p->rgb[2] = b;
    p->ycc[0] = round_to_code(full ? y : 16 + y * 219 / 255);
    p->ycc[1] = round_to_code(128 + chroma * (b - y) / (1 - kb));
    p->ycc[2] = round_to_code(128 + chroma * (r - y) / (1 - kr));
}

/* ------------------------------------------------------------------- pixels */

static uint8_t *get_pixel_address(const struct glint_image *image, int plane,
                                  int x, int y)
{
    return image->plane[plane] + y * image->stride_bytes[plane] + x;
}

static void set_rgb565_pixel(uint8_t *px, const uint8_t rgb[3])
{
    const int bits = rgb[0] >> 3 << 11 | rgb[1] >> 2 << 5 | rgb[2] >> 3;

    px[0] = (uint8_t)bits;
    px[1] = (uint8_t)(bits >> 8);
}

/* Sets the chroma of a pixel of I420, I422, I444, NV12 or NV21. */
static void set_chroma_of_pixel(const struct paint *p, int x, int y)
{
    const struct glint_image *image = p->image;
    const bool across = image->format != GLINT_I444;
    const bool down = across && image->format != GLINT_I422;
    const int cx = across ? x / 2 : x, cy = down ? y / 2 : y;

    if (image->format == GLINT_NV12 || image->format == GLINT_NV21) {
        const int swapped = image->format == GLINT_NV21;

        *get_pixel_address(image, 1, 2 * cx + swapped, cy) = p->ycc[1];
        *get_pixel_address(image, 1, 2 * cx + !swapped, cy) = p->ycc[2];
    } else {
        *get_pixel_address(image, 1, cx, cy) = p->ycc[1];
        *get_pixel_address(image, 2, cx, cy) = p->ycc[2];
    }
}

/* Sets the luma of a pixel of YUYV or UYVY, and the chroma that it shares with
 * its neighbour. */
static void set_packed_pixel(const struct paint *p, int x, int y)
{
    const int luma = p->image->format == GLINT_YUYV ? 0 : 1;
    uint8_t *pair = get_pixel_address(p->image, 0, x / 2 * 4, y);

    pair[luma + x % 2 * 2] = p->ycc[0];
    pair[1 - luma] = p->ycc[1];
    pair[3 - luma] = p->ycc[2];
}

static void set_rgb_pixel(const struct paint *p, int x, int y, int bytes,
                          bool is_bgr)
{
    uint8_t *px = get_pixel_address(p->image, 0, bytes * x, y);

    for (int i = 0; i < 3; i++)
        px[is_bgr ? 2 - i : i] = p->rgb[i];
}

static void set_pixel_to_colour(const struct paint *p, int x, int y)
{
    if (x < 0 || y < 0 || x >= p->image->width || y >= p->image->height)
        return;
    switch (p->image->format) {
    case GLINT_RGB24:
        set_rgb_pixel(p, x, y, 3, false);
        break;
    case GLINT_BGR24:
        set_rgb_pixel(p, x, y, 3, true);
        break;
    case GLINT_XRGB8888:
        set_rgb_pixel(p, x, y, 4, true);
        break;
    case GLINT_XBGR8888:
        set_rgb_pixel(p, x, y, 4, false);
        break;
    case GLINT_RGB565:
        set_rgb565_pixel(get_pixel_address(p->image, 0, 2 * x, y), p->rgb);
        break;
    case GLINT_YUYV:
    case GLINT_UYVY:
        set_packed_pixel(p, x, y);
        break;
    case GLINT_GREY:
        *get_pixel_address(p->image, 0, x, y) = p->ycc[0];
        break;
    case GLINT_LINEAR_Q20:
        break;
    default:
        *get_pixel_address(p->image, 0, x, y) = p->ycc[0];
        set_chroma_of_pixel(p, x, y);
    }
}

/* ------------------------------------------------------------------- shapes */

void paint_fill_rectangle(const struct paint *p, int x0, int y0, int x1, int y1)
{
    for (int y = y0 < 0 ? 0 : y0; y < y1 && y < p->image->height; y++)
        for (int x = x0 < 0 ? 0 : x0; x < x1 && x < p->image->width; x++)
            set_pixel_to_colour(p, x, y);
}

void paint_square_outline(const struct paint *p, int x, int y, int half)
{
    const int d = p->line;

    paint_fill_rectangle(p, x - half, y - half, x + half + d, y - half + d);
    paint_fill_rectangle(p, x - half, y + half, x + half + d, y + half + d);
    paint_fill_rectangle(p, x - half, y - half, x - half + d, y + half + d);
    paint_fill_rectangle(p, x + half, y - half, x + half + d, y + half + d);
}

/* --------------------------------------------------------------------- text */

/* Returns the glyph of character C: five rows of three pixels in 15 bits, the
 * top left pixel in the highest bit. */
static uint16_t find_glyph_of_character(char c)
{
    static const uint16_t digits[10] = {075557, 026227, 071747, 071717, 055711,
                                        074717, 074757, 071122, 075757, 075717};
    static const uint16_t letters[26] = {
        025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755, 072227,
        011152, 055655, 044447, 057755, 065555, 025552, 065644, 025573, 065655,
        034216, 072222, 055557, 055552, 055775, 055255, 055222, 071247};
    static const struct {
        char c;
        uint16_t glyph;
    } signs[] = {{'%', 051245}, {'.', 000002}, {',', 000024}, {'-', 000700},
                 {'+', 002720}, {':', 002020}, {'/', 011244}};

    if (c >= '0' && c <= '9')
        return digits[c - '0'];
    if (c >= 'a' && c <= 'z')
        return letters[c - 'a'];
    if (c >= 'A' && c <= 'Z')
        return letters[c - 'A'];
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
        if (signs[i].c == c)
            return signs[i].glyph;
    return 0;
}

static void draw_glyph(const struct paint *p, int x, int y, uint16_t glyph)
{
    const int d = p->line;

    for (int i = 0; i < 15; i++)
        if (glyph >> (14 - i) & 1)
            paint_fill_rectangle(p, x + i % 3 * d, y + i / 3 * d,
                                 x + (i % 3 + 1) * d, y + (i / 3 + 1) * d);
}

int paint_text_width(const struct paint *p, const char *text)
{
    return (4 * (int)strlen(text) - 1) * p->line;
}

void paint_text(const struct paint *p, int x, int y, const char *text)
{
    for (int i = 0; text[i]; i++)
        draw_glyph(p, x + 4 * i * p->line, y, find_glyph_of_character(text[i]));
}

/* Sets CODE[0] and CODE[1] to the values of the even and odd bytes of PLANE in
 * a black picture. */
static void get_codes_of_black(const struct glint_image *image, int plane,
                               uint8_t code[2])
{
    const bool limited = !glint_image_is_rgb(image->format) &&
                         image->range == GLINT_RANGE_LIMITED;

    code[0] = code[1] = plane > 0 ? 128 : limited ? 16 : 0;
    if (image->format == GLINT_YUYV)
        code[1] = 128;
    else if (image->format == GLINT_UYVY)
        code[0] = 128;
}

void paint_set_image_black(const struct glint_image *image)
{
    for (int p = 0; p < glint_image_planes(image->format); p++) {
        const int rows =
            glint_image_plane_height(image->format, p, image->height);
        const size_t bytes =
            glint_image_row_bytes(image->format, p, image->width);
        uint8_t code[2];

        get_codes_of_black(image, p, code);
        for (int y = 0; y < rows; y++) {
            uint8_t *row = image->plane[p] + y * image->stride_bytes[p];

            if (code[0] == code[1])
                memset(row, code[0], bytes);
            for (size_t i = 0; i < bytes && code[0] != code[1]; i++)
                row[i] = code[i & 1];
        }
    }
}
