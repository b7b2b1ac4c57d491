/* SPDX-License-Identifier: MIT
 *
 * Draws hand-made grids with the integer rasteriser and checks where light
 * falls and how much, also for clipped and folded ghosts.
 */
#include "support/ghosts.h"
#include "support/test.h"

/* ------------------------------------------------ total light and outlines */

/* Checks the total light of a ghost: an octagonal stop of radius 1 in a grid of
 * 2.5 x 2.5 stop radii. The stop has an area of 2 sqrt 2, the grid of 6.25. The
 * flux of the grid is 16 x 16 cells x 1.5e9 / 2^31 x 50000 / 65536. The energy
 * has a slope, which does not change the sum. */
TEST(ghost_has_the_light_that_passes_the_stop)
{
    const struct ghost g = {16, 100, 75, 40, 0, 1, 0, 0, {16384, 0, 0}};
    const double flux =
        256 * 1.5e9 / 2147483648.0 * 50000 / 65536 * 2.8284271 / 6.25;
    struct glint_flare_config c = make_octagonal_stop_config();

    /* The corners of the stop lie on the rim of the barrel aperture, so that
     * only the stop clips. */
    c.stop.apothem_q16 = 60547;
    draw_ghost_list(c, &g, 1, pixels);
    assert_true(sum_channel_light(pixels, 0) > 0.999 * flux);
    assert_true(sum_channel_light(pixels, 0) < 1.001 * flux);
    assert_true(sum_channel_light(pixels, 1) == 0 &&
                sum_channel_light(pixels, 2) == 0);
}

/* Checks that the light of a ghost only two pixels wide is preserved at several
 * positions, for straight and bent ghosts. */
TEST(focused_ghost_keeps_its_light)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    const double flux =
        256 * 1.5e9 / 2147483648.0 * 50000 / 65536 * 2.8284271 / 6.25;

    for (int k = 0; k < 32; k++) {
        const struct ghost g = {16, 50 + k / 2, 70,           1, 4 * k, 1,
                                0,  0,          {16384, 0, 0}};

        draw_ghost_list(c, &g, 1, pixels);
        assert_true(sum_channel_light(pixels, 0) > 0.999 * flux);
        assert_true(sum_channel_light(pixels, 0) < 1.001 * flux);
    }
}

static int32_t read_pixel_light(const int32_t *p, int x, int y)
{
    return p[3 * (y * WIDTH + x)];
}

/* Checks that away from its rim a flat ghost has an even irradiance: the flux
 * of a cell divided by the cell's area in pixels. */
TEST(flat_ghost_is_even_inside)
{
    struct ghost g = {16, 100, 75, 40, 0, 1, 0, 0, {16384, 0, 0}};
    const double cell = 2.5 * 40 / 16;
    const double irradiance = 1.5e9 / 2147483648.0 / (cell * cell);
    struct glint_flare_config c = make_octagonal_stop_config();

    draw_ghost_list(c, &g, 1, pixels);
    for (int y = 65; y < 85; y++) {
        /* Energy at the pixel: 50000 + sx / 8, sx = 65536 (x - 100) / 40. */
        for (int x = 90; x < 110; x++) {
            const double energy =
                (50000 + (x + 0.5 - 100) / 40 * 65536 / 8) / 65536;
            const double q20 = irradiance * energy * 1048576;

            assert_true(read_pixel_light(pixels, x, y) > 0.985 * q20 - 2 &&
                        read_pixel_light(pixels, x, y) < 1.015 * q20 + 2);
        }
    }
    assert_int_equal(read_pixel_light(pixels, 100, 2), 0);
}

/* Checks that outlines close exactly; a gap would light the rest of its row. */
TEST(outlines_close_without_streaks)
{
    for (int k = 0; k < 400; k++) {
        struct glint_flare_config c = make_octagonal_stop_config();
        const struct ghost g = make_random_ghost();

        c.stop.n_blades = k & 3 ? 8 : 0;
        c.stop.apothem_q16 -= draw_random_number(30000);
        c.irradiance_steps = draw_random_number(3) * 20;
        c.tile_log2 = 3 + draw_random_number(4);
        draw_ghost_list(c, &g, 1, pixels);
        for (int y = 0; y < HEIGHT; y++)
            for (int i = 0; i < 3; i++)
                assert_int_equal(pixels[3 * ((y + 1) * WIDTH - 1) + i], 0);
    }
}

/* Checks that the outline of a cell closes even if a corner is so far outside
 * the stop that the visible parts of its two sides are shorter than 1/256
 * pixel. */
TEST(outline_closes_around_a_far_corner)
{
    static const int32_t far_q16[] = {70000, 1 << 20, 700000000, 1000000000,
                                      0x3fffffff};
    const struct glint_image image = make_linear_image(pixels);
    const int32_t half = 759250125; /* sqrt(1/2) */

    for (size_t k = 0; k < sizeof far_q16 / sizeof *far_q16; k++) {
        struct glint_flare_config c = make_octagonal_stop_config();
        const struct glint_bundle b = {.n_cells = 1,
                                       .flux_q31 = 1 << 30,
                                       .flux_exponent = 10,
                                       .rgb_q14 = {16384, 16384, 16384}};
        struct glint_flare_stats stats;
        void *mem;
        struct glint_flare *f;
        struct glint_vertex *v;

        c.stop.n_blades = 4;
        c.stop.apothem_q16 = 46341;
        for (int i = 0; i < 4; i++) {
            c.stop.normal_q30[i][0] = i == 0 || i == 3 ? half : -half;
            c.stop.normal_q30[i][1] = i < 2 ? half : -half;
        }
        f = allocate_flare(&c, &mem);
        v = glint_flare_add(f, &b);
        for (int i = 0; i < 4; i++)
            v[i] = (struct glint_vertex){.x_q8 = i & 1 ? 7693 : 2573,
                                         .y_q8 = i & 2 ? 7757 : 2637,
                                         .energy_q16 = 65536};
        /* The stop position of this corner is just inside the outline of the
         * stop. */
        v[1].stop_x_q16 = v[2].stop_y_q16 = 65534;
        v[3].stop_x_q16 = v[3].stop_y_q16 = far_q16[k];
        memset(pixels, 0, sizeof pixels);
        glint_flare_bin(f, &stats);
        glint_flare_draw(f, &image);
        free(mem);
        assert_true(read_pixel_light(pixels, 12, 12) > 0);
        for (int y = 0; y < HEIGHT; y++)
            assert_int_equal(read_pixel_light(pixels, 60, y), 0);
    }
}

/* Checks that rounding the irradiance to steps changes the light of a cell by
 * at most half a step. */
TEST(irradiance_steps_change_little_light)
{
    static int32_t stepped[3 * WIDTH * HEIGHT];
    struct glint_flare_config c = make_octagonal_stop_config();
    const struct ghost g = {24, 100, 75, 55, 60, 1, 200, 4, {16384, 0, 0}};

    draw_ghost_list(c, &g, 1, pixels);
    c.irradiance_steps = 10;
    draw_ghost_list(c, &g, 1, stepped);
    assert_memory_not_equal(stepped, pixels, sizeof pixels);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_true(20 * llabs((long long)stepped[i] - pixels[i]) <=
                    pixels[i] + 20);
}

/* ---------------------------------------------------- comparison with rays */

/* Returns whether a ray of a cell passes STOP and the barrel aperture. The ray
 * is interpolated between the corners V with the bilinear weights WEIGHT. */
static bool ray_passes_stop(const struct glint_stop *stop,
                            const struct glint_vertex *v, const double *weight)
{
    double x = 0, y = 0, barrel = 0;

    for (int k = 0; k < 4; k++) {
        x += weight[k] * v[k].stop_x_q16;
        y += weight[k] * v[k].stop_y_q16;
        barrel += weight[k] * v[k].barrel_q16[0];
    }
    for (int k = 0; k < stop->n_blades; k++)
        if (x * stop->normal_q30[k][0] + y * stop->normal_q30[k][1] >
            0x1p30 * stop->apothem_q16)
            return false;
    return barrel <= 65536;
}

/* Draws the red ghost G into WANT by RAYS rays per cell, interpolated between
 * the cell's corners. Each ray adds light to the pixel that it hits. */
static void draw_ghost_by_rays(const struct ghost *g)
{
    enum { RAYS = 4096 };
    const struct glint_flare_config c = make_octagonal_stop_config();
    const double flux_q20 = ldexp(1.5e9 / RAYS / 65536, g->flux_exponent - 11);
    static double sum[HEIGHT * WIDTH];

    memset(sum, 0, sizeof sum);
    for (int cell = 0; cell < g->n * g->n; cell++) {
        const int i = cell % g->n, j = cell / g->n;
        const struct glint_vertex v[4] = {
            compute_ghost_vertex(g, i, j), compute_ghost_vertex(g, i + 1, j),
            compute_ghost_vertex(g, i, j + 1),
            compute_ghost_vertex(g, i + 1, j + 1)};

        for (int ray = 0; ray < RAYS; ray++) {
            const double a = fmod(ray * 0.6180339887, 1); /* golden ratio */
            const double b = (ray + 0.5) / RAYS;
            const double weight[4] = {(1 - a) * (1 - b), a * (1 - b),
                                      (1 - a) * b, a * b};
            double x = 0, y = 0, energy = 0;

            for (int k = 0; k < 4; k++) {
                x += weight[k] * v[k].x_q8 / 256;
                y += weight[k] * v[k].y_q8 / 256;
                energy += weight[k] * v[k].energy_q16;
            }
            if (x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT &&
                ray_passes_stop(&c.stop, v, weight))
                sum[(int)y * WIDTH + (int)x] += flux_q20 * energy;
        }
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        want[3 * i] = (int32_t)sum[i];
}

/* Checks that the image of G equals that of its rays except for at most the
 * fraction OFF of the light, and that the total light differs by at most 0.2
 * %. */
static void check_image_equals_rays(const struct ghost *g, double off)
{
    double sum = 0, all;

    draw_ghost_list(make_octagonal_stop_config(), g, 1, pixels);
    draw_ghost_by_rays(g);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i += 3)
        sum += abs(pixels[i] - want[i]) / 1048576.0;
    all = sum_channel_light(want, 0);
    assert_true(sum < off * all);
    assert_true(fabs(sum_channel_light(pixels, 0) - all) < 0.002 * all);
}

/* Checks ghosts that are bent, folded, and clipped by stop and barrel aperture,
 * with cells of 4.7 and of 2 pixels. */
TEST(ghosts_agree_with_traced_rays)
{
    const struct ghost large = {32, 100, 75, 60, 100, 1, 300, 6, {16384, 0, 0}};

    check_image_equals_rays(&large, 0.008);
    for (int k = 0; k < 16; k++) {
        const struct ghost small = {16, 100, 75, 9 + k % 4,    60 * k,
                                    1,  300, -2, {16384, 0, 0}};

        check_image_equals_rays(&small, 0.02);
    }
}

/* ------------------------------------------------ polygons computed by hand */

/* One cell of flux 64 and energy 1. Corners are listed around the cell; their
 * coordinates are in 1/256 pixel. */
struct quad {
    int32_t at[4][2];
    int32_t barrel_q16[4];
    int lost; /* bit k is set: the ray of corner k is invalid */
};

static struct glint_flare_stats draw_single_quad(const struct quad *q)
{
    /* indices of the corners row by row */
    static const int corner[4] = {0, 1, 3, 2};
    struct glint_flare_config c = make_octagonal_stop_config();
    const struct glint_image image = make_linear_image(pixels);
    const struct glint_bundle b = {.n_cells = 1,
                                   .flux_q31 = 1 << 30,
                                   .flux_exponent = 7,
                                   .rgb_q14 = {16384, 0, 0}};
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = allocate_flare(&c, &mem);
    struct glint_vertex *v = glint_flare_add(f, &b);

    for (int i = 0; i < 4; i++) {
        const int k = corner[i];

        v[i] =
            (struct glint_vertex){.x_q8 = q->at[k][0],
                                  .y_q8 = q->at[k][1],
                                  .barrel_q16 = {q->barrel_q16[k], 0},
                                  .energy_q16 = q->lost >> k & 1 ? -1 : 65536};
    }
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &image);
    free(mem);
    return stats;
}

static void assert_pixel_light(int x, int y, double light)
{
    const double got = read_pixel_light(pixels, x, y) / 1048576.0;

    if (got < light - 1e-4 || got > light + 1e-4)
        print_message("pixel %d,%d: %f, not %f\n", x, y, got, light);
    assert_true(got > light - 1e-4 && got < light + 1e-4);
}

static void assert_total_flux(double flux)
{
    assert_true(sum_channel_light(pixels, 0) > 0.999 * flux);
    assert_true(sum_channel_light(pixels, 0) < 1.001 * flux);
}

/* Checks that the rectangle from (10.25, 10.5) to (14.25, 12.5) distributes its
 * flux of 64 evenly over its area of eight pixels. */
TEST(rectangle_matches_hand_computation)
{
    struct quad q = {{{2624, 2688}, {3648, 2688}, {3648, 3200}, {2624, 3200}},
                     {0, 0, 0, 0},
                     0};

    draw_single_quad(&q);
    assert_pixel_light(9, 11, 0);
    assert_pixel_light(10, 10, 3);
    assert_pixel_light(11, 10, 4);
    assert_pixel_light(14, 10, 1);
    assert_pixel_light(15, 11, 0);
    assert_pixel_light(10, 11, 6);
    assert_pixel_light(13, 11, 8);
    assert_pixel_light(14, 12, 1);
    assert_pixel_light(12, 13, 0);
    /* The barrel's value rises from 0.5 on the left to 1.5 on the right. Above
     * 1 it blocks, so only the left half passes. */
    q.barrel_q16[0] = q.barrel_q16[3] = 32768;
    q.barrel_q16[1] = q.barrel_q16[2] = 98304;
    draw_single_quad(&q);
    assert_pixel_light(10, 11, 6);
    assert_pixel_light(11, 11, 8);
    assert_pixel_light(12, 11, 2);
    assert_pixel_light(13, 11, 0);
}

/* Checks that a cell with one invalid corner becomes a triangle with legs of
 * 8 pixels: area 32 and half of the flux, so each pixel has light 1. */
TEST(triangle_matches_hand_computation)
{
    const struct quad q = {
        {{2048, 2048}, {4096, 2048}, {9, 9}, {2048, 4096}}, {0, 0, 0, 0}, 4};

    assert_int_equal(draw_single_quad(&q).dropped_cells, 1);
    assert_pixel_light(8, 8, 1);
    assert_pixel_light(10, 12, 1);
    for (int x = 8; x < 16; x++) {
        assert_pixel_light(x, 23 - x, 0.5);
        assert_pixel_light(x, 24 - x, 0);
    }
    assert_total_flux(32);
}

/* Checks that slivers, folds, lines and points keep their light at any
 * position. */
TEST(thin_cells_keep_their_light)
{
    static const struct quad quads[] = {
        /* 1/256 px wide and 80 px long: vertical, horizontal, diagonal */
        {{{5000, 5000}, {5001, 5000}, {5001, 25480}, {5000, 25480}}, {0}, 0},
        {{{5000, 5000}, {25480, 5000}, {25480, 5001}, {5000, 5001}}, {0}, 0},
        {{{5000, 5000}, {5001, 5000}, {19001, 25480}, {19000, 25480}}, {0}, 0},
        /* zero area: a line, a line that runs back and forth, a point */
        {{{5000, 5000}, {9000, 7000}, {9000, 7000}, {5000, 5000}}, {0}, 0},
        {{{5000, 5000}, {9000, 5000}, {5000, 5000}, {9000, 5000}}, {0}, 0},
        {{{5120, 5120}, {5120, 5120}, {5120, 5120}, {5120, 5120}}, {0}, 0},
        /* self-intersecting: a bow tie; concave: a cell with a dent */
        {{{5000, 5000}, {9000, 5000}, {5000, 9000}, {9000, 9000}}, {0}, 0},
        {{{5000, 5000}, {9000, 5000}, {6000, 6000}, {5000, 9000}}, {0}, 0},
        /* tiny: 2/256 px wide and high */
        {{{5000, 5000}, {5002, 5000}, {5002, 5002}, {5000, 5002}}, {0}, 0},
    };

    for (size_t i = 0; i < sizeof quads / sizeof *quads; i++) {
        assert_int_equal(draw_single_quad(&quads[i]).dropped_cells, 0);
        assert_total_flux(64);
    }
    /* the barrel aperture passes half of a line */
    draw_single_quad(
        &(struct quad){{{5000, 5000}, {9000, 7000}, {9000, 7000}, {5000, 5000}},
                       {32768, 98304, 98304, 32768},
                       0});
    assert_total_flux(32);
}

/* Checks that eight times the flux gives an image eight times as bright, within
 * rounding. */
TEST(image_is_linear_in_flux)
{
    struct ghost g = ghosts[1];
    struct glint_flare_config c = make_octagonal_stop_config();

    draw_ghost_list(c, &g, 1, want);
    g.flux_exponent += 3;
    draw_ghost_list(c, &g, 1, pixels);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_true(abs(pixels[i] - 8 * want[i]) <= 24);
}

/* Checks that cells without area, invalid rays and light out of range cause
 * no error. */
TEST(invalid_bundles_cause_no_error)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    const struct glint_image image = make_linear_image(pixels);
    struct glint_bundle b = {.n_cells = 4,
                             .flux_q31 = INT32_MAX,
                             .flux_exponent = 900,
                             .rgb_q14 = {65536, -65536, 65536}};
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = allocate_flare(&c, &mem);
    struct glint_vertex *v = glint_flare_add(f, &b);

    for (int i = 0; i < 25; i++)
        v[i] = (struct glint_vertex){5000, 5000, 0, 0, {0, 0}, 65536};
    v = glint_flare_add(f, &b);
    for (int i = 0; i < 25; i++) {
        v[i] = compute_ghost_vertex(
            &(struct ghost){4, 50, 50, 9, 0, 1, 0, 0, {0}}, i % 5, i / 5);
        if (i % 3 == 0)
            v[i].energy_q16 = -1;
    }
    b.flux_exponent = -900;
    v = glint_flare_add(f, &b);
    for (int i = 0; i < 25; i++) {
        v[i] = (struct glint_vertex){
            0, 0, 1 << 30, -(1 << 30), {1 << 30, 1 << 29}, 1};
        v[i].x_q8 = (i % 5 - 2) * (GLINT_VERTEX_LIMIT_Q8 / 2 - 1);
        v[i].y_q8 = (i / 5 - 2) * (GLINT_VERTEX_LIMIT_Q8 / 2 - 1);
    }
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &image);
    assert_true(stats.dropped_cells >= 10);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_true(i % 3 == 1 ? pixels[i] <= 0 : pixels[i] >= 0);
    free(mem);
}
