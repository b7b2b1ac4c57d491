/* SPDX-License-Identifier: MIT
 *
 * Tests frames in reserved memory. A frame in reserved memory never allocates.
 * If the memory is sufficient, the image equals that of a frame that allocates
 * on demand. Otherwise parts of the image are dropped and counted.
 */
#include <errno.h>

#include "support/settings_frame.h"
#include "support/fakes/wrapped.h"
#include "support/shuffle.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 120, BYTES = 3 * WIDTH * HEIGHT };

static struct opened opened, exact_scene;
static struct tool tool = {.name = "test", .quiet = true, .n_threads = 1};
/* number of allocations since this counter was set to 0 */
static int n_allocations;
/* number of the allocation that fails, counted from 1; 0: none */
static int fail_at;

static bool must_fail_this_allocation(void)
{
    return ++n_allocations == fail_at;
}

void *__wrap_malloc(size_t bytes)
{
    if (must_fail_this_allocation())
        return NULL;
    return __real_malloc(bytes);
}

void *__wrap_calloc(size_t n, size_t bytes)
{
    if (must_fail_this_allocation())
        return NULL;
    return __real_calloc(n, bytes);
}

void *__wrap_realloc(void *old, size_t bytes)
{
    if (must_fail_this_allocation())
        return NULL;
    return __real_realloc(old, bytes);
}

int __wrap_posix_memalign(void **mem, size_t align, size_t bytes)
{
    if (must_fail_this_allocation())
        return ENOMEM;
    return __real_posix_memalign(mem, align, bytes);
}

static const struct glint_lamp lamps[] = {
    {3, 20, 3e3, {1, 1, 1}, {0, 0}, 0},
    {8, 140, 2e3, {1, .5, .2}, {0, 0}, 0},
    {12, 250, 4e3, {.3, 1, 1}, {0, 0}, 0},
    {6, 300, 1e3, {1, 1, .4}, {0, 0}, 0},
    {10, 80, 3e3, {1, .2, 1}, {0, 0}, 0},
};

enum { N_LAMPS = (int)(sizeof lamps / sizeof *lamps) };

static void make_frame_for_lens(const struct opened *of,
                                struct glint_frame *frame)
{
    assert_ok(make_frame_from_settings(&tool, of, WIDTH, HEIGHT, frame));
    frame->dials.fineness = 16;
}

static void make_heliar_frame(struct glint_frame *frame)
{
    make_frame_for_lens(&opened, frame);
}

static void make_frame_of_uniform_grids(struct glint_frame *frame, int fineness)
{
    make_heliar_frame(frame);
    frame->picture.uniform = true;
    frame->dials.fineness = fineness;
}

static void draw_lamps_on_grey(struct glint_frame *frame, int n,
                               uint8_t rgb[BYTES],
                               struct glint_engine_report *report)
{
    struct glint_image image =
        glint_image_over(rgb, GLINT_RGB24, WIDTH, HEIGHT);

    memset(rgb, 20, BYTES);
    assert_ok(glint_frame_draw(frame, lamps, n, 1, &image, report));
}

static int count_different_samples(const uint8_t *a, const uint8_t *b)
{
    int n = 0;

    for (int i = 0; i < BYTES; i++)
        n += a[i] != b[i];
    return n;
}

static int count_brighter_samples(const uint8_t *a, const uint8_t *b)
{
    int n = 0;

    for (int i = 0; i < BYTES; i++)
        n += b[i] > a[i];
    return n;
}

/* Checks that a frame drawn after frames with more and with fewer lamps equals
 * a new frame. */
TEST(regrown_frame_equals_a_new_frame)
{
    static const int n_of[] = {1, 5, 0, 2, 5, 3};
    static uint8_t want[BYTES], got[BYTES];
    struct glint_frame reserved, grown;
    struct glint_engine_report report, other;

    make_heliar_frame(&reserved);
    assert_ok(
        glint_frame_reserve_memory(&reserved, NULL, 8 << 20, N_LAMPS, N_LAMPS));
    assert_true(reserved.memory.bytes <= 8 << 20);
    for (size_t i = 0; i < sizeof n_of / sizeof *n_of; i++) {
        n_allocations = 0;
        draw_lamps_on_grey(&reserved, n_of[i], got, &report);
        assert_int_equal(n_allocations, 0);
        make_heliar_frame(&grown);
        draw_lamps_on_grey(&grown, n_of[i], want, &other);
        /* A frame without reserved memory must allocate; otherwise the count of
         * allocations would prove nothing. */
        assert_true(n_of[i] == 0 || n_allocations > 0);
        assert_int_equal(count_different_samples(want, got), 0);
        assert_int_equal(report.stats.dropped_bundles, 0);
        assert_int_equal(report.stats.dropped_cells, 0);
        assert_int_equal(report.ghosts, other.ghosts);
        if (n_of[i])
            assert_true(report.peak_bytes <= reserved.memory.bytes);
        glint_frame_finish(&grown);
    }
    draw_lamps_on_grey(&reserved, 0, want, &report);
    assert_true(count_different_samples(want, got) > 0);
    glint_frame_finish(&reserved);
}

/* Checks, at the coarsest grids, that a frame in too little memory draws less,
 * counts everything that it drops, and is never brighter. */
TEST(too_little_memory_drops_and_counts)
{
    static uint8_t full[BYTES], got[BYTES];
    struct glint_frame frame;
    struct glint_engine_report report;
    int n_lost = 0, n_darker = 0;

    make_frame_of_uniform_grids(&frame, 8);
    draw_lamps_on_grey(&frame, N_LAMPS, full, &report);
    glint_frame_finish(&frame);
    for (size_t bytes = report.peak_bytes; bytes > 5e4; bytes -= bytes / 32) {
        int lost;

        make_frame_of_uniform_grids(&frame, 8);
        if (glint_frame_reserve_memory(&frame, NULL, bytes, N_LAMPS, N_LAMPS) !=
            GLINT_OK) {
            glint_frame_finish(&frame);
            break;
        }
        assert_true(frame.memory.bytes <= bytes);
        n_allocations = 0;
        draw_lamps_on_grey(&frame, N_LAMPS, got, &report);
        assert_int_equal(n_allocations, 0);
        lost = report.stats.dropped_bundles + report.stats.dropped_cells;
        assert_true(count_different_samples(full, got) == 0 || lost > 0);
        assert_int_equal(count_brighter_samples(full, got), 0);
        n_darker += count_different_samples(full, got) > 0;
        n_lost += lost > 0;
        glint_frame_finish(&frame);
    }
    assert_true(n_lost >= 5 && n_darker >= 5);
    make_heliar_frame(&frame);
    assert_int_equal(
        glint_frame_reserve_memory(&frame, NULL, 1000, N_LAMPS, N_LAMPS),
        GLINT_E_MEMORY);
    glint_frame_finish(&frame);
}

/* Checks that limits of work and of memory make grids coarser or drop ghosts,
 * and that the frame reports this. The next frame, without limits, must equal
 * the first frame. */
TEST(limits_make_frames_coarser_and_are_reported)
{
    static uint8_t want[BYTES], got[BYTES];
    struct glint_frame frame;
    struct glint_engine_report full, held;

    make_heliar_frame(&frame);
    draw_lamps_on_grey(&frame, N_LAMPS, want, &full);
    assert_false(full.coarsened);
    frame.limits.most_minsn = 1;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &held);
    assert_true(held.coarsened);
    assert_int_equal(held.drawn_lights, 1);
    assert_true(held.stats.primitives < full.stats.primitives);
    frame.limits.most_minsn = 0;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &held);
    assert_false(held.coarsened);
    assert_memory_equal(got, want, BYTES);
    glint_frame_finish(&frame);
    make_heliar_frame(&frame);
    frame.limits.most_bytes =
        /* The arena may exceed the memory limit by a factor of 1.25. */
        full.need_bytes * 3 / 4;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &held);
    assert_true(held.arena_bytes <= frame.limits.most_bytes * 5 / 4);
    assert_true(held.stats.dropped_bundles > 0 && held.stats.bundles > 0);
    assert_int_equal(held.need_bytes, full.need_bytes);
    frame.limits.most_bytes = 0;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &held);
    assert_int_equal(held.stats.dropped_bundles, 0);
    assert_memory_equal(got, want, BYTES);
    glint_frame_finish(&frame);
}

/* Checks that a frame that needs too much memory is drawn completely with
 * coarser grids, reports this, and is drawn identically again in the same
 * memory. */
TEST(too_little_memory_makes_grids_coarser)
{
    static uint8_t want[BYTES], got[BYTES], coarse[BYTES];
    struct glint_frame frame;
    struct glint_engine_report full, held;

    make_frame_of_uniform_grids(&frame, 64);
    draw_lamps_on_grey(&frame, N_LAMPS, want, &full);
    assert_false(full.tight);
    glint_frame_finish(&frame);
    make_frame_of_uniform_grids(&frame, 64);
    frame.limits.most_bytes = full.need_bytes * 3 / 4;
    draw_lamps_on_grey(&frame, N_LAMPS, coarse, &held);
    assert_true(held.coarsened && held.tight);
    assert_true(held.arena_bytes <= frame.limits.most_bytes * 5 / 4);
    assert_int_equal(held.stats.dropped_bundles, 0);
    assert_int_equal(held.ghosts, full.ghosts);
    assert_true(held.stats.primitives < full.stats.primitives);
    assert_int_equal(frame.dials.fineness, 64);
    n_allocations = 0;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &held);
    assert_int_equal(n_allocations, 0);
    assert_memory_equal(got, coarse, BYTES);
    frame.limits.most_bytes = 0;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &held);
    assert_false(held.coarsened || held.tight);
    assert_memory_equal(got, want, BYTES);
    glint_frame_finish(&frame);
}

/* Draws a frame in BYTES of memory with N workers. Returns whether its grids
 * were made coarser. */
static bool makes_grids_coarser(int n, size_t bytes, uint8_t rgb[BYTES],
                                struct glint_engine_report *report)
{
    struct shuffle shuffle;
    struct glint_frame frame;

    init_shuffled_workers(&shuffle, n, 7);
    make_frame_of_uniform_grids(&frame, 192);
    frame.cfg.workers = &shuffle.workers;
    frame.limits.most_bytes = bytes;
    draw_lamps_on_grey(&frame, N_LAMPS, rgb, report);
    glint_frame_finish(&frame);
    return report->tight;
}

/* Checks the memory limit below which grids become coarser. The limit must not
 * depend on the number of workers, be at least the memory that the frame needs,
 * and include no reserve for workers with uneven amounts of work. Grids must be
 * no coarser than necessary. */
TEST(memory_limit_does_not_depend_on_workers)
{
    static uint8_t want[BYTES], got[BYTES];
    struct glint_engine_report full, held;
    size_t low, high;

    assert_false(makes_grids_coarser(1, 0, want, &full));
    low = full.need_bytes * 3 / 4;
    for (high = full.need_bytes * 3 / 2; high - low > high / 10;) {
        const size_t middle = (low + high) / 2;

        if (makes_grids_coarser(1, middle, got, &held))
            low = middle;
        else
            high = middle;
    }
    assert_true(high >= full.need_bytes);
    /* At this limit, workers with uneven amounts of work may drop ray bundles,
     * but must count them. */
    assert_false(makes_grids_coarser(5, high, got, &held));
    assert_true(held.stats.dropped_bundles + held.stats.dropped_cells > 0 ||
                count_different_samples(got, want) == 0);
    assert_true(makes_grids_coarser(1, low, want, &held));
    assert_true(held.stats.primitives > full.stats.primitives / 2);
    assert_true(makes_grids_coarser(5, low, got, &held));
    assert_memory_equal(got, want, BYTES);
}

/* Checks that with little reserved memory no ray bundle is dropped, and that
 * the image does not depend on the number of workers, either. */
TEST(dropped_bundles_do_not_depend_on_workers)
{
    static uint8_t got[2][BYTES];

    for (int n = 1; n <= 5; n += 2) {
        struct glint_engine_report report;
        struct glint_frame frame;
        struct shuffle shuffle;

        init_shuffled_workers(&shuffle, n, 7);
        make_frame_of_uniform_grids(&frame, 192);
        frame.cfg.workers = &shuffle.workers;
        assert_ok(glint_frame_reserve_memory(&frame, NULL, 4 << 20, N_LAMPS,
                                             N_LAMPS));
        draw_lamps_on_grey(&frame, n, got[n > 1], &report);
        draw_lamps_on_grey(&frame, N_LAMPS, got[n > 1], &report);
        assert_true(report.tight && report.stats.dropped_bundles == 0);
        assert_memory_equal(got[n > 1], got[0], BYTES);
        glint_frame_finish(&frame);
    }
}

/* Merging the lamps must allocate nothing. */
TEST(lamps_above_max_lights_are_merged)
{
    static uint8_t got[BYTES];
    struct glint_frame frame;
    struct glint_engine_report report;

    make_heliar_frame(&frame);
    frame.dials.max_lights = 2;
    assert_ok(
        glint_frame_reserve_memory(&frame, NULL, 8 << 20, N_LAMPS, N_LAMPS));
    n_allocations = 0;
    draw_lamps_on_grey(&frame, N_LAMPS, got, &report);
    assert_int_equal(n_allocations, 0);
    assert_int_equal(report.drawn_lights, 2);
    assert_int_equal(report.stats.dropped_bundles, 0);
    glint_frame_finish(&frame);
}

TEST(changed_settings_equal_a_new_frame)
{
    static const struct {
        int cells, steps, lights;
        double codes;
    } setting[] = {{16, 69, 128, .125},
                   {8, 10, 3, .5},
                   {8, 4, 1, 4},
                   {16, 0, 5, 0},
                   {16, 69, 128, .125}};
    static uint8_t want[BYTES], got[BYTES];
    struct glint_engine_report report;
    struct glint_frame frame, fresh;
    int n_changed = 0;

    make_heliar_frame(&frame);
    assert_ok(
        glint_frame_reserve_memory(&frame, NULL, 8 << 20, N_LAMPS, N_LAMPS));
    for (size_t i = 0; i < sizeof setting / sizeof *setting; i++) {
        struct glint_frame *const both[2] = {&frame, &fresh};

        make_heliar_frame(&fresh);
        for (int k = 0; k < 2; k++) {
            both[k]->dials.fineness = setting[i].cells;
            both[k]->dials.irradiance_steps = setting[i].steps;
            both[k]->dials.max_lights = setting[i].lights;
            both[k]->dials.cull_codes = setting[i].codes;
        }
        n_allocations = 0;
        /* the image with the previous settings */
        memcpy(want, got, BYTES);
        draw_lamps_on_grey(&frame, N_LAMPS, got, &report);
        assert_int_equal(n_allocations, 0);
        n_changed += i > 0 && count_different_samples(want, got) > 0;
        draw_lamps_on_grey(&fresh, N_LAMPS, want, &report);
        assert_int_equal(count_different_samples(want, got), 0);
        glint_frame_finish(&fresh);
    }
    assert_int_equal(n_changed, 4);
    glint_frame_finish(&frame);
}

/* Makes each allocation fail in turn, in frames drawn by a model and by exact
 * rays. Checks that the flare is then drawn completely or an error is returned,
 * but never an image without light. */
TEST(failed_allocation_draws_completely_or_fails)
{
    static float want[BYTES], got[BYTES];
    for (int exact = 0; exact < 2; exact++) {
        struct glint_engine_report report;
        struct glint_frame frame;
        int n_refused = 0;

        for (int nth = 0; nth < 100; nth++) {
            enum glint_status status;

            make_frame_for_lens(exact ? &exact_scene : &opened, &frame);
            frame.only_ghost = 0;
            /* There are three lamps, more than this limit, so lamps are
             * merged. */
            frame.dials.max_lights = 2;
            n_allocations = 0;
            fail_at = nth;
            status = glint_frame_draw_flare_alone(&frame, lamps, 3, 1,
                                                  nth ? got : want, &report);
            fail_at = 0;
            glint_frame_finish(&frame);
            n_refused += status == GLINT_E_MEMORY;
            assert_true(status == GLINT_OK || status == GLINT_E_MEMORY);
            if (status == GLINT_OK)
                assert_memory_equal(want, nth ? got : want, sizeof want);
            /* The frame made fewer than NTH allocations, so none failed. */
            if (n_allocations < nth)
                break;
        }
        assert_true(n_refused >= 5);
    }
}

/* Checks that an engine keeps drawing with the old stop if the allocation for a
 * new stop fails. */
TEST(failed_stop_change_keeps_the_old_stop)
{
    static uint8_t want[BYTES], got[BYTES];
    const struct glint_image image =
        glint_image_over(got, GLINT_RGB24, WIDTH, HEIGHT);
    struct glint_engine_lamp lamp = glint_engine_lamp_of(&lamps[0], 1);
    struct glint_engine_config cfg;
    struct glint_engine_report report;
    struct glint_engine *engine;
    struct glint_error error;
    int n_failed = 0;

    glint_engine_defaults(&cfg, WIDTH, HEIGHT);
    cfg.model = &opened.lens.model.lens;
    cfg.search.max_found = 0;
    cfg.search.more_lamps = 1;
    assert_ok(glint_engine_create(&engine, &cfg, &error));
    for (int k = 0;; k++) {
        memset(got, 20, BYTES);
        assert_ok(glint_engine_draw(engine, &lamp, 1, &image, &report));
        if (k == 0)
            memcpy(want, got, BYTES);
        assert_memory_equal(want, got, BYTES);
        n_allocations = 0;
        fail_at = k + 1;
        n_failed += glint_engine_stop(engine, 22, &error) == GLINT_E_MEMORY;
        fail_at = 0;
        if (n_failed == k)
            break;
    }
    assert_true(n_failed > 0);
    glint_engine_destroy(engine);
}

/* Checks that numbers of lamps, ghosts and wavelengths whose product overflows
 * an int are rejected before any ray bundle is written. */
TEST(rejects_overflowing_numbers_of_bundles)
{
    enum { N = 66577 };
    struct glint_lamp *many = malloc(N * sizeof *many);
    static float rgb[BYTES];
    struct glint_setup crowd;
    struct glint_engine_report report;
    struct glint_frame frame;

    assert_non_null(many);
    for (int i = 0; i < N; i++)
        many[i] = (struct glint_lamp){i % 100 / 2., i / 100 / 2., 1,
                                      {1, 1, 1},    {0, 0},       0};
    make_frame_for_lens(&exact_scene, &frame);
    /* 66577 lamps x 2016 ghosts x 32 wavelengths are 2^32 + 48128 ray
     * bundles */
    crowd = exact_scene.lens.setup;
    crowd.n_ghosts = 2016;
    crowd.n_wavelengths = 32;
    frame.setup = &crowd;
    frame.dials.max_lights = N;
    frame.apart_px = 0;
    assert_int_equal(
        glint_frame_draw_flare_alone(&frame, many, N, 1, rgb, &report),
        GLINT_E_MEMORY);
    glint_frame_finish(&frame);
    free(many);
}

/* Checks how many point lights may represent wide lamps: point_room if the
 * lamps fit into max_lights; max_lights in reserved memory or if there are more
 * lamps. */
TEST(points_of_wide_lamps_use_point_room)
{
    static const struct {
        int max_lights, point_room, least, most;
        bool reserved;
    } setting[] = {
        {10, 0, 9, 10, false}, {10, 30, 28, 30, false}, {2, 30, 2, 2, false},
        {10, 5, 9, 10, false}, {10, 30, 9, 10, true},
    };
    static float rgb[BYTES];
    struct glint_lamp wide[3];
    struct glint_engine_report report;

    for (int i = 0; i < 3; i++) {
        wide[i] = lamps[i];
        wide[i].axis[0] = wide[i].axis[1] = 0.05;
    }
    for (size_t k = 0; k < sizeof setting / sizeof *setting; k++) {
        struct glint_frame frame;

        make_heliar_frame(&frame);
        frame.dials.max_lights = setting[k].max_lights;
        frame.dials.area_points = 61;
        frame.picture.point_room = setting[k].point_room;
        if (setting[k].reserved)
            assert_ok(glint_frame_reserve_memory(&frame, NULL, 16 << 20, 100,
                                                 setting[k].max_lights));
        assert_ok(
            glint_frame_draw_flare_alone(&frame, wide, 3, 1, rgb, &report));
        assert_in_range(frame.lights.n, setting[k].least, setting[k].most);
        glint_frame_finish(&frame);
    }
}

TEST_OPEN
{
    settings_set_defaults(&opened.settings);
    opened.settings.coating.kind = COATING_TABLE;
    opened.settings.max_deg = 15;
    settings_set_defaults(&exact_scene.settings);
    exact_scene.settings.coating.kind = COATING_TABLE;
    exact_scene.settings.options.rays = GLINT_RAYS_EXACT;
    assert_ok(tool_start_threads(&tool));
    assert_ok(opened_lens_open(&tool, &exact_scene.lens, &exact_scene.settings,
                               "lenses/heliar-tronnier.lens"));
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
}

TEST_CLOSE
{
    opened_lens_close(&opened.lens);
    opened_lens_close(&exact_scene.lens);
    tool_stop_threads(&tool);
}
