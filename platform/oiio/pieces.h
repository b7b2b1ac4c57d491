/* SPDX-License-Identifier: MIT
 *
 * oiio/pieces.h - splits PNG and WebP files into chunks and JPEG files into
 * segments. */
#ifndef GLINT_PLATFORM_OIIO_PIECES_H
#define GLINT_PLATFORM_OIIO_PIECES_H

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "oiio/keep.h"

namespace glint
{

/* A chunk of PNG or WebP, or a segment of JPEG: the address of the whole chunk
 * or segment, and the address of its data. Both point into the file. */
struct file_piece {
    std::string name;
    const unsigned char *whole;
    size_t whole_bytes;
    const unsigned char *data;
    size_t data_bytes;
};

uint32_t read_big32(const unsigned char *at);
uint32_t read_little32(const unsigned char *at);

void append_bytes(bytes &to, const unsigned char *at, size_t n);

bool is_one_of(const std::string &name, std::initializer_list<const char *> of);

/* Return the chunks or segments of FILE; an empty list if FILE is malformed.
 * The last segment of a JPEG has the name "" and all bytes from the first scan
 * to the end. */
std::vector<file_piece> split_png_chunks(const bytes &file);
std::vector<file_piece> split_jpeg_segments(const bytes &file);
std::vector<file_piece> split_webp_chunks(const bytes &file);

/* Returns whether SEGMENT of a JPEG has the marker with the second byte MARKER,
 * 0xc0 .. 0xfe. */
bool has_marker_byte(const file_piece &segment, int marker);

/* Returns whether the data of SEGMENT begin with the N bytes at TEXT. */
bool begins_with_text(const file_piece &segment, const char *text, size_t n);

/* Return whether SEGMENT of a JPEG is XMP, and whether it is Exif. */
bool is_xmp_segment(const file_piece &segment);
bool is_exif_segment(const file_piece &segment);

/* number of bytes in a segment of XMP or Exif before the packet or the TIFF
 * header */
constexpr size_t xmp_head_bytes = 29, exif_head_bytes = 6;

/* Appends a segment of JPEG to TO: the marker byte MARKER, N_HEAD bytes at
 * HEAD, then DATA. Returns false and appends nothing if these are more than
 * 65533 bytes. */
bool append_segment(bytes &to, int marker, const char *head, size_t n_head,
                    const unsigned char *data, size_t n);

/* Appends CHUNK of a WebP to TO, padded to an even number of bytes. */
void append_chunk(bytes &to, const file_piece &chunk);

} // namespace glint

#endif
