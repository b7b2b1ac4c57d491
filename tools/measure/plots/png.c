/* SPDX-License-Identifier: MIT
 *
 * PNG as a data: URI. Pixels are compressed if the image plug-in is available;
 * else they are stored uncompressed, which needs no library.
 */
#include <stdlib.h>
#include <string.h>

#include "measure/plots/plot.h"
#include "formats/oiio.h"

enum { BLOCK = 65535 }; /* max bytes of a stored deflate block */

struct bytes {
    uint8_t *at;
    size_t n;
};

static void append_bytes(struct bytes *b, const void *data, size_t n)
{
    memcpy(b->at + b->n, data, n);
    b->n += n;
}

static void append_be32(struct bytes *b, uint32_t v)
{
    const uint8_t big[4] = {(uint8_t)(v >> 24), (uint8_t)(v >> 16),
                            (uint8_t)(v >> 8), (uint8_t)v};

    append_bytes(b, big, 4);
}

static uint32_t compute_crc(const uint8_t *data, size_t n)
{
    uint32_t crc = UINT32_MAX;

    for (size_t i = 0; i < n; i++) {
        crc ^= data[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (crc & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~crc;
}

/* Begins a chunk and returns its offset; append the content, then call
 * end_png_chunk(). */
static size_t begin_png_chunk(struct bytes *b, const char *type)
{
    const size_t start = b->n;

    append_be32(b, 0);
    append_bytes(b, type, 4);
    return start;
}

static void end_png_chunk(struct bytes *b, size_t start)
{
    const size_t length = b->n - start - 8, end = b->n;

    b->n = start;
    append_be32(b, (uint32_t)length);
    b->n = end;
    append_be32(b, compute_crc(b->at + start + 4, length + 4));
}

/* Appends ROWS[N], rows that begin with the filter byte 0, as uncompressed zlib
 * data. */
static void append_pixel_rows(struct bytes *b, const uint8_t *rows, size_t n)
{
    uint32_t a = 1, c = 0;

    append_bytes(b, "\x78\x01", 2);
    for (size_t at = 0; at < n; at += BLOCK) {
        const size_t part = n - at < BLOCK ? n - at : BLOCK;
        const uint8_t header[5] = {at + part == n, (uint8_t)part,
                                   (uint8_t)(part >> 8), (uint8_t)~part,
                                   (uint8_t)(~part >> 8)};

        append_bytes(b, header, 5);
        append_bytes(b, rows + at, part);
    }
    for (size_t i = 0; i < n; i++) {
        a = (a + rows[i]) % 65521; /* NOLINT: ROWS has N bytes */
        c = (c + a) % 65521;
    }
    append_be32(b, c << 16 | a);
}

static void write_base64(FILE *file, const uint8_t *data, size_t n)
{
    static const char digit[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

    for (size_t i = 0; i < n; i += 3) {
        const uint32_t v = (uint32_t)data[i] << 16 |
                           (uint32_t)(i + 1 < n ? data[i + 1] : 0) << 8 |
                           (uint32_t)(i + 2 < n ? data[i + 2] : 0);

        fputc(digit[v >> 18], file);
        fputc(digit[v >> 12 & 63], file);
        fputc(i + 1 < n ? digit[v >> 6 & 63] : '=', file);
        fputc(i + 2 < n ? digit[v & 63] : '=', file);
    }
}

/* Returns an uncompressed PNG file, which the caller frees. Without memory the
 * member AT of the result is NULL. */
static struct bytes make_uncompressed_png(const uint8_t *rgb, int width,
                                          int height)
{
    const size_t row = 3 * (size_t)width, n = (row + 1) * (size_t)height;
    uint8_t *rows = malloc(n);
    struct bytes b = {malloc(n + n / BLOCK * 5 + 100), 0};
    size_t start;

    if (!rows || !b.at) {
        free(rows);
        free(b.at);
        return (struct bytes){NULL, 0};
    }
    for (int y = 0; y < height; y++) {
        rows[(size_t)y * (row + 1)] = 0;
        memcpy(rows + (size_t)y * (row + 1) + 1, rgb + (size_t)y * row, row);
    }
    append_bytes(&b, "\x89PNG\r\n\x1a\n", 8);
    start = begin_png_chunk(&b, "IHDR");
    append_be32(&b, (uint32_t)width);
    append_be32(&b, (uint32_t)height);
    /* 8 bits, RGB, default compression and filter, no interlace; the fifth byte
     * is the 0 that ends the C string */
    append_bytes(&b, "\x08\x02\0\0", 5);
    end_png_chunk(&b, start);
    start = begin_png_chunk(&b, "IDAT");
    append_pixel_rows(&b, rows, n);
    end_png_chunk(&b, start);
    end_png_chunk(&b, begin_png_chunk(&b, "IEND"));
    free(rows);
    return b;
}

/* Returns a compressed PNG file, encoded by the image plug-in. The member AT of
 * the result is NULL if the plug-in is missing or fails. */
static struct bytes make_compressed_png(const uint8_t *rgb, int width,
                                        int height)
{
    const size_t row = 3 * (size_t)width, n = row * (size_t)height;
    struct glint_oiio_pixels pixels = {.width = width, .height = height};
    const struct glint_oiio *oiio;
    struct glint_error error;
    void *data = NULL;
    size_t bytes = 0;

    if (glint_oiio_load(&oiio, &error) != GLINT_OK)
        return (struct bytes){NULL, 0};
    pixels.rgb = malloc(n);
    if (pixels.rgb) {
        memcpy(pixels.rgb, rgb, n);
        if (oiio->encode(&data, &bytes, "x.png", &pixels, (ptrdiff_t)row,
                         &error) != GLINT_OK)
            data = NULL;
    }
    free(pixels.rgb);
    return (struct bytes){data, bytes};
}

void html_write_png(FILE *file, const uint8_t *rgb, int width, int height)
{
    const struct bytes stored = make_uncompressed_png(rgb, width, height);
    const struct bytes small = make_compressed_png(rgb, width, height);
    const bool is_small = small.at && (!stored.at || small.n < stored.n);
    const struct bytes b = is_small ? small : stored;

    if (b.at) {
        fputs("data:image/png;base64,", file);
        write_base64(file, b.at, b.n);
    }
    free(stored.at);
    free(small.at);
}
