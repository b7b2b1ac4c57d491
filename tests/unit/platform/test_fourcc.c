/* SPDX-License-Identifier: MIT
 *
 * Checks that V4L2 FOURCCs and colour spaces convert to glint's formats and
 * back.
 */
#include "linux/fourcc.h"
#include "support/test.h"

#include <linux/videodev2.h>

static uint32_t parse_fourcc(const char *text)
{
    uint32_t fourcc = 0;

    assert_true(glint_fourcc_parse(text, &fourcc));
    return fourcc;
}

static void expect_format_of_name(const char *text,
                                  enum glint_pixel_format want)
{
    enum glint_pixel_format format = GLINT_LINEAR_Q20;

    assert_true(glint_fourcc_to_format(parse_fourcc(text), &format));
    assert_int_equal(format, want);
}

TEST(names_give_their_formats)
{
    expect_format_of_name("YUYV", GLINT_YUYV);
    expect_format_of_name("yuyv422", GLINT_YUYV);
    expect_format_of_name("UYVY", GLINT_UYVY);
    expect_format_of_name("nv12", GLINT_NV12);
    expect_format_of_name("NM12", GLINT_NV12);
    expect_format_of_name("NV21", GLINT_NV21);
    expect_format_of_name("NM21", GLINT_NV21);
    expect_format_of_name("YU12", GLINT_I420);
    expect_format_of_name("yuv420p", GLINT_I420);
    expect_format_of_name("YM12", GLINT_I420);
    expect_format_of_name("422P", GLINT_I422);
    expect_format_of_name("YM16", GLINT_I422);
    expect_format_of_name("yuv444p", GLINT_I444);
    expect_format_of_name("GREY", GLINT_GREY);
    expect_format_of_name("gray", GLINT_GREY);
    expect_format_of_name("RGB3", GLINT_RGB24);
    expect_format_of_name("bgr24", GLINT_BGR24);
    expect_format_of_name("XR24", GLINT_XRGB8888);
    expect_format_of_name("AR24", GLINT_XRGB8888);
    expect_format_of_name("RGBP", GLINT_RGB565);
}

/* A FOURCC is a 32-bit word whose lowest byte is the first letter. Checks codes
 * computed by hand. */
TEST(fourccs_match_hand_computation)
{
    assert_int_equal(glint_fourcc_from_format(GLINT_YUYV), 0x56595559);
    assert_int_equal(glint_fourcc_from_format(GLINT_I420), 0x32315559);
    assert_int_equal(glint_fourcc_from_format(GLINT_XRGB8888), 0x34325258);
    assert_int_equal(glint_fourcc_from_format(GLINT_I444), 0);
    assert_int_equal(glint_fourcc_from_format(GLINT_LINEAR_Q20), 0);
    assert_int_equal(parse_fourcc("MJPG"), 0x47504a4d);
    assert_int_equal(parse_fourcc("mjpeg"), 0x47504a4d);
    /* Unknown codes are returned unchanged. */
    assert_int_equal(parse_fourcc("pRAA"), 0x41415270);
}

TEST(formats_and_fourccs_are_inverse)
{
    for (int i = GLINT_RGB24; i <= GLINT_XBGR8888; i++) {
        const uint32_t fourcc =
            glint_fourcc_from_format((enum glint_pixel_format)i);
        enum glint_pixel_format format;
        char text[5];

        if (i == GLINT_I444 || i == GLINT_LINEAR_Q20)
            continue;
        assert_true(glint_fourcc_to_format(fourcc, &format));
        assert_int_equal(format, i);
        glint_fourcc_text(fourcc, text);
        assert_int_equal(parse_fourcc(text), fourcc);
    }
}

TEST(rejects_unknown_fourccs)
{
    enum glint_pixel_format format;
    uint32_t fourcc;
    char text[5];

    assert_false(glint_fourcc_to_format(parse_fourcc("MJPG"), &format));
    assert_false(glint_fourcc_to_format(0, &format));
    assert_false(glint_fourcc_parse("", &fourcc));
    assert_false(glint_fourcc_parse("YUV", &fourcc));
    assert_false(glint_fourcc_parse("YUYV2", &fourcc));
    assert_false(glint_fourcc_parse("YU\tV", &fourcc));
    glint_fourcc_text(0x00ff0a41, text);
    assert_string_equal(text, "A???");
}

/* ------------------------------------------------------------------ colours */

static bool convert_colour(struct glint_image *image,
                           enum glint_pixel_format format, uint32_t space,
                           uint32_t enc, uint32_t quantization, uint32_t xfer)
{
    const struct glint_v4l2_colour colour = {space, enc, quantization, xfer};

    *image = (struct glint_image){.format = format};
    return glint_v4l2_colour_to_image(&colour, image);
}

TEST(undeclared_colour_has_defaults)
{
    struct glint_image i;

    /* vivid and most webcams report sRGB and leave the other colour fields at
     * their defaults */
    assert_true(convert_colour(&i, GLINT_YUYV, V4L2_COLORSPACE_SRGB, 0, 0, 0));
    assert_int_equal(i.range, GLINT_RANGE_LIMITED);
    assert_int_equal(i.matrix, GLINT_MATRIX_BT601);
    assert_int_equal(i.transfer, GLINT_TONE_SRGB);
    /* JPEG has full range. */
    assert_true(convert_colour(&i, GLINT_I420, V4L2_COLORSPACE_JPEG, 0, 0, 0));
    assert_int_equal(i.range, GLINT_RANGE_FULL);
    assert_int_equal(i.matrix, GLINT_MATRIX_BT601);
    assert_true(
        convert_colour(&i, GLINT_NV12, V4L2_COLORSPACE_REC709, 0, 0, 0));
    assert_int_equal(i.range, GLINT_RANGE_LIMITED);
    assert_int_equal(i.matrix, GLINT_MATRIX_BT709);
    assert_int_equal(i.transfer, GLINT_TONE_BT709);
    assert_true(
        convert_colour(&i, GLINT_NV12, V4L2_COLORSPACE_SMPTE170M, 0, 0, 0));
    assert_int_equal(i.matrix, GLINT_MATRIX_BT601);
    assert_int_equal(i.transfer, GLINT_TONE_BT709);
    assert_true(convert_colour(&i, GLINT_RGB24, V4L2_COLORSPACE_SRGB, 0, 0, 0));
    assert_int_equal(i.range, GLINT_RANGE_FULL);
    assert_true(convert_colour(&i, GLINT_GREY, V4L2_COLORSPACE_SRGB, 0, 0, 0));
    assert_int_equal(i.range, GLINT_RANGE_FULL);
}

TEST(declared_colour_is_used)
{
    struct glint_image i;

    assert_true(convert_colour(&i, GLINT_UYVY, V4L2_COLORSPACE_SRGB,
                               V4L2_YCBCR_ENC_709, V4L2_QUANTIZATION_FULL_RANGE,
                               V4L2_XFER_FUNC_709));
    assert_int_equal(i.range, GLINT_RANGE_FULL);
    assert_int_equal(i.matrix, GLINT_MATRIX_BT709);
    assert_int_equal(i.transfer, GLINT_TONE_BT709);
    /* A colour space that glint does not support is rejected. */
    assert_false(
        convert_colour(&i, GLINT_NV12, V4L2_COLORSPACE_BT2020, 0, 0, 0));
    assert_int_equal(i.matrix, GLINT_MATRIX_BT709);
    assert_false(convert_colour(&i, GLINT_RGB24, V4L2_COLORSPACE_SRGB, 0,
                                V4L2_QUANTIZATION_LIM_RANGE, 0));
    assert_int_equal(i.range, GLINT_RANGE_FULL);
    assert_false(convert_colour(&i, GLINT_YUYV, V4L2_COLORSPACE_RAW, 0, 0, 0));
}

TEST(colour_declarations_are_inverse)
{
    for (int i = 0; i < 8; i++) {
        const struct glint_image image = {
            .format = GLINT_YUYV,
            .range = i & 1 ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED,
            .matrix = i & 2 ? GLINT_MATRIX_BT601 : GLINT_MATRIX_BT709,
            .transfer = i & 4 ? GLINT_TONE_SRGB : GLINT_TONE_BT709,
        };
        struct glint_image back = {.format = GLINT_YUYV};
        struct glint_v4l2_colour colour;

        glint_v4l2_colour_from_image(&colour, &image);
        assert_true(glint_v4l2_colour_to_image(&colour, &back));
        assert_int_equal(back.range, image.range);
        assert_int_equal(back.matrix, image.matrix);
        assert_int_equal(back.transfer, image.transfer);
    }
}
