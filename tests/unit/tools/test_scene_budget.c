/* SPDX-License-Identifier: MIT
 *
 * Qualities of the dials of a scene's budget, and a scene that is drawn coarser
 * while it runs, as live does to hold a rate. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "live/live_adapt.h"
#include "scenes/over_scene.h"

enum { WIDTH = 64, HEIGHT = 36, BYTES = 3 * WIDTH * HEIGHT };

/* Qualities are those of the option that has the same dials. */
static void test_qualities(void **state)
{
    static const double quality[SCENE_BUDGET_LEVELS] = {1,   .5,   .375,
                                                        .25, .125, 0};

    (void)state;
    for (int i = 0; i < SCENE_BUDGET_LEVELS; i++) {
        struct scene_dials dials = {.width = WIDTH, .height = HEIGHT};
        struct scene_budget budget;

        scene_dials_be(&dials, quality[i]);
        scene_budget_init(&budget, &dials);
        assert_true(scene_budget_quality(&budget) == quality[i]);
        assert_int_equal(scene_budget_level(quality[i]), i);
        for (int k = 0; k < SCENE_BUDGET_LEVELS; k++) {
            budget.level = k;
            assert_true(scene_budget_quality(&budget) ==
                        fmin(quality[i], quality[k]));
        }
    }
}

/* Steps of live go down that scale to its end. */
static void test_steps(void **state)
{
    struct live_adapt adapt;
    double last = 1;

    (void)state;
    live_adapt_init(&adapt);
    assert_true(live_adapt_quality(&adapt) == 1);
    for (adapt.step = 1; adapt.step <= LIVE_MAX_STEP; adapt.step++) {
        const double now = live_adapt_quality(&adapt);

        assert_true(now < last || (now == 0 && last == 0));
        last = now;
    }
    assert_true(last == 0);
}

static void draw(struct over_scene *over, uint8_t *pixels)
{
    struct glint_image image = {
        .format = GLINT_RGB24, .width = WIDTH, .height = HEIGHT};

    memset(pixels, 90, BYTES);
    glint_image_place(&image, pixels);
    assert_int_equal(over_scene_draw(over, &image, 0), GLINT_OK);
}

/* A scene that is drawn coarser, and finer again,
 * is what the same dials draw from the start. */
static void test_coarser(void **state)
{
    static const struct tool tool = {.name = "test", .quiet = true};
    static uint8_t fine[BYTES], coarse[BYTES], got[BYTES];
    struct scene_dials dials = {.width = WIDTH, .height = HEIGHT};
    struct over_scene over = {.file = "tests/data/balls.scene"};

    (void)state;
    assert_int_equal(over_scene_open(&over, &tool), EXIT_OK);
    scene_dials_be(&dials, 0);
    assert_int_equal(over_scene_size(&over, &dials), EXIT_OK);
    draw(&over, coarse);
    dials = (struct scene_dials){.width = WIDTH, .height = HEIGHT};
    assert_int_equal(over_scene_size(&over, &dials), EXIT_OK);
    draw(&over, fine);
    assert_memory_not_equal(fine, coarse, BYTES);
    assert_int_equal(over_scene_coarsen(&over, 0), GLINT_OK);
    draw(&over, got);
    assert_memory_equal(got, coarse, BYTES);
    assert_int_equal(over_scene_coarsen(&over, 1), GLINT_OK);
    draw(&over, got);
    assert_memory_equal(got, fine, BYTES);
    over_scene_close(&over);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {cmocka_unit_test(test_qualities),
                                              cmocka_unit_test(test_steps),
                                              cmocka_unit_test(test_coarser)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
