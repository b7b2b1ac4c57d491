/* SPDX-License-Identifier: MIT
 *
 * Tests dirt on the front element. Its light must be the haze times the
 * fraction of a pixel's rays that pass through dirt, summed over the stop.
 * Images must be bit-identical for any tiles and workers, and a clean front
 * must add no light.
 */
#include "engine/frame/front.h"
#include "engine/setup/entrance.h"
#include "support/hash.h"
#include "support/stars/bare_flare.h"
#include "support/test.h"
#include "veil/glare.h"

enum { WIDTH = 131, HEIGHT = 75 };

static const struct glint_real one = {1 << 30, -30};

/* Optics of an octagonal stop behind a front element 20 mm wide. */
static const struct glint_front_optics optics = {.tangent = 1. / WIDTH,
                                                 .z = 1.4,
                                                 .radius = 0.12,
                                                 .width = WIDTH,
                                                 .height = HEIGHT,
                                                 .n_blades = 8};

static struct glint_front_dirt *make_front_dirt(const struct glint_front *front)
{
    struct glint_front_dirt *dirt;
    struct glint_error error;

    assert_ok(glint_front_make(&dirt, front, &error));
    return dirt;
}

static struct glint_front_table *
make_front_table(const struct glint_front_dirt *dirt,
                 const struct glint_setup *setup)
{
    struct glint_front_table *table;

    assert_ok(dirt->method->table(&table, dirt, &optics, setup));
    return table;
}

/* ----------------------------------------------- fraction of dirt per node */

TEST(table_has_the_dust_fractions)
{
    static const struct glint_setup setup = {.n_blades = 8};
    struct glint_front_dirt *dirt =
        make_front_dirt(&(struct glint_front){.dust = 0.05, .dust_seed = 3});
    struct glint_front_table *t = make_front_table(dirt, &setup);
    double worst = 0;

    assert_int_equal(t->front.n_x, GLINT_VEIL_FRONT_NODES(WIDTH));
    for (int j = 0; j < t->front.n_y; j += 3)
        for (int i = 0; i < t->front.n_x; i += 3) {
            const double want = glint_front_sum_pixel_cover(
                dirt, &optics, &setup, 4 * i, 4 * j, 100);
            const double is =
                t->front.part_q16[j * t->front.n_x + i] * t->most / 65535;

            worst = fmax(worst, fabs(is - want));
        }
    print_message("covered %.4f in the mean, %.4f at most, off by %.5f\n",
                  t->mean, t->most, worst);
    assert_true(worst < 0.03 * t->most);
    assert_true(t->mean > 0.03 && t->mean < 0.2 && t->most > 1.5 * t->mean);
    free(t);
    glint_front_free(dirt);
}

/* Checks how the lens mirrors a mask over the left half of the front element
 * (seen from the sensor, x right): it must cover the right half of the image,
 * whose light passes the left half of the element. The upper side of the mask
 * must be the upper side of the element. */
TEST(mask_is_mirrored_by_the_lens)
{
    static const uint8_t left[4] = {0, 255, 0, 255}, high[4] = {0, 0, 255, 255};
    static const struct glint_setup setup = {.n_blades = 8};

    for (int k = 0; k < 2; k++) {
        struct glint_front_dirt *dirt = make_front_dirt(&(struct glint_front){
            .mask = k ? high : left, .mask_width = 2, .mask_height = 2});
        const double low = glint_front_sum_pixel_cover(
            dirt, &optics, &setup, WIDTH / 2 - (k ? 0 : 30),
            HEIGHT / 2 - (k ? 20 : 0), 40);
        const double far = glint_front_sum_pixel_cover(
            dirt, &optics, &setup, WIDTH / 2 + (k ? 0 : 30),
            HEIGHT / 2 + (k ? 20 : 0), 40);

        assert_true(low < 1e-3 && far > 0.99);
        glint_front_free(dirt);
    }
}

TEST(rejects_invalid_dirt)
{
    static const uint8_t mask[4] = {0, 0, 0, 0};
    static const struct glint_front bad[] = {
        {.dust = -0.1},
        {.dust = 0.6},
        {.dust = NAN},
        {.mask = mask, .mask_width = 1, .mask_height = 4}};
    struct glint_front_dirt *dirt;
    struct glint_error error;

    for (int k = 0; k < 4; k++) {
        assert_int_equal(glint_front_make(&dirt, &bad[k], &error),
                         GLINT_E_ARGUMENT);
        assert_null(dirt);
    }
    assert_null(make_front_dirt(&(struct glint_front){0}));
    glint_front_free(NULL);
}

/* ------------------------------------------------------- light of the haze */

/* A table of random fractions, and haze whose light is the same in all
 * cells. */
struct scene {
    struct bare_flare bare;
    struct glint_veil *veil;
    void *mem;
    uint16_t part_q16[GLINT_VEIL_FRONT_NODES(WIDTH) *
                      GLINT_VEIL_FRONT_NODES(HEIGHT)];
    struct glint_veil_front front;
};

static void open_haze_and_dirt_scene(struct scene *s, int tile_log2,
                                     int n_workers, uint32_t order)
{
    const struct glint_veil_config cfg = {n_workers, WIDTH, HEIGHT, 1};
    const size_t bytes = glint_veil_count_bytes(&cfg);
    uint32_t seed = 9;

    bare_flare_open(&s->bare, WIDTH, HEIGHT, tile_log2, n_workers, order);
    s->mem = bare_flare_allocate_filled(bytes);
    assert_ok(glint_veil_init(&s->veil, &cfg, s->mem, bytes));
    for (size_t i = 0; i < sizeof s->part_q16 / 2; i++)
        s->part_q16[i] = (uint16_t)rng_int_below(&seed, 65536);
    s->front = (struct glint_veil_front){
        glint_veil_add_front_row, GLINT_VEIL_FRONT_NODES(WIDTH),
        GLINT_VEIL_FRONT_NODES(HEIGHT), s->part_q16};
}

static void close_haze_scene(struct scene *s)
{
    bare_flare_close(&s->bare);
    free(s->mem);
}

/* Draws the uniform haze of a lamp into MEM. LIGHT: light of the haze where the
 * dirt is densest, 1 = white. */
static void draw_haze_of_lamp(struct scene *s, double light,
                              enum glint_pixel_format format, void *mem)
{
    const int32_t rgb_q14[3] = {16384, 16384, 16384};
    struct glint_image image = glint_image_over(mem, format, WIDTH, HEIGHT);
    struct glint_veil_spread even;
    int cells[2];

    glint_veil_count_cells(WIDTH, HEIGHT, cells);
    for (int k = 0; k < 2; k++) {
        int32_t *table = k ? even.down_q30 : even.across_q30;
        int32_t rest = 1 << 30;

        for (int d = cells[k]; d > 0; d--) {
            table[d] = (1 << 29) / cells[k];
            rest -= (d == cells[k] ? 1 : 2) * table[d];
        }
        table[0] = rest;
    }
    even.share =
        glint_real_of(light * cells[0] * cells[1] / 1000 / (WIDTH * HEIGHT));
    glint_veil_read_picture(s->veil, NULL, one, &s->bare.shuffle.workers);
    glint_veil_add_lamp(s->veil, 60 * 256, 40 * 256,
                        glint_real_of(1000.0 * WIDTH * HEIGHT), rgb_q14);
    glint_veil_spread_light(s->veil, NULL, 0);
    glint_veil_front(s->veil, &s->front, &even, 1);
    glint_veil_draw_alone(s->veil, s->bare.flare, &image);
}

/* Checks that each pixel of a linear image gets the haze's light times the
 * fraction of dirt, interpolated linearly between nodes. */
TEST(linear_light_is_interpolated_between_nodes)
{
    static int32_t linear_q20[3 * WIDTH * HEIGHT];
    static struct scene s;
    double worst = 0;

    open_haze_and_dirt_scene(&s, 5, 1, 1);
    draw_haze_of_lamp(&s, 0.25, GLINT_LINEAR_Q20, linear_q20);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const uint16_t *at = s.part_q16 + y / 4 * s.front.n_x + x / 4;
            const double u = (x % 4 + 0.5) / 4, v = (y % 4 + 0.5) / 4;
            const double top = at[0] + u * (at[1] - at[0]);
            const double low =
                at[s.front.n_x] + u * (at[s.front.n_x + 1] - at[s.front.n_x]);
            const double want = 0.25 * (top + v * (low - top)) / 65536;

            worst = fmax(
                worst, fabs(linear_q20[3 * (y * WIDTH + x)] * 0x1p-20 - want));
        }
    print_message("light off by %.6f of white\n", worst);
    assert_true(worst < 1e-4);
    glint_veil_front(s.veil, NULL, NULL, 0);
    close_haze_scene(&s);
}

/* Checks images of pixel codes. Tiles, workers and order must not change any
 * bit, for dim light and for light above white. More light must make no pixel
 * darker, and every machine must draw the same image. */
TEST(codes_are_bit_identical)
{
    const uint64_t want = UINT64_C(0x5b5e6baa4b36eb8a);
    static uint8_t first[3 * WIDTH * HEIGHT], other[sizeof first];
    static uint8_t before[sizeof first];
    static struct scene s;
    uint64_t h = HASH_START;

    memset(before, 0, sizeof before);
    for (int k = 0; k < 6; k++) {
        const double light = ldexp(0.01, 3 * k);

        memset(first, 0, sizeof first);
        memset(other, 0, sizeof other);
        open_haze_and_dirt_scene(&s, 6, 1, 1);
        draw_haze_of_lamp(&s, light, GLINT_RGB24, first);
        close_haze_scene(&s);
        open_haze_and_dirt_scene(&s, 3 + k % 3, 1 + k % 3, 7 + (uint32_t)k);
        draw_haze_of_lamp(&s, light, GLINT_RGB24, other);
        close_haze_scene(&s);
        assert_memory_equal(first, other, sizeof first);
        for (size_t i = 0; i < sizeof first; i++)
            assert_true(first[i] >= before[i]);
        h = hash_bytes(h, first, sizeof first);
        memcpy(before, first, sizeof first);
    }
    print_message("hash %08lx%08lx\n", (unsigned long)(h >> 32),
                  (unsigned long)(h & 0xffffffff));
    assert_true(h == want);
}
