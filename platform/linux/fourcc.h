/* SPDX-License-Identifier: MIT
 *
 * linux/fourcc.h - what V4L2 calls the formats and colours of glint.
 *
 * A FOURCC is four characters in a word, the first lowest. Formats of several
 * planes exist twice in V4L2: NV12 in one block of memory, NM12 in one block
 * for each plane; both are GLINT_NV12 here.
 */
#ifndef GLINT_PLATFORM_LINUX_FOURCC_H
#define GLINT_PLATFORM_LINUX_FOURCC_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/image.h"

/* False: glint has no such format (MJPG among them). AR24 and BGR4 count as
 * GLINT_XRGB8888, whose fourth byte is nothing. */
bool glint_fourcc_to_format(uint32_t fourcc, enum glint_pixel_format *format);

/* The FOURCC in one block of memory; 0: V4L2 has none (GLINT_LINEAR_Q20, and
 * GLINT_I444, which exists as YM24 only). */
uint32_t glint_fourcc_of(enum glint_pixel_format format);

/* Blocks of memory that a picture in FOURCC is spread over, 1 .. 3. */
int glint_fourcc_memory_planes(uint32_t fourcc);

/* "YUYV"; what does not print becomes '?'. */
void glint_fourcc_text(uint32_t fourcc, char text[5]);

/* Reads a FOURCC or a name of ffmpeg's, in any case: "YUYV", "yuyv422", "nv12",
 * "mjpeg". Other texts of 4 printable characters are taken as they are. */
bool glint_fourcc_parse(const char *text, uint32_t *fourcc);

/* The colours of a format to V4L2: values of enum v4l2_colorspace and so on. */
struct glint_v4l2_colour {
    uint32_t colorspace, ycbcr_enc, quantization, xfer_func;
};

/* Sets range, matrix and transfer of IMAGE, whose format is set, from COLOUR;
 * where it says "default", by the rules of videodev2.h, but grey
 * of full range. False: it says what
 * glint has no word for (BT.2020, linear, RGB of limited range ...), and the
 * nearest is set. */
bool glint_v4l2_colour_read(const struct glint_v4l2_colour *colour,
                            struct glint_image *image);

/* The other way: COLOUR states everything. */
void glint_v4l2_colour_write(struct glint_v4l2_colour *colour,
                             const struct glint_image *image);

#endif
