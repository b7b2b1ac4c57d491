/* SPDX-License-Identifier: MIT */
#include "formats/pfm.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "posix/error.h"

#define TOKEN_CHARS 32  /* bytes of a word of the header, with its 0 */
#define CHUNK       256 /* floats encoded at a time */

static bool is_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool glint_pfm_matches(const void *data, size_t bytes)
{
    const uint8_t *const d = data;

    return bytes >= 3 && d[0] == 'P' && (d[1] == 'F' || d[1] == 'f') &&
           is_space(d[2]);
}

/* Copies the next word of DATA[BYTES] from *AT on to TOKEN, and moves *AT past
 * the one white space that ends it. Returns false if there is no such word, or
 * it is longer than TOKEN. */
static bool take_token(char token[TOKEN_CHARS], const uint8_t *data,
                       size_t bytes, size_t *at)
{
    size_t len = 0;

    while (*at < bytes && is_space(data[*at]))
        (*at)++;
    while (*at < bytes && !is_space(data[*at])) {
        if (len == TOKEN_CHARS - 1 || data[*at] == 0)
            return false;
        token[len++] = (char)data[(*at)++];
    }
    token[len] = 0;
    return len > 0 && *at < bytes && is_space(data[(*at)++]);
}

/* Returns TOKEN as a number, at most 99999, or 0 if it has other characters
 * than digits. */
static int side_of(const char *token)
{
    int value = 0;

    for (; *token >= '0' && *token <= '9'; token++)
        value = value > 9999 ? 99999 : value * 10 + (*token - '0');
    return *token ? 0 : value;
}

static bool read_header(struct glint_pfm_header *h, const uint8_t *data,
                        size_t bytes)
{
    char token[TOKEN_CHARS], *end;
    double scale;

    h->channels = data[1] == 'F' ? 3 : 1;
    h->bytes = 2;
    if (!take_token(token, data, bytes, &h->bytes))
        return false;
    h->width = side_of(token);
    if (!take_token(token, data, bytes, &h->bytes))
        return false;
    h->height = side_of(token);
    if (!take_token(token, data, bytes, &h->bytes))
        return false;
    scale = strtod(token, &end);
    h->little = scale < 0;
    return h->width > 0 && h->height > 0 && !*end && isfinite(scale) &&
           (scale < 0 || scale > 0);
}

static float decode_float(const uint8_t *b, bool little)
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

static void decode_rows(float *rgb, const struct glint_pfm_header *h,
                        const uint8_t *data)
{
    const size_t n = (size_t)h->width;

    for (int y = h->height - 1; y >= 0; y--) { /* the bottom row comes first */
        float *const row = rgb + 3 * n * (size_t)y;

        for (size_t i = 0; i < 3 * n; i++) {
            const size_t from = h->channels == 3 ? i : i / 3;

            row[i] = decode_float(data + 4 * from, h->little);
        }
        data += 4 * n * (size_t)h->channels;
    }
}

enum glint_status glint_pfm_header_read(struct glint_pfm_header *header,
                                        const void *data, size_t bytes,
                                        const char *name,
                                        struct glint_error *error)
{
    struct glint_pfm_header h;
    size_t need;

    if (!glint_pfm_matches(data, bytes))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "not a PFM (PF, Pf)");
    if (!read_header(&h, data, bytes))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "malformed PFM header");
    if (h.width > GLINT_MAX_SIDE || h.height > GLINT_MAX_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "larger than %d pixels a side",
                                  GLINT_MAX_SIDE);
    need = 4 * (size_t)h.width * (size_t)h.height * (size_t)h.channels;
    if (bytes - h.bytes < need)
        return glint_error_report(
            error, GLINT_E_FORMAT, name,
            "ends after %zu of %zu bytes of a %d x %d picture", bytes - h.bytes,
            need, h.width, h.height);
    *header = h;
    return GLINT_OK;
}

enum glint_status glint_pfm_read(struct glint_float_image *floats,
                                 const void *data, size_t bytes,
                                 const char *name, struct glint_error *error)
{
    struct glint_pfm_header h = {0};
    enum glint_status status =
        glint_pfm_header_read(&h, data, bytes, name, error);
    size_t n_pixels;
    float *rgb;

    if (status)
        return status;
    n_pixels = (size_t)h.width * (size_t)h.height;
    rgb = malloc(n_pixels * 3 * sizeof *rgb);
    if (!rgb)
        return glint_error_report(error, GLINT_E_MEMORY, name,
                                  "no memory for a %d x %d picture", h.width,
                                  h.height);
    decode_rows(rgb, &h, (const uint8_t *)data + h.bytes);
    *floats = (struct glint_float_image){h.width, h.height, rgb};
    return GLINT_OK;
}

static void encode_float(uint8_t *b, float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        b[i] = (uint8_t)(bits >> (8 * i));
}

static enum glint_status write_floats(struct glint_output *out,
                                      const float *values, size_t n,
                                      struct glint_error *error)
{
    uint8_t chunk[4 * CHUNK];
    enum glint_status status = GLINT_OK;

    while (n > 0 && !status) {
        const size_t now = n < CHUNK ? n : CHUNK;

        for (size_t i = 0; i < now; i++)
            encode_float(chunk + 4 * i, values[i]);
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
        status = write_floats(out, floats->rgb + n * (size_t)y, n, error);
    return status;
}
