/* SPDX-License-Identifier: MIT
 *
 * linux/fourcc.h - converts between V4L2's codes of formats and colours and
 * those of glint.
 *
 * A FOURCC is four characters in a word, the first in the lowest byte. V4L2 has
 * two codes for a format of several planes: NV12 has all planes in one block of
 * memory, NM12 each plane in its own block; both are GLINT_NV12 here. */
#ifndef GLINT_PLATFORM_LINUX_FOURCC_H
#define GLINT_PLATFORM_LINUX_FOURCC_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"

/* Sets FORMAT to glint's format for FOURCC. Returns false if glint has no such
 * format, as for MJPG. AR24 and BGR4 count as GLINT_XRGB8888, whose fourth byte
 * is unused. */
bool glint_fourcc_to_format(uint32_t fourcc, enum glint_pixel_format *format);

/* Returns the FOURCC of FORMAT with all planes in one block of memory. Returns
 * 0 if V4L2 has none: for GLINT_LINEAR_Q20, and for GLINT_I444, for which V4L2
 * has only the multi-block format YM24. */
uint32_t glint_fourcc_from_format(enum glint_pixel_format format);

/* Writes FOURCC as text, such as "YUYV", with '?' for unprintable
 * characters. */
void glint_fourcc_text(uint32_t fourcc, char text[5]);

/* Parses TEXT, a FOURCC or ffmpeg's name of a pixel format, in upper or lower
 * case ("YUYV", "yuyv422", "nv12", "mjpeg"). Any other 4 printable characters
 * become the FOURCC unchanged. Returns false for other texts. */
bool glint_fourcc_parse(const char *text, uint32_t *fourcc);

/* Colours of a format as values of V4L2: enum v4l2_colorspace, enum
 * v4l2_ycbcr_encoding and so on. */
struct glint_v4l2_colour {
    uint32_t colorspace, ycbcr_enc, quantization, xfer_func;
};

/* Sets range, matrix and transfer of IMAGE from COLOUR; the format of IMAGE
 * must be set before. A "default" value is resolved by the rules of
 * videodev2.h, except that grey is full range. If glint does not support COLOUR
 * (BT.2020, linear, RGB of limited range ...), sets IMAGE to the nearest
 * colours and returns false. */
bool glint_v4l2_colour_to_image(const struct glint_v4l2_colour *colour,
                                struct glint_image *image);

/* Sets COLOUR from range, matrix and transfer of IMAGE; no member is left at
 * "default". */
void glint_v4l2_colour_from_image(struct glint_v4l2_colour *colour,
                                  const struct glint_image *image);

#endif
