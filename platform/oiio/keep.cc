/* SPDX-License-Identifier: MIT
 *
 * Reads whole files: each part's pixels in the types they are stored in, and
 * metadata. */
#include "oiio/keep.h"

#include <cctype>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include "oiio/guard.h"

using glint::bytes;
using glint::check_spec;
using glint::failure;
using glint::kept_part;
using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

bool glint::is_carried(const std::string &type)
{
    return type == "png" || type == "jpeg" || type == "webp" || type == "tiff";
}

bytes glint::read_whole(const char *path)
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

void glint::give(void **data, size_t *n_bytes, const bytes &encoded)
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
    return read_whole(name().c_str());
}

namespace
{

/* ----------------------------------------------------------------- reading */

bool to_sample(TypeDesc type, enum glint_sample &sample)
{
    switch (type.basetype) {
    case TypeDesc::UINT8:
        sample = GLINT_SAMPLE_U8;
        return true;
    case TypeDesc::UINT16:
        sample = GLINT_SAMPLE_U16;
        return true;
    case TypeDesc::UINT32:
        sample = GLINT_SAMPLE_U32;
        return true;
    case TypeDesc::HALF:
        sample = GLINT_SAMPLE_HALF;
        return true;
    case TypeDesc::FLOAT:
        sample = GLINT_SAMPLE_FLOAT;
        return true;
    case TypeDesc::DOUBLE:
        sample = GLINT_SAMPLE_DOUBLE;
        return true;
    default:
        return false;
    }
}

/* Has a part read as floats if glint has no arithmetic for one of its types. */
void choose_types(ImageSpec &spec)
{
    enum glint_sample sample;
    bool all = to_sample(spec.format, sample);

    for (const TypeDesc &type : spec.channelformats)
        all = all && to_sample(type, sample);
    if (!all)
        spec.set_format(TypeDesc::FLOAT);
}

void read_part(ImageInput &in, int index, const bytes &whole, kept_part &part)
{
    part.spec = in.spec(index);
    if (part.spec.width < 1 || part.spec.nchannels < 1)
        throw failure{GLINT_E_FORMAT, in.geterror()};
    check_spec(part.spec);
    choose_types(part.spec);
    if (in.format_name() == std::string("webp") && glint::webp_takes(whole)) {
        part.pixels = glint::webp_decode(whole, part.spec.nchannels);
        part.spec.attribute("oiio:UnassociatedAlpha", 1);
        return;
    }
    part.pixels.resize(part.spec.image_bytes(true));
    if (!in.read_image(index, 0, 0, part.spec.nchannels,
                       glint::is_mixed(part.spec) ? TypeDesc::UNKNOWN
                                                  : part.spec.format,
                       part.pixels.data()))
        throw failure{GLINT_E_FORMAT, in.geterror()};
}

void check_whole(const struct glint_oiio_file &file)
{
    std::string missing;

    if (file.type == "jpeg")
        missing = glint::missing_of_jpeg(file.whole);
    else if (file.type == "tiff")
        missing = glint::missing_of_tiff(file.whole);
    if (!missing.empty())
        throw failure{GLINT_E_FORMAT, missing};
}

void read_file(struct glint_oiio_file &file, const char *path)
{
    ImageSpec as_stored;

    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    const std::unique_ptr<ImageInput> in = ImageInput::open(path, &as_stored);
    if (!in)
        throw failure{GLINT_E_FORMAT, OIIO::geterror()};
    check_spec(in->spec());
    file.type = in->format_name();
    if (glint::is_carried(file.type))
        file.whole = glint::read_whole(path);
    check_whole(file);
    for (int i = 0; i < 64 && in->seek_subimage(i, 0); i++) {
        file.parts.emplace_back();
        read_part(*in, i, file.whole, file.parts.back());
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

/* The colour channels and alpha of a part, by name. */
struct choice {
    int index[4]; /* R, G, B, alpha; -1: none */
    int rank;     /* the higher the better, 1 .. 4; 0: nothing chosen */
};

int rank_of(const std::string &prefix)
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
        if (g >= 0 && b >= 0 && rank_of(prefix) > best.rank)
            best = {{i, g, b, find_channel(spec, prefix + "A")},
                    rank_of(prefix)};
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

struct glint_sample_place channel_of(const ImageSpec &spec, int index)
{
    struct glint_sample_place channel = {GLINT_SAMPLE_FLOAT, 0};

    to_sample(spec.channelformat(index), channel.sample);
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
        s.colour[c] = channel_of(spec, choice.index[c]);
    s.has_alpha = choice.index[3] >= 0;
    s.is_premultiplied = !spec.get_int_attribute("oiio:UnassociatedAlpha", 0);
    if (s.has_alpha)
        s.alpha = channel_of(spec, choice.index[3]);
    s.maximum = s.colour[0].sample == GLINT_SAMPLE_U8    ? 0xffu
                : s.colour[0].sample == GLINT_SAMPLE_U16 ? 0xffffu
                                                         : 0xffffffffu;
    s.mem = part.pixels.data();
}

/* ------------------------------------------------------------------- facts */

void fill_png_facts(struct glint_oiio_facts &facts, const bytes &whole)
{
    const bytes cicp = glint::chunk_of_png(whole, "cICP");
    const bytes gamma = glint::chunk_of_png(whole, "gAMA");
    const bytes srgb = glint::chunk_of_png(whole, "sRGB");
    const bytes primaries = glint::chunk_of_png(whole, "cHRM");
    const auto big32 = [](const bytes &b, size_t at) {
        return (unsigned(b[at]) << 24 | unsigned(b[at + 1]) << 16 |
                unsigned(b[at + 2]) << 8 | b[at + 3]) *
               1e-5;
    };

    if (cicp.size() == 4) {
        facts.cicp[0] = cicp[0];
        facts.cicp[1] = cicp[1];
    }
    facts.colour_space[0] = 0;
    if (!srgb.empty())
        return;
    if (gamma.size() == 4 && big32(gamma, 0) > 0)
        facts.gamma = 1 / big32(gamma, 0);
    if (primaries.size() != 32)
        return;
    facts.has_primaries = 1;
    for (size_t i = 0; i < 8; i++) /* cHRM has white first */
        facts.primaries[(i / 2 + 3) % 4][i % 2] = big32(primaries, 4 * i);
}

void say(struct glint_oiio_facts &facts, const char *text)
{
    const size_t used = std::strlen(facts.note);

    std::snprintf(facts.note + used, sizeof facts.note - used, "%s%s",
                  used ? "; " : "", text);
}

void fill_facts(struct glint_oiio_facts &facts, struct glint_oiio_file &file,
                const ImageSpec &spec)
{
    const OIIO::ParamValue *const icc = spec.find_attribute("ICCProfile");
    const OIIO::ParamValue *const xy = spec.find_attribute("chromaticities");

    facts = {};
    if (icc && icc->type().basetype == TypeDesc::UINT8) {
        const auto *const at = static_cast<const unsigned char *>(icc->data());

        file.icc.assign(at, at + icc->type().size());
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
    if (file.type == "png")
        fill_png_facts(facts, file.whole);
    if (file.type == "jpeg") {
        facts.quality = glint::quality_of_jpeg(file.whole);
        if (glint::has_more_pictures(file.whole))
            say(facts, "only the first of its pictures is kept");
        if (glint::is_of_inks(file.whole))
            say(facts, "its CMYK becomes RGB");
    }
    if (spec.get_int_attribute("oiio:Movie", 0) ||
        spec.get_int_attribute("gif:FrameCount", 0) > 1)
        say(facts, "only the first of its frames is kept");
}

} // namespace

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
        for (size_t i = 0; i < made->parts.size(); i++) {
            const choice here = choose_channels(made->parts[i].spec);

            if (here.rank > best.rank) {
                best = here;
                at = i;
            }
        }
        fill_samples(*samples, made->parts.at(at), best);
        fill_facts(*facts, *made, made->parts[at].spec);
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

        is_same = out && file->type == out->format_name();
    });
    return is_same;
}
