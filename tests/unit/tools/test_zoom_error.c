/* SPDX-License-Identifier: MIT
 *
 * Errors of a zoom of two lenses that was baked at both ends: lights come from
 * where they are reported to, an end is exact, and the middle is not. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "glint/view.h"
#include "support/test.h"
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

static struct glint_prescription at[3]; /* both ends, and half-way */
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
    if (glint_prescription_parse(&lens, table, sizeof table - 1, "t.lens",
                                 &error) != GLINT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(glint_ghost_list(&lens, NULL, 0), GHOSTS);
    for (int k = 0; k < 3; k++) {
        at[k] = lens;
        if (glint_prescription_zoom(&at[k], k == 2 ? 0.5 : k, &error) !=
            GLINT_OK)
            fail_msg("%s", error.text);
    }
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

/* Sets the errors of ghosts whose first is below 0, with lights up to MAX_DEG,
 * SHIFT of their shares on. The zoom is set to ALONG, as LENS is. */
static void measure_to(double max_deg, const struct glint_prescription *lens,
                       double along, double shift,
                       struct zoom_error error[GHOSTS])
{
    const struct tool tool = {.name = "test"};
    struct glint_error message = {""};

    glint_zoom_set(&zoom, (int32_t)(along * (1 << 30)));
    if (zoom_error_measure(&tool, lens, &zoom, max_deg, shift, GHOSTS, error,
                           &message) != GLINT_OK)
        fail_msg("%s", message.text);
}

static void measure(const struct glint_prescription *lens, double along,
                    double shift, struct zoom_error error[GHOSTS])
{
    measure_to(MAX_DEG, lens, along, shift, error);
}

enum { EACH = 4 }; /* of the angles is measured in any case */

/* Requests the errors of ghost 0; those of the other one are 2. */
static void ask(struct zoom_error error[GHOSTS])
{
    for (int g = 0; g < GHOSTS; g++)
        for (int a = 0; a < ZOOM_ANGLES; a++)
            error[g].of[a] = g == 0 ? -1 : 2;
}

static double largest(const struct zoom_error *error)
{
    double most = 0;

    for (int a = 0; a < ZOOM_ANGLES; a++)
        most = error->of[a] > most ? error->of[a] : most;
    return most;
}

TEST(ends_are_exact)
{
    struct zoom_error end[GHOSTS];

    ask(end);
    measure(&at[0], 0, 0.5, end);
    for (int a = 0; a < ZOOM_ANGLES; a++) {
        /* 49.2 dB, of a model at 50 dB against interpolated exact rays */
        assert_true(end[0].of[a] >= 0 && end[0].of[a] < 1.2e-5);
        assert_true(end[1].of[a] == 2);
    }
}

/* The middle is not. The end of a fraction of the angles is where the next
 * begins. */
TEST(lights_are_shifted)
{
    struct zoom_error begin[GHOSTS], end[GHOSTS];

    ask(begin);
    ask(end);
    measure(&at[2], 0.5, 0, begin);
    measure(&at[2], 0.5, 1, end);
    assert_true(largest(&begin[0]) > 3e-5);
    for (int a = 0; a + EACH < ZOOM_ANGLES; a += EACH)
        assert_true(end[0].of[a] == begin[0].of[a + EACH]);
}

/* Where a ghost ends, here as the model does, angles between those that are
 * measured in any case have the errors of lights that come from there. */
TEST(ends_of_ghosts_are_found)
{
    struct zoom_error halves[GHOSTS], there[GHOSTS];
    int ends = 0;

    ask(halves);
    ask(there);
    measure_to(80, &at[0], 0, 0, halves);
    measure_to(80, &at[0], 0, 0.5, there);
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

/* Lights go up to 1.5 times the half diagonal, here beyond what was baked, so
 * that the last of them show whole ghosts as errors. */
TEST(lights_end_beyond_the_corner)
{
    const double corner_mm = 0.5 * hypot(24, 16);
    struct zoom_error asked[GHOSTS], all[GHOSTS], less[GHOSTS];
    struct glint_optics optics;
    double corner_deg;

    glint_optics_of(&at[0], &optics);
    corner_deg = 180 / GLINT_PI * atan(corner_mm / optics.focal_mm);
    ask(asked);
    ask(all);
    ask(less);
    measure_to(1.5 * corner_deg, &at[0], 0, 0.5, asked);
    measure_to(80, &at[0], 0, 0.5, all);
    measure_to(1.4 * corner_deg, &at[0], 0, 0.5, less);
    assert_memory_equal(asked, all, sizeof all);
    assert_memory_not_equal(asked, less, sizeof all);
}
