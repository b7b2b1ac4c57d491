/* SPDX-License-Identifier: MIT
 *
 * Copies the tags of one TIFF file to another. The file that OpenImageIO has
 * written keeps its tags about the layout of its pixels. All other tags, and
 * the Exif and GPS directories, are copied from the file that was read, which
 * may have the other byte order. */
#include "oiio/blocks.h"

#include <cstdint>
#include <cstring>
#include <map>

namespace glint
{

namespace
{

struct reader {
    const bytes &file;
    bool little;

    bool holds(uint64_t at, uint64_t n) const
    {
        return at <= file.size() && n <= file.size() - at;
    }
    uint32_t number(uint64_t at, int n) const
    {
        uint32_t value = 0;

        for (int i = 0; i < n && holds(at, static_cast<uint64_t>(n)); i++)
            value = value << 8 |
                    file[at + static_cast<uint64_t>(little ? n - 1 - i : i)];
        return value;
    }
};

/* An entry of a TIFF directory; its values are stored as little-endian
 * bytes. */
struct entry {
    unsigned type;
    uint32_t count;
    bytes values;
};

using directory = std::map<unsigned, entry>;

/* Returns the size in bytes of a value of TYPE, 1 .. 13, or 0 if TYPE is
 * unknown. */
unsigned get_value_bytes(unsigned type)
{
    static const unsigned char sizes[] = {0, 1, 1, 2, 4, 8, 1,
                                          1, 2, 4, 8, 4, 8, 4};

    return type < sizeof sizes ? sizes[type] : 0;
}

/* Returns the size in bytes of each number in a value of TYPE, for swapping
 * byte order; a rational consists of two numbers. */
unsigned get_number_bytes(unsigned type)
{
    return type == 5 || type == 10 ? 4 : get_value_bytes(type);
}

/* Reads the entry at offset AT, appends it to TO and subtracts the bytes of its
 * values from ROOM. Skips an entry that is malformed or needs more than ROOM
 * bytes. */
void read_entry(const reader &r, uint64_t at, uint64_t &room, directory &to)
{
    const unsigned type = r.number(at + 2, 2), unit = get_number_bytes(type);
    const uint32_t count = r.number(at + 4, 4);
    const uint64_t n = uint64_t(count) * get_value_bytes(type);
    const uint64_t from = n <= 4 ? at + 8 : r.number(at + 8, 4);

    if (n == 0 || n > room || !r.holds(from, n))
        return;
    room -= n;
    struct entry e = {type, count, bytes(n)};
    for (uint64_t i = 0; i < n; i++)
        e.values[i] =
            r.file[from +
                   (r.little ? i : i / unit * unit + unit - 1 - i % unit)];
    to[r.number(at, 2)] = e;
}

/* Returns the directory at offset AT, empty if it is malformed, and sets NEXT
 * to the offset of the directory after it. */
directory read_directory(const reader &r, uint64_t at, uint32_t &next)
{
    const unsigned n = r.number(at, 2);
    /* Limit of the size of all values, bytes. Values may overlap in the file;
     * without this limit they could need far more memory than the file's
     * size. */
    uint64_t room = r.file.size();
    directory read;

    next = 0;
    if (at == 0 || !r.holds(at, 2 + 12 * uint64_t(n) + 4))
        return read;
    for (unsigned i = 0; i < n; i++)
        read_entry(r, at + 2 + 12 * uint64_t(i), room, read);
    next = r.number(at + 2 + 12 * uint64_t(n), 4);
    return read;
}

bool is_pixel_layout_tag(unsigned tag)
{
    static const unsigned tags[] = {
        256, 257, 258, 259, 262, 263, 264, 265, 266, 273, 277, 278,
        279, 280, 281, 284, 288, 289, 292, 293, 317, 320, 322, 323,
        324, 325, 330, 332, 334, 338, 339, 340, 341, 347, 512, 513,
        514, 515, 517, 518, 519, 520, 521, 529, 530, 531, 532, 559};

    for (const unsigned structure : tags)
        if (tag == structure)
            return true;
    return false;
}

enum {
    XMP = 700,
    IPTC = 33723,
    PHOTOSHOP = 34377,
    EXIF = 34665,
    PROFILE = 34675,
    GPS = 34853,
    INTEROPERABILITY = 40965
};

void append_little_number(bytes &to, uint32_t value, int n)
{
    for (int i = 0; i < n; i++)
        to.push_back(static_cast<unsigned char>(value >> (8 * i)));
}

/* Appends the values of directory D to the file TO, and then D itself, with
 * NEXT as the offset of the next directory. Returns the offset of D. */
uint32_t write_directory(bytes &to, const directory &d, uint32_t next)
{
    bytes list;

    append_little_number(list, static_cast<uint32_t>(d.size()), 2);
    for (const auto &pair : d) {
        const struct entry &e = pair.second;

        append_little_number(list, pair.first, 2);
        append_little_number(list, e.type, 2);
        append_little_number(list, e.count, 4);
        if (e.values.size() > 4) {
            to.resize((to.size() + 1) & ~size_t(1));
            append_little_number(list, static_cast<uint32_t>(to.size()), 4);
            to.insert(to.end(), e.values.begin(), e.values.end());
        } else {
            list.insert(list.end(), e.values.begin(), e.values.end());
            list.resize(list.size() + 4 - e.values.size());
        }
    }
    append_little_number(list, next, 4);
    to.resize((to.size() + 1) & ~size_t(1));
    const uint32_t at = static_cast<uint32_t>(to.size());
    to.insert(to.end(), list.begin(), list.end());
    return at;
}

uint32_t read_directory_pointer(const struct entry &e)
{
    return e.values.size() != 4
               ? 0
               : uint32_t(e.values[3]) << 24 | uint32_t(e.values[2]) << 16 |
                     uint32_t(e.values[1]) << 8 | e.values[0];
}

/* Copies the directories to which D points (Exif, GPS, interoperability) from
 * FROM to TO. Sets the pointers in D to their new offsets; removes those to
 * malformed or too deeply nested directories. */
void copy_pointed_directories(bytes &to, const reader &from, directory &d,
                              int depth)
{
    for (const unsigned tag : {EXIF, GPS, INTEROPERABILITY}) {
        const auto found = d.find(tag);
        uint32_t next;

        if (found == d.end())
            continue;
        directory sub =
            read_directory(from, read_directory_pointer(found->second), next);
        if (sub.empty() || depth > 2) {
            d.erase(found);
            continue;
        }
        copy_pointed_directories(to, from, sub, depth + 1);
        const uint32_t at = write_directory(to, sub, 0);
        found->second = {4, 1, {}};
        append_little_number(found->second.values, at, 4);
    }
}

/* Appends directory D to FILE, a little-endian TIFF, and writes the offset of D
 * to LINK. NEXT: offset of the next directory. Returns the offset at which NEXT
 * is stored. */
uint64_t append_linked_directory(bytes &file, uint64_t link, const directory &d,
                                 uint32_t next)
{
    const uint32_t now = write_directory(file, d, next);

    for (int k = 0; k < 4; k++)
        file[link + static_cast<uint64_t>(k)] =
            static_cast<unsigned char>(now >> (8 * k));
    return now + 2 + 12 * d.size();
}

} // namespace

bool is_classic_tiff(const bytes &file)
{
    return file.size() >= 8 && (!std::memcmp(file.data(), "II*\0", 4) ||
                                !std::memcmp(file.data(), "MM\0*", 4));
}

bytes copy_tiff_metadata(const bytes &made, const bytes &from, bool drop_icc)
{
    if (!is_classic_tiff(made) || !is_classic_tiff(from) || made[0] != 'I')
        return made;
    const reader ours = {made, true}, theirs = {from, from[0] == 'I'};
    bytes file = made;
    uint32_t our_next = ours.number(4, 4), their_next = theirs.number(4, 4);
    uint64_t link = 4; /* offset of the link to the next directory */

    for (int i = 0; i < 64 && our_next && their_next; i++) {
        const uint32_t at = our_next;
        directory d = read_directory(ours, at, our_next);
        directory other = read_directory(theirs, their_next, their_next);

        for (auto e = d.begin(); e != d.end();)
            e = is_pixel_layout_tag(e->first) ? std::next(e) : d.erase(e);
        for (const auto &e : other)
            if (!is_pixel_layout_tag(e.first) &&
                !(drop_icc && e.first == PROFILE))
                d[e.first] = e.second;
        copy_pointed_directories(file, theirs, d, 0);
        link = append_linked_directory(file, link, d, our_next);
    }
    return file.size() < UINT32_MAX ? file : made;
}

bytes add_metadata_to_tiff(const bytes &made, const bytes &exif,
                           const std::string &xmp)
{
    if (!is_classic_tiff(made) || !is_classic_tiff(exif) || made[0] != 'I')
        return made;
    const reader ours = {made, true}, theirs = {exif, exif[0] == 'I'};
    bytes file = made;
    uint32_t our_next, their_next;
    directory d = read_directory(ours, ours.number(4, 4), our_next);

    for (const auto &e :
         read_directory(theirs, theirs.number(4, 4), their_next))
        if (!is_pixel_layout_tag(e.first))
            d[e.first] = e.second;
    if (!xmp.empty())
        d[XMP] = {1, static_cast<uint32_t>(xmp.size()),
                  bytes(xmp.begin(), xmp.end())};
    copy_pointed_directories(file, theirs, d, 0);
    append_linked_directory(file, 4, d, our_next);
    return file.size() < UINT32_MAX ? file : made;
}

file_blocks read_tiff_metadata(const bytes &whole)
{
    file_blocks b = {};

    if (!is_classic_tiff(whole))
        return b;
    const reader from = {whole, whole[0] == 'I'};
    uint32_t next;
    directory d = read_directory(from, from.number(4, 4), next);
    const auto xmp = d.find(XMP);

    if (xmp != d.end())
        b.xmp.assign(xmp->second.values.begin(), xmp->second.values.end());
    for (auto e = d.begin(); e != d.end();)
        e = is_pixel_layout_tag(e->first) || e->first == XMP ||
                    e->first == IPTC || e->first == PHOTOSHOP ||
                    e->first == PROFILE
                ? d.erase(e)
                : std::next(e);
    b.exif = {'I', 'I', '*', 0, 0, 0, 0, 0};
    copy_pointed_directories(b.exif, from, d, 0);
    append_linked_directory(b.exif, 4, d, 0);
    if (d.empty())
        b.exif.clear();
    return b;
}

} // namespace glint
