/* SPDX-License-Identifier: MIT
 *
 * oiio/webp.h - WebP pictures with straight alpha, as they are.
 */
#ifndef GLINT_PLATFORM_OIIO_WEBP_H
#define GLINT_PLATFORM_OIIO_WEBP_H

#include "oiio/carry.h"

namespace glint
{

/* Returns whether FILE can be decoded here: a WebP that is no animation, and
 * libwebp was there when this was built. */
bool webp_takes(const bytes &file);

/* R G B, or R G B A, of 8 bits. */
bytes webp_decode(const bytes &file, int channels);

/* QUALITY 1 .. 100; 0: without loss. */
bytes webp_encode(const unsigned char *pixels, int width, int height,
                  int channels, int quality);

} // namespace glint

#endif
