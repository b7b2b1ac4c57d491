/* SPDX-License-Identifier: MIT
 *
 * Tests passes, which blend layers of light and coverage into a tile: compares
 * them with their definition in linear light, in every format, at full and
 * half resolution, with two passes in either order.
 */
#include "glint/kernels.h"
#include "support/canvas.h"
#include "support/test.h"
#include "tile/blend.h"

enum { WIDTH = 91, HEIGHT = 53, N = WIDTH * HEIGHT, GREY_CODE = 120 };

static int32_t light_q20[3 * N];
static uint8_t *const px = (uint8_t *)light_q20;

/* A pass that draws stripes: some are opaque or partly opaque, some emit light,
 * and some do both. */
struct stripes {
    int step, light_q16[3];
    int linear;
    struct glint_box tile;
    int even; /* offset of the stripes in even rows, pixels */
};

static int compute_stripe_coverage(const struct stripes *s, int x, int y)
{
    return (x / s->step + (y % 2 ? 0 : s->even)) % 5 * 64;
}

static int compute_stripe_light(const struct stripes *s, int x, int y,
                                int channel)
{
    return (x / 5 + y / 3) % 3 ? s->light_q16[channel] : 0;
}

static void *begin_tile_row(const void *self, struct glint_box row, int worker)
{
    (void)row;
    (void)worker;
    return *(struct stripes *const *)self;
}

static int set_current_tile(void *state, struct glint_box tile)
{
    struct stripes *s = state;

    s->tile = tile;
    return 1;
}

static enum glint_given
set_coverage_and_light_of_rows(void *state, const struct glint_pass_rows *rows)
{
    const struct stripes *s = state;

    for (int row = 0; row < rows->n; row++)
        for (int i = 0; i < s->tile.x1 - s->tile.x0; i++) {
            const int x = s->tile.x0 + i, y = rows->y + row;

            rows->cover->cover_q8[row][i] =
                (uint16_t)compute_stripe_coverage(s, x, y);
            for (int c = 0; c < 3; c++)
                if (s->linear)
                    rows->light_q20[c][i] =
                        16 * compute_stripe_light(s, x, y, c);
                else
                    rows->light->rgb_q16[c][row][i] =
                        (uint16_t)compute_stripe_light(s, x, y, c);
        }
    return s->step < WIDTH ? GLINT_GIVES_COVER : GLINT_GIVES_LIGHT;
}

/* Draws the N_PASSES passes of S onto IMAGE. */
static void draw_stripe_passes(const struct glint_image *image, int half,
                               struct stripes *s, int n_passes)
{
    static struct glint_resolve resolve;
    static struct glint_light_rows light;
    static struct glint_quads_rows codes;
    static struct glint_blend_rows blend;
    static int32_t row_q20[3 * 2 * GLINT_CODES_WIDTH];
    struct stripes *const self[2] = {s, s + 1};
    const struct glint_tiles tiles = {
        .region = {0, 0, (WIDTH + half) >> half, (HEIGHT + half) >> half},
        .tile_log2 = 5,
        .half = half,
        .width = WIDTH,
        .height = HEIGHT,
        .image = image,
        .resolve = &resolve,
        .quads = &glint_half,
        .blend = &glint_blend};
    struct glint_tile_scratch scratch = {&light, row_q20, &codes, 0, 0, &blend};
    struct glint_pass pass[2];

    memset(&blend, 0x5a, sizeof blend);
    glint_resolve_init(&resolve, image, 0, glint_sets_here());
    for (int i = 0; i < n_passes; i++) {
        s[i].linear = image->format == GLINT_LINEAR_Q20;
        pass[i] =
            (struct glint_pass){&self[i], begin_tile_row, set_current_tile,
                                set_coverage_and_light_of_rows};
    }
    for (int row = 0; row < glint_tiles_count_rows(&tiles); row++)
        glint_tiles_draw_row(&tiles, pass, n_passes, row, 0, &scratch);
}

/* Returns the expected linear light of one channel of pixel (X, Y). */
static double compute_expected_light(const struct stripes *s, int n_passes,
                                     int half, int x, int y, int channel)
{
    double light = canvas_decode_srgb(GREY_CODE);

    x >>= half;
    y >>= half;
    for (int i = 0; i < n_passes; i++, s++) {
        if (s->step < WIDTH)
            light *= 1 - compute_stripe_coverage(s, x, y) / 256.;
        light += fmin(1, compute_stripe_light(s, x, y, channel) / 65535.);
    }
    return light;
}

static struct glint_image make_grey_image(enum glint_pixel_format format)
{
    struct glint_image image = glint_image_over(px, format, WIDTH, HEIGHT);

    memset(px, GREY_CODE, sizeof light_q20);
    for (int p = 1; p < 3; p++)
        if (image.plane[p])
            memset(image.plane[p], 128,
                   glint_image_row_bytes(format, p, WIDTH) *
                       (size_t)glint_image_plane_height(format, p, HEIGHT));
    for (int i = 0; i < 4 * N && format == GLINT_YUYV; i++)
        px[i] = i % 2 ? 128 : GREY_CODE;
    for (int i = 0; i < 3 * N && format == GLINT_LINEAR_Q20; i++)
        light_q20[i] = (int32_t)(canvas_decode_srgb(GREY_CODE) * 0x1p20);
    return image;
}

static struct stripes make_grey_stripes(int step, int light_q16)
{
    return (struct stripes){step, {light_q16, light_q16, light_q16}, 0, {0}, 0};
}

/* Checks the first sample of each pixel: it is within OFF of the expected
 * value. Pixels are STEP bytes apart. */
static void check_codes_of_pixels(enum glint_pixel_format format, int step,
                                  int half, struct stripes *s, int n_passes,
                                  double off)
{
    const struct glint_image image = make_grey_image(format);
    double sum = 0;

    draw_stripe_passes(&image, half, s, n_passes);
    for (int i = 0; i < N; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        const double want = canvas_encode_srgb_exactly(compute_expected_light(
                                s, n_passes, half, x, y, 0)) -
                            px[y * image.stride_bytes[0] + step * x];

        assert_true(fabs(want) < off);
        sum += want;
    }
    assert_true(fabs(sum / N) < 0.3);
}

TEST(blends_codes)
{
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < 4; i++) {
            struct stripes s[2] = {make_grey_stripes(i % 2 ? 7 : WIDTH, 9000),
                                   make_grey_stripes(i / 2 ? 4 : WIDTH, 21000)};

            for (int n = 1; n <= 2; n++) {
                check_codes_of_pixels(GLINT_RGB24, 3, half, s, n, 1.0);
                check_codes_of_pixels(GLINT_XRGB8888, 4, half, s, n, 1.0);
                check_codes_of_pixels(GLINT_I444, 1, half, s, n, 1.0);
                check_codes_of_pixels(GLINT_I420, 1, half, s, n, 1.0);
                check_codes_of_pixels(GLINT_NV12, 1, half, s, n, 1.0);
                check_codes_of_pixels(GLINT_YUYV, 2, half, s, n, 1.0);
                check_codes_of_pixels(GLINT_GREY, 1, half, s, n, 1.0);
            }
        }
}

/* Checks two rows, each completely covered where the other is not. */
TEST(blends_two_rows)
{
    struct stripes s = make_grey_stripes(64, 9000);

    s.even = 4;
    check_codes_of_pixels(GLINT_RGB24, 3, 0, &s, 1, 1.0);
    check_codes_of_pixels(GLINT_I420, 1, 0, &s, 1, 1.0);
    check_codes_of_pixels(GLINT_YUYV, 2, 0, &s, 1, 1.0);
}

TEST(blends_linear_light)
{
    for (int i = 0; i < 8; i++) {
        const struct glint_image image = make_grey_image(GLINT_LINEAR_Q20);
        struct stripes s[2] = {
            {i % 2 ? 7 : WIDTH, {900, 8000, 65535}, 0, {0}, 0},
            {i / 2 % 2 ? 4 : WIDTH, {70, 50, 30}, 0, {0}, 0}};

        draw_stripe_passes(&image, i / 4, s, 2);
        for (int k = 0; k < 3 * N; k++) {
            const double want =
                compute_expected_light(s, 2, i / 4, k / 3 % WIDTH,
                                       k / 3 / WIDTH, k % 3) *
                0x1p20;

            /* In light_q16, the light 1 is 65535, not 65536, so there is a
             * small error. */
            assert_true(fabs(light_q20[k] - want) < 20);
        }
    }
}

/* Checks that nothing of the background's colour remains in a completely
 * covered pixel. A chroma sample shared by pixels must be their mean. */
TEST(covered_pixels_keep_no_colour)
{
    struct stripes s =
        /* coverage of pairs of pixels: 0, 1/4, 1/2, 3/4, 1 */
        make_grey_stripes(2, 0);
    struct glint_image image = {
        .format = GLINT_I420, .width = WIDTH, .height = HEIGHT};

    for (int odd = 0; odd < 2; odd++) {
        for (int i = 0; i < N / 2 * 3; i++)
            px[i] = (uint8_t)(i < N ? 120 : 150);
        glint_image_place(&image, px);
        s.step = 2 - odd;
        draw_stripe_passes(&image, 0, &s, 1);
        for (int i = 0; i < 46; i++) {
            const int code = image.plane[1][i];

            if (odd)
                assert_in_range(code, 128, 150);
            else if (i % 5 == 0 || i % 5 == 4)
                assert_int_equal(code, i % 5 ? 128 : 150);
            else
                assert_in_range(code, 129, image.plane[1][i - 1] - 1);
        }
    }
}
