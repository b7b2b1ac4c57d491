/* SPDX-License-Identifier: MIT
 *
 * Pictures as textures: sides that are powers of two, and smaller ones of them.
 * Means are of light, not of codes. */
#ifndef GLINT_BAKE_SCENE_TEXELS_H
#define GLINT_BAKE_SCENE_TEXELS_H

#include "glint/image.h"
#include "glint/status.h"

/* Resizes IMAGE so that its sides are powers of two, at most MOST: the nearest
 * by ratio, so that 48 becomes 64. IMAGE must be a GLINT_RGB24 in sRGB without
 * padding whose plane is malloc'ed. If no side changes, texels are unchanged.
 * Returns GLINT_E_MEMORY on failure; IMAGE is then unchanged. */
enum glint_status glint_texels_fit(struct glint_image *image, int most);

/* Writes to DST[height][width] the same picture with other sides: each texel
 * the mean of the area that it covers in SRC[src_height][src_width].
 * GLINT_E_MEMORY. */
enum glint_status glint_texels_resize(uint8_t *dst, int width, int height,
                                      const uint8_t *src, int src_width,
                                      int src_height);

#endif
