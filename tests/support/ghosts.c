/* SPDX-License-Identifier: MIT */
#include "support/ghosts.h"

#include "support/rng.h"
#include "support/test.h"

/* Normals of an octagon's sides, Q30: cos and sin of 22.5 + 45 k degrees.
 * They are constants so that golden hashes do not depend on libm. */
static const int32_t octagon[8][2] = {
    {992008094, 410903207},  {410903207, 992008094},   {-410903207, 992008094},
    {-992008094, 410903207}, {-992008094, -410903207}, {-410903207, -992008094},
    {410903207, -992008094}, {992008094, -410903207}};

struct glint_flare_config make_octagonal_stop_config(void)
{
    struct glint_flare_config c = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .tile_log2 = 3,
                                   .max_bundles = 64,
                                   .max_vertices = 60000,
                                   .max_primitives = 60000,
                                   .max_refs = 400000};

    c.stop.n_blades = 8;
    c.stop.apothem_q16 = 60547; /* cos 22.5 degrees */
    memcpy(c.stop.normal_q30, octagon, sizeof octagon);
    return c;
}

struct glint_vertex compute_ghost_vertex(const struct ghost *g, int i, int j)
{
    /* position in the stop, -1.25 .. 1.25 stop radii, Q16, by integers only */
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

void add_ghost_to_flare(struct glint_flare *f, const struct ghost *g)
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
            *v++ = compute_ghost_vertex(g, i, j);
}

const struct ghost ghosts[N_GHOSTS] = {
    {16, 60, 60, 40, 0, 1, 0, 0, {16384, 0, 0}},
    {16, 64, 62, 42, 50, 1, 300, 0, {0, 16384, 0}},
    {32, 128, 64, 200, 120, -1, 600, 2, {0, 0, 16384}},
    {8, 128, 128, 3, 0, 1, 0, -2, {16384, 8000, -2000}},
    {16, 190, 20, 60, 900, 1, 0, 0, {9000, 9000, 9000}}, /* a folded ghost */
    {16, -40, 160, 90, 0, -1, 0, 1, {3000, 16384, 200}}, /* partly outside */
};

struct glint_flare *allocate_flare(struct glint_flare_config *c, void **mem)
{
    const size_t bytes = glint_flare_bytes(c);
    struct glint_flare *f;

    assert_int_not_equal(bytes, 0);
    assert_int_equal(posix_memalign(mem, 64, bytes), 0);
    /* Filled memory reveals members that init() leaves unset. */
    memset(*mem, 0xa5, bytes);
    assert_ok(glint_flare_init(&f, c, *mem, bytes));
    return f;
}

struct glint_image make_linear_image(int32_t *px)
{
    struct glint_image image =
        glint_image_over(px, GLINT_LINEAR_Q20, WIDTH, HEIGHT);

    memset(px, 0, sizeof(int32_t) * 3 * WIDTH * HEIGHT);
    return image;
}

struct glint_flare_stats draw_ghost_list(struct glint_flare_config c,
                                         const struct ghost *list, int n,
                                         int32_t *out)
{
    const struct glint_image image = make_linear_image(out);
    struct glint_flare_stats stats;
    void *mem;
    struct glint_flare *f = allocate_flare(&c, &mem);

    for (int i = 0; i < n; i++)
        add_ghost_to_flare(f, &list[i]);
    glint_flare_bin(f, &stats);
    glint_flare_draw(f, &image);
    free(mem);
    return stats;
}

struct glint_flare_stats draw_scene(struct glint_flare_config c, int32_t *out)
{
    return draw_ghost_list(c, ghosts, N_GHOSTS, out);
}

int32_t pixels[3 * WIDTH * HEIGHT], want[3 * WIDTH * HEIGHT];

void assert_pixels_equal_want(struct glint_flare_config c)
{
    draw_scene(c, pixels);
    assert_memory_equal(pixels, want, sizeof pixels);
}

double sum_channel_light(const int32_t *p, int channel)
{
    double sum = 0;

    for (int i = channel; i < 3 * WIDTH * HEIGHT; i += 3)
        sum += p[i] / 1048576.0;
    return sum;
}

int draw_random_number(int n)
{
    static uint32_t seed = 7;

    return rng_int_below(&seed, n);
}

struct ghost make_random_ghost(void)
{
    const int size = 3 + draw_random_number(40);

    return (struct ghost){
        4 + draw_random_number(29),
        draw_random_number(WIDTH - 60) - 20,
        draw_random_number(HEIGHT),
        size,
        /* ghosts with bends beyond +-320 are folded */
        draw_random_number(1500) - 750,
        draw_random_number(2) ? 1 : -1,
        draw_random_number(2000) - 1000,
        draw_random_number(4),
        {16384 - draw_random_number(20000), draw_random_number(16384), 16384}};
}
