/* SPDX-License-Identifier: MIT
 *
 * Draws hand-made grids with the integer rasteriser: tiles, workers and the
 * order of jobs do not change the image, and images have the expected hashes
 * (tests/golden).
 */
#include "glint/kernels.h"
#include "glint/pool.h"
#include "linux/sets.h"
#include "support/ghosts.h"
#include "support/hash.h"
#include "support/shuffle.h"
#include "support/test.h"

/* ------------------------------------------------- tiles, threads and order */

TEST(image_does_not_depend_on_tiles)
{
    struct glint_flare_config c = make_octagonal_stop_config();

    draw_scene(c, want);
    assert_true(sum_channel_light(want, 0) > 1);
    for (c.tile_log2 = 4; c.tile_log2 <= 6; c.tile_log2++)
        assert_pixels_equal_want(c);
}

TEST(image_does_not_depend_on_threads)
{
    for (int n = 1; n <= 8; n++) {
        struct glint_flare_config c = make_octagonal_stop_config();

        draw_scene(c, want);
        assert_ok(glint_pool_create(&c.workers, n));
        assert_pixels_equal_want(c);
        glint_pool_destroy(c.workers);
    }
}

TEST(image_does_not_depend_on_job_order)
{
    for (uint32_t seed = 1; seed <= 8; seed++) {
        struct glint_flare_config c = make_octagonal_stop_config();
        struct shuffle shuffle;

        draw_scene(c, want);
        init_shuffled_workers(&shuffle, 5, seed);
        c.workers = &shuffle.workers;
        assert_pixels_equal_want(c);
    }
}

/* An image of any format, with its own memory, on which random ghosts are
 * drawn. */
struct random_picture {
    struct glint_image image;
    uint8_t *mem;
    size_t bytes;
};

static void make_random_picture(struct random_picture *p,
                                enum glint_pixel_format f, uint32_t seed)
{
    p->image =
        (struct glint_image){.format = f,
                             .width = WIDTH,
                             .height = HEIGHT,
                             .range = (enum glint_range)(seed & 1),
                             .matrix = (enum glint_matrix)(seed >> 1 & 1),
                             .transfer = (enum glint_tone)(seed >> 2 & 1)};
    p->bytes = glint_image_bytes(f, WIDTH, HEIGHT);
    p->mem = malloc(p->bytes);
    glint_image_place(&p->image, p->mem);
    for (size_t i = 0; i < p->bytes; i++)
        p->mem[i] = (uint8_t)(f == GLINT_LINEAR_Q20 ? 0 : i * 7 + (i >> 8));
}

static void draw_random_picture(const struct glint_flare_config *cfg,
                                const struct ghost *list, int n, int backwards,
                                struct random_picture *p)
{
    struct glint_flare_config c = *cfg;
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = allocate_flare(&c, &mem);

    for (int i = 0; i < n; i++)
        add_ghost_to_flare(f, &list[backwards ? n - 1 - i : i]);
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &p->image);
    assert_int_equal(stats.dropped_bundles, 0);
    free(mem);
}

static unsigned choose_instruction_sets(void)
{
    return (unsigned)draw_random_number(8) & glint_system_sets();
}

/* Checks that a pixel never becomes darker while its light grows, from far
 * below a code to far above the range of 32-bit sums. */
TEST(more_light_never_darkens_a_pixel)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    int before = 0;

    for (int exponent = -12; exponent < 40; exponent++) {
        const struct ghost g = {
            16, 100, 75, 40, 0, 1, 0, exponent, {16384, 16384, 16384}};
        struct random_picture p;
        int code;

        make_random_picture(&p, GLINT_GREY, 0);
        memset(p.mem, 0, p.bytes);
        draw_random_picture(&c, &g, 1, 0, &p);
        code = p.mem[75 * WIDTH + 100];
        assert_true(code >= before);
        assert_true(exponent < 12 || code == 255);
        assert_int_equal(p.mem[75 * WIDTH + WIDTH - 1], 0);
        before = code;
        free(p.mem);
    }
}

/* Checks that many random scenes give bit-identical images for all tile sizes,
 * kernels, numbers of workers and orders of jobs. */
TEST(random_scenes_are_bit_identical)
{
    for (int k = 0; k < 240; k++) {
        const enum glint_pixel_format format =
            (enum glint_pixel_format)draw_random_number(GLINT_RGB565 + 1);
        const uint32_t seed = (uint32_t)draw_random_number(1 << 20) + 1;
        struct glint_flare_config c = make_octagonal_stop_config();
        struct random_picture plain, other;
        struct shuffle shuffle;
        struct ghost list[6];
        const int n = 1 + draw_random_number(6);

        for (int i = 0; i < n; i++) {
            list[i] = make_random_ghost();
            /* a ghost much larger than the image */
            if (draw_random_number(8) == 0)
                list[i].size <<= draw_random_number(14);
            /* scales the ghost's light by 2^-12 .. 2^7 */
            list[i].flux_exponent += draw_random_number(20) - 12;
        }
        c.stop.n_blades = k % 5 ? 8 : 0;
        c.irradiance_steps = draw_random_number(3) * 30;
        c.dither = draw_random_number(2);
        c.tile_log2 = 6;
        c.max_primitives = 400000;
        make_random_picture(&plain, format, seed);
        draw_random_picture(&c, list, n, 0, &plain);
        c.tile_log2 = 3 + draw_random_number(4);
        c.sets = choose_instruction_sets();
        init_shuffled_workers(&shuffle, 1 + draw_random_number(8), seed);
        c.workers = &shuffle.workers;
        make_random_picture(&other, format, seed);
        draw_random_picture(&c, list, n, draw_random_number(2), &other);
        if (memcmp(plain.mem, other.mem, plain.bytes) != 0)
            fail_msg("scene %d: format %d, tiles %d, sets %u, %d workers", k,
                     (int)format, c.tile_log2, c.sets, shuffle.workers.n);
        free(plain.mem);
        free(other.mem);
    }
}

TEST(image_does_not_depend_on_bundle_order)
{
    struct ghost turned[N_GHOSTS];

    for (int i = 0; i < N_GHOSTS; i++)
        turned[i] = ghosts[N_GHOSTS - 1 - i];
    draw_scene(make_octagonal_stop_config(), want);
    draw_ghost_list(make_octagonal_stop_config(), turned, N_GHOSTS, pixels);
    assert_memory_equal(pixels, want, sizeof pixels);
}

/* Checks that drawing onto an 8-bit image changes neither its padding nor
 * pixels that no ghost touches. */
TEST(untouched_pixels_are_unchanged)
{
    enum { STRIDE = WIDTH * 3 + 13 };
    static uint8_t bytes[STRIDE * HEIGHT], before[STRIDE * HEIGHT];
    struct glint_image image = {.format = GLINT_RGB24,
                                .width = WIDTH,
                                .height = HEIGHT,
                                .plane = {bytes},
                                .stride_bytes = {STRIDE}};
    struct glint_flare_config c = make_octagonal_stop_config();
    struct glint_flare_stats stats;
    int changed = 0;
    void *mem;
    struct glint_flare *f = allocate_flare(&c, &mem);

    for (int i = 0; i < STRIDE * HEIGHT; i++)
        before[i] = bytes[i] = (uint8_t)(i * 7 + i / 251);
    draw_ghost_list(c, ghosts, 1, want);
    add_ghost_to_flare(f, &ghosts[0]);
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &image);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < STRIDE; x++) {
            const int k = y * STRIDE + x;

            if (x >= WIDTH * 3 || want[y * WIDTH * 3 + x] == 0)
                assert_int_equal(bytes[k], before[k]);
            changed += bytes[k] != before[k];
        }
    assert_true(changed > 500);
    assert_true(glint_flare_tiles(f) < 26 * 19 / 2);
    free(mem);
}

/* Checks that drawing into NULL does the same work as drawing an image, except
 * for writing it, and does not change the next frame. */
TEST(drawing_into_null_does_all_work)
{
    static uint8_t bytes[2][3 * WIDTH * HEIGHT];
    struct glint_image image =
        glint_image_over(bytes[0], GLINT_RGB24, WIDTH, HEIGHT);

    struct glint_flare_config c = make_octagonal_stop_config();
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *const f = allocate_flare(&c, &mem);
    int tiles;

    for (int i = 0; i < 3; i++)
        add_ghost_to_flare(f, &ghosts[i]);
    glint_flare_bin(f, &stats);
    memset(bytes, 20, sizeof bytes);
    glint_flare_draw(f, &image);
    tiles = glint_flare_tiles(f);
    glint_flare_draw(f, NULL);
    assert_int_equal(glint_flare_tiles(f), tiles);
    glint_image_place(&image, bytes[1]);
    glint_flare_draw(f, &image);
    assert_memory_equal(bytes[0], bytes[1], sizeof bytes[0]);
    assert_true(tiles > 0 && bytes[0][0] == 20);
    free(mem);
}

/* ------------------------------------------------------------------ golden */

static void check_golden_hash(FILE *file, bool update, const char *name,
                              struct glint_flare_config c)
{
    char line[80], expected[80];
    uint64_t h;

    draw_scene(c, pixels);
    h = hash_bytes(HASH_START, pixels, sizeof pixels);
    snprintf(expected, sizeof expected, "%s %08lx%08lx\n", name,
             (unsigned long)(h >> 32), (unsigned long)(h & 0xffffffff));
    if (update) {
        fputs(expected, file);
        return;
    }
    assert_non_null(fgets(line, sizeof line, file));
    assert_string_equal(line, expected);
}

/* Checks that hashes equal the hashes of the golden file, on every CPU.
 * GLINT_GOLDEN_UPDATE=1 rewrites the file. */
TEST(hashes_match_the_golden_file)
{
    const bool update = getenv("GLINT_GOLDEN_UPDATE") != NULL;
    FILE *file = fopen("tests/golden/flare.txt", update ? "w" : "r");
    struct glint_flare_config c = make_octagonal_stop_config();

    assert_non_null(file);
    check_golden_hash(file, update, "edges", c);
    c.irradiance_steps = 35;
    check_golden_hash(file, update, "edges-stepped", c);
    c = make_octagonal_stop_config();
    c.stop.n_blades = 0;
    check_golden_hash(file, update, "edges-circle", c);
    fclose(file);
}
