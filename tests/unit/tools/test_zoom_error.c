/* SPDX-License-Identifier: MIT
 *
 * Tests the measured error of a zoom lens of two elements that was baked at
 * both ends. Lights must be at the reported angles. The error must be small at
 * the ends and larger half-way.
 */
#include "support/lens_check.h"
#include "zooms/zoom_error.h"

enum { GHOSTS = 2, MAX_DEG = 3 };

static const char table[] = "name t\n"
                            "f-number 20\n"
                            "film 24 16\n"
                            "surface  60    4  12  1.52 60\n"
                            "surface -200  2/8  12  air\n"
                            "stop     6/5  8\n"
                            "surface  90    4  12  1.62 36\n"
                            "surface -90   40/38  12  air\n";

/* the lens at both ends of the zoom, and half-way */
static struct glint_prescription at[3];
static struct glint_bake_model model[2];
static unsigned char *file;
static struct glint_zoom_lens zoom;

TEST_OPEN
{
    static struct glint_prescription lens;
    struct glint_bake_options options;
    struct glint_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";
    size_t bytes;

    glint_bake_defaults(&options);
    options.max_deg = MAX_DEG;
    parse_lens_text(&lens, table);
    assert_int_equal(glint_ghost_list(&lens, NULL, 0), GHOSTS);
    for (int k = 0; k < 3; k++)
        set_lens_at_position(&at[k], &lens, k == 2 ? 0.5 : k);
    for (int k = 0; k < 2; k++) {
        model[k].along_q30 = k << 30;
        if (glint_bake(&at[k], &options, &model[k].data, &model[k].bytes,
                       &report, &error) != GLINT_OK)
            fail_msg("%s", error.text);
    }
    if (glint_bake_zoom(model, 2, &file, &bytes, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    if (glint_zoom_open(&zoom, file, bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
}

TEST_CLOSE
{
    free(model[0].data);
    free(model[1].data);
    free(file);
}

/* Measures the errors of those ghosts whose first error is below 0, at the zoom
 * position ALONG, for the lens table LENS. Lights are at angles up to MAX_DEG,
 * shifted by SHIFT times their spacing. */
static void measure_errors_up_to_angle(double max_deg,
                                       const struct glint_prescription *lens,
                                       double along, double shift,
                                       struct zoom_error error[GHOSTS])
{
    const struct tool tool = {.name = "test"};
    struct glint_error message = {""};

    glint_zoom_set(&zoom, (int32_t)(along * (1 << 30)));
    if (zoom_error_measure_ghosts(&tool, lens, &zoom, max_deg, shift, GHOSTS,
                                  error, &message) != GLINT_OK)
        fail_msg("%s", message.text);
}

static void measure_ghost_errors(const struct glint_prescription *lens,
                                 double along, double shift,
                                 struct zoom_error error[GHOSTS])
{
    measure_errors_up_to_angle(MAX_DEG, lens, along, shift, error);
}

enum { EACH = 4 }; /* one in EACH angles is always measured */

/* Marks the errors of ghost 0 as not yet measured (-1), and the errors of the
 * other ghost as measured (2). */
static void mark_errors_to_measure(struct zoom_error error[GHOSTS])
{
    for (int g = 0; g < GHOSTS; g++)
        for (int a = 0; a < ZOOM_ANGLES; a++)
            error[g].of[a] = g == 0 ? -1 : 2;
}

static double find_max_error_of_angles(const struct zoom_error *error)
{
    double most = 0;

    for (int a = 0; a < ZOOM_ANGLES; a++)
        most = error->of[a] > most ? error->of[a] : most;
    return most;
}

TEST(errors_at_baked_positions_are_small)
{
    struct zoom_error end[GHOSTS];

    mark_errors_to_measure(end);
    measure_ghost_errors(&at[0], 0, 0.5, end);
    for (int a = 0; a < ZOOM_ANGLES; a++) {
        /* 49.2 dB: a model of 50 dB compared with interpolated exact rays */
        assert_true(end[0].of[a] >= 0 && end[0].of[a] < 1.2e-5);
        assert_true(end[1].of[a] == 2);
    }
}

/* Checks that the zoom is not exact half-way, and that the last angle of one
 * interval is the first angle of the next. */
TEST(lights_of_adjacent_intervals_meet)
{
    struct zoom_error begin[GHOSTS], end[GHOSTS];

    mark_errors_to_measure(begin);
    mark_errors_to_measure(end);
    measure_ghost_errors(&at[2], 0.5, 0, begin);
    measure_ghost_errors(&at[2], 0.5, 1, end);
    assert_true(find_max_error_of_angles(&begin[0]) > 3e-5);
    for (int a = 0; a + EACH < ZOOM_ANGLES; a += EACH)
        assert_true(end[0].of[a] == begin[0].of[a + EACH]);
}

/* Checks that additional angles are measured around the angle at which a ghost
 * vanishes. In this test, the ghost vanishes at the same angle in the model. */
TEST(angles_where_ghosts_vanish_are_measured)
{
    struct zoom_error halves[GHOSTS], there[GHOSTS];
    int ends = 0;

    mark_errors_to_measure(halves);
    mark_errors_to_measure(there);
    measure_errors_up_to_angle(80, &at[0], 0, 0, halves);
    measure_errors_up_to_angle(80, &at[0], 0, 0.5, there);
    for (int a = 0; a + EACH < ZOOM_ANGLES; a += EACH) {
        const double *const of = &halves[0].of[a];

        if (of[0] < 1e-6 || of[EACH] > 1e-9)
            continue;
        ends++;
        if (of[EACH / 2] != there[0].of[a])
            fail_msg("%g at angle %d, not %g", of[EACH / 2], a + EACH / 2,
                     there[0].of[a]);
    }
    assert_int_equal(ends, 1);
}

/* Checks that lights are measured up to 1.5 times the half diagonal of the
 * image. The model of this test was baked for smaller angles, so at the last
 * angles the whole light of a ghost is its error. */
TEST(lights_reach_beyond_the_corner)
{
    const double corner_mm = 0.5 * hypot(24, 16);
    struct zoom_error asked[GHOSTS], all[GHOSTS], less[GHOSTS];
    struct glint_optics optics;
    double corner_deg;

    glint_optics_of(&at[0], &optics);
    corner_deg = 180 / GLINT_PI * atan(corner_mm / optics.focal_mm);
    mark_errors_to_measure(asked);
    mark_errors_to_measure(all);
    mark_errors_to_measure(less);
    measure_errors_up_to_angle(1.5 * corner_deg, &at[0], 0, 0.5, asked);
    measure_errors_up_to_angle(80, &at[0], 0, 0.5, all);
    measure_errors_up_to_angle(1.4 * corner_deg, &at[0], 0, 0.5, less);
    assert_memory_equal(asked, all, sizeof all);
    assert_memory_not_equal(asked, less, sizeof all);
}
