/* SPDX-License-Identifier: MIT
 *
 * Resizes pictures for use as textures: to sides that are powers of two, and
 * to mipmap levels. Averages in linear light.
 */
#ifndef GLINT_BAKE_SCENE_TEXELS_H
#define GLINT_BAKE_SCENE_TEXELS_H

#include "glint/image.h"
#include "glint/status.h"

/* Resizes IMAGE to sides that are powers of two, at most MOST. Each side
 * becomes the power whose ratio to it is nearest to 1: 48 becomes 64. IMAGE
 * must be GLINT_RGB24 in sRGB, without padding, in a plane from malloc().
 * Texels are unchanged if no side changes. On GLINT_E_MEMORY IMAGE is
 * unchanged. */
enum glint_status
glint_texels_resize_to_powers_of_two(struct glint_image *image, int most);

/* Resizes SRC[src_height][src_width] to DST[height][width]. Each texel becomes
 * the mean of the source texels that it covers. May return GLINT_E_MEMORY. */
enum glint_status glint_texels_resize_picture(uint8_t *dst, int width,
                                              int height, const uint8_t *src,
                                              int src_width, int src_height);

#endif
