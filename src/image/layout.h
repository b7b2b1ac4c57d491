/* SPDX-License-Identifier: MIT
 *
 * Memory layout of the samples of a picture, for each format. */
#ifndef GLINT_IMAGE_LAYOUT_H
#define GLINT_IMAGE_LAYOUT_H

#include "glint/image.h"

enum glint_layout_kind {
    GLINT_LAYOUT_GREY,
    GLINT_LAYOUT_YCC,
    GLINT_LAYOUT_RGB,
    GLINT_LAYOUT_565,
    GLINT_LAYOUT_LINEAR
};

struct glint_layout {
    enum glint_layout_kind kind;
    int planes;
    int log2_x, log2_y; /* log2 of the number of pixels, horizontally and
                           vertically, that share a sample of chroma */
    /* For each of Y, Cb, Cr or R, G, B: the plane, the bytes from the row's
     * start to the first sample, and the bytes from one sample to the next. */
    struct glint_layout_sample {
        int plane, offset, step;
    } sample[3];
};

const struct glint_layout *glint_get_layout(enum glint_pixel_format format);

/* Returns whether luma and chroma are in the same plane, as in YUYV: every
 * second byte is luma, and the bytes between are Cb and Cr in turn. */
static inline int glint_layout_is_packed(const struct glint_layout *layout)
{
    return layout->planes == 1 && layout->log2_x;
}

/* Returns the address of the sample of channel I that pixel (X, Y) uses. */
static inline uint8_t *
glint_layout_get_sample_address(const struct glint_layout *layout,
                                const struct glint_image *image, int i, int x,
                                int y)
{
    const struct glint_layout_sample *s = &layout->sample[i];
    const int cx = i ? x >> layout->log2_x : x,
              cy = i ? y >> layout->log2_y : y;

    return image->plane[s->plane] + cy * image->stride_bytes[s->plane] +
           s->offset + (ptrdiff_t)cx * s->step;
}

#endif
