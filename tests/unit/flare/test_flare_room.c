/* SPDX-License-Identifier: MIT
 *
 * Checks the limits of the integer rasteriser: edges beyond the capacity are
 * dropped and counted, invalid settings are rejected, and counts saturate at
 * INT_MAX.
 */
#include "flare/state.h"
#include "support/ghosts.h"
#include "support/test.h"

/* ---------------------------------------------------------------- capacity */

/* Checks that the capacities that glint_flare_bin() requests are sufficient,
 * and that memory one byte smaller is rejected. */
TEST(requested_capacities_are_sufficient)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    struct glint_flare_stats s = draw_scene(c, want);
    struct glint_flare *f;
    void *mem;
    size_t bytes;

    assert_int_equal(s.dropped_bundles, 0);
    c.max_bundles = s.need_bundles;
    c.max_vertices = s.need_vertices;
    c.max_primitives = s.need_primitives;
    c.max_refs = s.need_refs;
    assert_pixels_equal_want(c);
    bytes = glint_flare_bytes(&c);
    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_int_equal(glint_flare_init(&f, &c, mem, bytes - 1), GLINT_E_MEMORY);
    assert_ok(glint_flare_init(&f, &c, mem, bytes));
    free(mem);
}

/* Checks each capacity: if it is too small by one, one ray bundle is dropped
 * and counted, and all others are drawn correctly. */
TEST(missing_capacity_drops_one_bundle)
{
    struct glint_flare_config full = make_octagonal_stop_config();
    struct glint_flare_stats s, less;

    s = draw_scene(full, pixels);
    draw_ghost_list(full, ghosts, N_GHOSTS - 1, want);
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
    /* dropped ray bundles are counted even with very little memory */
    for (int k = 0; k < 8; k++) {
        full.max_primitives = (int)((int64_t)s.need_primitives * k / 8);
        full.max_refs = k % 2 ? s.need_refs / 3 : s.need_refs;
        less = draw_scene(full, pixels);
        assert_true(less.bundles < s.bundles);
        assert_int_equal(less.need_primitives, s.need_primitives);
        assert_int_equal(less.need_refs, s.need_refs);
    }
}

TEST(rejects_invalid_configurations)
{
    struct glint_flare_config c = make_octagonal_stop_config();

    assert_int_not_equal(glint_flare_bytes(&c), 0);
    c.tile_log2 = 7;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c = make_octagonal_stop_config();
    c.width = GLINT_MAX_SIDE + 1;
    assert_int_equal(glint_flare_bytes(&c), 0);
    c = make_octagonal_stop_config();
    c.stop.n_blades = 2;
    assert_int_equal(glint_flare_bytes(&c), 0);
}

/* true: the wrapped glint_edges_bin() draws nothing, but adds 1e9 cells per ray
 * bundle to the counts */
static bool counts_many;

void __real_glint_edges_bin(struct glint_flare *f);
void __wrap_glint_edges_bin(struct glint_flare *f);
void __wrap_glint_edges_bin(struct glint_flare *f)
{
    if (!counts_many) {
        __real_glint_edges_bin(f);
        return;
    }
    f->n_drawn = f->n_bundles;
    for (int i = 0; i < f->n_bundles; i++)
        f->slot[i].n_dropped = f->slot[i].n_held = 1000000000;
}

/* Checks that the counts of a frame saturate at INT_MAX instead of wrapping. */
TEST(counts_saturate_at_int_max)
{
    struct glint_flare_config c = make_octagonal_stop_config();
    struct glint_flare_stats stats;
    struct glint_flare *f;
    void *mem;

    f = allocate_flare(&c, &mem);
    for (int i = 0; i < 3; i++)
        add_ghost_to_flare(f, &ghosts[i]);
    counts_many = true;
    glint_flare_bin(f, &stats);
    counts_many = false;
    assert_int_equal(stats.dropped_cells, INT32_MAX);
    assert_int_equal(stats.held_cells, INT32_MAX);
    free(mem);
}
