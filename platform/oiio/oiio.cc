/* SPDX-License-Identifier: MIT
 *
 * The plug-in behind oiio/oiio.h. No exception leaves it: all that OpenImageIO
 * throws or returns becomes a status and one line of text. */
#include "oiio/oiio.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include "glint/image.h"
#include "oiio/guard.h"
#include "oiio/keep.h"

namespace
{

using glint::check_spec;
using glint::failure;
using glint::guarded;

/* Returns the channels for R, G, B: the first three, or the first for all. */
std::vector<int> channel_order(int n_channels)
{
    if (n_channels >= 3)
        return {0, 1, 2};
    return {0, 0, 0};
}

/* Reads PATH as bytes or floats and turns it upright. An ImageBuf opened by
 * file name would answer from a cache after the file has changed. */
OIIO::ImageBuf load_upright(const char *path)
{
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(path);

    if (!in)
        throw failure{GLINT_E_FORMAT, OIIO::geterror()};
    OIIO::ImageSpec spec = in->spec();
    check_spec(spec);
    spec.set_format(spec.format.is_floating_point() ? OIIO::TypeDesc::FLOAT
                                                    : OIIO::TypeDesc::UINT8);
    OIIO::ImageBuf buf(spec);
    if (!in->read_image(0, 0, 0, spec.nchannels, spec.format,
                        buf.localpixels()))
        throw failure{GLINT_E_FORMAT, in->geterror()};
    if (buf.orientation() == 1)
        return buf;
    OIIO::ImageBuf upright = OIIO::ImageBufAlgo::reorient(buf);
    if (upright.has_error())
        throw failure{GLINT_E_FORMAT, upright.geterror()};
    return upright;
}

void read_pixels(struct glint_oiio_pixels *pixels, const char *path)
{
    const OIIO::ImageBuf buf = load_upright(path);
    const OIIO::TypeDesc type = buf.spec().format;
    const OIIO::ImageBuf rgb =
        OIIO::ImageBufAlgo::channels(buf, 3, channel_order(buf.nchannels()));

    if (rgb.has_error())
        throw failure{GLINT_E_FORMAT, rgb.geterror()};
    OIIO::ROI roi = rgb.roi_full(); /* black where the file has no data */
    roi.chbegin = 0;
    roi.chend = 3;
    struct glint_oiio_pixels made = {roi.width(), roi.height(),
                                     type.is_floating_point(), nullptr};
    made.rgb = std::malloc(roi.npixels() * 3 * type.size());
    if (!made.rgb)
        throw std::bad_alloc();
    if (!rgb.get_pixels(roi, type, made.rgb)) {
        std::free(made.rgb);
        throw failure{GLINT_E_FORMAT, rgb.geterror()};
    }
    *pixels = made;
}

/* Encodes PIXELS into memory, as some writers of OpenImageIO do not notice a
 * full disk. */
std::vector<unsigned char> encode_pixels(const char *path,
                                         const struct glint_oiio_pixels *pixels,
                                         ptrdiff_t stride_bytes)
{
    const OIIO::TypeDesc type =
        pixels->is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
    const std::unique_ptr<OIIO::ImageOutput> out =
        OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(pixels->width, pixels->height, 3, type);
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput file(encoded);

    if (!out)
        throw failure{GLINT_E_UNSUPPORTED, OIIO::geterror()};
    if (!out->supports("ioproxy") || !out->set_ioproxy(&file))
        throw failure{GLINT_E_UNSUPPORTED, "OpenImageIO cannot write this "
                                           "type into memory"};
    /* A TIFF with a colour space would get an Exif directory, whose writing
     * into memory OpenImageIO 2.4 spoils. */
    if (std::strcmp(out->format_name(), "tiff") != 0)
        spec.attribute("oiio:ColorSpace", pixels->is_float ? "Linear" : "sRGB");
    if (!out->open(path, spec) ||
        !out->write_image(type, pixels->rgb, OIIO::AutoStride, stride_bytes) ||
        !out->close())
        throw failure{GLINT_E_OUTPUT, out->geterror()};
    return encoded;
}

enum glint_status face_read(struct glint_oiio_pixels *pixels, const char *path,
                            struct glint_error *error)
{
    return guarded(path, error, [&] { read_pixels(pixels, path); });
}

enum glint_status face_encode(void **data, size_t *bytes, const char *path,
                              const struct glint_oiio_pixels *pixels,
                              ptrdiff_t stride_bytes, struct glint_error *error)
{
    return guarded(path, error, [&] {
        const std::vector<unsigned char> encoded =
            encode_pixels(path, pixels, stride_bytes);
        void *const block = std::malloc(encoded.size() + 1);

        if (!block)
            throw std::bad_alloc();
        std::memcpy(block, encoded.data(), encoded.size());
        *data = block;
        *bytes = encoded.size();
    });
}

} // namespace

extern "C" __attribute__((visibility("default")))
const struct glint_oiio glint_oiio_face;
const struct glint_oiio glint_oiio_face = {
    GLINT_OIIO_VERSION, face_read,         face_encode,
    glint::open_file,   glint::close_file, glint::is_same_type,
    glint::encode_file};
