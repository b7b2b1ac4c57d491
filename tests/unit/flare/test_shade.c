/* SPDX-License-Identifier: MIT
 *
 * Tests dust and masks in the stop, which are drawn by edges. On coarse and
 * fine grids, each pixel of a flat ghost must have the light that the stop
 * passes for the rays of that pixel. A white mask must give the ghost of a
 * clean stop, a black mask no light. Soft edges must follow their profile.
 * Workers and tiles must not change the image.
 */
#include "engine/setup/dirt.h"
#include "support/ghosts.h"
#include "support/test.h"

static const struct ghost plain = {16, 100, 75, 60, 0, 1, 0, 0, {16384, 0, 0}};

/* Sets SETUP to a stop of N_BLADES blades with the dust and mask of IRIS.
 * Returns the resulting dirt, which the caller frees. */
static struct glint_dirt *make_dirt_in_stop(struct glint_setup *setup,
                                            int n_blades,
                                            const struct glint_iris *iris)
{
    struct glint_dirt *dirt;
    struct glint_error error;

    memset(setup, 0, sizeof *setup);
    setup->opening = setup->clear = 1;
    setup->n_blades = n_blades;
    setup->n_wavelengths = 1;
    setup->direct_flux[0] = 1;
    assert_ok(glint_setup_iris(setup, iris, &dirt, &error));
    return dirt;
}

/* Draws the ghost G into OUT, in tiles of 2^TILE_LOG2 pixels, through a stop of
 * N_BLADES blades with the dust or mask of IRIS. */
static struct glint_flare_stats
draw_ghost_through_iris(const struct ghost *g, const struct glint_iris *iris,
                        int n_blades, int tile_log2, int32_t *out)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    struct glint_flare_stats stats;
    struct glint_setup setup;
    struct glint_dirt *const dirt = make_dirt_in_stop(&setup, n_blades, iris);

    glint_setup_stop(&setup, &c.stop);
    c.stop.opening_q30 = 0;
    c.tile_log2 = tile_log2;
    c.max_primitives *= 64;
    c.max_refs *= 64;
    stats = draw_ghost_list(c, g, 1, out);
    glint_dirt_free(dirt);
    return stats;
}

/* Compares each pixel inside the stop with the ghost of a clean stop times the
 * transmission of IRIS. Returns the RMS difference divided by the light of the
 * clean ghost. */
static double compare_with_clear_ghost(const struct ghost *g,
                                       const struct glint_iris *iris)
{
    const struct glint_iris clear = {0};
    struct glint_setup setup;
    struct glint_dirt *const dirt = make_dirt_in_stop(&setup, 8, iris);
    double sum = 0, all = 0;
    int n = 0;

    draw_ghost_through_iris(g, &clear, 8, 5, want);
    draw_ghost_through_iris(g, iris, 8, 5, pixels);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double u = (x + 0.5 - g->cx) / g->size;
            /* removes the shear of the ghost */
            const double v = (g->cy - y - 0.5) / g->size - u / 5;
            const int at = 3 * (y * WIDTH + x);
            double light = 0, off;

            if (hypot(u, v) > 0.88)
                continue;
            for (int k = 0; k < 16; k++)
                light += glint_dirt_light(dirt, u + (k % 4 - 1.5) / 4 / g->size,
                                          v - (k / 4 - 1.5) / 4 / g->size) /
                         16;
            off = pixels[at] - want[at] * light;
            sum += off * off;
            all += want[at];
            n++;
        }
    glint_dirt_free(dirt);
    return sqrt(sum / n) / (all / n);
}

/* Checks that specks of dust have the expected position and darkness, on every
 * grid. */
TEST(dust_has_its_position_and_darkness)
{
    for (int seed = 1; seed < 5; seed++)
        for (int n = 8; n <= 64; n *= 2) {
            const struct glint_iris iris = {.dust = 0.05, .dust_seed = seed};
            struct ghost g = plain;

            g.n = n;
            /* the smallest specks are smaller than a pixel */
            assert_true(compare_with_clear_ghost(&g, &iris) <
                        (n == 8 ? 0.085 : 0.045));
        }
}

/* Checks that a mask is drawn upright: the top row of its image lies at the
 * highest y of the stop. */
TEST(mask_is_upright)
{
    uint8_t mask[32 * 32];
    const struct glint_iris iris = {
        .mask = mask, .mask_width = 32, .mask_height = 32};

    for (int i = 0; i < 32 * 32; i++)
        mask[i] = (uint8_t)(64 + 5 * (i / 32) + (i % 32 > 20 ? 20 : 0));
    assert_true(compare_with_clear_ghost(&plain, &iris) < 0.005);
}

/* Checks that dirt rotates with the blades, from the x axis towards the y
 * axis. */
TEST(dirt_rotates_with_the_blades)
{
    const uint8_t mask[4] = {0, 255, 0, 255};
    const struct glint_iris iris = {
        .mask = mask, .mask_width = 2, .mask_height = 2};

    for (int turn = 0; turn < 360; turn += 30) {
        const double phi = turn * 3.14159265358979323846 / 180;
        struct glint_setup setup;
        struct glint_dirt *dirt;
        struct glint_error error;

        memset(&setup, 0, sizeof setup);
        setup.opening = setup.clear = 1;
        setup.n_wavelengths = 1;
        setup.direct_flux[0] = 1;
        setup.blade_rotation_deg = turn;
        assert_ok(glint_setup_iris(&setup, &iris, &dirt, &error));
        assert_true(glint_dirt_light(dirt, 0.8 * cos(phi), 0.8 * sin(phi)) >
                    0.99);
        assert_true(glint_dirt_light(dirt, -0.8 * cos(phi), -0.8 * sin(phi)) <
                    0.01);
        glint_dirt_free(dirt);
    }
}

/* Checks that a white mask changes nothing and that a black one leaves no
 * light. */
TEST(white_and_black_masks_pass_all_or_nothing)
{
    uint8_t mask[4] = {255, 255, 255, 255};
    struct glint_iris iris = {.mask = mask, .mask_width = 2, .mask_height = 2};
    const struct glint_iris clear = {0};

    draw_ghost_through_iris(&plain, &clear, 8, 5, want);
    draw_ghost_through_iris(&plain, &iris, 8, 5, pixels);
    assert_memory_equal(pixels, want, sizeof pixels);
    memset(mask, 0, sizeof mask);
    assert_int_equal(
        draw_ghost_through_iris(&plain, &iris, 8, 5, pixels).primitives, 0);
    assert_true(sum_channel_light(pixels, 0) == 0);
}

/* Checks that dust adds few edges: at most ten per cell. */
TEST(dust_adds_few_edges)
{
    const struct glint_iris iris = {.dust = 0.3, .dust_seed = 5};
    const struct glint_iris clear = {0};
    int plain_edges, dusty;

    plain_edges =
        draw_ghost_through_iris(&plain, &clear, 8, 5, want).primitives;
    dusty = draw_ghost_through_iris(&plain, &iris, 8, 5, pixels).primitives;
    /* clipped cells consist of two polygons, each with up to five corners */
    assert_true(dusty > plain_edges);
    assert_true(dusty < plain_edges + 16 * 16 * 10);
}

/* Checks a mask with one white half: it passes half of the light, and hardly
 * any pixel becomes negative. */
TEST(half_mask_passes_half_of_the_light)
{
    uint8_t mask[64 * 64];
    const struct glint_iris iris = {
        .mask = mask, .mask_width = 64, .mask_height = 64};
    const struct glint_iris clear = {0};
    double kept, all;

    for (int i = 0; i < 64 * 64; i++)
        mask[i] = i / 64 < 32 ? 255 : 0;
    draw_ghost_through_iris(&plain, &clear, 8, 5, want);
    draw_ghost_through_iris(&plain, &iris, 8, 5, pixels);
    kept = sum_channel_light(pixels, 0);
    all = sum_channel_light(want, 0);
    assert_true(fabs(kept / all - 0.5) < 0.005);
    for (int k = 0; k < 3 * WIDTH * HEIGHT; k++)
        assert_true(pixels[k] > -want[3 * (75 * WIDTH + 100)] / 100);
}

/* Checks that a soft edge passes the mean light of its profile, for straight
 * sides, arcs and circles. */
TEST(soft_edge_has_the_light_of_its_profile)
{
    for (int k = 0; k < 12; k++) {
        const struct glint_iris clear = {.roundness = k % 3 == 2 ? 0.6 : 0};
        const int n = k % 3 ? 6 : 0;
        struct glint_iris iris = clear;
        struct glint_setup setup;
        struct glint_dirt *dirt;
        double mean, share;

        iris.softness = 0.03 * (1 << k / 3);
        dirt = make_dirt_in_stop(&setup, n, &iris);
        mean = dirt->mean;
        glint_dirt_free(dirt);
        draw_ghost_through_iris(&plain, &clear, n, 5, want);
        draw_ghost_through_iris(&plain, &iris, n, 5, pixels);
        share = sum_channel_light(pixels, 0) / sum_channel_light(want, 0);
        assert_true(fabs(share / mean - 1) < 0.01);
    }
}

TEST(image_does_not_depend_on_tiles)
{
    const struct glint_iris iris = {
        .roundness = 0.4, .softness = 0.1, .dust = 0.1, .dust_seed = 9};

    draw_ghost_through_iris(&ghosts[1], &iris, 7, 5, want);
    assert_true(sum_channel_light(want, 0) + sum_channel_light(want, 1) +
                    sum_channel_light(want, 2) >
                0);
    for (int log2 = 3; log2 <= 6; log2++) {
        draw_ghost_through_iris(&ghosts[1], &iris, 7, log2, pixels);
        assert_memory_equal(pixels, want, sizeof pixels);
    }
}

TEST(rejects_values_out_of_range)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    struct glint_shade shade = {.method = &glint_shade_method};

    c.stop.shade = &shade;
    assert_true(glint_flare_bytes(&c) > 0);
    shade.soft_q16 = 65537;
    assert_int_equal(glint_flare_bytes(&c), 0);
    shade.soft_q16 = 0;
    shade.log2 = 2;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c.stop.shade = NULL;
    c.stop.round_q30 = 1 << 29;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c.stop.off_q30 = 1 << 29;
    assert_true(glint_flare_bytes(&c) > 0);
}
