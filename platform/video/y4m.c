/* SPDX-License-Identifier: MIT */
#include "video/y4m.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "video/y4m_light.h"
#include "posix/ending.h"
#include "posix/error.h"

#define MAGIC "YUV4MPEG2"

/* ------------------------------------------------------------------ header */

static enum glint_matrix matrix_of(int height)
{
    return height < 720 ? GLINT_MATRIX_BT601 : GLINT_MATRIX_BT709;
}

/* Checks whether codes are those of JPEG, which are BT.601 in any size [JFIF]:
 * full range, and C420jpeg or no tag C. */
static bool is_jpeg(const struct glint_y4m_header *h)
{
    return h->range == GLINT_RANGE_FULL &&
           (!*h->colour || !strcmp(h->colour, "420jpeg"));
}

bool glint_y4m_is_name(const char *name)
{
    return glint_ends_in(name, ".y4m");
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
        .matrix = matrix_of(height),
        .fps_num = fps_num,
        .fps_den = fps_den,
        .interlace = 'p',
        .aspect = "1:1",
    };
    strcpy(header->colour, glint_y4m_layout_tag(format));
    (void)glint_y4m_layout_parse(&header->layout, header->colour);
}

/* Returns the number at *AT, at most INT_MAX, and moves *AT past it. Returns -1
 * if there is none. */
static int take_number(const char **at)
{
    int value = -1;

    for (; **at >= '0' && **at <= '9'; (*at)++) {
        const int digit = **at - '0';

        value = value < 0 ? 0 : value;
        value = value > (INT_MAX - digit) / 10 ? INT_MAX : value * 10 + digit;
    }
    return value;
}

/* Reads TEXT as "N:D" in plain digits. Returns false if it is malformed, or D
 * is 0 and N is not. */
static bool take_ratio(const char *text, int *num, int *den)
{
    *num = take_number(&text);
    if (*num < 0 || *text++ != ':')
        return false;
    *den = take_number(&text);
    return *den >= 0 && !*text && (*den > 0 || *num == 0);
}

/* Returns TEXT as a number, or 0 if it has other characters than digits. */
static int take_side(const char *text)
{
    const int value = take_number(&text);

    return *text || value < 0 ? 0 : value;
}

static bool take_text(char *dst, size_t size, const char *text)
{
    const bool fits = strlen(text) < size;

    if (fits)
        strcpy(dst, text);
    return fits;
}

static bool take_range(struct glint_y4m_header *h, const char *tag)
{
    const bool full = !strcmp(tag, "XCOLORRANGE=FULL");

    if (!full && strcmp(tag, "XCOLORRANGE=LIMITED") != 0)
        return false;
    h->range = full ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED;
    h->range_stated = true;
    return true;
}

/* Sets H by a tag of the header. Returns false if TAG is malformed. */
static bool take_tag(struct glint_y4m_header *h, const char *tag)
{
    int num, den;

    switch (tag[0]) {
    case 'W':
        return (h->width = take_side(tag + 1)) > 0;
    case 'H':
        return (h->height = take_side(tag + 1)) > 0;
    case 'F':
        return take_ratio(tag + 1, &h->fps_num, &h->fps_den);
    case 'I':
        h->interlace = tag[1];
        return tag[1] && strchr("ptbm?", tag[1]) && !tag[2];
    case 'A':
        return take_ratio(tag + 1, &num, &den) &&
               take_text(h->aspect, sizeof h->aspect, tag + 1);
    case 'C':
        return tag[1] && take_text(h->colour, sizeof h->colour, tag + 1);
    }
    if (!take_range(h, tag)) {
        /* All tags fit, as they come from a line no longer than EXTRA. */
        strcat(h->extra, " ");
        strcat(h->extra, tag);
    }
    return true;
}

static enum glint_status check_header(struct glint_y4m_header *h,
                                      const char *name,
                                      struct glint_error *error)
{
    if (h->width < 1 || h->height < 1)
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "no width or height in the Y4M header");
    if (h->width > GLINT_MAX_SIDE || h->height > GLINT_MAX_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "larger than %d pixels a side",
                                  GLINT_MAX_SIDE);
    if (!glint_y4m_layout_parse(&h->layout, h->colour))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "C%s is none of 420, 422, 444 (to p16), 411, "
                                  "444alpha and mono (to mono16)",
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
    if (!is_plain_text(line) || !take_text(copy, sizeof copy, line))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "malformed Y4M header");
    for (char *tag = strtok_r(copy + strlen(MAGIC), " ", &rest); tag;
         tag = strtok_r(NULL, " ", &rest))
        if (!take_tag(&h, tag))
            return glint_error_report(error, GLINT_E_FORMAT, name,
                                      "malformed tag %s in the Y4M header",
                                      tag);
    status = check_header(&h, name, error);
    if (status)
        return status;
    h.matrix = is_jpeg(&h) ? GLINT_MATRIX_BT601 : matrix_of(h.height);
    strcpy(h.line, line); /* LINE fitted into COPY. */
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

static ptrdiff_t read_some(struct glint_y4m_reader *r, void *dst, size_t bytes)
{
    return r->source ? r->source(r->ctx, dst, bytes)
                     : glint_input_some(&r->in, dst, bytes);
}

static enum glint_status report_io(const struct glint_y4m_reader *r,
                                   struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_IO, r->name, "%s",
                              strerror(errno));
}

enum line_end { LINE_FEED, LINE_EOF, LINE_TOO_LONG, LINE_FAILED };

/* Reads a line up to its line feed, which is dropped, or to the end of the
 * stream. Sets *LEN to the number of characters. */
static enum line_end read_line(struct glint_y4m_reader *r, char *line,
                               size_t size, size_t *len)
{
    *len = 0;
    for (;;) {
        if (r->ahead_at == r->ahead_end) {
            const ptrdiff_t n = read_some(r, r->ahead, sizeof r->ahead);

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

/* Reads BYTES, or fewer at the end of the stream. Returns how many, or -1 on
 * failure. */
static ptrdiff_t read_block(struct glint_y4m_reader *r, uint8_t *dst,
                            size_t bytes)
{
    const size_t left = r->ahead_end - r->ahead_at;
    size_t got = left < bytes ? left : bytes;

    memcpy(dst, r->ahead + r->ahead_at, got);
    r->ahead_at += got;
    while (got < bytes) {
        const ptrdiff_t n = read_some(r, dst + got, bytes - got);

        if (n < 0)
            return -1;
        if (n == 0)
            break;
        got += (size_t)n;
    }
    return (ptrdiff_t)got;
}

static enum glint_status read_header(struct glint_y4m_reader *r,
                                     struct glint_error *error)
{
    char line[GLINT_Y4M_LINE];
    size_t len;
    const enum line_end end = read_line(r, line, sizeof line, &len);
    const char *cause = "holds a zero byte in the Y4M header";

    if (end == LINE_FAILED)
        return report_io(r, error);
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
    return read_header(reader, error);
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
        status = read_header(reader, error);
    if (status)
        glint_y4m_reader_close(reader);
    return status;
}

/* Prepares r->frame. Its memory is taken with the first frame, so that a header
 * alone costs none. */
static enum glint_status place_frame(struct glint_y4m_reader *r,
                                     struct glint_error *error)
{
    const struct glint_y4m_header *const h = &r->header;

    const bool is_plain = glint_y4m_layout_is_plain(&h->layout);
    const size_t bytes =
        glint_y4m_layout_bytes(&h->layout, h->width, h->height);

    if (!r->mem) {
        r->mem = malloc(
            bytes +
            (is_plain ? 0 : glint_image_bytes(h->format, h->width, h->height)));
        if (!r->mem)
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
    const enum line_end end = read_line(r, line, sizeof line, &len);

    *more = false;
    if (end == LINE_EOF && len == 0)
        return GLINT_OK;
    if (end == LINE_FAILED)
        return report_io(r, error);
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
    bool more;
    ptrdiff_t got;
    enum glint_status status = read_frame_line(reader, &more, error);

    if (!status && more)
        status = place_frame(reader, error);
    if (status)
        return status;
    if (!more) {
        *frame = NULL;
        return GLINT_OK;
    }
    got = read_block(reader, reader->planes, bytes);
    if (got < 0)
        return report_io(reader, error);
    if ((size_t)got < bytes)
        return glint_error_report(error, GLINT_E_FORMAT, reader->name,
                                  "frame %ld: ends after %zu of %zu bytes",
                                  reader->n_frames, (size_t)got, bytes);
    if (!glint_y4m_layout_is_plain(&h->layout))
        glint_y4m_light_proxy(&h->layout, &reader->frame, reader->planes);
    reader->n_frames++;
    *frame = &reader->frame;
    return GLINT_OK;
}

void glint_y4m_reader_close(struct glint_y4m_reader *reader)
{
    glint_input_close(&reader->in);
    free(reader->mem);
    reader->mem = NULL;
}
