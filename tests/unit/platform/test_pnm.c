/* SPDX-License-Identifier: MIT
 *
 * Checks that hand-written PPM, PGM and PFM files are read correctly, and that
 * hostile headers and files cut at any byte are rejected.
 */
#include <unistd.h>

#include "formats/pnm.h"
#include "posix/input.h"
#include "support/scratch.h"
#include "support/test.h"

static struct glint_error error;

/* Returns an allocated copy of exactly BYTES bytes, so that ASan detects
 * overreads. */
static void *allocate_copy_of_bytes(const void *data, size_t bytes)
{
    void *const copy = malloc(bytes ? bytes : 1);

    assert_non_null(copy);
    memcpy(copy, data, bytes);
    return copy;
}

static enum glint_status read_pnm_copy(struct glint_image *image,
                                       const char *data, size_t bytes)
{
    void *const copy = allocate_copy_of_bytes(data, bytes);
    const enum glint_status status =
        glint_pnm_read(image, copy, bytes, "x.ppm", &error);

    free(copy);
    return status;
}

static enum glint_status read_pfm_copy(struct glint_float_image *floats,
                                       const char *data, size_t bytes)
{
    void *const copy = allocate_copy_of_bytes(data, bytes);
    const enum glint_status status =
        glint_pfm_read(floats, copy, bytes, "x.pfm", &error);

    free(copy);
    return status;
}

/* ------------------------------------------------------------- reading PNM */

static void expect_pnm_pixels(const char *data, size_t bytes,
                              enum glint_pixel_format format, int width,
                              int height, const char *samples)
{
    struct glint_image image;

    assert_ok(read_pnm_copy(&image, data, bytes));
    assert_int_equal(image.format, format);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.range, GLINT_RANGE_FULL);
    assert_int_equal(image.transfer, GLINT_TONE_SRGB);
    assert_memory_equal(image.plane[0], samples,
                        glint_image_bytes(format, width, height));
    free(image.plane[0]);
}

TEST(reads_every_pnm_type)
{
    expect_pnm_pixels(BYTES("P6\n2 1\n255\nabcdef"), GLINT_RGB24, 2, 1,
                      "abcdef");
    expect_pnm_pixels(BYTES("P5\n2 3\n255\nabcdef"), GLINT_GREY, 2, 3,
                      "abcdef");
    /* bytes after the first image are ignored */
    expect_pnm_pixels(BYTES("P5 1 1 255 aP5 1 1 255 b"), GLINT_GREY, 1, 1, "a");
    /* samples may look like white space */
    expect_pnm_pixels(BYTES("P5\n3 1\n255\n\n #"), GLINT_GREY, 3, 1, "\n #");
}

TEST(accepts_comments)
{
    expect_pnm_pixels(BYTES("P5#made by\n# GIMP\n 2\t\r\n#x\n1#y\n255\nab"),
                      GLINT_GREY, 2, 1, "ab");
    /* The header may end with a comment. Its line feed separates the header
     * from the samples. */
    expect_pnm_pixels(BYTES("P5 2 1 255#end\nab"), GLINT_GREY, 2, 1, "ab");
    expect_pnm_pixels(BYTES("P5 0002 01 00255 ab"), GLINT_GREY, 2, 1, "ab");
}

TEST(scales_samples_to_255)
{
    /* with maximum 2, sample 1 is 127.5 and rounds up; 3 is clamped to 2 */
    expect_pnm_pixels(BYTES("P5 4 1 2 \x00\x01\x02\x03"), GLINT_GREY, 4, 1,
                      "\x00\x80\xff\xff");
    expect_pnm_pixels(BYTES("P5 2 1 1 \x00\x01"), GLINT_GREY, 2, 1, "\x00\xff");
    /* 16-bit samples: 128 of 65535 is 0.498 of an 8-bit step, so it rounds
     * down; 129 is 0.502 and rounds up */
    expect_pnm_pixels(
        BYTES("P5 5 1 65535 \x00\x80\x00\x81\xff\xff\x80\x80\x00\x00"),
        GLINT_GREY, 5, 1, "\x00\x01\xff\x80\x00");
    /* The samples have 10 bits. The third sample exceeds the maximum of 1023
     * and is clamped. */
    expect_pnm_pixels(BYTES("P6 1 1 1023 \x03\xff\x02\x00\xff\xff"),
                      GLINT_RGB24, 1, 1, "\xff\x80\xff");
}

static void check_pnm_is_rejected(enum glint_status status, const char *data,
                                  size_t bytes)
{
    struct glint_image image = {.width = 77};

    if (read_pnm_copy(&image, data, bytes) != status)
        fail_msg("%s", data);
    assert_memory_equal(error.text, "x.ppm: ", 7);
    assert_int_equal(image.width, 77);
}

TEST(rejects_invalid_headers)
{
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES(""));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("P"));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("P6"));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("P61 1 255 abc"));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("P3 1 1 255 1 2 3"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 0 1 255 abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 0 255 abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 -1 1 255 abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1.5 1 255 abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 1 0 abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 1 65536 abcdef"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 1 255"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 1 255abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 1 255#abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 1 1 # 255 abc"));
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 \0001 1 255 abc"));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("P6 32769 1 255 abc"));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("P6 1 32769 255 abc"));
    check_pnm_is_rejected(GLINT_E_UNSUPPORTED,
                          BYTES("P6 99999999999999999999 4294967297 255 abc"));
    /* no memory is allocated for a size whose samples are missing */
    check_pnm_is_rejected(GLINT_E_FORMAT, BYTES("P6 8192 8192 65535 abc"));
    assert_string_equal(
        error.text,
        "x.ppm: ends after 3 of 402653184 bytes of a 8192 x 8192 picture");
}

TEST(rejects_truncated_pnm)
{
    static const char ppm[] =
        "P6\n# x\n2 1\n65535\n\0\1\2\3\4\5\6\7\10\11\12\13";
    struct glint_image image;

    for (size_t n = 0; n < sizeof ppm - 1; n++)
        check_pnm_is_rejected(n < 3 ? GLINT_E_UNSUPPORTED : GLINT_E_FORMAT, ppm,
                              n);
    assert_ok(read_pnm_copy(&image, ppm, sizeof ppm - 1));
    free(image.plane[0]);
}

/* ------------------------------------------------------------- reading PFM */

/* PFM stores the bottom row first: two_pixels, as a 1 x 2 image, is stored
 * as 0, 3, 4, then 1, -2, 0.5. These macros are little-endian floats; TWO is
 * -2. */
#define ONE   "\x00\x00\x80\x3f"
#define TWO   "\x00\x00\x00\xc0"
#define HALF  "\x00\x00\x00\x3f"
#define ZERO  "\x00\x00\x00\x00"
#define THREE "\x00\x00\x40\x40"
#define FOUR  "\x00\x00\x80\x40"

static const float two_pixels[6] = {1, -2, 0.5F, 0, 3, 4};

static void expect_pfm_pixels(const char *data, size_t bytes, int width,
                              int height, const float *values)
{
    struct glint_float_image floats;

    assert_ok(read_pfm_copy(&floats, data, bytes));
    assert_int_equal(floats.width, width);
    assert_int_equal(floats.height, height);
    assert_memory_equal(floats.rgb, values,
                        (size_t)(width * height) * 3 * sizeof(float));
    free(floats.rgb);
}

TEST(reads_grey_and_colour_pfm)
{
    static const float grey[6] = {3, 3, 3, 4, 4, 4};

    expect_pfm_pixels(BYTES("PF\n1 2\n-1.0\n" ZERO THREE FOUR ONE TWO HALF), 1,
                      2, two_pixels);
    expect_pfm_pixels(BYTES("PF\n2 1\n-1.0\n" ONE TWO HALF ZERO THREE FOUR), 2,
                      1, two_pixels);
    expect_pfm_pixels(BYTES("Pf 2 1 -0.5 " THREE FOUR), 2, 1, grey);
    expect_pfm_pixels(BYTES("Pf\n2 1\n1\n\x40\x40\x00\x00\x40\x80\x00\x00"), 2,
                      1, grey);
}

TEST(reads_nan_infinity_and_denormals)
{
    struct glint_float_image floats;

    assert_ok(read_pfm_copy(&floats, BYTES("PF 1 1 -1 \x00\x00\xc0\x7f"
                                           "\x00\x00\x80\x7f"
                                           "\x01\x00\x00\x00")));
    assert_true(isnan(floats.rgb[0]));
    assert_true(isinf(floats.rgb[1]));
    assert_true(floats.rgb[2] > 0 && floats.rgb[2] < 1e-44F);
    free(floats.rgb);
}

static void check_pfm_is_rejected(enum glint_status status, const char *data,
                                  size_t bytes)
{
    struct glint_float_image floats = {77, 0, NULL};

    if (read_pfm_copy(&floats, data, bytes) != status)
        fail_msg("%s", data);
    assert_memory_equal(error.text, "x.pfm: ", 7);
    assert_int_equal(floats.width, 77);
}

TEST(rejects_invalid_pfm)
{
    check_pfm_is_rejected(GLINT_E_UNSUPPORTED, BYTES(""));
    check_pfm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("PF"));
    check_pfm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("PG\n1 1\n-1\n"));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 0 1 -1 " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 0 -1 " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 -1 -1 " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 1 0 " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 1 nan " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 1 -inf " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 1 -1x " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1x 1 -1 " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("Pf 1 1 -1\0 " ONE));
    check_pfm_is_rejected(
        GLINT_E_FORMAT,
        BYTES("Pf 1 1 -1.0000000000000000000000000000000000000 " ONE));
    check_pfm_is_rejected(GLINT_E_UNSUPPORTED, BYTES("Pf 32769 1 -1 " ONE));
    check_pfm_is_rejected(GLINT_E_UNSUPPORTED,
                          BYTES("Pf 1 9999999999999999 -1 " ONE));
    check_pfm_is_rejected(GLINT_E_FORMAT, BYTES("PF 8192 8192 -1 " ONE));
}

TEST(rejects_truncated_pfm)
{
    static const char pfm[] = "PF\n1 2\n-1.0\n" ZERO THREE FOUR ONE TWO HALF;

    for (size_t n = 0; n < sizeof pfm - 1; n++)
        check_pfm_is_rejected(n < 3 ? GLINT_E_UNSUPPORTED : GLINT_E_FORMAT, pfm,
                              n);
}

/* ----------------------------------------------------------------- writing */

static void open_output_file(struct glint_output *out)
{
    assert_ok(
        glint_output_open(out, scratch_file, GLINT_OUTPUT_BINARY, &error));
}

static void expect_output_bytes(struct glint_output *out, const char *want,
                                size_t want_bytes)
{
    uint8_t *data;
    size_t bytes;

    assert_ok(glint_output_commit(out, &error));
    assert_ok(glint_input_read_whole_file(&data, &bytes, scratch_file, 10000,
                                          &error));
    assert_int_equal(bytes, want_bytes);
    assert_memory_equal(data, want, bytes);
    free(data);
}

TEST(writes_ppm)
{
    uint8_t padded[] = "abcdef--ghijkl--";
    struct glint_image image = {.format = GLINT_RGB24,
                                .width = 2,
                                .height = 2,
                                .plane = {padded, NULL, NULL},
                                .stride_bytes = {8, 0, 0}};
    struct glint_output out;

    open_output_file(&out);
    assert_ok(glint_pnm_write(&out, &image, &error));
    expect_output_bytes(&out, BYTES("P6\n2 2\n255\nabcdefghijkl"));

    image.plane[0] = padded + 8; /* in memory the bottom row is stored first */
    image.stride_bytes[0] = -8;
    open_output_file(&out);
    assert_ok(glint_pnm_write(&out, &image, &error));
    expect_output_bytes(&out, BYTES("P6\n2 2\n255\nghijklabcdef"));
}

TEST(writes_pfm)
{
    float values[6];
    const struct glint_float_image floats = {1, 2, values};
    struct glint_output out;

    memcpy(values, two_pixels, sizeof values);
    open_output_file(&out);
    assert_ok(glint_pfm_write(&out, &floats, &error));
    expect_output_bytes(&out,
                        BYTES("PF\n1 2\n-1.0\n" ZERO THREE FOUR ONE TWO HALF));
}

/* Checks that an image of odd width, with more rows than are encoded at a time,
 * is unchanged after writing and reading. */
TEST(pfm_round_trip)
{
    enum { W = 333, H = 3, N = W * H * 3 };
    static float values[N];
    const struct glint_float_image floats = {W, H, values};
    struct glint_float_image again;
    struct glint_output out;
    uint8_t *data;
    size_t bytes;

    for (int i = 0; i < N; i++)
        values[i] = (float)i * 0.37F - 100;
    open_output_file(&out);
    assert_ok(glint_pfm_write(&out, &floats, &error));
    assert_ok(glint_output_commit(&out, &error));
    assert_ok(glint_input_read_whole_file(&data, &bytes, scratch_file, 100000,
                                          &error));
    assert_ok(glint_pfm_read(&again, data, bytes, scratch_file, &error));
    assert_memory_equal(again.rgb, values, sizeof values);
    free(again.rgb);
    free(data);
}

TEST_GROUP(scratch_create_file, scratch_remove_file);
