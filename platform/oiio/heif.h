/* SPDX-License-Identifier: MIT
 *
 * oiio/heif.h - HEIC and AVIF by libheif itself: OpenImageIO 2.4 reads them in
 * 8 bits, without colour tags and profile.
 */
#ifndef GLINT_PLATFORM_OIIO_HEIF_H
#define GLINT_PLATFORM_OIIO_HEIF_H

#include <string>

#include "oiio/blocks.h"

namespace glint
{

struct heif_picture {
    int width, height; /* upright */
    int channels;      /* 3: R G B; 4: R G B A */
    int bits;          /* of the file's samples, 8 .. 16 */
    bool is_avif, is_premultiplied;
    /* interleaved, in 8 bits if BITS is 8, else in 16 bits, white is 65535 */
    bytes pixels;
    file_blocks meta;
    std::string lost; /* lists content that glint does not keep */
};

/* Returns whether FILE is a HEIF by its first bytes. */
bool is_heif(const bytes &file);

/* Returns whether FILE, a HEIF, is an AVIF. */
bool is_avif(const bytes &file);

/* Returns whether this plug-in was built with libheif, or also has an encoder
 * for AVIF or for HEIC. */
bool heif_reads();
bool heif_writes(bool avif);

/* Returns the bits that a file of PICTURE has: 8, or 10 and more for pictures
 * of more than 8. */
int heif_bits(const heif_picture &picture);

/* Decodes FILE; throws failure. */
heif_picture heif_decode(const bytes &file);

/* Encodes PICTURE with QUALITY, 1 .. 100; throws failure. */
bytes heif_encode(const heif_picture &picture, int quality);

} // namespace glint

#endif
