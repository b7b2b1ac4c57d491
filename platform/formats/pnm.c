/* SPDX-License-Identifier: MIT */
#include "formats/pnm.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "posix/error.h"

#define MAX_NUMBER 99999 /* Larger numbers are read as this one. */

struct cursor {
    const uint8_t *at, *end;
};

static bool is_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static void skip_comment(struct cursor *c)
{
    while (c->at < c->end && *c->at != '\n')
        c->at++;
}

static void skip_space(struct cursor *c)
{
    while (c->at < c->end && (is_space(*c->at) || *c->at == '#')) {
        if (*c->at == '#')
            skip_comment(c);
        else
            c->at++;
    }
}

/* Skips white space and comments and returns the number that follows, at most
 * MAX_NUMBER, or -1 if none does. */
static int take_number(struct cursor *c)
{
    int value = -1;

    skip_space(c);
    while (c->at < c->end && *c->at >= '0' && *c->at <= '9') {
        value = (value < 0 ? 0 : value) * 10 + (*c->at++ - '0');
        if (value > MAX_NUMBER)
            value = MAX_NUMBER;
    }
    return value;
}

/* Skips the one white space that ends the header, and a comment before it.
 * Returns false if there is none. */
static bool take_header_end(struct cursor *c)
{
    if (c->at < c->end && *c->at == '#')
        skip_comment(c);
    return c->at < c->end && is_space(*c->at++);
}

bool glint_pnm_matches(const void *data, size_t bytes)
{
    const uint8_t *const d = data;

    return bytes >= 3 && d[0] == 'P' && (d[1] == '5' || d[1] == '6') &&
           (is_space(d[2]) || d[2] == '#');
}

static enum glint_status read_header(struct cursor *c,
                                     struct glint_pnm_header *h,
                                     const char *name,
                                     struct glint_error *error)
{
    h->channels = c->at[1] == '6' ? 3 : 1;
    c->at += 2;
    h->width = take_number(c);
    h->height = take_number(c);
    h->maximum = take_number(c);
    if (h->width < 1 || h->height < 1 || !take_header_end(c))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "malformed PNM header");
    if (h->maximum < 1 || h->maximum > 65535)
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "the maximum value is not 1 .. 65535");
    if (h->width > GLINT_MAX_SIDE || h->height > GLINT_MAX_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "larger than %d pixels a side",
                                  GLINT_MAX_SIDE);
    return GLINT_OK;
}

/* Scales N samples of SRC, 0 .. MAXIMUM, to 8 bits. They have 2 bytes if
 * MAXIMUM is above 255, else 1. */
static void scale_samples(uint8_t *dst, const uint8_t *src, size_t n,
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

enum glint_status glint_pnm_header_read(struct glint_pnm_header *header,
                                        const void *data, size_t bytes,
                                        const char *name,
                                        struct glint_error *error)
{
    struct cursor c = {.at = data};
    struct glint_pnm_header h;
    size_t need;
    enum glint_status status;

    if (!glint_pnm_matches(data, bytes))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "not a binary PPM or PGM (P6, P5)");
    c.end = c.at + bytes;
    status = read_header(&c, &h, name, error);
    if (status)
        return status;
    h.bytes = (size_t)(c.at - (const uint8_t *)data);
    need = (size_t)h.width * (size_t)h.height * (size_t)h.channels *
           (h.maximum > 255 ? 2 : 1);
    if (bytes - h.bytes < need)
        return glint_error_report(
            error, GLINT_E_FORMAT, name,
            "ends after %zu of %zu bytes of a %d x %d picture", bytes - h.bytes,
            need, h.width, h.height);
    *header = h;
    return GLINT_OK;
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
    scale_samples(mem, (const uint8_t *)data + h.bytes, n_samples, h.maximum);
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
