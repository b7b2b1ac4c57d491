/* SPDX-License-Identifier: MIT
 *
 * Checks images of extreme frames: one pixel, one row, 8192 x 8192, odd sizes,
 * padded rows and negative strides.
 */
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

static struct stage heliar;

/* Power at which a light 7.5 degrees off the axis is well exposed in an image
 * of one pixel per mm. The required power grows with the square of the pixels
 * per mm. */
static double power_of_mm;

TEST_OPEN
{
    const struct glint_lamp lamp = stage_make_lamp(7.5, 33, 1);

    if (!stage_load_lens(&heliar, "heliar-tronnier") ||
        !stage_set_up_lens(&heliar, 8) ||
        !stage_bake_or_load_model(&heliar, 1, 60))
        fail();
    stage_set_view(&heliar, 252, 168, 36);
    power_of_mm = stage_find_exposed_power(&heliar, &lamp) / 7 / 7;
}

static void *allocate_image_bytes(size_t bytes)
{
    void *p = malloc(bytes);

    assert_non_null(p);
    return p;
}

/* Draws a lamp into an image of FORMAT and size WIDTH x HEIGHT, with PX_MM
 * pixels per mm. */
static void draw_lamp_in_format(enum glint_pixel_format format, int width,
                                int height, double px_mm, uint8_t *bytes)
{
    const struct glint_lamp lamp =
        stage_make_lamp(7.5, 33, power_of_mm * px_mm * px_mm);
    struct glint_image image = glint_image_over(bytes, format, width, height);

    stage_set_view(&heliar, width, height, width / px_mm);
    assert_ok(
        glint_frame_draw(&heliar.frame, &lamp, 1, 1, &image, &heliar.drawn));
}

/* ------------------------------------------------------------------- sizes */

/* Draws a small image. Returns the number of its samples that differ from the
 * middle of the larger image LARGE, which has the same scale and parity of
 * sides. Samples may differ only if one image drops a ghost that the other
 * draws: in LARGE, light outside the small image counts as visible. */
static int count_differing_samples(int width, int height, const uint8_t *large,
                                   int large_w, int large_h, double px_mm)
{
    uint8_t *small = allocate_image_bytes((size_t)width * (size_t)height * 3);
    const int x0 = (large_w - width) / 2, y0 = (large_h - height) / 2;
    int n = 0;

    memset(small, 40, (size_t)width * (size_t)height * 3);
    draw_lamp_in_format(GLINT_RGB24, width, height, px_mm, small);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < 3 * width; x++)
            n += small[(size_t)y * 3 * (size_t)width + (size_t)x] !=
                 large[(size_t)(y + y0) * 3 * (size_t)large_w +
                       (size_t)(3 * x0 + x)];
    free(small);
    return n;
}

TEST(every_size_is_part_of_a_larger_frame)
{
    static const int sizes[][2] = {{1, 1},   {1, 199},   {301, 1},  {3, 199},
                                   {65, 63}, {301, 3},   {17, 129}, {127, 65},
                                   {7, 9},   {299, 199}, {193, 1},  {1, 65}};
    enum { W = 301, H = 199 };
    uint8_t *large = allocate_image_bytes(3 * W * H);
    int n = 0, lit = 0;

    memset(large, 40, 3 * W * H);
    draw_lamp_in_format(GLINT_RGB24, W, H, 7, large);
    for (int i = 0; i < 3 * W * H; i++)
        lit += large[i] != 40;
    assert_true(lit > W * H);
    for (int i = 0; i < 12; i++)
        n += count_differing_samples(sizes[i][0], sizes[i][1], large, W, H, 7);
    free(large);
    assert_at_most("frames: 1x1 to 301x199, samples that differ from the large "
                   "frame's middle",
                   n, 0, "samples");
}

/* Checks that the middle of the largest frame equals a small frame, which shows
 * that nothing overflows or loses precision far from the middle. */
TEST(middle_of_the_largest_frame_is_exact)
{
    enum { SIDE = 8192, MIDDLE = 512 };
    uint8_t *large = allocate_image_bytes((size_t)SIDE * SIDE),
            *small = allocate_image_bytes(MIDDLE * MIDDLE);
    int n = 0, corners = 0;

    memset(large, 0, (size_t)SIDE * SIDE);
    memset(small, 0, MIDDLE * MIDDLE);
    draw_lamp_in_format(GLINT_GREY, SIDE, SIDE, 250, large);
    assert_int_equal(heliar.drawn.stats.dropped_bundles, 0);
    draw_lamp_in_format(GLINT_GREY, MIDDLE, MIDDLE, 250, small);
    for (int y = 0; y < MIDDLE; y++)
        for (int x = 0; x < MIDDLE; x++)
            n += small[y * MIDDLE + x] !=
                 large[(size_t)(y + (SIDE - MIDDLE) / 2) * SIDE +
                       (size_t)(x + (SIDE - MIDDLE) / 2)];
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i += 997)
        corners += large[i] != 0;
    free(large);
    free(small);
    assert_true(corners > 1000);
    assert_at_most("frames: 8192x8192 against its middle drawn alone", n, 0,
                   "samples");
}

/* Checks that the middles of the longest possible frames equal short frames. */
TEST(middle_of_the_longest_frames_is_exact)
{
    enum { LONG = GLINT_MAX_SIDE, SHORT = 64, MIDDLE = 512 };
    uint8_t *large = allocate_image_bytes(LONG * SHORT),
            *small = allocate_image_bytes(MIDDLE * SHORT);
    int n = 0, lit[2] = {0, 0};

    for (int turned = 0; turned < 2; turned++) {
        const int w = turned ? SHORT : LONG, h = turned ? LONG : SHORT;
        const int sw = turned ? SHORT : MIDDLE, sh = turned ? MIDDLE : SHORT;

        memset(large, 0, LONG * SHORT);
        memset(small, 0, MIDDLE * SHORT);
        draw_lamp_in_format(GLINT_GREY, w, h, 1000, large);
        assert_int_equal(heliar.drawn.stats.dropped_bundles, 0);
        draw_lamp_in_format(GLINT_GREY, sw, sh, 1000, small);
        for (int y = 0; y < sh; y++)
            for (int x = 0; x < sw; x++)
                n += small[y * sw + x] !=
                     large[(y + (h - sh) / 2) * w + x + (w - sw) / 2];
        for (int i = 0; i < LONG * SHORT; i++)
            lit[turned] += large[i] > 0 && large[i] < 255;
    }
    free(large);
    free(small);
    print_message("%d and %d samples are lit, and not white\n", lit[0], lit[1]);
    assert_true(lit[0] > 10000 && lit[1] > 10000);
    assert_at_most(
        "frames: 32768x64 and 64x32768 against their middles by themselves", n,
        0, "samples");
}

/* ----------------------------------------------------------------- strides */

/* Draws an image with rows padded by PAD bytes, bottom row first if DOWN is -1.
 * Returns the number of rows that differ from an image without padding, plus
 * the number of bytes written outside the rows. */
static int count_wrong_rows_of_layout(enum glint_pixel_format format, int pad,
                                      int down)
{
    enum { W = 157, H = 83, ROOM = 1 << 19 };
    static uint8_t want[ROOM], got[ROOM];
    struct glint_image plain = {.format = format, .width = W, .height = H};
    struct glint_image image = plain;
    const struct glint_lamp lamp =
        stage_make_lamp(7.5, 33, power_of_mm * W * W / 24 / 24);
    uint8_t *at = got + 4096;
    int n = 0;

    stage_set_view(&heliar, W, H, 24);
    memset(want, 90, sizeof want);
    glint_image_place(&plain, want);
    assert_ok(
        glint_frame_draw(&heliar.frame, &lamp, 1, 1, &plain, &heliar.drawn));
    memset(got, 90, sizeof got);
    for (int p = 0; p < glint_image_planes(format); p++) {
        const int rows = glint_image_plane_height(format, p, H);
        const ptrdiff_t stride =
            (ptrdiff_t)glint_image_row_bytes(format, p, W) + pad;

        image.plane[p] = down > 0 ? at : at + (rows - 1) * stride;
        image.stride_bytes[p] = down * stride;
        at += rows * stride + 64;
    }
    assert_true(at < got + ROOM);
    assert_ok(
        glint_frame_draw(&heliar.frame, &lamp, 1, 1, &image, &heliar.drawn));
    for (int p = 0; p < glint_image_planes(format); p++)
        for (int y = 0; y < glint_image_plane_height(format, p, H); y++) {
            const size_t bytes = glint_image_row_bytes(format, p, W);
            uint8_t *row = image.plane[p] + y * image.stride_bytes[p];

            n += memcmp(row, plain.plane[p] + y * plain.stride_bytes[p],
                        bytes) != 0;
            /* after the test all bytes must be 90 again */
            memset(row, 90, bytes);
        }
    for (int i = 0; i < ROOM; i++)
        n += got[i] != 90;
    return n;
}

TEST(strides_do_not_change_the_image)
{
    int n = 0;

    for (int format = GLINT_RGB24; format <= GLINT_RGB565; format++) {
        /* YUYV and UYVY need even strides, int32 needs multiples of 4 */
        n += count_wrong_rows_of_layout((enum glint_pixel_format)format, 52, 1);
        n += count_wrong_rows_of_layout((enum glint_pixel_format)format, 0, -1);
        n += count_wrong_rows_of_layout((enum glint_pixel_format)format, 4, -1);
    }
    assert_at_most("frames: strides of 13 formats, rows or bytes that differ",
                   n, 0, "");
}

/* ------------------------------------------------------------------- tiles */

/* Checks, for every tile size, that a cell whose sides lie exactly on borders
 * of tiles and pixels adds light to exactly the pixels inside it, with exact
 * flux. */
TEST(cells_on_tile_borders_are_exact)
{
    enum { W = 192, H = 192 };
    static int32_t pixels[3 * W * H], first[3 * W * H];
    double worst = 0;
    int outside = 0, differ = 0;

    for (int log2 = 3; log2 <= 6; log2++) {
        struct glint_flare_config c = {.width = W,
                                       .height = H,
                                       .tile_log2 = log2,
                                       .max_bundles = 1,
                                       .max_primitives = 100,
                                       .max_vertices = 100,
                                       .max_refs = 10000};
        const struct glint_bundle b = {.n_cells = 1,
                                       .flux_q31 = 1 << 30,
                                       /* a flux of 64 x 64 */
                                       .flux_exponent = 13,
                                       .rgb_q14 = {16384, 16384, 16384}};
        struct glint_image image =
            glint_image_over(pixels, GLINT_LINEAR_Q20, W, H);
        const size_t bytes = glint_flare_bytes(&c);
        struct glint_flare_stats stats;
        struct glint_flare *f;
        struct glint_vertex *v;
        double sum = 0;
        void *mem;

        assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
        assert_ok(glint_flare_init(&f, &c, mem, bytes));
        v = glint_flare_add(f, &b);
        assert_non_null(v);
        for (int k = 0; k < 4; k++)
            v[k] = (struct glint_vertex){.x_q8 = k % 2 ? 128 * 256 : 64 * 256,
                                         .y_q8 = k / 2 ? 64 * 256 : 128 * 256,
                                         .energy_q16 = 65536};
        memset(pixels, 0, sizeof pixels);
        glint_flare_bin(f, &stats);
        glint_flare_draw(f, &image);
        for (int i = 0; i < 3 * W * H; i++) {
            const int x = i / 3 % W, y = i / 3 / W;
            const int in = x >= 64 && x < 128 && y >= 64 && y < 128;

            outside += !in && pixels[i] != 0;
            sum += pixels[i] / 1048576.0;
            differ += log2 > 3 && pixels[i] != first[i];
        }
        worst = fmax(worst, fabs(sum / 3 / 4096 - 1));
        memcpy(first, pixels, sizeof first);
        free(mem);
    }
    assert_at_most("frames: a cell on borders of tiles, samples lit outside or "
                   "by tile size",
                   outside + differ, 0, "samples");
    assert_at_most("frames: a cell on borders of tiles, flux", worst, 1e-6, "");
}

TEST_CLOSE
{
    stage_free(&heliar);
}
