/* SPDX-License-Identifier: MIT
 *
 * oiio/blocks.h - Exif, XMP and colour codes of a picture, which go from files
 * of one type to files of another byte for byte.
 *
 *     file_blocks b = blocks_of("jpeg", whole);
 *     make_upright(b);
 *     made = carry_blocks("png", made, b, lost);
 */
#ifndef GLINT_PLATFORM_OIIO_BLOCKS_H
#define GLINT_PLATFORM_OIIO_BLOCKS_H

#include <string>

#include "oiio/keep.h"

namespace glint
{

struct file_blocks {
    bytes exif;      /* a TIFF header and directories; empty: none */
    std::string xmp; /* the packet; empty: none */
    bytes icc;       /* of WebP, of which OpenImageIO 2.4 has none, and HEIF */
    /* codes of primaries, transfer, matrix and full range [ITU-T H.273]; all 0:
     * none */
    unsigned char cicp[4];
};

/* Returns Exif and XMP of WHOLE, a file of OpenImageIO's TYPE; nothing if TYPE
 * has no blocks or they are malformed. */
file_blocks blocks_of(const std::string &type, const bytes &whole);
file_blocks blocks_of_tiff(const bytes &whole);

/* Sets the orientation in B to 1, removes the thumbnail of its Exif and what
 * its XMP claims of other pictures. */
void make_upright(file_blocks &b);

/* Returns MADE, a file of TYPE, with the blocks of B in place of its own, and
 * names in LOST those that do not fit. Does nothing for types without blocks.
 * CICP goes into a PNG, ICC into a WebP; other types have had them before. */
bytes carry_blocks(const std::string &type, const bytes &made,
                   const file_blocks &b, std::string &lost);

} // namespace glint

#endif
