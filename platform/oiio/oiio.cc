/* SPDX-License-Identifier: MIT
 *
 * Implements formats/oiio.h. No exception leaves the plug-in: every error that
 * OpenImageIO throws or returns becomes a status and one line of text. */
#include "formats/oiio.h"

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

using glint::failure;
using glint::guarded;
using glint::open_picture;
using glint::reject_unsupported_spec;

/* Returns the indices of the channels to read as R, G, B: the first three
 * channels, or three times the first channel if there are fewer. */
std::vector<int> choose_rgb_channels(int n_channels)
{
    if (n_channels >= 3)
        return {0, 1, 2};
    return {0, 0, 0};
}

/* Reads PATH as bytes or floats and rotates it upright. The ImageBuf is not
 * opened by file name, because it would then come from a cache even if the file
 * has changed. */
OIIO::ImageBuf load_upright_image(const char *path)
{
    const std::unique_ptr<OIIO::ImageInput> in = open_picture(path);
    OIIO::ImageSpec spec = in->spec();

    reject_unsupported_spec(spec);
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

void read_upright_pixels(struct glint_oiio_pixels *pixels, const char *path)
{
    const OIIO::ImageBuf buf = load_upright_image(path);
    const OIIO::TypeDesc type = buf.spec().format;
    const OIIO::ImageBuf rgb = OIIO::ImageBufAlgo::channels(
        buf, 3, choose_rgb_channels(buf.nchannels()));

    if (rgb.has_error())
        throw failure{GLINT_E_FORMAT, rgb.geterror()};
    /* Pixels for which the file has no data are black. */
    OIIO::ROI roi = rgb.roi_full();
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

/* Encodes PIXELS to memory instead of a file, because some writers of
 * OpenImageIO do not report a full disk. */
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
    /* A TIFF gets no colour space: OpenImageIO 2.4 would write an Exif
     * directory for it, which is corrupt for files in memory. */
    if (std::strcmp(out->format_name(), "tiff") != 0)
        spec.attribute("oiio:ColorSpace", pixels->is_float ? "Linear" : "sRGB");
    if (!out->open(path, spec) ||
        !out->write_image(type, pixels->rgb, OIIO::AutoStride, stride_bytes) ||
        !out->close())
        throw failure{GLINT_E_OUTPUT, out->geterror()};
    return encoded;
}

OIIO::ImageSpec describe_layer(const struct glint_oiio_layers *layers, int k)
{
    OIIO::ImageSpec spec(layers->width, layers->height, 3,
                         layers->is_half ? OIIO::TypeDesc::HALF
                                         : OIIO::TypeDesc::FLOAT);

    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("oiio:subimagename", layers->layer[k].name);
    spec.attribute("name", layers->layer[k].name);
    spec.attribute("compression", "zip");
    return spec;
}

/* Encodes LAYERS, one part per layer. Uses a file in memory that has a file
 * name, because OpenImageIO 2.4 can write files of several parts only by
 * name. */
std::vector<unsigned char> encode_parts(const char *path,
                                        const struct glint_oiio_layers *layers)
{
    const std::unique_ptr<OIIO::ImageOutput> out =
        OIIO::ImageOutput::create(path);
    const glint::memory_file file;
    std::vector<OIIO::ImageSpec> specs;

    if (!out)
        throw failure{GLINT_E_UNSUPPORTED, OIIO::geterror()};
    if (layers->n > 1 && !out->supports("multiimage"))
        throw failure{GLINT_E_UNSUPPORTED,
                      "this type cannot hold layers; name an .exr, or put %s "
                      "into the name for a file per layer"};
    for (int k = 0; k < layers->n; k++)
        specs.push_back(describe_layer(layers, k));
    if (!(layers->n > 1 ? out->open(file.name(), layers->n, specs.data())
                        : out->open(file.name(), specs[0])))
        throw failure{GLINT_E_OUTPUT, out->geterror()};
    for (int k = 0; k < layers->n; k++)
        if ((k > 0 && !out->open(file.name(), specs[static_cast<size_t>(k)],
                                 OIIO::ImageOutput::AppendSubimage)) ||
            !out->write_image(OIIO::TypeDesc::FLOAT, layers->layer[k].rgb))
            throw failure{GLINT_E_OUTPUT, out->geterror()};
    if (!out->close())
        throw failure{GLINT_E_OUTPUT, out->geterror()};
    return file.contents();
}

enum glint_status encode_layers_guarded(void **data, size_t *bytes,
                                        const char *path,
                                        const struct glint_oiio_layers *layers,
                                        struct glint_error *error)
{
    return guarded(path, GLINT_E_OUTPUT, error, [&] {
        glint::copy_to_malloc(data, bytes, encode_parts(path, layers));
    });
}

enum glint_status read_pixels_guarded(struct glint_oiio_pixels *pixels,
                                      const char *path,
                                      struct glint_error *error)
{
    return guarded(path, GLINT_E_FORMAT, error,
                   [&] { read_upright_pixels(pixels, path); });
}

enum glint_status encode_pixels_guarded(void **data, size_t *bytes,
                                        const char *path,
                                        const struct glint_oiio_pixels *pixels,
                                        ptrdiff_t stride_bytes,
                                        struct glint_error *error)
{
    return guarded(path, GLINT_E_OUTPUT, error, [&] {
        glint::copy_to_malloc(data, bytes,
                              encode_pixels(path, pixels, stride_bytes));
    });
}

} // namespace

extern "C" __attribute__((visibility("default")))
const struct glint_oiio glint_oiio_face;
const struct glint_oiio glint_oiio_face = {
    GLINT_OIIO_VERSION,  read_pixels_guarded, encode_pixels_guarded,
    glint::open_file,    glint::close_file,   glint::can_write,
    glint::is_same_type, glint::encode_file,  encode_layers_guarded,
    glint::report_abort};
