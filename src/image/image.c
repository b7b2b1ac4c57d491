/* SPDX-License-Identifier: MIT */
#include "glint/image.h"

#include "image/layout.h"

static const struct glint_layout layouts[] = {
    [GLINT_RGB24] =
        {GLINT_LAYOUT_RGB, 1, 0, 0, {{0, 0, 3}, {0, 1, 3}, {0, 2, 3}}},
    [GLINT_GREY] =
        {GLINT_LAYOUT_GREY, 1, 0, 0, {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}},
    [GLINT_I420] =
        {GLINT_LAYOUT_YCC, 3, 1, 1, {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}},
    [GLINT_I422] =
        {GLINT_LAYOUT_YCC, 3, 1, 0, {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}},
    [GLINT_I444] =
        {GLINT_LAYOUT_YCC, 3, 0, 0, {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}},
    [GLINT_LINEAR_Q20] =
        {GLINT_LAYOUT_LINEAR, 1, 0, 0, {{0, 0, 12}, {0, 4, 12}, {0, 8, 12}}},
    [GLINT_NV12] =
        {GLINT_LAYOUT_YCC, 2, 1, 1, {{0, 0, 1}, {1, 0, 2}, {1, 1, 2}}},
    [GLINT_NV21] =
        {GLINT_LAYOUT_YCC, 2, 1, 1, {{0, 0, 1}, {1, 1, 2}, {1, 0, 2}}},
    [GLINT_YUYV] =
        {GLINT_LAYOUT_YCC, 1, 1, 0, {{0, 0, 2}, {0, 1, 4}, {0, 3, 4}}},
    [GLINT_UYVY] =
        {GLINT_LAYOUT_YCC, 1, 1, 0, {{0, 1, 2}, {0, 0, 4}, {0, 2, 4}}},
    [GLINT_BGR24] =
        {GLINT_LAYOUT_RGB, 1, 0, 0, {{0, 2, 3}, {0, 1, 3}, {0, 0, 3}}},
    [GLINT_XRGB8888] =
        {GLINT_LAYOUT_RGB, 1, 0, 0, {{0, 2, 4}, {0, 1, 4}, {0, 0, 4}}},
    [GLINT_RGB565] =
        {GLINT_LAYOUT_565, 1, 0, 0, {{0, 0, 2}, {0, 0, 2}, {0, 0, 2}}},
    [GLINT_XBGR8888] = {
        GLINT_LAYOUT_RGB, 1, 0, 0, {{0, 0, 4}, {0, 1, 4}, {0, 2, 4}}}};

const struct glint_layout *glint_get_layout(enum glint_pixel_format format)
{
    return &layouts[format];
}

int glint_image_is_rgb(enum glint_pixel_format format)
{
    const enum glint_layout_kind kind = layouts[format].kind;

    return kind == GLINT_LAYOUT_RGB || kind == GLINT_LAYOUT_565;
}

int glint_image_planes(enum glint_pixel_format format)
{
    return layouts[format].planes;
}

size_t glint_image_row_bytes(enum glint_pixel_format format, int plane,
                             int width)
{
    const struct glint_layout *l = &layouts[format];
    const size_t across = ((size_t)width + 1) / 2;

    if (plane > 0)
        return (l->log2_x ? across : (size_t)width) * (size_t)l->sample[1].step;
    /* A plane of a packed format such as YUYV consists of pairs of pixels that
     * share chroma. */
    if (l->planes == 1 && l->log2_x)
        return across * (size_t)l->sample[1].step;
    return (size_t)width * (size_t)l->sample[0].step;
}

int glint_image_plane_height(enum glint_pixel_format format, int plane,
                             int height)
{
    return plane > 0 && layouts[format].log2_y ? (height + 1) / 2 : height;
}

size_t glint_image_bytes(enum glint_pixel_format format, int width, int height)
{
    uint64_t bytes = 0;

    if (width < 1 || height < 1 || width > GLINT_MAX_SIDE ||
        height > GLINT_MAX_SIDE)
        return 0;
    for (int i = 0; i < glint_image_planes(format); i++)
        bytes += (uint64_t)glint_image_row_bytes(format, i, width) *
                 (uint64_t)glint_image_plane_height(format, i, height);
    return bytes <= PTRDIFF_MAX ? (size_t)bytes : 0;
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
            (ptrdiff_t)glint_image_row_bytes(image->format, i, image->width);
        at += image->stride_bytes[i] *
              glint_image_plane_height(image->format, i, image->height);
    }
}

struct glint_image glint_image_over(void *mem, enum glint_pixel_format format,
                                    int width, int height)
{
    struct glint_image image = {
        .format = format, .width = width, .height = height};

    glint_image_place(&image, mem);
    return image;
}
