/* SPDX-License-Identifier: MIT
 *
 * The integer rasteriser on grids made by hand: energy, clipping, folds,
 * independence of everything that must not matter, capacities, and goldens.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "glint/flare.h"
#include "glint/kernels.h"
#include "linux/sets.h"
#include "flare/state.h"
#include "posix/workers.h"
#include "support/shuffle.h"
#include "support/rng.h"

enum { WIDTH = 203, HEIGHT = 151 };

/* An octagon's sides, rounded to q30 by hand from cos and sin of 22.5 + 45 k
 * degrees: integers, so that goldens do not hang on a libm. */
static const int32_t octagon[8][2] = {
    {992008094, 410903207},  {410903207, 992008094},   {-410903207, 992008094},
    {-992008094, 410903207}, {-992008094, -410903207}, {-410903207, -992008094},
    {410903207, -992008094}, {992008094, -410903207}};

static struct glint_flare_config base_config(void)
{
    struct glint_flare_config c = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .tile_log2 = 3,
                                   .coarse_log2 = 7,
                                   .weights = GLINT_WEIGHTS_WACHSPRESS,
                                   .antialias = 1,
                                   .max_bundles = 64,
                                   .max_vertices = 60000,
                                   .max_primitives = 60000,
                                   .max_refs = 400000,
                                   .max_tile_refs = 400000};

    c.stop.n_blades = 8;
    c.stop.apothem_q16 = 60547; /* cos 22.5 degrees */
    memcpy(c.stop.normal_q30, octagon, sizeof octagon);
    return c;
}

/* A synthetic ghost: a grid over +-1.25 stop radii, scaled, sheared and bent.
 */
struct ghost {
    int n;
    int cx, cy;       /* pixels */
    int size;         /* pixels per stop radius */
    int bend;         /* quadratic term, per mille of size */
    int mirror;       /* -1: turned over */
    int barrel_shift; /* of the barrel against the stop, per mille of radius */
    int32_t flux_exponent;
    int32_t rgb_q14[3];
};

static struct glint_vertex ghost_vertex(const struct ghost *g, int i, int j)
{
    /* +-1.25 as q16, integers only */
    const int64_t sx = (int64_t)163840 * i / g->n - 81920;
    const int64_t sy = (int64_t)163840 * j / g->n - 81920;
    const int64_t bent = (sx * sx / 65536 + sx * sy / 131072) * g->bend / 1000;
    const int64_t bx = sx + 65536 * g->barrel_shift / 1000;
    const int64_t r2 = (bx * bx + sy * sy) / 65536;
    struct glint_vertex v = {0, 0, 0, 0, {0, 0}, 0};

    v.x_q8 = (int32_t)(g->cx * 256 + (sx + bent) * g->size * g->mirror / 256);
    v.y_q8 = (int32_t)(g->cy * 256 - (sy + sx / 5) * g->size / 256);
    v.stop_x_q16 = (int32_t)sx;
    v.stop_y_q16 = (int32_t)sy;
    v.barrel_q16[0] = (int32_t)((r2 + 65536) / 2);
    v.energy_q16 = (int32_t)(50000 + sx / 8);
    return v;
}

static void add_ghost(struct glint_flare *f, const struct ghost *g)
{
    struct glint_bundle b = {.n_cells = g->n,
                             .flux_q31 = 1500000000,
                             .flux_exponent = g->flux_exponent};
    struct glint_vertex *v;

    memcpy(b.rgb_q14, g->rgb_q14, sizeof b.rgb_q14);
    v = glint_flare_add(f, &b);
    if (!v)
        return;
    for (int j = 0; j <= g->n; j++)
        for (int i = 0; i <= g->n; i++)
            *v++ = ghost_vertex(g, i, j);
}

static const struct ghost ghosts[] = {
    {16, 60, 60, 40, 0, 1, 0, 0, {16384, 0, 0}},
    {16, 64, 62, 42, 50, 1, 300, 0, {0, 16384, 0}},
    {32, 128, 64, 200, 120, -1, 600, 2, {0, 0, 16384}},
    {8, 128, 128, 3, 0, 1, 0, -2, {16384, 8000, -2000}},
    {16, 190, 20, 60, 900, 1, 0, 0, {9000, 9000, 9000}}, /* folded */
    {16, -40, 160, 90, 0, -1, 0, 1, {3000, 16384, 200}}, /* partly outside */
};

enum { N_GHOSTS = sizeof ghosts / sizeof *ghosts };

static struct glint_flare *open_flare(struct glint_flare_config *c, void **mem)
{
    const size_t bytes = glint_flare_bytes(c);
    struct glint_flare *f;

    assert_int_not_equal(bytes, 0);
    assert_int_equal(posix_memalign(mem, 64, bytes), 0);
    memset(*mem, 0xa5, bytes); /* nothing may hang on what was there */
    assert_int_equal(glint_flare_init(&f, c, *mem, bytes), GLINT_OK);
    return f;
}

static struct glint_image linear_image(int32_t *pixels)
{
    struct glint_image image = {
        .format = GLINT_LINEAR_Q20, .width = WIDTH, .height = HEIGHT};

    memset(pixels, 0, sizeof(int32_t) * 3 * WIDTH * HEIGHT);
    glint_image_place(&image, pixels);
    return image;
}

static int32_t pixels[3 * WIDTH * HEIGHT], want[3 * WIDTH * HEIGHT];

static struct glint_flare_stats draw_list(struct glint_flare_config c,
                                          const struct ghost *list, int n,
                                          int32_t *out)
{
    const struct glint_image image = linear_image(out);
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = open_flare(&c, &mem);

    for (int i = 0; i < n; i++)
        add_ghost(f, &list[i]);
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &image);
    free(mem);
    return stats;
}

static struct glint_flare_stats draw_scene(struct glint_flare_config c,
                                           int32_t *out)
{
    return draw_list(c, ghosts, N_GHOSTS, out);
}

static double total(const int32_t *p, int channel)
{
    double sum = 0;

    for (int i = channel; i < 3 * WIDTH * HEIGHT; i += 3)
        sum += p[i] / 1048576.0;
    return sum;
}

/* --------------------------------------------------------------------- light
 */

/* The octagon of radius 1 in a grid of 2.5 x 2.5 radii: area 2 sqrt 2 of 6.25,
 * flux 16 x 16 cells x 1.5e9 / 2^31 x 50000 / 65536 (energy is odd about 0). */
static void test_energy(void **state)
{
    const struct ghost g = {16, 100, 75, 40, 0, 1, 0, 0, {16384, 0, 0}};
    const double flux =
        256 * 1.5e9 / 2147483648.0 * 50000 / 65536 * 2.8284271 / 6.25;
    struct glint_flare_config c = base_config();

    (void)state;
    /* the barrel is as wide as the stop's corners: cut it out of the way */
    c.stop.apothem_q16 = 60547;
    for (int raster = 0; raster < 2; raster++) {
        const double off = raster == 0 ? 0.001 : 0.005;

        c.raster = raster ? &glint_raster_cells : &glint_raster_edges;
        draw_list(c, &g, 1, pixels);
        assert_true(total(pixels, 0) > (1 - off) * flux);
        assert_true(total(pixels, 0) < (1 + off) * flux);
        assert_true(total(pixels, 1) == 0 && total(pixels, 2) == 0);
    }
}

/* Twice as large, mirrored, other weights, merged or not: the same light. */
static void test_energy_is_kept(void **state)
{
    struct ghost g = {16, 100, 75, 25, 0, 1, 0, 0, {16384, 0, 0}};
    struct glint_flare_config c = base_config();
    double first;

    (void)state;
    c.raster = &glint_raster_cells;
    draw_list(c, &g, 1, pixels);
    first = total(pixels, 0);
    g.size = 50;
    g.mirror = -1;
    draw_list(c, &g, 1, pixels);
    assert_true(total(pixels, 0) > 0.998 * first &&
                total(pixels, 0) < 1.002 * first);
    c.weights = GLINT_WEIGHTS_LOOP_DEROSE;
    c.merge_steps = 4;
    c.merge_gamma_q16 = 66;
    assert_true(draw_list(c, &g, 1, pixels).merged_cells > 60);
    assert_true(total(pixels, 0) > 0.998 * first &&
                total(pixels, 0) < 1.002 * first);
}

/* A ghost smaller than a pixel, anywhere in it: its light still arrives. */
static void test_focused_light_arrives(void **state)
{
    struct glint_flare_config c = base_config();
    const double flux =
        256 * 1.5e9 / 2147483648.0 * 50000 / 65536 * 2.8284271 / 6.25;

    (void)state;
    for (int k = 0; k < 32; k++) {
        const struct ghost g = {16, 50 + k / 2, 70,           1, 4 * k, 1,
                                0,  0,          {16384, 0, 0}};
        const double off = k & 1 ? 0.1 : 0.001;

        c.raster = k & 1 ? &glint_raster_cells : &glint_raster_edges;
        draw_list(c, &g, 1, pixels);
        assert_true(total(pixels, 0) > (1 - off) * flux);
        assert_true(total(pixels, 0) < (1 + off) * flux);
    }
}

static int32_t at(const int32_t *p, int x, int y)
{
    return p[3 * (y * WIDTH + x)];
}

/* A flat ghost is flat inside: every pixel away from the rim has the same
 * irradiance, flux per cell over its area in pixels. */
static void test_flat_inside(void **state)
{
    struct ghost g = {16, 100, 75, 40, 0, 1, 0, 0, {16384, 0, 0}};
    const double cell = 2.5 * 40 / 16;
    const double irradiance = 1.5e9 / 2147483648.0 / (cell * cell);
    struct glint_flare_config c = base_config();

    (void)state;
    c.raster = &glint_raster_cells;
    draw_list(c, &g, 1, pixels);
    for (int y = 65; y < 85; y++) {
        /* energy at the pixel: 50000 + sx / 8, sx = 65536 (x - 100) / 40 */
        for (int x = 90; x < 110; x++) {
            const double energy =
                (50000 + (x + 0.5 - 100) / 40 * 65536 / 8) / 65536;
            const double q20 = irradiance * energy * 1048576;

            assert_true(at(pixels, x, y) > 0.997 * q20 - 2 &&
                        at(pixels, x, y) < 1.003 * q20 + 2);
        }
    }
    assert_int_equal(at(pixels, 100, 2), 0);
}

/* By edges a cell is even: the energy is that of its middle, at most half a
 * cell away. */
static void test_edges_agree_with_cells(void **state)
{
    const struct ghost g = {32, 100, 75, 60, 100, 1, 300, 6, {16384, 0, 0}};
    struct glint_flare_config c = base_config();
    double off = 0, all = 0;

    (void)state;
    draw_list(c, &g, 1, pixels);
    c.raster = &glint_raster_cells;
    draw_list(c, &g, 1, want);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        off += abs(pixels[i] - want[i]);
        all += want[i];
    }
    assert_true(off < 0.006 * all);
    assert_true(total(pixels, 0) > 0.999 * total(want, 0));
    assert_true(total(pixels, 0) < 1.001 * total(want, 0));
}

/* Cells of two pixels, folded, cut by stop and barrel: sampled by cells. */
static void test_small_cells_agree(void **state)
{
    struct glint_flare_config c = base_config();
    double off = 0, all = 0;

    (void)state;
    for (int k = 0; k < 16; k++) {
        const struct ghost g = {16, 100, 75, 9 + k % 4,    60 * k,
                                1,  300, -2, {16384, 0, 0}};

        c.raster = &glint_raster_edges;
        draw_list(c, &g, 1, pixels);
        c.raster = &glint_raster_cells;
        draw_list(c, &g, 1, want);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
            off += abs(pixels[i] - want[i]);
            all += want[i];
        }
    }
    assert_true(off < 0.083 * all); /* pixel centres alone: 0.0896 */
}

static int draw_number(int n)
{
    static uint32_t seed = 7;

    return rng_below(&seed, n);
}

static struct ghost random_ghost(void)
{
    const int size = 3 + draw_number(40);

    return (struct ghost){
        4 + draw_number(29),
        draw_number(WIDTH - 60) - 20,
        draw_number(HEIGHT),
        size,
        draw_number(1500) - 750, /* some are folded */
        draw_number(2) ? 1 : -1,
        draw_number(2000) - 1000,
        draw_number(4),
        {16384 - draw_number(20000), draw_number(16384), 16384}};
}

/* An outline that does not close to the last bit would leave a streak to the
 * right end of its rows. */
static void test_outlines_close(void **state)
{
    (void)state;
    for (int k = 0; k < 400; k++) {
        struct glint_flare_config c = base_config();
        const struct ghost g = random_ghost();

        c.stop.n_blades = k & 3 ? 8 : 0;
        c.stop.apothem_q16 -= draw_number(30000);
        c.irradiance_steps = draw_number(3) * 20;
        c.tile_log2 = 3 + draw_number(4);
        draw_list(c, &g, 1, pixels);
        for (int y = 0; y < HEIGHT; y++)
            for (int i = 0; i < 3; i++)
                assert_int_equal(pixels[3 * ((y + 1) * WIDTH - 1) + i], 0);
    }
}

/* A corner so far outside of the stop that the sides to it have no part worth a
 * step: the cell still closes. */
static void test_far_corner_closes(void **state)
{
    static const int32_t far_q16[] = {70000, 1 << 20, 700000000, 1000000000,
                                      0x3fffffff};
    const struct glint_image image = linear_image(pixels);
    const int32_t half = 759250125; /* root of 1/2 */

    (void)state;
    for (size_t k = 0; k < sizeof far_q16 / sizeof *far_q16; k++) {
        struct glint_flare_config c = base_config();
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
        f = open_flare(&c, &mem);
        v = glint_flare_add(f, &b);
        for (int i = 0; i < 4; i++)
            v[i] = (struct glint_vertex){.x_q8 = i & 1 ? 7693 : 2573,
                                         .y_q8 = i & 2 ? 7757 : 2637,
                                         .energy_q16 = 65536};
        v[1].stop_x_q16 = v[2].stop_y_q16 = 65534; /* just inside */
        v[3].stop_x_q16 = v[3].stop_y_q16 = far_q16[k];
        memset(pixels, 0, sizeof pixels);
        glint_flare_bin(f, &stats);
        glint_flare_draw(f, &image);
        free(mem);
        assert_true(at(pixels, 12, 12) > 0);
        for (int y = 0; y < HEIGHT; y++)
            assert_int_equal(at(pixels, 60, y), 0);
    }
}

/* Steps change the light of a cell by half of one at most. */
static void test_steps(void **state)
{
    static int32_t stepped[3 * WIDTH * HEIGHT];
    struct glint_flare_config c = base_config();
    const struct ghost g = {24, 100, 75, 55, 60, 1, 200, 4, {16384, 0, 0}};

    (void)state;
    draw_list(c, &g, 1, pixels);
    c.irradiance_steps = 10;
    draw_list(c, &g, 1, stepped);
    assert_memory_not_equal(stepped, pixels, sizeof pixels);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_true(20 * llabs((long long)stepped[i] - pixels[i]) <=
                    pixels[i] + 20);
}

/* ------------------------------------------------------- polygons by hand */

/* One cell of flux 64 and energy 1, corners in order round it, in 1/256 px. */
struct quad {
    int32_t at[4][2];
    int32_t barrel_q16[4];
    int lost; /* bits of corners that were lost */
};

static struct glint_flare_stats draw_quad(const struct quad *q)
{
    static const int corner[4] = {0, 1, 3, 2}; /* the grid goes row by row */
    struct glint_flare_config c = base_config();
    const struct glint_image image = linear_image(pixels);
    const struct glint_bundle b = {.n_cells = 1,
                                   .flux_q31 = 1 << 30,
                                   .flux_exponent = 7,
                                   .rgb_q14 = {16384, 0, 0}};
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = open_flare(&c, &mem);
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

static void assert_light(int x, int y, double light)
{
    const double got = at(pixels, x, y) / 1048576.0;

    if (got < light - 1e-4 || got > light + 1e-4)
        print_message("pixel %d,%d: %f, not %f\n", x, y, got, light);
    assert_true(got > light - 1e-4 && got < light + 1e-4);
}

static void assert_flux(double flux)
{
    assert_true(total(pixels, 0) > 0.999 * flux);
    assert_true(total(pixels, 0) < 1.001 * flux);
}

/* 10.25 .. 14.25 by 10.5 .. 12.5: eight pixels of area, 8 of light each. */
static void test_rectangle_by_hand(void **state)
{
    struct quad q = {{{2624, 2688}, {3648, 2688}, {3648, 3200}, {2624, 3200}},
                     {0, 0, 0, 0},
                     0};

    (void)state;
    draw_quad(&q);
    assert_light(9, 11, 0);
    assert_light(10, 10, 3);
    assert_light(11, 10, 4);
    assert_light(14, 10, 1);
    assert_light(15, 11, 0);
    assert_light(10, 11, 6);
    assert_light(13, 11, 8);
    assert_light(14, 12, 1);
    assert_light(12, 13, 0);
    /* a barrel from 0.5 on the left to 1.5 on the right leaves half */
    q.barrel_q16[0] = q.barrel_q16[3] = 32768;
    q.barrel_q16[1] = q.barrel_q16[2] = 98304;
    draw_quad(&q);
    assert_light(10, 11, 6);
    assert_light(11, 11, 8);
    assert_light(12, 11, 2);
    assert_light(13, 11, 0);
}

/* A triangle of legs 8: area 32 and half of the flux, so that all is 1. */
static void test_triangle_by_hand(void **state)
{
    const struct quad q = {
        {{2048, 2048}, {4096, 2048}, {9, 9}, {2048, 4096}}, {0, 0, 0, 0}, 4};

    (void)state;
    assert_int_equal(draw_quad(&q).dropped_cells, 1);
    assert_light(8, 8, 1);
    assert_light(10, 12, 1);
    for (int x = 8; x < 16; x++) {
        assert_light(x, 23 - x, 0.5);
        assert_light(x, 24 - x, 0);
    }
    assert_flux(32);
}

/* Slivers, folds, lines and points keep their light, wherever they lie. */
static void test_thin_light_arrives(void **state)
{
    static const struct quad quads[] = {
        /* a step wide, 80 px long: upright, lying, aslant */
        {{{5000, 5000}, {5001, 5000}, {5001, 25480}, {5000, 25480}}, {0}, 0},
        {{{5000, 5000}, {25480, 5000}, {25480, 5001}, {5000, 5001}}, {0}, 0},
        {{{5000, 5000}, {5001, 5000}, {19001, 25480}, {19000, 25480}}, {0}, 0},
        /* no area at all: a line, a line there and back, a point */
        {{{5000, 5000}, {9000, 7000}, {9000, 7000}, {5000, 5000}}, {0}, 0},
        {{{5000, 5000}, {9000, 5000}, {5000, 5000}, {9000, 5000}}, {0}, 0},
        {{{5120, 5120}, {5120, 5120}, {5120, 5120}, {5120, 5120}}, {0}, 0},
        /* turned over: a bow tie, one with a dent */
        {{{5000, 5000}, {9000, 5000}, {5000, 9000}, {9000, 9000}}, {0}, 0},
        {{{5000, 5000}, {9000, 5000}, {6000, 6000}, {5000, 9000}}, {0}, 0},
        /* two steps wide, tiny */
        {{{5000, 5000}, {5002, 5000}, {5002, 5002}, {5000, 5002}}, {0}, 0},
    };

    (void)state;
    for (size_t i = 0; i < sizeof quads / sizeof *quads; i++) {
        assert_int_equal(draw_quad(&quads[i]).dropped_cells, 0);
        assert_flux(64);
    }
    /* half of a line, cut by a barrel */
    draw_quad(
        &(struct quad){{{5000, 5000}, {9000, 7000}, {9000, 7000}, {5000, 5000}},
                       {32768, 98304, 98304, 32768},
                       0});
    assert_flux(32);
}

/* Light is linear: twice the flux is twice the picture, within rounding. */
static void test_linear_in_light(void **state)
{
    struct ghost g = ghosts[1];
    struct glint_flare_config c = base_config();

    (void)state;
    draw_list(c, &g, 1, want);
    g.flux_exponent += 3;
    draw_list(c, &g, 1, pixels);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_true(abs(pixels[i] - 8 * want[i]) <= 24);
}

/* A cell without area, rays that were lost, and light beyond all bounds. */
static void test_hostile_bundles(void **state)
{
    struct glint_flare_config c = base_config();
    const struct glint_image image = linear_image(pixels);
    struct glint_bundle b = {.n_cells = 4,
                             .flux_q31 = INT32_MAX,
                             .flux_exponent = 900,
                             .rgb_q14 = {65536, -65536, 65536}};
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = open_flare(&c, &mem);
    struct glint_vertex *v = glint_flare_add(f, &b);

    (void)state;
    for (int i = 0; i < 25; i++)
        v[i] = (struct glint_vertex){5000, 5000, 0, 0, {0, 0}, 65536};
    v = glint_flare_add(f, &b);
    for (int i = 0; i < 25; i++) {
        v[i] = ghost_vertex(&(struct ghost){4, 50, 50, 9, 0, 1, 0, 0, {0}},
                            i % 5, i / 5);
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

/* ------------------------------------------------------ what must not matter
 */

static void same_as_want(struct glint_flare_config c)
{
    draw_scene(c, pixels);
    assert_memory_equal(pixels, want, sizeof pixels);
}

static void test_tiles_do_not_matter(void **state)
{
    static const int levels[][2] = {{3, 0}, {4, 0}, {5, 0}, {3, 6},
                                    {3, 7}, {4, 7}, {5, 8}, {5, 6},
                                    {6, 0}, {6, 8}, {3, 4}};

    struct glint_flare_config c = base_config();

    (void)state;
    for (int raster = 0; raster < 2; raster++) {
        c.raster = raster ? &glint_raster_cells : &glint_raster_edges;
        draw_scene(c, want);
        assert_true(total(want, 0) > 1);
        for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
            c.tile_log2 = levels[i][0];
            c.coarse_log2 = levels[i][1];
            same_as_want(c);
        }
    }
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    for (int n = 0; n < 16; n++) {
        struct glint_flare_config c = base_config();

        c.raster = n / 8 ? &glint_raster_cells : NULL;
        draw_scene(c, want);
        assert_int_equal(glint_pool_create(&c.workers, n % 8 + 1), GLINT_OK);
        same_as_want(c);
        c.coarse_log2 = 0;
        same_as_want(c);
        glint_pool_destroy(c.workers);
    }
}

static void test_order_does_not_matter(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 16; seed++) {
        struct glint_flare_config c = base_config();
        struct shuffle shuffle;

        c.raster = seed > 8 ? &glint_raster_cells : NULL;
        draw_scene(c, want);
        shuffle_init(&shuffle, 5, seed);
        c.workers = &shuffle.workers;
        c.coarse_log2 = seed & 1 ? 7 : 0;
        same_as_want(c);
    }
}

/* A picture of any format, on which a scene of a few random ghosts is drawn. */
struct random_picture {
    struct glint_image image;
    uint8_t *mem;
    size_t bytes;
};

static void make_picture(struct random_picture *p, enum glint_pixel_format f,
                         uint32_t seed)
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

static void draw_picture(const struct glint_flare_config *cfg,
                         const struct ghost *list, int n, int backwards,
                         struct random_picture *p)
{
    struct glint_flare_config c = *cfg;
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = open_flare(&c, &mem);

    for (int i = 0; i < n; i++)
        add_ghost(f, &list[backwards ? n - 1 - i : i]);
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &p->image);
    assert_int_equal(stats.dropped_bundles, 0);
    free(mem);
}

static unsigned random_sets(void)
{
    return (unsigned)draw_number(8) & glint_system_sets();
}

/* From far below a code to far above what 32-bit sums hold: never darker. */
static void test_bright_stays_bright(void **state)
{
    struct glint_flare_config c = base_config();
    int before = 0;

    (void)state;
    for (int exponent = -12; exponent < 40; exponent++) {
        const struct ghost g = {
            16, 100, 75, 40, 0, 1, 0, exponent, {16384, 16384, 16384}};
        struct random_picture p;
        int code;

        make_picture(&p, GLINT_GREY, 0);
        memset(p.mem, 0, p.bytes);
        draw_picture(&c, &g, 1, 0, &p);
        code = p.mem[75 * WIDTH + 100];
        assert_true(code >= before);
        assert_true(exponent < 12 || code == 255);
        assert_int_equal(p.mem[75 * WIDTH + WIDTH - 1], 0);
        before = code;
        free(p.mem);
    }
}

/* The promise: the same bytes whatever does not matter, over many scenes. */
static void test_random_scenes(void **state)
{
    (void)state;
    for (int k = 0; k < 240; k++) {
        const enum glint_pixel_format format =
            (enum glint_pixel_format)draw_number(GLINT_RGB565 + 1);
        const uint32_t seed = (uint32_t)draw_number(1 << 20) + 1;
        struct glint_flare_config c = base_config();
        struct random_picture plain, other;
        struct shuffle shuffle;
        struct ghost list[6];
        const int n = 1 + draw_number(6);

        for (int i = 0; i < n; i++) {
            list[i] = random_ghost();
            if (draw_number(8) == 0) /* far beyond the picture */
                list[i].size <<= draw_number(14);
            list[i].flux_exponent +=
                draw_number(20) - 12; /* to and fro white */
        }
        c.raster = k % 4 ? &glint_raster_edges : &glint_raster_cells;
        c.stop.n_blades = k % 5 ? 8 : 0;
        c.irradiance_steps = draw_number(3) * 30;
        c.dither = draw_number(2);
        c.tile_log2 = 6;
        c.max_primitives = 400000;
        make_picture(&plain, format, seed);
        draw_picture(&c, list, n, 0, &plain);
        c.tile_log2 = 3 + draw_number(4);
        c.coarse_log2 = draw_number(2) ? 7 : 0;
        c.sets = random_sets();
        shuffle_init(&shuffle, 1 + draw_number(8), seed);
        c.workers = &shuffle.workers;
        make_picture(&other, format, seed);
        draw_picture(&c, list, n, draw_number(2), &other);
        if (memcmp(plain.mem, other.mem, plain.bytes) != 0)
            fail_msg("scene %d: format %d, tiles %d, sets %u, %d workers", k,
                     (int)format, c.tile_log2, c.sets, shuffle.workers.n);
        free(plain.mem);
        free(other.mem);
    }
}

static void test_bundle_order_does_not_matter(void **state)
{
    struct ghost turned[N_GHOSTS];

    (void)state;
    for (int i = 0; i < N_GHOSTS; i++)
        turned[i] = ghosts[N_GHOSTS - 1 - i];
    for (int raster = 0; raster < 2; raster++) {
        struct glint_flare_config c = base_config();

        c.raster = raster ? &glint_raster_cells : &glint_raster_edges;
        draw_scene(c, want);
        draw_list(c, turned, N_GHOSTS, pixels);
        assert_memory_equal(pixels, want, sizeof pixels);
    }
}

/* In place on 8 bits: what no ghost touches keeps its bytes, and padding too.
 */
static void test_untouched_stays(void **state)
{
    enum { STRIDE = WIDTH * 3 + 13 };
    static uint8_t bytes[STRIDE * HEIGHT], before[STRIDE * HEIGHT];
    struct glint_image image = {.format = GLINT_RGB24,
                                .width = WIDTH,
                                .height = HEIGHT,
                                .plane = {bytes},
                                .stride_bytes = {STRIDE}};
    struct glint_flare_config c = base_config();
    struct glint_flare_stats stats;
    int changed = 0;
    void *mem;
    struct glint_flare *f = open_flare(&c, &mem);

    (void)state;
    for (int i = 0; i < STRIDE * HEIGHT; i++)
        before[i] = bytes[i] = (uint8_t)(i * 7 + i / 251);
    draw_list(c, ghosts, 1, want);
    add_ghost(f, &ghosts[0]);
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

/* Drawing into nothing does all but touch a picture, and leaves no trace. */
static void test_into_nothing(void **state)
{
    static uint8_t bytes[2][3 * WIDTH * HEIGHT];
    struct glint_image image = {
        .format = GLINT_RGB24, .width = WIDTH, .height = HEIGHT};

    (void)state;
    for (int raster = 0; raster < 2; raster++) {
        struct glint_flare_config c = base_config();
        struct glint_flare_stats stats;
        struct glint_flare *f;
        int tiles;
        void *mem;

        c.raster = raster ? &glint_raster_cells : &glint_raster_edges;
        f = open_flare(&c, &mem);
        for (int i = 0; i < 3; i++)
            add_ghost(f, &ghosts[i]);
        glint_flare_bin(f, &stats);
        memset(bytes, 20, sizeof bytes);
        glint_image_place(&image, bytes[0]);
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
}

/* ------------------------------------------------------------------ capacity
 */

/* Exactly what bin asked for is enough, and one byte less is refused. */
static void test_exact_capacity(void **state)
{
    struct glint_flare_config c = base_config();
    struct glint_flare_stats s = draw_scene(c, want);
    struct glint_flare *f;
    void *mem;
    size_t bytes;

    (void)state;
    assert_int_equal(s.dropped_bundles, 0);
    c.max_bundles = s.need_bundles;
    c.max_vertices = s.need_vertices;
    c.max_primitives = s.need_primitives;
    c.max_refs = s.need_refs;
    c.max_tile_refs = s.need_tile_refs;
    same_as_want(c);
    bytes = glint_flare_bytes(&c);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_int_equal(glint_flare_init(&f, &c, mem, bytes - 1), GLINT_E_MEMORY);
    assert_int_equal(glint_flare_init(&f, &c, mem, bytes), GLINT_OK);
    free(mem);
}

/* One less of anything: whole bundles go, counted, and the rest is right. */
static void check_capacity(const struct glint_raster *raster)
{
    struct glint_flare_config full = base_config();
    struct glint_flare_stats s, less;

    full.raster = raster;
    s = draw_scene(full, pixels);
    draw_list(full, ghosts, N_GHOSTS - 1, want);
    for (int k = 0; k < 4; k++) {
        struct glint_flare_config c = full;

        c.max_bundles = k == 0 ? s.need_bundles - 1 : c.max_bundles;
        c.max_vertices = k == 1 ? s.need_vertices - 1 : c.max_vertices;
        c.max_primitives = k == 2 ? s.need_primitives - 1 : c.max_primitives;
        c.max_refs = k == 3 ? s.need_refs - 1 : c.max_refs;
        less = draw_scene(c, pixels);
        assert_int_equal(less.dropped_bundles, 1);
        assert_memory_equal(pixels, want, sizeof pixels);
    }
    full.max_refs = 0;
    less = draw_scene(full, pixels);
    assert_int_equal(less.bundles, 0);
    assert_int_equal(less.need_refs, s.need_refs);
    full.max_primitives = 0;
    less = draw_scene(full, pixels);
    assert_int_equal(less.bundles, 0);
    assert_int_equal(less.need_primitives, s.need_primitives);
    /* what finds no room is told all the same, however little there is */
    for (int k = 0; k < 8; k++) {
        full.max_primitives = (int)((int64_t)s.need_primitives * k / 8);
        full.max_refs = k % 2 ? s.need_refs / 3 : s.need_refs;
        less = draw_scene(full, pixels);
        assert_true(less.bundles < s.bundles);
        assert_int_equal(less.need_primitives, s.need_primitives);
        assert_int_equal(less.need_refs, s.need_refs);
        assert_int_equal(less.need_tile_refs, s.need_tile_refs);
    }
}

static void test_too_little_capacity(void **state)
{
    (void)state;
    check_capacity(&glint_raster_edges);
    check_capacity(&glint_raster_cells);
}

static void test_config_is_checked(void **state)
{
    static const int16_t mask_q13[4] = {0};
    struct glint_flare_config c = base_config();

    (void)state;
    assert_int_not_equal(glint_flare_bytes(&c), 0);
    c.tile_log2 = 7;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c = base_config();
    c.stop.mask_q13 = mask_q13; /* by cells alone */
    c.stop.mask_nodes = 2;
    c.stop.mask_span_q16 = 1 << 16;
    c.raster = &glint_raster_edges;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c.raster = &glint_raster_cells;
    assert_int_not_equal(glint_flare_bytes(&c), 0);
    c = base_config();
    c.coarse_log2 = 3;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c = base_config();
    c.width = GLINT_MAX_SIDE + 1;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c = base_config();
    c.stop.n_blades = 2;
    assert_int_equal(glint_flare_bytes(&c), 0);
}

/* -------------------------------------------------------------------- golden
 */

static uint64_t hash(const void *data, size_t bytes)
{
    const uint8_t *p = data;
    uint64_t h = UINT64_C(14695981039346656037); /* FNV-1a */

    for (size_t i = 0; i < bytes; i++)
        h = (h ^ p[i]) * UINT64_C(1099511628211);
    return h;
}

static void golden_case(FILE *file, bool update, const char *name,
                        struct glint_flare_config c)
{
    char line[80], expected[80];
    uint64_t h;

    draw_scene(c, pixels);
    h = hash(pixels, sizeof pixels);
    snprintf(expected, sizeof expected, "%s %08lx%08lx\n", name,
             (unsigned long)(h >> 32), (unsigned long)(h & 0xffffffff));
    if (update) {
        fputs(expected, file);
        return;
    }
    assert_non_null(fgets(line, sizeof line, file));
    assert_string_equal(line, expected);
}

/* The same bits on every CPU; GLINT_GOLDEN_UPDATE=1 writes them anew. */
static void test_golden(void **state)
{
    const bool update = getenv("GLINT_GOLDEN_UPDATE") != NULL;
    FILE *file = fopen("tests/golden/flare.txt", update ? "w" : "r");
    struct glint_flare_config c = base_config();

    (void)state;
    assert_non_null(file);
    golden_case(file, update, "edges", c);
    c.irradiance_steps = 35;
    golden_case(file, update, "edges-stepped", c);
    c = base_config();
    c.stop.n_blades = 0;
    golden_case(file, update, "edges-circle", c);
    c = base_config();
    c.raster = &glint_raster_cells;
    golden_case(file, update, "wachspress", c);
    c.weights = GLINT_WEIGHTS_LOOP_DEROSE;
    golden_case(file, update, "loop-derose", c);
    c.antialias = 0;
    golden_case(file, update, "pixel-centre", c);
    c = base_config();
    c.raster = &glint_raster_cells;
    c.merge_steps = 4;
    c.merge_gamma_q16 = 6554;
    golden_case(file, update, "merged", c);
    c = base_config();
    c.raster = &glint_raster_cells;
    c.stop.n_blades = 0;
    golden_case(file, update, "circle", c);
    fclose(file);
}

/* By way of bins that count a thousand million cells for each bundle. */
static void count_many(struct glint_flare *f)
{
    f->n_drawn = f->n_bundles;
    for (int i = 0; i < f->n_bundles; i++)
        f->slot[i].n_dropped = f->slot[i].n_merged = f->slot[i].n_held =
            1000000000;
}

/* Counts of a frame stop at the largest int, and do not turn over. */
static void test_counts_are_held(void **state)
{
    struct glint_flare_config c = base_config();
    struct glint_raster counting = glint_raster_cells;
    struct glint_flare_stats stats;
    struct glint_flare *f;
    void *mem;

    (void)state;
    counting.bin = count_many;
    c.raster = &counting;
    f = open_flare(&c, &mem);
    for (int i = 0; i < 3; i++)
        add_ghost(f, &ghosts[i]);
    glint_flare_bin(f, &stats);
    assert_int_equal(stats.dropped_cells, INT32_MAX);
    assert_int_equal(stats.merged_cells, INT32_MAX);
    assert_int_equal(stats.held_cells, INT32_MAX);
    free(mem);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_energy_is_kept),
        cmocka_unit_test(test_focused_light_arrives),
        cmocka_unit_test(test_flat_inside),
        cmocka_unit_test(test_edges_agree_with_cells),
        cmocka_unit_test(test_small_cells_agree),
        cmocka_unit_test(test_outlines_close),
        cmocka_unit_test(test_far_corner_closes),
        cmocka_unit_test(test_steps),
        cmocka_unit_test(test_rectangle_by_hand),
        cmocka_unit_test(test_triangle_by_hand),
        cmocka_unit_test(test_thin_light_arrives),
        cmocka_unit_test(test_linear_in_light),
        cmocka_unit_test(test_hostile_bundles),
        cmocka_unit_test(test_tiles_do_not_matter),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_order_does_not_matter),
        cmocka_unit_test(test_bright_stays_bright),
        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_bundle_order_does_not_matter),
        cmocka_unit_test(test_untouched_stays),
        cmocka_unit_test(test_into_nothing),
        cmocka_unit_test(test_exact_capacity),
        cmocka_unit_test(test_too_little_capacity),
        cmocka_unit_test(test_counts_are_held),
        cmocka_unit_test(test_config_is_checked),
        cmocka_unit_test(test_golden),
    };

    return cmocka_run_group_tests_name("flare", tests, NULL, NULL);
}
