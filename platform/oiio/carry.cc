/* SPDX-License-Identifier: MIT */
#include "oiio/pieces.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace glint
{

namespace
{

/* Returns whether CHUNK is copied to the new file. Chunks about the coding of
 * pixels are copied only if SAME_CODING is set, chunks about colours only if
 * DROP_ICC is not set, and critical chunks and those of transparency, histogram
 * or animation never. */
bool is_chunk_copied(const file_piece &chunk, bool same_coding, bool drop_icc)
{
    if (!(chunk.name[0] & 0x20) ||
        is_one_of(chunk.name, {"tRNS", "hIST", "acTL", "fcTL", "fdAT"}))
        return false;
    if (is_one_of(chunk.name, {"sBIT", "bKGD"}))
        return same_coding;
    return !drop_icc || !is_one_of(chunk.name, {"iCCP", "gAMA", "cHRM", "sRGB",
                                                "cICP", "mDCv", "cLLi"});
}

bool is_metadata_segment(const file_piece &segment)
{
    const int marker =
        segment.name.empty() ? 0 : static_cast<unsigned char>(segment.name[0]);

    return (marker >= 0xe0 && marker <= 0xef && marker != 0xee) ||
           marker == 0xfe;
}

/* Returns whether SEGMENT is an index of several pictures. Its offsets hold
 * only for the old file. */
bool is_picture_index(const file_piece &segment)
{
    return has_marker_byte(segment, 0xe2) &&
           begins_with_text(segment, "MPF", 4);
}

bool is_icc_segment(const file_piece &segment)
{
    return has_marker_byte(segment, 0xe2) &&
           begins_with_text(segment, "ICC_PROFILE", 12);
}

void append_named_chunks(bytes &to, const std::vector<file_piece> &chunks,
                         std::initializer_list<const char *> names)
{
    for (const file_piece &chunk : chunks)
        if (is_one_of(chunk.name, names))
            append_chunk(to, chunk);
}

/* Parses CHUNK, the only chunk of a simple WebP. Sets SIDE to width - 1 and
 * height - 1, as a VP8X chunk stores them, and ALPHA. Returns false if CHUNK
 * cannot be parsed. */
bool read_webp_canvas_size(const file_piece &chunk, uint32_t side[2],
                           bool &alpha)
{
    const unsigned char *const d = chunk.data;

    if (chunk.name == "VP8 " && chunk.data_bytes >= 10) {
        side[0] = ((d[6] | d[7] << 8) & 0x3fff) - 1u;
        side[1] = ((d[8] | d[9] << 8) & 0x3fff) - 1u;
        alpha = false;
        return true;
    }
    if (chunk.name == "VP8L" && chunk.data_bytes >= 5) {
        const uint32_t bits = read_little32(d + 1);

        side[0] = bits & 0x3fff;
        side[1] = bits >> 14 & 0x3fff;
        alpha = bits >> 28 & 1;
        return true;
    }
    return false;
}

bytes build_vp8x_chunk(const std::vector<file_piece> &made)
{
    uint32_t side[2] = {0, 0};
    bool alpha = false;
    bytes x;

    if (!made.empty() && made[0].name == "VP8X") {
        append_bytes(x, made[0].whole, 18);
        return x;
    }
    if (made.empty() || !read_webp_canvas_size(made[0], side, alpha))
        return x;
    x = {'V', 'P', '8', 'X', 10, 0, 0, 0, 0, 0, 0, 0};
    x[8] = alpha ? 0x10 : 0;
    for (uint32_t s : side)
        for (int i = 0; i < 3; i++)
            x.push_back(static_cast<unsigned char>(s >> (8 * i)));
    return x;
}

} // namespace

bytes copy_png_metadata(const bytes &made, const bytes &from, bool drop_icc)
{
    const std::vector<file_piece> ours = split_png_chunks(made);
    const std::vector<file_piece> theirs = split_png_chunks(from);
    bytes file;

    if (ours.empty() || theirs.empty() || ours[0].data_bytes != 13 ||
        theirs[0].data_bytes != 13)
        return made;
    const bool same = !std::memcmp(ours[0].data + 8, theirs[0].data + 8, 2);
    append_bytes(file, made.data(), 8);
    append_bytes(file, ours[0].whole, ours[0].whole_bytes);
    bool behind = false;
    for (const file_piece &chunk : theirs) {
        if (chunk.name == "IDAT" && !behind) {
            behind = true;
            for (const file_piece &data : ours)
                if (data.name == "IDAT")
                    append_bytes(file, data.whole, data.whole_bytes);
        } else if (is_chunk_copied(chunk, same, drop_icc)) {
            append_bytes(file, chunk.whole, chunk.whole_bytes);
        }
    }
    append_bytes(file, ours.back().whole, ours.back().whole_bytes);
    return behind ? file : made;
}

/* --------------------------------------------------- pictures behind a JPEG */

namespace
{

/* Returns whether SEGMENT describes the gain map of a JPEG [ISO 21496-1]. */
bool is_gain_map(const file_piece &segment)
{
    static const char name[] = "urn:iso:std:iso:ts:21496:-1";

    return has_marker_byte(segment, 0xe2) &&
           begins_with_text(segment, name, sizeof name);
}

std::string get_xmp_packet(const file_piece &xmp_segment)
{
    return std::string(reinterpret_cast<const char *>(xmp_segment.data) +
                           xmp_head_bytes,
                       xmp_segment.data_bytes - xmp_head_bytes);
}

/* Appends the XMP packet of SEGMENT, without the properties that refer to
 * pictures and videos after the first picture, as these are not copied. Appends
 * nothing if the packet is malformed. */
void append_cleaned_xmp(bytes &to, const file_piece &segment)
{
    std::string xmp = get_xmp_packet(segment);

    if (!remove_xmp_claims(xmp, false))
        return;
    append_segment(
        to, 0xe1, reinterpret_cast<const char *>(segment.data), xmp_head_bytes,
        reinterpret_cast<const unsigned char *>(xmp.data()), xmp.size());
}

/* Returns whether all pictures that the index SEGMENT lists, except the first,
 * are previews of the first [CIPA DC-007]. */
bool are_pictures_previews(const file_piece &segment)
{
    const unsigned char *const d = segment.data + 4; /* data after the 4 bytes
                                                        "MPF", 0 */
    const size_t n = segment.data_bytes - 4;
    const bool little = n > 0 && d[0] == 'I';
    const auto number = [&](size_t at, size_t bytes) {
        uint32_t value = 0;

        for (size_t i = 0; i < bytes && at + bytes <= n; i++)
            value = value << 8 | d[at + (little ? bytes - 1 - i : i)];
        return value;
    };
    const uint32_t first = number(4, 4), n_tags = number(first, 2);
    bool all = false;

    for (uint32_t i = 0; i < n_tags && i < 64; i++) {
        const uint32_t tag = first + 2 + 12 * i;
        const uint32_t place = number(tag + 8, 4), size = number(tag + 4, 4);

        /* 0xb002 is the list of pictures; its entries have 16 bytes */
        if (number(tag, 2) != 0xb002)
            continue;
        all = size > 16;
        for (uint32_t k = 16; k + 16 <= size && place + k + 16 <= n; k += 16)
            all = all && (number(place + k, 4) >> 16 & 0xff) == 1;
    }
    return all;
}

} // namespace

std::string describe_extra_jpeg_data(const bytes &jpeg)
{
    bool map = false, video = false, more = false, previews = false;
    bool malformed = false;
    std::string text;

    for (const file_piece &segment : split_jpeg_segments(jpeg)) {
        if (is_picture_index(segment)) {
            more = true;
            previews = are_pictures_previews(segment);
        }
        map = map || is_gain_map(segment);
        if (!is_xmp_segment(segment))
            continue;
        std::string xmp = get_xmp_packet(segment);

        map = map || xmp.find("hdrgm:") != std::string::npos;
        video = video || xmp.find("Camera:MotionPhoto") != std::string::npos ||
                xmp.find("Camera:MicroVideo") != std::string::npos;
        malformed = malformed || !remove_xmp_claims(xmp, false);
    }
    if (map)
        text = "its gain map (Ultra HDR) is dropped";
    if (video)
        text += text.empty() ? "its video (motion photo) is dropped"
                             : ", so is its video";
    if (text.empty() && more)
        text = previews ? "its embedded preview is dropped"
                        : "only its first picture is written";
    if (malformed)
        text += std::string(text.empty() ? "" : "; ") +
                "its XMP is malformed and is dropped";
    return text;
}

bytes copy_jpeg_metadata(const bytes &made, const bytes &from, bool drop_icc)
{
    const std::vector<file_piece> ours = split_jpeg_segments(made);
    const std::vector<file_piece> theirs = split_jpeg_segments(from);
    bytes file = {0xff, 0xd8};

    if (ours.empty() || theirs.empty())
        return made;
    for (const file_piece &segment : theirs)
        if (is_xmp_segment(segment))
            append_cleaned_xmp(file, segment);
        else if (is_metadata_segment(segment) && !is_picture_index(segment) &&
                 !is_gain_map(segment) &&
                 !(drop_icc && is_icc_segment(segment)))
            append_bytes(file, segment.whole, segment.whole_bytes);
    for (const file_piece &segment : ours)
        if (!is_metadata_segment(segment))
            append_bytes(file, segment.whole, segment.whole_bytes);
    return file;
}

bytes copy_webp_metadata(const bytes &made, const bytes &from, bool drop_icc)
{
    const std::vector<file_piece> ours = split_webp_chunks(made);
    const std::vector<file_piece> theirs = split_webp_chunks(from);
    bytes file = {'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'};
    const bytes x = build_vp8x_chunk(ours);
    unsigned flags = 0;

    for (const file_piece &chunk : theirs)
        flags |= chunk.name == "ICCP" && !drop_icc ? 0x20u
                 : chunk.name == "EXIF"            ? 0x08u
                 : chunk.name == "XMP "            ? 0x04u
                                                   : 0u;
    if (x.empty() || !flags)
        return made;
    append_bytes(file, x.data(), x.size());
    file[20] = static_cast<unsigned char>((file[20] & ~0x2cu) | flags);
    if (!drop_icc)
        append_named_chunks(file, theirs, {"ICCP"});
    append_named_chunks(file, ours, {"ALPH", "VP8 ", "VP8L"});
    append_named_chunks(file, theirs, {"EXIF"});
    append_named_chunks(file, theirs, {"XMP "});
    for (int i = 0; i < 4; i++)
        file[4 + i] = static_cast<unsigned char>((file.size() - 8) >> (8 * i));
    return file;
}

bool is_animated_webp(const bytes &webp)
{
    for (const file_piece &chunk : split_webp_chunks(webp))
        if (chunk.name == "ANIM")
            return true;
    return false;
}

bool is_lossless(const bytes &webp)
{
    for (const file_piece &chunk : split_webp_chunks(webp))
        if (chunk.name == "VP8L")
            return true;
    return false;
}

bytes find_png_chunk(const bytes &file, const char *name)
{
    for (const file_piece &chunk : split_png_chunks(file))
        if (chunk.name == name)
            return bytes(chunk.data, chunk.data + chunk.data_bytes);
    return {};
}

/* ---------------------------------------------------------------- complete */

/* Searches the scans for the end of the image. In a scan the byte 0xff occurs
 * only before a 0 byte and in restart markers; any other marker ends the
 * scan. */
std::string describe_missing_jpeg_data(const bytes &file)
{
    const std::vector<file_piece> segments = split_jpeg_segments(file);

    if (segments.empty())
        return "is cut off before its first scan";
    const file_piece &scans = segments.back();
    const unsigned char *at = scans.data;
    const unsigned char *const end = at + scans.data_bytes;

    while (at + 1 < end) {
        if (at[0] != 0xff || at[1] == 0 || (at[1] >= 0xd0 && at[1] <= 0xd7)) {
            at++;
        } else if (at[1] == 0xd9) {
            return "";
        } else if (at[1] == 0xff) {
            at++;
        } else { /* the marker belongs to a table or to the next scan */
            if (end - at < 4)
                break;
            at += 2 + (at[2] << 8 | at[3]);
        }
    }
    return "is cut off: its end marker is missing";
}

bool is_progressive_jpeg(const bytes &jpeg)
{
    for (const file_piece &segment : split_jpeg_segments(jpeg))
        if (has_marker_byte(segment, 0xc2))
            return true;
    return false;
}

bool is_cmyk_jpeg(const bytes &jpeg)
{
    for (const file_piece &segment : split_jpeg_segments(jpeg))
        if ((has_marker_byte(segment, 0xc0) || has_marker_byte(segment, 0xc1) ||
             has_marker_byte(segment, 0xc2)) &&
            segment.data_bytes > 5)
            return segment.data[5] == 4;
    return false;
}

int estimate_jpeg_quality(const bytes &file)
{
    /* luma quantisation table K.1 of ITU-T T.81, which each quality scales by a
     * factor. The quality is found by comparing the sums of the tables. */
    static const int luminance[64] = {
        16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
        14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
        18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
        49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
    long stated = 0, nearest = 1L << 30;
    int best = 0;

    for (const file_piece &segment : split_jpeg_segments(file)) {
        if (!has_marker_byte(segment, 0xdb) || segment.data_bytes < 65)
            continue;
        const bool wide = segment.data[0] >> 4;
        if ((segment.data[0] & 15) != 0 || (wide && segment.data_bytes < 129))
            continue;
        for (int i = 0; i < 64; i++)
            stated +=
                wide ? segment.data[1 + 2 * i] << 8 | segment.data[2 + 2 * i]
                     : segment.data[1 + i];
        break;
    }
    for (int quality = 1; stated && quality <= 100; quality++) {
        const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
        long sum = 0;

        for (int step : luminance) {
            const int scaled = (step * scale + 50) / 100;

            sum += scaled < 1 ? 1 : scaled > 255 ? 255 : scaled;
        }
        if (std::labs(sum - stated) < nearest) {
            nearest = std::labs(sum - stated);
            best = quality;
        }
    }
    return best;
}

/* -------------------------------------------------------------------- TIFF */

namespace
{

struct tiff {
    const bytes &file;
    bool little, big; /* little-endian; BigTIFF */

    uint64_t number(uint64_t at, int n) const
    {
        uint64_t value = 0;

        if (at > file.size() || file.size() - at < size_t(n))
            return 0;
        for (int i = 0; i < n; i++)
            value = value << 8 | file[at + (little ? n - 1 - i : i)];
        return value;
    }

    /* Returns value I of the directory entry at AT. */
    uint64_t value(uint64_t at, uint64_t i) const
    {
        const int type = int(number(at + 2, 2));
        const int size = type == 3 ? 2 : type == 16 ? 8 : 4;
        const uint64_t count = number(at + 4, big ? 8 : 4);
        const uint64_t place = at + (big ? 12 : 8);
        const bool inside = count * size <= (big ? 8u : 4u);

        return number((inside ? place : number(place, big ? 8 : 4)) + i * size,
                      size);
    }
};

} // namespace

/* Returns a text that states which strips or tiles of the first picture are
 * missing; "" if the file is complete. */
std::string describe_missing_tiff_data(const bytes &file)
{
    if (file.size() < 8)
        return "is cut off";
    const tiff t = {file, file[0] == 'I', file[file[0] == 'I' ? 2 : 3] == 43};
    const uint64_t first = t.big ? t.number(8, 8) : t.number(4, 4);
    const uint64_t n = t.number(first, t.big ? 8 : 2);
    const unsigned step = t.big ? 20 : 12;
    /* bits: number of bits of all pixels; packing: value of tag 259 (1:
     * uncompressed); total: number of bytes as stored */
    uint64_t bits = 1, packing = 1, total = 0;
    uint64_t offsets = 0, counts = 0, entries = 0, missing = 0, present = 0;

    for (uint64_t i = 0; i < n && i < 65536; i++) {
        const uint64_t at = first + (t.big ? 8 : 2) + i * step;
        const uint64_t tag = t.number(at, 2);

        if (tag == 273 || tag == 324) {
            offsets = at;
            entries = t.number(at + 4, t.big ? 8 : 4);
        } else if (tag == 279 || tag == 325) {
            counts = at;
        } else if (tag == 256 || tag == 257 || tag == 258 || tag == 277) {
            bits *= t.value(at, 0);
        } else if (tag == 259) {
            packing = t.value(at, 0);
        }
    }
    if (!offsets || !counts || !entries)
        return "has no pixels";
    if (entries > file.size())
        return "is cut off";
    for (uint64_t i = 0; i < entries; i++) {
        const uint64_t at = t.value(offsets, i), size = t.value(counts, i);

        total += size;
        present += size > 0; /* Some writers omit black tiles. */
        missing += at > file.size() || size > file.size() - at;
    }
    if (!present)
        return "has no pixels";
    /* Only fax codes (2 .. 4) compress by more than a factor of 4096. A file
     * with another code that seems to compress more was cut off. */
    if (missing == 0 && (packing >= 2 && packing <= 4 ? true
                         : packing == 1 ? total * 8 >= bits || present < entries
                                        : total * 8 * 4096 >= bits))
        return "";
    if (missing == 0)
        return "is cut off: its strips or tiles are too short";
    return "is cut off: " + std::to_string(missing) + " of its " +
           std::to_string(entries) + " strips or tiles are incomplete";
}

} // namespace glint
