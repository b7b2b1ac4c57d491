/* SPDX-License-Identifier: MIT
 *
 * Tests starbursts in integers. Images must be bit-identical for any tiles,
 * workers, order of jobs and machine, and extreme values must be clamped.
 * Tables are random and made with integers, so that they do not depend on
 * libm.
 */
#include "base/real.h"
#include "support/stars/any.h"
#include "support/stars/canvas.h"
#include "support/test.h"

enum { WIDTH = 97, HEIGHT = 83, N = 3 * WIDTH * HEIGHT, MAX_WORKERS = 3 };

static int32_t linear_q20[N], other_q20[N];
static uint8_t codes[N], others[N];
static struct star_any any;

static const struct glint_real all = {0, 0};

/* FAINTEST: light of 1 / 26357, which changes a code near black by 1/8 */
static const struct glint_real eighth = {0x4f8f7a00, -45};

/* ------------------------------------------------- scheduling and hashes */

/* Draws LIGHTS[N_LIGHTS] in tiles of 2^TILE_LOG2 pixels. */
static void draw_stars(const struct glint_star_light *lights, int n_lights,
                       int tile_log2, int n_workers, uint32_t order,
                       enum glint_pixel_format format, void *mem)
{
    struct star_canvas c;

    star_canvas_open(&c, WIDTH, HEIGHT, tile_log2, n_workers, order);
    star_canvas_draw_light(&c, &any.tables, lights, n_lights,
                           format == GLINT_LINEAR_Q20 ? all : eighth, format,
                           mem);
    star_canvas_close(&c);
}

/* Checks that workers, tiles and the order of jobs do not change any code. */
TEST(codes_are_bit_identical)
{
    uint32_t seed = 7;

    for (int i = 0; i < 30; i++) {
        struct glint_star_light lights[STAR_CANVAS_LIGHTS];
        const int n = 1 + rng_int_below(&seed, STAR_CANVAS_LIGHTS);

        star_make_random(&any, &seed);
        for (int k = 0; k < n; k++)
            lights[k] = star_make_random_light(WIDTH, HEIGHT, &seed);
        for (int k = 0; k < 5; k++) {
            draw_stars(lights, n, k ? 2 + k : 6, k ? 1 + k % MAX_WORKERS : 1,
                       rng_bits32(&seed), GLINT_RGB24, k ? others : codes);
            if (k)
                assert_memory_equal(codes, others, N);
        }
    }
}

/* Checks that tiles do not change any bit of linear images, also for distant
 * lights. */
TEST(linear_light_is_bit_identical)
{
    uint32_t seed = 99;

    for (int i = 0; i < 24; i++) {
        struct glint_star_light light;

        star_make_random(&any, &seed);
        light = star_make_random_light(WIDTH, HEIGHT, &seed);
        if (i % 2) {
            light.x_q8 = rng_int_below(&seed, 60000) - 20000;
            light.y_q8 = rng_int_below(&seed, 60000) - 20000;
        }
        draw_stars(&light, 1, 6, 1, 1, GLINT_LINEAR_Q20, linear_q20);
        for (int tile_log2 = 3; tile_log2 < 6; tile_log2++) {
            draw_stars(&light, 1, tile_log2, 1, 1, GLINT_LINEAR_Q20, other_q20);
            assert_memory_equal(linear_q20, other_q20, sizeof other_q20);
        }
    }
}

static uint64_t hash_word(uint64_t h, uint64_t x)
{
    return (h ^ x) * UINT64_C(1099511628211); /* FNV-1a, by words */
}

/* Checks that the codes and linear light of 40 stars have this hash on every
 * machine. */
TEST(images_match_their_hash)
{
    const uint64_t want = UINT64_C(0xe3138f46f7839366);
    uint64_t h = UINT64_C(14695981039346656037);
    uint32_t seed = 2026;
    int n_lit = 0;

    for (int i = 0; i < 40; i++) {
        struct glint_star_light light;
        bool is_lit = false;

        star_make_random(&any, &seed);
        light = star_make_random_light(WIDTH, HEIGHT, &seed);
        draw_stars(&light, 1, 5, 1, 1, GLINT_LINEAR_Q20, linear_q20);
        draw_stars(&light, 1, 5, 1, 1, GLINT_RGB24, codes);
        for (int k = 0; k < N; k++) {
            h = hash_word(hash_word(h, (uint32_t)linear_q20[k]), codes[k]);
            is_lit |= codes[k] > 0;
        }
        n_lit += is_lit;
    }
    print_message("%d of 40 stars have light in codes, hash %08lx%08lx\n",
                  n_lit, (unsigned long)(h >> 32),
                  (unsigned long)(h & 0xffffffff));
    assert_true(n_lit > 15);
    assert_true(h == want);
}

/* -------------------------------------------------------------- extremes */

/* Raises the power from invisible to saturated, for a light at a pixel's
 * centre, at its corner, on the image border, and 1000 px off two sides of the
 * image. Checks that no pixel becomes darker, except by one code due to
 * rounding. */
TEST(more_power_never_darkens_codes)
{
    static const int place_q8[][2] = {{48 * 256 + 128, 41 * 256 + 128},
                                      {48 * 256, 41 * 256},
                                      {0, 0},
                                      {WIDTH * 256, 3 * 256},
                                      {-256000, 40 * 256},
                                      {50 * 256, 256000 + HEIGHT * 256}};
    uint32_t seed = 3;

    for (int i = 0; i < 12; i++) {
        struct star_canvas c;
        int lit = 0;

        star_make_random(&any, &seed);
        star_canvas_open(&c, WIDTH, HEIGHT, 5, 1, 1);
        memset(others, 0, N);
        for (int ev = -20; ev <= 30; ev++) {
            const struct glint_star_light light = {
                .x_q8 = place_q8[i % 6][0],
                .y_q8 = place_q8[i % 6][1],
                .radius_q8 = i < 6 ? -1 : 300,
                .power = real_of(1, ev),
                .rgb_q14 = {16384, 16384, 16384}};

            star_canvas_draw_light(&c, &any.tables, &light, 1, eighth,
                                   GLINT_RGB24, codes);
            for (int k = 0; k < N; k++)
                assert_true(codes[k] + 1 >= others[k]);
            memcpy(others, codes, N);
        }
        for (int k = 0; k < N; k++)
            lit += codes[k] > 0;
        assert_true(lit > N / 20);
        star_canvas_close(&c);
    }
}

/* Checks that invalid lights draw nothing: lights without power or colour, and
 * lights further away than the limit. */
TEST(invalid_lights_draw_nothing)
{
    struct glint_star_light light[4];
    uint32_t seed = 5;

    star_make_random(&any, &seed);
    for (int i = 0; i < 4; i++)
        light[i] = (struct glint_star_light){
            48 * 256, 41 * 256, -1, real_of(1, 20), {16384, 16384, 16384}};
    light[0].power = all;
    light[1].rgb_q14[0] = light[1].rgb_q14[1] = light[1].rgb_q14[2] = 0;
    light[2].x_q8 = 1 << 25;
    light[3].y_q8 = -(1 << 25);
    draw_stars(light, 4, 5, 1, 1, GLINT_LINEAR_Q20, linear_q20);
    for (int k = 0; k < N; k++)
        assert_int_equal(linear_q20[k], 0);
}
