/* SPDX-License-Identifier: MIT
 *
 * Tests editing image files in place: everything but the added light is
 * preserved. Uses PNM and PFM, which need no plug-in.
 */
#include <unistd.h>

#include "formats/picture.h"
#include "support/scratch.h"
#include "support/test.h"

static struct glint_error error;

static void expect_file_bytes(const char *name, const char *data, size_t bytes)
{
    scratch_expect_bytes(scratch_make_path(name), data, bytes);
    unlink(scratch_make_path(name));
}

/* Opens image NAME, adds LIGHT (1 = white) to all pixels, and writes the result
 * to file TO. */
static void add_light_to_file(const char *name, const char *to, float light)
{
    struct glint_kept kept;
    struct glint_kept_options options = {.quality = 0};
    float layer[36];

    for (int i = 0; i < 36; i++)
        layer[i] = light;
    assert_ok(glint_kept_open(&kept, scratch_make_path(name), &error));
    glint_samples_add_light(&kept.samples, layer);
    if (glint_kept_save(&kept, scratch_make_path(to), NULL, &options, &error))
        fail_msg("%s", error.text);
    glint_kept_close(&kept);
    glint_kept_close(&kept);
    unlink(scratch_make_path(name));
}

static void check_rewritten_file_is_identical(const char *name,
                                              const char *data, size_t bytes)
{
    scratch_write_file(name, data, bytes);
    add_light_to_file(name,
                      name[0] == 'a'   ? "b.pfm"
                      : name[0] == 'c' ? "b.pgm"
                                       : "b.ppm",
                      0);
    expect_file_bytes(name[0] == 'a'   ? "b.pfm"
                      : name[0] == 'c' ? "b.pgm"
                                       : "b.ppm",
                      data, bytes);
}

/* Checks that comments, bit depth, byte order and bytes after the image are
 * unchanged by an edit in place. */
TEST(comments_and_depth_are_preserved)
{
    check_rewritten_file_is_identical("x.ppm",
                                      BYTES("P6 #hello\n2 1 #x\n255\nabcdef"));
    check_rewritten_file_is_identical(
        "x.ppm", BYTES("P6 1 1 1023\n\x03\xff\x01\x02\x00\x01P6 tail"));
    check_rewritten_file_is_identical("x.ppm", BYTES("P6 1 1 100\nabc"));
    check_rewritten_file_is_identical("c.pgm",
                                      BYTES("P5 1 2 65535\n\x12\x34\xab\xcd"));
    check_rewritten_file_is_identical(
        "a.pfm", BYTES("PF\n1 2\n-2.5\nabcdefghijklABCDEFGHIJKL"));
    check_rewritten_file_is_identical("a.pfm", BYTES("Pf 1 1 1 abcd"));
    check_rewritten_file_is_identical(
        "a.pfm", BYTES("PF 1 1 1 \x7f\xc0\0\1\x80\0\0\0\xff\x80\0\0"));
}

TEST(light_is_added_to_float_files)
{
    scratch_write_file("x.pfm", BYTES("Pf 1 2 1 \x40\0\0\0\xbf\x80\0\0"));
    add_light_to_file("x.pfm", "y.pfm", 1);
    expect_file_bytes("y.pfm", BYTES("Pf 1 2 1 \x40\x40\0\0\0\0\0\0"));
    scratch_write_file("x.ppm", BYTES("P6 1 1 65535\n\0\0\0\0\xff\xff"));
    add_light_to_file("x.ppm", "y.ppm", 0.5F);
    expect_file_bytes("y.ppm", BYTES("P6 1 1 65535\n\xbc\x40\xbc\x40\xff\xff"));
}

/* Checks conversion to another file type: the bit depth becomes one that the
 * type supports, and losses are reported. */
TEST(converts_to_other_file_types)
{
    struct glint_kept kept;
    struct glint_kept_options options = {.quality = 0};

    scratch_write_file("x.pfm",
                       BYTES("PF 1 1 1 \x40\0\0\0\x3f\x80\0\0\0\0\0\0"));
    assert_ok(glint_kept_open(&kept, scratch_make_path("x.pfm"), &error));
    assert_true(kept.is_float);
    assert_false(glint_kept_is_same_type(&kept, "x.ppm"));
    assert_true(glint_kept_is_same_type(&kept, "y.pfm"));
    assert_ok(glint_kept_save(&kept, scratch_make_path("y.ppm"), NULL, &options,
                              &error));
    assert_non_null(strstr(options.said, "clipped"));
    glint_kept_close(&kept);
    unlink(scratch_make_path("x.pfm"));
    expect_file_bytes("y.ppm", BYTES("P6\n1 1\n65535\n\xff\xff\xff\xff\0\0"));
    scratch_write_file("x.pgm", BYTES("P5 1 1 255\n\xbc"));
    add_light_to_file("x.pgm", "y.ppm", 0);
    expect_file_bytes("y.ppm", BYTES("P6\n1 1\n255\n\xbc\xbc\xbc"));
}

TEST(copies_files_unchanged)
{
    struct glint_kept kept;

    scratch_write_file("x.ppm", BYTES("P6 1 1 255\nabc and more"));
    assert_ok(glint_kept_open(&kept, scratch_make_path("x.ppm"), &error));
    assert_ok(glint_kept_copy_file(&kept, scratch_make_path("y.ppm"), &error));
    glint_kept_close(&kept);
    unlink(scratch_make_path("x.ppm"));
    expect_file_bytes("y.ppm", BYTES("P6 1 1 255\nabc and more"));
}

static void check_file_is_rejected(enum glint_status status, const char *data,
                                   size_t bytes, const char *cause)
{
    struct glint_kept kept;

    scratch_write_file("x", data, bytes);
    assert_int_equal(glint_kept_open(&kept, scratch_make_path("x"), &error),
                     status);
    if (!strstr(error.text, cause))
        fail_msg("%s", error.text);
    unlink(scratch_make_path("x"));
}

TEST(rejects_invalid_files)
{
    struct glint_kept kept;
    char *const stated = getenv("GLINT_OIIO");

    check_file_is_rejected(GLINT_E_FORMAT, BYTES(""), "is empty");
    check_file_is_rejected(GLINT_E_FORMAT, BYTES("P6 2 2 65535 abcdef"),
                           "ends after");
    check_file_is_rejected(GLINT_E_FORMAT, BYTES("PF 2 2 x abc"), "malformed");
    check_file_is_rejected(GLINT_E_UNSUPPORTED, BYTES("YUV4MPEG2 W2 H2\n"),
                           "is a video");
    assert_int_equal(glint_kept_open(&kept, "/nowhere/x", &error), GLINT_E_IO);
    assert_int_equal(glint_kept_check("a.y4m", &error), GLINT_E_UNSUPPORTED);
    /* This check is impossible if the plug-in is already loaded. */
    if (!stated) {
        setenv("GLINT_OIIO", "/nowhere/glint-oiio.so", 1);
        check_file_is_rejected(GLINT_E_UNSUPPORTED, BYTES("GIF89a"), "plug-in");
        unsetenv("GLINT_OIIO");
    }
}

TEST_GROUP(scratch_create_dir, scratch_remove_dir);
