/* SPDX-License-Identifier: MIT */
#include "desk/sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"
#include "formats/paint.h"

enum { GAP = 8, GROUND = 32 };

/* ----------------------------------------------------------------- captions */

static int compute_caption_stroke_width(int width)
{
    return width >= 960 ? 3 : width >= 200 ? 2 : 1;
}

/* Returns the number of bytes of TEXT that fit into the next row of a caption
 * below an image of WIDTH pixels. Rows break at blanks, or within a word that
 * is wider than a row. */
static size_t get_caption_row_length(int width, const char *text)
{
    const int line = compute_caption_stroke_width(width);
    /* number of letters in a row: a letter with its gap is 4 strokes wide, the
     * margins 2 */
    const int fit = (width - 3 * line) / (4 * line);
    const size_t room = fit > 1 ? (size_t)fit : 1;
    size_t n = strlen(text);

    if (n <= room)
        return n;
    for (n = room; n > 0 && text[n] != ' ';)
        n--;
    return n > 0 ? n : room;
}

static const char *skip_caption_blanks(const char *text)
{
    return text + strspn(text, " ");
}

int sheet_count_caption_lines(int width, const char *text)
{
    int rows = 0;

    for (text = skip_caption_blanks(text); *text; rows++)
        text = skip_caption_blanks(text + get_caption_row_length(width, text));
    return rows;
}

static int compute_caption_height(const struct sheet *s)
{
    return (2 + 7 * s->rows) * s->line;
}

void sheet_draw_caption(const struct sheet *s, int k, const char *text)
{
    struct glint_image below = sheet_get_image(s, k);
    struct paint p = {.image = &below, .line = s->line};
    char row[160];

    below.plane[0] += s->height * below.stride_bytes[0];
    below.height = compute_caption_height(s);
    paint_set_colour(&p, 224, 224, 224);
    text = skip_caption_blanks(text);
    for (int i = 0; i < s->rows && *text; i++) {
        const size_t n = get_caption_row_length(s->width, text);

        snprintf(row, sizeof row, "%.*s", (int)n, text);
        paint_text(&p, 2 * s->line, (2 + 7 * i) * s->line, row);
        text = skip_caption_blanks(text + n);
    }
}

/* ------------------------------------------------------------------- sheets */

enum glint_status sheet_open(struct sheet *s, int n, int width, int height,
                             int rows)
{
    uint8_t *mem;
    size_t bytes;

    *s = (struct sheet){.width = width, .height = height, .rows = rows};
    /* number of columns for an approximately square sheet of at most 2400
     * pixels width */
    s->columns = (int)ceil(sqrt(n * (double)(height + 20) / width));
    while (s->columns > 1 && s->columns * (width + GAP) > 2400)
        s->columns--;
    while (s->columns < n && s->columns * (width + GAP) < 700)
        s->columns++;
    s->line = compute_caption_stroke_width(width);
    rows = (n + s->columns - 1) / s->columns;
    s->image = (struct glint_image){
        .format = GLINT_RGB24,
        .width = GAP + s->columns * (width + GAP),
        .height = GAP + rows * (height + compute_caption_height(s) + GAP)};
    bytes = glint_image_bytes(GLINT_RGB24, s->image.width, s->image.height);
    mem = malloc(bytes);
    if (!mem)
        return GLINT_E_MEMORY;
    memset(mem, GROUND, bytes);
    glint_image_place(&s->image, mem);
    for (int k = 0; k < n; k++) {
        const struct glint_image p = sheet_get_image(s, k);

        for (int y = 0; y < height; y++)
            memset(p.plane[0] + y * p.stride_bytes[0], 0, 3 * (size_t)width);
    }
    return GLINT_OK;
}

struct glint_image sheet_get_image(const struct sheet *s, int k)
{
    const int x = GAP + k % s->columns * (s->width + GAP);
    const int y =
        GAP + k / s->columns * (s->height + compute_caption_height(s) + GAP);
    struct glint_image p = s->image;

    p.width = s->width;
    p.height = s->height;
    p.plane[0] += y * p.stride_bytes[0] + 3 * (ptrdiff_t)x;
    return p;
}

void sheet_close(struct sheet *s)
{
    free(s->image.plane[0]);
    s->image.plane[0] = NULL;
}

/* ----------------------------------------------------------------- reducing */

static double convert_code_to_light(double code)
{
    const double x = code / 255;

    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

/* Sets PX to the sRGB codes of the mean light of BIG over the columns X[0] ..
 * X[1] - 1 and rows Y[0] .. Y[1] - 1. LIGHT converts codes to linear light. */
static void compute_mean_pixel(const struct glint_image *big,
                               const double light[256], const int x[2],
                               const int y[2], uint8_t *px)
{
    const double n = (double)(x[1] - x[0]) * (y[1] - y[0]);
    double sum[3] = {0, 0, 0};

    for (int j = y[0]; j < y[1]; j++) {
        const uint8_t *from =
            big->plane[0] + j * big->stride_bytes[0] + 3 * (ptrdiff_t)x[0];

        for (int i = 3 * x[0]; i < 3 * x[1]; i++)
            sum[i % 3] += light[*from++];
    }
    for (int c = 0; c < 3; c++)
        px[c] = (uint8_t)lrint(glint_measure_code(sum[c] / n));
}

enum glint_status sheet_reduce_image(struct glint_image *small,
                                     const struct glint_image *big, int width)
{
    const int w = width < big->width ? width : big->width;
    const int h =
        (int)fmax(1, floor((double)big->height * w / big->width + 0.5));
    double light[256];
    uint8_t *mem = malloc(glint_image_bytes(GLINT_RGB24, w, h));

    if (!mem)
        return GLINT_E_MEMORY;
    *small =
        (struct glint_image){.format = GLINT_RGB24, .width = w, .height = h};
    glint_image_place(small, mem);
    for (int i = 0; i < 256; i++)
        light[i] = convert_code_to_light(i);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            const int x[2] = {(int)((int64_t)i * big->width / w),
                              (int)((int64_t)(i + 1) * big->width / w)};
            const int y[2] = {(int)((int64_t)j * big->height / h),
                              (int)((int64_t)(j + 1) * big->height / h)};

            compute_mean_pixel(big, light, x, y,
                               mem + 3 * ((size_t)j * (size_t)w + (size_t)i));
        }
    return GLINT_OK;
}
