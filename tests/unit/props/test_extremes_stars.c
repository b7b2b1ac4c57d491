/* SPDX-License-Identifier: MIT
 *
 * Tests extreme starbursts: powers from 2^-20 to 2^30, positions at pixel
 * corners and up to 1000 pixels off-screen, stops of 3 to 64 blades and
 * circular stops.
 */
#include "engine/star/core_table.h"
#include "engine/star/star_tables.h"
#include "support/extreme.h"
#include "support/stars/canvas.h"
#include "support/test.h"

enum { WIDTH = 97, HEIGHT = 83, N = 3 * WIDTH * HEIGHT };

static const int blades[] = {0, 3, 6, 64};
static const double airy_px[] = {0.02, 0.4, 4};

/* Positions of lights: centre and corner of a pixel, corner and sides of the
 * image, and 1000 pixels off two sides. */
static const double place[][2] = {
    {48.5, 41.5},   {48, 41},   {0, 0},      {WIDTH, HEIGHT},
    {WIDTH, 40.25}, {50.75, 0}, {-1000, 40}, {50, 1000 + HEIGHT}};
enum { PLACES = sizeof place / sizeof *place };

static int32_t linear_q20[N];
static uint8_t codes[N], others[N];

/* Draws the star of a light of power 2^POWER_LOG2 at AT. Returns the max
 * relative difference between the image and the star's tables. Ignores
 * differences below one step of a linear image. */
static double measure_max_relative_difference(const struct glint_star_tables *t,
                                              const double at[2],
                                              int power_log2)
{
    double most = 0;

    for (int k = 0; k < N / 3; k++) {
        double rgb[3];

        glint_star_evaluate_far_tables(t, k % WIDTH + 0.5 - at[0],
                                       k / WIDTH + 0.5 - at[1], rgb);
        for (int c = 0; c < 3; c++) {
            const double want = fmin(rgb[c] * exp2(power_log2 + 20), INT32_MAX);

            most =
                fmax(most, fabs(linear_q20[3 * k + c] - want) / (want + 256));
        }
    }
    return most;
}

TEST(distant_star_light_matches_direct_sums)
{
    double most = 0;

    for (int i = 0; i < 12; i++) {
        struct glint_star_tables *t =
            star_canvas_make_tables(blades[i % 4], 7 * i, airy_px[i / 4]);
        struct star_canvas c;

        star_canvas_open(&c, WIDTH, HEIGHT, 5, 1, 1);
        for (int ev = -20; ev <= 30; ev += 10) {
            const double *at = place[PLACES - 1 - i % 2];
            const struct glint_star_light light =
                star_canvas_make_light(at[0], at[1], ev);

            star_canvas_draw_light(&c, t, &light, 1, glint_real_of(0),
                                   GLINT_LINEAR_Q20, linear_q20);
            most = fmax(most, measure_max_relative_difference(t, at, ev));
        }
        star_canvas_close(&c);
        glint_star_tables_free(t);
    }
    assert_at_most("stars: 1000 px beside, 2^-20 to 2^30, against tables", most,
                   0.03, "");
}

/* Checks that the total light of a star does not depend on the position of its
 * light inside the pixel. */
TEST(position_in_the_pixel_keeps_star_light)
{
    static const double within[][2] = {
        {0, 0}, {0.5, 0.5}, {0, 0.5}, {0.25, 0.75}, {0.996, 0.004}};
    double most = 0;

    for (int i = 0; i < 12; i++) {
        struct glint_star_tables *t =
            star_canvas_make_tables(blades[i % 4], 3, airy_px[i / 4] / 4);
        struct star_canvas c;
        double low = HUGE_VAL, high = 0;

        star_canvas_open(&c, WIDTH, HEIGHT, 5, 1, 1);
        for (int k = 0; k < 5; k++) {
            const struct glint_star_light light =
                star_canvas_make_light(48 + within[k][0], 41 + within[k][1], 8);
            double sum = 0;

            star_canvas_draw_light(&c, t, &light, 1, glint_real_of(0),
                                   GLINT_LINEAR_Q20, linear_q20);
            for (int p = 1; p < N; p += 3)
                sum += linear_q20[p];
            low = fmin(low, sum);
            high = fmax(high, sum);
        }
        most = fmax(most, high / low - 1);
        star_canvas_close(&c);
        glint_star_tables_free(t);
    }
    assert_at_most("stars: a light on corners and middles of pixels, its sum",
                   most, 0.005, "");
}

/* Checks that doubling the power lowers no pixel by more than one code, and
 * that an invisible power gives none. */
TEST(more_power_never_darkens_stars)
{
    double most = 0;
    int dark = 0;

    for (int i = 0; i < 4 * PLACES; i++) {
        struct glint_star_tables *t =
            star_canvas_make_tables(blades[i % 4], 1, airy_px[i % 3]);
        struct star_canvas c;

        star_canvas_open(&c, WIDTH, HEIGHT, 5, 1, 1);
        memset(others, 0, sizeof others);
        for (int ev = -20; ev <= 30; ev++) {
            const struct glint_star_light light =
                star_canvas_make_light(place[i / 4][0], place[i / 4][1], ev);

            star_canvas_draw_light(&c, t, &light, 1,
                                   glint_real_of(0.25 / 255 / 12.92),
                                   GLINT_RGB24, codes);
            for (int k = 0; k < N; k++) {
                most = fmax(most, others[k] - codes[k]);
                dark += ev < -12 && codes[k] > 0;
            }
            memcpy(others, codes, sizeof others);
        }
        star_canvas_close(&c);
        glint_star_tables_free(t);
    }
    assert_at_most("stars: codes that fall as power doubles, 2^-20 to 2^30",
                   most, 1, "codes");
    assert_at_most("stars: codes lit below 2^-12", dark, 0, "codes");
}
