/* SPDX-License-Identifier: MIT
 *
 * Compares the search for bright pixels with a test of each pixel, in random
 * images of every format and threshold. Checks the reported lengths of runs of
 * equal pixels.
 */
#include "support/canvas.h"
#include "support/rng.h"
#include "lamps/bright_code.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "support/test.h"

enum { HEIGHT = 6 };

static uint32_t seed = 1;

/* Fills IMAGE with random bytes. Only one byte in RARE may exceed 63. */
static void fill_with_random_bytes(const struct glint_image *image, int rare)
{
    const size_t bytes =
        glint_image_bytes(image->format, image->width, image->height);

    for (size_t i = 0; i < bytes; i++)
        image->plane[0][i] =
            (uint8_t)(rng_int_below(&seed, rare) ? rng_int_below(&seed, 64)
                                                 : rng_int_below(&seed, 256));
}

static struct glint_bright *create_bright_scanner(int width, void **mem)
{
    struct glint_arena arena = glint_arena_begin_measuring();
    struct glint_bright *b = malloc(sizeof *b);

    assert_non_null(b);
    glint_bright_allocate(b, &arena, width);
    assert_int_equal(posix_memalign(mem, 64, arena.used), 0);
    memset(*mem, 0x5a, arena.used);
    arena = glint_arena_init_in_memory(*mem, arena.used);
    glint_bright_allocate(b, &arena, width);
    glint_bright_init(b, width);
    return b;
}

static int compute_luma(int r, int g, int b)
{
    return (54 * r + 183 * g + 19 * b + 128) / 256;
}

static int widen_code_to_8_bits(int v, int bits)
{
    return v << (8 - bits) | v >> (2 * bits - 8);
}

/* Sets *LARGEST to the largest of R, G, B and *LUMA to the luma of a pixel, by
 * the definition of YCbCr. */
static void compute_ycc_brightness(const struct glint_image *image,
                                   const int code[3], double *largest,
                                   int *luma)
{
    const int limited = image->range == GLINT_RANGE_LIMITED;
    const int is_709 = image->matrix == GLINT_MATRIX_BT709;
    const double kr = is_709 ? 0.2126 : 0.299, kb = is_709 ? 0.0722 : 0.114;
    const double y = limited ? (code[0] - 16) * 255 / 219.0 : code[0];
    const double scale = limited ? 255 / 224.0 : 1;
    const double cb = (code[1] - 128) * scale, cr = (code[2] - 128) * scale;
    const double red = y + 2 * (1 - kr) * cr, blue = y + 2 * (1 - kb) * cb;
    const double green = (y - kr * red - kb * blue) / (1 - kr - kb);

    *largest = fmax(red, fmax(green, blue));
    *luma = (int)fmax(0, fmin(255, floor(y + 0.5)));
}

static const uint8_t *address_of_sample(const struct glint_image *image,
                                        int plane, int x, int y)
{
    return image->plane[plane] + y * image->stride_bytes[plane] + x;
}

/* Sets CODE to Y, Cb, Cr of pixel (X, Y). */
static void read_ycc_codes(const struct glint_image *image, int x, int y,
                           int code[3])
{
    const int cx = x / 2, cy = y / 2;
    const uint8_t *row = address_of_sample(image, 0, 0, y);

    code[0] = row[x];
    code[1] = code[2] = 128;
    if (image->format == GLINT_YUYV)
        code[0] = row[2 * x], code[1] = row[4 * cx + 1],
        code[2] = row[4 * cx + 3];
    if (image->format == GLINT_UYVY)
        code[0] = row[2 * x + 1], code[1] = row[4 * cx],
        code[2] = row[4 * cx + 2];
    for (int i = 1; i < 3; i++) {
        if (image->format == GLINT_I420)
            code[i] = *address_of_sample(image, i, cx, cy);
        if (image->format == GLINT_I422)
            code[i] = *address_of_sample(image, i, cx, y);
        if (image->format == GLINT_I444)
            code[i] = *address_of_sample(image, i, x, y);
        if (image->format == GLINT_NV12)
            code[i] = *address_of_sample(image, 1, 2 * cx + i - 1, cy);
        if (image->format == GLINT_NV21)
            code[i] = *address_of_sample(image, 1, 2 * cx + 2 - i, cy);
    }
}

static int compute_brightness_of_clipped_luma(int luma)
{
    return 250 + (luma > 177 ? (luma - 177) / 15 : 0);
}

static int compute_rgb_brightness(int r, int g, int b)
{
    const int largest = r > g ? r > b ? r : b : g > b ? g : b;

    return largest < 250
               ? largest
               : compute_brightness_of_clipped_luma(compute_luma(r, g, b));
}

/* Sets *LEAST and *MOST to the brightness of pixel (X, Y) as its format defines
 * it. If the exact value is nearly half-way between two integers, they differ
 * by 1, so that both roundings are correct. */
static void compute_brightness_range(const struct glint_image *image, int x,
                                     int y, int *least, int *most)
{
    const uint8_t *row = address_of_sample(image, 0, 0, y);
    int code[3], bits, luma, rounded[2];
    double largest;

    switch (image->format) {
    case GLINT_RGB24:
        *least = *most =
            compute_rgb_brightness(row[3 * x], row[3 * x + 1], row[3 * x + 2]);
        return;
    case GLINT_BGR24:
        *least = *most =
            compute_rgb_brightness(row[3 * x + 2], row[3 * x + 1], row[3 * x]);
        return;
    case GLINT_XRGB8888:
        *least = *most =
            compute_rgb_brightness(row[4 * x + 2], row[4 * x + 1], row[4 * x]);
        return;
    case GLINT_RGB565:
        bits = row[2 * x] | row[2 * x + 1] << 8;
        *least = *most =
            compute_rgb_brightness(widen_code_to_8_bits(bits >> 11, 5),
                                   widen_code_to_8_bits(bits >> 5 & 63, 6),
                                   widen_code_to_8_bits(bits & 31, 5));
        return;
    default:
        read_ycc_codes(image, x, y, code);
        compute_ycc_brightness(image, code, &largest, &luma);
    }
    for (int i = 0; i < 2; i++) {
        rounded[i] = (int)floor(largest + 0.3 + 0.4 * i);
        rounded[i] = rounded[i] < 0 ? 0
                     : rounded[i] >= 250
                         ? compute_brightness_of_clipped_luma(luma)
                         : rounded[i];
    }
    *least = rounded[0];
    *most = rounded[1];
}

static void check_scan_of_image(struct glint_bright *b,
                                const struct glint_image *image, int low)
{
    int n_bright = 0, n_marked = 0;

    glint_bright_begin_picture(b, image);
    glint_bright_set_min_brightness(b, low);
    for (int y = 0; y < HEIGHT; y++) {
        const int any = glint_bright_scan_row(b, y);

        for (int x = 0; x < image->width; x++) {
            const int is_marked = any && b->block[x / BRIGHT_BLOCK];
            int least, most;

            compute_brightness_range(image, x, y, &least, &most);
            n_bright += most >= low;
            n_marked += is_marked;
            if (is_marked)
                assert_in_range(b->value[x], least, most);
            else
                assert_true(least < low);
            if (is_marked)
                assert_in_range(b->block[x / BRIGHT_BLOCK], b->value[x], 255);
            assert_in_range(bright_compute_pixel_brightness(b, x), least, most);
        }
    }
    if (n_bright == 0)
        assert_int_equal(n_marked, 0);
}

TEST(scan_matches_a_test_of_every_pixel)
{
    static const int widths[] = {1, 2, 31, 32, 33, 64, 97, 160};
    static const int rares[] = {2, 50, 2000};

    for (int round = 0; round < CANVAS_FORMATS * 8 * 3 * 2; round++) {
        struct glint_image image =
            canvas_allocate_image(canvas_format[round % CANVAS_FORMATS],
                                  widths[round / CANVAS_FORMATS % 8], HEIGHT);
        struct glint_bright *b;
        void *mem;

        b = create_bright_scanner(image.width, &mem);
        image.range = round / (CANVAS_FORMATS * 24) ? GLINT_RANGE_LIMITED
                                                    : GLINT_RANGE_FULL;
        image.matrix = (enum glint_matrix)(round % 2);
        fill_with_random_bytes(&image, rares[round / (CANVAS_FORMATS * 8) % 3]);
        for (int low = 1; low <= 255; low++)
            check_scan_of_image(b, &image, low);
        free(b);
        free(mem);
        free(image.plane[0]);
    }
}

/* The search reads the last block of a row in complete words. Checks that the
 * block's padding, which create_bright_scanner() fills with 0x5a, is
 * cleared. */
TEST(padding_is_cleared)
{
    for (int width = 1; width <= 2 * BRIGHT_BLOCK; width++) {
        struct glint_image image =
            canvas_allocate_image(GLINT_RGB24, width, HEIGHT);
        void *mem;
        struct glint_bright *b = create_bright_scanner(width, &mem);

        fill_with_random_bytes(&image, 1);
        glint_bright_begin_picture(b, &image);
        glint_bright_set_min_brightness(b, 1);
        glint_bright_scan_row(b, 0);
        for (int x = width; x % BRIGHT_BLOCK; x++)
            assert_int_equal(b->value[x], 0);
        free(b);
        free(mem);
        free(image.plane[0]);
    }
}

/* Checks that a single pixel exactly at the threshold is found anywhere, and
 * that a pixel one code darker is not. */
TEST(finds_a_pixel_at_the_threshold)
{
    struct glint_image image = canvas_allocate_image(GLINT_GREY, 96, HEIGHT);
    struct glint_bright *b;
    void *mem;

    b = create_bright_scanner(image.width, &mem);
    for (int low = 1; low <= 250; low++)
        for (int x = 0; x < 96; x++) {
            const int value = low < 250 ? low : 254;

            glint_bright_begin_picture(b, &image);
            glint_bright_set_min_brightness(b, low);
            memset(image.plane[0], 0, 96);
            image.plane[0][x] = (uint8_t)low;
            assert_int_equal(glint_bright_scan_row(b, 0), value);
            for (int i = 0; i < 3; i++)
                assert_int_equal(b->block[i],
                                 i == x / BRIGHT_BLOCK ? value : 0);
            image.plane[0][x] = (uint8_t)(low - 1);
            assert_int_equal(glint_bright_scan_row(b, 0), 0);
        }
    free(b);
    free(mem);
    free(image.plane[0]);
}

/* Checks that the one different code in a row of dim grey is detected: in the
 * four blocks that are tested together, and in the fifth block. */
TEST(finds_a_differing_code_in_grey)
{
    static const enum glint_pixel_format packed[] = {GLINT_YUYV, GLINT_UYVY};

    for (int round = 0; round < 2000; round++) {
        struct glint_image image =
            canvas_allocate_image(packed[round % 2], 160, HEIGHT);
        const int chroma_at = round % 2 ? 0 : 1;
        struct glint_bright *b;
        void *mem;

        b = create_bright_scanner(image.width, &mem);
        image.range = round / 2 % 2 ? GLINT_RANGE_LIMITED : GLINT_RANGE_FULL;
        for (int y = 0; y < HEIGHT; y++) {
            const int luma = rng_int_below(&seed, 230),
                      chroma = 100 + rng_int_below(&seed, 56);
            uint8_t *row = image.plane[0] + y * image.stride_bytes[0];

            for (int i = 0; i < 2 * image.width; i++)
                row[i] = (uint8_t)(i % 2 == chroma_at ? chroma : luma);
            row[rng_int_below(&seed, 2 * image.width)] =
                (uint8_t)rng_int_below(&seed, 256);
        }
        check_scan_of_image(b, &image, 100 + rng_int_below(&seed, 156));
        free(b);
        free(mem);
        free(image.plane[0]);
    }
}
