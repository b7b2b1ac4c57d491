/* SPDX-License-Identifier: MIT */
#include "formats/picture.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/stills.h"
#include "glint/options.h"
#include "posix/ending.h"
#include "posix/error.h"
#include "posix/input.h"

/* Returns the offset behind the GIF sub-blocks that begin at offset AT, or N if
 * the data end before. */
static size_t skip_gif_blocks(const uint8_t *d, size_t n, size_t at)
{
    while (at < n && d[at] != 0)
        at += (size_t)d[at] + 1;
    return at < n ? at + 1 : n;
}

static size_t get_gif_colour_table_bytes(uint8_t packed)
{
    return packed & 0x80 ? (size_t)3 << ((packed & 7) + 1) : 0;
}

static int count_gif_frames(const uint8_t *d, size_t n)
{
    int frames = 0;
    size_t at;

    if (n < 13 || memcmp(d, "GIF8", 4) != 0)
        return 0;
    at = 13 + get_gif_colour_table_bytes(d[10]);
    while (at < n && d[at] != 0x3b) {
        if (d[at] == 0x21 && at + 2 < n) {
            at = skip_gif_blocks(d, n, at + 2);
        } else if (d[at] == 0x2c && at + 11 < n) {
            frames++;
            at = skip_gif_blocks(
                d, n, at + 11 + get_gif_colour_table_bytes(d[at + 9]));
        } else
            break;
    }
    return frames;
}

int glint_gif_count_frames(const char *name)
{
    struct glint_error error;
    uint8_t *data = NULL;
    size_t bytes = 0;
    int n = 0;

    if (!glint_has_extension(name, ".gif"))
        return 0;
    if (glint_input_read_whole_file(&data, &bytes, name, 1 << 28, &error) ==
        GLINT_OK)
        n = count_gif_frames(data, bytes);
    free(data);
    return n;
}

/* Max bytes of a file that glint reads without the plug-in: those of a PFM with
 * its header. PNM files are smaller. */
#define MAX_FILE_BYTES                                             \
    (SIZE_MAX / 4 < UINT64_C(12) * GLINT_MAX_SIDE * GLINT_MAX_SIDE \
         ? SIZE_MAX / 4                                            \
         : (size_t)(UINT64_C(12) * GLINT_MAX_SIDE * GLINT_MAX_SIDE + 4096))
#define HEAD_BYTES 12 /* first bytes of a file, which identify its type */

/* ------------------------------------------------------------------- types */

enum type_alpha { ALPHA_NONE, ALPHA_STRAIGHT, ALPHA_PREMULTIPLIED };

/* Bits: content besides pixels that a file type can hold. */
enum type_holds { HOLDS_METADATA = 1, HOLDS_ICC = 2, HOLDS_CICP = 4 };

struct file_type {
    const char *extension;
    bool is_native; /* true: glint writes this type without the plug-in */
    bool is_grey;   /* true: the type can hold only grey pictures */
    enum type_alpha alpha;
    bool takes_u8, takes_u16, takes_half, takes_float;
    unsigned holds; /* bits of enum type_holds */
};

/* clang-format off */
static const struct file_type types[] = {
    /* Columns: extension; is native; is grey only; alpha; can hold 8 bits, 16
     * bits, half, float; bits of enum type_holds */
    {".ppm",  true,  false, ALPHA_NONE,          true,  true,  false, false, 0},
    {".pnm",  true,  false, ALPHA_NONE,          true,  true,  false, false, 0},
    {".pgm",  true,  true,  ALPHA_NONE,          true,  true,  false, false, 0},
    {".pfm",  true,  false, ALPHA_NONE,          false, false, false, true, 0},
    {".png",  false, false, ALPHA_STRAIGHT,      true,  true,  false, false, 7},
    {".jpg",  false, false, ALPHA_NONE,          true,  false, false, false, 3},
    {".jpeg", false, false, ALPHA_NONE,          true,  false, false, false, 3},
    {".exr",  false, false, ALPHA_PREMULTIPLIED, false, false, true,  true, 1},
    {".hdr",  false, false, ALPHA_NONE,          false, false, false, true, 0},
    {".tif",  false, false, ALPHA_STRAIGHT,      true,  true,  true,  true, 3},
    {".tiff", false, false, ALPHA_STRAIGHT,      true,  true,  true,  true, 3},
    {".bmp",  false, false, ALPHA_NONE,          true,  false, false, false, 0},
    {".tga",  false, false, ALPHA_STRAIGHT,      true,  false, false, false, 0},
    {".webp", false, false, ALPHA_STRAIGHT,      true,  false, false, false, 3},
    {".heic", false, false, ALPHA_STRAIGHT,      true,  true,  false, false, 7},
    {".heif", false, false, ALPHA_STRAIGHT,      true,  true,  false, false, 7},
    {".avif", false, false, ALPHA_STRAIGHT,      true,  true,  false, false, 7},
    {".jxl",  false, false, ALPHA_STRAIGHT,      true,  true,  false, false, 1},
};
/* clang-format on */

/* ----------------------------------------------------------------- loading */

/* A loaded picture. Either image (8 bits) or floats is set; the other member is
 * all 0. */
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

/* Returns, for messages, the name of the file type that HEAD, the first BYTES
 * of a file, identify. */
static const char *get_name_of_file_type(const uint8_t *head, size_t bytes)
{
    for (size_t i = 0; i < sizeof magics / sizeof *magics; i++)
        if (bytes >= magics[i].n && !memcmp(head, magics[i].bytes, magics[i].n))
            return magics[i].type;
    return "any file but PPM, PGM and PFM";
}

static enum glint_status report_type_needs_plugin(const char *path,
                                                  const char *type,
                                                  struct glint_error *error)
{
    const struct glint_error cause = *error;

    return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                              "%s needs glint's image plug-in: %s", type,
                              cause.text);
}

/* Appends TEXT to NOTES, after "; " if NOTES is not empty. */
static void append_to_notes(char notes[GLINT_KEPT_NOTES], const char *text)
{
    const size_t used = strlen(notes);

    snprintf(notes + used, GLINT_KEPT_NOTES - used, "%s%s", used ? "; " : "",
             text);
}

/* Sets OIIO to the functions that read or write files of TYPE, a name or a path
 * with its extension: those of the image plug-in or, if it is missing, those of
 * the libraries that are built in. Appends to NOTES, which may be NULL, why a
 * plug-in is not used. */
static enum glint_status find_functions(const struct glint_oiio **oiio,
                                        const char *type, const char *path,
                                        char *notes, struct glint_error *error)
{
    const enum glint_status status = glint_oiio_load(oiio, error);

    if (status)
        *oiio = glint_stills_find(type);
    if (status == GLINT_E_FORMAT && *oiio && notes)
        append_to_notes(notes, error->text);
    return *oiio ? GLINT_OK : report_type_needs_plugin(path, type, error);
}

static enum glint_status load_picture_by_plugin(struct loaded *loaded,
                                                const char *path,
                                                const char *type,
                                                struct glint_error *error)
{
    const struct glint_oiio *oiio;
    struct glint_oiio_pixels pixels;
    enum glint_status status = find_functions(&oiio, type, path, NULL, error);

    if (status)
        return status;
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

/* Reads all of IN if it is a PNM or PFM, else its first 12 bytes, into *DATA,
 * which the caller frees also on failure. Errors name the file NAME. Returns
 * GLINT_E_FORMAT if IN is empty, GLINT_E_UNSUPPORTED if it is a video or too
 * large, GLINT_E_IO or GLINT_E_MEMORY. */
static enum glint_status read_picture_file(struct glint_input *in,
                                           const char *name, uint8_t **data,
                                           size_t *bytes,
                                           struct glint_error *error)
{
    ptrdiff_t n = 1;

    *bytes = 0;
    *data = malloc(HEAD_BYTES);
    if (!*data)
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "not enough memory to read the file");
    while (n > 0 && *bytes < HEAD_BYTES) {
        n = glint_input_read_available(in, *data + *bytes, HEAD_BYTES - *bytes);
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
    return glint_pnm_has_signature(*data, *bytes) ||
                   glint_pfm_has_signature(*data, *bytes)
               ? glint_input_read_rest(in, data, bytes, MAX_FILE_BYTES, error)
               : GLINT_OK;
}

static enum glint_status load_picture_from_input(struct loaded *loaded,
                                                 struct glint_input *in,
                                                 uint8_t **data,
                                                 struct glint_error *error)
{
    size_t bytes;
    enum glint_status status =
        read_picture_file(in, in->name, data, &bytes, error);

    if (status)
        return status;
    if (glint_pnm_has_signature(*data, bytes))
        return glint_pnm_read(&loaded->image, *data, bytes, in->name, error);
    if (glint_pfm_has_signature(*data, bytes))
        return glint_pfm_read(&loaded->floats, *data, bytes, in->name, error);
    glint_input_close(in);
    if (!strcmp(in->name, "standard input"))
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, in->name,
            "only PPM, PGM and PFM can be read from a pipe");
    return load_picture_by_plugin(loaded, in->name,
                                  get_name_of_file_type(*data, bytes), error);
}

static enum glint_status load_picture(struct loaded *loaded, const char *path,
                                      struct glint_error *error)
{
    struct glint_input in;
    uint8_t *data = NULL;
    enum glint_status status = glint_input_open_file(&in, path, error);

    memset(loaded, 0, sizeof *loaded);
    if (status)
        return status;
    status = load_picture_from_input(loaded, &in, &data, error);
    glint_input_close(&in);
    free(data);
    if (!status && !loaded->floats.rgb && !loaded->image.plane[0]) {
        /* the plug-in returned GLINT_OK without pixels */
        (void)glint_error_report(error, GLINT_E_FORMAT, path, "has no pixels");
        status = GLINT_E_FORMAT;
    }
    return status;
}

/* Returns the sRGB code [IEC 61966-2-1] of LINEAR light, 1 = white. NaN becomes
 * 0. */
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

static enum glint_status report_memory_shortage(struct glint_error *error,
                                                const char *path, int width,
                                                int height)
{
    return glint_error_report(error, GLINT_E_MEMORY, path,
                              "no memory for a %d x %d picture", width, height);
}

/* Sets IMAGE to FROM, a grey or float picture, converted to RGB24. */
static enum glint_status convert_to_rgb24(struct glint_image *image,
                                          const struct loaded *from,
                                          const char *path,
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
        return report_memory_shortage(error, path, made.width, made.height);
    for (size_t i = 0; i < n; i++)
        mem[i] = rgb ? encode_srgb(rgb[i]) : from->image.plane[0][i / 3];
    glint_image_place(&made, mem);
    *image = made;
    return GLINT_OK;
}

/* Sets FLOATS to FROM, an RGB24 or grey image, converted to linear light. */
static enum glint_status convert_to_floats(struct glint_float_image *floats,
                                           const struct glint_image *from,
                                           const char *path,
                                           struct glint_error *error)
{
    const size_t step = from->format == GLINT_RGB24 ? 1 : 3;
    const size_t n = glint_image_bytes(GLINT_RGB24, from->width, from->height);
    float *const rgb = malloc(n * sizeof *rgb);
    float decoded[256];

    if (!rgb)
        return report_memory_shortage(error, path, from->width, from->height);
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
    enum glint_status status = load_picture(&loaded, path, error);

    if (status)
        return status;
    if (loaded.image.plane[0] && loaded.image.format == GLINT_RGB24) {
        *image = loaded.image;
        return GLINT_OK;
    }
    status = convert_to_rgb24(image, &loaded, path, error);
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
    enum glint_status status = load_picture(&loaded, path, error);

    if (status)
        return status;
    if (loaded.floats.rgb) {
        *floats = loaded.floats;
        return GLINT_OK;
    }
    status = convert_to_floats(floats, &loaded.image, path, error);
    glint_picture_free(&loaded.image);
    return status;
}

/* ------------------------------------------------------------------ saving */

/* Returns the file type of PATH's extension, or NULL if it is unknown. */
static const struct file_type *find_type_of_extension(const char *path)
{
    const char *const slash = strrchr(path, '/');
    const char *const extension = strrchr(slash ? slash : path, '.');

    for (size_t i = 0; extension && i < sizeof types / sizeof *types; i++)
        if (strcasecmp(extension, types[i].extension) == 0)
            return &types[i];
    return NULL;
}

/* Returns the file type of PATH's extension, or NULL if it is unknown. For "-",
 * a pipe, returns PPM if KIND is 8 bits, and PFM if KIND is floats. */
static const struct file_type *find_output_type(const char *path,
                                                enum glint_picture_kind kind)
{
    if (!strcmp(path, "-"))
        path = kind == GLINT_PICTURE_FLOAT ? "-.pfm" : "-.ppm";
    return find_type_of_extension(path);
}

bool glint_picture_is_float(const char *path)
{
    const struct file_type *const type =
        find_output_type(path, GLINT_PICTURE_8BIT);

    return type && !type->takes_u8;
}

enum glint_status glint_picture_check(const char *path,
                                      enum glint_picture_kind kind,
                                      struct glint_error *error)
{
    const struct file_type *const type = find_output_type(path, kind);
    const struct glint_oiio *oiio;

    if (!type || type->is_grey)
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, path,
            "unknown extension; pictures are .ppm .png .jpg .tif .bmp .tga "
            ".webp .heic .avif .jxl, linear light is .pfm .exr .hdr .tif");
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
    return type->is_native
               ? GLINT_OK
               : find_functions(&oiio, type->extension, path, NULL, error);
}

static enum glint_status
write_picture_by_plugin(struct glint_output *out,
                        const struct glint_oiio_pixels *pixels,
                        ptrdiff_t stride_bytes, struct glint_error *error)
{
    const struct glint_oiio *oiio;
    enum glint_status status =
        find_functions(&oiio, out->name, out->name, NULL, error);
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

/* Writes PIXELS to the file PATH. Rows are STRIDE_BYTES apart; float rows have
 * no gaps. */
static enum glint_status save_pixels(const char *path,
                                     const struct glint_oiio_pixels *pixels,
                                     ptrdiff_t stride_bytes,
                                     struct glint_error *error)
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
    if (!find_output_type(path, kind)->is_native)
        status = write_picture_by_plugin(&out, pixels, stride_bytes, error);
    else if (pixels->is_float)
        status = glint_pfm_write(&out, &floats, error);
    else
        status = glint_pnm_write(&out, &image, error);
    return glint_output_commit_or_abort(&out, status, error);
}

enum glint_status glint_picture_save(const char *path,
                                     const struct glint_image *image,
                                     struct glint_error *error)
{
    return save_pixels(path,
                       &(struct glint_oiio_pixels){image->width, image->height,
                                                   0, image->plane[0]},
                       image->stride_bytes[0], error);
}

enum glint_status
glint_picture_save_float(const char *path,
                         const struct glint_float_image *floats,
                         struct glint_error *error)
{
    return save_pixels(path,
                       &(struct glint_oiio_pixels){
                           floats->width, floats->height, 1, floats->rgb},
                       3 * (ptrdiff_t)sizeof *floats->rgb * floats->width,
                       error);
}

/* Sets the layout of S to WIDTH x HEIGHT pixels of 1 .. 4 CHANNELS,
 * interleaved; the last of 2 or 4 channels is alpha. Leaves s->mem NULL. */
static void set_sample_layout(struct glint_samples *s, int width, int height,
                              enum glint_sample sample, int channels)
{
    const size_t bytes = glint_sample_get_bytes(sample);

    *s = (struct glint_samples){
        .width = width,
        .height = height,
        .window_width = width,
        .window_height = height,
        .orientation = 1,
        .pixel_bytes = bytes * (size_t)channels,
        .n_colours = channels < 3 ? 1 : 3,
        .has_alpha = channels % 2 == 0,
        .is_premultiplied = true,
        .alpha = {sample, bytes * (size_t)(channels - 1)}};
    for (int c = 0; c < 3; c++)
        s->colour[c] = (struct glint_sample_place){
            sample, channels < 3 ? 0 : bytes * (size_t)c};
    s->maximum = sample == GLINT_SAMPLE_U8    ? UINT8_MAX
                 : sample == GLINT_SAMPLE_U16 ? UINT16_MAX
                                              : UINT32_MAX;
    if (glint_sample_is_float(sample))
        glint_colours_set_bt709(&s->colours, GLINT_TONE_IS_LINEAR, 0, "linear");
    else
        glint_colours_set_bt709(&s->colours, GLINT_TONE_IS_SRGB, 0, "sRGB");
}

static size_t count_sample_bytes(const struct glint_samples *s)
{
    return (size_t)s->width * (size_t)s->height * s->pixel_bytes;
}

/* -------------------------------------------------------------- PNM and PFM */

/* Copies BYTES of 16-bit samples, from big-endian order to this machine's or
 * back. */
static void swap_bytes_of_16_bit_samples(uint8_t *to, const uint8_t *from,
                                         size_t bytes)
{
    const uint16_t one = 1;
    const bool swap = *(const uint8_t *)&one == 1;

    for (size_t i = 0; i < bytes; i += 2) {
        to[i] = from[i + swap];
        to[i + 1] = from[i + !swap];
    }
}

/* Copies the float rows of S in reverse order. Converts the byte order from the
 * file to this machine or back. LITTLE: the file is little-endian. */
static void reverse_order_of_float_rows(uint8_t *to, const uint8_t *from,
                                        const struct glint_samples *s,
                                        bool little)
{
    const uint16_t one = 1;
    const bool swap = (*(const uint8_t *)&one == 1) != little;
    const size_t row = (size_t)s->width * s->pixel_bytes;

    for (int y = 0; y < s->height; y++)
        for (size_t i = 0; i < row; i++)
            to[(size_t)y * row + (swap ? i ^ 3 : i)] =
                from[(size_t)(s->height - 1 - y) * row + i];
}

/* Opens the PNM or PFM in k->native. */
static enum glint_status open_native_file(struct glint_kept *k,
                                          struct glint_error *error)
{
    struct glint_samples *const s = &k->samples;
    struct glint_pnm_header h;
    enum glint_status status =
        glint_pnm_header_read(&h, k->native, k->native_bytes, k->path, error);

    if (status)
        return status;
    k->header_bytes = h.bytes;
    k->is_pfm = k->is_float = h.maximum == 0;
    k->is_little = h.little;
    set_sample_layout(s, h.width, h.height,
                      k->is_pfm         ? GLINT_SAMPLE_FLOAT
                      : h.maximum > 255 ? GLINT_SAMPLE_U16
                                        : GLINT_SAMPLE_U8,
                      h.channels);
    s->mem = k->native + h.bytes;
    if (!k->is_pfm)
        s->maximum = (uint32_t)h.maximum;
    if (!k->is_pfm && h.maximum <= 255)
        return GLINT_OK;
    k->own = malloc(count_sample_bytes(s));
    if (!k->own)
        return report_memory_shortage(error, k->path, s->width, s->height);
    if (k->is_pfm)
        reverse_order_of_float_rows(k->own, s->mem, s, h.little);
    else
        swap_bytes_of_16_bit_samples(k->own, s->mem, count_sample_bytes(s));
    s->mem = k->own;
    return GLINT_OK;
}

/* Copies the samples of K back into the bytes of its PNM or PFM file, in the
 * file's byte order. Does nothing if k->own is NULL: the samples are these
 * bytes. */
static void update_native_file(struct glint_kept *k)
{
    uint8_t *const at = k->native + k->header_bytes;

    if (k->is_pfm)
        reverse_order_of_float_rows(at, k->own, &k->samples, k->is_little);
    else if (k->own)
        swap_bytes_of_16_bit_samples(at, k->own,
                                     count_sample_bytes(&k->samples));
}

/* ------------------------------------------------------------------ colours */

/* Sets the colours C from CICP, the codes of primaries and transfer in ITU-T
 * H.273. Returns false if the transfer is unknown. */
static bool set_colours_by_cicp(struct glint_colours *c, const int cicp[2])
{
    static const double p3[4][2] = {
        {0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, {0.3127, 0.329}};
    static const double bt2020[4][2] = {
        {0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, {0.3127, 0.329}};

    if (cicp[1] == 13)
        glint_colours_set_bt709(c, GLINT_TONE_IS_SRGB, 0, "sRGB");
    else if (cicp[1] == 8)
        glint_colours_set_bt709(c, GLINT_TONE_IS_LINEAR, 0, "linear");
    else if (cicp[1] == 4 || cicp[1] == 5)
        glint_colours_set_bt709(c, GLINT_TONE_IS_GAMMA,
                                cicp[1] == 4 ? 2.2 : 2.8, "gamma");
    else if (cicp[1] == 16)
        glint_colours_set_bt709(c, GLINT_TONE_IS_PQ, 0, "PQ");
    else if (cicp[1] == 18)
        glint_colours_set_bt709(c, GLINT_TONE_IS_HLG, 0, "HLG");
    else if (cicp[1] == 1 || cicp[1] == 6 || cicp[1] == 14 || cicp[1] == 15)
        glint_colours_set_bt709(c, GLINT_TONE_IS_BT709, 0, "BT.709");
    else
        return false;
    if (cicp[0] == 9)
        return glint_colours_set_primaries(c, bt2020);
    return cicp[0] != 12 || glint_colours_set_primaries(c, p3);
}

/* Sets the colours C from NAME, OpenImageIO's name of a colour space. Returns
 * false if NAME is unknown. */
static bool set_colours_by_name(struct glint_colours *c, const char *name)
{
    static const double adobe[4][2] = {
        {0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.329}};
    const char *end;
    double gamma;

    if (strcasecmp(name, "sRGB") == 0)
        glint_colours_set_bt709(c, GLINT_TONE_IS_SRGB, 0, "sRGB");
    else if (strcasecmp(name, "linear") == 0 ||
             strncasecmp(name, "lin_", 4) == 0)
        glint_colours_set_bt709(c, GLINT_TONE_IS_LINEAR, 0, "linear");
    else if (strcasecmp(name, "Rec709") == 0)
        glint_colours_set_bt709(c, GLINT_TONE_IS_BT709, 0, "BT.709");
    else if (strcasecmp(name, "AdobeRGB") == 0) {
        glint_colours_set_bt709(c, GLINT_TONE_IS_GAMMA, 563 / 256.0,
                                "Adobe RGB");
        return glint_colours_set_primaries(c, adobe);
    } else if (strncmp(name, "Gamma", 5) == 0 &&
               (gamma = glint_option_number(name + 5, &end)) > 0.1 &&
               gamma < 10)
        glint_colours_set_bt709(c, GLINT_TONE_IS_GAMMA, gamma, "gamma");
    else
        return false;
    return true;
}

/* Sets the colours of K's samples from FACTS. A colour space that glint does
 * not know is treated as linear or sRGB, and k->note reports this. */
static void set_colours_of_file(struct glint_kept *k,
                                const struct glint_oiio_facts *facts)
{
    struct glint_samples *const s = &k->samples;
    struct glint_colours *const c = &s->colours;
    char text[96];
    bool known = true;

    if (k->is_float)
        glint_colours_set_bt709(c, GLINT_TONE_IS_LINEAR, 0, "linear");
    else
        glint_colours_set_bt709(c, GLINT_TONE_IS_SRGB, 0, "sRGB");
    if (facts->cicp[1])
        known = k->has_cicp = set_colours_by_cicp(c, facts->cicp);
    else if (facts->icc)
        known = k->has_icc =
            glint_icc_read_colours(c, facts->icc, facts->icc_bytes);
    else if (facts->gamma > 0.1 && facts->gamma < 10)
        glint_colours_set_bt709(c, GLINT_TONE_IS_GAMMA, facts->gamma, "gamma");
    else if (*facts->colour_space && !k->is_float)
        known = set_colours_by_name(c, facts->colour_space);
    if (!facts->icc && !facts->cicp[1] && facts->has_primaries)
        glint_colours_set_primaries(c, (const double(*)[2])facts->primaries);
    if (known)
        return;
    snprintf(text, sizeof text, "%.24s is unknown; treated as %s",
             facts->cicp[1] ? "the transfer of its cICP"
             : facts->icc   ? "its ICC profile's curve"
                            : facts->colour_space,
             k->is_float ? "linear" : "sRGB");
    append_to_notes(k->note, text);
}

/* --------------------------------------------------------------- plug-in */

static double drop_implausible_focal_length(double mm)
{
    return mm >= 0.1 && mm <= 10000 ? mm : 0;
}

/* Sets the camera settings of K from those of Exif in FACTS. */
static void set_camera(struct glint_kept *k,
                       const struct glint_oiio_facts *facts)
{
    /* A lens of a shorter focal length is that of a sensor much smaller than 35
     * mm film. */
    const double min_lens_mm = 15;
    const double lens_mm = drop_implausible_focal_length(facts->focal_mm);
    const double film_mm = drop_implausible_focal_length(facts->film_focal_mm);

    if (film_mm == 0 && lens_mm < min_lens_mm)
        return;
    k->focal_mm = film_mm > 0 ? film_mm : lens_mm;
    k->f_number =
        facts->f_number * (lens_mm > 0 && film_mm > 0 ? film_mm / lens_mm : 1);
}

static enum glint_status open_file_by_plugin(struct glint_kept *k,
                                             const char *type,
                                             struct glint_error *error)
{
    struct glint_oiio_facts facts;
    const struct glint_oiio *oiio;
    enum glint_status status =
        find_functions(&oiio, type, k->path, k->note, error);

    if (status)
        return status;
    status = oiio->open(&k->file, &k->samples, &facts, k->path, error);
    if (status)
        return status;
    k->oiio = oiio;
    k->is_float = glint_sample_is_float(k->samples.colour[0].sample);
    k->metadata = facts.metadata;
    set_camera(k, &facts);
    if (*facts.note)
        append_to_notes(k->note, facts.note);
    set_colours_of_file(k, &facts);
    return GLINT_OK;
}

/* ----------------------------------------------------------------- opening */

static enum glint_status open_any_file(struct glint_kept *k,
                                       struct glint_error *error)
{
    struct glint_input in;
    enum glint_status status = glint_input_open_file(&in, k->path, error);

    if (status)
        return status;
    status =
        read_picture_file(&in, k->path, &k->native, &k->native_bytes, error);
    glint_input_close(&in);
    if (status)
        return status;
    return glint_pnm_has_signature(k->native, k->native_bytes) ||
                   glint_pfm_has_signature(k->native, k->native_bytes)
               ? open_native_file(k, error)
               : open_file_by_plugin(
                     k, get_name_of_file_type(k->native, k->native_bytes),
                     error);
}

enum glint_status glint_kept_open(struct glint_kept *kept, const char *path,
                                  struct glint_error *error)
{
    enum glint_status status;

    memset(kept, 0, sizeof *kept);
    kept->path = path;
    status = open_any_file(kept, error);
    if (status)
        glint_kept_close(kept);
    return status;
}

void glint_kept_close(struct glint_kept *kept)
{
    if (kept->oiio)
        kept->oiio->close(kept->file);
    free(kept->native);
    free(kept->own);
    kept->oiio = NULL;
    kept->native = kept->own = NULL;
}

/* ------------------------------------------------------------------ saving */

enum glint_status glint_kept_check(const char *path, struct glint_error *error)
{
    const struct file_type *const type = find_type_of_extension(path);
    const struct glint_oiio *oiio;

    if (!type)
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, path,
            "unknown extension; pictures are .ppm .pgm .png .jpg .tif .bmp "
            ".tga .webp .heic .avif .jxl, linear light is .pfm .exr .hdr "
            ".tif");
    if (type->is_native)
        return GLINT_OK;
    if (find_functions(&oiio, type->extension, path, NULL, error))
        return GLINT_E_UNSUPPORTED;
    if (!oiio->can_write(path))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                                  "the installed OpenImageIO does not write "
                                  "%s; write .png and convert that",
                                  type->extension);
    return GLINT_OK;
}

bool glint_kept_is_same_type(const struct glint_kept *kept, const char *path)
{
    const struct file_type *const type = find_type_of_extension(path);

    if (!type)
        return false;
    if (kept->oiio)
        return !type->is_native && kept->oiio->is_same_type(kept->file, path);
    return type->is_native && kept->is_pfm == type->takes_float &&
           (kept->is_pfm || type->is_grey == (kept->samples.n_colours == 1) ||
            strcasecmp(type->extension, ".pnm") == 0);
}

enum glint_status glint_kept_copy_file(const struct glint_kept *kept,
                                       const char *path,
                                       struct glint_error *error)
{
    uint8_t *data;
    size_t bytes;
    enum glint_status status = glint_input_read_whole_file(
        &data, &bytes, kept->path, SIZE_MAX / 2, error);

    if (status)
        return status;
    status =
        glint_output_save_file(path, GLINT_OUTPUT_BINARY, data, bytes, error);
    free(data);
    return status;
}

enum glint_status glint_kept_make_blank(struct glint_samples *blank,
                                        const struct glint_samples *from,
                                        bool has_alpha)
{
    const enum glint_sample sample = from->colour[0].sample == GLINT_SAMPLE_U32
                                         ? GLINT_SAMPLE_FLOAT
                                         : from->colour[0].sample;

    set_sample_layout(blank, glint_samples_get_width(from),
                      glint_samples_get_height(from), sample,
                      has_alpha ? 4 : 3);
    blank->mem = calloc((size_t)blank->width * (size_t)blank->height,
                        blank->pixel_bytes);
    return blank->mem ? GLINT_OK : GLINT_E_MEMORY;
}

/* Returns whether samples of the type of S can be lighter than white. */
static bool can_be_above_white(const struct glint_samples *s)
{
    return glint_sample_is_float(s->colour[0].sample) ||
           glint_tone_curve_is_hdr(&s->colours.transfer[0]);
}

static void report_losses(struct glint_kept_options *options,
                          const struct glint_samples *to,
                          const struct glint_samples *from)
{

    if (from->has_alpha && !to->has_alpha)
        append_to_notes(
            options->said,
            "the file type has no alpha: the picture is composited over black");
    if (can_be_above_white(from) && !can_be_above_white(to))
        append_to_notes(
            options->said,
            to->colour[0].sample == GLINT_SAMPLE_U8
                ? "light above white is clipped, and 8 bits remain"
                : "light above white is clipped, and 16 bits remain");
    else if (glint_sample_get_bytes(from->colour[0].sample) > 1 &&
             to->colour[0].sample == GLINT_SAMPLE_U8)
        append_to_notes(options->said, "8 bits remain");
}

/* Returns the sample type nearest to SAMPLE that files of TYPE can hold. */
static enum glint_sample
choose_nearest_sample_type(const struct file_type *type,
                           enum glint_sample sample)
{
    const bool is_float = glint_sample_is_float(sample);

    if (sample == GLINT_SAMPLE_U8 && type->takes_u8)
        return GLINT_SAMPLE_U8;
    if (sample == GLINT_SAMPLE_HALF && type->takes_half)
        return GLINT_SAMPLE_HALF;
    if (is_float && type->takes_float)
        return GLINT_SAMPLE_FLOAT;
    if (sample == GLINT_SAMPLE_U8 && type->takes_half)
        return GLINT_SAMPLE_HALF;
    if (sample != GLINT_SAMPLE_U8 && type->takes_u16)
        return GLINT_SAMPLE_U16;
    return type->takes_u8 ? GLINT_SAMPLE_U8 : GLINT_SAMPLE_FLOAT;
}

/* Returns whether a file of TYPE can describe the colours of K for samples TO,
 * by its ICC profile or cICP. */
static bool can_type_hold_colours(const struct glint_kept *k,
                                  const struct file_type *type,
                                  const struct glint_samples *to)
{
    return !glint_sample_is_float(to->colour[0].sample) &&
           !glint_sample_is_float(k->samples.colour[0].sample) &&
           to->n_colours == k->samples.n_colours &&
           ((k->has_icc && (type->holds & HOLDS_ICC)) ||
            (k->has_cicp && (type->holds & HOLDS_CICP)));
}

/* Converts the samples FROM to samples TO, of a type that files of TYPE can
 * hold; the caller frees to->mem. If FROM has the colours of K and files of
 * TYPE can describe them, TO gets these colours and *KEEPS is set. */
static enum glint_status
convert_samples_for_type(const struct glint_kept *k, struct glint_samples *to,
                         const struct glint_samples *from,
                         const struct file_type *type, bool *keeps)
{
    const bool has_alpha = from->has_alpha && type->alpha != ALPHA_NONE;
    const bool is_grey = type->is_grey ||
                         (from->n_colours == 1 && !type->is_native) ||
                         (from->n_colours == 1 && type->takes_float);

    set_sample_layout(to, glint_samples_get_width(from),
                      glint_samples_get_height(from),
                      choose_nearest_sample_type(type, from->colour[0].sample),
                      (is_grey ? 1 : 3) + has_alpha);
    to->is_premultiplied = type->alpha != ALPHA_STRAIGHT;
    *keeps = from == &k->samples && can_type_hold_colours(k, type, to);
    if (*keeps)
        to->colours = from->colours;
    to->mem = malloc(count_sample_bytes(to));
    if (!to->mem)
        return GLINT_E_MEMORY;
    glint_samples_convert(to, from);
    return GLINT_OK;
}

static enum glint_status write_native_file(struct glint_output *out,
                                           struct glint_samples *s,
                                           const struct file_type *type,
                                           struct glint_error *error)
{
    const size_t bytes = count_sample_bytes(s);
    const bool is_wide = s->colour[0].sample == GLINT_SAMPLE_U16;
    const char *const kind = type->takes_float
                                 ? (s->n_colours == 1 ? "Pf" : "PF")
                                 : (s->n_colours == 1 ? "P5" : "P6");
    uint8_t *const data = malloc(bytes);
    enum glint_status status;
    char header[64];
    int n;

    if (!data)
        return report_memory_shortage(error, out->name, s->width, s->height);
    if (type->takes_float)
        reverse_order_of_float_rows(data, s->mem, s, true);
    else if (is_wide)
        swap_bytes_of_16_bit_samples(data, s->mem, bytes);
    else
        memcpy(data, s->mem, bytes);
    n = snprintf(header, sizeof header, "%s\n%d %d\n%s\n", kind, s->width,
                 s->height,
                 type->takes_float ? "-1.0"
                 : is_wide         ? "65535"
                                   : "255");
    status = glint_output_write(out, header, (size_t)n, error);
    if (!status)
        status = glint_output_write(out, data, bytes, error);
    free(data);
    return status;
}

static enum glint_status
write_kept(struct glint_kept *k, struct glint_output *out,
           const struct glint_samples *pixels, bool keeps_colours,
           struct glint_kept_options *options, struct glint_error *error)
{
    struct glint_oiio_options how = {.quality = options->quality,
                                     .drop_colours = !keeps_colours};
    const struct glint_oiio *oiio;
    enum glint_status status = find_functions(
        &oiio, out->name, out->name, k->oiio ? NULL : options->said, error);
    void *data;
    size_t bytes;

    if (!status)
        status = oiio->encode_file(&data, &bytes, out->name, k->file, pixels,
                                   &how, error);
    if (status)
        return status;
    if (*how.said)
        append_to_notes(options->said, how.said);
    status = glint_output_write(out, data, bytes, error);
    free(data);
    return status;
}

/* Writes the samples FROM to OUT, converted to the file type of OUT's name,
 * with the metadata of K. Lists in options->said the content that the
 * conversion loses. */
static enum glint_status
save_in_other_file_type(struct glint_kept *k, struct glint_output *out,
                        const struct glint_samples *from,
                        struct glint_kept_options *options,
                        struct glint_error *error)
{
    const struct file_type *const type = find_type_of_extension(out->name);
    struct glint_samples to;
    enum glint_status status;
    bool keeps_colours;
    char text[48];

    if (!type)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, out->name,
                                  "is of a type that glint cannot write");
    status = convert_samples_for_type(k, &to, from, type, &keeps_colours);
    if (status)
        return report_memory_shortage(error, out->name, to.width, to.height);
    report_losses(options, &to, from);
    if (k->metadata && *k->metadata && !(type->holds & HOLDS_METADATA)) {
        snprintf(text, sizeof text, "%s has no %s", type->extension,
                 k->metadata);
        append_to_notes(options->said, text);
    }
    status = type->is_native
                 ? write_native_file(out, &to, type, error)
                 : write_kept(k, out, &to, keeps_colours, options, error);
    free(to.mem);
    return status;
}

enum glint_status glint_kept_save(struct glint_kept *kept, const char *path,
                                  const struct glint_samples *alone,
                                  struct glint_kept_options *options,
                                  struct glint_error *error)
{
    struct glint_output out;
    enum glint_status status = glint_kept_check(path, error);

    options->said[0] = '\0';
    if (!status)
        status = glint_output_open(&out, path, GLINT_OUTPUT_BINARY, error);
    if (status)
        return status;
    if (alone || !glint_kept_is_same_type(kept, path)) {
        status = save_in_other_file_type(
            kept, &out, alone ? alone : &kept->samples, options, error);
    } else if (kept->oiio) {
        status = write_kept(kept, &out, NULL, true, options, error);
    } else {
        update_native_file(kept);
        status =
            glint_output_write(&out, kept->native, kept->native_bytes, error);
    }
    return glint_output_commit_or_abort(&out, status, error);
}
