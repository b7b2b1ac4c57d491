/* SPDX-License-Identifier: MIT
 *
 * Compares the light that an edge adds to each pixel with the area of the pixel
 * to the right of the edge, computed by hand. The area is rounded to 1/256
 * pixel for images of pixel codes, to 1/65536 for linear images.
 */
#include "support/rng.h"
#include "kernels/kernels.h"
#include "flare/edges/edge.h"
#include "support/test.h"

enum { LOG2 = 3, SIDE = 1 << LOG2, STRIDE = GLINT_EDGE_STRIDE(LOG2) };

static struct glint_edge_sums make_row_sums(int linear)
{
    static uint64_t wide[3 * SIDE * STRIDE];
    static uint32_t narrow[3 * SIDE * STRIDE];
    static int64_t carry[3 * SIDE];
    static uint64_t touched[3];

    memset(wide, 0, sizeof wide);
    memset(narrow, 0, sizeof narrow);
    memset(carry, 0, sizeof carry);
    memset(touched, 0, sizeof touched);
    return (struct glint_edge_sums){.tile = {0, 0, SIDE, SIDE},
                                    .tile_log2 = LOG2,
                                    .stride = STRIDE,
                                    .linear = linear,
                                    .wide = wide,
                                    .narrow = narrow,
                                    .carry = carry,
                                    .touched = touched};
}

/* Adds an edge from (X0, Y0) to (X1, Y1) with red light to its right. */
static void add_red_edge(struct glint_edge_sums *s, int x0_q8, int y0_q8,
                         int x1_q8, int y1_q8, int64_t light_q20)
{
    static const struct glint_bundle red = {.rgb_q14 = {1 << 14, 0, 0}};
    const int32_t a[2] = {x0_q8, y0_q8}, b[2] = {x1_q8, y1_q8}, first = 0;
    struct glint_edge edge;

    assert_int_equal(
        glint_edge_set_from_points(&edge, a, b, 0, glint_light_pack(light_q20)),
        1);
    edge.bundle = 0;
    glint_edges_add_to_sums(s, &edge, &red, &first, 1);
}

/* Returns the red light, Q16, of pixel X in row Y of an image of pixel codes.
 * Light of half of white adds 128 for each 1/256 of the pixel that it
 * covers. */
static int read_pixel_light(struct glint_edge_sums *s, int x, int y)
{
    uint16_t light_q16[STRIDE];

    glint_sums_read_code_row(s, 0, y, glint_choose_pixel_kernels(0), light_q16);
    return light_q16[x];
}

/* Checks that a vertical edge adds light to the area on its right. The edge
 * lies FROM_Q8 right of the pixel's left side and is HEIGHT_Q8 high. */
TEST(vertical_edge_lights_its_right)
{
    for (int from_q8 = 0; from_q8 < 256; from_q8 += 5)
        for (int height_q8 = 1; height_q8 <= 256; height_q8 += 3) {
            const int area_q16 = height_q8 * (256 - from_q8);
            struct glint_edge_sums s = make_row_sums(0);
            int32_t linear_q20[STRIDE];

            add_red_edge(&s, 3 * 256 + from_q8, 512, 3 * 256 + from_q8,
                         512 + height_q8, 1 << 19);
            assert_int_equal(read_pixel_light(&s, 3, 2),
                             (area_q16 + 128) / 256 * 128);
            s = make_row_sums(1);
            add_red_edge(&s, 3 * 256 + from_q8, 512, 3 * 256 + from_q8,
                         512 + height_q8, 1 << 19);
            glint_sums_read_linear_row(&s, 0, 2, linear_q20);
            assert_int_equal(linear_q20[2], 0);
            assert_int_equal(linear_q20[3], 8 * area_q16);
            assert_int_equal(linear_q20[4], 2048 * height_q8);
        }
}

/* Checks that an edge from the upper right corner of pixel 3 to the lower left
 * corner of pixel 2 adds light to a quarter of pixel 2 and to three quarters of
 * pixel 3. */
TEST(slanted_edge_lights_partial_pixels)
{
    struct glint_edge_sums s = make_row_sums(0);
    uint16_t light_q16[STRIDE];

    add_red_edge(&s, 4 * 256, 0, 2 * 256, 256, 1 << 19);
    glint_sums_read_code_row(&s, 0, 0, glint_choose_pixel_kernels(0),
                             light_q16);
    assert_int_equal(light_q16[1], 0);
    assert_int_equal(light_q16[2], 32768 / 4);
    assert_int_equal(light_q16[3], 32768 * 3 / 4);
    assert_int_equal(light_q16[4], 32768);
}

static int random_int_below(int n)
{
    static uint32_t seed = 1;

    return (int)((uint64_t)rng_bits32(&seed) * (uint32_t)n >> 32);
}

/* Checks that a random edge gives bit-identical light in one tile and in the
 * tile's two halves, which use different code. There must be no light left of
 * the edge, and that of its full height right of it. */
TEST(edge_gives_the_same_light_in_half_tiles)
{
    enum { FROM = 4 };

    for (int i = 0; i < 20000; i++) {
        const int wide = i % 2 ? 256 * (SIDE + 4) : 600;
        const int x0 = random_int_below(wide) - 512,
                  x1 = random_int_below(wide) - 512;
        const int y0 = random_int_below(256 * SIDE - 1), up = i / 2 % 2;
        const int high = 1 + random_int_below(i % 3 ? 256 * SIDE - y0 - 1 : 4);
        const int32_t left_q8 = x0 < x1 ? x0 : x1, right_q8 = x0 < x1 ? x1 : x0;
        int32_t all_q20[SIDE][STRIDE], part_q20[STRIDE];
        struct glint_edge_sums s = make_row_sums(1);

        add_red_edge(&s, up ? x1 : x0, y0, up ? x0 : x1, y0 + high, 1 << 18);
        for (int y = 0; y < SIDE; y++) {
            const int from = y0 > 256 * y ? y0 : 256 * y;
            const int end =
                y0 + high < 256 * (y + 1) ? y0 + high : 256 * (y + 1);

            glint_sums_read_linear_row(&s, 0, y, all_q20[y]);
            for (int x = 0; x < SIDE; x++) {
                const int most = end > from ? 1024 * (end - from) : 0;

                assert_in_range(all_q20[y][x], 0, most);
                if (256 * (x + 1) <= left_q8)
                    assert_int_equal(all_q20[y][x], 0);
                if (256 * x >= right_q8)
                    assert_int_equal(all_q20[y][x], most);
            }
        }
        s = make_row_sums(1);
        for (int part = 0; part < 2;
             /* The sums of the left half continue in the right half. */
             part++) {
            s.tile.x0 = part ? FROM : 0;
            s.tile.x1 = part ? SIDE : FROM;
            add_red_edge(&s, up ? x1 : x0, y0, up ? x0 : x1, y0 + high,
                         1 << 18);
            for (int y = 0; y < SIDE; y++) {
                glint_sums_read_linear_row(&s, 0, y, part_q20);
                assert_memory_equal(part_q20, all_q20[y] + s.tile.x0,
                                    FROM * sizeof *part_q20);
            }
        }
    }
}

/* Draws eight edges that each add LIGHT to their right. If BRIGHT is 1, also
 * draws two edges that cancel each other and need wide sums. */
static void draw_eight_edges(int fine, int64_t light_q20, int bright,
                             uint16_t light_q16[SIDE][STRIDE])
{
    static const struct glint_bundle red = {.rgb_q14 = {1 << 14, 0, 0}};
    const int64_t brightest_q20 = INT64_C(1000) << 20;
    struct glint_edge_sums s = make_row_sums(0);
    struct glint_edge edge[10];
    int32_t ref[10];

    for (int i = 0; i < 10; i++) {
        const int32_t a[2] = {40 * i, 100}, b[2] = {600 - 60 * i, 1900};
        const int32_t from[2] = {30, 0}, to[2] = {999, 2000};
        const int64_t pair_q20 = i == 8 ? brightest_q20 : -brightest_q20;

        ref[i] = i;
        glint_edge_set_from_points(
            &edge[i], i < 8 ? a : from, i < 8 ? b : to, 0,
            glint_light_pack(i < 8 ? light_q20 : pair_q20));
        edge[i].bundle = 0;
    }
    s.fine = fine;
    glint_edges_add_to_sums(&s, edge, &red, ref, bright ? 10 : 8);
    assert_true(!bright || !s.in_narrow);
    for (int y = 0; y < SIDE; y++)
        glint_sums_read_code_row(&s, 0, y, glint_choose_pixel_kernels(0),
                                 light_q16[y]);
}

/* Checks that the light is the same with narrow and wide sums, up to and above
 * the range of narrow sums. */
TEST(light_does_not_depend_on_sum_width)
{
    for (int fine = 0; fine < 2; fine++)
        for (int64_t light_q20 = 1; light_q20 < 1 << 26;
             light_q20 += 1 + light_q20 / 16) {
            uint16_t some[SIDE][STRIDE], all[SIDE][STRIDE];

            draw_eight_edges(fine, light_q20, 0, some);
            draw_eight_edges(fine, light_q20, 1, all);
            for (int y = 0; y < SIDE; y++)
                assert_memory_equal(some[y], all[y], SIDE * sizeof **some);
        }
}

/* Checks that packed light is exact to 25 bits, up to 2^40. */
TEST(packed_light_is_within_half_a_step)
{
    for (int bit = 0; bit < 40; bit++)
        for (int k = 0; k < 64; k++) {
            const int64_t light =
                (INT64_C(1) << bit) + (((INT64_C(1) << bit) - 1) * k / 63);
            const int64_t step = bit < 25 ? 1 : INT64_C(1) << (bit - 24);

            assert_true(llabs(glint_light_unpack_q20(glint_light_pack(light)) -
                              light) <= step / 2);
            assert_true(glint_light_unpack_q20(glint_light_pack(-light)) < 0);
        }
    assert_int_equal(glint_light_unpack_q20(glint_light_pack(0)), 0);
}
