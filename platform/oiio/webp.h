/* SPDX-License-Identifier: MIT
 *
 * oiio/webp.h - WebP pictures, whose alpha stays straight.
 */
#ifndef GLINT_PLATFORM_OIIO_WEBP_H
#define GLINT_PLATFORM_OIIO_WEBP_H

#include "oiio/carry.h"

namespace glint
{

/* Returns whether webp_decode() can decode FILE: a WebP without animation, if
 * this was built with libwebp. */
bool webp_takes(const bytes &file);

/* Returns the pixels of FILE in 8 bits: R G B A if CHANNELS is 4, else R G B.
 * Throws failure. */
bytes webp_decode(const bytes &file, int channels);

/* Returns PIXELS, 8 bits, as a WebP of QUALITY 1 .. 100, or 0: without loss.
 * Throws failure. */
bytes webp_encode(const unsigned char *pixels, int width, int height,
                  int channels, int quality);

} // namespace glint

#endif
