/* SPDX-License-Identifier: MIT
 *
 * Reads and writes YUV4MPEG2 streams, and adds light to their frames
 * (video/y4m.h). */
#include "video/y4m.h"

#include <assert.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "posix/ending.h"
#include "posix/error.h"
#include "video/y4m_divide.h"

#define MAGIC "YUV4MPEG2"

/* ------------------------------------------------------------------ layout */

static const struct colour {
    const char *tag;
    enum glint_pixel_format format;
    bool has_alpha, is_411, may_be_deep;
} colours[] = {
    /* Formats by the value of the tag C. glint writes the first tag of each
     * format (find_layout_tag()). */
    {"420jpeg", GLINT_I420, false, false, false},
    {"420mpeg2", GLINT_I420, false, false, false},
    {"420paldv", GLINT_I420, false, false, false},
    {"420", GLINT_I420, false, false, true},
    {"422", GLINT_I422, false, false, true},
    {"411", GLINT_I422, false, true, false},
    {"444", GLINT_I444, false, false, true},
    {"444alpha", GLINT_I444, true, false, false},
    {"mono", GLINT_GREY, false, false, true},
};

#define N_COLOURS (sizeof colours / sizeof *colours)

/* Returns the bits per sample, 9 .. 16, that TEXT, the end of a tag, states; 8
 * if TEXT is empty, 0 if it is malformed. */
static int parse_bits_per_sample(const char *text, bool is_grey)
{
    static const char *const names[] = {"9", "10", "12", "14", "16"};
    static const int bits[] = {9, 10, 12, 14, 16};

    if (!*text)
        return 8;
    if (!is_grey && *text++ != 'p')
        return 0;
    for (size_t i = 0; i < sizeof bits / sizeof *bits; i++)
        if (strcmp(text, names[i]) == 0)
            return bits[i];
    return 0;
}

/* Sets LAYOUT from TAG; an empty TAG means 420jpeg. Returns false if TAG is
 * unknown. */
static bool parse_layout_tag(struct glint_y4m_layout *layout, const char *tag)
{
    const char *const text = *tag ? tag : colours[0].tag;

    for (size_t i = 0; i < N_COLOURS; i++) {
        const struct colour *const c = &colours[i];
        const size_t n = strlen(c->tag);
        const int bits =
            strncmp(text, c->tag, n) == 0
                ? parse_bits_per_sample(text + n, c->format == GLINT_GREY)
                : 0;

        if (bits == 0 || (bits > 8 && !c->may_be_deep))
            continue;
        *layout =
            (struct glint_y4m_layout){c->format, bits, c->has_alpha, c->is_411};
        return true;
    }
    return false;
}

/* Returns the value of tag C that glint writes for FORMAT: _GREY, _I420, _I422
 * or _I444. */
static const char *find_layout_tag(enum glint_pixel_format format)
{
    size_t i = 0;

    while (colours[i].format != format)
        i++;
    return colours[i].tag;
}

bool glint_y4m_is_8_bit_bt709(const struct glint_y4m_header *header)
{
    return header->layout.bits == 8 && !header->layout.is_411 &&
           header->transfer == GLINT_TRANSFER_BT709 &&
           header->primaries == GLINT_PRIMARIES_BT709;
}

/* Sets SIZE to the number of samples across and down in PLANE, 0 .. 3, or to 0
 * and 0 if there is no such plane. */
static void compute_plane_size(const struct glint_y4m_layout *layout, int plane,
                               int width, int height, int size[2])
{
    const enum glint_pixel_format format = layout->format;
    const bool is_chroma = plane == 1 || plane == 2;
    const int across = layout->is_411 ? 4 : format == GLINT_I444 ? 1 : 2;
    const int down = format == GLINT_I420 ? 2 : 1;

    size[0] = is_chroma ? (width + across - 1) / across : width;
    size[1] = is_chroma ? (height + down - 1) / down : height;
    if ((is_chroma && format == GLINT_GREY) ||
        (plane == 3 && !layout->has_alpha))
        size[0] = size[1] = 0;
}

size_t glint_y4m_layout_bytes(const struct glint_y4m_layout *layout, int width,
                              int height)
{
    size_t samples = 0;

    for (int p = 0; p < 4; p++) {
        int size[2];

        compute_plane_size(layout, p, width, height, size);
        samples += (size_t)size[0] * (size_t)size[1];
    }
    return samples * (layout->bits > 8 ? 2 : 1);
}

/* ------------------------------------------------------------------ planes */

struct plane {
    uint8_t *at;
    int size[2];
    bool is_wide;
};

static void locate_planes(const struct glint_y4m_layout *layout, int width,
                          int height, uint8_t *planes, struct plane plane[4])
{
    for (int p = 0; p < 4; p++) {
        compute_plane_size(layout, p, width, height, plane[p].size);
        plane[p].is_wide = layout->bits > 8;
        plane[p].at = planes;
        planes += (size_t)plane[p].size[0] * (size_t)plane[p].size[1] *
                  (plane[p].is_wide ? 2 : 1);
    }
}

static int32_t read_sample_code(const struct plane *p, int x, int y)
{
    const size_t i = (size_t)y * (size_t)p->size[0] + (size_t)x;

    return p->is_wide ? p->at[2 * i] | p->at[2 * i + 1] << 8 : p->at[i];
}

static void write_sample_code(const struct plane *p, int x, int y, int32_t code)
{
    const size_t i = (size_t)y * (size_t)p->size[0] + (size_t)x;

    if (p->is_wide) {
        p->at[2 * i] = (uint8_t)code;
        p->at[2 * i + 1] = (uint8_t)(code >> 8);
    } else {
        p->at[i] = (uint8_t)code;
    }
}

/* Fills IMAGE, of LAYOUT's format, with the stored planes PLANES reduced to 8
 * bits. */
static void fill_8_bit_copy(const struct glint_y4m_layout *layout,
                            const struct glint_image *image,
                            const uint8_t *planes)
{
    const int down = layout->bits - 8;
    struct plane plane[4];

    locate_planes(layout, image->width, image->height, (uint8_t *)planes,
                  plane);
    for (int p = 0; p < glint_image_planes(image->format); p++) {
        const int width =
            (int)glint_image_row_bytes(image->format, p, image->width);
        const int height =
            glint_image_plane_height(image->format, p, image->height);

        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const int from = layout->is_411 && p > 0 ? x / 2 : x;
                const int32_t code =
                    read_sample_code(&plane[p], from, y) >> down;

                image->plane[p][y * image->stride_bytes[p] + x] =
                    (uint8_t)(code < 255 ? code : 255);
            }
    }
}

/* ------------------------------------------------------------------ header */

static enum glint_matrix choose_matrix(int height)
{
    return height < 720 ? GLINT_MATRIX_BT601 : GLINT_MATRIX_BT709;
}

/* Returns whether the matrix is BT.601 in pictures of any size, as in JPEG
 * [JFIF]: the range is full, and the tag C is C420jpeg or missing. */
static bool has_jpeg_colours(const struct glint_y4m_header *h)
{
    return h->range == GLINT_RANGE_FULL &&
           (!*h->colour || !strcmp(h->colour, "420jpeg"));
}

bool glint_y4m_has_extension(const char *name)
{
    return glint_has_extension(name, ".y4m");
}

void glint_y4m_header_init(struct glint_y4m_header *header, int width,
                           int height, enum glint_pixel_format format,
                           int fps_num, int fps_den)
{
    *header = (struct glint_y4m_header){
        .width = width,
        .height = height,
        .format = format,
        .range = GLINT_RANGE_LIMITED,
        .matrix = choose_matrix(height),
        .fps_num = fps_num,
        .fps_den = fps_den,
        .interlace = 'p',
        .aspect = "1:1",
    };
    strcpy(header->colour, find_layout_tag(format));
    (void)parse_layout_tag(&header->layout, header->colour);
}

/* Returns the number at *AT, at most INT_MAX, and moves *AT past it. Returns -1
 * if there is no number. */
static int parse_number(const char **at)
{
    int value = -1;

    for (; **at >= '0' && **at <= '9'; (*at)++) {
        const int digit = **at - '0';

        value = value < 0 ? 0 : value;
        value = value > (INT_MAX - digit) / 10 ? INT_MAX : value * 10 + digit;
    }
    return value;
}

/* Parses TEXT as "N:D" in plain digits. Returns false if TEXT is malformed, or
 * D is 0 and N is not. */
static bool parse_ratio(const char *text, int *num, int *den)
{
    *num = parse_number(&text);
    if (*num < 0 || *text++ != ':')
        return false;
    *den = parse_number(&text);
    return *den >= 0 && !*text && (*den > 0 || *num == 0);
}

/* Returns TEXT as a number, or 0 if any character is not a digit. */
static int parse_side_length(const char *text)
{
    const int value = parse_number(&text);

    return *text || value < 0 ? 0 : value;
}

static bool copy_tag_text(char *dst, size_t size, const char *text)
{
    const bool fits = strlen(text) < size;

    if (fits)
        strcpy(dst, text);
    return fits;
}

static bool parse_colour_range(struct glint_y4m_header *h, const char *tag)
{
    const bool full = !strcmp(tag, "XCOLORRANGE=FULL");

    if (!full && strcmp(tag, "XCOLORRANGE=LIMITED") != 0)
        return false;
    h->range = full ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED;
    h->range_stated = true;
    return true;
}

/* Sets the member of H that TAG of the header line states. Returns false if TAG
 * is malformed. */
static bool parse_header_tag(struct glint_y4m_header *h, const char *tag)
{
    int num, den;

    switch (tag[0]) {
    case 'W':
        return (h->width = parse_side_length(tag + 1)) > 0;
    case 'H':
        return (h->height = parse_side_length(tag + 1)) > 0;
    case 'F':
        return parse_ratio(tag + 1, &h->fps_num, &h->fps_den);
    case 'I':
        h->interlace = tag[1];
        return tag[1] && strchr("ptbm?", tag[1]) && !tag[2];
    case 'A':
        return parse_ratio(tag + 1, &num, &den) &&
               copy_tag_text(h->aspect, sizeof h->aspect, tag + 1);
    case 'C':
        return tag[1] && copy_tag_text(h->colour, sizeof h->colour, tag + 1);
    }
    if (!parse_colour_range(h, tag)) {
        /* All tags fit into EXTRA because the header line is not longer than
         * EXTRA. */
        strcat(h->extra, " ");
        strcat(h->extra, tag);
    }
    return true;
}

static enum glint_status check_stream_header(struct glint_y4m_header *h,
                                             const char *name,
                                             struct glint_error *error)
{
    if (h->width < 1 || h->height < 1)
        return glint_error_report(
            error, GLINT_E_FORMAT, name,
            "no width (W640) or height (H480) in the Y4M header");
    if (h->width > GLINT_MAX_SIDE || h->height > GLINT_MAX_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "larger than %d pixels a side",
                                  GLINT_MAX_SIDE);
    if (!parse_layout_tag(&h->layout, h->colour))
        return glint_error_report(
            error, GLINT_E_UNSUPPORTED, name,
            "C%s is not a supported colour space: 420, 422, 444 (up to p16), "
            "411, 444alpha and mono (up to mono16) are",
            h->colour);
    h->format = h->layout.format;
    return GLINT_OK;
}

static bool is_plain_text(const char *line)
{
    while ((unsigned char)*line >= ' ')
        line++;
    return !*line;
}

enum glint_status glint_y4m_header_parse(struct glint_y4m_header *header,
                                         const char *line, const char *name,
                                         struct glint_error *error)
{
    struct glint_y4m_header h = {.range = GLINT_RANGE_LIMITED};
    char copy[GLINT_Y4M_LINE], *rest = NULL;
    enum glint_status status;

    if (strncmp(line, MAGIC, strlen(MAGIC)) != 0 ||
        (line[strlen(MAGIC)] && line[strlen(MAGIC)] != ' '))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "is not a YUV4MPEG2 stream");
    if (!is_plain_text(line) || !copy_tag_text(copy, sizeof copy, line))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "malformed Y4M header");
    for (char *tag = strtok_r(copy + strlen(MAGIC), " ", &rest); tag;
         tag = strtok_r(NULL, " ", &rest))
        if (!parse_header_tag(&h, tag))
            return glint_error_report(error, GLINT_E_FORMAT, name,
                                      "malformed tag %s in the Y4M header",
                                      tag);
    status = check_stream_header(&h, name, error);
    if (status)
        return status;
    h.matrix =
        has_jpeg_colours(&h) ? GLINT_MATRIX_BT601 : choose_matrix(h.height);
    strcpy(h.line, line); /* fits, as LINE fitted into COPY */
    h.line_range = h.range;
    *header = h;
    return GLINT_OK;
}

size_t glint_y4m_header_print(char line[GLINT_Y4M_PRINTED],
                              const struct glint_y4m_header *header)
{
    const bool full = header->range == GLINT_RANGE_FULL;
    const char interlace[] = {header->interlace, 0};
    const int n = *header->line && header->range == header->line_range
                      ? snprintf(line, GLINT_Y4M_PRINTED, "%s\n", header->line)
                      : snprintf(line, GLINT_Y4M_PRINTED,
                                 MAGIC " W%d H%d F%d:%d%s%s%s%s%s%s%s%s\n",
                                 header->width, header->height, header->fps_num,
                                 header->fps_den, *interlace ? " I" : "",
                                 interlace, *header->aspect ? " A" : "",
                                 header->aspect, *header->colour ? " C" : "",
                                 header->colour, header->extra,
                                 full                   ? " XCOLORRANGE=FULL"
                                 : header->range_stated ? " XCOLORRANGE=LIMITED"
                                                        : "");

    return (size_t)n;
}

/* ----------------------------------------------------------------- reading */

/* Tables that convert frames of a stream that is not BT.709 to an 8-bit BT.709
 * copy. */
struct glint_y4m_seen {
    struct glint_y4m_light from, to;
};

static void fill_bt709_copy(const struct glint_y4m_reader *r);

static ptrdiff_t read_available_bytes(struct glint_y4m_reader *r, void *dst,
                                      size_t bytes)
{
    return r->source ? r->source(r->ctx, dst, bytes)
                     : glint_input_read_available(&r->in, dst, bytes);
}

static enum glint_status report_read_failure(const struct glint_y4m_reader *r,
                                             struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_IO, r->name, "%s",
                              strerror(errno));
}

enum line_end { LINE_FEED, LINE_EOF, LINE_TOO_LONG, LINE_FAILED };

/* Reads a line up to its line feed, which is not stored, or to the end of the
 * stream. Sets *LEN to the number of characters stored. */
static enum line_end read_stream_line(struct glint_y4m_reader *r, char *line,
                                      size_t size, size_t *len)
{
    *len = 0;
    for (;;) {
        if (r->ahead_at == r->ahead_end) {
            const ptrdiff_t n =
                read_available_bytes(r, r->ahead, sizeof r->ahead);

            r->ahead_at = 0;
            r->ahead_end = n > 0 ? (size_t)n : 0;
            if (n <= 0)
                return n < 0 ? LINE_FAILED : LINE_EOF;
        }
        line[*len] = (char)r->ahead[r->ahead_at++];
        if (line[*len] == '\n') {
            line[*len] = 0;
            return LINE_FEED;
        }
        if (++*len == size)
            return LINE_TOO_LONG;
    }
}

/* Reads BYTES, or fewer at the end of the stream. Returns the number of bytes
 * read, or -1 on failure. */
static ptrdiff_t read_stream_bytes(struct glint_y4m_reader *r, uint8_t *dst,
                                   size_t bytes)
{
    const size_t left = r->ahead_end - r->ahead_at;
    size_t got = left < bytes ? left : bytes;

    memcpy(dst, r->ahead + r->ahead_at, got);
    r->ahead_at += got;
    while (got < bytes) {
        const ptrdiff_t n = read_available_bytes(r, dst + got, bytes - got);

        if (n < 0)
            return -1;
        if (n == 0)
            break;
        got += (size_t)n;
    }
    return (ptrdiff_t)got;
}

static enum glint_status read_stream_header(struct glint_y4m_reader *r,
                                            struct glint_error *error)
{
    char line[GLINT_Y4M_LINE];
    size_t len;
    const enum line_end end = read_stream_line(r, line, sizeof line, &len);
    const char *cause = "holds a zero byte in the Y4M header";

    if (end == LINE_FAILED)
        return report_read_failure(r, error);
    if (end == LINE_FEED && strlen(line) == len)
        return glint_y4m_header_parse(&r->header, line, r->name, error);
    if (len == 0)
        cause = "is empty";
    else if (len < strlen(MAGIC) || memcmp(line, MAGIC, strlen(MAGIC)) != 0)
        cause = "is not a YUV4MPEG2 stream";
    else if (end == LINE_EOF)
        cause = "ends inside the Y4M header";
    else if (end == LINE_TOO_LONG)
        cause = "has a Y4M header that is too long";
    return glint_error_report(error, GLINT_E_FORMAT, r->name, "%s", cause);
}

enum glint_status glint_y4m_reader_start(struct glint_y4m_reader *reader,
                                         glint_y4m_source_fn *source, void *ctx,
                                         const char *name,
                                         struct glint_error *error)
{
    memset(reader, 0, sizeof *reader);
    reader->in.fd = -1;
    reader->source = source;
    reader->ctx = ctx;
    reader->name = name;
    return read_stream_header(reader, error);
}

enum glint_status glint_y4m_reader_open(struct glint_y4m_reader *reader,
                                        const char *path,
                                        struct glint_error *error)
{
    enum glint_status status;

    memset(reader, 0, sizeof *reader);
    status = glint_input_open(&reader->in, path, error);
    reader->name = reader->in.name;
    if (!status)
        status = read_stream_header(reader, error);
    if (status)
        glint_y4m_reader_close(reader);
    return status;
}

enum glint_status
glint_y4m_reader_open_raw(struct glint_y4m_reader *reader, const char *path,
                          const struct glint_y4m_header *header, size_t stride,
                          struct glint_error *error)
{
    enum glint_status status;

    memset(reader, 0, sizeof *reader);
    status = glint_input_open(&reader->in, path, error);
    reader->name = reader->in.name;
    reader->header = *header;
    reader->is_raw = true;
    reader->stride = stride;
    if (status)
        glint_y4m_reader_close(reader);
    return status;
}

/* Sets *MORE to whether another frame follows in a stream without FRAME
 * lines. */
static enum glint_status peek_raw_frame(struct glint_y4m_reader *r, bool *more,
                                        struct glint_error *error)
{
    if (r->ahead_at == r->ahead_end) {
        const ptrdiff_t n = read_available_bytes(r, r->ahead, sizeof r->ahead);

        if (n < 0)
            return report_read_failure(r, error);
        r->ahead_at = 0;
        r->ahead_end = (size_t)n;
    }
    *more = r->ahead_end > r->ahead_at;
    return GLINT_OK;
}

/* Reads a frame whose rows are padded to r->stride, and omits the padding.
 * Returns the number of bytes of pixels read, which is less than a frame at the
 * end of the stream, or -1 on failure. */
static ptrdiff_t read_padded_rows(struct glint_y4m_reader *r)
{
    uint8_t *to = r->planes;
    uint8_t padding[4096];

    for (int p = 0; p < 4; p++) {
        size_t stride = r->stride;
        int size[2];

        compute_plane_size(&r->header.layout, p, r->header.width,
                           r->header.height, size);
        if (size[0] < r->header.width)
            stride /= 2;
        for (int y = 0; y < size[1]; y++) {
            const size_t n = (size_t)size[0];
            ptrdiff_t got = read_stream_bytes(r, to, n);

            to += got > 0 ? got : 0;
            if (got < (ptrdiff_t)n)
                return got < 0 ? -1 : to - r->planes;
            for (size_t left = stride - n; left > 0; left -= (size_t)got) {
                got = read_stream_bytes(
                    r, padding, left < sizeof padding ? left : sizeof padding);
                if (got <= 0)
                    break;
            }
            if (got < 0)
                return -1;
        }
    }
    return to - r->planes;
}

static bool differs_from_bt709(const struct glint_y4m_header *h)
{
    return h->transfer != GLINT_TRANSFER_BT709 ||
           h->primaries != GLINT_PRIMARIES_BT709;
}

static struct glint_y4m_seen *
allocate_copy_tables(const struct glint_y4m_header *h)
{
    struct glint_y4m_seen *const seen = malloc(sizeof *seen);
    struct glint_y4m_header to = *h;

    if (!seen)
        return NULL;
    to.transfer = GLINT_TRANSFER_BT709;
    to.primaries = GLINT_PRIMARIES_BT709;
    to.layout = (struct glint_y4m_layout){.format = h->format, .bits = 8};
    glint_y4m_light_init(&seen->from, h);
    glint_y4m_light_init(&seen->to, &to);
    return seen;
}

/* Sets r->frame and allocates its memory. Allocates only at the first frame, so
 * that a program that reads only the header needs no memory. */
static enum glint_status allocate_frame(struct glint_y4m_reader *r,
                                        struct glint_error *error)
{
    const struct glint_y4m_header *const h = &r->header;

    const bool is_plain = glint_y4m_is_8_bit_bt709(h);
    const size_t bytes =
        glint_y4m_layout_bytes(&h->layout, h->width, h->height);

    if (!r->mem) {
        r->mem = malloc(
            bytes +
            (is_plain ? 0 : glint_image_bytes(h->format, h->width, h->height)));
        r->seen =
            r->mem && differs_from_bt709(h) ? allocate_copy_tables(h) : NULL;
        if (!r->mem || (differs_from_bt709(h) && !r->seen))
            return glint_error_report(error, GLINT_E_MEMORY, r->name,
                                      "no memory for a %d x %d frame", h->width,
                                      h->height);
    }
    r->frame = (struct glint_image){
        .format = h->format,
        .width = h->width,
        .height = h->height,
        .range = h->range,
        .matrix = h->matrix,
        .transfer = GLINT_TONE_BT709,
    };
    r->planes = r->mem;
    glint_image_place(&r->frame, is_plain ? r->mem : r->mem + bytes);
    return GLINT_OK;
}

/* Reads a FRAME line. Sets *MORE if there is one, and clears it at the end of
 * the stream. */
static enum glint_status read_frame_line(struct glint_y4m_reader *r, bool *more,
                                         struct glint_error *error)
{
    char line[sizeof "FRAME" - 1 + GLINT_Y4M_FRAME_TAGS] = "";
    size_t len;
    const enum line_end end = read_stream_line(r, line, sizeof line, &len);

    *more = false;
    if (end == LINE_EOF && len == 0)
        return GLINT_OK;
    if (end == LINE_FAILED)
        return report_read_failure(r, error);
    if (end != LINE_FEED || strlen(line) != len || !is_plain_text(line) ||
        strncmp(line, "FRAME", 5) != 0 || (line[5] && line[5] != ' '))
        return glint_error_report(error, GLINT_E_FORMAT, r->name,
                                  "frame %ld: malformed FRAME line",
                                  r->n_frames);
    strcpy(r->frame_tags, line + 5);
    *more = true;
    return GLINT_OK;
}

enum glint_status glint_y4m_reader_next(struct glint_y4m_reader *reader,
                                        const struct glint_image **frame,
                                        struct glint_error *error)
{
    const struct glint_y4m_header *const h = &reader->header;
    const size_t bytes =
        glint_y4m_layout_bytes(&h->layout, h->width, h->height);
    bool more = false;
    ptrdiff_t got;
    enum glint_status status = reader->is_raw
                                   ? peek_raw_frame(reader, &more, error)
                                   : read_frame_line(reader, &more, error);

    if (!status && more)
        status = allocate_frame(reader, error);
    if (status)
        return status;
    if (!more) {
        *frame = NULL;
        return GLINT_OK;
    }
    got = reader->stride ? read_padded_rows(reader)
                         : read_stream_bytes(reader, reader->planes, bytes);
    if (got < 0)
        return report_read_failure(reader, error);
    if ((size_t)got < bytes)
        return glint_error_report(error, GLINT_E_FORMAT, reader->name,
                                  "frame %ld: ends after %zu of %zu bytes",
                                  reader->n_frames, (size_t)got, bytes);
    if (reader->seen)
        fill_bt709_copy(reader);
    else if (!glint_y4m_is_8_bit_bt709(h))
        fill_8_bit_copy(&h->layout, &reader->frame, reader->planes);
    reader->n_frames++;
    *frame = &reader->frame;
    return GLINT_OK;
}

void glint_y4m_reader_close(struct glint_y4m_reader *reader)
{
    glint_input_close(&reader->in);
    free(reader->mem);
    free(reader->seen);
    reader->mem = NULL;
    reader->seen = NULL;
}

enum glint_status glint_y4m_writer_open(struct glint_y4m_writer *writer,
                                        const char *path,
                                        const struct glint_y4m_header *header,
                                        struct glint_error *error)
{
    char line[GLINT_Y4M_PRINTED];
    const size_t len = glint_y4m_header_print(line, header);
    enum glint_status status;

    writer->n_frames = 0;
    status = glint_output_open(&writer->out, path, GLINT_OUTPUT_BINARY, error);
    if (!status)
        status = glint_output_write(&writer->out, line, len, error);
    if (status)
        glint_y4m_writer_abort(writer);
    return status;
}

static enum glint_status write_plane(struct glint_output *out,
                                     const struct glint_image *frame, int plane,
                                     struct glint_error *error)
{
    const int across =
        (int)glint_image_row_bytes(frame->format, plane, frame->width);
    const int down =
        glint_image_plane_height(frame->format, plane, frame->height);
    const ptrdiff_t stride = frame->stride_bytes[plane];
    const uint8_t *row = frame->plane[plane];
    enum glint_status status = GLINT_OK;

    if (stride == across)
        return glint_output_write(out, row, (size_t)across * (size_t)down,
                                  error);
    for (int y = 0; y < down && !status; y++) {
        status = glint_output_write(out, row, (size_t)across, error);
        row += stride;
    }
    return status;
}

enum glint_status glint_y4m_writer_put(struct glint_y4m_writer *writer,
                                       const struct glint_image *frame,
                                       const char *tags,
                                       struct glint_error *error)
{
    char line[sizeof "FRAME\n" + GLINT_Y4M_FRAME_TAGS];
    const int len = snprintf(line, sizeof line, "FRAME%s\n", tags);
    enum glint_status status;

    assert(strlen(tags) < GLINT_Y4M_FRAME_TAGS);
    status = glint_output_write(&writer->out, line, (size_t)len, error);
    for (int i = 0; i < glint_image_planes(frame->format) && !status; i++)
        status = write_plane(&writer->out, frame, i, error);
    if (!status)
        status = glint_output_flush(&writer->out, error);
    if (!status)
        writer->n_frames++;
    return status;
}

enum glint_status glint_y4m_writer_put_planes(struct glint_y4m_writer *writer,
                                              const uint8_t *planes,
                                              size_t bytes, const char *tags,
                                              struct glint_error *error)
{
    char line[sizeof "FRAME\n" + GLINT_Y4M_FRAME_TAGS];
    const int len = snprintf(line, sizeof line, "FRAME%s\n", tags);
    enum glint_status status =
        glint_output_write(&writer->out, line, (size_t)len, error);

    if (!status)
        status = glint_output_write(&writer->out, planes, bytes, error);
    if (!status)
        status = glint_output_flush(&writer->out, error);
    writer->n_frames += !status;
    return status;
}

enum glint_status glint_y4m_writer_commit(struct glint_y4m_writer *writer,
                                          struct glint_error *error)
{
    return glint_output_commit(&writer->out, error);
}

void glint_y4m_writer_abort(struct glint_y4m_writer *writer)
{
    glint_output_abort(&writer->out);
}

/* ------------------------------------------------------------------- light */

#define WHITE_Q24 (INT32_C(1) << 24)
#define WHITE_Q20 (INT32_C(1) << 20)

/* Returns the R'G'B' code, _q20, at which the table DECODE, interpolated
 * linearly, reaches LIGHT, _q24. */
static int32_t find_code_of_light_q20(const int32_t *decode_q24, int32_t light)
{
    int low = 0, high = GLINT_Y4M_STEPS;
    int64_t over, step;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (decode_q24[middle] <= light)
            low = middle;
        else
            high = middle;
    }
    over = light - decode_q24[low];
    step = decode_q24[high] - decode_q24[low];
    return (int32_t)(((int64_t)low << 8) + ((over << 8) + step / 2) / step);
}

static void fill_light_tables(struct glint_y4m_light *l,
                              enum glint_transfer_curve curve)
{
    for (int i = 0; i <= GLINT_Y4M_STEPS; i++)
        l->decode_q24[i] = glint_transfer_decode_q24(curve, i, GLINT_Y4M_STEPS);
    for (int o = 0; o < GLINT_Y4M_OCTAVES; o++)
        for (int i = 0; i <= GLINT_Y4M_IN_OCTAVE; i++) {
            const int64_t light =
                ((int64_t)(GLINT_Y4M_IN_OCTAVE + i) << o) / GLINT_Y4M_IN_OCTAVE;

            l->encode_q20[o][i] =
                light >= l->decode_q24[GLINT_Y4M_STEPS]
                    ? WHITE_Q20
                    : find_code_of_light_q20(l->decode_q24, (int32_t)light);
        }
}

void glint_y4m_light_init(struct glint_y4m_light *light,
                          const struct glint_y4m_header *header)
{
    struct glint_y4m_light *const l = light;
    const int up = header->layout.bits - 8;
    const bool full = header->range == GLINT_RANGE_FULL;
    /* Kr and Kb [ITU-R BT.601, BT.709, BT.2020] */
    static const int32_t k_q16[][2] = {[GLINT_MATRIX_BT601] = {19595, 7471},
                                       [GLINT_MATRIX_BT709] = {13933, 4732},
                                       [GLINT_MATRIX_BT2020] = {17216, 3886}};

    l->layout = header->layout;
    l->width = header->width;
    l->height = header->height;
    l->most = (1 << header->layout.bits) - 1;
    l->black = full ? 0 : 16 << up;
    l->y_span = full ? l->most : 219 << up;
    l->c_span = full ? l->most : 224 << up;
    l->kr_q16 = k_q16[header->matrix][0];
    l->kb_q16 = k_q16[header->matrix][1];
    l->kg_q16 = 65536 - l->kr_q16 - l->kb_q16;
    l->y_factor = y4m_scaled_quotient_factor(20, l->y_span);
    l->c_factor = y4m_scaled_quotient_factor(20, l->c_span);
    l->cb_factor = y4m_scaled_quotient_factor(15, 65536 - l->kb_q16);
    l->cr_factor = y4m_scaled_quotient_factor(15, 65536 - l->kr_q16);
    l->g_factor = y4m_fraction_factor(l->kg_q16);
    l->primaries = header->primaries;
    fill_light_tables(l, header->transfer);
}

static int32_t decode_code_to_light(const struct glint_y4m_light *l,
                                    int32_t v_q20)
{
    const int32_t *const at = l->decode_q24 + (v_q20 >> 8);

    if (v_q20 >= WHITE_Q20)
        return l->decode_q24[GLINT_Y4M_STEPS];
    return at[0] +
           (int32_t)(((int64_t)(at[1] - at[0]) * (v_q20 & 255) + 128) >> 8);
}

static int32_t encode_light_to_code(const struct glint_y4m_light *l,
                                    int64_t light)
{
    int octave = 0;
    int64_t place; /* position of LIGHT in the octave, in entries, with 16
                      fraction bits */
    const int32_t *at;

    if (light >= l->decode_q24[GLINT_Y4M_STEPS])
        return WHITE_Q20;
    if (light < 1)
        return 0;
    for (int up = 16; up; up >>= 1)
        if (light >> (octave + up))
            octave += up;
    place = ((light - (INT64_C(1) << octave)) * GLINT_Y4M_IN_OCTAVE << 16) >>
            octave;
    at = l->encode_q20[octave] + (place >> 16);
    return at[0] +
           (int32_t)(((at[1] - at[0]) * (place & 0xffff) + 0x8000) >> 16);
}

void glint_y4m_light_set_black(const struct glint_y4m_light *light,
                               uint8_t *planes)
{
    struct plane plane[4];

    locate_planes(&light->layout, light->width, light->height, planes, plane);
    for (int p = 0; p < 3; p++)
        for (int y = 0; y < plane[p].size[1]; y++)
            for (int x = 0; x < plane[p].size[0]; x++)
                write_sample_code(&plane[p], x, y,
                                  p ? 1 << (light->layout.bits - 1)
                                    : light->black);
}

/* ------------------------------------------------------------------- adding */

static int32_t clamp_to_code_range(int64_t v, int32_t most)
{
    return v < 0 ? 0 : v > most ? most : (int32_t)v;
}

/* Converts YCC to RGB. YCC: the code of Y', and the codes of Cb and Cr minus
 * the code of neutral chroma. RGB: R', G', B', clamped to 0 .. 1. */
static void convert_to_rgb(const struct glint_y4m_light *l,
                           const int32_t ycc[3], int32_t rgb_q20[3])
{
    const int64_t y = y4m_scaled_quotient(ycc[0] - l->black, l->y_factor);
    const int64_t cb = y4m_scaled_quotient(ycc[1], l->c_factor);
    const int64_t cr = y4m_scaled_quotient(ycc[2], l->c_factor);
    const int64_t r =
        y + y4m_divide_by_power_of_two((65536 - l->kr_q16) * cr, 15);
    const int64_t b =
        y + y4m_divide_by_power_of_two((65536 - l->kb_q16) * cb, 15);

    rgb_q20[0] = clamp_to_code_range(r, WHITE_Q20);
    rgb_q20[1] = y4m_divide_fraction(65536 * y - l->kr_q16 * r - l->kb_q16 * b,
                                     l->kg_q16, l->g_factor);
    rgb_q20[2] = clamp_to_code_range(b, WHITE_Q20);
}

/* Multiplies LIGHT by the matrix M; each row of M sums up to 65536. */
static void multiply_by_matrix(const int32_t m_q16[3][3], int64_t light[3])
{
    const int64_t r = light[0], g = light[1], b = light[2];

    for (int c = 0; c < 3; c++)
        light[c] = y4m_divide_by_power_of_two(
            m_q16[c][0] * r + m_q16[c][1] * g + m_q16[c][2] * b, 16);
}

/* Sets Y', Cb and Cr, _q20, from R', G' and B'. */
static void convert_to_ycc(const struct glint_y4m_light *l,
                           const int64_t rgb_q20[3], int64_t ycc_q20[3])
{
    const int64_t y = y4m_divide_by_power_of_two(l->kr_q16 * rgb_q20[0] +
                                                     l->kg_q16 * rgb_q20[1] +
                                                     l->kb_q16 * rgb_q20[2],
                                                 16);

    ycc_q20[0] = y;
    ycc_q20[1] = y4m_scaled_quotient((int32_t)(rgb_q20[2] - y), l->cb_factor);
    ycc_q20[2] = y4m_scaled_quotient((int32_t)(rgb_q20[0] - y), l->cr_factor);
}

/* Computes the changes of Y', Cb and Cr, _q20, of a pixel with codes YCC when
 * the fraction COVER_Q8 of its light is hidden and the light of LAYER is
 * added. */
static void compute_code_change(const struct glint_y4m_light *l,
                                const int32_t ycc[3], const float *layer,
                                int cover_q8, int64_t change_q20[3])
{
    int32_t rgb_q20[3];
    int64_t d[3], light[3];

    convert_to_rgb(l, ycc, rgb_q20);
    for (int c = 0; c < 3; c++) {
        const float most = 64;
        const float held = layer[c] > most ? most : layer[c] > 0 ? layer[c] : 0;

        light[c] = (int64_t)(held * WHITE_Q24);
    }
    if (l->primaries != GLINT_PRIMARIES_BT709)
        multiply_by_matrix(glint_primaries_from_bt709_q16[l->primaries], light);
    for (int c = 0; c < 3; c++) {
        const int32_t own = decode_code_to_light(l, rgb_q20[c]);
        const int64_t left =
            cover_q8 ? ((int64_t)own * (256 - cover_q8) + 128) >> 8 : own;

        d[c] = encode_light_to_code(l, left + light[c]) - rgb_q20[c];
        if (!cover_q8 && (d[c] < 0 || light[c] == 0))
            d[c] = 0;
    }
    convert_to_ycc(l, d, change_q20);
}

static bool has_added_light(const float *layer)
{
    return layer[0] > 0 || layer[1] > 0 || layer[2] > 0;
}

/* Returns SUM_Q20 / COUNT, rounded to an integer. COUNT is the number of pixels
 * per chroma sample, 1 .. 4; it is 3 only at the right edge of 4:1:1. */
static int64_t divide_by_pixel_count(int64_t sum_q20, int count)
{
    const int64_t whole = 3 * (int64_t)WHITE_Q20;

    if (count != 3)
        return y4m_divide_by_power_of_two(sum_q20, 20 + count / 2);
    return sum_q20 < 0 ? -((2 * -sum_q20 + whole) / (2 * whole))
                       : (2 * sum_q20 + whole) / (2 * whole);
}

/* The pixels X0 .. X1 - 1, Y0 .. Y1 - 1 that share a chroma sample. */
struct block {
    int x, y; /* position of the chroma sample in its plane */
    int x0, y0, x1, y1;
};

/* Adds the light of LAYER to the pixels of block B after hiding the fraction
 * COVER_Q8 of each. LAYER and COVER_Q8 are arrays of the whole frame; if
 * COVER_Q8 is NULL, nothing is hidden. */
static void add_light_to_block(const struct glint_y4m_light *l,
                               struct plane plane[4], const struct block *b,
                               const float *layer, const uint16_t *cover_q8)
{
    const bool is_grey = plane[1].size[0] == 0;
    const int32_t middle = 1 << (l->layout.bits - 1);
    const int count = (b->x1 - b->x0) * (b->y1 - b->y0);
    int64_t sum[2] = {0, 0};
    int32_t ycc[3] = {0, 0, 0};

    for (int c = 1; c < 3 && !is_grey; c++)
        ycc[c] = read_sample_code(&plane[c], b->x, b->y) - middle;
    for (int y = b->y0; y < b->y1; y++)
        for (int x = b->x0; x < b->x1; x++) {
            const size_t at = (size_t)y * (size_t)l->width + (size_t)x;
            const float *const light = layer + 3 * at;
            const int cover = cover_q8 ? cover_q8[at] : 0;
            int64_t change[3];

            if (!cover && !has_added_light(light))
                continue;
            ycc[0] = read_sample_code(&plane[0], x, y);
            compute_code_change(l, ycc, light, cover, change);
            write_sample_code(
                &plane[0], x, y,
                clamp_to_code_range(ycc[0] + y4m_divide_by_power_of_two(
                                                 change[0] * l->y_span, 20),
                                    l->most));
            sum[0] += change[1];
            sum[1] += change[2];
        }
    for (int c = 1; c < 3 && !is_grey; c++)
        write_sample_code(
            &plane[c], b->x, b->y,
            clamp_to_code_range(
                middle + ycc[c] +
                    divide_by_pixel_count(sum[c - 1] * l->c_span, count),
                l->most));
}

static int get_min_int(int a, int b)
{
    return a < b ? a : b;
}

/* Sets ACROSS and DOWN to the width and height, in pixels, of the blocks that
 * share a chroma sample. */
static void get_chroma_block_size(const struct glint_y4m_layout *layout,
                                  int *across, int *down)
{
    const bool is_grey = layout->format == GLINT_GREY;

    *across = layout->is_411                            ? 4
              : layout->format == GLINT_I444 || is_grey ? 1
                                                        : 2;
    *down = layout->format == GLINT_I420 ? 2 : 1;
}

/* Converts YCC, codes of the stream FROM, to YCC_Q20, values for the stream TO;
 * light above white is clipped. */
static void convert_ycc_between_streams(const struct glint_y4m_light *from,
                                        const struct glint_y4m_light *to,
                                        const int32_t ycc[3],
                                        int64_t ycc_q20[3])
{
    int32_t rgb_q20[3];
    int64_t rgb[3];

    convert_to_rgb(from, ycc, rgb_q20);
    for (int c = 0; c < 3; c++)
        rgb[c] = decode_code_to_light(from, rgb_q20[c]);
    if (from->primaries != GLINT_PRIMARIES_BT709)
        multiply_by_matrix(glint_primaries_to_bt709_q16[from->primaries], rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = encode_light_to_code(to, rgb[c]);
    convert_to_ycc(to, rgb, ycc_q20);
}

static void convert_block_to_bt709(const struct glint_y4m_seen *seen,
                                   const struct plane from[4],
                                   const struct plane to[4],
                                   const struct block *b)
{
    const struct glint_y4m_light *const f = &seen->from, *const t = &seen->to;
    const int32_t middle = 1 << (f->layout.bits - 1);
    const bool is_grey = from[1].size[0] == 0;
    const int count = (b->x1 - b->x0) * (b->y1 - b->y0);
    int32_t ycc[3] = {0, 0, 0};
    int64_t made[3], sum[2] = {0, 0};

    for (int c = 1; c < 3 && !is_grey; c++)
        ycc[c] = read_sample_code(&from[c], b->x, b->y) - middle;
    for (int y = b->y0; y < b->y1; y++)
        for (int x = b->x0; x < b->x1; x++) {
            ycc[0] = read_sample_code(&from[0], x, y);
            convert_ycc_between_streams(f, t, ycc, made);
            write_sample_code(
                &to[0], x, y,
                clamp_to_code_range(t->black + y4m_divide_by_power_of_two(
                                                   made[0] * t->y_span, 20),
                                    255));
            sum[0] += made[1];
            sum[1] += made[2];
        }
    /* The BT.709 copy of a 4:1:1 frame has the format 4:2:2. */
    for (int c = 1; c < 3 && !is_grey; c++)
        for (int x = b->x0; x < b->x1; x += 2)
            write_sample_code(
                &to[c], f->layout.is_411 ? x / 2 : b->x, b->y,
                clamp_to_code_range(
                    128 + divide_by_pixel_count(sum[c - 1] * t->c_span, count),
                    255));
}

/* Converts the last frame that R has read to its BT.709 copy, r->frame. */
static void fill_bt709_copy(const struct glint_y4m_reader *r)
{
    const struct glint_y4m_light *const f = &r->seen->from, *const t =
                                                                &r->seen->to;
    struct plane from[4], to[4];
    int across, down;

    get_chroma_block_size(&f->layout, &across, &down);
    locate_planes(&f->layout, f->width, f->height, r->planes, from);
    locate_planes(&t->layout, t->width, t->height, r->frame.plane[0], to);
    for (int y = 0; y < f->height; y += down)
        for (int x = 0; x < f->width; x += across) {
            const struct block block = {x / across,
                                        y / down,
                                        x,
                                        y,
                                        get_min_int(x + across, f->width),
                                        get_min_int(y + down, f->height)};

            convert_block_to_bt709(r->seen, from, to, &block);
        }
}

void glint_y4m_light_add(const struct glint_y4m_light *light, uint8_t *planes,
                         const float *layer)
{
    glint_y4m_light_cover(light, planes, layer, NULL);
}

void glint_y4m_light_cover(const struct glint_y4m_light *light, uint8_t *planes,
                           const float *layer, const uint16_t *cover_q8)
{
    const struct glint_y4m_light *const l = light;
    struct plane plane[4];
    int across, down;

    get_chroma_block_size(&l->layout, &across, &down);
    locate_planes(&l->layout, l->width, l->height, planes, plane);
    for (int y = 0; y < l->height; y += down)
        for (int x = 0; x < l->width; x += across) {
            const struct block block = {x / across,
                                        y / down,
                                        x,
                                        y,
                                        get_min_int(x + across, l->width),
                                        get_min_int(y + down, l->height)};

            add_light_to_block(l, plane, &block, layer, cover_q8);
        }
}
