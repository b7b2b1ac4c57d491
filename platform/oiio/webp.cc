/* SPDX-License-Identifier: MIT
 *
 * WebP by its own library: OpenImageIO 2.4 multiplies colours by alpha when it
 * reads one, and does not divide when it writes. */
#include "oiio/keep.h"

#include "oiio/guard.h"

#if __has_include(<webp/encode.h>)
#include <webp/decode.h>
#include <webp/encode.h>

bool glint::webp_takes(const bytes &file)
{
    WebPBitstreamFeatures is;

    return WebPGetFeatures(file.data(), file.size(), &is) == VP8_STATUS_OK &&
           !is.has_animation;
}

glint::bytes glint::webp_decode(const bytes &file, int channels)
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

glint::bytes glint::webp_encode(const unsigned char *pixels, int width,
                                int height, int channels, int quality)
{
    WebPConfig config;
    WebPPicture picture;
    WebPMemoryWriter writer;

    if (!WebPConfigPreset(&config, WEBP_PRESET_PHOTO,
                          static_cast<float>(quality ? quality : 100)) ||
        !WebPPictureInit(&picture))
        throw failure{GLINT_E_OUTPUT, "libwebp is of another version"};
    if (width > WEBP_MAX_DIMENSION || height > WEBP_MAX_DIMENSION)
        throw failure{GLINT_E_OUTPUT, "WebP has at most 16383 pixels a side"};
    if (!quality)
        WebPConfigLosslessPreset(&config, 6);
    config.exact = 1; /* keeps colours where alpha is 0 */
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
                      "libwebp gives up, error " + std::to_string(code)};
    return made;
}

#else

bool glint::webp_takes(const bytes &)
{
    return false;
}

glint::bytes glint::webp_decode(const bytes &, int)
{
    return {};
}

glint::bytes glint::webp_encode(const unsigned char *, int, int, int, int)
{
    throw failure{GLINT_E_UNSUPPORTED,
                  "this plug-in was built without libwebp-dev"};
}

#endif
