/* SPDX-License-Identifier: MIT */
#include "oiio/heif.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

#include "oiio/guard.h"

#if __has_include(<libheif/heif.h>)
#include <libheif/heif.h>
#define HAS_HEIF 1
#else
#define HAS_HEIF 0
#endif

namespace glint
{

namespace
{

/* Returns whether the first box of FILE lists BRAND. */
bool has_heif_brand(const bytes &file, const char *brand)
{
    const size_t end =
        file.size() < 16
            ? 0
            : std::min<size_t>(file.size(), size_t(file[2]) << 8 | file[3]);

    for (size_t at = 8; at + 4 <= end; at += 4)
        if (at != 12 && !std::memcmp(file.data() + at, brand, 4))
            return true;
    return false;
}

} // namespace

bool is_heif(const bytes &file)
{
    if (file.size() < 16 || std::memcmp(file.data() + 4, "ftyp", 4))
        return false;
    for (const char *brand :
         {"heic", "heix", "mif1", "msf1", "hevc", "hevx", "avif", "avis"})
        if (!std::memcmp(file.data() + 8, brand, 4))
            return true;
    return false;
}

bool is_avif(const bytes &file)
{
    return has_heif_brand(file, "avif") || has_heif_brand(file, "avis");
}

int get_heif_bits(const heif_picture &picture)
{
    /* Pictures of 10 bits as 4:2:0 and 4:4:4 would make libaom abort, because
     * of a bug in libheif 1.15. */
    return picture.bits <= 8                       ? 8
           : picture.is_avif || picture.bits == 12 ? 12
                                                   : 10;
}

#if HAS_HEIF

namespace
{

using context = std::unique_ptr<heif_context, decltype(&heif_context_free)>;
using handle =
    std::unique_ptr<heif_image_handle, decltype(&heif_image_handle_release)>;
using image = std::unique_ptr<heif_image, decltype(&heif_image_release)>;
using nclx = std::unique_ptr<heif_color_profile_nclx,
                             decltype(&heif_nclx_color_profile_free)>;

void throw_on_heif_error(const struct heif_error &e, enum glint_status status)
{
    if (e.code != heif_error_Ok)
        throw failure{e.code == heif_error_Memory_allocation_error
                          ? GLINT_E_MEMORY
                          : status,
                      std::string("libheif: ") + e.message};
}

context create_heif_context()
{
    context made(heif_context_alloc(), heif_context_free);

    if (!made)
        throw std::bad_alloc();
    return made;
}

/* ----------------------------------------------------------------- reading */

void read_heif_metadata_blocks(const heif_image_handle *from, file_blocks &to)
{
    heif_item_id ids[16];
    const int n = heif_image_handle_get_list_of_metadata_block_IDs(
        from, nullptr, ids, 16);

    for (int i = 0; i < n; i++) {
        const std::string type =
            heif_image_handle_get_metadata_type(from, ids[i]);
        const std::string content =
            heif_image_handle_get_metadata_content_type(from, ids[i]);
        bytes data(heif_image_handle_get_metadata_size(from, ids[i]));

        if (data.empty() ||
            heif_image_handle_get_metadata(from, ids[i], data.data()).code)
            continue;
        /* The Exif block begins with the offset of its TIFF header. */
        const size_t skip = data.size() < 4
                                ? data.size()
                                : 4 + (size_t(data[0]) << 24 | data[1] << 16 |
                                       data[2] << 8 | data[3]);
        if (type == "Exif" && skip < data.size() && to.exif.empty())
            to.exif.assign(data.begin() + static_cast<std::ptrdiff_t>(skip),
                           data.end());
        else if (content == "application/rdf+xml" && to.xmp.empty())
            to.xmp.assign(data.begin(), data.end());
    }
}

void read_heif_colours(const heif_image_handle *from, file_blocks &to)
{
    heif_color_profile_nclx *read = nullptr;

    to.icc.resize(heif_image_handle_get_raw_color_profile_size(from));
    if (!to.icc.empty() &&
        heif_image_handle_get_raw_color_profile(from, to.icc.data()).code)
        to.icc.clear();
    if (heif_image_handle_get_nclx_color_profile(from, &read).code || !read)
        return;
    const nclx held(read, heif_nclx_color_profile_free);
    if (read->transfer_characteristics == 2) /* 2: unspecified */
        return;
    to.cicp[0] = static_cast<unsigned char>(read->color_primaries);
    to.cicp[1] = static_cast<unsigned char>(read->transfer_characteristics);
    to.cicp[2] = static_cast<unsigned char>(read->matrix_coefficients);
    to.cicp[3] = 1;
}

void append_lost_text(std::string &lost, const char *text)
{
    lost += std::string(lost.empty() ? "" : "; ") + text;
}

/* Returns a text that lists the pictures of FILE besides the main one. */
std::string describe_lost_pictures(const bytes &file, heif_context *all,
                                   const heif_image_handle *from)
{
    const int aux = LIBHEIF_AUX_IMAGE_FILTER_OMIT_ALPHA |
                    LIBHEIF_AUX_IMAGE_FILTER_OMIT_DEPTH;
    heif_item_id ids[16];
    const int n =
        heif_image_handle_get_list_of_auxiliary_image_IDs(from, aux, ids, 16);
    bool map = has_heif_brand(file, "tmap"), others = false;
    std::string lost;

    for (int i = 0; i < n; i++) {
        heif_image_handle *other = nullptr;
        const char *type = nullptr;

        if (heif_image_handle_get_auxiliary_image_handle(from, ids[i], &other)
                .code)
            continue;
        const handle held(other, heif_image_handle_release);
        if (heif_image_handle_get_auxiliary_type(other, &type).code || !type)
            continue;
        const bool is_map = std::strstr(type, "hdrgainmap") != nullptr;
        map = map || is_map;
        others = others || !is_map;
        heif_image_handle_free_auxiliary_types(other, &type);
    }
    if (map)
        append_lost_text(lost, "its gain map is dropped");
    if (heif_image_handle_has_depth_image(from))
        append_lost_text(lost, "its depth map is dropped");
    if (others)
        append_lost_text(lost, "its auxiliary pictures are dropped");
    if (has_heif_brand(file, "avis") || has_heif_brand(file, "msf1"))
        append_lost_text(lost, "only its first frame is written");
    else if (heif_context_get_number_of_top_level_images(all) > 1)
        append_lost_text(lost, "only its main picture is written");
    return lost;
}

/* Copies the pixels of FROM to TO: 16 bits with white 65535 if the picture has
 * more than 8 bits, else 8 bits. */
void copy_heif_pixels(const heif_image *from, heif_picture &to)
{
    int stride = 0;
    const uint8_t *const mem =
        heif_image_get_plane_readonly(from, heif_channel_interleaved, &stride);
    const size_t n = static_cast<size_t>(to.width) * size_t(to.channels);
    const size_t row = n * (to.bits > 8 ? 2 : 1);

    if (!mem ||
        heif_image_get_width(from, heif_channel_interleaved) != to.width ||
        heif_image_get_height(from, heif_channel_interleaved) != to.height)
        throw failure{GLINT_E_FORMAT, "has no pixels"};
    const int bits =
        heif_image_get_bits_per_pixel_range(from, heif_channel_interleaved);
    const uint32_t white = (1u << std::clamp(bits, 1, 16)) - 1;

    to.pixels.resize(row * size_t(to.height));
    for (int y = 0; y < to.height; y++) {
        const uint8_t *const at = mem + size_t(y) * size_t(stride);
        unsigned char *const out = to.pixels.data() + size_t(y) * row;

        std::memcpy(out, at, row);
        for (size_t i = 0; i < n && to.bits > 8; i++) {
            const uint32_t read = uint32_t(at[2 * i] | at[2 * i + 1] << 8);
            const auto code = static_cast<uint16_t>(
                (std::min(read, white) * 65535u + white / 2) / white);

            std::memcpy(out + 2 * i, &code, 2);
        }
    }
}

} // namespace

bool is_heif_readable()
{
    return true;
}

bool is_heif_writable(bool avif)
{
    return heif_have_encoder_for_format(avif ? heif_compression_AV1
                                             : heif_compression_HEVC);
}

heif_picture decode_heif(const bytes &file)
{
    const context all = create_heif_context();
    heif_picture made = {};
    heif_image_handle *main = nullptr;
    heif_image *decoded = nullptr;

    throw_on_heif_error(heif_context_read_from_memory_without_copy(
                            all.get(), file.data(), file.size(), nullptr),
                        GLINT_E_FORMAT);
    throw_on_heif_error(heif_context_get_primary_image_handle(all.get(), &main),
                        GLINT_E_FORMAT);
    const handle held(main, heif_image_handle_release);
    made.width = heif_image_handle_get_width(main);
    made.height = heif_image_handle_get_height(main);
    made.channels = heif_image_handle_has_alpha_channel(main) ? 4 : 3;
    made.bits = heif_image_handle_get_luma_bits_per_pixel(main);
    made.is_avif = is_avif(file);
    made.is_premultiplied = heif_image_handle_is_premultiplied_alpha(main);
    reject_unsupported_spec(
        OIIO::ImageSpec(made.width, made.height, made.channels));
    throw_on_heif_error(
        heif_decode_image(main, &decoded, heif_colorspace_RGB,
                          made.channels == 4
                              ? made.bits > 8
                                    ? heif_chroma_interleaved_RRGGBBAA_LE
                                    : heif_chroma_interleaved_RGBA
                          : made.bits > 8 ? heif_chroma_interleaved_RRGGBB_LE
                                          : heif_chroma_interleaved_RGB,
                          nullptr),
        GLINT_E_FORMAT);
    const image pixels(decoded, heif_image_release);
    copy_heif_pixels(decoded, made);
    read_heif_metadata_blocks(main, made.meta);
    read_heif_colours(main, made.meta);
    made.lost = describe_lost_pictures(file, all.get(), main);
    return made;
}

/* ----------------------------------------------------------------- writing */

namespace
{

/* Weights of red and blue in luma for a MATRIX of ITU-T H.273. */
struct weights {
    double red, blue;
};

weights get_luma_weights(int matrix)
{
    return matrix == 1   ? weights{0.2126, 0.0722}
           : matrix == 9 ? weights{0.2627, 0.0593}
                         : weights{0.299, 0.114};
}

/* Returns the code of the matrix for writing P: P's own matrix if glint
 * supports it, else the one that fits P's primaries. A file with an ICC profile
 * states no matrix, so decoders assume code 6. */
int choose_heif_matrix(const heif_picture &p)
{
    const int own = p.meta.cicp[2];

    if (!p.meta.icc.empty() || !p.meta.cicp[1])
        return 6;
    return own == 1 || own == 9 ? own : p.meta.cicp[0] == 9 ? 9 : 6;
}

/* The samples of a picture as Y, Cb, Cr and alpha, 0 .. 1; neutral chroma is
 * 0.5. */
struct planes {
    const heif_picture &p;
    weights w;

    double sample(int x, int y, int c) const
    {
        const size_t i =
            (static_cast<size_t>(y) * size_t(p.width) + size_t(x)) *
                size_t(p.channels) +
            size_t(c);
        uint16_t code;

        if (p.bits <= 8)
            return p.pixels[i] / 255.0;
        std::memcpy(&code, p.pixels.data() + 2 * i, 2);
        return code / 65535.0;
    }
    double value(int x, int y, heif_channel channel) const
    {
        if (channel == heif_channel_Alpha)
            return sample(x, y, 3);
        const double r = sample(x, y, 0), g = sample(x, y, 1);
        const double b = sample(x, y, 2);
        const double luma = w.red * r + (1 - w.red - w.blue) * g + w.blue * b;

        return channel == heif_channel_Y ? luma
               : channel == heif_channel_Cb
                   ? 0.5 + (b - luma) / (2 * (1 - w.blue))
                   : 0.5 + (r - luma) / (2 * (1 - w.red));
    }
    /* Returns the mean of CHANNEL over the STEP x STEP pixels at (X, Y) times
     * STEP. */
    double mean(int x, int y, int step, heif_channel channel) const
    {
        double sum = 0;

        for (int i = 0; i < step * step; i++)
            sum += value(std::min(x * step + i % step, p.width - 1),
                         std::min(y * step + i / step, p.height - 1), channel);
        return sum / (step * step);
    }
};

/* Adds CHANNEL of FROM to the image TO, one sample per STEP x STEP pixels. */
void add_image_plane(heif_image *to, const planes &from, heif_channel channel,
                     int step)
{
    const int width = (from.p.width + step - 1) / step;
    const int height = (from.p.height + step - 1) / step;
    const int bits = get_heif_bits(from.p);
    const int white = (1 << bits) - 1;
    int stride = 0;

    throw_on_heif_error(heif_image_add_plane(to, channel, width, height, bits),
                        GLINT_E_OUTPUT);
    uint8_t *const mem = heif_image_get_plane(to, channel, &stride);
    if (!mem)
        throw std::bad_alloc();
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint8_t *const at = mem + size_t(y) * size_t(stride);
            /* The neutral value of Cb and Cr is half the number of codes, not
             * half the code of white. */
            const double v =
                from.mean(x, y, step, channel) * white +
                (channel == heif_channel_Cb || channel == heif_channel_Cr ? 0.5
                                                                          : 0);
            const uint16_t code = static_cast<uint16_t>(
                std::clamp(static_cast<int>(v + 0.5), 0, white));

            if (bits > 8)
                std::memcpy(at + 2 * x, &code, 2);
            else
                at[x] = static_cast<uint8_t>(code);
        }
}

image build_heif_image(const heif_picture &p, heif_chroma chroma)
{
    const planes from = {p, get_luma_weights(choose_heif_matrix(p))};
    const int step = chroma == heif_chroma_420 ? 2 : 1;
    heif_image *made = nullptr;

    throw_on_heif_error(heif_image_create(p.width, p.height,
                                          heif_colorspace_YCbCr, chroma, &made),
                        GLINT_E_OUTPUT);
    image held(made, heif_image_release);
    add_image_plane(made, from, heif_channel_Y, 1);
    add_image_plane(made, from, heif_channel_Cb, step);
    add_image_plane(made, from, heif_channel_Cr, step);
    if (p.channels == 4) {
        add_image_plane(made, from, heif_channel_Alpha, 1);
        heif_image_set_premultiplied_alpha(made, p.is_premultiplied);
    }
    return held;
}

void set_heif_colours(heif_image *to, const heif_picture &p,
                      heif_color_profile_nclx &n)
{
    const bool has = p.meta.cicp[1] != 0;

    if (!p.meta.icc.empty())
        throw_on_heif_error(heif_image_set_raw_color_profile(to, "prof",
                                                             p.meta.icc.data(),
                                                             p.meta.icc.size()),
                            GLINT_E_OUTPUT);
    heif_nclx_color_profile_set_color_primaries(&n, has ? p.meta.cicp[0] : 1);
    heif_nclx_color_profile_set_transfer_characteristics(
        &n, has ? p.meta.cicp[1] : 13);
    heif_nclx_color_profile_set_matrix_coefficients(
        &n, static_cast<uint16_t>(choose_heif_matrix(p)));
    n.full_range_flag = 1;
    throw_on_heif_error(heif_image_set_nclx_color_profile(to, &n),
                        GLINT_E_OUTPUT);
}

void add_metadata_blocks(heif_context *to, const heif_image_handle *main,
                         const file_blocks &b)
{
    if (!b.exif.empty())
        throw_on_heif_error(
            heif_context_add_exif_metadata(to, main, b.exif.data(),
                                           static_cast<int>(b.exif.size())),
            GLINT_E_OUTPUT);
    if (!b.xmp.empty())
        throw_on_heif_error(
            heif_context_add_XMP_metadata(to, main, b.xmp.data(),
                                          static_cast<int>(b.xmp.size())),
            GLINT_E_OUTPUT);
}

struct heif_error append_encoded_bytes(heif_context *, const void *data,
                                       size_t n, void *to)
{
    const auto *const at = static_cast<const unsigned char *>(data);

    static_cast<bytes *>(to)->insert(static_cast<bytes *>(to)->end(), at,
                                     at + n);
    return {heif_error_Ok, heif_suberror_Unspecified, ""};
}

} // namespace

bytes encode_heif_picture(const heif_picture &picture, int quality)
{
    /* Phones decode HEIC only with chroma of 4:2:0. */
    const heif_chroma chroma =
        picture.is_avif ? heif_chroma_444 : heif_chroma_420;
    const context all = create_heif_context();
    const nclx codes(heif_nclx_color_profile_alloc(),
                     heif_nclx_color_profile_free);
    heif_encoder *coder = nullptr;
    heif_image_handle *main = nullptr;
    heif_writer writer = {1, append_encoded_bytes};
    bytes file;

    throw_on_heif_error(
        heif_context_get_encoder_for_format(
            all.get(),
            picture.is_avif ? heif_compression_AV1 : heif_compression_HEVC,
            &coder),
        GLINT_E_UNSUPPORTED);
    const std::unique_ptr<heif_encoder, decltype(&heif_encoder_release)> held(
        coder, heif_encoder_release);
    if (!codes)
        throw std::bad_alloc();
    heif_encoder_set_lossy_quality(coder, quality);
    heif_encoder_set_parameter_string(coder, "chroma",
                                      picture.is_avif ? "444" : "420");
    const image pixels = build_heif_image(picture, chroma);
    set_heif_colours(pixels.get(), picture, *codes);
    throw_on_heif_error(heif_context_encode_image(all.get(), pixels.get(),
                                                  coder, nullptr, &main),
                        GLINT_E_OUTPUT);
    const handle kept(main, heif_image_handle_release);
    add_metadata_blocks(all.get(), main, picture.meta);
    throw_on_heif_error(heif_context_write(all.get(), &writer, &file),
                        GLINT_E_OUTPUT);
    return file;
}

#else

bool is_heif_readable()
{
    return false;
}

bool is_heif_writable(bool)
{
    return false;
}

heif_picture decode_heif(const bytes &)
{
    throw failure{GLINT_E_UNSUPPORTED,
                  "this plug-in was built without libheif: install libheif-dev "
                  "and build it again"};
}

bytes encode_heif_picture(const heif_picture &, int)
{
    throw failure{GLINT_E_UNSUPPORTED,
                  "this plug-in was built without libheif: install libheif-dev "
                  "and build it again"};
}

#endif

} // namespace glint
