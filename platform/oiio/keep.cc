/* SPDX-License-Identifier: MIT
 *
 * Reads picture files with all of their content: the pixels of each part in the
 * types in which the file stores them, and metadata. Writes their parts
 * unchanged or modified, or other pixels with the metadata of the file. */
#include "oiio/keep.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "oiio/blocks.h"
#include "oiio/guard.h"
#include "oiio/heif.h"
#include "oiio/icc.h"

#if __has_include(<webp/encode.h>)
#include <webp/decode.h>
#include <webp/encode.h>
#endif

using glint::bytes;
using glint::failure;
using glint::open_picture;
using glint::reject_unsupported_spec;
using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace glint
{

struct kept_part {
    OIIO::ImageSpec spec; /* description of the part as the file stores it */
    std::vector<unsigned char> pixels;
};

inline bool has_mixed_channel_types(const OIIO::ImageSpec &spec)
{
    return !spec.channelformats.empty();
}

} // namespace glint

using glint::kept_part;

struct glint_oiio_file {
    std::string type;   /* OpenImageIO's name of the file type */
    glint::bytes whole; /* bytes of the file, if it is a HEIF or
                           is_metadata_copied(type) */
    std::vector<glint::kept_part> parts;
    std::vector<unsigned char> icc;
    glint::file_blocks meta; /* metadata as read, for types that have metadata
                                blocks */
    const char *metadata;    /* as in glint_oiio_facts */
    /* HEIF only: number of bits of the file's samples, or 0; and a text that
     * lists the content that is not preserved. */
    int bits;
    bool is_avif;
    std::string lost;
    /* link: conversion by the profile of parts[0]; only set if this profile
     * consists of tables and can also convert RGB back to codes. rgb: the
     * pixels converted to RGB, to which light is added. */
    std::unique_ptr<glint::icc_link> link;
    glint::kept_part rgb;
    bool drops_icc; /* true: the pixels of parts[0] are no longer in the file's
                       profile */
};

namespace
{

bool has_avif_extension(const char *path)
{
    return OIIO::Strutil::iends_with(path, ".avif");
}

/* Returns whether metadata of files of TYPE, a name of OpenImageIO, are copied
 * byte for byte. */
bool is_metadata_copied(const std::string &type)
{
    return type == "png" || type == "jpeg" || type == "webp" || type == "tiff";
}

bytes read_whole_file(const char *path)
{
    FILE *const f = std::fopen(path, "rb");
    unsigned char block[65536];
    bytes all;

    if (!f)
        throw failure{GLINT_E_IO, "cannot be opened"};
    for (size_t n; (n = std::fread(block, 1, sizeof block, f)) > 0;)
        all.insert(all.end(), block, block + n);
    std::fclose(f);
    return all;
}

/* WebP is read and written by its own library, because OpenImageIO 2.4
 * multiplies colours by alpha on reading and does not divide by alpha on
 * writing. */
#if __has_include(<webp/encode.h>)

/* Returns whether decode_webp() can decode FILE: a WebP without animation, in a
 * build with libwebp. */
bool can_decode_webp(const bytes &file)
{
    WebPBitstreamFeatures is;

    return WebPGetFeatures(file.data(), file.size(), &is) == VP8_STATUS_OK &&
           !is.has_animation;
}

/* Returns the pixels of FILE in 8 bits: R G B A if CHANNELS is 4, else R G B.
 * Throws failure. */
bytes decode_webp(const bytes &file, int channels)
{
    int width = 0, height = 0;
    if (!WebPGetInfo(file.data(), file.size(), &width, &height))
        throw failure{GLINT_E_FORMAT, "is not a WebP"};
    const size_t row = static_cast<size_t>(channels) * size_t(width);
    bytes pixels(row * size_t(height));
    const auto *const done =
        channels == 4
            ? WebPDecodeRGBAInto(file.data(), file.size(), pixels.data(),
                                 pixels.size(), static_cast<int>(row))
            : WebPDecodeRGBInto(file.data(), file.size(), pixels.data(),
                                pixels.size(), static_cast<int>(row));

    if (!done)
        throw failure{GLINT_E_FORMAT, "is cut off or damaged"};
    return pixels;
}

/* Returns the file of PIXELS, 8 bits, encoded as WebP of QUALITY 1 .. 100, or
 * lossless for 0. Throws failure. */
bytes encode_webp(const unsigned char *pixels, int width, int height,
                  int channels, int quality)
{
    WebPConfig config;
    WebPPicture picture;
    WebPMemoryWriter writer;

    if (!WebPConfigPreset(&config, WEBP_PRESET_PHOTO,
                          static_cast<float>(quality ? quality : 100)) ||
        !WebPPictureInit(&picture))
        throw failure{GLINT_E_OUTPUT,
                      "the installed libwebp has an incompatible version"};
    if (width > WEBP_MAX_DIMENSION || height > WEBP_MAX_DIMENSION)
        throw failure{GLINT_E_OUTPUT, "WebP has at most 16383 pixels a side"};
    if (!quality)
        WebPConfigLosslessPreset(&config, 6);
    config.exact = 1; /* preserves the colours of pixels whose alpha is 0 */
    config.thread_level = 1;
    picture.use_argb = quality == 0;
    picture.width = width;
    picture.height = height;
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
    WebPMemoryWriterInit(&writer);
    const bool done =
        (channels == 4 ? WebPPictureImportRGBA(&picture, pixels, 4 * width)
                       : WebPPictureImportRGB(&picture, pixels, 3 * width)) &&
        WebPEncode(&config, &picture);
    const int code = picture.error_code;
    const bytes made(writer.mem, writer.mem + (done ? writer.size : 0));
    WebPPictureFree(&picture);
    WebPMemoryWriterClear(&writer);
    if (!done)
        throw failure{code == VP8_ENC_ERROR_OUT_OF_MEMORY ? GLINT_E_MEMORY
                                                          : GLINT_E_OUTPUT,
                      "libwebp failed with error " + std::to_string(code)};
    return made;
}

#else

bool can_decode_webp(const bytes &)
{
    return false;
}

bytes decode_webp(const bytes &, int)
{
    return {};
}

bytes encode_webp(const unsigned char *, int, int, int, int)
{
    throw failure{GLINT_E_UNSUPPORTED,
                  "this plug-in was built without libwebp: install libwebp-dev "
                  "and build it again"};
}

#endif

/* ----------------------------------------------------------------- reading */

constexpr TypeDesc::BASETYPE types[] = {/* by enum glint_sample */
                                        TypeDesc::UINT8,  TypeDesc::UINT16,
                                        TypeDesc::UINT32, TypeDesc::HALF,
                                        TypeDesc::FLOAT,  TypeDesc::DOUBLE};

bool convert_to_sample_type(TypeDesc type, enum glint_sample &sample)
{
    for (size_t i = 0; i < std::size(types); i++)
        if (type.basetype == types[i]) {
            sample = static_cast<enum glint_sample>(i);
            return true;
        }
    return false;
}

/* If glint cannot compute with one of the part's sample types, requests that
 * the part is read as floats. */
void request_supported_sample_types(ImageSpec &spec)
{
    enum glint_sample sample;
    bool all = convert_to_sample_type(spec.format, sample);

    for (const TypeDesc &type : spec.channelformats)
        all = all && convert_to_sample_type(type, sample);
    if (!all)
        spec.set_format(TypeDesc::FLOAT);
}

/* Returns SPEC, changed to describe a C M Y K picture. SPEC may describe the
 * RGB to which OpenImageIO has converted the picture. */
ImageSpec convert_spec_to_cmyk(ImageSpec spec)
{
    spec.nchannels = 4;
    spec.channelnames = {"C", "M", "Y", "K"};
    spec.alpha_channel = -1; /* OpenImageIO 2.4 treats K of a TIFF as alpha. */
    return spec;
}

void read_picture_part(ImageInput &in, int index,
                       const struct glint_oiio_file &file, kept_part &part)
{
    part.spec = in.spec(index);
    if (part.spec.width < 1 || part.spec.nchannels < 1)
        throw failure{GLINT_E_FORMAT, in.geterror()};
    reject_unsupported_spec(part.spec);
    request_supported_sample_types(part.spec);
    if (file.link && index == 0) {
        part.spec = convert_spec_to_cmyk(part.spec);
        if (file.type == "jpeg") {
            part.pixels = glint::decode_cmyk_jpeg(file.whole, part.spec.width,
                                                  part.spec.height);
            return;
        }
    }
    if (file.type == "webp" && can_decode_webp(file.whole)) {
        part.pixels = decode_webp(file.whole, part.spec.nchannels);
        part.spec.attribute("oiio:UnassociatedAlpha", 1);
        return;
    }
    part.pixels.resize(part.spec.image_bytes(true));
    if (!in.read_image(index, 0, 0, part.spec.nchannels,
                       glint::has_mixed_channel_types(part.spec)
                           ? TypeDesc::UNKNOWN
                           : part.spec.format,
                       part.pixels.data()))
        throw failure{GLINT_E_FORMAT, in.geterror()};
}

void check_file_complete(const struct glint_oiio_file &file)
{
    std::string missing;

    if (file.type == "jpeg")
        missing = glint::describe_missing_jpeg_data(file.whole);
    else if (file.type == "tiff")
        missing = glint::describe_missing_tiff_data(file.whole);
    if (!missing.empty())
        throw failure{GLINT_E_FORMAT, missing};
}

void read_heif(struct glint_oiio_file &file)
{
    glint::heif_picture read = glint::decode_heif(file.whole);
    ImageSpec spec(read.width, read.height, read.channels,
                   read.bits > 8 ? TypeDesc::UINT16 : TypeDesc::UINT8);
    const bytes &icc = read.meta.icc;

    if (!icc.empty())
        spec.attribute("ICCProfile",
                       TypeDesc(TypeDesc::UINT8, static_cast<int>(icc.size())),
                       icc.data());
    spec.attribute("Orientation", 1);
    if (!read.is_premultiplied)
        spec.attribute("oiio:UnassociatedAlpha", 1);
    file.type = "heif";
    file.bits = read.bits;
    file.is_avif = read.is_avif;
    file.lost = read.lost;
    file.meta = read.meta;
    file.parts.push_back({spec, std::move(read.pixels)});
}

/* Reads FILE by libheif if it is a HEIF by content and libheif is available.
 * Otherwise returns false. */
bool read_file_if_heif(struct glint_oiio_file &file, const char *path)
{
    bytes head(16);
    FILE *const f = std::fopen(path, "rb");

    if (!f)
        throw failure{GLINT_E_IO, "cannot be opened"};
    head.resize(std::fread(head.data(), 1, head.size(), f));
    std::fclose(f);
    if (!glint::is_heif(head))
        return false;
    if (!glint::is_heif_readable()) {
        file.lost = "read as sRGB of 8 bits, as glint was built without "
                    "libheif-dev";
        return false;
    }
    file.whole = read_whole_file(path);
    read_heif(file);
    return true;
}

/* Returns the ICC profile of a part of FILE; empty if it has none. */
bytes get_icc_profile(const struct glint_oiio_file &file, const ImageSpec &spec)
{
    const OIIO::ParamValue *const icc = spec.find_attribute("ICCProfile");

    if (icc && icc->type().basetype == TypeDesc::UINT8) {
        const auto *const at = static_cast<const unsigned char *>(icc->data());

        return bytes(at, at + icc->type().size());
    }
    return file.type == "webp" ? file.meta.icc : bytes();
}

/* Returns whether OpenImageIO has converted C M Y K to RGB. */
bool is_rgb_from_cmyk(const struct glint_oiio_file &file, const ImageSpec &spec)
{
    return spec.nchannels == 3 &&
           (file.type == "jpeg"
                ? glint::is_cmyk_jpeg(file.whole)
                : spec.get_string_attribute("tiff:ColorSpace") == "CMYK");
}

/* Sets FILE.link to the conversion by the profile of PART, if its samples allow
 * one. */
void open_icc_link_of_part(struct glint_oiio_file &file, const kept_part &part)
{
    const ImageSpec &spec = part.spec;
    const bool alpha = spec.alpha_channel >= 0;
    const glint::code_layout layout = {size_t(spec.nchannels - alpha), alpha,
                                       spec.format.size()};

    if (glint::has_mixed_channel_types(spec) || file.meta.cicp[1] ||
        (spec.format != TypeDesc::UINT8 && spec.format != TypeDesc::UINT16) ||
        (alpha && (spec.alpha_channel != spec.nchannels - 1 ||
                   !spec.get_int_attribute("oiio:UnassociatedAlpha", 0))))
        return;
    /* OpenImageIO cannot write CMYK JPEGs, so for these the conversion from RGB
     * back to codes is not needed. */
    file.link =
        glint::open_icc_link(get_icc_profile(file, spec), layout,
                             file.type != "jpeg" || layout.n_colours != 4);
}

/* If the profile of IN, the picture of the file PATH, is for C M Y K, sets
 * FILE.link and, unless it is a JPEG, opens IN again to read C M Y K. */
void request_cmyk_reading(struct glint_oiio_file &file,
                          std::unique_ptr<ImageInput> &in, const char *path,
                          ImageSpec &config)
{
    /* OpenImageIO 2.4 can return only RGB for C M Y K in a TIFF compressed as
     * JPEG. */
    if (!is_rgb_from_cmyk(file, in->spec()) ||
        in->spec().get_string_attribute("compression") == "jpeg")
        return;
    open_icc_link_of_part(file, {convert_spec_to_cmyk(in->spec()), {}});
    if (!file.link || file.type == "jpeg")
        return;
    config.attribute("oiio:RawColor", 1);
    std::unique_ptr<ImageInput> raw = open_picture(path, &config);
    if (raw->spec().nchannels == 4)
        in = std::move(raw);
    else
        file.link.reset();
}

/* If FILE has a conversion by its profile, converts its pixels to RGB. The RGB
 * becomes FILE.rgb or, if it cannot be converted back, replaces the pixels. */
void add_rgb_by_profile(struct glint_oiio_file &file)
{
    kept_part &part = file.parts.at(0);
    kept_part rgb;

    if (!file.link && !is_rgb_from_cmyk(file, part.spec))
        open_icc_link_of_part(file, part);
    if (!file.link)
        return;
    const bool alpha = file.link->rgb.has_alpha;
    const bool is_ink = file.link->codes.n_colours == 4;
    rgb.pixels = file.link->decode(part.pixels);
    rgb.spec = part.spec;
    rgb.spec.nchannels = 3 + alpha;
    rgb.spec.default_channel_names();
    rgb.spec.set_format(types[file.link->rgb.sample_bytes - 1]);
    for (const char *name : {"ICCProfile", "tiff:ColorSpace", "oiio:ColorSpace",
                             "tiff:PhotometricInterpretation"})
        rgb.spec.erase_attribute(name);
    if (file.link->can_encode) {
        file.rgb = std::move(rgb);
        if (is_ink && part.spec.format != TypeDesc::UINT8) /* OpenImageIO 2.4
                                                              cannot write other
                                                              CMYK samples */
            file.lost += std::string(file.lost.empty() ? "" : "; ") +
                         "its CMYK is written in 8 bits";
        return;
    }
    file.lost += std::string(file.lost.empty() ? "" : "; ") +
                 (is_ink ? "its CMYK becomes sRGB"
                         : "its ICC profile cannot convert colours back, so "
                           "they become sRGB");
    part = std::move(rgb);
    file.meta.icc.clear();
    file.drops_icc = true;
    file.link.reset();
}

void read_file(struct glint_oiio_file &file, const char *path)
{
    ImageSpec as_stored;

    if (read_file_if_heif(file, path))
        return;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<ImageInput> in = open_picture(path, &as_stored);
    reject_unsupported_spec(in->spec());
    file.type = in->format_name();
    if (is_metadata_copied(file.type))
        file.whole = read_whole_file(path);
    check_file_complete(file);
    file.meta = glint::read_metadata_blocks(file.type, file.whole);
    request_cmyk_reading(file, in, path, as_stored);
    for (int i = 0; i < 64 && in->seek_subimage(i, 0); i++) {
        file.parts.emplace_back();
        read_picture_part(*in, i, file, file.parts.back());
        if (in->format_name() != std::string("openexr") &&
            in->format_name() != std::string("tiff"))
            break;
    }
}

/* ----------------------------------------------------------------- channels */

int find_channel(const ImageSpec &spec, const std::string &name)
{
    for (int i = 0; i < spec.nchannels; i++)
        if (OIIO::Strutil::iequals(spec.channelnames[i], name))
            return i;
    return -1;
}

/* the channels of a part that are chosen, by name, as its colours and alpha */
struct choice {
    int index[4]; /* indices of the channels of R, G, B, alpha; -1: none */
    /* preference of this choice, 1 .. 4 (higher is better); 0: nothing
     * chosen */
    int rank;
};

int rank_channel_prefix(const std::string &prefix)
{
    if (prefix.empty())
        return 4;
    for (const char *word : {"combined", "beauty", "rgba"})
        if (OIIO::Strutil::icontains(prefix, word))
            return 3;
    return 2;
}

choice choose_channels(const ImageSpec &spec)
{
    choice best = {{0, 0, 0, -1}, 1};

    for (int i = 0; i < spec.nchannels; i++) {
        const std::string &name = spec.channelnames[i];
        const size_t n = name.size();

        if (n < 1 || std::tolower(name[n - 1]) != 'r' ||
            (n > 1 && name[n - 2] != '.'))
            continue;
        const std::string prefix = name.substr(0, n - 1);
        const int g = find_channel(spec, prefix + "G");
        const int b = find_channel(spec, prefix + "B");
        if (g >= 0 && b >= 0 && rank_channel_prefix(prefix) > best.rank)
            best = {{i, g, b, find_channel(spec, prefix + "A")},
                    rank_channel_prefix(prefix)};
    }
    if (best.rank > 1)
        return best;
    best.index[3] = spec.alpha_channel;
    const int n_colours = spec.nchannels - (spec.alpha_channel >= 0);
    if (n_colours >= 3)
        return {{0, 1, 2, spec.alpha_channel}, 2};
    const int y = find_channel(spec, "Y");
    if (y >= 0)
        best.index[0] = best.index[1] = best.index[2] = y;
    return best;
}

struct glint_sample_place get_position_of_sample(const ImageSpec &spec,
                                                 int index)
{
    struct glint_sample_place channel = {GLINT_SAMPLE_FLOAT, 0};

    convert_to_sample_type(spec.channelformat(index), channel.sample);
    channel.offset = 0;
    for (int i = 0; i < index; i++)
        channel.offset += spec.channelformat(i).size();
    return channel;
}

void fill_samples(struct glint_samples &s, kept_part &part,
                  const choice &choice)
{
    const ImageSpec &spec = part.spec;

    s = {};
    s.width = spec.width;
    s.height = spec.height;
    s.x = spec.x - spec.full_x;
    s.y = spec.y - spec.full_y;
    s.window_width = spec.full_width;
    s.window_height = spec.full_height;
    s.orientation = spec.get_int_attribute("Orientation", 1);
    if (s.orientation < 1 || s.orientation > 8)
        s.orientation = 1;
    s.pixel_bytes = spec.pixel_bytes(true);
    s.n_colours = choice.index[1] == choice.index[0] ? 1 : 3;
    for (int c = 0; c < 3; c++)
        s.colour[c] = get_position_of_sample(spec, choice.index[c]);
    s.has_alpha = choice.index[3] >= 0;
    s.is_premultiplied = !spec.get_int_attribute("oiio:UnassociatedAlpha", 0);
    if (s.has_alpha)
        s.alpha = get_position_of_sample(spec, choice.index[3]);
    s.maximum = s.colour[0].sample == GLINT_SAMPLE_U8    ? 0xffu
                : s.colour[0].sample == GLINT_SAMPLE_U16 ? 0xffffu
                                                         : 0xffffffffu;
    s.mem = part.pixels.data();
}

/* ------------------------------------------------------------------- facts */

void describe_png_in_facts(struct glint_oiio_facts &facts, const bytes &whole)
{
    const bytes gamma = glint::find_png_chunk(whole, "gAMA");
    const bytes srgb = glint::find_png_chunk(whole, "sRGB");
    const bytes primaries = glint::find_png_chunk(whole, "cHRM");
    const auto read_big32 = [](const bytes &b, size_t at) {
        return (unsigned(b[at]) << 24 | unsigned(b[at + 1]) << 16 |
                unsigned(b[at + 2]) << 8 | b[at + 3]) *
               1e-5;
    };

    facts.colour_space[0] = 0;
    if (!srgb.empty())
        return;
    if (gamma.size() == 4 && read_big32(gamma, 0) > 0)
        facts.gamma = 1 / read_big32(gamma, 0);
    if (primaries.size() != 32)
        return;
    facts.has_primaries = 1;
    for (size_t i = 0; i < 8; i++) /* the cHRM chunk begins with white */
        facts.primaries[(i / 2 + 3) % 4][i % 2] = read_big32(primaries, 4 * i);
}

void describe_camera_in_facts(struct glint_oiio_facts &facts,
                              const ImageSpec &spec)
{
    const auto get = [&](const char *name) {
        return static_cast<double>(spec.get_float_attribute(name, 0));
    };

    facts.f_number = get("FNumber");
    facts.focal_mm = get("Exif:FocalLength");
    facts.film_focal_mm = get("Exif:FocalLengthIn35mmFilm");
}

void append_note(char (&notes)[160], const char *text)
{
    const size_t used = std::strlen(notes);

    std::snprintf(notes + used, sizeof notes - used, "%s%s", used ? "; " : "",
                  text);
}

void describe_file_in_facts(struct glint_oiio_facts &facts,
                            struct glint_oiio_file &file, const ImageSpec &spec)
{
    const OIIO::ParamValue *const xy = spec.find_attribute("chromaticities");

    facts = {};
    file.metadata = !file.meta.exif.empty()
                        ? file.meta.xmp.empty() ? "Exif" : "Exif and XMP"
                    : file.meta.xmp.empty() ? ""
                                            : "XMP";
    facts.metadata = file.metadata;
    facts.cicp[0] = file.meta.cicp[0];
    facts.cicp[1] = file.meta.cicp[1];
    file.icc = get_icc_profile(file, spec);
    if (!file.icc.empty()) {
        facts.icc = file.icc.data();
        facts.icc_bytes = file.icc.size();
    }
    if (xy && xy->type().size() == 8 * sizeof(float)) {
        facts.has_primaries = 1;
        for (int i = 0; i < 8; i++)
            facts.primaries[i / 2][i % 2] =
                static_cast<double>(static_cast<const float *>(xy->data())[i]);
    }
    std::snprintf(facts.colour_space, sizeof facts.colour_space, "%s",
                  spec.get_string_attribute("oiio:ColorSpace").c_str());
    describe_camera_in_facts(facts, spec);
    if (file.type == "png")
        describe_png_in_facts(facts, file.whole);
    if (file.type == "jpeg") {
        facts.quality = glint::estimate_jpeg_quality(file.whole);
        const std::string more = glint::describe_extra_jpeg_data(file.whole);

        if (!more.empty())
            append_note(facts.note, more.c_str());
    }
    if (is_rgb_from_cmyk(file, spec) && !file.drops_icc) {
        append_note(facts.note, file.type == "jpeg"
                                    ? "its CMYK becomes RGB"
                                    : "its CMYK is converted to RGB and back, "
                                      "which changes all inks");
        file.drops_icc = true;
    }
    if (!file.lost.empty())
        append_note(facts.note, file.lost.c_str());
    if (spec.get_int_attribute("oiio:Movie", 0) ||
        spec.get_int_attribute("gif:FrameCount", 0) > 1 ||
        (file.type == "png" &&
         !glint::find_png_chunk(file.whole, "acTL").empty()) ||
        (file.type == "webp" && glint::is_animated_webp(file.whole)))
        append_note(facts.note, "only its first frame is written");
}

/* Describes in FACTS the colours of the RGB to which FILE's pixels were
 * converted by its profile. */
void describe_linked_colours(struct glint_oiio_facts &facts,
                             const struct glint_oiio_file &file)
{
    facts.icc = nullptr;
    facts.colour_space[0] = 0;
    facts.gamma = file.link ? glint::wide_gamma : 0;
    facts.has_primaries = file.link != nullptr;
    for (int i = 0; i < 8; i++)
        facts.primaries[i / 2][i % 2] = glint::wide_primaries[i / 2][i % 2];
}

} // namespace

void glint::copy_to_malloc(void **data, size_t *n_bytes, const bytes &encoded)
{
    void *const block = std::malloc(encoded.size() + 1);

    if (!block)
        throw std::bad_alloc();
    std::memcpy(block, encoded.data(), encoded.size());
    *data = block;
    *n_bytes = encoded.size();
}

glint::memory_file::memory_file() : fd(memfd_create("parts", MFD_CLOEXEC))
{
    if (fd < 0)
        throw std::bad_alloc();
}

glint::memory_file::~memory_file()
{
    close(fd);
}

std::string glint::memory_file::name() const
{
    return "/proc/self/fd/" + std::to_string(fd);
}

bytes glint::memory_file::contents() const
{
    return read_whole_file(name().c_str());
}

enum glint_status glint::open_file(struct glint_oiio_file **file,
                                   struct glint_samples *samples,
                                   struct glint_oiio_facts *facts,
                                   const char *path, struct glint_error *error)
{
    return guarded(path, GLINT_E_FORMAT, error, [&] {
        auto made = std::make_unique<struct glint_oiio_file>();
        choice best = {{0, 0, 0, -1}, 0};
        size_t at = 0;

        read_file(*made, path);
        add_rgb_by_profile(*made);
        /* If there are several parts, only the first is converted by its
         * profile. */
        const bool linked = made->link || made->drops_icc;
        for (size_t i = 0; i < (linked ? 1 : made->parts.size()); i++) {
            const choice here = choose_channels(made->parts[i].spec);

            if (here.rank > best.rank) {
                best = here;
                at = i;
            }
        }
        describe_file_in_facts(*facts, *made, made->parts.at(at).spec);
        if (linked)
            describe_linked_colours(*facts, *made);
        if (made->link)
            fill_samples(*samples, made->rgb, choose_channels(made->rgb.spec));
        else
            fill_samples(*samples, made->parts[at], best);
        *file = made.release();
    });
}

void glint::close_file(struct glint_oiio_file *file)
{
    struct glint_error error;

    guarded("a picture", GLINT_E_FORMAT, &error, [&] { delete file; });
}

int glint::is_same_type(const struct glint_oiio_file *file, const char *path)
{
    struct glint_error error;
    bool is_same = false;

    guarded(path, GLINT_E_FORMAT, &error, [&] {
        const std::unique_ptr<ImageOutput> out = ImageOutput::create(path);

        is_same =
            out && file->type == out->format_name() &&
            (file->type != "heif" || file->is_avif == has_avif_extension(path));
    });
    return is_same;
}

int glint::can_write(const char *path)
{
    struct glint_error error;
    bool can = false;

    guarded(path, GLINT_E_OUTPUT, &error, [&] {
        const std::unique_ptr<ImageOutput> out = ImageOutput::create(path);

        can = out && (out->format_name() != std::string("heif") ||
                      is_heif_writable(has_avif_extension(path)));
    });
    return can;
}

/* ----------------------------------------------------------------- writing */

namespace
{

/* A file in memory for OpenImageIO's writers. It can also be read, because the
 * TIFF writer reads what it has written. */
class memory : public OIIO::Filesystem::IOProxy
{
  public:
    explicit memory(bytes &to) : IOProxy("", Write), data(to)
    {
    }
    const char *proxytype() const override
    {
        return "glint";
    }
    size_t write(const void *buf, size_t size) override
    {
        size = pwrite(buf, size, m_pos);
        m_pos += static_cast<int64_t>(size);
        return size;
    }
    size_t pwrite(const void *buf, size_t size, int64_t offset) override
    {
        const size_t end = static_cast<size_t>(offset) + size;

        if (data.size() < end)
            data.resize(end);
        std::memcpy(data.data() + offset, buf, size);
        return size;
    }
    size_t read(void *buf, size_t size) override
    {
        size = pread(buf, size, m_pos);
        m_pos += static_cast<int64_t>(size);
        return size;
    }
    size_t pread(void *buf, size_t size, int64_t offset) override
    {
        const size_t at = static_cast<size_t>(offset);

        size = at < data.size() ? std::min(size, data.size() - at) : 0;
        std::memcpy(buf, data.data() + (size ? at : 0), size);
        return size;
    }
    size_t size() const override
    {
        return data.size();
    }

  private:
    bytes &data;
};

/* Removes the attributes that describe how the input file was coded. */
void remove_coding_attributes(ImageSpec &spec)
{
    for (const char *name :
         {"compression",          "oiio:BitsPerSample",
          "tiff:Compression",     "tiff:PhotometricInterpretation",
          "tiff:ColorSpace",      "tiff:PlanarConfiguration",
          "planarconfig",         "tiff:RowsPerStrip",
          "tiff:Predictor",       "tiff:PageNumber",
          "openexr:lineOrder",    "png:compressionLevel",
          "oiio:ColorSpace",      "oiio:Gamma",
          "Exif:PixelXDimension", "Exif:PixelYDimension",
          "oiio:subimages",       "thumbnail_width",
          "thumbnail_height",     "thumbnail_nchannels",
          "thumbnail_image",      "jpeg:subsampling"})
        spec.erase_attribute(name);
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
}

ImageSpec copy_basic_spec(const ImageSpec &spec)
{
    ImageSpec to(spec.width, spec.height, spec.nchannels, spec.format);

    to.channelnames = spec.channelnames;
    to.alpha_channel = spec.alpha_channel;
    to.tile_width = spec.tile_width;
    to.tile_height = spec.tile_height;
    for (const char *name :
         {"oiio:UnassociatedAlpha", "jpeg:subsampling", "compression",
          "oiio:BitsPerSample", "planarconfig", "tiff:PlanarConfiguration",
          "tiff:Compression", "tiff:PhotometricInterpretation",
          "tiff:RowsPerStrip", "tiff:Predictor", "tiff:ColorSpace",
          "tiff:zipquality"})
        if (const OIIO::ParamValue *const p = spec.find_attribute(name))
            to.extra_attribs.push_back(*p);
    return to;
}

/* Removes the attributes that would make OpenImageIO 2.4 write an Exif
 * directory to a TIFF. This directory is corrupt for files in memory. */
void remove_exif_attributes(ImageSpec &spec)
{
    const auto is_exif = [](const OIIO::ParamValue &p) {
        return OIIO::Strutil::starts_with(p.name(), "Exif:") ||
               OIIO::Strutil::starts_with(p.name(), "GPS:") ||
               p.name() == "ExposureTime" || p.name() == "FNumber" ||
               p.name() == "oiio:ColorSpace";
    };

    spec.extra_attribs.erase(std::remove_if(spec.extra_attribs.begin(),
                                            spec.extra_attribs.end(), is_exif),
                             spec.extra_attribs.end());
}

/* Returns the quality for writing a file of TYPE, 1 .. 100, or 0: lossless. It
 * is the quality in OPTIONS; else, if FILE has the same TYPE, that of a JPEG or
 * 0 for a lossless WebP; else 95. */
int choose_quality(const std::string &type, const struct glint_oiio_file *file,
                   const struct glint_oiio_options &options)
{
    const bool same = file && file->type == type;

    if (options.quality)
        return options.quality;
    if (same && type == "webp" && glint::is_lossless(file->whole))
        return 0;
    const int own =
        same && type == "jpeg" ? glint::estimate_jpeg_quality(file->whole) : 0;
    return own ? own : 95;
}

/* Returns a part with the pixels SAMPLES, and with the metadata of FILE unless
 * FILE is NULL. */
kept_part create_part(const struct glint_samples &samples,
                      const struct glint_oiio_file *file)
{
    const int n = samples.n_colours + (samples.has_alpha ? 1 : 0);
    kept_part made;

    made.spec = ImageSpec(samples.width, samples.height, n,
                          types[samples.colour[0].sample]);
    if (file) {
        ImageSpec own = file->parts[0].spec;

        remove_coding_attributes(own);
        made.spec.extra_attribs = own.extra_attribs;
        made.spec.attribute("Orientation", 1);
    }
    made.spec.erase_attribute("oiio:UnassociatedAlpha");
    if (samples.n_colours == 1)
        made.spec.channelnames[0] = "Y";
    made.spec.alpha_channel = samples.has_alpha ? n - 1 : -1;
    if (samples.has_alpha) {
        made.spec.channelnames[n - 1] = "A";
        if (!samples.is_premultiplied)
            made.spec.attribute("oiio:UnassociatedAlpha", 1);
    }
    made.pixels.assign(samples.mem, samples.mem + made.spec.image_bytes(true));
    return made;
}

void write_parts(ImageOutput &out, const char *path,
                 std::vector<ImageSpec> &specs,
                 const std::vector<kept_part> &parts)
{
    const bool announced =
        parts.size() > 1 && out.format_name() == std::string("openexr");
    bool done = true;

    for (size_t i = 0; i < parts.size() && done; i++) {
        if (announced && i == 0)
            done = out.open(path, static_cast<int>(parts.size()), specs.data());
        else
            done = out.open(path, specs[i],
                            i == 0 ? ImageOutput::Create
                                   : ImageOutput::AppendSubimage);
        done = done && out.write_image(glint::has_mixed_channel_types(specs[i])
                                           ? TypeDesc::UNKNOWN
                                           : specs[i].format,
                                       parts[i].pixels.data());
    }
    if (!done || !out.close())
        throw failure{GLINT_E_OUTPUT, out.geterror()};
}

/* Returns whether FILE's metadata are copied byte for byte. They are not for a
 * BigTIFF, of which OpenImageIO copies the metadata that it knows. */
bool is_metadata_copied_from(const struct glint_oiio_file &file)
{
    return is_metadata_copied(file.type) &&
           (file.type != "tiff" || glint::is_classic_tiff(file.whole));
}

/* Encodes an EXR of several parts through a temporary file: OpenImageIO 2.4
 * cannot write it to memory, although it reports that it can. */
bytes encode_exr(ImageOutput &out, std::vector<ImageSpec> &specs,
                 const std::vector<kept_part> &parts)
{
    const glint::memory_file file;
    const std::unique_ptr<ImageInput> check = ImageInput::create("exr");
    ImageSpec first;

    write_parts(out, file.name().c_str(), specs, parts);
    if (!check || !check->open(file.name(), first) ||
        !check->seek_subimage(static_cast<int>(parts.size()) - 1, 0))
        throw failure{GLINT_E_OUTPUT, "could not be encoded in memory"};
    return file.contents();
}

bytes encode_by_oiio(ImageOutput &out, const char *path,
                     std::vector<ImageSpec> specs,
                     const std::vector<kept_part> &parts)
{
    bytes encoded;
    memory to(encoded);

    if (parts.size() > 1 && out.format_name() == std::string("openexr"))
        return encode_exr(out, specs, parts);
    if (out.set_ioproxy(&to)) {
        write_parts(out, path, specs, parts);
    }
    if (encoded.empty())
        throw failure{GLINT_E_OUTPUT, "OpenImageIO returned no encoded data"};
    return encoded;
}

/* Removes empty texts: OpenImageIO 2.4 aborts when it copies one into the IPTC
 * block of a JPEG or TIFF. */
void remove_empty_texts(ImageSpec &spec)
{
    auto &all = spec.extra_attribs;

    for (size_t i = all.size(); i-- > 0;)
        if (all[i].type() == TypeDesc::STRING && all[i].get_string().empty())
            all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
}

/* Returns the metadata blocks of FILE, with upright orientation, for writing to
 * another file. */
glint::file_blocks get_upright_blocks(const struct glint_oiio_file *file,
                                      const struct glint_oiio_options &options)
{
    glint::file_blocks b = {};

    if (file)
        b = file->meta;
    glint::set_upright_orientation(b);
    if (file && !options.drop_colours)
        b.icc = file->icc;
    else {
        b.icc.clear();
        std::fill_n(b.cicp, 4, static_cast<unsigned char>(0));
    }
    return b;
}

/* Returns PART encoded as HEIF, with the metadata blocks of FILE; grey is
 * written as R = G = B. */
bytes encode_heif(const char *path, const kept_part &part,
                  const struct glint_oiio_file *file, int quality,
                  struct glint_oiio_options &options)
{
    const size_t n = static_cast<size_t>(part.spec.nchannels);
    const bool alpha = part.spec.alpha_channel >= 0;
    const size_t sample = part.spec.format.size();
    glint::heif_picture p = {};

    p.width = part.spec.width;
    p.height = part.spec.height;
    p.channels = alpha ? 4 : 3;
    p.bits = sample == 1 ? 8 : file && file->bits > 8 ? file->bits : 16;
    p.is_avif = has_avif_extension(path);
    p.is_premultiplied =
        !part.spec.get_int_attribute("oiio:UnassociatedAlpha", 0);
    p.meta = get_upright_blocks(file, options);
    for (size_t at = 0; at < part.pixels.size(); at += n * sample)
        for (size_t c = 0; c < size_t(p.channels); c++) {
            const size_t from = n >= 3 ? c : c < 3 ? 0 : 1;

            p.pixels.insert(
                p.pixels.end(), part.pixels.begin() + long(at + from * sample),
                part.pixels.begin() + long(at + (from + 1) * sample));
        }
    if (glint::get_heif_bits(p) < p.bits)
        std::snprintf(options.said, sizeof options.said, "%d bits remain",
                      glint::get_heif_bits(p));
    return glint::encode_heif_picture(p, quality);
}

/* Returns ENCODED, a file of TYPE, with the metadata blocks of FILE, which has
 * another type. */
bytes add_metadata_blocks(const std::string &type, const bytes &encoded,
                          const struct glint_oiio_file *file,
                          struct glint_oiio_options &options)
{
    std::string lost;
    const glint::file_blocks b = get_upright_blocks(file, options);
    const bytes made = glint::replace_metadata_blocks(type, encoded, b, lost);

    /* OpenImageIO translates the metadata of other types to EXR headers, but
     * not those that libheif has read. */
    if (lost.empty() && file && file->type == "heif" && type == "openexr" &&
        *file->metadata)
        lost = std::string("no ") + file->metadata;

    std::snprintf(options.said, sizeof options.said, "%s", lost.c_str());
    return made;
}

bytes encode_parts(const char *path, const std::vector<kept_part> &parts,
                   const struct glint_oiio_file *file, bool same,
                   struct glint_oiio_options &options)
{
    const std::unique_ptr<ImageOutput> out = ImageOutput::create(path);
    const bool drop = options.drop_colours;
    std::vector<ImageSpec> specs;
    bytes encoded;

    if (!out)
        throw failure{GLINT_E_UNSUPPORTED, OIIO::geterror()};
    const std::string type = out->format_name();
    const int quality = choose_quality(type, file, options);
    if (type == "heif")
        return encode_heif(path, parts[0], file, quality, options);
    for (const kept_part &p : parts) {
        specs.push_back(same && is_metadata_copied_from(*file)
                            ? copy_basic_spec(p.spec)
                            : p.spec);
        if (type == "tiff")
            remove_exif_attributes(specs.back());
        if (type == "tiff" || type == "jpeg")
            remove_empty_texts(specs.back());
        if (drop)
            specs.back().erase_attribute("ICCProfile");
        if (type == "jpeg" || type == "jpegxl")
            specs.back().attribute("Compression",
                                   type + ":" + std::to_string(quality));
        if (same && type == "jpeg" && glint::is_progressive_jpeg(file->whole))
            specs.back().attribute("jpeg:progressive", 1);
    }
    if (type == "webp" && specs[0].nchannels >= 3)
        encoded = encode_webp(parts[0].pixels.data(), specs[0].width,
                              specs[0].height, specs[0].nchannels, quality);
    else
        encoded = encode_by_oiio(*out, path, specs, parts);
    if (!same)
        return add_metadata_blocks(type, encoded, file, options);
    return type == "png" ? glint::copy_png_metadata(encoded, file->whole, drop)
           : type == "jpeg"
               ? glint::copy_jpeg_metadata(encoded, file->whole, drop)
           : type == "webp"
               ? glint::copy_webp_metadata(encoded, file->whole, drop)
           : type == "tiff"
               ? glint::copy_tiff_metadata(encoded, file->whole, drop)
               : encoded;
}

} // namespace

enum glint_status glint::encode_file(void **data, size_t *n_bytes,
                                     const char *path,
                                     struct glint_oiio_file *file,
                                     const struct glint_samples *pixels,
                                     struct glint_oiio_options *options,
                                     struct glint_error *error)
{
    return guarded(path, GLINT_E_OUTPUT, error, [&] {
        options->said[0] = 0;
        const bool same = file && is_same_type(file, path);
        std::vector<kept_part> made;

        if (file && file->drops_icc)
            options->drop_colours = 1;
        if (pixels)
            made.push_back(create_part(*pixels, file));
        else if (file->link)
            file->link->encode(file->rgb.pixels, file->parts[0].pixels);
        const bytes encoded = encode_parts(path, pixels ? made : file->parts,
                                           file, same, *options);

        if (pixels && file && file->link && !same &&
            pixels->colour[0].sample < GLINT_SAMPLE_HALF)
            append_note(options->said,
                        "the colours of its profile become sRGB");
        copy_to_malloc(data, n_bytes, encoded);
    });
}
