/* SPDX-License-Identifier: MIT */
#include "glint/image.h"

int glint_image_planes(enum glint_pixel_format format)
{
    return format == GLINT_I420 || format == GLINT_I422 || format == GLINT_I444
               ? 3
               : 1;
}

int glint_image_plane_width(enum glint_pixel_format format, int plane,
                            int width)
{
    const int halved =
        plane > 0 && (format == GLINT_I420 || format == GLINT_I422);

    return halved ? (width + 1) / 2 : width;
}

int glint_image_plane_height(enum glint_pixel_format format, int plane,
                             int height)
{
    return plane > 0 && format == GLINT_I420 ? (height + 1) / 2 : height;
}

int glint_image_sample_bytes(enum glint_pixel_format format)
{
    return format == GLINT_RGB24 ? 3 : format == GLINT_LINEAR_Q20 ? 12 : 1;
}

static size_t plane_bytes(enum glint_pixel_format format, int plane, int width,
                          int height)
{
    const size_t across = (size_t)glint_image_plane_width(format, plane, width);
    const size_t down = (size_t)glint_image_plane_height(format, plane, height);

    return across * down * (size_t)glint_image_sample_bytes(format);
}

size_t glint_image_bytes(enum glint_pixel_format format, int width, int height)
{
    size_t bytes = 0;

    if (width < 1 || height < 1 || width > GLINT_MAX_SIDE ||
        height > GLINT_MAX_SIDE)
        return 0;
    for (int i = 0; i < glint_image_planes(format); i++)
        bytes += plane_bytes(format, i, width, height);
    return bytes;
}

void glint_image_place(struct glint_image *image, void *mem)
{
    const int n_planes = glint_image_planes(image->format);
    uint8_t *at = mem;

    for (int i = 0; i < 3; i++) {
        image->plane[i] = i < n_planes ? at : NULL;
        image->stride_bytes[i] = 0;
        if (i >= n_planes)
            continue;
        image->stride_bytes[i] =
            (ptrdiff_t)glint_image_plane_width(image->format, i, image->width) *
            glint_image_sample_bytes(image->format);
        at += plane_bytes(image->format, i, image->width, image->height);
    }
}
