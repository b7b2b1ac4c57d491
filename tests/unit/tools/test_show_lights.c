/* SPDX-License-Identifier: MIT
 *
 * Checks the marks that show detected lights: their position and colour in
 * images of every format, and that nothing is written outside the image.
 */
#include "overlay/show_lights.h"
#include "support/canvas.h"
#include "support/test.h"

enum { WIDTH = 96, HEIGHT = 64, GUARD = 4096 };

/* Returns a grey image between guard bytes of 0xee. */
static struct glint_image
make_guarded_grey_image(enum glint_pixel_format format, uint8_t **mem)
{
    struct glint_image image = {
        .format = format, .width = WIDTH, .height = HEIGHT};
    const size_t bytes = glint_image_bytes(format, WIDTH, HEIGHT);

    *mem = malloc(bytes + 2 * GUARD);
    assert_non_null(*mem);
    memset(*mem, 0xee, bytes + 2 * GUARD);
    memset(*mem + GUARD, 128, bytes);
    glint_image_place(&image, *mem + GUARD);
    return image;
}

static void assert_guard_bytes_unchanged(const struct glint_image *image,
                                         const uint8_t *mem)
{
    const size_t bytes = glint_image_bytes(image->format, WIDTH, HEIGHT);

    for (int i = 0; i < GUARD; i++) {
        assert_int_equal(mem[i], 0xee);
        assert_int_equal(mem[GUARD + bytes + (size_t)i], 0xee);
    }
}

static struct glint_lamp_track make_lamp_track(int x, int y)
{
    return (struct glint_lamp_track){.id = 907,
                                     .state = GLINT_LAMP_STEADY,
                                     .x_q8 = x * 256 + 128,
                                     .y_q8 = y * 256 + 128,
                                     .size_q8 = 2 << 8};
}

/* Checks that a mark drawn with lines one pixel wide is a cross of 5 pixels, a
 * box of +-8 pixels, and the digits 907. */
TEST(mark_is_a_cross_a_box_and_digits)
{
    static const char *const number[5] = {"### ### ###", "# # # #   #",
                                          "### # #   #", "  # # #  # ",
                                          "### ###  # "};
    const struct glint_lamp_track track = make_lamp_track(30, 20);
    uint8_t *mem;
    struct glint_image image = make_guarded_grey_image(GLINT_RGB24, &mem);
    const uint8_t *px = image.plane[0];
    int n_green = 0;

    show_lamp_mark(&image, &track);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        n_green += px[3 * i] == 0 && px[3 * i + 1] == 255;
    assert_int_equal(n_green, 9 + 4 * 16 + 31);
    for (int i = -2; i <= 2; i++) {
        assert_int_equal(px[3 * (20 * WIDTH + 30 + i) + 1], 255);
        assert_int_equal(px[3 * ((20 + i) * WIDTH + 30) + 1], 255);
    }
    for (int i = -8; i <= 8; i++) {
        assert_int_equal(px[3 * (12 * WIDTH + 30 + i) + 1], 255);
        assert_int_equal(px[3 * ((20 + i) * WIDTH + 38) + 1], 255);
    }
    for (int y = 0; y < 5; y++)
        for (int x = 0; number[y][x]; x++)
            assert_int_equal(px[3 * ((12 + y) * WIDTH + 41 + x) + 1] == 255,
                             number[y][x] == '#');
    /* the shadow of the cross is black */
    assert_int_equal(px[3 * (21 * WIDTH + 33)], 0);
    free(mem);
}

/* Checks that the centre of a mark is green: R, G, B = (0, 255, 0), which is Y,
 * Cb, Cr = (145, 54, 34) in BT.601 limited range and (182, 30, 12) in BT.709
 * full range. */
TEST(marks_are_green_in_every_format)
{
    static const struct {
        enum glint_pixel_format format;
        /* byte offsets of the samples Y, Cb, Cr or R, G, B of pixel (30, 20) */
        int offset[3];
        int is_rgb;
    } at[] = {
        {GLINT_RGB24, {5850, 5851, 5852}, 1},
        {GLINT_BGR24, {5852, 5851, 5850}, 1},
        {GLINT_XRGB8888, {7802, 7801, 7800}, 1},
        {GLINT_I420, {1950, 6144 + 495, 6144 + 1536 + 495}, 0},
        {GLINT_I422, {1950, 6144 + 975, 6144 + 3072 + 975}, 0},
        {GLINT_I444, {1950, 6144 + 1950, 12288 + 1950}, 0},
        {GLINT_NV12, {1950, 6144 + 990, 6144 + 991}, 0},
        {GLINT_NV21, {1950, 6144 + 991, 6144 + 990}, 0},
        {GLINT_YUYV, {3900, 3901, 3903}, 0},
        {GLINT_UYVY, {3901, 3900, 3902}, 0},
    };
    static const int expected[3][3] = {
        {0, 255, 0}, {145, 54, 34}, {182, 30, 12}};

    for (unsigned i = 0; i < 2 * sizeof at / sizeof *at; i++) {
        const struct glint_lamp_track track = make_lamp_track(30, 20);
        uint8_t *mem;
        struct glint_image image =
            make_guarded_grey_image(at[i / 2].format, &mem);

        image.matrix = i & 1 ? GLINT_MATRIX_BT709 : GLINT_MATRIX_BT601;
        image.range = i & 1 ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED;
        show_lamp_mark(&image, &track);
        for (int c = 0; c < 3; c++)
            assert_int_equal(mem[GUARD + at[i / 2].offset[c]],
                             expected[at[i / 2].is_rgb ? 0 : 1 + (i & 1)][c]);
        free(mem);
    }
}

TEST(writes_rgb565)
{
    struct glint_lamp_track track = make_lamp_track(30, 20);
    uint8_t *mem;
    struct glint_image image = make_guarded_grey_image(GLINT_RGB565, &mem);

    track.state = GLINT_LAMP_FADING;
    show_lamp_mark(&image, &track);
    assert_int_equal(mem[GUARD + 3900], 0x00); /* red: 0xf800 */
    assert_int_equal(mem[GUARD + 3901], 0xf8);
    free(mem);
}

/* Checks that marks inside the image, across its borders and far off-screen do
 * not change the guard bytes. */
TEST(marks_are_clipped_at_the_borders)
{
    static const int places[] = {-(1 << 20), -100, -9, -1,     0,      5,
                                 47,         63,   95, 96 + 8, 96 + 9, 1 << 20};

    for (int i = 0; i < 144 * CANVAS_FORMATS; i++) {
        struct glint_lamp_track track =
            make_lamp_track(places[i % 12], places[i / 12 % 12]);
        uint8_t *mem;
        struct glint_image image =
            make_guarded_grey_image(canvas_format[i / 144], &mem);

        track.id = UINT32_MAX;
        track.size_q8 = i % 7 ? 512 : 1 << 21;
        show_lamp_mark(&image, &track);
        assert_guard_bytes_unchanged(&image, mem);
        free(mem);
    }
}
