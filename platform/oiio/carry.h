/* SPDX-License-Identifier: MIT
 *
 * oiio/carry.h - metadata that OpenImageIO does not carry from file to file:
 * chunks of PNG and WebP, segments of JPEG and tags of TIFF, copied byte for
 * byte; and a check that it does not make: whether a JPEG or TIFF is complete.
 */
#ifndef GLINT_PLATFORM_OIIO_CARRY_H
#define GLINT_PLATFORM_OIIO_CARRY_H

#include <cstddef>
#include <string>
#include <vector>

namespace glint
{

using bytes = std::vector<unsigned char>;

/* Return MADE with the metadata of FROM, a file of the same type, in place of
 * its own, but without FROM's profile if DROP_ICC. They return MADE as it is if
 * they cannot read one of the two. */
bytes carry_png(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_jpeg(const bytes &made, const bytes &from, bool drop_icc);
bytes carry_webp(const bytes &made, const bytes &from, bool drop_icc);
bool is_classic_tiff(const bytes &file); /* BigTIFF is not. */
bytes carry_tiff(const bytes &made, const bytes &from, bool drop_icc);

/* Return in words what FILE lacks; "" if it is complete. */
std::string missing_of_jpeg(const bytes &file);
std::string missing_of_tiff(const bytes &file);

/* Returns the quality, 1 .. 100 on libjpeg's scale, whose tables are nearest to
 * FILE's; 0 if FILE has none. */
int quality_of_jpeg(const bytes &file);

bool is_progressive(const bytes &jpeg);

/* Returns whether the pixels of JPEG are C M Y K, which become R G B. */
bool is_of_inks(const bytes &jpeg);

/* Returns whether JPEG has more pictures after the first, which are lost. */
bool has_more_pictures(const bytes &jpeg);

/* Returns the data of the first chunk NAME of a PNG; empty if it has none. */
bytes chunk_of_png(const bytes &file, const char *name);

/* Returns whether WEBP is coded without loss. */
bool is_lossless(const bytes &webp);

} // namespace glint

#endif
