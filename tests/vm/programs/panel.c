/* SPDX-License-Identifier: MIT
 *
 * panel LAYOUT WxH RAW NAME - writes NAME.ppm and NAME.png from the memory of a
 * framebuffer, for emulators that cannot take screenshots.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"

struct picture {
    unsigned width, height;
    uint8_t *rgb;
};

static FILE *open_named_framebuffer(const char *name, const char *suffix)
{
    char path[4096];
    snprintf(path, sizeof path, "%s%s", name, suffix);
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static int read_raw_screen(const char *path, const struct layout *layout,
                           struct picture *picture)
{
    FILE *file = fopen(path, "rb");
    uint8_t *dst = picture->rgb, bytes[4];
    if (!file)
        return 0;
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        uint32_t pixel = 0;
        if (fread(bytes, 1, layout->n_bytes, file) != layout->n_bytes)
            return 0;
        for (unsigned b = 0; b < layout->n_bytes; b++)
            pixel |= (uint32_t)bytes[b] << 8 * b;
        for (unsigned c = 0; c < 3; c++) {
            uint32_t mask = (1u << layout->length[c]) - 1;
            *dst++ = shown(layout, c, pixel >> layout->offset[c] & mask);
        }
    }
    fclose(file);
    return 1;
}

/* ---------------------------------------------------------------------- PNG
 * Not compressed: blocks of one row, as the format allows. */
struct png {
    FILE *file;
    /* CRC-32 of the current chunk; both sums of Adler-32 */
    uint32_t crc, s1, s2;
};

static void write_bytes(struct png *png, const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        png->crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            png->crc = png->crc >> 1 ^ (png->crc & 1 ? 0xedb88320u : 0);
    }
    fwrite(bytes, 1, n, png->file);
}

static void write_be32(struct png *png, uint32_t value)
{
    uint8_t bytes[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16),
                        (uint8_t)(value >> 8), (uint8_t)value};
    write_bytes(png, bytes, 4);
}

static void begin_png_chunk(struct png *png, const char *type, uint32_t n_bytes)
{
    write_be32(png, n_bytes);
    png->crc = 0xffffffffu;
    write_bytes(png, (const uint8_t *)type, 4);
}

static void end_png_chunk(struct png *png)
{
    write_be32(png, ~png->crc);
}

static void write_and_add_checksum(struct png *png, const uint8_t *bytes,
                                   size_t n)
{
    write_bytes(png, bytes, n);
    for (size_t i = 0; i < n; i++) {
        png->s1 = (png->s1 + bytes[i]) % 65521;
        png->s2 = (png->s2 + png->s1) % 65521;
    }
}

static void write_compressed_rows(struct png *png,
                                  const struct picture *picture)
{
    static const uint8_t zlib[2] = {0x78, 0x01}, no_filter = 0;
    uint32_t n = picture->width * 3, block = n + 1;
    begin_png_chunk(png, "IDAT", picture->height * (block + 5) + 6);
    write_bytes(png, zlib, 2);
    png->s1 = 1;
    for (unsigned y = 0; y < picture->height; y++) {
        uint8_t head[5] = {y + 1 == picture->height, (uint8_t)block,
                           (uint8_t)(block >> 8), (uint8_t)~block,
                           (uint8_t)(~block >> 8)};
        write_bytes(png, head, 5);
        write_and_add_checksum(png, &no_filter, 1);
        write_and_add_checksum(png, picture->rgb + (size_t)y * n, n);
    }
    write_be32(png, png->s2 << 16 | png->s1);
    end_png_chunk(png);
}

static void write_png(const char *name, const struct picture *picture)
{
    static const uint8_t rgb8[5] = {8, 2, 0, 0, 0};
    struct png png = {.file = open_named_framebuffer(name, ".png")};
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, png.file);
    begin_png_chunk(&png, "IHDR", 13);
    write_be32(&png, picture->width);
    write_be32(&png, picture->height);
    write_bytes(&png, rgb8, 5);
    end_png_chunk(&png);
    write_compressed_rows(&png, picture);
    begin_png_chunk(&png, "IEND", 0);
    end_png_chunk(&png);
    fclose(png.file);
}

static void write_ppm(const char *name, const struct picture *picture)
{
    FILE *file = open_named_framebuffer(name, ".ppm");
    fprintf(file, "P6\n%u %u\n255\n", picture->width, picture->height);
    fwrite(picture->rgb, 3, (size_t)picture->width * picture->height, file);
    fclose(file);
}

int main(int argc, char **argv)
{
    struct layout layout;
    struct picture picture;
    if (argc != 5 || !layout_of(argv[1], &layout) ||
        sscanf(argv[2], "%ux%u", &picture.width, &picture.height) != 2 ||
        picture.width > 16384 || picture.height > 16384) {
        fputs("panel LAYOUT WxH RAW NAME\n", stderr);
        return 2;
    }
    picture.rgb = malloc((size_t)picture.width * picture.height * 3 + 1);
    if (!picture.rgb || !read_raw_screen(argv[3], &layout, &picture)) {
        fprintf(stderr, "%s: cannot read a screen of %s\n", argv[3], argv[2]);
        return 1;
    }
    write_ppm(argv[4], &picture);
    write_png(argv[4], &picture);
    free(picture.rgb);
    return 0;
}
