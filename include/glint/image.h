/* SPDX-License-Identifier: MIT
 *
 * glint/image.h - pictures in memory that belongs to the caller.
 */
#ifndef GLINT_IMAGE_H
#define GLINT_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#define GLINT_MAX_SIDE 8192 /* pixels, of either side of a picture */

enum glint_pixel_format {
    GLINT_RGB24,     /* one plane, R G B bytes */
    GLINT_GREY,      /* one plane, Y bytes */
    GLINT_I420,      /* planes Y, Cb, Cr; chroma halved both ways */
    GLINT_I422,      /* planes Y, Cb, Cr; chroma halved across */
    GLINT_I444,      /* planes Y, Cb, Cr */
    GLINT_LINEAR_Q20 /* one plane, three int32 _q20 a pixel, linear R G B */
};

enum glint_range { GLINT_RANGE_FULL, GLINT_RANGE_LIMITED };
enum glint_matrix { GLINT_MATRIX_BT601, GLINT_MATRIX_BT709 };
enum glint_tone { GLINT_TONE_SRGB, GLINT_TONE_BT709 };

/* A picture. Chroma planes of subsampled formats have (side + 1) / 2 samples,
 * so odd sizes are fine. Strides may exceed the row and may be negative. */
struct glint_image {
    enum glint_pixel_format format;
    int width, height; /* pixels, 1 .. GLINT_MAX_SIDE */
    uint8_t *plane[3]; /* first sample of the top row; unused ones NULL */
    ptrdiff_t stride_bytes[3];
    enum glint_range range;   /* of the codes; RGB24: always full */
    enum glint_matrix matrix; /* of Y, Cb, Cr; ignored for RGB24 */
    enum glint_tone transfer; /* from codes to linear light */
};

/* Number of planes of FORMAT, 1 or 3. */
int glint_image_planes(enum glint_pixel_format format);

/* Samples across and down plane PLANE of a WIDTH x HEIGHT picture. */
int glint_image_plane_width(enum glint_pixel_format format, int plane,
                            int width);
int glint_image_plane_height(enum glint_pixel_format format, int plane,
                             int height);

/* Bytes of one sample of plane 0: 1, 3 (RGB24) or 12 (LINEAR_Q20). */
int glint_image_sample_bytes(enum glint_pixel_format format);

/* Bytes of a picture without padding, all planes; 0 if out of range. */
size_t glint_image_bytes(enum glint_pixel_format format, int width, int height);

/* Points the planes of IMAGE into MEM, which has glint_image_bytes() bytes, one
 * after the other without padding; format, width and height are set already. */
void glint_image_place(struct glint_image *image, void *mem);

#endif
