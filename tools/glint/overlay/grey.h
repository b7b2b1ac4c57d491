/* SPDX-License-Identifier: MIT
 *
 * grey.h - draws grey flares on monochrome photographs.
 *
 *     if (grey_is_monochrome(&image)) {
 *         mem = malloc(glint_image_bytes(GLINT_GREY, width, height));
 *         grey = grey_copy_green(&image, mem);
 *         ... draw on grey
 *         grey_add_difference(&image, &grey);
 *     }
 *
 * Pictures are GLINT_RGB24 or GLINT_XBGR8888, full range. */
#ifndef GLINT_TOOLS_OVERLAY_GREY_H
#define GLINT_TOOLS_OVERLAY_GREY_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/image.h"

/* Returns whether IMAGE is a monochrome photograph, not a drawing. */
bool grey_is_monochrome(const struct glint_image *image);

/* Returns an image in MEM, grey, with the green channel of FROM. */
struct glint_image grey_copy_green(const struct glint_image *from, void *mem);

/* Adds to all channels of IMAGE the amount by which GREY exceeds the green
 * channel. */
void grey_add_difference(const struct glint_image *image,
                         const struct glint_image *grey);

/* Replaces each of N pixels RGB, linear light, by its luminance. */
void grey_convert_light(float *rgb, size_t n);

#endif
