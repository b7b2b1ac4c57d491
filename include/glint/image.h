/* SPDX-License-Identifier: MIT
 *
 * glint/image.h - pictures in memory that belongs to the caller.
 */
#ifndef GLINT_IMAGE_H
#define GLINT_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_SIDE 32768 /* max side of a picture, pixels */

enum glint_pixel_format {
    GLINT_RGB24, /* one plane, R G B bytes */
    GLINT_GREY,  /* one plane, Y bytes */
    GLINT_I420,  /* planes Y, Cb, Cr; chroma at half width and half height */
    GLINT_I422,  /* planes Y, Cb, Cr; chroma at half width */
    GLINT_I444,  /* planes Y, Cb, Cr; all of full size */
    GLINT_LINEAR_Q20, /* one plane, linear R G B, three int32 _q20 per pixel */
    GLINT_NV12, /* planes Y and Cb Cr interleaved; chroma at half width and half
                   height */
    GLINT_NV21, /* planes Y and Cr Cb interleaved; chroma at half width and half
                   height */
    GLINT_YUYV, /* one plane, Y Cb Y Cr for two pixels */
    GLINT_UYVY, /* one plane, Cb Y Cr Y for two pixels */
    GLINT_BGR24,    /* one plane, B G R bytes */
    GLINT_XRGB8888, /* one plane, B G R X bytes; X is preserved */
    GLINT_RGB565,   /* one plane, 16 bits per pixel, low byte first, R in the
                       highest bits */
    GLINT_XBGR8888  /* one plane, R G B X bytes; X is preserved */
};

enum glint_range { GLINT_RANGE_FULL, GLINT_RANGE_LIMITED };
enum glint_matrix {
    GLINT_MATRIX_BT601,
    GLINT_MATRIX_BT709,
    GLINT_MATRIX_BT2020 /* BT.2020 with non-constant luminance */
};
enum glint_tone { GLINT_TONE_SRGB, GLINT_TONE_BT709 };

/* A picture. Chroma planes of subsampled formats have (side + 1) / 2 samples,
 * so that sides may be odd. Strides may exceed the row and may be negative. */
struct glint_image {
    enum glint_pixel_format format;
    int width, height; /* size of the picture, pixels, 1 .. GLINT_MAX_SIDE */
    uint8_t *plane[3]; /* address of the first sample of the top row; NULL for
                          unused planes */
    ptrdiff_t stride_bytes[3];
    enum glint_range range;   /* range of the codes; RGB is always full */
    enum glint_matrix matrix; /* matrix of Y, Cb, Cr; ignored for RGB */
    enum glint_tone transfer; /* transfer curve from codes to linear light */
};

/* Returns the number of planes of FORMAT, 1 .. 3. */
int glint_image_planes(enum glint_pixel_format format);

/* Returns whether FORMAT has codes R', G' and B' in one plane; otherwise
 * samples are luma and chroma, grey, or linear light. */
int glint_image_is_rgb(enum glint_pixel_format format);

/* Return the number of bytes in a row of plane PLANE without padding, and the
 * plane's number of rows. */
size_t glint_image_row_bytes(enum glint_pixel_format format, int plane,
                             int width);
int glint_image_plane_height(enum glint_pixel_format format, int plane,
                             int height);

/* Returns the number of bytes of all planes of a picture without padding; 0 if
 * WIDTH or HEIGHT is out of range. */
size_t glint_image_bytes(enum glint_pixel_format format, int width, int height);

/* Sets the planes of IMAGE to consecutive parts of MEM[glint_image_bytes()],
 * without padding; format, width and height of IMAGE must be set. */
void glint_image_place(struct glint_image *image, void *mem);

/* Returns a picture whose planes glint_image_place() puts into MEM. Its codes
 * are full-range BT.601 with the transfer curve of sRGB. */
struct glint_image glint_image_over(void *mem, enum glint_pixel_format format,
                                    int width, int height);

/* Divides IMAGE evenly into COLUMNS x ROWS rectangles (each 1 .. 1024) and
 * writes to RGB the full-range 8-bit codes R', G', B' of the pixel in the
 * middle of each rectangle, row by row. For a linear picture, which has no
 * codes, it writes zeros. */
void glint_image_sample(const struct glint_image *image, int columns, int rows,
                        uint8_t *rgb);

/* A picture of linear light, BT.709 primaries, 1 = display white. */
struct glint_float_image {
    int width, height; /* size of the picture, pixels, 1 .. GLINT_MAX_SIDE */
    float *rgb;        /* pixels, [height][width][3], the top row first */
};

#ifdef __cplusplus
}
#endif

#endif
