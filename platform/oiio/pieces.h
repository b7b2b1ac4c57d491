/* SPDX-License-Identifier: MIT
 *
 * oiio/pieces.h - the chunks of PNG and WebP and the segments of JPEG.
 */
#ifndef GLINT_PLATFORM_OIIO_PIECES_H
#define GLINT_PLATFORM_OIIO_PIECES_H

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "oiio/keep.h"

namespace glint
{

/* A chunk of PNG or WebP, or a segment of JPEG: all of it, and its data. It
 * points into the file. */
struct file_piece {
    std::string name;
    const unsigned char *whole;
    size_t whole_bytes;
    const unsigned char *data;
    size_t data_bytes;
};

uint32_t big32(const unsigned char *at);
uint32_t little32(const unsigned char *at);

void append(bytes &to, const unsigned char *at, size_t n);

bool is_one_of(const std::string &name, std::initializer_list<const char *> of);

/* Return the pieces of FILE; none if it is malformed. The last segment of a
 * JPEG is named "" and has all bytes from the first scan on. */
std::vector<file_piece> chunks_of_png(const bytes &file);
std::vector<file_piece> segments_of_jpeg(const bytes &file);
std::vector<file_piece> chunks_of_webp(const bytes &file);

/* Returns whether SEGMENT of a JPEG has MARKER, 0xc0 .. 0xfe. */
bool is_marker(const file_piece &segment, int marker);

/* Returns whether the data of SEGMENT begin with the N bytes at TEXT. */
bool begins(const file_piece &segment, const char *text, size_t n);

/* Returns whether SEGMENT of a JPEG is its XMP, or its Exif. */
bool is_xmp(const file_piece &segment);
bool is_exif(const file_piece &segment);

/* Bytes of a segment of XMP or Exif before the packet or the TIFF header. */
constexpr size_t xmp_head_bytes = 29, exif_head_bytes = 6;

/* Appends a segment of JPEG with MARKER: the N_HEAD bytes at HEAD, then DATA.
 * Returns false and appends nothing if that is above 65533 bytes. */
bool append_segment(bytes &to, int marker, const char *head, size_t n_head,
                    const unsigned char *data, size_t n);

/* Appends CHUNK of a WebP, padded to an even number of bytes. */
void append_chunk(bytes &to, const file_piece &chunk);

} // namespace glint

#endif
