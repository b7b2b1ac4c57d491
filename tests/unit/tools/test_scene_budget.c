/* SPDX-License-Identifier: MIT
 *
 * Tests how the quality of a scene adapts to a frame rate in glint live, and to
 * a budget of time per frame. Frame times come from tables, and the clock is
 * fake.
 */
#include "live/live_adapt.h"
#include "overlay/over_scene.h"
#include "support/test.h"

enum { WIDTH = 64, HEIGHT = 36, BYTES = 3 * WIDTH * HEIGHT };

/* Checks that each quality level reports the value of --quality from which it
 * was made, and that this value gives the level. */
TEST(levels_have_their_quality)
{
    static const double quality[SCENE_BUDGET_LEVELS] = {1, .5, .375, .125, 0};

    for (int i = 0; i < SCENE_BUDGET_LEVELS; i++) {
        struct scene_dials dials = {.width = WIDTH, .height = HEIGHT};
        struct scene_budget budget;

        scene_dials_set_quality(&dials, quality[i]);
        scene_budget_init(&budget, &dials);
        assert_true(scene_budget_get_flare_quality(&budget) == quality[i]);
        assert_int_equal(scene_budget_find_level_of_quality(quality[i]), i);
        for (int k = 0; k < SCENE_BUDGET_LEVELS; k++) {
            budget.level = k;
            assert_true(scene_budget_get_flare_quality(&budget) ==
                        fmin(quality[i], quality[k]));
        }
    }
}

/* Checks that glint live, step by step, uses all quality levels from first to
 * last. */
TEST(live_steps_follow_the_levels)
{
    struct live_adapt adapt;
    double last = 1;

    live_adapt_init(&adapt);
    assert_true(live_adapt_get_max_scene_quality(&adapt) == 1);
    for (adapt.step = 1; adapt.step <= LIVE_MAX_STEP; adapt.step++) {
        const double now = live_adapt_get_max_scene_quality(&adapt);

        assert_true(now < last || (now == 0 && last == 0));
        last = now;
    }
    assert_true(last == 0);
}

static void simulate_scene_frame(struct over_scene *over, uint8_t *pixels)
{
    struct glint_image image =
        glint_image_over(pixels, GLINT_RGB24, WIDTH, HEIGHT);

    memset(pixels, 90, BYTES);
    assert_ok(over_scene_draw(over, &image, 0));
}

/* Draws a scene at a coarse quality level, then at a finer one. Checks that the
 * second image equals that of a new scene at the finer level. */
TEST(changed_level_equals_a_new_scene)
{
    static const struct tool tool = {.name = "test", .quiet = true};
    static uint8_t fine[BYTES], coarse[BYTES], got[BYTES];
    struct scene_dials dials = {.width = WIDTH, .height = HEIGHT};
    struct over_scene over = {.file = "tests/data/balls.scene"};

    assert_ok(over_scene_open(&over, &tool));
    scene_dials_set_quality(&dials, 0);
    assert_ok(over_scene_allocate(&over, &dials));
    simulate_scene_frame(&over, coarse);
    dials = (struct scene_dials){.width = WIDTH, .height = HEIGHT};
    assert_ok(over_scene_allocate(&over, &dials));
    simulate_scene_frame(&over, fine);
    assert_memory_not_equal(fine, coarse, BYTES);
    assert_ok(over_scene_set_quality(&over, 0));
    simulate_scene_frame(&over, got);
    assert_memory_equal(got, coarse, BYTES);
    assert_ok(over_scene_set_quality(&over, 1));
    simulate_scene_frame(&over, got);
    assert_memory_equal(got, fine, BYTES);
    over_scene_close(&over);
}

/* ------------------------------------------------------------------ budgets */

/* frame time of each quality level at the usual speed of the machine, ms */
static const double level_ms[SCENE_BUDGET_LEVELS] = {40, 40, 24, 12, 8};

static struct scene_budget make_scene_budget(void)
{
    const struct scene_dials dials = {.width = WIDTH, .height = HEIGHT};
    struct scene_budget budget;

    scene_budget_init(&budget, &dials);
    return budget;
}

/* Draws N frames with a time limit of LIMIT_MS; each frame takes SLOWER times
 * as long as in the table. Returns the number of frames above the limit. */
static int count_late_frames(struct scene_budget *b, int n, double slower,
                             double limit_ms)
{
    int late = 0;

    for (int i = 0; i < n; i++) {
        const double ms = slower * level_ms[b->level];

        late += ms > limit_ms;
        scene_budget_update_level(b, ms, limit_ms);
    }
    return late;
}

/* Checks that the finest quality level that fits into the budget is reached,
 * first from finer levels, later from coarser ones. */
TEST(finest_fitting_level_is_reached)
{
    struct scene_budget b = make_scene_budget();

    assert_int_equal(count_late_frames(&b, 100, 1, 1000), 0);
    assert_int_equal(b.level, 0);
    count_late_frames(&b, 12, 1, 30);
    assert_int_equal(b.level, 2);
    assert_int_equal(count_late_frames(&b, 300, 1, 30), 0);
    assert_int_equal(b.level, 2);
    count_late_frames(&b, 7, 2, 30);
    assert_int_equal(b.level, 3);
    count_late_frames(&b, 12, 10, 30);
    assert_int_equal(b.level, SCENE_BUDGET_LEVELS - 1);
    count_late_frames(&b, 200, 1, 30);
    assert_int_equal(b.level, 2);
    count_late_frames(&b, 200, .5, 30);
    /* The finest quality level is 1, as level 0 has the same parameters. */
    assert_int_equal(b.level, 1);
}

TEST(slow_level_is_rarely_tried)
{
    struct scene_budget b = make_scene_budget();

    count_late_frames(&b, 7, 1, 22);
    assert_int_equal(b.level, 3);
    assert_true(count_late_frames(&b, 1000, 1, 22) <= 14);
}

TEST(single_slow_frame_changes_nothing)
{
    struct scene_budget b = make_scene_budget();

    count_late_frames(&b, 12, 1, 30);
    assert_int_equal(b.level, 2);
    assert_false(scene_budget_update_level(&b, 300, 30));
    assert_int_equal(count_late_frames(&b, 100, 1, 30), 0);
    assert_int_equal(b.level, 2);
}

/* Simulates 200 frames of a scene and a flare with a common budget of 60 ms.
 * The flare uses the time that the scene leaves, at least LEAST_MS (quality 0)
 * and at most MOST_MS (quality 1). Checks that the scene ends at the quality
 * level LEVEL, and that at most 10 frames are late after the first 20. */
static void check_budget_shared_with_flare(double least_ms, double most_ms,
                                           int level)
{
    struct scene_budget b = make_scene_budget();
    double flare_ms = 0, quality = 0;
    int late = 0;

    for (int i = 0; i < 200; i++) {
        const double scene_ms = level_ms[b.level], left_ms = 60 - scene_ms;

        if (i > 0)
            scene_budget_update_level(
                &b, scene_ms, scene_budget_limit_flare(60, flare_ms, quality));
        flare_ms = fmax(least_ms, fmin(most_ms, left_ms));
        quality = fmax(0, fmin(1, (left_ms - least_ms) / (most_ms - least_ms)));
        late += i >= 20 && scene_ms + flare_ms > 60;
    }
    assert_int_equal(b.level, level);
    assert_true(late <= 10); /* frames are late when a finer level is tried */
}

TEST(budget_is_shared_with_the_flare)
{
    /* The flare needs almost no time. */
    check_budget_shared_with_flare(1, 2, 0);
    /* The flare could use all the time. */
    check_budget_shared_with_flare(10, 200, 2);
    /* The flare needs at least half of the time. */
    check_budget_shared_with_flare(30, 200, 2);
    /* The flare needs at least 50 of 60 ms. */
    check_budget_shared_with_flare(50, 200, 4);
    assert_true(scene_budget_limit_flare(60, 59, 0) == 6);
}

static double now_s, step_s;

/* a fake clock that advances by one step at each reading */
double __wrap_tool_clock_s(void);
double __wrap_tool_clock_s(void)
{
    now_s += step_s;
    return now_s;
}

/* Checks that images of a scene with a budget equal images drawn with the
 * quality that the budget has selected. */
TEST(images_equal_those_of_the_quality)
{
    static const struct tool tool = {.name = "test", .quiet = true};
    static uint8_t coarse[BYTES], got[BYTES];
    struct scene_dials dials = {.width = WIDTH, .height = HEIGHT};
    struct over_scene over = {.file = "tests/data/balls.scene"};

    step_s = 1e-3;
    assert_ok(over_scene_open(&over, &tool));
    scene_dials_set_quality(&dials, 0);
    assert_ok(over_scene_allocate(&over, &dials));
    simulate_scene_frame(&over, coarse);
    dials = (struct scene_dials){.width = WIDTH, .height = HEIGHT};
    assert_ok(over_scene_allocate(&over, &dials));
    over.budget_ms = 2 * over.ms;
    for (int i = 0; i < 20; i++)
        simulate_scene_frame(&over, got);
    assert_true(scene_budget_get_flare_quality(&over.budget) == .5);
    step_s = 3e-3;
    for (int i = 0; i < 20; i++)
        simulate_scene_frame(&over, got);
    assert_true(scene_budget_get_flare_quality(&over.budget) == 0);
    assert_memory_equal(got, coarse, BYTES);
    over_scene_close(&over);
}
