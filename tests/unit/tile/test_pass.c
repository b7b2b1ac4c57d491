/* SPDX-License-Identifier: MIT
 *
 * Tests a second pass in addition to the flare, by a minimal example: a flat
 * triangle that covers pixels, and is also the light source of the flare that
 * is drawn over it. Its coverage is computed from 4 x 4 points per pixel.
 */
#include "base/real.h"
#include "flare/draw_over.h"
#include "glint/kernels.h"
#include "support/model_builder.h"
#include "support/shuffle.h"
#include "support/test.h"

enum { WIDTH = 153, HEIGHT = 117, BYTES = 12 * WIDTH * HEIGHT };
enum { MAX_WORKERS = 3, N_FORMATS = 9 };

struct triangle {
    int on, half, linear;
    int corner[3][2]; /* corners, pixels; counter-clockwise with y down */
    int light_q16[3];
    struct on_row *at; /* [worker] */
};

/* State of a worker that draws a row of tiles. */
struct on_row {
    const struct triangle *triangle;
    struct glint_box row, tile;
};

static int is_inside_triangle(const struct triangle *t, int x_q3, int y_q3)
{
    int in = 1;

    for (int i = 0; i < 3; i++) {
        const int *a = t->corner[i], *b = t->corner[(i + 1) % 3];

        in &= (b[0] - a[0]) * (y_q3 - 8 * a[1]) <=
              (b[1] - a[1]) * (x_q3 - 8 * a[0]);
    }
    return in;
}

/* Returns the fraction of pixel (X, Y) that the triangle covers, Q8. */
static int compute_pixel_coverage(const struct triangle *t, int x, int y)
{
    int n = 0;

    for (int k = 0; k < 16; k++)
        n += is_inside_triangle(t, (8 * x + 2 * (k % 4) + 1) << t->half,
                                (8 * y + 2 * (k / 4) + 1) << t->half);
    return 16 * n;
}

static void *begin_tile_row(const void *self, struct glint_box row, int worker)
{
    const struct triangle *t = self;

    assert_in_range(worker, 0, MAX_WORKERS - 1);
    t->at[worker] = (struct on_row){t, row, {0, row.y0, 0, row.y1}};
    return &t->at[worker];
}

static int set_current_tile(void *state, struct glint_box tile)
{
    struct on_row *r = state;

    /* tiles are passed from left to right, without gaps */
    assert_int_equal(tile.x0, r->tile.x1);
    assert_int_equal(tile.y0, r->row.y0);
    assert_int_equal(tile.y1, r->row.y1);
    r->tile = tile;
    return r->triangle->on;
}

static enum glint_given set_coverage_of_rows(void *state,
                                             const struct glint_pass_rows *out)
{
    const struct on_row *r = state;
    const struct triangle *t = r->triangle;
    int any = 0;

    assert_true(out->n == 1 || (out->n == 2 && out->y % 2 == 0));
    for (int i = 0; i < out->n * (r->tile.x1 - r->tile.x0); i++) {
        const int row = i % out->n, x = i / out->n;
        const int cover_q8 =
            compute_pixel_coverage(t, r->tile.x0 + x, out->y + row);

        any |= cover_q8;
        out->cover->cover_q8[row][x] = (uint16_t)cover_q8;
        for (int c = 0; c < 3; c++)
            if (t->linear)
                out->light_q20[c][x] = t->light_q16[c] * cover_q8 / 16;
            else
                out->light->rgb_q16[c][row][x] =
                    (uint16_t)(t->light_q16[c] * cover_q8 / 256);
    }
    return any ? GLINT_GIVES_COVER : GLINT_GIVES_NOTHING;
}

/* Returns the triangle as a light source of the flare. It has the colour of the
 * triangle, and a power of an eighth of the triangle's area in pixels. */
static struct glint_light make_light_of_triangle(const struct triangle *t)
{
    const int(*p)[2] = t->corner;
    const int area2 = (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]) -
                      (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]);
    struct glint_light light = {0,   1 << 30, 1 << 30, 0, real_of(area2, -4),
                                {0}, 0};

    for (int c = 0; c < 3; c++)
        light.rgb_q14[c] = t->light_q16[c] / 4;
    return light;
}

struct glint_frame {
    struct glint_image image;
    struct triangle triangle;
    struct glint_flare_config cfg;
    /* alone = 1: glint_flare_draw() draws only the flare, without the pass */
    int half, n_workers, n_lights, alone;
    uint32_t order;
};

static const struct glint_frame first = {
    .image = {.width = WIDTH, .height = HEIGHT},
    .triangle = {.on = 1,
                 .corner = {{20, 12}, {28, 104}, {131, 60}},
                 .light_q16 = {65535, 26000, 9000}},
    .cfg = {.width = WIDTH,
            .height = HEIGHT,
            .tile_log2 = 6,
            .irradiance_steps = 70,
            .max_bundles = 16,
            .max_primitives = 20000,
            .max_refs = 40000},
    .n_workers = 1,
    .n_lights = 1};

static void draw_triangle_pass(struct glint_frame *f, struct glint_flare *flare)
{
    static struct glint_blend_rows rows[MAX_WORKERS];
    struct on_row at[MAX_WORKERS];
    const struct glint_pass pass = {&f->triangle, begin_tile_row,
                                    set_current_tile, set_coverage_of_rows};
    const struct glint_flare_under under = {&pass, 1, &glint_blend, rows};

    /* Rows that are filled beforehand reveal samples that the pass does not
     * set. */
    memset(rows, 0xa5, sizeof rows);
    f->triangle.half = f->half;
    f->triangle.linear = f->image.format == GLINT_LINEAR_Q20;
    f->triangle.at = at;
    glint_flare_draw_over_passes(flare, &f->image, &under);
}

/* Returns byte I of the image before drawing. */
static uint8_t compute_background_byte(int i)
{
    return (uint8_t)(40 + i * 7 / 2 % 90);
}

static void draw_flare_and_triangle(struct glint_frame f, uint8_t *px)
{
    const struct glint_wave wave = {
        MODEL_WAVE_LO_Q24, {16384, 12000, 5000}, real_of(1, 0)};
    const struct glint_light light = make_light_of_triangle(&f.triangle);
    struct model_image m = model_make_three_ghosts();
    struct glint_lens lens;
    const struct glint_flare_frame planned = {.lens = &lens,
                                              .wave = &wave,
                                              .n_waves = 1,
                                              .pixels_per_mm = real_of(64, 0),
                                              .fineness = 64,
                                              .only_ghost = -1,
                                              .faintest = real_of(163, -22),
                                              .half =
                                                  f.half ? &glint_half : NULL};
    struct glint_flare_stats stats;
    struct glint_flare *flare;
    struct shuffle shuffle;
    void *mem;

    /* every fourth byte is 0, so that linear light is below white */
    for (int i = 0; i < BYTES; i++)
        px[i] = f.image.format == GLINT_LINEAR_Q20 && i % 4 == 3
                    ? 0
                    : compute_background_byte(i);
    glint_image_place(&f.image, px);
    init_shuffled_workers(&shuffle, f.n_workers, f.order);
    lens = model_open_image(&m);
    f.cfg.workers = &shuffle.workers;
    assert_int_equal(posix_memalign(&mem, 64, glint_flare_bytes(&f.cfg)), 0);
    assert_ok(glint_flare_init(&flare, &f.cfg, mem, glint_flare_bytes(&f.cfg)));
    glint_flare_plan(flare, &planned, &light, f.n_lights);
    glint_flare_bin(flare, &stats);
    assert_true(stats.dropped_bundles == 0 &&
                (stats.primitives > 0) == (f.n_lights > 0));
    if (f.alone)
        glint_flare_draw(flare, &f.image);
    else
        draw_triangle_pass(&f, flare);
    free(mem);
}

/* two images, as linear light (Q20) or as pixel codes at the same addresses */
static int32_t one_q20[BYTES / 4], other_q20[BYTES / 4];
static uint8_t *const one = (uint8_t *)one_q20, *const other =
                                                    (uint8_t *)other_q20;

static const enum glint_pixel_format formats[N_FORMATS] = {
    GLINT_RGB24, GLINT_I420, GLINT_NV12,       GLINT_YUYV,  GLINT_I422,
    GLINT_I444,  GLINT_GREY, GLINT_LINEAR_Q20, GLINT_RGB565};

/* Checks that workers, tiles, the order of jobs and kernels do not change any
 * bit of the image. */
TEST(image_is_bit_identical)
{
    uint32_t seed = 5;

    for (int i = 0; i < 2 * N_FORMATS; i++) {
        struct glint_frame f = first;

        f.image.format = formats[i / 2];
        f.half = i % 2;
        draw_flare_and_triangle(f, one);
        for (int k = 0; k < 9; k++) {
            f.cfg.tile_log2 = 3 + k % 4;
            f.n_workers = 1 + k % MAX_WORKERS;
            f.order = rng_xorshift(&seed);
            f.cfg.sets = rng_xorshift(&seed) & glint_sets_here();
            draw_flare_and_triangle(f, other);
            assert_memory_equal(one, other, BYTES);
        }
    }
}

/* Checks that without the triangle the image is that of the flare alone, and
 * that with it the image differs. */
TEST(inactive_pass_changes_nothing)
{
    for (int i = 0; i < 2 * N_FORMATS; i++) {
        struct glint_frame f = first;

        f.image.format = formats[i / 2];
        f.half = i % 2;
        f.alone = 1;
        draw_flare_and_triangle(f, one);
        f.alone = 0;
        draw_flare_and_triangle(f, other);
        assert_memory_not_equal(one, other, BYTES);
        f.triangle.on = 0;
        draw_flare_and_triangle(f, other);
        assert_memory_equal(one, other, BYTES);
    }
}

/* Checks that before the flare is added, completely covered pixels have the
 * triangle's colour, on any background, and uncovered pixels are unchanged. */
TEST(covered_pixels_have_the_passs_colour)
{
    struct glint_frame f = first;
    int n_set = 0, n_kept = 0, n_lit = 0;

    draw_flare_and_triangle(f, other);
    f.n_lights = 0;
    draw_flare_and_triangle(f, one);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i += 3) {
        const int cover_q8 =
            compute_pixel_coverage(&f.triangle, i / 3 % WIDTH, i / 3 / WIDTH);

        n_set += cover_q8 == GLINT_COVER_ALL;
        n_kept += cover_q8 == 0;
        n_lit += cover_q8 == GLINT_COVER_ALL && other[i + 1] > one[i + 1];
        /* sRGB codes of the triangle's light, R, G, B = 1, 0.397, 0.137 */
        if (cover_q8 == GLINT_COVER_ALL)
            assert_true(one[i] == 255 && one[i + 1] == 169 &&
                        one[i + 2] == 104);
        else if (cover_q8 == 0)
            assert_true(one[i] == compute_background_byte(i) &&
                        one[i + 1] == compute_background_byte(i + 1));
        assert_true(other[i] >= one[i]);
    }
    assert_true(n_set > 1000 && n_kept > 1000 && n_lit > 100);
}
