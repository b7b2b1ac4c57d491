/* SPDX-License-Identifier: MIT
 *
 * Tests veiling glare: the amount and distribution of its light, and the
 * veiling glare index by ISO 9358. Images must be bit-identical for any
 * workers, tiles and order of jobs, and change continuously while a lamp
 * moves.
 */
#include "glint/kernels.h"
#include "support/hash.h"
#include "support/stars/bare_flare.h"
#include "support/test.h"
#include "veil/glare.h"

enum { MAX_WIDTH = 163, MAX_HEIGHT = 121, MAX_N = 3 * MAX_WIDTH * MAX_HEIGHT };
enum { MAX_WORKERS = 3 };

static int32_t linear_q20[MAX_N];
static const struct glint_real one = {1 << 30, -30};

/* A veil, and a flare renderer without ghosts that draws it. */
struct canvas {
    int width, height, cells[2];
    struct bare_flare bare;
    struct glint_veil *veil;
    void *mem; /* memory of the veil renderer */
};

static void open_veil_canvas(struct canvas *c, int width, int height,
                             int tile_log2, int n_workers, uint32_t order)
{
    const struct glint_veil_config veil = {n_workers, width, height, 0};
    const size_t bytes = glint_veil_count_bytes(&veil);

    c->width = width;
    c->height = height;
    glint_veil_count_cells(width, height, c->cells);
    bare_flare_open(&c->bare, width, height, tile_log2, n_workers, order);
    c->mem = bare_flare_allocate_filled(bytes);
    assert_int_equal(glint_veil_init(&c->veil, &veil, c->mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_ok(glint_veil_init(&c->veil, &veil, c->mem, bytes));
}

static void close_veil_canvas(struct canvas *c)
{
    bare_flare_close(&c->bare);
    free(c->mem);
}

/* Sets TABLE[N] to a Gaussian with a standard deviation of SIGMA cells. */
static void set_gaussian_table(int32_t *table_q30, int n, double sigma)
{
    double at[GLINT_VEIL_CELLS + 1], sum = 0;
    int32_t rest = 1 << 30;

    for (int d = 0; d <= n; d++) {
        at[d] = 0;
        for (int k = -20; k <= 20; k++)
            at[d] += exp(-0.5 * pow((d + 2.0 * n * k) / sigma, 2));
        sum += (d == 0 || d == n ? 1 : 2) * at[d];
    }
    for (int d = n; d > 0; d--) {
        table_q30[d] = (int32_t)lrint(at[d] / sum * 0x1p30);
        rest -= (d == n ? 1 : 2) * table_q30[d];
    }
    table_q30[0] = rest;
}

/* Makes a Gaussian spread function with a standard deviation of SIGMA pixels,
 * which spreads the fraction SHARE of all light. */
static struct glint_veil_spread make_gaussian_spread(const struct canvas *c,
                                                     double sigma, double share)
{
    struct glint_veil_spread s;

    set_gaussian_table(s.across_q30, c->cells[0],
                       sigma * c->cells[0] / c->width);
    set_gaussian_table(s.down_q30, c->cells[1],
                       sigma * c->cells[1] / c->height);
    s.share =
        glint_real_of(share * c->cells[0] * c->cells[1] / c->width / c->height);
    return s;
}

/* Returns an image with its pixels in MEM. */
static struct glint_image make_image_over_memory(const struct canvas *c,
                                                 enum glint_pixel_format format,
                                                 void *mem)
{
    return glint_image_over(mem, format, c->width, c->height);
}

/* Draws the veil onto black in linear light. Returns the sum of CHANNEL over
 * all pixels, white x pixels. */
static double draw_and_sum_veil(struct canvas *c, int channel)
{
    const struct glint_image image =
        make_image_over_memory(c, GLINT_LINEAR_Q20, linear_q20);
    double sum = 0;

    memset(linear_q20, 0, 12 * (size_t)c->width * (size_t)c->height);
    glint_veil_draw_alone(c->veil, c->bare.flare, &image);
    for (int i = 0; i < c->width * c->height; i++)
        sum += linear_q20[3 * i + channel] * 0x1p-20;
    return sum;
}

static void clear_veil_light(struct canvas *c)
{
    glint_veil_read_picture(c->veil, NULL, one, &c->bare.shuffle.workers);
}

static void add_lamp_to_veil(struct canvas *c, double x, double y, double power)
{
    const int32_t rgb_q14[3] = {16384, 8192, 0};

    glint_veil_add_lamp(c->veil, (int32_t)lrint(256 * x),
                        (int32_t)lrint(256 * y), glint_real_of(power), rgb_q14);
}

/* ------------------------------------------------------------------- light */

/* Checks that for any image size and lamp position the total light of the veil
 * is the specified fraction of the lamp's light, within 0.1 %. */
TEST(veil_has_its_fraction_of_the_light)
{
    static const int size[][2] = {{163, 121}, {64, 36}, {97, 3},  {1, 1},
                                  {5, 121},   {2, 2},   {160, 90}};
    static const double sigma[] = {3, 12, 60};

    for (int k = 0; k < 7; k++)
        for (int i = 0; i < 9; i++) {
            struct canvas c;
            struct glint_veil_spread s;
            const double x = 0.5 * (i % 3), y = 0.5 * (i / 3);

            open_veil_canvas(&c, size[k][0], size[k][1], 5, 1, 1);
            s = make_gaussian_spread(&c, sigma[i % 3], 0.03);
            clear_veil_light(&c);
            add_lamp_to_veil(&c, x * c.width, y * c.height, 500);
            glint_veil_spread_light(c.veil, &s, 1);
            /* At the middle of three columns, the interpolation weights are not
             * exact. */
            assert_true(fabs(draw_and_sum_veil(&c, 0) / 15 - 1) < 1e-3);
            assert_true(fabs(draw_and_sum_veil(&c, 1) / 7.5 - 1) < 1e-3);
            assert_true(draw_and_sum_veil(&c, 2) == 0);
            close_veil_canvas(&c);
        }
}

/* Checks that the veil of a lamp is the specified Gaussian, widened by the
 * interpolation between cells, if it is far from borders and wider than
 * cells. */
TEST(veil_of_a_lamp_is_a_gaussian)
{
    struct canvas c;
    struct glint_veil_spread s;
    double worst = 0;
    const double sigma = 14;

    open_veil_canvas(&c, 160, 120, 6, 2, 1);
    s = make_gaussian_spread(&c, sigma, 1);
    clear_veil_light(&c);
    add_lamp_to_veil(&c, 81.3, 60.2, 4096);
    glint_veil_spread_light(c.veil, &s, 1);
    draw_and_sum_veil(&c, 0);
    for (int y = 30; y < 90; y++)
        for (int x = 40; x < 120; x++) {
            /* Two interpolations by quadratic splines each add the variance of
             * 1/4 cell^2. Cells are 4 pixels wide. */
            const double v = sigma * sigma + 0.5 * 16;
            const double r2 = pow(x + 0.5 - 81.3, 2) + pow(y + 0.5 - 60.2, 2);
            const double want =
                4096 / (2 * 3.14159265358979 * v) * exp(-0.5 * r2 / v);
            const double is = linear_q20[3 * (160 * y + x)] * 0x1p-20;

            worst = fmax(worst, fabs(is - want) / 4096 * 2 * 3.14159 * v);
        }
    print_message("off by %.5f of the brightest\n", worst);
    assert_true(worst < 0.01);
    close_veil_canvas(&c);
}

/* Checks, in each format, that the veil of uniform white is uniform, and that
 * the veil in a black spot has the fraction V of the light of the white around
 * it; V is the veiling glare index of ISO 9358. For this, the spread function
 * has the fraction V / (1 - V) of the light. */
TEST(black_spot_has_the_veiling_glare_index)
{
    static uint8_t codes[4 * MAX_WIDTH * MAX_HEIGHT];

    for (int f = GLINT_RGB24; f <= GLINT_RGB565; f++) {
        struct canvas c;
        struct glint_image image;
        struct glint_veil_spread s;
        double least = 1e9, most = 0;

        if (f == GLINT_LINEAR_Q20)
            continue;
        open_veil_canvas(&c, 162, 121, 5, 2, 3);
        image = make_image_over_memory(&c, (enum glint_pixel_format)f, codes);
        for (int p = 0; p < glint_image_planes(image.format); p++)
            memset(image.plane[p], p ? 128 : 255,
                   (size_t)image.stride_bytes[p] *
                       (size_t)glint_image_plane_height(image.format, p, 121));
        for (int i = 0; i < 162 * 121; i++) {
            if (f == GLINT_YUYV)
                codes[2 * i + 1] = 128;
            else if (f == GLINT_UYVY)
                codes[2 * i] = 128;
        }
        s = make_gaussian_spread(&c, 20, 0.05 / 0.95);
        glint_veil_read_picture(c.veil, &image, one, &c.bare.shuffle.workers);
        glint_veil_spread_light(c.veil, &s, 1);
        draw_and_sum_veil(&c, 1);
        for (int i = 0; i < 162 * 121; i++) {
            least = fmin(least, linear_q20[3 * i + 1] * 0x1p-20);
            most = fmax(most, linear_q20[3 * i + 1] * 0x1p-20);
        }
        assert_true(fabs(least / (1 + least) - 0.05) < 5e-4);
        assert_true(fabs(most / (1 + most) - 0.05) < 5e-4);
        close_veil_canvas(&c);
    }
}

/* Checks that the veil of an image has the position and colour of the light in
 * the image, in linear light. */
TEST(veil_of_an_image_has_its_colours)
{
    static uint8_t codes[3 * MAX_WIDTH * MAX_HEIGHT];
    struct canvas c;
    struct glint_image image;
    struct glint_veil_spread s;
    double sum[3] = {0}, at[2] = {0};

    open_veil_canvas(&c, 161, 121, 5, 1, 1);
    image = make_image_over_memory(&c, GLINT_RGB24, codes);
    memset(codes, 0, sizeof codes);
    for (int y = 20; y < 40; y++)
        for (int x = 100; x < 130; x++) {
            codes[3 * (161 * y + x)] = 255;
            codes[3 * (161 * y + x) + 1] = 188; /* half of white */
        }
    s = make_gaussian_spread(&c, 6, 0.1);
    glint_veil_read_picture(c.veil, &image, glint_real_of(2),
                            &c.bare.shuffle.workers);
    glint_veil_spread_light(c.veil, &s, 1);
    draw_and_sum_veil(&c, 0);
    for (int i = 0; i < 161 * 121; i++) {
        for (int k = 0; k < 3; k++)
            sum[k] += linear_q20[3 * i + k] * 0x1p-20;
        at[0] += linear_q20[3 * i] * 0x1p-20 * (i % 161 + 0.5);
        at[1] += linear_q20[3 * i] * 0x1p-20 * (i / 161 + 0.5);
    }
    /* here a cell of four pixels covers three to five pixels */
    assert_true(fabs(sum[0] / (600 * 0.2) - 1) < 0.03);
    assert_true(fabs(sum[1] / sum[0] - 0.5029) < 2e-3); /* sRGB 188 */
    assert_true(sum[2] == 0);
    assert_true(fabs(at[0] / sum[0] - 115) < 0.5);
    assert_true(fabs(at[1] / sum[0] - 30) < 0.5);
    close_veil_canvas(&c);
}

/* ------------------------------------------------------------ moving lamps */

/* Moves a lamp by 0.05 px per frame. Checks that the total light of the veil
 * does not change, and that no pixel changes by more than the slope of the
 * Gaussian allows. */
TEST(moving_lamp_keeps_the_veil_steady)
{
    static int32_t before_q20[MAX_N];
    struct canvas c;
    struct glint_veil_spread s;
    double least = 1e9, most = 0, jump = 0, peak = 0;

    open_veil_canvas(&c, 160, 90, 5, 1, 1);
    s = make_gaussian_spread(&c, 8, 0.1);
    for (int i = 0; i < 200; i++) {
        double sum;

        clear_veil_light(&c);
        add_lamp_to_veil(&c, 60 + 0.05 * i, 40 + 0.02 * i, 3000);
        glint_veil_spread_light(c.veil, &s, 1);
        sum = draw_and_sum_veil(&c, 0);
        least = fmin(least, sum);
        most = fmax(most, sum);
        for (int k = 0; k < 3 * 160 * 90; k++) {
            peak = fmax(peak, linear_q20[k] * 0x1p-20);
            if (i)
                jump = fmax(jump, abs(linear_q20[k] - before_q20[k]) * 0x1p-20);
        }
        memcpy(before_q20, linear_q20, sizeof before_q20);
    }
    print_message("light %.5f to %.5f of 300, steps of %.5f of the peak\n",
                  least, most, jump / peak);
    assert_true(most / least < 1.0005);
    /* the max slope of a Gaussian is 0.61 of its peak / sigma */
    assert_true(jump / peak < 1.2 * 0.61 * hypot(0.05, 0.02) / 8);
    close_veil_canvas(&c);
}

/* --------------------------------------------------- scheduling and hashes */

/* Sets the spread function S to random numbers, without floating point. */
static void set_random_spread(struct glint_veil_spread *s,
                              const struct canvas *c, uint32_t *seed)
{
    int32_t *const table[2] = {s->across_q30, s->down_q30};

    for (int k = 0; k < 2; k++) {
        int32_t rest = 1 << 30;

        for (int d = c->cells[k]; d > 0; d--) {
            table[k][d] = rng_int_below(seed, 1 << 22);
            rest -= (d == c->cells[k] ? 1 : 2) * table[k][d];
        }
        table[k][0] = rest;
    }
    s->share = (struct glint_real){(1 << 30) + rng_int_below(seed, 1 << 24),
                                   -38 - rng_int_below(seed, 4)};
}

/* Draws the veil of a random image (seed SEED) onto that image. */
static void draw_veil_of_random_image(uint32_t seed, int tile_log2,
                                      int n_workers, uint32_t order,
                                      enum glint_pixel_format format,
                                      uint8_t *mem)
{
    struct canvas c;
    struct glint_image image;
    struct glint_veil_spread s[2];
    const size_t bytes = glint_image_bytes(format, 130, 75);
    const int32_t rgb_q14[3] = {16384, 9000, 3};

    open_veil_canvas(&c, 130, 75, tile_log2, n_workers, order);
    image = make_image_over_memory(&c, format, mem);
    for (size_t i = 0; i < bytes; i++)
        mem[i] = (uint8_t)(rng_int_below(&seed, 256) *
                           (format == GLINT_LINEAR_Q20 && i % 4 == 3 ? 0 : 1));
    glint_veil_read_picture(c.veil, &image, one, &c.bare.shuffle.workers);
    for (int i = 0; i < 3; i++)
        glint_veil_add_lamp(c.veil, rng_int_below(&seed, 130 * 256),
                            rng_int_below(&seed, 75 * 256),
                            (struct glint_real){1 << 30, -30 + 3 * i}, rgb_q14);
    for (int i = 0; i < 2; i++)
        set_random_spread(&s[i], &c, &seed);
    glint_veil_spread_light(c.veil, s, 2);
    glint_veil_draw(c.veil, NULL, c.bare.flare, &image);
    close_veil_canvas(&c);
}

/* Checks that workers, tiles and the order of jobs do not change any bit of the
 * image, in any format, and that every machine draws the same image. */
TEST(veil_is_bit_identical)
{
    const uint64_t want = UINT64_C(0x8c34ca68742ff06b);
    static uint8_t first[12 * 130 * 75], other[12 * 130 * 75];
    uint64_t h = HASH_START;

    for (int f = GLINT_RGB24; f <= GLINT_RGB565; f++) {
        const enum glint_pixel_format format = (enum glint_pixel_format)f;
        const size_t bytes = glint_image_bytes(format, 130, 75);

        draw_veil_of_random_image(7 + (uint32_t)f, 6, 1, 1, format, first);
        for (int k = 0; k < 4; k++) {
            draw_veil_of_random_image(7 + (uint32_t)f, 3 + k % 4,
                                      1 + k % MAX_WORKERS, 100 + (uint32_t)k,
                                      format, other);
            assert_memory_equal(first, other, bytes);
        }
        h = hash_bytes(h, first, bytes);
    }
    print_message("hash %08lx%08lx\n", (unsigned long)(h >> 32),
                  (unsigned long)(h & 0xffffffff));
    assert_true(h == want);
}

/* ----------------------------------------------------------------- extremes */

/* Checks lamps of any power at the borders of the image and outside it. More
 * power must not reduce the total light, and lamps outside must add none. */
TEST(extreme_lamps_give_valid_veils)
{
    static const double place[][2] = {{0, 0},     {160, 90}, {80.5, 45},
                                      {-0.01, 3}, {161, 3},  {1160, 3}};
    struct canvas c;
    struct glint_veil_spread s;

    open_veil_canvas(&c, 160, 90, 5, 1, 1);
    s = make_gaussian_spread(&c, 8, 0.9);
    for (int k = 0; k < 6; k++) {
        double before = -1;

        for (int p = -20; p <= 60; p += 5) {
            double sum;

            clear_veil_light(&c);
            add_lamp_to_veil(&c, place[k][0], place[k][1], ldexp(1, p));
            glint_veil_spread_light(c.veil, &s, 1);
            sum = draw_and_sum_veil(&c, 0);
            assert_true(sum >= before);
            assert_true(k < 3 || sum == 0);
            assert_true(p < 10 || k >= 3 || sum > 0);
            before = sum;
        }
    }
    close_veil_canvas(&c);
    assert_int_equal(
        glint_veil_count_bytes(&(struct glint_veil_config){0, 160, 90, 0}), 0);
    assert_int_equal(
        glint_veil_count_bytes(&(struct glint_veil_config){1, 0, 90, 0}), 0);
    assert_int_equal(
        glint_veil_count_bytes(&(struct glint_veil_config){1, 160, 40000, 0}),
        0);
}
