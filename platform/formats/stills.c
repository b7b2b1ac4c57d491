/* SPDX-License-Identifier: MIT */
#include "formats/stills.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/still_codec.h"
#include "glint/image.h"
#include "posix/error.h"
#include "posix/input.h"

static const struct still_codec *const codecs[] = {&glint_still_jpeg,
                                                   &glint_still_png};

/* ------------------------------------------------------------------ memory */

static enum glint_status report_memory_shortage(const char *path,
                                                struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_MEMORY, path,
                              "not enough memory for the picture");
}

static enum glint_status report_unknown_type(const char *path,
                                             struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                              STILL_NEEDS_PLUGIN);
}

static void close_still(struct still_file *file)
{
    if (!file)
        return;
    free(file->data);
    free(file->pixels.mem);
    free(file->icc);
    free(file);
}

static void close_file(struct glint_oiio_file *file)
{
    close_still((struct still_file *)file);
}

/* -------------------------------------------------------------------- types */

static bool has_extension_of(const struct still_codec *codec, const char *path)
{
    const char *const slash = strrchr(path, '/');
    const char *const dot = strrchr(slash ? slash : path, '.');

    for (int i = 0; dot && codec->type && codec->extensions[i]; i++)
        if (strcasecmp(dot, codec->extensions[i]) == 0)
            return true;
    return false;
}

static const struct still_codec *find_codec_of_path(const char *path)
{
    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
        if (has_extension_of(codecs[i], path))
            return codecs[i];
    return NULL;
}

static int can_write(const char *path)
{
    return find_codec_of_path(path) != NULL;
}

static int is_same_type(const struct glint_oiio_file *file, const char *path)
{
    return has_extension_of(((const struct still_file *)file)->codec, path);
}

/* -------------------------------------------------------------------- Exif */

enum { EXIF_SHORT = 3, EXIF_LONG = 4, EXIF_RATIONAL = 5 }; /* types of tags */

/* Returns N bytes at offset AT of Exif as a number in its byte order, 0 after
 * its end. */
static uint32_t read_exif_number(const uint8_t *exif, size_t bytes, size_t at,
                                 size_t n)
{
    uint32_t value = 0;

    if (bytes < n || at > bytes - n)
        return 0;
    for (size_t i = 0; i < n; i++)
        value = value << 8 | exif[at + (exif[0] == 'I' ? n - 1 - i : i)];
    return value;
}

/* Returns the offset in Exif of the value, or of its offset, of TAG with TYPE
 * in the directory at offset FIRST; 0 if it has none. Sets END to the offset
 * behind the entries of the directory. */
static size_t find_exif_tag(const uint8_t *exif, size_t bytes, size_t first,
                            unsigned tag, unsigned type, size_t *end)
{
    const size_t n = read_exif_number(exif, bytes, first, 2);
    size_t found = 0;

    *end = first + 2 + 12 * n;
    for (size_t at = first + 2; at < *end && at + 12 <= bytes; at += 12)
        if (read_exif_number(exif, bytes, at, 2) == tag &&
            read_exif_number(exif, bytes, at + 2, 2) == type)
            found = at + 8;
    return found;
}

static size_t find_orientation(const uint8_t *exif, size_t bytes, size_t *end)
{
    return find_exif_tag(exif, bytes, read_exif_number(exif, bytes, 4, 4),
                         0x0112, EXIF_SHORT, end);
}

static int get_orientation(const struct still_file *file)
{
    size_t end, at;
    uint32_t value;

    if (!file->exif)
        return 1;
    at = find_orientation(file->exif, file->exif_bytes, &end);
    value = at ? read_exif_number(file->exif, file->exif_bytes, at, 2) : 1;
    return value >= 1 && value <= 8 ? (int)value : 1;
}

/* Returns the value of TAG, a fraction, in the directory at offset FIRST, or 0.
 */
static double read_exif_fraction(const struct still_file *file, size_t first,
                                 unsigned tag)
{
    const uint8_t *const exif = file->exif;
    const size_t bytes = file->exif_bytes;
    size_t end,
        at = find_exif_tag(exif, bytes, first, tag, EXIF_RATIONAL, &end);
    uint32_t divisor;

    at = at ? read_exif_number(exif, bytes, at, 4) : bytes;
    divisor = read_exif_number(exif, bytes, at + 4, 4);
    return divisor ? read_exif_number(exif, bytes, at, 4) / (double)divisor : 0;
}

static void describe_camera(const struct still_file *file,
                            struct glint_oiio_facts *facts)
{
    const uint8_t *const exif = file->exif;
    const size_t bytes = file->exif_bytes;
    size_t end, at;

    if (!exif)
        return;
    at = find_exif_tag(exif, bytes, read_exif_number(exif, bytes, 4, 4), 0x8769,
                       EXIF_LONG, &end);
    if (!at)
        return;
    at = read_exif_number(exif, bytes, at, 4);
    facts->f_number = read_exif_fraction(file, at, 0x829d);
    facts->focal_mm = read_exif_fraction(file, at, 0x920a);
    at = find_exif_tag(exif, bytes, at, 0xa405, EXIF_SHORT, &end);
    facts->film_focal_mm = at ? read_exif_number(exif, bytes, at, 2) : 0;
}

/* Removes the preview, which is in the directory whose offset is at AT, from
 * Exif. */
static void remove_preview(uint8_t *exif, size_t *bytes, size_t at)
{
    const size_t first = read_exif_number(exif, *bytes, at, 4);
    size_t end, start, n;

    start = find_exif_tag(exif, *bytes, first, 0x0201, EXIF_LONG, &end);
    n = find_exif_tag(exif, *bytes, first, 0x0202, EXIF_LONG, &end);
    start = start ? read_exif_number(exif, *bytes, start, 4) : 0;
    n = n ? read_exif_number(exif, *bytes, n, 4) : 0;
    memset(exif + at, 0, 4);
    if (start < at + 4 || start > *bytes || n > *bytes - start)
        return;
    memset(exif + start, 0, n);
    if (start + n == *bytes)
        *bytes = start;
}

/* Returns a malloc'ed copy of FILE's Exif for an upright picture, without
 * preview, and sets BYTES to its size; NULL if memory is short. */
static uint8_t *copy_exif_upright(const struct still_file *file, size_t *bytes)
{
    uint8_t *const exif = malloc(file->exif_bytes);
    size_t end, at;

    if (!exif)
        return NULL;
    *bytes = file->exif_bytes;
    memcpy(exif, file->exif, *bytes);
    at = find_orientation(exif, *bytes, &end);
    if (at) {
        exif[at] = exif[0] == 'I';
        exif[at + 1] = exif[0] != 'I';
    }
    if (*bytes >= 4 && end <= *bytes - 4)
        remove_preview(exif, bytes, end);
    return exif;
}

/* ----------------------------------------------------------------- reading */

/* Appends to FILE's note that PIECE with CONTENT is dropped. */
static void note_dropped_piece(struct still_file *file,
                               const struct still_piece *piece,
                               enum still_content content)
{
    char text[64];

    if (content == STILL_EXTRA) {
        glint_still_add_note(file, "only its first picture is written, without "
                                   "gain map, video and preview");
        return;
    }
    snprintf(text, sizeof text, "%s, valid only for its pixels, is dropped",
             piece->marker ? "APP11 (C2PA, JUMBF)" : piece->name);
    glint_still_add_note(file, text);
}

/* Finds metadata in FILE. Appends to its note content that is dropped. */
static void scan_metadata(struct still_file *file)
{
    bool is_noted[STILL_OTHER + 1] = {false};
    const struct still_codec *const codec = file->codec;
    const size_t head = codec->exif_head_bytes;
    struct still_piece piece;

    for (size_t at = 0;
         codec->next_piece(&piece, file->data, file->bytes, &at);) {
        const enum still_content content = codec->classify(&piece);

        if (content == STILL_EXIF && !file->exif &&
            piece.data_bytes >= head + 8) {
            file->exif = piece.data + head;
            file->exif_bytes = piece.data_bytes - head;
        }
        file->has_other |= content == STILL_OTHER;
        if ((content == STILL_EXTRA || content == STILL_BOUND) &&
            !is_noted[content])
            note_dropped_piece(file, &piece, content);
        is_noted[content] = true;
    }
}

/* Opens PATH, of the type of its first bytes. Changes nothing on failure. */
static enum glint_status read_file(struct still_file **file, const char *path,
                                   struct glint_error *error)
{
    struct still_file *const f = calloc(1, sizeof *f);
    enum glint_status status;

    if (!f)
        return report_memory_shortage(path, error);
    f->path = path;
    status = glint_input_read_whole_file(&f->data, &f->bytes, path,
                                         SIZE_MAX / 4, error);
    if (!status) {
        f->codec = f->bytes > 0 && f->data[0] == 0xff ? &glint_still_jpeg
                                                      : &glint_still_png;
        status = f->codec->type ? f->codec->decode(f, error)
                                : report_unknown_type(path, error);
    }
    if (status) {
        close_still(f);
        return status;
    }
    scan_metadata(f);
    *file = f;
    return GLINT_OK;
}

static void fill_samples(struct glint_samples *s, struct still_file *file)
{
    const struct still_pixels *const p = &file->pixels;
    const enum glint_sample sample =
        p->sample_bytes == 2 ? GLINT_SAMPLE_U16 : GLINT_SAMPLE_U8;
    const size_t bytes = (size_t)p->sample_bytes;

    *s = (struct glint_samples){
        .width = p->width,
        .height = p->height,
        .window_width = p->width,
        .window_height = p->height,
        .orientation = get_orientation(file),
        .pixel_bytes = bytes * (size_t)p->channels,
        .n_colours = p->channels < 3 ? 1 : 3,
        .has_alpha = p->channels % 2 == 0,
        .alpha = {sample, bytes * (size_t)(p->channels - 1)},
        .maximum = sample == GLINT_SAMPLE_U16 ? UINT16_MAX : UINT8_MAX,
        .mem = p->mem};
    for (int c = 0; c < 3; c++)
        s->colour[c] = (struct glint_sample_place){
            sample, p->channels < 3 ? 0 : bytes * (size_t)c};
}

static const char *name_metadata(const struct still_file *file)
{
    if (file->has_other)
        return file->exif ? "Exif, XMP, text or resolution"
                          : "XMP, text or resolution";
    return file->exif ? "Exif" : "";
}

static enum glint_status open_file(struct glint_oiio_file **file,
                                   struct glint_samples *samples,
                                   struct glint_oiio_facts *facts,
                                   const char *path, struct glint_error *error)
{
    struct still_file *f = NULL;
    const enum glint_status status = read_file(&f, path, error);

    if (!f)
        return status;
    *facts = (struct glint_oiio_facts){
        .icc = f->icc, .icc_bytes = f->icc_bytes, .metadata = name_metadata(f)};
    snprintf(facts->note, sizeof facts->note, "%s", f->note);
    describe_camera(f, facts);
    if (f->codec->describe)
        f->codec->describe(f, facts);
    fill_samples(samples, f);
    *file = (struct glint_oiio_file *)f;
    return GLINT_OK;
}

static enum glint_status read_pixels(struct glint_oiio_pixels *pixels,
                                     const char *path,
                                     struct glint_error *error)
{
    struct still_file *file = NULL;
    enum glint_status status = read_file(&file, path, error);
    struct glint_samples from, to = {.n_colours = 3,
                                     .pixel_bytes = 3,
                                     .colour = {{GLINT_SAMPLE_U8, 0},
                                                {GLINT_SAMPLE_U8, 1},
                                                {GLINT_SAMPLE_U8, 2}},
                                     .maximum = UINT8_MAX};

    if (!file)
        return status;
    fill_samples(&from, file);
    /* Like OpenImageIO, multiplies codes by alpha, not linear light. */
    glint_colours_set_bt709(&from.colours, GLINT_TONE_IS_LINEAR, 0, "codes");
    to.colours = from.colours;
    to.width = glint_samples_get_width(&from);
    to.height = glint_samples_get_height(&from);
    to.mem = malloc((size_t)to.width * (size_t)to.height * to.pixel_bytes);
    if (to.mem)
        glint_samples_convert(&to, &from);
    else
        status = report_memory_shortage(path, error);
    *pixels = (struct glint_oiio_pixels){
        .width = to.width, .height = to.height, .rgb = to.mem};
    close_still(file);
    return status;
}

/* ----------------------------------------------------------------- writing */

/* Sets DATA to the bytes TO, or frees them if writing has failed. */
static enum glint_status finish(void **data, size_t *bytes,
                                struct still_bytes *to,
                                enum glint_status status, const char *path,
                                struct glint_error *error)
{
    if (!status && to->is_short)
        status = report_memory_shortage(path, error);
    if (status) {
        free(to->mem);
        return status;
    }
    *data = to->mem;
    *bytes = to->n;
    return GLINT_OK;
}

/* Uses the quality that OpenImageIO uses for files without an original. */
static enum glint_status encode(void **data, size_t *bytes, const char *path,
                                const struct glint_oiio_pixels *pixels,
                                ptrdiff_t stride_bytes,
                                struct glint_error *error)
{
    const struct still_codec *const codec = find_codec_of_path(path);
    const size_t row = 3 * (size_t)pixels->width;
    struct still_pixels p = {.width = pixels->width,
                             .height = pixels->height,
                             .channels = 3,
                             .sample_bytes = 1};
    struct still_bytes to = {.mem = NULL};
    enum glint_status status;

    if (!codec || pixels->is_float)
        return report_unknown_type(path, error);
    p.mem = malloc(row * (size_t)p.height);
    if (!p.mem)
        return report_memory_shortage(path, error);
    for (int y = 0; y < p.height; y++)
        memcpy(p.mem + (size_t)y * row,
               (const uint8_t *)pixels->rgb + y * stride_bytes, row);
    status = codec->encode(
        &to, path, &(struct still_source){.pixels = &p, .quality = 98}, error);
    free(p.mem);
    return finish(data, bytes, &to, status, path, error);
}

/* Returns whether a piece of FILE with CONTENT is copied to a new file of its
 * type with the coding of MADE. */
static bool is_copied(const struct still_file *file, enum still_content content,
                      const struct still_bytes *made)
{
    /* A PNG states bits and channels behind its size. */
    const bool same = file->codec != &glint_still_png ||
                      memcmp(made->mem + 24, file->data + 24, 2) == 0;

    return content == STILL_EXIF || content == STILL_COLOURS ||
           content == STILL_OTHER || (content == STILL_CODED && same);
}

/* Appends MADE, a file without metadata, with those of FILE, of its type. */
static void append_with_metadata(struct still_bytes *to,
                                 const struct still_bytes *made,
                                 const struct still_file *file)
{
    const size_t head = file->codec->head_bytes;
    struct still_piece piece;

    glint_still_append(to, made->mem, head);
    for (size_t at = 0;
         file->codec->next_piece(&piece, file->data, file->bytes, &at);)
        if (is_copied(file, file->codec->classify(&piece), made))
            glint_still_append(to, piece.whole, piece.whole_bytes);
    glint_still_append(to, made->mem + head, made->n - head);
}

/* Encodes FILE in its own type with all of its metadata. */
static enum glint_status encode_same(struct still_bytes *to, const char *path,
                                     const struct still_file *file,
                                     struct glint_oiio_options *options,
                                     struct glint_error *error)
{
    struct still_bytes made = {.mem = NULL};
    enum glint_status status =
        file->codec->encode(&made, path,
                            &(struct still_source){.pixels = &file->pixels,
                                                   .quality = options->quality,
                                                   .like = file,
                                                   .said = options->said},
                            error);

    if (!status && made.is_short)
        status = report_memory_shortage(path, error);
    if (!status)
        append_with_metadata(to, &made, file);
    free(made.mem);
    return status;
}

/* Lists in options->said the metadata of FILE that another file type or other
 * pixels lose. */
static void report_lost_metadata(struct glint_oiio_options *options,
                                 const struct still_file *file,
                                 const struct still_codec *codec)
{
    if (file->exif_bytes > codec->exif_max_bytes)
        snprintf(options->said, sizeof options->said,
                 "no Exif: its %zu KB are more than a JPEG's 64 KB",
                 (file->exif_bytes + 1023) / 1024);
    else if (file->has_other)
        snprintf(options->said, sizeof options->said,
                 "of its metadata only Exif and ICC profile are written; the "
                 "image plug-in (OpenImageIO) also writes XMP, texts and "
                 "resolution");
}

/* Encodes PIXELS in the type of CODEC with Exif and ICC profile of FILE, which
 * may be NULL. */
static enum glint_status encode_other(struct still_bytes *to, const char *path,
                                      const struct still_codec *codec,
                                      const struct still_file *file,
                                      const struct glint_samples *pixels,
                                      struct glint_oiio_options *options,
                                      struct glint_error *error)
{
    const size_t sample_bytes =
        glint_sample_get_bytes(pixels->colour[0].sample);
    const struct still_pixels p = {
        .width = pixels->width,
        .height = pixels->height,
        .channels = (int)(pixels->pixel_bytes / sample_bytes),
        .sample_bytes = (int)sample_bytes,
        .mem = pixels->mem};
    struct still_source from = {
        .pixels = &p, .quality = options->quality ? options->quality : 95};
    uint8_t *exif = NULL;
    enum glint_status status;

    if (file)
        report_lost_metadata(options, file, codec);
    if (file && !options->drop_colours) {
        from.icc = file->icc;
        from.icc_bytes = file->icc_bytes;
    }
    if (file && file->exif && file->exif_bytes <= codec->exif_max_bytes) {
        from.exif = exif = copy_exif_upright(file, &from.exif_bytes);
        if (!exif)
            return report_memory_shortage(path, error);
    }
    status = codec->encode(to, path, &from, error);
    free(exif);
    return status;
}

static enum glint_status
encode_file(void **data, size_t *bytes, const char *path,
            struct glint_oiio_file *file, const struct glint_samples *pixels,
            struct glint_oiio_options *options, struct glint_error *error)
{
    const struct still_codec *const codec = find_codec_of_path(path);
    struct still_file *const f = (struct still_file *)file;
    struct still_bytes to = {.mem = NULL};
    enum glint_status status;

    options->said[0] = '\0';
    if (!codec)
        return report_unknown_type(path, error);
    status = pixels ? encode_other(&to, path, codec, f, pixels, options, error)
                    : encode_same(&to, path, f, options, error);
    return finish(data, bytes, &to, status, path, error);
}

static enum glint_status encode_layers(void **data, size_t *bytes,
                                       const char *path,
                                       const struct glint_oiio_layers *layers,
                                       struct glint_error *error)
{
    (void)data, (void)bytes, (void)layers;
    return report_unknown_type(path, error);
}

/* Neither library aborts. */
static int report_abort(void)
{
    return 0;
}

const struct glint_oiio *glint_stills_find(const char *type)
{
    static const struct glint_oiio face = {
        GLINT_OIIO_VERSION, read_pixels, encode,       open_file,
        close_file,         can_write,   is_same_type, encode_file,
        encode_layers,      report_abort};

    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
        if (codecs[i]->type && (!strcmp(type, codecs[i]->type) ||
                                has_extension_of(codecs[i], type)))
            return &face;
    return NULL;
}
