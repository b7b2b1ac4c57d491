/* SPDX-License-Identifier: MIT
 *
 * Tests the statistics of a scene: the state of each object (drawn, hidden,
 * ...), the object that covers it, and counts with known values.
 */
#include "glint/scene/account.h"
#include "support/models/scene_builder.h"
#include "support/test.h"

enum { UNIT = 1 << 16, WIDTH = 200, HEIGHT = 120, MOST = 8 };

static struct scene_file file;
static struct glint_scene_part object[MOST], all;
static int16_t seen[WIDTH * HEIGHT];

static struct glint_scene *draw_scene_with_statistics(int edge_samples,
                                                      int half)
{
    struct glint_scene_config cfg;
    struct glint_scene *s;

    glint_scene_defaults(&cfg, WIDTH, HEIGHT);
    cfg.parts.bounces = &glint_scene_bounces;
    cfg.edge_samples = edge_samples;
    cfg.half_shading = half;
    s = scene_init_renderer(&file, &cfg, NULL);
    glint_scene_account(s, object, &all, seen);
    return s;
}

/* Checks the number of intersection tests. A lamp of four points lights a ball
 * that fills the picture: each pixel needs 3 tests for the ball's bounding box
 * and 4 for the lamp. With shadows, both balls are tested once for whether they
 * can hide a part of the lamp, which none can. The count saturates at its
 * limit. */
TEST(counts_intersection_tests)
{
    static const int32_t at[3] = {0, 0, 0};
    struct glint_scene *s;
    uint32_t m;

    scene_begin_header(&file);
    m = scene_add_material(&file, "m");
    scene_add_sphere(&file, "wall", m, 0, 0, 1000 * UNIT, 998 * UNIT);
    scene_add_sphere(&file, "back", m, 0, 0, -900 * UNIT, UNIT);
    scene_add_lamp(&file, at, UNIT);
    file.light[0].radius = UNIT / 8;
    s = draw_scene_with_statistics(1, 0);
    assert_true(fabs((double)glint_scene_count_tests(s, INT64_MAX) /
                         (7.0 * (double)all.count[GLINT_SCENE_COVERING]) -
                     1) < 0.05);
    file.header.shadow = 1;
    s = draw_scene_with_statistics(1, 0);
    assert_true(fabs((double)glint_scene_count_tests(s, INT64_MAX) /
                         (9.0 * (double)all.count[GLINT_SCENE_COVERING]) -
                     1) < 0.05);
    assert_true(glint_scene_count_tests(s, 1000) > 1000);
    assert_int_equal(glint_scene_count_tests(s, 1000), 1001);
}

TEST(counts_the_outcome_of_each_object)
{
    uint32_t m;

    scene_begin_header(&file);
    m = scene_add_material(&file, "m");
    scene_add_sphere(&file, "near", m, 0, 0, 4 * UNIT, UNIT);
    scene_add_sphere(&file, "far", m, 0, 0, 8 * UNIT, UNIT);
    scene_add_sphere(&file, "back", m, 0, 0, -4 * UNIT, UNIT);
    scene_add_sphere(&file, "aside", m, 40 * UNIT, 0, 4 * UNIT, UNIT);
    scene_add_sphere(&file, "dot", m, 2 * UNIT, UNIT / 2, 400 * UNIT,
                     UNIT / 512);
    scene_add_sphere(&file, "off", m, 0, 0, 3 * UNIT, UNIT);
    file.object[5].hidden = 1;
    draw_scene_with_statistics(4, 0);
    assert_int_equal(object[0].fate, GLINT_SCENE_DRAWN);
    assert_int_equal(object[1].fate, GLINT_SCENE_COVERED);
    assert_int_equal(object[1].by, 0);
    assert_int_equal(object[2].fate, GLINT_SCENE_BEHIND);
    assert_int_equal(object[3].fate, GLINT_SCENE_OUTSIDE);
    assert_int_equal(object[4].fate, GLINT_SCENE_SMALL);
    assert_int_equal(object[5].fate, GLINT_SCENE_OFF);
    for (int i = 0; i < 6; i++)
        assert_int_equal(object[i].count[GLINT_SCENE_SAMPLED] > 0, i == 0);
    assert_int_equal(seen[HEIGHT / 2 * WIDTH + WIDTH / 2], 0);
    assert_int_equal(seen[0], -1);
}

/* Checks the counts of pixels and rays. A ball of radius 1 at the distance 4
 * covers a circle of tangent 1 / sqrt 15, which is 2095 pixels if the tangent 1
 * is 100 pixels wide. A lamp lights the complete circle, a sun half of it. */
TEST(counts_pixels_and_rays)
{
    static const int32_t toward_q30[3] = {1 << 30, 0, 0};
    static const int32_t at[3] = {0, 0, -1000 * UNIT};
    const double area = 3.14159265 * 1e4 / 15;
    int64_t full[GLINT_SCENE_ITEMS];
    uint32_t m;

    scene_begin_header(&file);
    m = scene_add_material(&file, "m");
    scene_add_sphere(&file, "ball", m, 0, 0, 4 * UNIT, UNIT);
    scene_add_sun(&file, toward_q30);
    scene_add_lamp(&file, at, UNIT);
    file.header.shadow = 1;
    file.light[0].radius = 1 << 20;
    draw_scene_with_statistics(4, 0);
    memcpy(full, object[0].count, sizeof full);
    assert_true(fabs((double)full[GLINT_SCENE_SAMPLED] / 4 / area - 1) < 0.01);
    assert_int_equal(full[GLINT_SCENE_SHADED], full[GLINT_SCENE_COVERING]);
    assert_int_equal(full[GLINT_SCENE_COVERING],
                     all.count[GLINT_SCENE_COVERING]);
    /* the lamp lights all pixels of the ball, the sun half of them; each traces
     * four shadow rays per pixel */
    assert_true(fabs((double)full[GLINT_SCENE_SHADOWS] /
                         (3 * (double)full[GLINT_SCENE_SHADED]) -
                     1) < 0.03);
    draw_scene_with_statistics(1, 0);
    assert_true(fabs((double)object[0].count[GLINT_SCENE_SAMPLED] / area - 1) <
                0.02);
    draw_scene_with_statistics(4, 1);
    assert_true(object[0].count[GLINT_SCENE_SHADED] <
                full[GLINT_SCENE_SHADED] * 2 / 5);
    assert_int_equal(object[0].count[GLINT_SCENE_COVERING],
                     full[GLINT_SCENE_COVERING]);
    /* A reflective surface is shaded at each sample, not once per pixel. */
    file.material[0].reflect_q15 = 1 << 14;
    draw_scene_with_statistics(4, 0);
    assert_int_equal(object[0].count[GLINT_SCENE_BOUNCED],
                     full[GLINT_SCENE_SAMPLED]);
}

TEST(counts_occluded_lights)
{
    static const int32_t toward_q30[3] = {0, 0, 1 << 30};
    struct glint_scene *s;
    uint32_t m;

    scene_begin_header(&file);
    m = scene_add_material(&file, "m");
    scene_add_sphere(&file, "aside", m, 2 * UNIT, 0, 4 * UNIT, UNIT);
    scene_add_sphere(&file, "before", m, 0, 0, 4 * UNIT, UNIT);
    scene_add_sun(&file, toward_q30);
    s = draw_scene_with_statistics(1, 0);
    assert_int_equal(glint_scene_hider(s, 0), 1);
    glint_scene_show(s, 1, 0);
    assert_int_equal(glint_scene_hider(s, 0), -1);
}
