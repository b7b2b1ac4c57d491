/* SPDX-License-Identifier: MIT
 *
 * oiio/blocks.h - copies Exif, XMP and colour codes of a picture byte for byte
 * to files of another type.
 *
 *     file_blocks b = read_metadata_blocks("jpeg", whole);
 *     set_upright_orientation(b);
 *     made = replace_metadata_blocks("png", made, b, lost); */
#ifndef GLINT_PLATFORM_OIIO_BLOCKS_H
#define GLINT_PLATFORM_OIIO_BLOCKS_H

#include <string>

#include "oiio/keep.h"

namespace glint
{

struct file_blocks {
    bytes exif;      /* Exif: a TIFF header and directories; empty: none */
    std::string xmp; /* the XMP packet; empty: none */
    /* ICC profile; only set for HEIF and for WebP, of which OpenImageIO 2.4
     * does not read it */
    bytes icc;
    /* codes of primaries, transfer, matrix and full range [ITU-T H.273]; all 0:
     * none */
    unsigned char cicp[4];
};

/* read_metadata_blocks() returns Exif and XMP of WHOLE, the bytes of a file of
 * OpenImageIO's TYPE. They are empty if TYPE has no such blocks or they are
 * malformed. read_tiff_metadata() does the same for a TIFF. */
file_blocks read_metadata_blocks(const std::string &type, const bytes &whole);
file_blocks read_tiff_metadata(const bytes &whole);

/* Sets the orientation in B to 1 (upright). Removes malformed Exif, the Exif
 * thumbnail, and the XMP properties that refer to other pictures in the
 * file. */
void set_upright_orientation(file_blocks &b);

/* Returns MADE, the bytes of a file of TYPE, with its own metadata blocks
 * replaced by those of B. Appends to LOST the names of blocks that do not fit.
 * Does nothing for types without such blocks. CICP is written to PNG, ICC to
 * WebP; in other types OpenImageIO has written them already. */
bytes replace_metadata_blocks(const std::string &type, const bytes &made,
                              const file_blocks &b, std::string &lost);

} // namespace glint

#endif
