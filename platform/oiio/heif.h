/* SPDX-License-Identifier: MIT
 *
 * oiio/heif.h - reads and writes HEIC and AVIF pictures by libheif. OpenImageIO
 * 2.4 is not used for them because it reads only 8 bits, and neither colour
 * tags nor profile. */
#ifndef GLINT_PLATFORM_OIIO_HEIF_H
#define GLINT_PLATFORM_OIIO_HEIF_H

#include <string>

#include "oiio/blocks.h"

namespace glint
{

struct heif_picture {
    int width, height; /* size of the upright picture, pixels */
    int channels;      /* 3: R G B; 4: R G B A */
    int bits;          /* bits of the file's samples, 8 .. 16 */
    bool is_avif, is_premultiplied;
    /* interleaved samples: 8 bits if BITS is 8, else 16 bits with white
     * 65535 */
    bytes pixels;
    file_blocks meta;
    std::string lost; /* text that lists content that glint does not preserve */
};

/* Returns whether FILE is a HEIF by its first bytes. */
bool is_heif(const bytes &file);

/* Returns whether FILE, a HEIF, is an AVIF. */
bool is_avif(const bytes &file);

/* is_heif_readable() returns whether this plug-in was built with libheif,
 * is_heif_writable() whether libheif also has an encoder for AVIF or for
 * HEIC. */
bool is_heif_readable();
bool is_heif_writable(bool avif);

/* Returns the bits per sample of a file of PICTURE: 8, 10 or 12. */
int get_heif_bits(const heif_picture &picture);

/* Decodes FILE; throws failure. */
heif_picture decode_heif(const bytes &file);

/* Encodes PICTURE with QUALITY, 1 .. 100; throws failure. */
bytes encode_heif_picture(const heif_picture &picture, int quality);

} // namespace glint

#endif
