/* SPDX-License-Identifier: MIT */
#include "oiio/pieces.h"

#include <cstring>

namespace glint
{

namespace
{

const char xmp_head[] = "http://ns.adobe.com/xap/1.0/"; /* identifier of XMP
                                                           segments, with its
                                                           final zero byte */
static_assert(sizeof xmp_head == xmp_head_bytes, "length of XMP's name");

} // namespace

uint32_t read_big32(const unsigned char *at)
{
    return uint32_t(at[0]) << 24 | uint32_t(at[1]) << 16 |
           uint32_t(at[2]) << 8 | at[3];
}

uint32_t read_little32(const unsigned char *at)
{
    return uint32_t(at[3]) << 24 | uint32_t(at[2]) << 16 |
           uint32_t(at[1]) << 8 | at[0];
}

void append_bytes(bytes &to, const unsigned char *at, size_t n)
{
    to.insert(to.end(), at, at + n);
}

bool is_one_of(const std::string &name, std::initializer_list<const char *> of)
{
    for (const char *one : of)
        if (name == one)
            return true;
    return false;
}

/* ------------------------------------------------------------------- PNG */

std::vector<file_piece> split_png_chunks(const bytes &file)
{
    std::vector<file_piece> chunks;
    size_t at = 8;

    while (file.size() - at >= 12 && at < file.size()) {
        const unsigned char *const p = file.data() + at;
        const size_t n = read_big32(p);

        if (n > file.size() - at - 12)
            return {};
        chunks.push_back({std::string(reinterpret_cast<const char *>(p) + 4, 4),
                          p, n + 12, p + 8, n});
        if (chunks.back().name == "IEND")
            return chunks[0].name == "IHDR" ? chunks : std::vector<file_piece>();
        at += n + 12;
    }
    return {};
}

/* -------------------------------------------------------------------- JPEG */

std::vector<file_piece> split_jpeg_segments(const bytes &file)
{
    std::vector<file_piece> segments;
    size_t at = 2;

    while (at + 4 <= file.size() && file[at] == 0xff) {
        const unsigned char *const p = file.data() + at;
        const size_t n = size_t(p[2]) << 8 | p[3];

        /* Bytes 0xff in front of a marker, which itself begins with 0xff, are
         * padding. */
        if (p[1] == 0xff) {
            at++;
            continue;
        }
        if (p[1] == 0xda) {
            segments.push_back({"", p, file.size() - at, p, file.size() - at});
            return segments;
        }
        if (n < 2 || n + 2 > file.size() - at)
            return {};
        segments.push_back(
            {std::string(1, char(p[1])), p, n + 2, p + 4, n - 2});
        at += n + 2;
    }
    return {};
}

bool has_marker_byte(const file_piece &segment, int marker)
{
    return segment.name.size() == 1 &&
           static_cast<unsigned char>(segment.name[0]) == marker;
}

bool begins_with_text(const file_piece &segment, const char *text, size_t n)
{
    return segment.data_bytes >= n && !std::memcmp(segment.data, text, n);
}

bool is_xmp_segment(const file_piece &segment)
{
    return has_marker_byte(segment, 0xe1) &&
           begins_with_text(segment, xmp_head, sizeof xmp_head);
}

bool is_exif_segment(const file_piece &segment)
{
    return has_marker_byte(segment, 0xe1) && begins_with_text(segment, "Exif\0", 6);
}

bool append_segment(bytes &to, int marker, const char *head, size_t n_head,
                    const unsigned char *data, size_t n)
{
    const size_t all = 2 + n_head + n;
    const unsigned char start[] = {0xff, static_cast<unsigned char>(marker),
                                   static_cast<unsigned char>(all >> 8),
                                   static_cast<unsigned char>(all)};

    if (all > 0xffff)
        return false;
    append_bytes(to, start, sizeof start);
    append_bytes(to, reinterpret_cast<const unsigned char *>(head), n_head);
    append_bytes(to, data, n);
    return true;
}

/* -------------------------------------------------------------------- WebP */

std::vector<file_piece> split_webp_chunks(const bytes &file)
{
    std::vector<file_piece> chunks;
    size_t at = 12;

    if (file.size() < 12 || std::memcmp(file.data(), "RIFF", 4) ||
        std::memcmp(file.data() + 8, "WEBP", 4))
        return {};
    while (at + 8 <= file.size()) {
        const unsigned char *const p = file.data() + at;
        const size_t n = read_little32(p + 4);
        const size_t whole = 8 + n + (n & 1);

        if (n > file.size() - at - 8)
            return {};
        chunks.push_back({std::string(reinterpret_cast<const char *>(p), 4), p,
                          whole, p + 8, n});
        at += whole;
    }
    return chunks;
}

void append_chunk(bytes &to, const file_piece &chunk)
{
    append_bytes(to, chunk.whole, 8 + chunk.data_bytes);
    if (chunk.data_bytes & 1)
        to.push_back(0);
}

} // namespace glint
