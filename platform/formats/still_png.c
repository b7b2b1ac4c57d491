/* SPDX-License-Identifier: MIT */
#include "formats/still_codec.h"

#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "posix/error.h"

enum {
    SIGNATURE_BYTES = 8,
    IHDR_BYTES = 25, /* with its length, name and checksum */
    PIECE_BYTES = 12 /* length, name and checksum of a chunk */
};

/* A call of libpng: an error leaves it by longjmp(). */
struct call {
    png_structp png;
    png_infop info;
    const struct still_file *in;
    size_t at; /* offset in the file of the next byte to read */
    struct still_bytes *to;
    struct glint_error *error;
    const char *path;
    enum glint_status status;
    bool is_reading;
};

static void on_error(png_structp png, png_const_charp text)
{
    struct call *const c = png_get_error_ptr(png);

    if (!c->status)
        c->status = glint_error_report(
            c->error, c->is_reading ? GLINT_E_FORMAT : GLINT_E_OUTPUT, c->path,
            "%s", text);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png, (void)text;
}

static void read_bytes(png_structp png, png_bytep to, size_t n)
{
    struct call *const c = png_get_io_ptr(png);

    if (n > c->in->bytes - c->at)
        png_error(png, "is cut off");
    memcpy(to, c->in->data + c->at, n);
    c->at += n;
}

static void write_bytes(png_structp png, png_bytep from, size_t n)
{
    struct call *const c = png_get_io_ptr(png);

    glint_still_append(c->to, from, n);
}

static void flush(png_structp png)
{
    (void)png;
}

static bool is_little_endian(void)
{
    const uint16_t one = 1;

    return *(const uint8_t *)&one == 1;
}

/* Returns false if memory is short. */
static bool create(struct call *c)
{
    c->png = c->is_reading ? png_create_read_struct(PNG_LIBPNG_VER_STRING, c,
                                                    on_error, on_warning)
                           : png_create_write_struct(PNG_LIBPNG_VER_STRING, c,
                                                     on_error, on_warning);
    c->info = c->png ? png_create_info_struct(c->png) : NULL;
    if (!c->info)
        c->status = glint_error_report(c->error, GLINT_E_MEMORY, c->path,
                                       "not enough memory");
    return c->info != NULL;
}

static size_t count_row_bytes(const struct still_pixels *p)
{
    return (size_t)p->width * (size_t)p->channels * (size_t)p->sample_bytes;
}

/* ------------------------------------------------------------------ chunks */

static uint32_t read_big32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 |
           (uint32_t)at[2] << 8 | at[3];
}

static bool next_piece(struct still_piece *piece, const uint8_t *data,
                       size_t bytes, size_t *at)
{
    const size_t i = *at ? *at : SIGNATURE_BYTES;
    size_t n;

    if (i + PIECE_BYTES > bytes)
        return false;
    n = read_big32(data + i);
    if (n > bytes - i - PIECE_BYTES)
        return false;
    *piece = (struct still_piece){.whole = data + i,
                                  .whole_bytes = n + PIECE_BYTES,
                                  .data = data + i + 8,
                                  .data_bytes = n};
    memcpy(piece->name, data + i + 4, 4);
    *at = i + piece->whole_bytes;
    return strcmp(piece->name, "IEND") != 0;
}

/* ----------------------------------------------------------------- reading */

/* Lets libpng convert pixels to 1 to 4 channels of 8 or 16 bits. */
static void set_conversions(struct call *c)
{
    png_set_expand(c->png); /* palettes, fewer bits, transparent colours */
    if (is_little_endian())
        png_set_swap(c->png);
}

static void read_icc(struct call *c, struct still_file *file)
{
    png_charp name;
    png_bytep icc;
    png_uint_32 n;
    int compression;

    if (!png_get_iCCP(c->png, c->info, &name, &compression, &icc, &n))
        return;
    file->icc = malloc(n);
    if (!file->icc)
        png_error(c->png, "not enough memory");
    memcpy(file->icc, icc, n);
    file->icc_bytes = n;
}

static void read_rows(struct call *c, struct still_file *file)
{
    struct still_pixels *const p = &file->pixels;
    int passes;

    png_set_read_fn(c->png, c, read_bytes);
    png_set_user_limits(c->png, GLINT_MAX_SIDE, GLINT_MAX_SIDE);
    png_read_info(c->png, c->info);
    set_conversions(c);
    passes = png_set_interlace_handling(c->png);
    png_read_update_info(c->png, c->info);
    *p = (struct still_pixels){
        .width = (int)png_get_image_width(c->png, c->info),
        .height = (int)png_get_image_height(c->png, c->info),
        .channels = png_get_channels(c->png, c->info),
        .sample_bytes = png_get_bit_depth(c->png, c->info) / 8};
    c->status = glint_still_allocate(file, c->error);
    if (c->status)
        png_longjmp(c->png, 1);
    while (passes-- > 0)
        for (int y = 0; y < p->height; y++)
            png_read_row(c->png, p->mem + (size_t)y * count_row_bytes(p), NULL);
    png_read_end(c->png, NULL);
    glint_still_note_rest(file, file->bytes - c->at);
    read_icc(c, file);
}

/* Returns whether all chunks end in the file. libpng allocates and clears the
 * memory for a chunk, up to 2 GiB, before it reads the chunk. */
static bool has_whole_chunks(const struct still_file *file)
{
    struct still_piece piece = {.name = ""};
    size_t at = 0;

    while (next_piece(&piece, file->data, file->bytes, &at)) {
    }
    return strcmp(piece.name, "IEND") == 0;
}

static enum glint_status decode(struct still_file *file,
                                struct glint_error *error)
{
    struct call c = {
        .in = file, .path = file->path, .error = error, .is_reading = true};

    if (file->bytes >= SIGNATURE_BYTES &&
        png_sig_cmp(file->data, 0, SIGNATURE_BYTES) == 0 &&
        !has_whole_chunks(file))
        return glint_error_report(error, GLINT_E_FORMAT, file->path,
                                  "is cut off");
    if (create(&c)) {
        if (setjmp(png_jmpbuf(c.png)) == 0)
            read_rows(&c, file);
    }
    png_destroy_read_struct(&c.png, &c.info, NULL);
    return c.status;
}

/* ----------------------------------------------------------------- writing */

static void write_metadata(struct call *c, const struct still_source *from)
{
    if (from->like) /* Its own metadata will be added. */
        return;
    if (from->icc)
        png_set_iCCP(c->png, c->info, "ICC profile", PNG_COMPRESSION_TYPE_BASE,
                     from->icc, (png_uint_32)from->icc_bytes);
    else
        png_set_sRGB(c->png, c->info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (from->icc && !png_get_valid(c->png, c->info, PNG_INFO_iCCP))
        png_error(c->png, "libpng rejects the ICC profile of the picture; "
                          "write .jpg, or use glint's image plug-in");
    if (from->exif)
        png_set_eXIf_1(c->png, c->info, (png_uint_32)from->exif_bytes,
                       from->exif);
}

static void write_file(struct call *c, const struct still_source *from)
{
    static const int colour_types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GA,
                                       PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    const struct still_pixels *const p = from->pixels;

    png_set_write_fn(c->png, c, write_bytes, flush);
    png_set_IHDR(c->png, c->info, (png_uint_32)p->width, (png_uint_32)p->height,
                 8 * p->sample_bytes, colour_types[p->channels - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    write_metadata(c, from);
    png_write_info(c->png, c->info);
    if (p->sample_bytes == 2 && is_little_endian())
        png_set_swap(c->png);
    for (int y = 0; y < p->height; y++)
        png_write_row(c->png, p->mem + (size_t)y * count_row_bytes(p));
    png_write_end(c->png, c->info);
}

static enum glint_status encode(struct still_bytes *to, const char *path,
                                const struct still_source *from,
                                struct glint_error *error)
{
    struct call c = {.to = to, .path = path, .error = error};

    if (create(&c)) {
        if (setjmp(png_jmpbuf(c.png)) == 0)
            write_file(&c, from);
    }
    png_destroy_write_struct(&c.png, &c.info);
    return c.status;
}

/* ---------------------------------------------------------------- metadata */

static enum still_content classify(const struct still_piece *piece)
{
    static const struct {
        const char *name;
        enum still_content content;
    } chunks[] = {
        {"tRNS", STILL_CODING},  {"hIST", STILL_CODING},
        {"sBIT", STILL_CODED},   {"bKGD", STILL_CODED},
        {"acTL", STILL_EXTRA},   {"fcTL", STILL_EXTRA},
        {"fdAT", STILL_EXTRA},   {"eXIf", STILL_EXIF},
        {"iCCP", STILL_COLOURS}, {"gAMA", STILL_COLOURS},
        {"cHRM", STILL_COLOURS}, {"sRGB", STILL_COLOURS},
        {"cICP", STILL_COLOURS}, {"mDCv", STILL_COLOURS},
        {"cLLi", STILL_COLOURS}, {"tIME", STILL_OTHER},
        {"sCAL", STILL_OTHER},   {"sTER", STILL_OTHER},
    };

    if (!(piece->name[0] & 0x20)) /* a critical chunk */
        return STILL_CODING;
    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++)
        if (strcmp(piece->name, chunks[i].name) == 0)
            return chunks[i].content;
    /* The fourth letter states whether an unknown chunk stays valid if pixels
     * change. */
    return piece->name[3] & 0x20 ? STILL_OTHER : STILL_BOUND;
}

static void describe(const struct still_file *file,
                     struct glint_oiio_facts *facts)
{
    struct still_piece piece;
    bool is_srgb = false;

    for (size_t at = 0; next_piece(&piece, file->data, file->bytes, &at);) {
        const uint8_t *const d = piece.data;

        if (!strcmp(piece.name, "sRGB")) {
            is_srgb = true;
        } else if (!strcmp(piece.name, "cICP") && piece.data_bytes == 4) {
            facts->cicp[0] = d[0];
            facts->cicp[1] = d[1];
        } else if (!strcmp(piece.name, "gAMA") && piece.data_bytes == 4) {
            facts->gamma = read_big32(d) ? 1e5 / read_big32(d) : 0;
        } else if (!strcmp(piece.name, "cHRM") && piece.data_bytes == 32) {
            facts->has_primaries = true;
            for (int i = 0; i < 8; i++) /* The chunk begins with white. */
                facts->primaries[(i / 2 + 3) % 4][i % 2] =
                    read_big32(d + 4 * i) * 1e-5;
        } else if (!strcmp(piece.name, "iCCP") && !file->icc) {
            snprintf(facts->colour_space, sizeof facts->colour_space,
                     "its ICC profile");
        }
    }
    if (is_srgb) {
        facts->gamma = 0;
        facts->has_primaries = false;
    }
}

const struct still_codec glint_still_png = {
    .type = "PNG",
    .extensions = {".png"},
    .decode = decode,
    .encode = encode,
    .next_piece = next_piece,
    .classify = classify,
    .head_bytes = SIGNATURE_BYTES + IHDR_BYTES,
    .exif_max_bytes = 0x7fffffff,
    .describe = describe,
};
