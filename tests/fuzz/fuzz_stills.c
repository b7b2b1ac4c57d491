/* SPDX-License-Identifier: MIT
 *
 * Reads random bytes as PNG or JPEG of up to 65536 pixels, by libpng and
 * libjpeg. An accepted picture must be written as PNG and JPEG and read again,
 * with equal pixels from a PNG.
 *
 *     make fuzz FUZZ=stills SECONDS=60
 */
#include <stdio.h>
#include <unistd.h>

#include "formats/still_codec.h"
#include "formats/stills.h"
#include "fuzz/fuzz.h"

enum { MAX_PIXELS = 65536 };

static const char *path; /* of the temporary file */

static void write_path(const void *data, size_t size)
{
    static char text[64];
    static FILE *file;

    if (!file) {
        file = tmpfile();
        require(file != NULL);
        snprintf(text, sizeof text, "/proc/self/fd/%d", fileno(file));
        path = text;
    }
    require(!ftruncate(fileno(file), 0));
    require(pwrite(fileno(file), data, size, 0) == (ssize_t)size);
}

static uint32_t read_big(const uint8_t *at, int n)
{
    uint32_t value = 0;

    while (n-- > 0)
        value = value << 8 | *at++;
    return value;
}

static void write_big32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Sets the checksums of the chunks of a PNG to valid values. */
static void set_checksums(uint8_t *data, size_t size)
{
    struct still_piece piece;
    bool is_last = false;

    for (size_t at = 0; !is_last;) {
        uint32_t sum = 0xffffffff;
        size_t n;

        piece.whole = NULL;
        piece.name[0] = 0;
        is_last = !glint_still_png.next_piece(&piece, data, size, &at);
        if (!piece.whole)
            break;
        n = piece.whole_bytes;
        for (size_t i = 4; i < n - 4; i++) {
            sum ^= piece.whole[i];
            for (int k = 0; k < 8; k++)
                sum = sum >> 1 ^ (sum & 1 ? 0xedb88320 : 0);
        }
        write_big32(data + (piece.whole - data) + n - 4, ~sum);
    }
}

/* Returns whether no header in DATA states more than MAX_PIXELS. libjpeg skips
 * bytes between segments, so that a header may be anywhere. */
static bool is_small(const struct still_codec *codec, const uint8_t *data,
                     size_t size)
{
    if (codec == &glint_still_png)
        return size < 24 ||
               (uint64_t)read_big(data + 16, 4) * read_big(data + 20, 4) <=
                   MAX_PIXELS;
    for (size_t i = 0; i + 9 <= size; i++)
        if (data[i] == 0xff && (data[i + 1] & 0xf0) == 0xc0 &&
            read_big(data + i + 5, 2) * read_big(data + i + 7, 2) > MAX_PIXELS)
            return false;
    return true;
}

/* Reads the temporary file as 8-bit RGB, or returns false. */
static bool read_rgb(struct glint_oiio_pixels *pixels)
{
    struct glint_error error = {.text = ""};

    if (glint_stills_find("PNG")->read(pixels, path, &error)) {
        require(error.text[0]);
        return false;
    }
    return true;
}

/* Writes the bytes DATA, which a writer has made, reads the picture and
 * compares it with PIXELS. */
static void check_written(void *data, size_t bytes,
                          const struct glint_oiio_pixels *pixels, bool is_equal)
{
    struct glint_oiio_pixels again;

    write_path(data, bytes);
    free(data);
    require(read_rgb(&again));
    require(again.width == pixels->width && again.height == pixels->height);
    require(!is_equal ||
            !memcmp(again.rgb, pixels->rgb,
                    3 * (size_t)again.width * (size_t)again.height));
    free(again.rgb);
}

/* Writes FILE in its own type, and PIXELS with its metadata in both. */
static void write_kept(struct glint_oiio_file *file,
                       const struct glint_oiio_pixels *pixels)
{
    static const char *const names[] = {"x.png", "x.jpg"};
    const struct glint_oiio *const face = glint_stills_find("PNG");
    struct glint_samples rgb = {.width = pixels->width,
                                .height = pixels->height,
                                .n_colours = 3,
                                .pixel_bytes = 3,
                                .colour = {{GLINT_SAMPLE_U8, 0},
                                           {GLINT_SAMPLE_U8, 1},
                                           {GLINT_SAMPLE_U8, 2}},
                                .maximum = UINT8_MAX,
                                .mem = pixels->rgb};
    struct glint_error error = {.text = ""};
    void *data;
    size_t bytes;

    for (int i = 0; i < 2; i++) {
        struct glint_oiio_options options = {.quality = 90};
        const bool is_same = face->is_same_type(file, names[i]);

        /* libpng may reject the ICC profile. */
        if (!face->encode_file(&data, &bytes, names[i], file, &rgb, &options,
                               &error))
            check_written(data, bytes, pixels, false);
        else
            require(error.text[0]);
        if (is_same) {
            require(!face->encode_file(&data, &bytes, names[i], file, NULL,
                                       &options, &error));
            check_written(data, bytes, pixels, i == 0);
        }
        require(!face->encode(&data, &bytes, names[i], pixels,
                              3 * (ptrdiff_t)pixels->width, &error));
        check_written(data, bytes, pixels, i == 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct still_codec *const codec =
        size > 0 && data[0] == 0xff ? &glint_still_jpeg : &glint_still_png;
    struct glint_error error = {.text = ""};
    struct glint_oiio_pixels pixels;
    struct glint_oiio_file *file;
    struct glint_samples samples;
    struct glint_oiio_facts facts;
    uint8_t *const copy = fuzz_copy(data, size);

    if (codec == &glint_still_png)
        set_checksums(copy, size);
    if (is_small(codec, copy, size)) {
        write_path(copy, size);
        if (!glint_stills_find("PNG")->open(&file, &samples, &facts, path,
                                            &error)) {
            require(samples.orientation >= 1 && samples.orientation <= 8);
            require(read_rgb(&pixels));
            write_kept(file, &pixels);
            free(pixels.rgb);
            glint_stills_find("PNG")->close(file);
        } else
            require(error.text[0]);
    }
    free(copy);
    return 0;
}
