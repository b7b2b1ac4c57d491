/* SPDX-License-Identifier: MIT
 *
 * Tests image files: the type is detected by content when loading and chosen by
 * extension when saving. Tests of the image plug-in are skipped unless
 * $GLINT_OIIO names it.
 */
#include <unistd.h>

#include "formats/picture.h"
#include "support/scratch.h"
#include "support/test.h"

static struct glint_error error;

static void expect_loaded_pixels(const char *name, const char *data,
                                 size_t bytes, const char *rgb)
{
    struct glint_image image;

    scratch_write_file(name, data, bytes);
    assert_ok(glint_picture_load(scratch_make_path(name), &image, &error));
    assert_int_equal(image.format, GLINT_RGB24);
    assert_int_equal(image.stride_bytes[0], 3 * image.width);
    assert_memory_equal(image.plane[0], rgb,
                        (size_t)(3 * image.width * image.height));
    glint_picture_free(&image);
    glint_picture_free(&image);
    unlink(scratch_make_path(name));
}

TEST(file_type_is_read_from_the_content)
{
    expect_loaded_pixels("a.png", BYTES("P6 2 1 255 abcdef"), "abcdef");
    expect_loaded_pixels("a", BYTES("P5 2 1 255 ab"), "aaabbb");
    /* The first pixel has the linear light 0, 0.5 and 1, the second one -1, 2
     * and NaN. */
    expect_loaded_pixels("a.ppm",
                         BYTES("PF 2 1 1 \0\0\0\0\x3f\0\0\0\x3f\x80\0\0"
                               "\xbf\x80\0\0\x40\0\0\0\x7f\xc0\0\0"),
                         "\x00\xbc\xff\x00\xff\x00");
}

static void expect_load_fails(enum glint_status status, const char *data,
                              size_t bytes, const char *cause)
{
    struct glint_image image;

    scratch_write_file("a.x", data, bytes);
    assert_int_equal(
        glint_picture_load(scratch_make_path("a.x"), &image, &error), status);
    assert_memory_equal(error.text, scratch_dir, strlen(scratch_dir));
    if (!strstr(error.text, cause))
        fail_msg("%s", error.text);
    unlink(scratch_make_path("a.x"));
}

TEST(rejects_files_that_are_not_pictures)
{
    struct glint_image image;

    expect_load_fails(GLINT_E_FORMAT, BYTES(""), "is empty");
    expect_load_fails(GLINT_E_FORMAT, BYTES("P6 2 2 255 abc"), "ends after");
    expect_load_fails(GLINT_E_UNSUPPORTED, BYTES("YUV4MPEG2 W2 H2\n"),
                      "is a video");
    assert_int_equal(glint_picture_load("/nowhere/a.ppm", &image, &error),
                     GLINT_E_IO);
    assert_int_equal(glint_picture_load(scratch_dir, &image, &error),
                     GLINT_E_IO);
}

TEST(loads_floats)
{
    struct glint_float_image floats;

    scratch_write_file("a", BYTES("Pf 1 1 -1 \0\0\x40\x40"));
    assert_ok(
        glint_picture_load_float(scratch_make_path("a"), &floats, &error));
    assert_true(floats.rgb[2] > 2.999F && floats.rgb[2] < 3.001F);
    free(floats.rgb);
    scratch_write_file("a", BYTES("P5 3 1 255 \0\xbc\xff"));
    assert_ok(
        glint_picture_load_float(scratch_make_path("a"), &floats, &error));
    assert_int_equal(floats.width, 3);
    assert_true(floats.rgb[0] <= 0 && floats.rgb[8] >= 1);
    assert_true(floats.rgb[4] > 0.502F && floats.rgb[4] < 0.504F);
    free(floats.rgb);
    unlink(scratch_make_path("a"));
}

static void expect_save_fails(const char *path, enum glint_picture_kind kind,
                              const char *cause)
{
    assert_int_equal(glint_picture_check(path, kind, &error),
                     GLINT_E_UNSUPPORTED);
    if (!strstr(error.text, cause))
        fail_msg("%s", error.text);
}

TEST(rejects_unknown_extensions)
{
    expect_save_fails("a", GLINT_PICTURE_8BIT, "unknown extension");
    expect_save_fails("a.b/c", GLINT_PICTURE_8BIT, "unknown extension");
    expect_save_fails("a.y4m", GLINT_PICTURE_FLOAT, "unknown extension");
    expect_save_fails("a.pfm", GLINT_PICTURE_8BIT, ".pfm holds linear light");
    expect_save_fails("a.EXR", GLINT_PICTURE_8BIT, ".exr holds linear light");
    expect_save_fails("a.png", GLINT_PICTURE_FLOAT, ".png holds 8-bit codes");
    expect_save_fails("a.ppm", GLINT_PICTURE_FLOAT, ".ppm holds 8-bit codes");
    assert_ok(glint_picture_check("-", GLINT_PICTURE_8BIT, &error));
    assert_ok(glint_picture_check("-", GLINT_PICTURE_FLOAT, &error));
    assert_true(glint_picture_is_float("x/a.PFM"));
    assert_true(glint_picture_is_float("a.exr"));
    assert_false(glint_picture_is_float("a.tif"));
    assert_false(glint_picture_is_float("a.ppm"));
    assert_false(glint_picture_is_float("-"));
    assert_false(glint_picture_is_float("a"));
}

static uint8_t codes[] = "abcdefghijklmnopqr";
static struct glint_image picture = {.format = GLINT_RGB24,
                                     .width = 3,
                                     .height = 2,
                                     .plane = {codes, NULL, NULL},
                                     .stride_bytes = {9, 0, 0}};

static void check_8bit_round_trip(const char *name)
{
    struct glint_image again;

    assert_ok(glint_picture_save(scratch_make_path(name), &picture, &error));
    assert_ok(glint_picture_load(scratch_make_path(name), &again, &error));
    assert_int_equal(again.width, 3);
    assert_int_equal(again.height, 2);
    assert_memory_equal(again.plane[0], codes, 18);
    glint_picture_free(&again);
    unlink(scratch_make_path(name));
}

/* Checks that floats are read back within 1 %. EXR and PFM are lossless; the
 * 8-bit mantissa of HDR is precise enough for these values. */
static void check_float_round_trip(const char *name)
{
    float values[] = {0, 0.5F, 1, 1000, 500, 250};
    const struct glint_float_image floats = {2, 1, values};
    struct glint_float_image again;

    assert_ok(
        glint_picture_save_float(scratch_make_path(name), &floats, &error));
    assert_ok(
        glint_picture_load_float(scratch_make_path(name), &again, &error));
    assert_int_equal(again.width, 2);
    assert_int_equal(again.height, 1);
    for (int i = 0; i < 6; i++)
        assert_true(again.rgb[i] > values[i] * 0.99F - 1e-6F &&
                    again.rgb[i] < values[i] * 1.01F + 1e-6F);
    free(again.rgb);
    unlink(scratch_make_path(name));
}

TEST(native_round_trips)
{
    check_8bit_round_trip("a.ppm");
    check_8bit_round_trip("a.PNM");
    check_float_round_trip("a.pfm");
}

TEST(full_device_is_an_error)
{
    assert_int_equal(symlink("/dev/full", scratch_make_path("a.ppm")), 0);
    assert_int_equal(
        glint_picture_save(scratch_make_path("a.ppm"), &picture, &error),
        GLINT_E_OUTPUT);
    unlink(scratch_make_path("a.ppm"));
}

TEST(reports_a_missing_plugin)
{
    char *const stated = getenv("GLINT_OIIO");
    char *const kept = stated ? strdup(stated) : NULL;

    setenv("GLINT_OIIO", "/nowhere/glint-oiio.so", 1);
    expect_save_fails("a.bmp", GLINT_PICTURE_8BIT,
                      "a.bmp: .bmp needs glint's image plug-in: ");
    expect_load_fails(GLINT_E_UNSUPPORTED, BYTES("GIF89a"),
                      "GIF needs glint's image plug-in: ");
    expect_load_fails(
        GLINT_E_UNSUPPORTED, BYTES("hello"),
        "any file but PPM, PGM and PFM needs glint's image plug-in: ");
    unsetenv("GLINT_OIIO");
    if (kept)
        setenv("GLINT_OIIO", kept, 1);
    free(kept);
}

TEST(plugin_formats_round_trip)
{
    if (!getenv("GLINT_OIIO"))
        skip();
    check_8bit_round_trip("a.png");
    check_8bit_round_trip("a.bmp");
    check_8bit_round_trip("a.tif");
    check_8bit_round_trip("a.tga");
    check_float_round_trip("a.exr");
    check_float_round_trip("a.hdr");
    check_float_round_trip("a.tif");
    expect_load_fails(GLINT_E_FORMAT, BYTES("\x89PNG\r\n\x1a\n"), ": ");
    expect_load_fails(GLINT_E_FORMAT, BYTES("hello"), ": ");
    assert_int_equal(symlink("/dev/full", scratch_make_path("a.png")), 0);
    assert_int_equal(
        glint_picture_save(scratch_make_path("a.png"), &picture, &error),
        GLINT_E_OUTPUT);
    unlink(scratch_make_path("a.png"));
}

TEST_GROUP(scratch_create_dir, scratch_remove_dir);
