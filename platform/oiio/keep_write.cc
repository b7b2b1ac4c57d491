/* SPDX-License-Identifier: MIT
 *
 * Writes whole files: parts as they came, or other pixels with the metadata of
 * the file. */
#include "oiio/keep.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "oiio/guard.h"

using glint::bytes;
using glint::failure;
using glint::kept_part;
using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace
{

/* A file in memory. TIFF also reads what it has written. */
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

TypeDesc to_type(enum glint_sample sample)
{
    static const TypeDesc::BASETYPE types[] = {
        TypeDesc::UINT8, TypeDesc::UINT16, TypeDesc::UINT32,
        TypeDesc::HALF,  TypeDesc::FLOAT,  TypeDesc::DOUBLE};

    return types[sample];
}

/* Removes the attributes that describe how the input was coded and not what it
 * shows. */
void clear_coding(ImageSpec &spec)
{
    for (const char *name : {"compression",
                             "oiio:BitsPerSample",
                             "tiff:Compression",
                             "tiff:PhotometricInterpretation",
                             "tiff:PlanarConfiguration",
                             "planarconfig",
                             "tiff:RowsPerStrip",
                             "tiff:Predictor",
                             "tiff:PageNumber",
                             "openexr:lineOrder",
                             "png:compressionLevel",
                             "oiio:ColorSpace",
                             "oiio:Gamma",
                             "Exif:PixelXDimension",
                             "Exif:PixelYDimension",
                             "oiio:subimages",
                             "thumbnail_width",
                             "thumbnail_height",
                             "thumbnail_nchannels",
                             "thumbnail_image",
                             "jpeg:subsampling"})
        spec.erase_attribute(name);
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
}

ImageSpec bare(const ImageSpec &spec)
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

/* Removes the attributes for which OpenImageIO 2.4 writes a TIFF's Exif
 * directory, which it spoils in memory. */
void clear_exif(ImageSpec &spec)
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

/* Returns the quality for a file of TYPE, 1 .. 100, or 0: without loss. It is
 * that of OPTIONS, else FILE's own if that is of TYPE, else 95. */
int quality_of(const std::string &type, const struct glint_oiio_file *file,
               const struct glint_oiio_options &options)
{
    const bool same = file && file->type == type;

    if (options.quality)
        return options.quality;
    if (same && type == "webp" && glint::is_lossless(file->whole))
        return 0;
    const int own =
        same && type == "jpeg" ? glint::quality_of_jpeg(file->whole) : 0;
    return own ? own : 95;
}

/* Returns SAMPLES as a part, with the metadata of FILE unless that is NULL. */
kept_part part_of(const struct glint_samples &samples,
                  const struct glint_oiio_file *file)
{
    const int n = samples.n_colours + (samples.has_alpha ? 1 : 0);
    kept_part made;

    made.spec = ImageSpec(samples.width, samples.height, n,
                          to_type(samples.colour[0].sample));
    if (file) {
        ImageSpec own = file->parts[0].spec;

        clear_coding(own);
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
        done = done &&
               out.write_image(glint::is_mixed(specs[i]) ? TypeDesc::UNKNOWN
                                                         : specs[i].format,
                               parts[i].pixels.data());
    }
    if (!done || !out.close())
        throw failure{GLINT_E_OUTPUT, out.geterror()};
}

/* Checks whether FILE's metadata are copied byte for byte. Those of BigTIFF are
 * not; OpenImageIO passes on what it knows of them. */
bool is_carried_from(const struct glint_oiio_file &file)
{
    return glint::is_carried(file.type) &&
           (file.type != "tiff" || glint::is_classic_tiff(file.whole));
}

/* Encodes an EXR of parts by way of a file: OpenImageIO 2.4 cannot write it
 * into memory, though it claims to. */
bytes encode_by_file(ImageOutput &out, std::vector<ImageSpec> &specs,
                     const std::vector<kept_part> &parts)
{
    const glint::memory_file file;
    const std::unique_ptr<ImageInput> check = ImageInput::create("exr");
    ImageSpec first;

    write_parts(out, file.name().c_str(), specs, parts);
    if (!check || !check->open(file.name(), first) ||
        !check->seek_subimage(static_cast<int>(parts.size()) - 1, 0))
        throw failure{GLINT_E_OUTPUT, "could not be written into memory"};
    return file.contents();
}

bytes encode_by_oiio(ImageOutput &out, const char *path,
                     std::vector<ImageSpec> specs,
                     const std::vector<kept_part> &parts)
{
    bytes encoded;
    memory to(encoded);

    if (parts.size() > 1 && out.format_name() == std::string("openexr"))
        return encode_by_file(out, specs, parts);
    if (!out.supports("ioproxy") || !out.set_ioproxy(&to))
        throw failure{GLINT_E_UNSUPPORTED, "OpenImageIO cannot write this "
                                           "type into memory"};
    write_parts(out, path, specs, parts);
    if (encoded.empty())
        throw failure{GLINT_E_OUTPUT, "OpenImageIO wrote nothing"};
    return encoded;
}

/* Removes empty texts: OpenImageIO 2.4 aborts on an empty one that it copies
 * into the IPTC block of a JPEG or TIFF. */
void clear_empty(ImageSpec &spec)
{
    auto &all = spec.extra_attribs;

    for (size_t i = all.size(); i-- > 0;)
        if (all[i].type() == TypeDesc::STRING && all[i].get_string().empty())
            all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
}

bytes encode_parts(const char *path, const std::vector<kept_part> &parts,
                   const struct glint_oiio_file *file, bool same,
                   const struct glint_oiio_options &options)
{
    const std::unique_ptr<ImageOutput> out = ImageOutput::create(path);
    const bool drop = options.drop_icc;
    std::vector<ImageSpec> specs;
    bytes encoded;

    if (!out)
        throw failure{GLINT_E_UNSUPPORTED, OIIO::geterror()};
    const std::string type = out->format_name();
    const int quality = quality_of(type, file, options);
    for (const kept_part &p : parts) {
        specs.push_back(same && is_carried_from(*file) ? bare(p.spec) : p.spec);
        if (type == "tiff")
            clear_exif(specs.back());
        if (type == "tiff" || type == "jpeg")
            clear_empty(specs.back());
        if (drop)
            specs.back().erase_attribute("ICCProfile");
        if (type == "jpeg")
            specs.back().attribute("Compression",
                                   "jpeg:" + std::to_string(quality));
        if (same && type == "jpeg" && glint::is_progressive(file->whole))
            specs.back().attribute("jpeg:progressive", 1);
    }
    if (type == "webp" && specs[0].nchannels >= 3)
        encoded =
            glint::webp_encode(parts[0].pixels.data(), specs[0].width,
                               specs[0].height, specs[0].nchannels, quality);
    else
        encoded = encode_by_oiio(*out, path, specs, parts);
    if (!same)
        return encoded;
    return type == "png"    ? glint::carry_png(encoded, file->whole, drop)
           : type == "jpeg" ? glint::carry_jpeg(encoded, file->whole, drop)
           : type == "webp" ? glint::carry_webp(encoded, file->whole, drop)
           : type == "tiff" ? glint::carry_tiff(encoded, file->whole, drop)
                            : encoded;
}

} // namespace

enum glint_status glint::encode_file(void **data, size_t *n_bytes,
                                     const char *path,
                                     struct glint_oiio_file *file,
                                     const struct glint_samples *pixels,
                                     const struct glint_oiio_options *options,
                                     struct glint_error *error)
{
    return guarded(path, GLINT_E_OUTPUT, error, [&] {
        const bool same = file && is_same_type(file, path);
        std::vector<kept_part> made;

        if (pixels)
            made.push_back(part_of(*pixels, file));
        const bytes encoded = encode_parts(path, pixels ? made : file->parts,
                                           file, same, *options);

        give(data, n_bytes, encoded);
    });
}
