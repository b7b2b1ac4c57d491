/* SPDX-License-Identifier: MIT */
#include "overlay/grey.h"

/* Max difference between the channels of a grey pixel, 8-bit codes: for 99 % of
 * the pixels, and for all pixels. Not 0, because JPEG compression and colour
 * profiles add such differences. */
enum { NEARLY_GREY = 2, AT_MOST_GREY = 12 };

static int get_pixel_bytes(const struct glint_image *image)
{
    return image->format == GLINT_RGB24 ? 3 : 4;
}

static int compute_max_channel_difference(const uint8_t px[3])
{
    const int low = px[0] < px[1] ? px[0] : px[1];
    const int high = px[0] < px[1] ? px[1] : px[0];

    return (px[2] > high ? px[2] : high) - (px[2] < low ? px[2] : low);
}

/* All pixels are grey within AT_MOST_GREY and 99 % within NEARLY_GREY. At least
 * a tenth of all pixels are neither nearly black nor nearly white; otherwise
 * IMAGE is a drawing, whose flare has colours. */
bool grey_is_monochrome(const struct glint_image *image)
{
    const int64_t all = (int64_t)image->width * image->height;
    const int step = get_pixel_bytes(image);
    int64_t n = 0, n_tinged = 0;

    for (int y = 0; y < image->height; y++) {
        const uint8_t *px = image->plane[0] + y * image->stride_bytes[0];

        for (int x = 0; x < image->width; x++, px += step) {
            const int codes = compute_max_channel_difference(px);

            if (codes > AT_MOST_GREY)
                return false;
            n_tinged += codes > NEARLY_GREY;
            n += px[1] >= 8 && px[1] < 248;
        }
    }
    return 10 * n >= all && 100 * n_tinged <= all;
}

struct glint_image grey_copy_green(const struct glint_image *from, void *mem)
{
    struct glint_image grey = {.format = GLINT_GREY,
                               .transfer = from->transfer,
                               .width = from->width,
                               .height = from->height};

    glint_image_place(&grey, mem);
    grey.range = GLINT_RANGE_FULL;
    for (int y = 0; y < from->height; y++) {
        uint8_t *to = grey.plane[0] + y * grey.stride_bytes[0];
        const uint8_t *px = from->plane[0] + y * from->stride_bytes[0];

        for (int x = 0; x < from->width; x++, px += get_pixel_bytes(from))
            to[x] = px[1];
    }
    return grey;
}

void grey_add_difference(const struct glint_image *image,
                         const struct glint_image *grey)
{
    const int step = get_pixel_bytes(image);

    for (int y = 0; y < image->height; y++) {
        uint8_t *px = image->plane[0] + y * image->stride_bytes[0];
        const uint8_t *from = grey->plane[0] + y * grey->stride_bytes[0];

        for (int x = 0; x < image->width; x++, px += step) {
            const int more = from[x] - px[1];

            for (int c = 0; c < 3; c++) {
                const int sum = px[c] + more;

                px[c] = (uint8_t)(sum < 0 ? 0 : sum > 255 ? 255 : sum);
            }
        }
    }
}

void grey_convert_light(float *rgb, size_t n)
{
    for (; n > 0; n--, rgb += 3)
        rgb[0] = rgb[1] = rgb[2] =
            0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
}
