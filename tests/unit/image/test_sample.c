/* SPDX-License-Identifier: MIT
 *
 * Checks that the codes of an image of any format are sampled correctly at a
 * few positions.
 */
#include "support/canvas.h"
#include "support/test.h"

enum { WIDTH = 50, HEIGHT = 30, COLUMNS = 10, ROWS = 3 };

static void check_code_is_near(int code, int wanted, int most)
{
    assert_true(abs(code - wanted) <= most);
}

static void set_grey_row(const struct glint_image *image, int y, int code)
{
    const int n = (int)glint_image_row_bytes(image->format, 0, image->width);
    const int packed = image->format == GLINT_YUYV   ? 1
                       : image->format == GLINT_UYVY ? 2
                                                     : 0;
    const int grey_565 = code >> 3 << 11 | code >> 2 << 5 | code >> 3;
    uint8_t *row = image->plane[0] + y * image->stride_bytes[0];

    for (int i = 0; i < n; i++)
        row[i] =
            (uint8_t)(image->format == GLINT_RGB565 ? grey_565 >> (i & 1) * 8
                      : packed && (i & 1) == (packed == 1) ? 128
                                                           : code);
    for (int p = 1; p < glint_image_planes(image->format); p++)
        memset(image->plane[p], 128,
               glint_image_row_bytes(image->format, p, image->width) *
                   (size_t)glint_image_plane_height(image->format, p, HEIGHT));
}

/* Checks the samples of an image of three stripes, from the top: black, grey,
 * bright. */
static void check_samples_of_format(enum glint_pixel_format format,
                                    enum glint_range range)
{
    struct glint_image image = canvas_allocate_image(format, WIDTH, HEIGHT);
    const int limited = range == GLINT_RANGE_LIMITED;
    uint8_t rgb[ROWS][COLUMNS][3];

    image.range = range;
    for (int y = 0; y < HEIGHT; y++)
        set_grey_row(&image, y, y < 10 ? 16 * limited : y < 20 ? 120 : 200);
    glint_image_sample(&image, COLUMNS, ROWS, rgb[0][0]);
    for (int i = 0; i < COLUMNS; i++)
        for (int c = 0; c < 3; c++) {
            check_code_is_near(rgb[0][i][c], 0, 0);
            check_code_is_near(rgb[1][i][c],
                               limited ? (120 - 16) * 255 / 219 : 120, 7);
            check_code_is_near(rgb[2][i][c],
                               limited ? (200 - 16) * 255 / 219 : 200, 7);
        }
    free(image.plane[0]);
}

TEST(samples_every_format)
{
    for (int f = GLINT_RGB24; f <= GLINT_RGB565; f++)
        if (f != GLINT_LINEAR_Q20)
            check_samples_of_format((enum glint_pixel_format)f,
                                    GLINT_RANGE_FULL);
    check_samples_of_format(GLINT_I420, GLINT_RANGE_LIMITED);
    check_samples_of_format(GLINT_GREY, GLINT_RANGE_LIMITED);
}

/* Checks the samples of an image of three pixels, stored as BYTES[N]; the
 * middle pixel is orange. */
static void check_orange_sample(enum glint_pixel_format format,
                                const uint8_t *bytes, size_t n)
{
    struct glint_image image = canvas_allocate_image(format, 3, 1);
    uint8_t rgb[3];

    memcpy(image.plane[0] + n, bytes, n);
    glint_image_sample(&image, 1, 1, rgb);
    check_code_is_near(rgb[0], 255, 0);
    check_code_is_near(rgb[1], 96, 4);
    check_code_is_near(rgb[2], 24, 4);
    free(image.plane[0]);
}

TEST(samples_colours_of_every_layout)
{
    static const uint8_t rgb[] = {255, 96, 24}, bgrx[] = {24, 96, 255, 0};
    static const uint8_t rgbx[] = {255, 96, 24, 0};
    /* RGB565 pixel with R, G, B = 31, 24, 3 */
    static const uint8_t packed[] = {0x03, 0xfb};

    check_orange_sample(GLINT_RGB24, rgb, 3);
    check_orange_sample(GLINT_BGR24, bgrx, 3);
    check_orange_sample(GLINT_XRGB8888, bgrx, 4);
    check_orange_sample(GLINT_XBGR8888, rgbx, 4);
    check_orange_sample(GLINT_RGB565, packed, 2);
}

/* Checks an image with fewer pixels than samples: each sample must be a pixel
 * of the image. A linear image, which has no codes, must return 0. */
TEST(samples_tiny_images)
{
    struct glint_image image = canvas_allocate_image(GLINT_GREY, 1, 1);
    static int32_t linear[3] = {1 << 20, 1 << 20, 1 << 20};
    uint8_t rgb[ROWS][COLUMNS][3];

    canvas_set_grey_pixel(&image, 0, 0, 77);
    glint_image_sample(&image, COLUMNS, ROWS, rgb[0][0]);
    assert_int_equal(rgb[0][0][0], 77);
    assert_int_equal(rgb[ROWS - 1][COLUMNS - 1][2], 77);
    free(image.plane[0]);
    image = (struct glint_image){
        .format = GLINT_LINEAR_Q20, .width = 1, .height = 1};
    glint_image_place(&image, linear);
    glint_image_sample(&image, 1, 1, rgb[0][0]);
    assert_int_equal(rgb[0][0][1], 0);
}
