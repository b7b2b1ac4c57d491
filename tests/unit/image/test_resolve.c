/* SPDX-License-Identifier: MIT
 *
 * Adds light to images of every format. Compares the codes with results in
 * double precision, which are computed from the curves and matrices of the
 * standards instead of tables.
 */
#include "support/canvas.h"
#include "support/hash.h"
#include "support/rng.h"
#include "image/quads.h"

#include "glint/kernels.h"
#include "linux/sets.h"
#include "support/test.h"

enum {
    MAX_SIDE = 40,
    TILE_LOG2 = 3,
    TILE = 1 << TILE_LOG2,
    PLANE_BYTES = 3 * (MAX_SIDE + 8) * (MAX_SIDE + 8),
    GUARD = 0xa5
};

#define WHITE_Q20 INT64_C(1048576)

/* An image with guard bytes around it and between its rows, a copy of its bytes
 * before light is added, and the light to add. */
struct fixture {
    struct glint_image image;
    uint8_t plane[3][PLANE_BYTES], before[3][PLANE_BYTES];
    int32_t light_q20[3][MAX_SIDE * MAX_SIDE];
};

static struct fixture fixture;
static struct glint_resolve resolve;
static uint32_t seed = 1;

/* Makes an image of guard bytes. Each row is followed by 5 guard bytes; with
 * UPSIDE_DOWN, strides are negative. */
static void make_guarded_image(enum glint_pixel_format format, int width,
                               int height, int upside_down)
{
    struct glint_image *image = &fixture.image;

    memset(fixture.plane, GUARD, sizeof fixture.plane);
    memset(fixture.light_q20, 0, sizeof fixture.light_q20);
    *image = (struct glint_image){
        .format = format, .width = width, .height = height};
    for (int i = 0; i < glint_image_planes(format); i++) {
        const int across = (int)glint_image_row_bytes(format, i, width);
        const int down = glint_image_plane_height(format, i, height);
        const ptrdiff_t stride = across + 5;

        image->plane[i] = fixture.plane[i] + 64;
        image->stride_bytes[i] = stride;
        if (upside_down) {
            image->plane[i] += (down - 1) * stride;
            image->stride_bytes[i] = -stride;
        }
    }
}

static uint8_t *address_of_sample(int plane, int x, int y)
{
    return fixture.image.plane[plane] + y * fixture.image.stride_bytes[plane] +
           x;
}

/* Returns the number of bytes per row of plane PLANE, without padding. */
static int compute_row_bytes_of_plane(int plane)
{
    const struct glint_image *image = &fixture.image;

    return (int)glint_image_row_bytes(image->format, plane, image->width);
}

static int count_rows_of_plane(int plane)
{
    const struct glint_image *image = &fixture.image;

    return glint_image_plane_height(image->format, plane, image->height);
}

static void fill_with_random_codes(int plane, int low, int high)
{
    for (int y = 0; y < count_rows_of_plane(plane); y++)
        for (int x = 0; x < compute_row_bytes_of_plane(plane); x++)
            *address_of_sample(plane, x, y) =
                (uint8_t)(low + rng_int_below(&seed, high - low + 1));
}

/* Converts light from Q20 to the range 0 .. 65535 of the kernels' input. */
static uint16_t convert_light_to_q16(int32_t light_q20)
{
    const int32_t l = (light_q20 >> 4) + (light_q20 >> 3 & 1);

    return (uint16_t)(l < 0 ? 0 : l > 65535 ? 65535 : l);
}

static double read_light_of_pixel(int i, int at)
{
    return convert_light_to_q16(fixture.light_q20[i][at]) / 65535.0;
}

/* Adds the light to IMAGE in strips of two rows, the last strip first. */
static void add_light_in_strips(const struct glint_image *image, int dither,
                                unsigned sets)
{
    static struct glint_light_rows light;
    static struct glint_resolve_rows rows;

    glint_resolve_init(&resolve, image, dither, sets);
    for (int y0 = (image->height - 1) / 2 * 2; y0 >= 0; y0 -= 2)
        for (int x0 = (image->width - 1) / TILE * TILE; x0 >= 0; x0 -= TILE) {
            const int x1 = x0 + TILE < image->width ? x0 + TILE : image->width;
            const int y1 = y0 + 2 < image->height ? y0 + 2 : image->height;

            /* The buffer is filled with bright light, which reveals reads
             * outside the image. */
            memset(&light, 0x55, sizeof light);
            for (int i = 0; i < 3; i++)
                for (int y = y0; y < y1; y++)
                    for (int x = x0; x < x1; x++)
                        light.rgb_q16[i][y - y0][x - x0] = convert_light_to_q16(
                            fixture.light_q20[i][y * image->width + x]);
            glint_resolve_add_to_run(&resolve, image, x0, y0, x1 - x0, y1 - y0,
                                     &light, &rows);
        }
}

static void add_light_to_image(int dither)
{
    memcpy(fixture.before, fixture.plane, sizeof fixture.before);
    add_light_in_strips(&fixture.image, dither, 0);
}

static int sample_before(int plane, int x, int y)
{
    return fixture
        .before[plane][address_of_sample(plane, x, y) - fixture.plane[plane]];
}

static void assert_guard_bytes_unchanged(void)
{
    for (int i = 0; i < 3; i++) {
        static uint8_t inside[PLANE_BYTES];

        memset(inside, 0, sizeof inside);
        if (i < glint_image_planes(fixture.image.format))
            for (int y = 0; y < count_rows_of_plane(i); y++)
                for (int x = 0; x < compute_row_bytes_of_plane(i); x++)
                    inside[address_of_sample(i, x, y) - fixture.plane[i]] = 1;
        for (int k = 0; k < PLANE_BYTES; k++)
            assert_true(inside[k] || fixture.plane[i][k] == GUARD);
    }
}

/* ------------------------------------------- reference in double precision */

/* Returns the change of the encoded value V (1 = white) when the linear light
 * LIGHT is added to it. */
static double compute_expected_code_change(double v, double light)
{
    const double held = fmax(0, fmin(v, 1));
    const enum glint_tone tone = fixture.image.transfer;

    return light > 0 ? canvas_encode_light(
                           canvas_decode_value(held, tone) + light, tone) -
                           held
                     : 0;
}

struct coding {
    double kr, kg, kb, black, y_steps, c_steps;
};

static struct coding make_coding_of_image(void)
{
    const int bt601 = fixture.image.matrix == GLINT_MATRIX_BT601;
    const int full = fixture.image.range == GLINT_RANGE_FULL;
    struct coding c = {.kr = bt601 ? 0.299 : 0.2126,
                       .kb = bt601 ? 0.114 : 0.0722,
                       .black = full ? 0 : 16,
                       .y_steps = full ? 255 : 219,
                       .c_steps = full ? 255 : 224};

    c.kg = 1 - c.kr - c.kb;
    return c;
}

/* Sets RGB to the measured change of R'G'B' of pixel (X, Y) in a Y'CbCr
 * image. */
static void compute_expected_rgb_change(const struct coding *c, int x, int y,
                                        int cx, int cy, double rgb[3])
{
    const double luma = (sample_before(0, x, y) - c->black) / c->y_steps;
    const double cb = (sample_before(1, cx, cy) - 128) / c->c_steps;
    const double cr = (sample_before(2, cx, cy) - 128) / c->c_steps;
    const int at = y * fixture.image.width + x;

    rgb[0] = luma + 2 * (1 - c->kr) * cr;
    rgb[2] = luma + 2 * (1 - c->kb) * cb;
    rgb[1] = (luma - c->kr * rgb[0] - c->kb * rgb[2]) / c->kg;
    for (int i = 0; i < 3; i++)
        rgb[i] =
            compute_expected_code_change(rgb[i], read_light_of_pixel(i, at));
}

static void assert_code_is_near(double want, int got, double within)
{
    want = want < 0 ? 0 : want > 255 ? 255 : want;
    if (fabs(want - got) > within)
        fail_msg("code %d where %.3f is right", got, want);
}

/* Checks the chroma sample (CX, CY) and the luma of the pixels that share
 * it. */
static void check_chroma_block(int cx, int cy, double within)
{
    const enum glint_pixel_format format = fixture.image.format;
    const struct coding c = make_coding_of_image();
    const int nx = format == GLINT_I444 ? 1 : 2;
    const int ny = format == GLINT_I420 ? 2 : 1;
    double total[3] = {0, 0, 0};
    int n = 0;

    for (int y = cy * ny; y < cy * ny + ny && y < count_rows_of_plane(0); y++)
        for (int x = cx * nx;
             x < cx * nx + nx && x < compute_row_bytes_of_plane(0); x++, n++) {
            double rgb[3];

            compute_expected_rgb_change(&c, x, y, cx, cy, rgb);
            for (int i = 0; i < 3; i++)
                total[i] += rgb[i];
            assert_code_is_near(
                sample_before(0, x, y) +
                    c.y_steps * (c.kr * rgb[0] + c.kg * rgb[1] + c.kb * rgb[2]),
                *address_of_sample(0, x, y), within);
        }
    for (int i = 0; i < 3; i++)
        total[i] /= n;
    {
        const double luma = c.kr * total[0] + c.kg * total[1] + c.kb * total[2];

        assert_code_is_near(sample_before(1, cx, cy) +
                                c.c_steps * (total[2] - luma) / 2 / (1 - c.kb),
                            *address_of_sample(1, cx, cy), within);
        assert_code_is_near(sample_before(2, cx, cy) +
                                c.c_steps * (total[0] - luma) / 2 / (1 - c.kr),
                            *address_of_sample(2, cx, cy), within);
    }
}

static void check_ycc_image(double within)
{
    for (int cy = 0; cy < count_rows_of_plane(1); cy++)
        for (int cx = 0; cx < compute_row_bytes_of_plane(1); cx++)
            check_chroma_block(cx, cy, within);
}

static void check_rgb24_image(double within)
{
    for (int y = 0; y < count_rows_of_plane(0); y++)
        for (int x = 0; x < compute_row_bytes_of_plane(0); x++) {
            const double light =
                read_light_of_pixel(x % 3, y * fixture.image.width + x / 3);
            const int code = sample_before(0, x, y);

            assert_code_is_near(
                code + 255 * compute_expected_code_change(code / 255.0, light),
                *address_of_sample(0, x, y), within);
        }
}

static void check_grey_image(double within)
{
    const struct coding c = make_coding_of_image();

    for (int y = 0; y < count_rows_of_plane(0); y++)
        for (int x = 0; x < compute_row_bytes_of_plane(0); x++) {
            const double weight[3] = {0.2126, 0.7152, 0.0722};
            const double v = (sample_before(0, x, y) - c.black) / c.y_steps;
            double light = 0;

            for (int i = 0; i < 3; i++)
                light += weight[i] *
                         read_light_of_pixel(i, y * fixture.image.width + x);
            assert_code_is_near(sample_before(0, x, y) +
                                    c.y_steps *
                                        compute_expected_code_change(v, light),
                                *address_of_sample(0, x, y), within);
        }
}

static void check_image_with_added_light(double within)
{
    if (fixture.image.format == GLINT_RGB24)
        check_rgb24_image(within);
    else if (fixture.image.format == GLINT_GREY)
        check_grey_image(within);
    else
        check_ycc_image(within);
    assert_guard_bytes_unchanged();
}

/* ------------------------------------------------------------------- tests */

static const enum glint_pixel_format formats[5] = {
    GLINT_RGB24, GLINT_GREY, GLINT_I420, GLINT_I422, GLINT_I444};
static const int sizes[][2] = {{1, 1}, {3, 1}, {1, 3}, {7, 5}, {33, 18}};

enum { N_SIZES = sizeof sizes / sizeof *sizes };

/* Fills the fixture with random light of all magnitudes; a third of it is
 * negative. */
static void fill_with_random_light(void)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < MAX_SIDE * MAX_SIDE; k++) {
            const int32_t size_q20 =
                rng_int_below(&seed, 1 << rng_int_below(&seed, 23));

            fixture.light_q20[i][k] =
                rng_int_below(&seed, 3) ? size_q20 : -size_q20;
        }
}

/* Selects the transfer curve, code range and YCbCr matrix of the image by the
 * bits of K. */
static void set_coding_by_bits(int k)
{
    fixture.image.transfer = k & 1 ? GLINT_TONE_BT709 : GLINT_TONE_SRGB;
    fixture.image.range = k & 2 ? GLINT_RANGE_LIMITED : GLINT_RANGE_FULL;
    fixture.image.matrix = k & 4 ? GLINT_MATRIX_BT709 : GLINT_MATRIX_BT601;
}

/* Checks random images whose chroma differs by up to CHROMA codes from
 * neutral. */
static void check_light_on_random_images(int chroma, double within)
{
    for (int f = 0; f < 5; f++)
        for (int s = 0; s < N_SIZES; s++)
            for (int k = 0; k < 16; k++) {
                make_guarded_image(formats[f], sizes[s][0], sizes[s][1], k & 8);
                set_coding_by_bits(k);
                if (formats[f] == GLINT_RGB24)
                    fixture.image.range = GLINT_RANGE_FULL;
                fill_with_random_codes(0, 0, 255);
                if (glint_image_planes(formats[f]) == 3) {
                    fill_with_random_codes(1, 128 - chroma, 127 + chroma);
                    fill_with_random_codes(2, 128 - chroma, 127 + chroma);
                }
                fill_with_random_light();
                add_light_to_image(0);
                check_image_with_added_light(within);
            }
}

TEST(light_adds_up)
{
    for (int round = 0; round < 4; round++)
        check_light_on_random_images(40, 0.65);
}

/* Checks that light is added correctly to all codes, including those of colours
 * far outside the RGB cube. */
TEST(codes_outside_the_rgb_cube_resolve)
{
    for (int round = 0; round < 4; round++)
        check_light_on_random_images(128, 0.65);
}

static void check_image_is_unchanged(int dither)
{
    for (int f = 0; f < 5; f++)
        for (int k = 0; k < 16; k++) {
            make_guarded_image(formats[f], 33, 18, k & 8);
            set_coding_by_bits(k);
            for (int i = 0; i < glint_image_planes(formats[f]); i++)
                fill_with_random_codes(i, 0, 255);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 33 * 18; j++)
                    fixture.light_q20[i][j] = -rng_int_below(&seed, 3);
            add_light_to_image(dither);
            assert_memory_equal(fixture.plane, fixture.before,
                                sizeof fixture.plane);
        }
}

TEST(untouched_pixels_are_unchanged)
{
    check_image_is_unchanged(0);
    check_image_is_unchanged(1);
}

/* Checks that light too faint to change a code by half a code changes
 * nothing. */
TEST(faint_light_changes_nothing)
{
    for (int f = 0; f < 5; f++) {
        make_guarded_image(formats[f], 33, 18, 0);
        for (int i = 0; i < glint_image_planes(formats[f]); i++)
            fill_with_random_codes(i, 128, 128);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 33 * 18; k += 4)
                /* light that would change code 128 by 0.4 */
                fixture.light_q20[i][k] = 1500;
        add_light_to_image(0);
        assert_memory_equal(fixture.plane, fixture.before,
                            sizeof fixture.plane);
    }
}

TEST(strong_light_saturates_at_white)
{
    for (int f = 0; f < 5; f++)
        for (int k = 0; k < 16; k++) {
            make_guarded_image(formats[f], 7, 5, k & 8);
            set_coding_by_bits(k);
            fill_with_random_codes(0, 20, 230);
            for (int i = 1; i < glint_image_planes(formats[f]); i++)
                fill_with_random_codes(i, 128, 128);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 7 * 5; j++)
                    fixture.light_q20[i][j] = INT32_MAX >> (j / 4);
            add_light_to_image(0);
            for (int i = 0; i < glint_image_planes(formats[f]); i++)
                for (int y = 0; y < count_rows_of_plane(i); y++)
                    for (int x = 0; x < compute_row_bytes_of_plane(i); x++)
                        assert_int_equal(*address_of_sample(i, x, y),
                                         i > 0              ? 128
                                         : (k & 2) && f > 0 ? 235
                                                            : 255);
        }
}

/* Checks results of sRGB codes computed by hand. Code 128 has light 226346 /
 * 2^20; 2.5 times this light is code 194, 4 times is 239, and a quarter of
 * white is 137. */
TEST(codes_match_hand_computation)
{
    make_guarded_image(GLINT_RGB24, 1, 1, 0);
    memset(address_of_sample(0, 0, 0), 128, 3);
    fixture.light_q20[0][0] = 3 * 226346 / 2;
    fixture.light_q20[1][0] = 3 * 226346;
    fixture.light_q20[2][0] = WHITE_Q20 / 4 - 226346;
    add_light_to_image(0);
    assert_int_equal(*address_of_sample(0, 0, 0), 194);
    assert_int_equal(*address_of_sample(0, 1, 0), 239);
    assert_int_equal(*address_of_sample(0, 2, 0), 137);
}

/* Checks chroma samples of several pixels. One lit pixel of four changes their
 * common sample by a quarter. In an image with odd sides, the last sample has
 * only one pixel, which changes it completely. */
TEST(chroma_is_the_mean_of_existing_pixels)
{
    make_guarded_image(GLINT_I420, 3, 3, 0);
    for (int i = 0; i < 3; i++)
        fill_with_random_codes(i, i ? 128 : 0, i ? 128 : 0);
    fixture.light_q20[2][0] = WHITE_Q20;
    fixture.light_q20[2][8] = WHITE_Q20;
    add_light_to_image(0);
    assert_int_equal(*address_of_sample(0, 0, 0), 29); /* 0.114 * 255 */
    assert_int_equal(*address_of_sample(0, 1, 0), 0);
    assert_int_equal(*address_of_sample(0, 2, 2), 29);
    /* Cb of a block with one blue pixel of four: 128 + 127.5 / 4 */
    assert_int_equal(*address_of_sample(1, 0, 0), 160);
    assert_int_equal(*address_of_sample(1, 1, 0), 128);
    assert_int_equal(*address_of_sample(1, 1, 1), 255); /* 128 + 127.5 */
    assert_int_equal(*address_of_sample(2, 1, 1),
                     /* Cr of the blue pixel: 128 - 0.114 * 127.5 / 0.701 */
                     107);
}

/* Checks that with dither the mean over a uniform image is right within 0.1
 * code. */
TEST(dither_keeps_the_mean)
{
    for (int light = 0; light < 9000; light += 97) {
        int total = 0;
        double want;

        make_guarded_image(GLINT_RGB24, 8, 8, 0);
        fill_with_random_codes(0, 200, 200);
        for (int k = 0; k < 64; k++)
            fixture.light_q20[0][k] = light;
        add_light_to_image(1);
        for (int k = 0; k < 64; k++) {
            total += *address_of_sample(0, 3 * (k % 8), k / 8);
            assert_int_equal(*address_of_sample(0, 3 * (k % 8) + 1, k / 8),
                             200);
        }
        want = 200 + 255 * compute_expected_code_change(
                               200 / 255.0, read_light_of_pixel(0, 0));
        assert_true(fabs(total / 64.0 - want) <= 0.1);
    }
}

/* Checks that the dither pattern contains each of its 64 thresholds once, with
 * large differences between neighbours. */
TEST(dither_pattern_has_all_thresholds)
{
    int seen[64] = {0};

    make_guarded_image(GLINT_GREY, 8, 8, 0);
    glint_resolve_init(&resolve, &fixture.image, 1, 0);
    for (int k = 0; k < 64; k++)
        seen[(resolve.round_q7[k / 8][k % 8] - 1) / 2]++;
    for (int k = 0; k < 64; k++)
        assert_int_equal(seen[k], 1);
    assert_int_equal(resolve.round_q7[0][0], 1);
    assert_int_equal(resolve.round_q7[1][1], 33);
    assert_int_equal(resolve.round_q7[0][1], 65);
    assert_int_equal(resolve.round_q7[1][0], 97);
}

TEST(dither_in_ycc_stays_within_a_code)
{
    for (int f = 0; f < 5; f++)
        for (int k = 0; k < 16; k++) {
            make_guarded_image(formats[f], 33, 18, k & 8);
            set_coding_by_bits(k);
            if (formats[f] == GLINT_RGB24)
                fixture.image.range = GLINT_RANGE_FULL;
            fill_with_random_codes(0, 0, 255);
            for (int i = 1; i < glint_image_planes(formats[f]); i++)
                fill_with_random_codes(i, 100, 156);
            fill_with_random_light();
            add_light_to_image(1);
            check_image_with_added_light(1.15);
        }
}

TEST(linear_light_adds_and_saturates)
{
    /* Each row has three pixels, the third of which is padding. */
    static int32_t px_q20[2][9];
    const int32_t light_q20[3][2][2] = {{{5, INT32_MAX}, {-7, 1}},
                                        {{-9, INT32_MIN}, {1 << 20, 2}},
                                        {{0, INT32_MAX}, {INT32_MAX - 9, 3}}};
    const int32_t want_q20[2][9] = {
        {15, 1, 10, INT32_MAX, INT32_MIN + 10, INT32_MAX, 10, 10, 10},
        {3, 1048586, INT32_MAX, 11, 12, 13, 10, 10, 10}};
    const struct glint_image image = {.format = GLINT_LINEAR_Q20,
                                      .width = 2,
                                      .height = 2,
                                      .plane = {(uint8_t *)px_q20},
                                      .stride_bytes = {sizeof px_q20[0]}};

    for (int k = 0; k < 18; k++)
        px_q20[k / 9][k % 9] = 10;
    for (int y = 0; y < 2; y++)
        glint_resolve_add_to_linear(&image, 0, y, 2,
                                    (const int32_t *const[]){light_q20[0][y],
                                                             light_q20[1][y],
                                                             light_q20[2][y]});
    assert_memory_equal(px_q20, want_q20, sizeof px_q20);
}

/* Pairs of formats that store the same codes at different positions. */
static const enum glint_pixel_format twins[][2] = {
    {GLINT_I420, GLINT_NV12},     {GLINT_I420, GLINT_NV21},
    {GLINT_I422, GLINT_YUYV},     {GLINT_I422, GLINT_UYVY},
    {GLINT_RGB24, GLINT_BGR24},   {GLINT_RGB24, GLINT_XRGB8888},
    {GLINT_RGB24, GLINT_XBGR8888}};

static void copy_image_codes(const struct glint_image *to,
                             const struct glint_image *from)
{
    const struct glint_layout *lt = glint_get_layout(to->format);
    const struct glint_layout *lf = glint_get_layout(from->format);

    for (int i = 0; i < 3; i++)
        for (int y = 0; y < to->height; y++)
            for (int x = 0; x < to->width; x++)
                *glint_layout_get_sample_address(lt, to, i, x, y) =
                    *glint_layout_get_sample_address(lf, from, i, x, y);
}

TEST(layouts_give_the_same_codes)
{
    static uint8_t twin_mem[4 * 34 * 18], back_mem[4 * 34 * 18];
    for (size_t t = 0; t < sizeof twins / sizeof *twins; t++)
        for (int s = 0; s < N_SIZES; s++) {
            struct glint_image twin, back;

            make_guarded_image(twins[t][0], sizes[s][0], sizes[s][1], 0);
            for (int i = 0; i < glint_image_planes(twins[t][0]); i++)
                fill_with_random_codes(i, 0, 255);
            fill_with_random_light();
            twin = back = fixture.image;
            twin.format = twins[t][1];
            memset(twin_mem, 0x99, sizeof twin_mem);
            glint_image_place(&twin, twin_mem);
            glint_image_place(&back, back_mem);
            copy_image_codes(&twin, &fixture.image);
            add_light_to_image(0);
            add_light_in_strips(&twin, 0, 0);
            copy_image_codes(&back, &twin);
            copy_image_codes(&twin, &fixture.image);
            for (int i = 0; i < 3; i++)
                for (int y = 0; y < back.height; y++)
                    for (int x = 0; x < back.width; x++)
                        assert_int_equal(
                            *glint_layout_get_sample_address(
                                glint_get_layout(back.format), &back, i, x, y),
                            *glint_layout_get_sample_address(
                                glint_get_layout(fixture.image.format),
                                &fixture.image, i, x, y));
            if (twin.format == GLINT_XRGB8888 || twin.format == GLINT_XBGR8888)
                for (int k = 3; k < 4 * twin.width * twin.height; k += 4)
                    assert_int_equal(twin_mem[k], 0x99);
        }
}

/* Checks that a row of packed pixels drawn in one long span, which is not a
 * whole number of SIMD vectors, equals the row drawn in spans of eight
 * pixels. */
TEST(long_spans_equal_short_spans)
{
    static const enum glint_pixel_format packed[] = {GLINT_YUYV, GLINT_UYVY};
    static struct glint_light_rows light, part;
    static struct glint_resolve_rows rows;
    uint8_t want[2 * 64], got[2 * 64];

    for (int n = 2; n <= 64; n += 2)
        for (int k = 0; k < 4; k++) {
            struct glint_image image = {
                .format = packed[k & 1], .width = n, .height = 1};

            for (int i = 0; i < 2 * n; i++)
                want[i] = got[i] = (uint8_t)rng_int_below(&seed, 256);
            for (int i = 0; i < 3 * 64; i++)
                light.rgb_q16[i / 64][0][i % 64] =
                    (uint16_t)rng_int_below(&seed, 9000);
            glint_resolve_init(&resolve, &image, 0,
                               k & 2 ? glint_system_sets() : 0u);
            glint_image_place(&image, got);
            glint_resolve_add_to_run(&resolve, &image, 0, 0, n, 1, &light,
                                     &rows);
            glint_image_place(&image, want);
            for (int x = 0; x < n; x += 8) {
                for (int i = 0; i < 3 * 8; i++)
                    part.rgb_q16[i / 8][0][i % 8] =
                        light.rgb_q16[i / 8][0][x + i % 8];
                glint_resolve_add_to_run(&resolve, &image, x, 0,
                                         n - x < 8 ? n - x : 8, 1, &part,
                                         &rows);
            }
            assert_memory_equal(got, want, 2 * (size_t)n);
        }
}

/* Makes each block of 2 x 2 pixels of the image uniform; for such blocks, one
 * light value for all four pixels is exact. */
static void make_2x2_blocks_uniform(void)
{
    const struct glint_image *image = &fixture.image;
    const struct glint_layout *l = glint_get_layout(image->format);
    const int n_channels = l->kind == GLINT_LAYOUT_GREY ? 1 : 3;

    for (int i = 0; i < n_channels; i++)
        for (int y = 0; y < image->height; y++)
            for (int x = 0; x < image->width; x++)
                *glint_layout_get_sample_address(l, image, i, x, y) =
                    *glint_layout_get_sample_address(l, image, i, x & ~1,
                                                     y & ~1);
}

static void add_light_by_2x2_blocks(const struct glint_image *image, int dither,
                                    unsigned sets)
{
    static struct glint_quads_rows rows;
    static struct glint_light_rows light;
    const uint16_t *const rgb[3] = {light.rgb_q16[0][0], light.rgb_q16[1][0],
                                    light.rgb_q16[2][0]};

    glint_resolve_init(&resolve, image, dither, sets);
    memset(&light, 0x55, sizeof light);
    for (int y = 0; y < image->height; y += 2) {
        for (int x = 0; x < image->width; x += 2)
            for (int i = 0; i < 3; i++)
                light.rgb_q16[i][0][x / 2] = convert_light_to_q16(
                    fixture.light_q20[i][y * image->width + x]);
        glint_resolve_add_to_quads(
            &resolve, image, 0, y, image->width,
            y + 2 < image->height ? 2 : image->height - y, rgb, &rows);
    }
}

TEST(quads_of_uniform_blocks_are_exact)
{
    static const enum glint_pixel_format every[] = {
        GLINT_YUYV, GLINT_UYVY,  GLINT_I420,     GLINT_NV12,
        GLINT_I422, GLINT_RGB24, GLINT_XRGB8888, GLINT_GREY};
    static uint8_t even[3][PLANE_BYTES], want[3][PLANE_BYTES];

    for (size_t f = 0; f < sizeof every / sizeof *every; f++)
        for (int size = 0; size < 40; size++) {
            make_guarded_image(every[f], 1 + size, 1 + (size * 7) % 40, 0);
            for (int i = 0; i < glint_image_planes(every[f]); i++)
                fill_with_random_codes(i, 0, 255);
            make_2x2_blocks_uniform();
            fill_with_random_light();
            for (int i = 0; i < 3; i++)
                for (int y = 0; y < fixture.image.height; y++)
                    for (int x = 0; x < fixture.image.width; x++)
                        fixture.light_q20[i][y * fixture.image.width + x] =
                            fixture
                                .light_q20[i][(y & ~1) * fixture.image.width +
                                              (x & ~1)];
            memcpy(even, fixture.plane, sizeof even);
            add_light_in_strips(&fixture.image, 1, 0);
            memcpy(want, fixture.plane, sizeof want);
            for (int k = 0; k < 2; k++) {
                memcpy(fixture.plane, even, sizeof even);
                add_light_by_2x2_blocks(&fixture.image, 1,
                                        k ? glint_system_sets() : 0u);
                assert_memory_equal(fixture.plane, want, sizeof want);
            }
        }
}

/* Checks blocks of 2 x 2 different pixels with one light value for all. No
 * pixel may become darker or exceed white. The order of the two left pixels
 * must be preserved, and strong light must make all four white. */
TEST(quads_of_edges_stay_ordered)
{
    static const uint8_t luma[2][2] = {{16, 235}, {90, 17}};

    for (int strength = 0; strength <= 24; strength++) {
        make_guarded_image(GLINT_YUYV, 32, 2, 0);
        fixture.image.range = GLINT_RANGE_LIMITED;
        for (int x = 0; x < 64; x++)
            for (int y = 0; y < 2; y++)
                *address_of_sample(0, x, y) = x % 2 ? 128 : luma[y][x / 2 % 2];
        for (int i = 0; i < 3 * 64; i++)
            fixture.light_q20[i / 64][i % 64] = 1 << strength >> 4;
        add_light_by_2x2_blocks(&fixture.image, 0, 0);
        for (int x = 0; x < 64; x += 2)
            for (int y = 0; y < 2; y++) {
                assert_in_range(*address_of_sample(0, x, y), luma[y][x / 2 % 2],
                                235);
                assert_int_equal(*address_of_sample(0, x + 1, y), 128);
                if (strength == 24)
                    assert_int_equal(*address_of_sample(0, x, y), 235);
            }
        assert_true(*address_of_sample(0, 0, 0) <= *address_of_sample(0, 0, 1));
    }
}

/* Makes images whose pixels differ by up to DIFFER codes within each block of 2
 * x 2 pixels. Returns the RMS difference, codes, between light computed per
 * block and light computed per pixel. */
static double measure_rms_of_blocks_and_pixels(int differ)
{
    static uint8_t want[PLANE_BYTES];
    double sum2 = 0;
    int n = 0;

    for (int turn = 0; turn < 50; turn++) {
        make_guarded_image(GLINT_YUYV, 32, 2, 0);
        fill_with_random_codes(0, 0, differ);
        for (int x = 0; x < 64; x++)
            for (int y = 0; y < 2; y++)
                *address_of_sample(0, x, y) =
                    (uint8_t)(*address_of_sample(0, x, y) +
                              (x % 2 ? 120 : 20 + 3 * turn));
        for (int i = 0; i < 3 * 64; i++)
            fixture.light_q20[i / 64][i % 64] = 3000 << turn % 8;
        memcpy(fixture.before, fixture.plane, sizeof fixture.before);
        add_light_in_strips(&fixture.image, 0, 0);
        memcpy(want, fixture.plane[0], sizeof want);
        memcpy(fixture.plane, fixture.before, sizeof fixture.before);
        add_light_by_2x2_blocks(&fixture.image, 0, 0);
        for (int x = 0; x < 64; x += 2)
            for (int y = 0; y < 2; y++, n++) {
                const int off =
                    *address_of_sample(0, x, y) -
                    want[address_of_sample(0, x, y) - fixture.plane[0]];

                sum2 += off * off;
            }
    }
    return sqrt(sum2 / n);
}

TEST(quads_are_near_single_pixels)
{
    assert_true(measure_rms_of_blocks_and_pixels(0) < 1e-9);
    assert_true(measure_rms_of_blocks_and_pixels(8) < 0.5);
    assert_true(measure_rms_of_blocks_and_pixels(40) < 1.5);
}

/* Checks that one span of 2 x 2 blocks equals several short spans, whatever
 * number of blocks remains after the last SIMD vector. */
TEST(long_quad_spans_equal_short_spans)
{
    static const enum glint_pixel_format some[] = {GLINT_YUYV, GLINT_UYVY,
                                                   GLINT_I420};
    static struct glint_light_rows light, part;
    static struct glint_quads_rows rows;
    static uint8_t want[PLANE_BYTES], got[PLANE_BYTES];

    for (int n = 1; n <= 64; n++)
        for (int k = 0; k < 6; k++) {
            struct glint_image image = {
                .format = some[k % 3], .width = n, .height = 2};
            const size_t bytes = glint_image_bytes(image.format, n, 2);
            const uint16_t *const whole[3] = {
                light.rgb_q16[0][0], light.rgb_q16[1][0], light.rgb_q16[2][0]};

            for (size_t i = 0; i < bytes; i++)
                want[i] = got[i] = (uint8_t)rng_int_below(&seed, 256);
            for (int i = 0; i < 3 * 64; i++)
                light.rgb_q16[i / 64][0][i % 64] =
                    (uint16_t)rng_int_below(&seed, 9000);
            glint_resolve_init(&resolve, &image, 0,
                               k > 2 ? glint_system_sets() : 0u);
            glint_image_place(&image, got);
            glint_resolve_add_to_quads(&resolve, &image, 0, 0, n, 2, whole,
                                       &rows);
            glint_image_place(&image, want);
            for (int x = 0; x < n; x += 8) {
                const uint16_t *const rgb[3] = {
                    part.rgb_q16[0][0], part.rgb_q16[1][0], part.rgb_q16[2][0]};

                for (int i = 0; i < 3 * 4; i++)
                    part.rgb_q16[i / 4][0][i % 4] =
                        light.rgb_q16[i / 4][0][x / 2 + i % 4];
                glint_resolve_add_to_quads(&resolve, &image, x, 0,
                                           n - x < 8 ? n - x : 8, 2, rgb,
                                           &rows);
            }
            assert_memory_equal(got, want, bytes);
        }
}

/* Checks that without light all codes of RGB565 are unchanged, and that strong
 * green light gives the max green code. */
TEST(writes_rgb565)
{
    static uint8_t mem[2 * 32 * 32], before_mem[2 * 32 * 32];
    struct glint_image image = glint_image_over(mem, GLINT_RGB565, 32, 32);

    for (int block = 0; block < 64; block++) {
        for (int k = 0; k < 1024; k++) {
            mem[2 * k] = (uint8_t)k;
            mem[2 * k + 1] = (uint8_t)(block * 4 + k / 256);
        }
        memcpy(before_mem, mem, sizeof mem);
        memset(fixture.light_q20, 0, sizeof fixture.light_q20);
        add_light_in_strips(&image, 0, 0);
        assert_memory_equal(mem, before_mem, sizeof mem);
        for (int k = 0; k < 1024; k++)
            fixture.light_q20[1][k] = WHITE_Q20;
        add_light_in_strips(&image, 0, 0);
        for (int k = 0; k < 1024; k++) {
            assert_int_equal(mem[2 * k], before_mem[2 * k] | 0xe0);
            assert_int_equal(mem[2 * k + 1], before_mem[2 * k + 1] | 0x07);
        }
    }
}

TEST(images_match_their_hashes)
{
    uint64_t hash = HASH_START;

    seed = 12345;
    for (int f = 0; f < 5; f++)
        for (int k = 0; k < 8; k++) {
            make_guarded_image(formats[f], 33, 18, 0);
            set_coding_by_bits(k);
            for (int i = 0; i < glint_image_planes(formats[f]); i++)
                fill_with_random_codes(i, 0, 255);
            fill_with_random_light();
            add_light_to_image(k & 1);
            hash = hash_bytes(hash, fixture.plane, sizeof fixture.plane);
        }
    if (hash != UINT64_C(0x771b307552988e33))
        fail_msg("the bytes are %llx", (unsigned long long)hash);
}
