/* SPDX-License-Identifier: MIT
 *
 * What the budget of a scene knows of flares, qualities of its dials, and a
 * scene that is drawn coarser while it runs, as live does to hold a rate. */
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

/* Ratios and PSNR are those that `make trade` wrote. */
static void test_flares(void **state)
{
    static const char *const lens[3] = {"| heliar-tronnier |",
                                        "| double-gauss-angenieux |",
                                        "| nikon-zoom-mid |"};
    double ratio[5] = {0}, db[5] = {0};
    char line[512];
    int n = 0;
    FILE *const file = fopen("tests/figures/trade.md", "r");

    (void)state;
    assert_non_null(file);
    while (n < 3 && fgets(line, sizeof line, file)) {
        double m[5], d[5];

        if (strncmp(line, lens[n], strlen(lens[n])) != 0 ||
            sscanf(line + strlen(lens[n]),
                   "%lf; %lf; %*[^|]| %lf; %lf; %*[^|]| %lf; %lf; %*[^|]| "
                   "%lf; %lf; %*[^|]| %lf; %lf;",
                   &m[0], &d[0], &m[1], &d[1], &m[2], &d[2], &m[3], &d[3],
                   &m[4], &d[4]) != 10)
            continue;
        for (int i = 0; i < 5; i++) {
            ratio[i] += m[i] / m[2] / 3;
            db[i] += d[i] / 3;
        }
        n++;
    }
    fclose(file);
    assert_int_equal(n, 3);
    for (int i = 0; i < SCENE_BUDGET_FLARES; i++) {
        const struct scene_budget_flare *const f = &scene_budget_flares[i];

        assert_true(f->quality == i / 4.);
        if (fabs(f->ratio / ratio[i] - 1) > .02 || fabs(f->db - db[i]) > .1)
            fail_msg("quality %g: %g, %g dB, not %.3f, %.2f dB", f->quality,
                     f->ratio, f->db, ratio[i], db[i]);
    }
}

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
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flares), cmocka_unit_test(test_qualities),
        cmocka_unit_test(test_steps), cmocka_unit_test(test_coarser)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
