/* SPDX-License-Identifier: MIT
 *
 * What is bright in random pictures of every format and threshold, against
 * pixel by pixel; and how far pixels are the same.
 */
#include "flare/bright.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"

enum { HEIGHT = 6 };

static const enum glint_pixel_format formats[] = {
    GLINT_RGB24, GLINT_GREY,  GLINT_I420,     GLINT_I422,
    GLINT_I444,  GLINT_NV12,  GLINT_NV21,     GLINT_YUYV,
    GLINT_UYVY,  GLINT_BGR24, GLINT_XRGB8888, GLINT_RGB565};
enum { N_FORMATS = sizeof formats / sizeof *formats };

static uint32_t seed = 1;

static int draw_random(int n)
{
    seed = seed * 1664525 + 1013904223;
    return (int)((uint64_t)(seed >> 8) * (uint32_t)n >> 24);
}

static struct glint_image new_image(enum glint_pixel_format format, int width)
{
    struct glint_image image = {
        .format = format, .width = width, .height = HEIGHT};
    void *mem = malloc(glint_image_bytes(format, width, HEIGHT));

    assert_non_null(mem);
    glint_image_place(&image, mem);
    return image;
}

/* Random bytes, most of them low. */
static void fill(const struct glint_image *image, int rare)
{
    const size_t bytes =
        glint_image_bytes(image->format, image->width, image->height);

    for (size_t i = 0; i < bytes; i++)
        image->plane[0][i] =
            (uint8_t)(draw_random(rare) ? draw_random(64) : draw_random(256));
}

static struct glint_bright *new_bright(int width, void **mem)
{
    struct glint_arena arena = glint_arena_measure();
    struct glint_bright *b = malloc(sizeof *b);

    assert_non_null(b);
    glint_bright_carve(b, &arena, width);
    assert_int_equal(posix_memalign(mem, 64, arena.used), 0);
    memset(*mem, 0x5a, arena.used);
    arena = glint_arena_over(*mem, arena.used);
    glint_bright_carve(b, &arena, width);
    glint_bright_init(b, width);
    return b;
}

static int weigh(int r, int g, int b)
{
    return (54 * r + 183 * g + 19 * b + 128) / 256;
}

static int widen(int v, int bits)
{
    return v << (8 - bits) | v >> (2 * bits - 8);
}

/* Luma by the definition of each format. */
static int luma_at(const struct glint_image *image, int x, int y)
{
    const uint8_t *row = image->plane[0] + y * image->stride_bytes[0];
    int code, bits;

    switch (image->format) {
    case GLINT_RGB24:
        return weigh(row[3 * x], row[3 * x + 1], row[3 * x + 2]);
    case GLINT_BGR24:
        return weigh(row[3 * x + 2], row[3 * x + 1], row[3 * x]);
    case GLINT_XRGB8888:
        return weigh(row[4 * x + 2], row[4 * x + 1], row[4 * x]);
    case GLINT_RGB565:
        bits = row[2 * x] | row[2 * x + 1] << 8;
        return weigh(widen(bits >> 11, 5), widen(bits >> 5 & 63, 6),
                     widen(bits & 31, 5));
    case GLINT_YUYV:
        code = row[2 * x];
        break;
    case GLINT_UYVY:
        code = row[2 * x + 1];
        break;
    default:
        code = row[x];
    }
    if (image->range == GLINT_RANGE_FULL)
        return code;
    return (int)fmax(0, fmin(255, floor((code - 16) * 255 / 219.0 + 0.5)));
}

static void check_scan(struct glint_bright *b, const struct glint_image *image,
                       int low)
{
    int n_bright = 0, n_marked = 0;

    glint_bright_begin(b, image, low);
    for (int y = 0; y < HEIGHT; y++) {
        const int any = glint_bright_scan(b, y);

        for (int x = 0; x < image->width; x++) {
            const int luma = luma_at(image, x, y);
            const int is_marked = any && b->block[x / BRIGHT_BLOCK];

            n_bright += luma >= low;
            n_marked += is_marked;
            if (is_marked)
                assert_int_equal(b->luma[x], luma);
            else
                assert_true(luma < low);
        }
    }
    if (low > 250 && n_bright == 0 && image->width % BRIGHT_BLOCK == 0 &&
        image->format == GLINT_GREY)
        assert_int_equal(n_marked, 0);
}

static void test_scan_against_every_pixel(void **state)
{
    static const int widths[] = {1, 2, 31, 32, 33, 64, 97, 160};
    static const int rares[] = {2, 50, 2000};

    (void)state;
    for (int round = 0; round < N_FORMATS * 8 * 3 * 2; round++) {
        struct glint_image image = new_image(formats[round % N_FORMATS],
                                             widths[round / N_FORMATS % 8]);
        struct glint_bright *b;
        void *mem;

        b = new_bright(image.width, &mem);
        image.range =
            round / (N_FORMATS * 24) ? GLINT_RANGE_LIMITED : GLINT_RANGE_FULL;
        fill(&image, rares[round / (N_FORMATS * 8) % 3]);
        for (int low = 1; low <= 255; low++)
            check_scan(b, &image, low);
        free(b);
        free(mem);
        free(image.plane[0]);
    }
}

/* One pixel of exactly the threshold, anywhere, and one of a code less. */
static void test_no_pixel_is_missed(void **state)
{
    struct glint_image image = new_image(GLINT_GREY, 96);
    struct glint_bright *b;
    void *mem;

    (void)state;
    b = new_bright(image.width, &mem);
    for (int low = 1; low <= 255; low++)
        for (int x = 0; x < 96; x++) {
            glint_bright_begin(b, &image, low);
            memset(image.plane[0], 0, 96);
            image.plane[0][x] = (uint8_t)low;
            assert_int_equal(glint_bright_scan(b, 0), 1);
            for (int i = 0; i < 3; i++)
                assert_int_equal(b->block[i], i == x / BRIGHT_BLOCK);
            image.plane[0][x] = (uint8_t)(low - 1);
            assert_int_equal(glint_bright_scan(b, 0), 0);
        }
    free(b);
    free(mem);
    free(image.plane[0]);
}

/* Spans of the same codes end where the light changes, or sooner where other
 * codes have the same light. */
static void test_same_pixels(void **state)
{
    (void)state;
    for (int round = 0; round < N_FORMATS * 20; round++) {
        struct glint_image image = new_image(formats[round % N_FORMATS], 70);
        struct glint_bright *b;
        int n_long = 0;
        void *mem;

        b = new_bright(image.width, &mem);
        memset(image.plane[0], 255,
               glint_image_bytes(image.format, image.width, HEIGHT));
        for (int i = 0; i < 8; i++)
            image.plane[0][draw_random((int)glint_image_bytes(
                image.format, image.width, HEIGHT))] = 77;
        glint_bright_begin(b, &image, 1);
        for (int y = 0; y < HEIGHT; y++) {
            glint_bright_scan(b, y);
            for (int x = 0, end; x < 70; x = end) {
                int32_t here[3], there[3];

                end = glint_bright_same(b, x, 70);
                assert_in_range(end, x + 1, 70);
                n_long += end > x + 20;
                glint_bright_read(b, x, here);
                for (int i = x; i < end; i++) {
                    glint_bright_read(b, i, there);
                    assert_memory_equal(here, there, sizeof here);
                }
            }
        }
        assert_true(n_long > 0);
        free(b);
        free(mem);
        free(image.plane[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scan_against_every_pixel),
        cmocka_unit_test(test_no_pixel_is_missed),
        cmocka_unit_test(test_same_pixels),
    };

    return cmocka_run_group_tests_name("bright", tests, NULL, NULL);
}
