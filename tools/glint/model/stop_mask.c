/* SPDX-License-Identifier: MIT */
#include <stddef.h>
#include <stdlib.h>

#include "formats/picture.h"
#include "model/stop_mask.h"

static void read_luma_codes(const struct glint_image *image, uint8_t *to)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const uint8_t *p =
                image->plane[0] + (ptrdiff_t)y * image->stride_bytes[0] + 3 * x;

            *to++ = (uint8_t)((p[0] * 54 + p[1] * 183 + p[2] * 19) >> 8);
        }
}

int stop_mask_read_image(const struct tool *tool, const char *file,
                         struct stop_mask *mask)
{
    struct glint_error error = {""};
    struct glint_image image = {0};
    const enum glint_status status = glint_picture_load(file, &image, &error);

    *mask = (struct stop_mask){NULL, image.width, image.height};
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    mask->luma = malloc((size_t)image.width * (size_t)image.height);
    if (mask->luma)
        read_luma_codes(&image, mask->luma);
    glint_picture_free(&image);
    return mask->luma ? EXIT_OK : tool_fail(tool, GLINT_E_MEMORY, NULL);
}
