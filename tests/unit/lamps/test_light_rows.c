/* SPDX-License-Identifier: MIT
 *
 * Tests two optimisations of the lamp finder. The light of pixel runs,
 * computed as differences of row sums, must equal pixel-by-pixel sums. Brief
 * scores of lamp candidates, which ignore the surroundings, must agree with
 * full scores.
 */
#include "support/region_pixels.h"
#include "support/rng.h"
#include "lamps/row_light.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "lamps/score.h"
#include "support/canvas.h"
#include "support/test.h"

enum { WIDTH = 70, HEIGHT = 48, ROUNDS = 300, CANDIDATES = 400 };

static uint32_t seed = 1;

struct fixture {
    struct glint_image image;
    struct glint_bright bright;
    struct glint_row_light row;
    void *mem;
};

/* Sets up an image of random codes, many of which repeat the previous pixel. */
static void make_random_image(struct fixture *f, enum glint_pixel_format format)
{
    struct glint_arena arena = glint_arena_begin_measuring();
    const size_t bytes = glint_image_bytes(format, WIDTH, HEIGHT);
    const int dark =
        /* number of bits by which random codes are shifted right: 0, or 4 for
         * dark images */
        4 * rng_int_below(&seed, 2);
    uint8_t *codes = malloc(bytes);
    const size_t pixel = /* bytes per pixel, or per two pixels */
        format == GLINT_RGB24 || format == GLINT_BGR24 ? 3 : 4;
    /* number of bytes that will still repeat the previous pixel */
    int alike = 0;

    assert_non_null(codes);
    for (size_t i = 0; i < bytes; i++, alike--) {
        if (alike <= 0)
            alike = rng_int_below(&seed, 3) ? 0 : 4 * rng_int_below(&seed, 16);
        codes[i] =
            (uint8_t)(i >= pixel && (alike > 0 || rng_int_below(&seed, 2))
                          ? codes[i - pixel]
                          : rng_int_below(&seed, 256) >> dark);
    }
    *f = (struct fixture){
        .image = {.format = format, .width = WIDTH, .height = HEIGHT}};
    glint_image_place(&f->image, codes);
    for (int pass = 0; pass < 2; pass++) {
        glint_bright_allocate(&f->bright, &arena, WIDTH);
        glint_row_light_allocate(&f->row, &arena, WIDTH);
        if (pass == 0) {
            assert_int_equal(posix_memalign(&f->mem, 64, arena.used), 0);
            memset(f->mem, 0x5a, arena.used);
            arena = glint_arena_init_in_memory(f->mem, arena.used);
        }
    }
    glint_bright_init(&f->bright, WIDTH);
    glint_bright_begin_picture(&f->bright, &f->image);
}

static void free_random_image(struct fixture *f)
{
    free(f->image.plane[0]);
    free(f->mem);
}

/* Adds the pixels X0 .. X1 - 1 to REGION one by one, as a reference for
 * glint_row_light_add_run_to_region(). */
static void add_light_by_pixel(const struct fixture *f,
                               struct glint_region *region, int x0, int x1,
                               int y)
{
    const int32_t clipped_q20 = f->bright.curve->decode_q20[BRIGHT_CLIPPED];

    for (int x = x0 - ROW_LIGHT_RIM; x < x1 + ROW_LIGHT_RIM; x++) {
        struct glint_region_light light;
        int32_t rgb_q20[3];
        int is_clipped = 0;

        if (x < 0 || x >= WIDTH)
            continue;
        glint_bright_read_pixel_light(&f->bright, x, rgb_q20);
        light = region_compute_pixel_light(rgb_q20);
        if (x >= x0 && x < x1)
            region_add_pixels(region, &light, x, x + 1, y);
        for (int i = 0; i < 3; i++)
            is_clipped |= rgb_q20[i] >= clipped_q20;
        for (int i = 0; i < 3 && !is_clipped; i++)
            region->rim_rgb_q14[i] += light.rgb_q14[i];
    }
}

/* Checks the light of random runs within two spans of row Y, which may
 * overlap. */
static void check_runs_of_row(struct fixture *f, int y)
{
    const int from = rng_int_below(&seed, 20),
              to = from + rng_int_below(&seed, 20);
    const int next = to - rng_int_below(&seed, 5) + 2;
    const int ends[2][2] = {{from, to}, {next < from ? from : next, WIDTH}};
    struct glint_region sum, plain;

    memset(&sum, 0, sizeof sum);
    memset(&plain, 0, sizeof plain);
    glint_bright_select_row(&f->bright, y);
    glint_row_light_begin_row(&f->row);
    for (int i = 0; i < 2; i++)
        glint_row_light_sum_pixels(&f->row, &f->bright, ends[i][0], ends[i][1]);
    for (int i = 0; i < 2; i++) {
        const int x0 = ends[i][0] > 0 ? ends[i][0] + ROW_LIGHT_RIM : ends[i][0];
        const int x1 =
            ends[i][1] < WIDTH ? ends[i][1] - ROW_LIGHT_RIM : ends[i][1];

        if (x0 >= x1)
            continue;
        /* The first run is the whole span; the other three lie inside it. */
        for (int j = 0; j < 4; j++) {
            const int begin = j ? x0 + rng_int_below(&seed, x1 - x0) : x0;
            const int end =
                j ? begin + 1 + rng_int_below(&seed, x1 - begin) : x1;

            glint_row_light_add_run_to_region(&f->row, &sum, begin, end, WIDTH,
                                              y + 1000);
            add_light_by_pixel(f, &plain, begin, end, y + 1000);
        }
    }
    assert_memory_equal(&sum, &plain, sizeof sum);
}

TEST(light_of_runs_equals_sum_of_pixels)
{
    for (int round = 0; round < ROUNDS; round++) {
        struct fixture f;

        make_random_image(&f, canvas_format[round % CANVAS_FORMATS]);
        for (int y = 0; y < HEIGHT; y++)
            check_runs_of_row(&f, y);
        free_random_image(&f);
    }
}

/* Returns a random candidate region in the image, with any light and filling
 * any fraction of its bounding box. */
static struct glint_candidate make_random_candidate(void)
{
    const int x0 = rng_int_below(&seed, WIDTH - 1),
              y0 = rng_int_below(&seed, HEIGHT - 1);
    const int x1 = x0 + 1 + rng_int_below(&seed, WIDTH - x0);
    const int y1 = y0 + 1 + rng_int_below(&seed, HEIGHT - y0);
    struct glint_candidate c = {.sum = {.x0 = x0, .y0 = y0}};
    /* the max difference between white and each channel is 2^HIDDEN, Q20 */
    const int hidden = 10 + rng_int_below(&seed, 11);
    const int32_t rgb_q20[3] = {(1 << 20) - rng_int_below(&seed, 1 << hidden),
                                (1 << 20) - rng_int_below(&seed, 1 << hidden),
                                (1 << 20) - rng_int_below(&seed, 1 << hidden)};
    const struct glint_region_light light = region_compute_pixel_light(rgb_q20);

    for (int y = y0; y < y1; y++) {
        glint_region_add_run(&c.sum, x0, x1, y);
        region_add_pixels(&c.sum, &light, x0, x1, y);
    }
    if (rng_int_below(&seed,
                      /* some regions fill most of their box, as lamps do */
                      2)) {
        c.sum.area -= rng_int_below(&seed, c.sum.area) / 8;
        c.sum.n_clipped = c.sum.area - rng_int_below(&seed, c.sum.area);
    } else
        c.sum.area = 1 + rng_int_below(&seed, c.sum.area) / 256;
    return c;
}

/* The brief score saves time for candidates that are certainly not lamps.
 * Checks that it equals the full score if that is at least -SCORE_DOUBT;
 * otherwise it must lie between the full score and -SCORE_DOUBT. */
TEST(brief_score_bounds_the_full_score)
{
    int n_kept = 0, n_brief = 0;

    for (int round = 0; round < CANDIDATES; round++) {
        static const struct glint_level level = {200, 230, 250, 0};
        struct glint_candidate c[2];
        struct glint_white white;
        const int32_t order = 0;
        struct fixture f;

        make_random_image(&f, canvas_format[round % CANVAS_FORMATS]);
        glint_white_measure_picture(&white, &f.bright, HEIGHT);
        c[0] = c[1] = make_random_candidate();
        for (int brief = 0; brief < 2; brief++) {
            const struct glint_score score = {&f.bright, &white, WIDTH, HEIGHT,
                                              &level,    brief,  0};

            glint_score_score_candidates(&score, &c[brief], &order, 1);
        }
        if (c[0].score_q8 >= -SCORE_DOUBT)
            assert_int_equal(c[1].score_q8, c[0].score_q8);
        else
            assert_in_range(-c[1].score_q8, SCORE_DOUBT + 1, -c[0].score_q8);
        n_kept += c[0].score_q8 >= -SCORE_DOUBT;
        n_brief += c[0].score_q8 != c[1].score_q8;
        free_random_image(&f);
    }
    print_message("%d of %d kept, %d brief\n", n_kept, CANDIDATES, n_brief);
    assert_true(n_kept > 0 && n_brief > 0);
}
