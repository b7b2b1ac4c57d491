/* SPDX-License-Identifier: MIT */
#include "oiio/icc.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "oiio/guard.h"

#if __has_include(<lcms2.h>) && __has_include(<jpeglib.h>)
#include <csetjmp>

#include <jpeglib.h>
#include <lcms2.h>

namespace glint
{

namespace
{

constexpr size_t max_profile_bytes = size_t(1) << 24;
constexpr size_t block_pixels =
    4096; /* number of pixels that encode() converts at a time */

using profile_ptr = std::unique_ptr<void, decltype(&cmsCloseProfile)>;
using transform_ptr = std::unique_ptr<void, decltype(&cmsDeleteTransform)>;

/* Returns whether profile P is for N_COLOURS colours and consists of tables,
 * not of curves and a matrix. Rejects tables of floats: their elements may
 * share bytes, so that a small profile could need unlimited memory. */
bool is_table_profile(cmsHPROFILE p, size_t n_colours)
{
    const cmsColorSpaceSignature space = cmsGetColorSpace(p);
    const cmsProfileClassSignature kind = cmsGetDeviceClass(p);

    for (cmsTagSignature tag :
         {cmsSigDToB0Tag, cmsSigDToB1Tag, cmsSigDToB2Tag, cmsSigDToB3Tag,
          cmsSigBToD0Tag, cmsSigBToD1Tag, cmsSigBToD2Tag, cmsSigBToD3Tag})
        if (cmsIsTag(p, tag))
            return false;
    return ((space == cmsSigGrayData && n_colours == 1) ||
            (space == cmsSigRgbData && n_colours == 3) ||
            (space == cmsSigCmykData && n_colours == 4)) &&
           (kind == cmsSigInputClass || kind == cmsSigDisplayClass ||
            kind == cmsSigOutputClass || kind == cmsSigColorSpaceClass) &&
           !cmsIsMatrixShaper(p);
}

profile_ptr make_wide_profile()
{
    const auto xy = [](int i) {
        return cmsCIExyY{wide_primaries[i][0], wide_primaries[i][1], 1};
    };
    const cmsCIExyY white = xy(3);
    const cmsCIExyYTRIPLE primaries = {xy(0), xy(1), xy(2)};
    cmsToneCurve *const curve = cmsBuildGamma(nullptr, wide_gamma);
    cmsToneCurve *const curves[] = {curve, curve, curve};
    profile_ptr made(cmsCreateRGBProfile(&white, &primaries, curves),
                     &cmsCloseProfile);

    cmsFreeToneCurve(curve);
    return made;
}

size_t get_pixel_bytes(const code_layout &layout)
{
    return (layout.n_colours + layout.has_alpha) * layout.sample_bytes;
}

/* Returns the transform from one profile to another. It evaluates the tables of
 * the profiles for each pixel. The default of lcms2 would be a precomputed grid
 * of colours, which is wrong by up to 20 codes of 8 bits for dark inks. */
transform_ptr create_icc_transform(const profile_ptr &from,
                                   const code_layout &of_from,
                                   const profile_ptr &to,
                                   const code_layout &of_to)
{
    const auto format = [](const code_layout &l) {
        return CHANNELS_SH(cmsUInt32Number(l.n_colours)) |
               EXTRA_SH(cmsUInt32Number(l.has_alpha)) |
               BYTES_SH(cmsUInt32Number(l.sample_bytes));
    };

    return {cmsCreateTransform(from.get(), format(of_from), to.get(),
                               format(of_to), INTENT_RELATIVE_COLORIMETRIC,
                               cmsFLAGS_BLACKPOINTCOMPENSATION |
                                   cmsFLAGS_NOOPTIMIZE | cmsFLAGS_COPY_ALPHA),
            &cmsDeleteTransform};
}

struct lcms_link : icc_link {
    transform_ptr forward{nullptr, &cmsDeleteTransform};
    transform_ptr backward{nullptr, &cmsDeleteTransform};

    bytes decode(const bytes &from) const override;
    void encode(const bytes &from, bytes &to) const override;
};

bytes lcms_link::decode(const bytes &from) const
{
    const size_t n = from.size() / get_pixel_bytes(codes);
    bytes made(n * get_pixel_bytes(rgb));

    for (size_t i = 0; i < n; i += block_pixels)
        cmsDoTransform(forward.get(), from.data() + i * get_pixel_bytes(codes),
                       made.data() + i * get_pixel_bytes(rgb),
                       cmsUInt32Number(std::min(block_pixels, n - i)));
    return made;
}

/* A block of pixels: their codes, and the RGB values to which the codes
 * decode. */
struct block {
    bytes codes;
    std::vector<uint16_t> rgb;
};

int compute_colour_distance(const uint16_t *a, const uint16_t *b)
{
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) +
           std::abs(a[2] - b[2]);
}

/* The profile's tables for encoding are not the exact inverse of its tables for
 * decoding. So the codes are decoded again, and a second attempt subtracts
 * their error. */
void lcms_link::encode(const bytes &from, bytes &to) const
{
    const size_t n = to.size() / get_pixel_bytes(codes);
    const size_t c_bytes = get_pixel_bytes(codes), step = 3 + rgb.has_alpha;
    std::vector<uint16_t> want(block_pixels * step), was = want;
    block first = {bytes(block_pixels * c_bytes), want}, second = first;

    for (size_t i = 0; i < n; i += block_pixels) {
        const size_t n_here = std::min(block_pixels, n - i);
        const auto here = cmsUInt32Number(n_here);
        const auto attempt = [&](block &b) {
            cmsDoTransform(backward.get(), b.rgb.data(), b.codes.data(), here);
            cmsDoTransform(forward.get(), b.codes.data(), b.rgb.data(), here);
        };

        std::memcpy(want.data(), from.data() + 2 * i * step, 2 * n_here * step);
        cmsDoTransform(forward.get(), to.data() + i * c_bytes, was.data(),
                       here);
        if (std::equal(was.begin(), was.begin() + long(n_here * step),
                       want.begin()))
            continue;
        first.rgb = second.rgb = want;
        attempt(first);
        for (size_t k = 0; k < n_here * step; k++)
            if (k % step < 3)
                second.rgb[k] = static_cast<uint16_t>(
                    std::clamp(2 * want[k] - first.rgb[k], 0, 0xffff));
        attempt(second);
        for (size_t k = 0; k < n_here; k++) {
            const uint16_t *const at = want.data() + k * step;
            const bool is_better =
                compute_colour_distance(second.rgb.data() + k * step, at) <
                compute_colour_distance(first.rgb.data() + k * step, at);

            if (!std::equal(at, at + step, was.data() + k * step))
                std::memcpy(to.data() + (i + k) * c_bytes,
                            (is_better ? second : first).codes.data() +
                                k * c_bytes,
                            c_bytes);
        }
    }
}

/* -------------------------------------------------------------------- JPEG */

struct jpeg_errors {
    jpeg_error_mgr base; /* first member, because libjpeg has a pointer to it */
    std::jmp_buf escape;
    char cause[JMSG_LENGTH_MAX];
};

void leave_libjpeg(j_common_ptr jpeg)
{
    auto *const errors = reinterpret_cast<jpeg_errors *>(jpeg->err);

    jpeg->err->format_message(jpeg, errors->cause);
    std::longjmp(errors->escape, 1);
}

/* Decodes the pixels of FILE to PIXELS; returns false on an error. Declares no
 * object with a destructor, as errors leave it by longjmp(). */
bool decode_cmyk_pixels(jpeg_decompress_struct *jpeg, jpeg_errors *errors,
                        const bytes *file, bytes *pixels)
{
    if (setjmp(errors->escape))
        return false;
    jpeg_create_decompress(jpeg);
    jpeg_mem_src(jpeg, file->data(), static_cast<unsigned long>(file->size()));
    jpeg_read_header(jpeg, TRUE);
    jpeg->out_color_space = JCS_CMYK;
    jpeg_start_decompress(jpeg);
    const size_t row = size_t(4) * jpeg->output_width;
    if (pixels->size() != row * jpeg->output_height)
        return false;
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW at = pixels->data() + row * jpeg->output_scanline;

        jpeg_read_scanlines(jpeg, &at, 1);
    }
    return true;
}

} // namespace

bytes decode_cmyk_jpeg(const bytes &file, int width, int height)
{
    jpeg_decompress_struct jpeg = {};
    jpeg_errors errors = {};
    bytes pixels(size_t(4) * size_t(width) * size_t(height));

    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = leave_libjpeg;
    const bool done = decode_cmyk_pixels(&jpeg, &errors, &file, &pixels);
    jpeg_destroy_decompress(&jpeg);
    if (!done)
        throw failure{GLINT_E_FORMAT, errors.cause};
    for (unsigned char &ink :
         pixels) /* In Adobe's JPEGs the code 255 stands for no ink. */
        ink = static_cast<unsigned char>(255 - ink);
    return pixels;
}

std::unique_ptr<icc_link>
open_icc_link(const bytes &profile, const code_layout &layout, bool may_encode)
{
    if (profile.empty() || profile.size() > max_profile_bytes)
        return nullptr;
    const profile_ptr file(
        cmsOpenProfileFromMem(profile.data(), cmsUInt32Number(profile.size())),
        &cmsCloseProfile);
    if (!file || !is_table_profile(file.get(), layout.n_colours))
        return nullptr;
    const profile_ptr wide = make_wide_profile();
    const profile_ptr srgb(cmsCreate_sRGBProfile(), &cmsCloseProfile);
    if (!wide || !srgb)
        throw std::bad_alloc();
    auto made = std::make_unique<lcms_link>();
    made->codes = layout;
    made->rgb = {3, layout.has_alpha, 2};
    if (may_encode)
        made->backward = create_icc_transform(wide, made->rgb, file, layout);
    made->can_encode = made->backward != nullptr;
    if (!made->can_encode)
        made->rgb.sample_bytes = layout.sample_bytes;
    made->forward = create_icc_transform(
        file, layout, made->can_encode ? wide : srgb, made->rgb);
    if (!made->forward)
        return nullptr;
    return made;
}

} // namespace glint

#else

std::unique_ptr<glint::icc_link> glint::open_icc_link(const bytes &,
                                                      const code_layout &, bool)
{
    return nullptr;
}

glint::bytes glint::decode_cmyk_jpeg(const bytes &, int, int)
{
    throw failure{GLINT_E_UNSUPPORTED,
                  "this plug-in was built without lcms2: install liblcms2-dev "
                  "and build it again"};
}

#endif
