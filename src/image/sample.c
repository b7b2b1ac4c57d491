/* SPDX-License-Identifier: MIT */
#include "base/q.h"
#include "image/curve.h"
#include "image/layout.h"

static uint8_t clamp_to_code(int32_t code_q7)
{
    return (uint8_t)q_clamp_sat(code_q7 >> 7, 0, 255);
}

static void convert_ycc_sample(const struct glint_ycc *ycc, int y, int cb,
                               int cr, uint8_t rgb[3])
{
    int32_t rgb_q7[3];

    convert_ycc_to_rgb(ycc, y, cb, cr, rgb_q7);
    for (int c = 0; c < 3; c++)
        rgb[c] = clamp_to_code(rgb_q7[c]);
}

/* Expands a pixel of 5, 6 and 5 bits to 8 bits per channel. The upper bits are
 * repeated, so that white stays white. */
static void read_565_pixel(const uint8_t *p, uint8_t rgb[3])
{
    const int code = p[0] | p[1] << 8;
    const int r = code >> 11, g = code >> 5 & 63, b = code & 31;

    rgb[0] = (uint8_t)(r << 3 | r >> 2);
    rgb[1] = (uint8_t)(g << 2 | g >> 4);
    rgb[2] = (uint8_t)(b << 3 | b >> 2);
}

static void read_pixel_rgb(const struct glint_layout *layout,
                           const struct glint_image *image,
                           const struct glint_ycc *ycc, int x, int y,
                           uint8_t rgb[3])
{
    const uint8_t *p[3];

    for (int i = 0; i < 3; i++)
        p[i] = glint_layout_get_sample_address(
            layout, image, layout->kind == GLINT_LAYOUT_GREY ? 0 : i, x, y);
    switch (layout->kind) {
    case GLINT_LAYOUT_GREY:
        convert_ycc_sample(ycc, *p[0], 128, 128, rgb);
        break;
    case GLINT_LAYOUT_YCC:
        convert_ycc_sample(ycc, *p[0], *p[1], *p[2], rgb);
        break;
    case GLINT_LAYOUT_565:
        read_565_pixel(p[0], rgb);
        break;
    default:
        for (int c = 0; c < 3; c++)
            rgb[c] = layout->kind == GLINT_LAYOUT_RGB ? *p[c] : 0;
        break;
    }
}

void glint_image_sample(const struct glint_image *image, int columns, int rows,
                        uint8_t *rgb)
{
    const struct glint_layout *const layout = glint_get_layout(image->format);
    struct glint_ycc ycc;

    glint_ycc_init(&ycc, image->matrix, image->range);
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++, rgb += 3)
            read_pixel_rgb(layout, image, &ycc,
                           (2 * i + 1) * image->width / (2 * columns),
                           (2 * j + 1) * image->height / (2 * rows), rgb);
}
