/* SPDX-License-Identifier: MIT
 *
 * Resizes pictures for use as textures: to sides that are powers of two, and
 * to mipmap levels. Averages in linear light.
 */
#ifndef GLINT_BAKE_SCENE_TEXELS_H
#define GLINT_BAKE_SCENE_TEXELS_H

#include "glint/image.h"
#include "glint/status.h"

/* Resizes IMAGE to sides that are powers of two, at most MOST: each side
 * becomes the power at the smallest ratio, so 48 becomes 64. IMAGE must be
 * GLINT_RGB24 in sRGB, without padding, in a plane from malloc(). Texels are
 * unchanged if no side changes. On GLINT_E_MEMORY IMAGE is unchanged. */
enum glint_status glint_texels_fit(struct glint_image *image, int most);

/* Resizes SRC[src_height][src_width] to DST[height][width]. Each texel becomes
 * the mean of the source texels that it covers. May return GLINT_E_MEMORY. */
enum glint_status glint_texels_resize(uint8_t *dst, int width, int height,
                                      const uint8_t *src, int src_width,
                                      int src_height);

#endif
