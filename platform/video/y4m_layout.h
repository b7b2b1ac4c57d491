/* SPDX-License-Identifier: MIT
 *
 * video/y4m_layout.h - how a frame of Y4M lies in its bytes, by the tag C.
 *
 *     C420 420jpeg 420mpeg2 420paldv 411 422 444 444alpha mono
 *     and 420 422 444 with p9 p10 p12 p14 p16, mono with 9 10 12 14 16
 *
 * A sample of more than 8 bits takes two bytes, the low one first.
 */
#ifndef GLINT_PLATFORM_VIDEO_Y4M_LAYOUT_H
#define GLINT_PLATFORM_VIDEO_Y4M_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/image.h"

struct glint_y4m_layout {
    enum glint_pixel_format format; /* _GREY, _I420, _I422 or _I444; of 411 that
                                       of its copy, _I422 */
    int bits;                       /* bits a sample, 8 .. 16 */
    bool has_alpha; /* a fourth plane of full size, which is passed on */
    bool is_411;    /* chroma is a quarter as wide */
};

/* Sets LAYOUT by TAG, "" being 420jpeg. Returns false if there is no such
 * tag. */
bool glint_y4m_layout_parse(struct glint_y4m_layout *layout, const char *tag);

/* Returns the tag that glint writes for FORMAT: _GREY, _I420, _I422 or
 * _I444. */
const char *glint_y4m_layout_tag(enum glint_pixel_format format);

/* Returns whether a stored frame, but for an alpha plane, is a struct
 * glint_image as it is. */
bool glint_y4m_layout_is_plain(const struct glint_y4m_layout *layout);

/* Sets SIZE to the samples across and down PLANE, 0 .. 3, or to 0 and 0 if
 * there is no such plane. */
void glint_y4m_layout_size(const struct glint_y4m_layout *layout, int plane,
                           int width, int height, int size[2]);

/* Returns the bytes of all planes of a frame. */
size_t glint_y4m_layout_bytes(const struct glint_y4m_layout *layout, int width,
                              int height);

#endif
