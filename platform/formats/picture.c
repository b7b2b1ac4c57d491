/* SPDX-License-Identifier: MIT */
#include "formats/picture.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/oiio.h"
#include "posix/ending.h"
#include "posix/error.h"

/* Returns where the sub-blocks that begin at AT end, or the end of the data. */
static size_t skip_blocks(const uint8_t *d, size_t n, size_t at)
{
    while (at < n && d[at] != 0)
        at += (size_t)d[at] + 1;
    return at < n ? at + 1 : n;
}

static size_t colours(uint8_t packed)
{
    return packed & 0x80 ? (size_t)3 << ((packed & 7) + 1) : 0;
}

static int count_frames(const uint8_t *d, size_t n)
{
    int frames = 0;
    size_t at;

    if (n < 13 || memcmp(d, "GIF8", 4) != 0)
        return 0;
    at = 13 + colours(d[10]);
    while (at < n && d[at] != 0x3b) {
        if (d[at] == 0x21 && at + 2 < n) {
            at = skip_blocks(d, n, at + 2);
        } else if (d[at] == 0x2c && at + 11 < n) {
            frames++;
            at = skip_blocks(d, n, at + 11 + colours(d[at + 9]));
        } else
            break;
    }
    return frames;
}

int glint_gif_frames(const char *name)
{
    struct glint_error error;
    uint8_t *data = NULL;
    size_t bytes = 0;
    int n = 0;

    if (!glint_ends_in(name, ".gif"))
        return 0;
    if (glint_input_slurp(&data, &bytes, name, 1 << 28, &error) == GLINT_OK)
        n = count_frames(data, bytes);
    free(data);
    return n;
}

/* Bytes of the largest file read: a PFM with its header. PNM files are
 * smaller. */
#define MAX_FILE_BYTES                                             \
    (SIZE_MAX / 4 < UINT64_C(12) * GLINT_MAX_SIDE * GLINT_MAX_SIDE \
         ? SIZE_MAX / 4                                            \
         : (size_t)(UINT64_C(12) * GLINT_MAX_SIDE * GLINT_MAX_SIDE + 4096))
#define HEAD_BYTES 12 /* first bytes, which tell file types apart */

/* ----------------------------------------------------------------- loading */

/* A picture that was loaded, of 8 bits or of floats; the other member is
 * zeros. */
struct loaded {
    struct glint_image image; /* GLINT_RGB24 or GLINT_GREY */
    struct glint_float_image floats;
};

static const struct magic {
    const char *bytes;
    size_t n;
    const char *type;
} magics[] = {
    {"\x89PNG", 4, "PNG"},
    {"\xff\xd8\xff", 3, "JPEG"},
    {"\x76\x2f\x31\x01", 4, "EXR"},
    {"#?", 2, "Radiance HDR"},
    {"II*", 3, "TIFF"},
    {"MM", 2, "TIFF"},
    {"BM", 2, "BMP"},
    {"GIF8", 4, "GIF"},
    {"RIFF", 4, "WebP"},
};

const char *glint_picture_type(const uint8_t *head, size_t bytes)
{
    for (size_t i = 0; i < sizeof magics / sizeof *magics; i++)
        if (bytes >= magics[i].n && !memcmp(head, magics[i].bytes, magics[i].n))
            return magics[i].type;
    return "any file but PPM, PGM and PFM";
}

enum glint_status glint_picture_needs_plugin(const char *path, const char *type,
                                             struct glint_error *error)
{
    const struct glint_error cause = *error;

    return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                              "%s needs glint's image plug-in: %s", type,
                              cause.text);
}

static enum glint_status load_by_plugin(struct loaded *loaded, const char *path,
                                        const char *type,
                                        struct glint_error *error)
{
    const struct glint_oiio *oiio;
    struct glint_oiio_pixels pixels;
    enum glint_status status = glint_oiio_load(&oiio, error);

    if (status)
        return glint_picture_needs_plugin(path, type, error);
    status = oiio->read(&pixels, path, error);
    if (status)
        return status;
    if (pixels.is_float) {
        loaded->floats =
            (struct glint_float_image){pixels.width, pixels.height, pixels.rgb};
        return GLINT_OK;
    }
    loaded->image = (struct glint_image){.format = GLINT_RGB24,
                                         .width = pixels.width,
                                         .height = pixels.height,
                                         .range = GLINT_RANGE_FULL,
                                         .transfer = GLINT_TONE_SRGB};
    glint_image_place(&loaded->image, pixels.rgb);
    return GLINT_OK;
}

enum glint_status glint_picture_read(struct glint_input *in, const char *name,
                                     uint8_t **data, size_t *bytes,
                                     struct glint_error *error)
{
    ptrdiff_t n = 1;

    *bytes = 0;
    *data = malloc(HEAD_BYTES);
    if (!*data)
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "no memory for a buffer");
    while (n > 0 && *bytes < HEAD_BYTES) {
        n = glint_input_some(in, *data + *bytes, HEAD_BYTES - *bytes);
        *bytes += n > 0 ? (size_t)n : 0;
    }
    if (n < 0)
        return glint_error_report(error, GLINT_E_IO, name, "%s",
                                  strerror(errno));
    if (*bytes == 0)
        return glint_error_report(error, GLINT_E_FORMAT, name, "is empty");
    if (*bytes >= 9 && !memcmp(*data, "YUV4MPEG2", 9))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "is a video, not a picture");
    return glint_pnm_matches(*data, *bytes) || glint_pfm_matches(*data, *bytes)
               ? glint_input_append(in, data, bytes, MAX_FILE_BYTES, error)
               : GLINT_OK;
}

static enum glint_status load_opened(struct loaded *loaded,
                                     struct glint_input *in, uint8_t **data,
                                     struct glint_error *error)
{
    size_t bytes;
    enum glint_status status =
        glint_picture_read(in, in->name, data, &bytes, error);

    if (status)
        return status;
    if (glint_pnm_matches(*data, bytes))
        return glint_pnm_read(&loaded->image, *data, bytes, in->name, error);
    if (glint_pfm_matches(*data, bytes))
        return glint_pfm_read(&loaded->floats, *data, bytes, in->name, error);
    glint_input_close(in);
    if (!strcmp(in->name, "standard input"))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, in->name,
                                  "only PPM, PGM and PFM come through a pipe");
    return load_by_plugin(loaded, in->name, glint_picture_type(*data, bytes),
                          error);
}

static enum glint_status load(struct loaded *loaded, const char *path,
                              struct glint_error *error)
{
    struct glint_input in;
    uint8_t *data = NULL;
    enum glint_status status = glint_input_open(&in, path, error);

    memset(loaded, 0, sizeof *loaded);
    if (status)
        return status;
    status = load_opened(loaded, &in, &data, error);
    glint_input_close(&in);
    free(data);
    if (!status && !loaded->floats.rgb && !loaded->image.plane[0]) {
        /* The plug-in reported success, but gave no pixels. */
        (void)glint_error_report(error, GLINT_E_FORMAT, path, "has no pixels");
        status = GLINT_E_FORMAT;
    }
    return status;
}

/* Encodes LINEAR light, 1 = white, to a code by the curve of IEC 61966-2-1.
 * Not-a-number becomes 0. */
static uint8_t encode_srgb(float linear)
{
    if (!(linear > 0))
        return 0;
    if (linear >= 1)
        return 255;
    if (linear <= 0.0031308F)
        return (uint8_t)(linear * 12.92F * 255 + 0.5F);
    return (uint8_t)((1.055F * powf(linear, 1 / 2.4F) - 0.055F) * 255 + 0.5F);
}

static float decode_srgb(int code)
{
    const float v = (float)code / 255;

    return v <= 0.04045F ? v / 12.92F : powf((v + 0.055F) / 1.055F, 2.4F);
}

static enum glint_status report_memory(struct glint_error *error,
                                       const char *path, int width, int height)
{
    return glint_error_report(error, GLINT_E_MEMORY, path,
                              "no memory for a %d x %d picture", width, height);
}

/* Makes an RGB24 image of FROM, which is grey or floats. */
static enum glint_status to_rgb24(struct glint_image *image,
                                  const struct loaded *from, const char *path,
                                  struct glint_error *error)
{
    const float *const rgb = from->floats.rgb;
    struct glint_image made = {
        .format = GLINT_RGB24,
        .width = rgb ? from->floats.width : from->image.width,
        .height = rgb ? from->floats.height : from->image.height,
        .range = GLINT_RANGE_FULL,
        .transfer = GLINT_TONE_SRGB};
    const size_t n = glint_image_bytes(GLINT_RGB24, made.width, made.height);
    uint8_t *const mem = malloc(n);

    if (!mem)
        return report_memory(error, path, made.width, made.height);
    for (size_t i = 0; i < n; i++)
        mem[i] = rgb ? encode_srgb(rgb[i]) : from->image.plane[0][i / 3];
    glint_image_place(&made, mem);
    *image = made;
    return GLINT_OK;
}

/* Makes floats of FROM, which is RGB24 or grey. */
static enum glint_status to_floats(struct glint_float_image *floats,
                                   const struct glint_image *from,
                                   const char *path, struct glint_error *error)
{
    const size_t step = from->format == GLINT_RGB24 ? 1 : 3;
    const size_t n = glint_image_bytes(GLINT_RGB24, from->width, from->height);
    float *const rgb = malloc(n * sizeof *rgb);
    float decoded[256];

    if (!rgb)
        return report_memory(error, path, from->width, from->height);
    for (int i = 0; i < 256; i++)
        decoded[i] = decode_srgb(i);
    for (size_t i = 0; i < n; i++)
        rgb[i] = decoded[from->plane[0][i / step]];
    *floats = (struct glint_float_image){from->width, from->height, rgb};
    return GLINT_OK;
}

enum glint_status glint_picture_load(const char *path,
                                     struct glint_image *image,
                                     struct glint_error *error)
{
    struct loaded loaded;
    enum glint_status status = load(&loaded, path, error);

    if (status)
        return status;
    if (loaded.image.plane[0] && loaded.image.format == GLINT_RGB24) {
        *image = loaded.image;
        return GLINT_OK;
    }
    status = to_rgb24(image, &loaded, path, error);
    glint_picture_free(&loaded.image);
    free(loaded.floats.rgb);
    return status;
}

void glint_picture_free(struct glint_image *image)
{
    free(image->plane[0]);
    image->plane[0] = NULL;
}

enum glint_status glint_picture_load_float(const char *path,
                                           struct glint_float_image *floats,
                                           struct glint_error *error)
{
    struct loaded loaded;
    enum glint_status status = load(&loaded, path, error);

    if (status)
        return status;
    if (loaded.floats.rgb) {
        *floats = loaded.floats;
        return GLINT_OK;
    }
    status = to_floats(floats, &loaded.image, path, error);
    glint_picture_free(&loaded.image);
    return status;
}

/* ------------------------------------------------------------------ saving */

/* clang-format off */
static const struct glint_file_type types[] = {
    /* extension, native, grey, alpha; takes 8 bits, 16, half, float */
    {".ppm",  true,  false, GLINT_ALPHA_NONE,          true,  true,  false, false},
    {".pnm",  true,  false, GLINT_ALPHA_NONE,          true,  true,  false, false},
    {".pgm",  true,  true,  GLINT_ALPHA_NONE,          true,  true,  false, false},
    {".pfm",  true,  false, GLINT_ALPHA_NONE,          false, false, false, true},
    {".png",  false, false, GLINT_ALPHA_STRAIGHT,      true,  true,  false, false},
    {".jpg",  false, false, GLINT_ALPHA_NONE,          true,  false, false, false},
    {".jpeg", false, false, GLINT_ALPHA_NONE,          true,  false, false, false},
    {".exr",  false, false, GLINT_ALPHA_PREMULTIPLIED, false, false, true,  true},
    {".hdr",  false, false, GLINT_ALPHA_NONE,          false, false, false, true},
    {".tif",  false, false, GLINT_ALPHA_STRAIGHT,      true,  true,  true,  true},
    {".tiff", false, false, GLINT_ALPHA_STRAIGHT,      true,  true,  true,  true},
    {".bmp",  false, false, GLINT_ALPHA_NONE,          true,  false, false, false},
    {".tga",  false, false, GLINT_ALPHA_STRAIGHT,      true,  false, false, false},
    {".webp", false, false, GLINT_ALPHA_STRAIGHT,      true,  false, false, false},
};
/* clang-format on */

const struct glint_file_type *glint_file_type_of(const char *path)
{
    const char *const slash = strrchr(path, '/');
    const char *const extension = strrchr(slash ? slash : path, '.');

    for (size_t i = 0; extension && i < sizeof types / sizeof *types; i++)
        if (strcasecmp(extension, types[i].extension) == 0)
            return &types[i];
    return NULL;
}

/* Returns the type that PATH's extension names, or NULL if it is unknown. The
 * pipe "-" has the type that glint itself writes for KIND. */
static const struct glint_file_type *find_type(const char *path,
                                               enum glint_picture_kind kind)
{
    if (!strcmp(path, "-"))
        path = kind == GLINT_PICTURE_FLOAT ? "-.pfm" : "-.ppm";
    return glint_file_type_of(path);
}

bool glint_picture_is_float(const char *path)
{
    const struct glint_file_type *const type =
        find_type(path, GLINT_PICTURE_8BIT);

    return type && !type->takes_u8;
}

enum glint_status glint_picture_check(const char *path,
                                      enum glint_picture_kind kind,
                                      struct glint_error *error)
{
    const struct glint_file_type *const type = find_type(path, kind);
    const struct glint_oiio *oiio;

    if (!type || type->is_grey)
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, path,
            "unknown extension; pictures are .ppm .png .jpg .tif .bmp .tga "
            ".webp, linear light is .pfm .exr .hdr .tif");
    if (kind == GLINT_PICTURE_8BIT && !type->takes_u8)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                                  "%s holds linear light in floats, and this "
                                  "picture has 8-bit codes",
                                  type->extension);
    if (kind == GLINT_PICTURE_FLOAT && !type->takes_float)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                                  "%s holds 8-bit codes, and this picture has "
                                  "linear light in floats",
                                  type->extension);
    if (!type->is_native && glint_oiio_load(&oiio, error))
        return glint_picture_needs_plugin(path, type->extension, error);
    return GLINT_OK;
}

static enum glint_status write_by_plugin(struct glint_output *out,
                                         const struct glint_oiio_pixels *pixels,
                                         ptrdiff_t stride_bytes,
                                         struct glint_error *error)
{
    const struct glint_oiio *oiio;
    enum glint_status status = glint_oiio_load(&oiio, error);
    void *data;
    size_t bytes;

    if (!status)
        status =
            oiio->encode(&data, &bytes, out->name, pixels, stride_bytes, error);
    if (status)
        return status;
    status = glint_output_write(out, data, bytes, error);
    free(data);
    return status;
}

/* Saves PIXELS, whose rows are STRIDE_BYTES apart, of floats without gaps. */
static enum glint_status save(const char *path,
                              const struct glint_oiio_pixels *pixels,
                              ptrdiff_t stride_bytes, struct glint_error *error)
{
    const enum glint_picture_kind kind =
        pixels->is_float ? GLINT_PICTURE_FLOAT : GLINT_PICTURE_8BIT;
    const struct glint_image image = {.format = GLINT_RGB24,
                                      .width = pixels->width,
                                      .height = pixels->height,
                                      .plane = {pixels->rgb},
                                      .stride_bytes = {stride_bytes}};
    const struct glint_float_image floats = {pixels->width, pixels->height,
                                             pixels->rgb};
    struct glint_output out;
    enum glint_status status = glint_picture_check(path, kind, error);

    if (!status)
        status = glint_output_open(&out, path, GLINT_OUTPUT_BINARY, error);
    if (status)
        return status;
    if (!find_type(path, kind)->is_native)
        status = write_by_plugin(&out, pixels, stride_bytes, error);
    else if (pixels->is_float)
        status = glint_pfm_write(&out, &floats, error);
    else
        status = glint_pnm_write(&out, &image, error);
    return glint_output_end(&out, status, error);
}

enum glint_status glint_picture_save(const char *path,
                                     const struct glint_image *image,
                                     struct glint_error *error)
{
    return save(path,
                &(struct glint_oiio_pixels){image->width, image->height, 0,
                                            image->plane[0]},
                image->stride_bytes[0], error);
}

enum glint_status
glint_picture_save_float(const char *path,
                         const struct glint_float_image *floats,
                         struct glint_error *error)
{
    return save(path,
                &(struct glint_oiio_pixels){floats->width, floats->height, 1,
                                            floats->rgb},
                3 * (ptrdiff_t)sizeof *floats->rgb * floats->width, error);
}
