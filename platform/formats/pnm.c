/* SPDX-License-Identifier: MIT */
#include "formats/pnm.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/options.h"
#include "posix/error.h"

/* max bytes of a word of the header, including the final 0 */
#define TOKEN_CHARS 32
#define CHUNK       256 /* number of floats that are encoded at a time */

static bool is_white_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool glint_pfm_has_signature(const void *data, size_t bytes)
{
    const uint8_t *const d = data;

    return bytes >= 3 && d[0] == 'P' && (d[1] == 'F' || d[1] == 'f') &&
           is_white_space(d[2]);
}

/* Copies the word at offset *AT of DATA[BYTES] to TOKEN, and moves *AT behind
 * the single white space that ends the word. Returns false if there is no such
 * word, or if it is longer than TOKEN. */
static bool read_header_word(char token[TOKEN_CHARS], const uint8_t *data,
                             size_t bytes, size_t *at)
{
    size_t len = 0;

    while (*at < bytes && is_white_space(data[*at]))
        (*at)++;
    while (*at < bytes && !is_white_space(data[*at])) {
        if (len == TOKEN_CHARS - 1 || data[*at] == 0)
            return false;
        token[len++] = (char)data[(*at)++];
    }
    token[len] = 0;
    return len > 0 && *at < bytes && is_white_space(data[(*at)++]);
}

/* Returns TOKEN as a number, at most 99999, or 0 if any character is not a
 * digit. */
static int parse_side_length(const char *token)
{
    int value = 0;

    for (; *token >= '0' && *token <= '9'; token++)
        value = value > 9999 ? 99999 : value * 10 + (*token - '0');
    return *token ? 0 : value;
}

static bool read_pfm_header(struct glint_pnm_header *h, const uint8_t *data,
                            size_t bytes)
{
    char token[3][TOKEN_CHARS];
    const char *end;
    double scale;

    h->channels = data[1] == 'F' ? 3 : 1;
    h->bytes = 2;
    for (int i = 0; i < 3; i++)
        if (!read_header_word(token[i], data, bytes, &h->bytes))
            return false;
    h->width = parse_side_length(token[0]);
    h->height = parse_side_length(token[1]);
    scale = glint_option_number(token[2], &end);
    h->little = scale < 0;
    return h->width > 0 && h->height > 0 && !*end && isfinite(scale) &&
           (scale < 0 || scale > 0);
}

/* max number in a header; larger numbers are read as this one */
#define MAX_NUMBER 99999

struct cursor {
    const uint8_t *at, *end;
};

static void skip_header_comment(struct cursor *c)
{
    while (c->at < c->end && *c->at != '\n')
        c->at++;
}

static void skip_header_space(struct cursor *c)
{
    while (c->at < c->end && (is_white_space(*c->at) || *c->at == '#')) {
        if (*c->at == '#')
            skip_header_comment(c);
        else
            c->at++;
    }
}

/* Skips white space and comments and returns the number that follows, clamped
 * to MAX_NUMBER, or -1 if no number follows. */
static int read_header_number(struct cursor *c)
{
    int value = -1;

    skip_header_space(c);
    while (c->at < c->end && *c->at >= '0' && *c->at <= '9') {
        value = (value < 0 ? 0 : value) * 10 + (*c->at++ - '0');
        if (value > MAX_NUMBER)
            value = MAX_NUMBER;
    }
    return value;
}

/* Skips a comment, and then the single white space that ends the header.
 * Returns false if there is no white space. */
static bool skip_header_end(struct cursor *c)
{
    if (c->at < c->end && *c->at == '#')
        skip_header_comment(c);
    return c->at < c->end && is_white_space(*c->at++);
}

bool glint_pnm_has_signature(const void *data, size_t bytes)
{
    const uint8_t *const d = data;

    return bytes >= 3 && d[0] == 'P' && (d[1] == '5' || d[1] == '6') &&
           (is_white_space(d[2]) || d[2] == '#');
}

static bool read_pnm_header(struct glint_pnm_header *h, const uint8_t *data,
                            size_t bytes)
{
    struct cursor c = {data + 2, data + bytes};

    h->channels = data[1] == '6' ? 3 : 1;
    h->width = read_header_number(&c);
    h->height = read_header_number(&c);
    h->maximum = read_header_number(&c);
    if (h->width < 1 || h->height < 1 || !skip_header_end(&c))
        return false;
    h->bytes = (size_t)(c.at - data);
    return true;
}

enum glint_status glint_pnm_header_read(struct glint_pnm_header *header,
                                        const void *data, size_t bytes,
                                        const char *name,
                                        struct glint_error *error)
{
    const bool is_pfm = glint_pfm_has_signature(data, bytes);
    struct glint_pnm_header h = {0};
    size_t need;

    if (!is_pfm && !glint_pnm_has_signature(data, bytes))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "not a binary PPM or PGM (P6, P5)");
    if (!(is_pfm ? read_pfm_header : read_pnm_header)(&h, data, bytes))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "malformed %s header",
                                  is_pfm ? "PFM" : "PNM");
    if (!is_pfm && (h.maximum < 1 || h.maximum > 65535))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "the maximum value is not 1 .. 65535");
    if (h.width > GLINT_MAX_SIDE || h.height > GLINT_MAX_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "larger than %d pixels a side",
                                  GLINT_MAX_SIDE);
    need = (size_t)h.width * (size_t)h.height * (size_t)h.channels *
           (is_pfm            ? 4
            : h.maximum > 255 ? 2
                              : 1);
    if (bytes - h.bytes < need)
        return glint_error_report(
            error, GLINT_E_FORMAT, name,
            "ends after %zu of %zu bytes of a %d x %d picture", bytes - h.bytes,
            need, h.width, h.height);
    *header = h;
    return GLINT_OK;
}

/* Scales N samples of SRC, 0 .. MAXIMUM, to 8 bits in DST. A sample of SRC has
 * 2 bytes if MAXIMUM is above 255, else 1. */
static void scale_samples_to_8_bits(uint8_t *dst, const uint8_t *src, size_t n,
                                    int maximum)
{
    if (maximum == 255) {
        memcpy(dst, src, n);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const int wide = maximum > 255;
        const int v = wide ? src[2 * i] << 8 | src[2 * i + 1] : src[i];

        dst[i] =
            (uint8_t)(v >= maximum ? 255 : (v * 255 + maximum / 2) / maximum);
    }
}

enum glint_status glint_pnm_read(struct glint_image *image, const void *data,
                                 size_t bytes, const char *name,
                                 struct glint_error *error)
{
    struct glint_image made = {.range = GLINT_RANGE_FULL,
                               .matrix = GLINT_MATRIX_BT601,
                               .transfer = GLINT_TONE_SRGB};
    struct glint_pnm_header h = {0};
    size_t n_samples;
    enum glint_status status =
        glint_pnm_header_read(&h, data, bytes, name, error);
    void *mem;

    if (!status && h.maximum == 0)
        status = glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                    "not a binary PPM or PGM (P6, P5)");
    if (status)
        return status;
    made.format = h.channels == 3 ? GLINT_RGB24 : GLINT_GREY;
    made.width = h.width;
    made.height = h.height;
    n_samples = glint_image_bytes(made.format, made.width, made.height);
    mem = malloc(n_samples);
    if (!mem)
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "no memory for a %d x %d picture", made.width,
                                  made.height);
    scale_samples_to_8_bits(mem, (const uint8_t *)data + h.bytes, n_samples,
                            h.maximum);
    glint_image_place(&made, mem);
    *image = made;
    return GLINT_OK;
}

enum glint_status glint_pnm_write(struct glint_output *out,
                                  const struct glint_image *image,
                                  struct glint_error *error)
{
    char header[64];
    const int len = snprintf(header, sizeof header, "P6\n%d %d\n255\n",
                             image->width, image->height);
    const uint8_t *row = image->plane[0];
    enum glint_status status =
        glint_output_write(out, header, (size_t)len, error);

    for (int y = 0; y < image->height && !status; y++) {
        status = glint_output_write(out, row, 3 * (size_t)image->width, error);
        row += image->stride_bytes[0];
    }
    return status;
}

static float decode_pfm_float(const uint8_t *b, bool little)
{
    const uint32_t bits = little
                              ? b[0] | (uint32_t)b[1] << 8 |
                                    (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24
                              : b[3] | (uint32_t)b[2] << 8 |
                                    (uint32_t)b[1] << 16 | (uint32_t)b[0] << 24;
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static void decode_pfm_rows(float *rgb, const struct glint_pnm_header *h,
                            const uint8_t *data)
{
    const size_t n = (size_t)h->width;

    /* A PFM begins with the bottom row. */
    for (int y = h->height - 1; y >= 0; y--) {
        float *const row = rgb + 3 * n * (size_t)y;

        for (size_t i = 0; i < 3 * n; i++) {
            const size_t from = h->channels == 3 ? i : i / 3;

            row[i] = decode_pfm_float(data + 4 * from, h->little);
        }
        data += 4 * n * (size_t)h->channels;
    }
}

enum glint_status glint_pfm_read(struct glint_float_image *floats,
                                 const void *data, size_t bytes,
                                 const char *name, struct glint_error *error)
{
    struct glint_pnm_header h = {0};
    enum glint_status status;
    size_t n_pixels;
    float *rgb;

    if (!glint_pfm_has_signature(data, bytes))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "not a PFM (PF, Pf)");
    status = glint_pnm_header_read(&h, data, bytes, name, error);
    if (status)
        return status;
    n_pixels = (size_t)h.width * (size_t)h.height;
    rgb = malloc(n_pixels * 3 * sizeof *rgb);
    if (!rgb)
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "no memory for a %d x %d picture", h.width,
                                  h.height);
    decode_pfm_rows(rgb, &h, (const uint8_t *)data + h.bytes);
    *floats = (struct glint_float_image){h.width, h.height, rgb};
    return GLINT_OK;
}

static void encode_pfm_float(uint8_t *b, float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        b[i] = (uint8_t)(bits >> (8 * i));
}

static enum glint_status write_pfm_floats(struct glint_output *out,
                                          const float *values, size_t n,
                                          struct glint_error *error)
{
    uint8_t chunk[4 * CHUNK];
    enum glint_status status = GLINT_OK;

    while (n > 0 && !status) {
        const size_t now = n < CHUNK ? n : CHUNK;

        for (size_t i = 0; i < now; i++)
            encode_pfm_float(chunk + 4 * i, values[i]);
        status = glint_output_write(out, chunk, 4 * now, error);
        values += now;
        n -= now;
    }
    return status;
}

enum glint_status glint_pfm_write(struct glint_output *out,
                                  const struct glint_float_image *floats,
                                  struct glint_error *error)
{
    const size_t n = 3 * (size_t)floats->width;
    char header[64];
    const int len = snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n",
                             floats->width, floats->height);
    enum glint_status status =
        glint_output_write(out, header, (size_t)len, error);

    for (int y = floats->height - 1; y >= 0 && !status; y--)
        status = write_pfm_floats(out, floats->rgb + n * (size_t)y, n, error);
    return status;
}
