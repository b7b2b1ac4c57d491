/* SPDX-License-Identifier: MIT
 *
 * oiio/carry.h - what OpenImageIO does not carry from file to file: chunks of
 * PNG and WebP, segments of JPEG and tags of TIFF, taken over byte for byte;
 * and what it does not check: whether a JPEG or TIFF is all there.
 */
#ifndef GLINT_PLATFORM_OIIO_CARRY_H
#define GLINT_PLATFORM_OIIO_CARRY_H

#include <cstddef>
#include <string>
#include <vector>

namespace glint
{

using bytes = std::vector<unsigned char>;

/* MADE, a file of the same type, with the metadata of FROM in place of its own.
 * MADE as it is where one of them is not understood. DROP_ICC: but for its
 * profile. */
bytes carry_png(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_jpeg(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_webp(const bytes &made, const bytes &from, bool drop_icc);
bool is_classic_tiff(const bytes &file); /* not BigTIFF */
bytes carry_tiff(const bytes &made, const bytes &from, bool drop_icc);

/* Return what FILE lacks, for a person; empty: nothing. */
std::string missing_of_jpeg(const bytes &file);
std::string missing_of_tiff(const bytes &file);

/* 1 .. 100 of libjpeg's scale, nearest to FILE's tables; 0: there are none. */
int quality_of_jpeg(const bytes &file);

bool is_progressive(const bytes &jpeg);

/* Returns whether the colours of JPEG are those of inks: C M Y K, whose pixels
 * become R G B. */
bool is_of_inks(const bytes &jpeg);

/* Returns whether the file has more pictures behind the first, which get lost.
 */
bool has_more_pictures(const bytes &jpeg);

/* Data of the first chunk NAME of a PNG; empty: there is none. */
bytes chunk_of_png(const bytes &file, const char *name);

/* Returns whether a WebP is without loss. */
bool is_lossless(const bytes &webp);

} // namespace glint

#endif
