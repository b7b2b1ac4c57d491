/* SPDX-License-Identifier: MIT
 *
 * Checks that an occlusion mask dims lamps, and that lamps fade out
 * off-screen.
 */
#include "desk/occlusion.h"
#include "glint/area.h"
#include "support/test.h"

enum { SIDE = 64 };

static uint8_t rgb[3 * SIDE * SIDE];
static const struct glint_view view = {
    .width = 4 * SIDE, .height = 4 * SIDE, .sensor_width_mm = 36};
static const double focal_mm = 50;

/* Returns a mask a quarter as large as the image, black to the left of
 * COLUMN. */
static struct occlusion make_half_black_mask(int column)
{
    struct occlusion o = {.file = "mask.ppm", .black = 0, .white = 255};

    o.image = (struct glint_image){
        .format = GLINT_RGB24, .width = SIDE, .height = SIDE};
    for (int i = 0; i < SIDE * SIDE; i++)
        memset(rgb + 3 * (ptrdiff_t)i, i % SIDE < column ? 0 : 255, 3);
    glint_image_place(&o.image, rgb);
    return o;
}

/* Returns the fraction of a lamp's light that the mask O does not occlude. The
 * lamp has power 8 and a radius of RADIUS pixels, and is at (X, Y). */
static double visible_fraction(struct occlusion *o, double x, double y,
                               double radius)
{
    struct glint_lamp lamp = {.power = 8, .rgb = {1, 1, 1}};
    struct glint_engine_lamp known;

    glint_view_to_angles(&view, focal_mm, x, y, &lamp);
    glint_area_set_round(&lamp, radius / sqrt(2) *
                                    glint_view_pixel_tangent(&view, focal_mm));
    known = glint_engine_lamp_of(&lamp, 1);
    known.level = 0.5;
    occlusion_dim_lamps(o, 0, &view, focal_mm, &known, 1);
    assert_true(fabs(known.level - fmax(0.5 * known.lamp.power / 8, 1e-6)) <
                1e-12);
    return known.lamp.power / 8;
}

TEST(mask_occludes_a_fraction_of_a_lamp)
{
    struct occlusion o = make_half_black_mask(SIDE / 2);

    assert_true(fabs(visible_fraction(&o, 200, 100, 20) - 1) < 1e-9);
    assert_true(visible_fraction(&o, 60, 100, 20) == 0);
    assert_true(fabs(visible_fraction(&o, 128, 100, 20) - 0.5) < 0.03);
    /* area of the segment of a disc that is more than half a radius from the
     * centre, as a fraction of the disc */
    assert_true(fabs(visible_fraction(&o, 118, 100, 20) - 0.1955) < 0.04);
    assert_true(fabs(visible_fraction(&o, 128, 100, 0) - 0.5) <
                0.1);                                    /* a point lamp */
    assert_true(visible_fraction(&o, -30, 100, 5) == 1); /* off-screen */
}

/* Checks that a lamp that crosses the edge of a mask fades by small steps. */
TEST(lamp_crossing_a_mask_fades_gradually)
{
    struct occlusion o = make_half_black_mask(SIDE / 2);
    double last = 0;

    for (int i = 0; i <= 120; i++) {
        const double now = visible_fraction(&o, 98 + 0.5 * i, 90, 15);

        assert_true(now >= last - 0.02 && now - last < 0.05);
        last = now;
    }
    assert_true(fabs(last - 1) < 1e-9);
}

TEST(lamp_fades_outside_the_border)
{
    struct occlusion o = {.fade_px = 100};
    double last = 1;

    assert_true(visible_fraction(&o, 10, 10, 5) == 1 &&
                visible_fraction(&o, 256, 256, 0) == 1);
    for (int i = 0; i <= 110; i++) {
        const double now = visible_fraction(&o, 256 + i, 128, 0);

        assert_true(now <= last && last - now < 0.02);
        assert_true(i == 0 || i > 99 || (now > 0 && now < 1));
        last = now;
    }
    assert_true(last == 0);
    assert_true(fabs(visible_fraction(&o, -30, -40, 0) - 0.5) < 1e-9);
}

TEST(no_occlusion_by_default)
{
    struct occlusion o = {.fade_px = 0};

    assert_true(visible_fraction(&o, -500, 10, 5) == 1);
}
