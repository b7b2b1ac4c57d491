/* SPDX-License-Identifier: MIT */
#include "oiio/blocks.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "oiio/pieces.h"

namespace glint
{

namespace
{

const char exif_head[] = "Exif\0"; /* "Exif" and two zero bytes */
const char xmp_head[] = "http://ns.adobe.com/xap/1.0/";
const char xmp_keyword[] = "XML:com.adobe.xmp"; /* keyword of XMP in an iTXt
                                                   chunk of PNG */

bytes copy_piece_data(const file_piece &p, size_t from)
{
    return bytes(p.data + from, p.data + p.data_bytes);
}

std::string convert_bytes_to_text(const file_piece &p, size_t from)
{
    return std::string(reinterpret_cast<const char *>(p.data) + from,
                       p.data_bytes - from);
}

const unsigned char *get_text_bytes(const std::string &text)
{
    return reinterpret_cast<const unsigned char *>(text.data());
}

bool is_png_chunk_with_xmp(const file_piece &chunk)
{
    return chunk.name == "iTXt" &&
           begins_with_text(chunk, xmp_keyword, sizeof xmp_keyword);
}

/* Returns the text of an uncompressed iTXt chunk of PNG, without its keyword,
 * flag, method, language and translated keyword. */
std::string get_itxt_text(const file_piece &chunk)
{
    size_t at = sizeof xmp_keyword + 2;

    if (chunk.data_bytes < at || chunk.data[sizeof xmp_keyword] != 0)
        return "";
    for (int zeros = 0; zeros < 2 && at < chunk.data_bytes; at++)
        zeros += chunk.data[at] == 0;
    return convert_bytes_to_text(chunk, at);
}

/* -------------------------------------------------------------------- PNG */

uint32_t compute_crc(const unsigned char *at, size_t n)
{
    uint32_t crc = ~UINT32_C(0);

    for (size_t i = 0; i < n; i++) {
        crc ^= at[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~crc;
}

void append_big32(bytes &to, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        to.push_back(static_cast<unsigned char>(value >> shift));
}

void append_png_chunk(bytes &to, const char *name, const unsigned char *data,
                      size_t n)
{
    append_big32(to, static_cast<uint32_t>(n));
    append_bytes(to, reinterpret_cast<const unsigned char *>(name), 4);
    append_bytes(to, data, n);
    append_big32(to, compute_crc(to.data() + to.size() - n - 4, n + 4));
}

void append_png_blocks(bytes &file, const file_blocks &b)
{
    std::string text(xmp_keyword, sizeof xmp_keyword);

    if (b.cicp[1]) {
        const unsigned char rgb[] = {b.cicp[0], b.cicp[1], 0, 1};

        append_png_chunk(file, "cICP", rgb, sizeof rgb);
    }
    if (!b.exif.empty())
        append_png_chunk(file, "eXIf", b.exif.data(), b.exif.size());
    text += std::string(4, '\0') + b.xmp;
    if (!b.xmp.empty())
        append_png_chunk(file, "iTXt", get_text_bytes(text), text.size());
}

bytes replace_png_blocks(const bytes &made, const file_blocks &b)
{
    const std::vector<file_piece> chunks = split_png_chunks(made);
    bytes file(made.begin(), made.begin() + (chunks.empty() ? 0 : 8));

    for (const file_piece &chunk : chunks) {
        const bool goes =
            (chunk.name == "eXIf" && !b.exif.empty()) ||
            (is_png_chunk_with_xmp(chunk) && !b.xmp.empty()) ||
            (b.cicp[1] && is_one_of(chunk.name, {"gAMA", "cHRM", "sRGB"}));

        if (!goes)
            append_bytes(file, chunk.whole, chunk.whole_bytes);
        if (chunk.name == "IHDR")
            append_png_blocks(file, b);
    }
    return chunks.empty() ? made : file;
}

/* ------------------------------------------------------------ JPEG and WebP */

void report_lost_block(std::string &lost, const char *what, size_t n)
{
    lost += std::string(lost.empty() ? "" : "; ") + "no " + what + ": its " +
            std::to_string((n + 1023) / 1024) +
            " KB are more than a JPEG's 64 KB";
}

/* If B has Exif or XMP, that block of MADE, which OpenImageIO wrote, is removed
 * even if that of B does not fit into a segment, because it contains only a
 * part of it. */
bytes replace_jpeg_blocks(const bytes &made, const file_blocks &b,
                          std::string &lost)
{
    const std::vector<file_piece> segments = split_jpeg_segments(made);
    bytes file = {0xff, 0xd8}, own;

    if (segments.empty())
        return made;
    if (!b.exif.empty() &&
        !append_segment(own, 0xe1, exif_head, exif_head_bytes, b.exif.data(),
                        b.exif.size()))
        report_lost_block(lost, "Exif", b.exif.size());
    if (!b.xmp.empty() && !append_segment(own, 0xe1, xmp_head, xmp_head_bytes,
                                          get_text_bytes(b.xmp), b.xmp.size()))
        report_lost_block(lost, "XMP", b.xmp.size());
    bool is_in = false;
    for (const file_piece &segment : segments) {
        if (!is_in && !has_marker_byte(segment, 0xe0)) {
            append_bytes(file, own.data(), own.size());
            is_in = true;
        }
        if (!(is_exif_segment(segment) && !b.exif.empty()) &&
            !(is_xmp_segment(segment) && !b.xmp.empty()))
            append_bytes(file, segment.whole, segment.whole_bytes);
    }
    return file;
}

void append_webp_chunk(bytes &to, const char *name, const unsigned char *data,
                       size_t n)
{
    append_bytes(to, reinterpret_cast<const unsigned char *>(name), 4);
    for (int i = 0; i < 4; i++)
        to.push_back(static_cast<unsigned char>(n >> (8 * i)));
    append_bytes(to, data, n);
    if (n & 1)
        to.push_back(0);
}

/* Returns a WebP that consists only of the metadata chunks of B, as input for
 * copy_webp_metadata(). */
bytes build_metadata_webp(const file_blocks &b)
{
    bytes file = {'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'};

    if (!b.icc.empty())
        append_webp_chunk(file, "ICCP", b.icc.data(), b.icc.size());
    if (!b.exif.empty())
        append_webp_chunk(file, "EXIF", b.exif.data(), b.exif.size());
    if (!b.xmp.empty())
        append_webp_chunk(file, "XMP ", get_text_bytes(b.xmp), b.xmp.size());
    return file;
}

} // namespace

file_blocks read_metadata_blocks(const std::string &type, const bytes &whole)
{
    file_blocks b = {};

    if (type == "tiff")
        return read_tiff_metadata(whole);
    if (type == "jpeg")
        for (const file_piece &segment : split_jpeg_segments(whole)) {
            if (is_exif_segment(segment) && b.exif.empty())
                b.exif = copy_piece_data(segment, exif_head_bytes);
            if (is_xmp_segment(segment) && b.xmp.empty())
                b.xmp = convert_bytes_to_text(segment, xmp_head_bytes);
        }
    if (type == "png")
        for (const file_piece &chunk : split_png_chunks(whole)) {
            if (chunk.name == "eXIf" && b.exif.empty())
                b.exif = copy_piece_data(chunk, 0);
            if (chunk.name == "cICP" && chunk.data_bytes == 4)
                std::memcpy(b.cicp, chunk.data, 4);
            if (is_png_chunk_with_xmp(chunk) && b.xmp.empty())
                b.xmp = get_itxt_text(chunk);
        }
    if (type == "webp")
        for (const file_piece &chunk : split_webp_chunks(whole)) {
            if (chunk.name == "EXIF" && b.exif.empty())
                b.exif = copy_piece_data(
                    chunk, begins_with_text(chunk, exif_head, 6) ? 6 : 0);
            if (chunk.name == "ICCP" && b.icc.empty())
                b.icc = copy_piece_data(chunk, 0);
            if (chunk.name == "XMP " && b.xmp.empty())
                b.xmp = convert_bytes_to_text(chunk, 0);
        }
    return b;
}

void set_upright_orientation(file_blocks &b)
{
    remove_xmp_claims(b.xmp, true);
    if (!is_classic_tiff(b.exif)) {
        b.exif.clear();
        return;
    }
    const bool little = b.exif[0] == 'I';
    const auto number = [&](size_t at, size_t n) {
        size_t value = 0;

        for (size_t i = 0; i < n && at + n <= b.exif.size(); i++)
            value = value << 8 | b.exif[at + (little ? n - 1 - i : i)];
        return value;
    };
    const size_t first = number(4, 4), n_tags = number(first, 2);
    const size_t end = first + 2 + 12 * n_tags;

    for (size_t at = first + 2; at < end && at + 12 <= b.exif.size(); at += 12)
        if (number(at, 2) == 0x0112 && number(at + 2, 2) == 3) {
            b.exif[at + 8] = little;
            b.exif[at + 9] = !little;
        }
    /* The next directory describes the thumbnail. */
    if (end + 4 <= b.exif.size())
        std::fill_n(b.exif.begin() + static_cast<std::ptrdiff_t>(end), 4, 0);
}

bytes replace_metadata_blocks(const std::string &type, const bytes &made,
                              const file_blocks &b, std::string &lost)
{
    const bytes tiff = {'I', 'I', '*', 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0};

    if (type == "png")
        return replace_png_blocks(made, b);
    if (type == "jpeg")
        return replace_jpeg_blocks(made, b, lost);
    if (type == "webp")
        return copy_webp_metadata(made, build_metadata_webp(b), false);
    if (type == "tiff" && (!b.exif.empty() || !b.xmp.empty()))
        return add_metadata_to_tiff(made, b.exif.empty() ? tiff : b.exif,
                                    b.xmp);
    return made;
}

} // namespace glint
