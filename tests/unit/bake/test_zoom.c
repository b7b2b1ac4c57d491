/* SPDX-License-Identifier: MIT
 *
 * Checks zoom and focus of lens tables. A table of several positions must equal
 * one table per position. Values between positions are interpolated. A focused
 * lens must have its paraxial focus on the sensor.
 */
#include "support/lens_check.h"

static struct glint_error error;

#define LINE_D_NM 587.5618

static const char *const zooms[] = {"canon-zoom", "nikon-zoom", "itoh-zoom"};
static const char *const ends[] = {"short", "mid", "long"};

static struct glint_prescription zoom, single;

static void load_zoom_lens(const char *name)
{
    char path[64];

    snprintf(path, sizeof path, "zoom/%s", name);
    load_lens(&zoom, path);
}

static void set_zoom_position(double along)
{
    if (glint_prescription_zoom(&zoom, along, &error) != GLINT_OK)
        fail_msg("%s", error.text);
}

static void focus_lens_at_distance(struct glint_prescription *lens,
                                   double metres)
{
    if (glint_prescription_focus(lens, metres, &error) != GLINT_OK)
        fail_msg("%s", error.text);
}

/* Checks that a zoom set to a column of its table equals the lens of the
 * single-position table, bit-identical. */
TEST(zoom_at_a_column_equals_its_table)
{
    for (int k = 0; k < 9; k++) {
        char name[64];

        snprintf(name, sizeof name, "%s-%s", zooms[k / 3], ends[k % 3]);
        load_lens(&single, name);
        load_zoom_lens(zooms[k / 3]);
        set_zoom_position(zoom.zoom.along[k % 3]);
        assert_int_equal(zoom.n_surfaces, single.n_surfaces);
        for (int i = 0; i < zoom.n_surfaces; i++)
            assert_memory_equal(&zoom.surface[i], &single.surface[i],
                                sizeof zoom.surface[i]);
        assert_true(zoom.f_number == single.f_number &&
                    zoom.stop_semi_mm == single.stop_semi_mm &&
                    zoom.stop_thickness_mm == single.stop_thickness_mm &&
                    zoom.stop_after == single.stop_after);
    }
}

/* Checks that focal lengths between the columns of a table are monotonic and
 * the image stays in focus, and that glint_prescription_zoom_to() finds the
 * position of each focal length. */
TEST(focal_length_is_monotone_between_columns)
{
    enum { STEPS = 40 };

    for (int z = 0; z < 3; z++) {
        double before = 0;

        for (int k = 0; k <= STEPS; k++) {
            struct glint_optics optics;
            double along = -1;

            load_zoom_lens(zooms[z]);
            set_zoom_position((double)k / STEPS);
            glint_optics_of(&zoom, &optics);
            assert_true(optics.focal_mm > before);
            before = optics.focal_mm;
            assert_near(zoom.surface[zoom.n_surfaces - 1].thickness_mm,
                        optics.back_focal_mm, 1e-6);
            assert_true(zoom.surface[zoom.n_surfaces - 1].thickness_mm > 20);
            load_zoom_lens(zooms[z]);
            assert_ok(glint_prescription_zoom_to(&zoom, optics.focal_mm, &along,
                                                 &error));
            assert_near(along, (double)k / STEPS, k % STEPS ? 1e-6 : 1e-12);
        }
    }
}

/* Returns the position on the sensor, mm, of a ray through (X, 0) in the vertex
 * plane of the front surface with the slope TANGENT. */
static double trace_ray_to_sensor(const struct glint_prescription *lens,
                                  double x, double tangent)
{
    static struct glint_path path;
    const double size = sqrt(1 + tangent * tangent);
    const double direction[3] = {tangent / size, 0, 1 / size};
    struct glint_ray ray;

    glint_path_init(&path, lens, NULL, LINE_D_NM);
    assert_int_equal(glint_trace(&path, x, 0, direction, &ray, NULL),
                     GLINT_RAY_OK);
    return ray.sensor_x_mm;
}

/* Checks that rays from the focused point meet on the sensor, and that distant
 * light is imaged at the position that scale_mm gives. */
static void check_lens_is_focused(struct glint_prescription *lens,
                                  double metres)
{
    const double h = 1e-3, angle = 1e-5;
    struct glint_optics before, optics;
    double object;

    glint_optics_of(lens, &before);
    focus_lens_at_distance(lens, metres);
    glint_optics_of(lens, &optics);
    object = 1000 * metres - optics.length_mm;
    assert_near(trace_ray_to_sensor(lens, h, h / object), 0,
                1e-7 * h * before.focal_mm);
    assert_true(fabs(trace_ray_to_sensor(lens, h, 0)) > 1e-3 * h);
    assert_near(
        trace_ray_to_sensor(lens, -optics.entrance_z_mm * angle, angle) / angle,
        optics.scale_mm, 1e-4 * optics.scale_mm);
    assert_true(fabs(optics.scale_mm - before.focal_mm) >
                1e-3 * before.focal_mm);
}

TEST(focused_lens_images_the_distance_sharply)
{
    static const double metres[] = {1.5, 5, 30};

    for (int k = 0; k < 3; k++) {
        load_lens(&single, "heliar-tronnier");
        check_lens_is_focused(&single, metres[k]);
        load_lens(&single, "double-gauss-angenieux");
        check_lens_is_focused(&single, metres[k] / 3);
        for (int z = 0; z < 9; z++) {
            load_zoom_lens(zooms[z / 3]);
            set_zoom_position(0.5 * (z % 3));
            check_lens_is_focused(&zoom, metres[k]);
        }
    }
}

/* Checks that Newton's formula, x x' = f^2, holds for a lens that is focused by
 * moving the whole lens. */
TEST(moving_the_lens_obeys_newtons_formula)
{
    struct glint_optics optics;
    double before, moved;

    load_lens(&single, "heliar-tronnier");
    before = single.surface[single.n_surfaces - 1].thickness_mm;
    focus_lens_at_distance(&single, 2);
    moved = single.surface[single.n_surfaces - 1].thickness_mm - before;
    glint_optics_of(&single, &optics);
    /* the front focus lies about one focal length in front of the lens */
    assert_near(optics.focal_mm * optics.focal_mm / moved,
                2000 - optics.length_mm - optics.focal_mm,
                0.5 * optics.focal_mm);
}

/* Checks that a stop in front of the focusing group does not move relative to
 * the sensor. */
TEST(front_stop_keeps_its_distance_to_the_sensor)
{
    static const char text[] =
        "name t\nfilm 36 24\nf-number 10\nstop 5 8\nfocus\n"
        "surface 61.47 6 12 1.5168 64.17\nsurface -44.64 2.5 12 1.6727 32.2\n"
        "surface -129.94 40 12 air\nend\n"
        "surface 300 3 12 1.5168 64.17\nsurface flat 55 12 air\n";
    struct glint_optics optics;
    double before;

    parse_lens_text(&single, text);
    glint_optics_of(&single, &optics);
    before = optics.length_mm + single.stop_thickness_mm;
    focus_lens_at_distance(&single, 3);
    glint_optics_of(&single, &optics);
    assert_true(single.stop_thickness_mm < 4.5);
    assert_near(optics.length_mm + single.stop_thickness_mm, before, 1e-9);
}

/* Checks that lens elements behind a front stop may not intersect: even
 * surfaces whose rims do not touch may not pass through each other's
 * vertices. */
TEST(elements_stay_solid_behind_a_front_stop)
{
    static const char text[] =
        "name t\nfilm 36 24\nf-number 10\nstop 5 8\n"
        "surface 100 4 12 1.5 60\nsurface -100 0.5 12 air\nfocus\n"
        "surface 100 4 12 1.5 60\nsurface -100 47 12 air\nend\n";

    parse_lens_text(&single, text);
    focus_lens_at_distance(&single, 20);
    assert_true(single.surface[1].thickness_mm > 0);
    parse_lens_text(&single, text);
    assert_int_equal(glint_prescription_focus(&single, 3, &error),
                     GLINT_E_ARGUMENT);
    assert_non_null(strstr(error.text, "cannot focus at 3 m"));
}

/* ---------------------------------------------------- zoom lines of tables */

static void expect_rejected(const char *body, const char *cause)
{
    char text[1000];

    snprintf(text, sizeof text, "name t\nfilm 36 24\n%s\n", body);
    assert_int_equal(
        glint_prescription_parse(&single, text, strlen(text), "t.lens", &error),
        GLINT_E_LENS);
    if (!strstr(error.text, cause))
        fail_msg("'%s' does not contain '%s'", error.text, cause);
}

#define FRONT "surface 50 4 12 1.5 60\nsurface -50 "
#define BACK  " 12 air\nsurface 40 4 12 1.5 60\nsurface -60 30 12 air\nstop 5 9"

TEST(rejects_wrong_columns)
{
    expect_rejected("f-number 10\n" FRONT "4/x" BACK,
                    "t.lens:5:15: thickness 'x'");
    expect_rejected("f-number 10\n" FRONT "4//6" BACK, "thickness");
    expect_rejected("f-number 10/11/12\n" FRONT "4/6" BACK,
                    "thickness has 2 positions, but the lines above have 3");
    expect_rejected("f-number 10/11\n" FRONT "4" BACK, "no thickness differs");
    expect_rejected("f-number 10\n" FRONT "4/4" BACK,
                    "focal lengths must only rise or only fall");
    expect_rejected("f-number 10\n" FRONT "1/2/3/4/5/6/7/8/9" BACK,
                    "more than 8 positions");
    expect_rejected("f-number 10\nfocal-length 31/99\n" FRONT "4/6" BACK,
                    "focal-length is");
    expect_rejected("f-number 10\nfocus\n" FRONT "4/6" BACK, "end it above");
    expect_rejected("f-number 10\nfocus\ngroup tilt 1 0\n" FRONT "4/6" BACK,
                    "t.lens:5:1: the group above has no line 'end'");
    expect_rejected("f-number 10\nfocus\nend\n" FRONT "4/6" BACK,
                    "the focusing group has no surface");
}

/* Checks that the lens at a zoom position does not depend on the position set
 * before, even if the table states a single last gap while each column has
 * another focus distance. */
TEST(position_does_not_depend_on_the_previous_one)
{
    static const char text[] =
        "name t\nfilm 36 24\nf-number 10\n" FRONT "4/6/7" BACK;
    struct glint_prescription once;
    const double places[] = {0.3, 0.75, 1, 0.2, 0};

    parse_lens_text(&once, text);
    zoom = once;
    for (int i = 0; i < 5; i++) {
        single = once;
        assert_ok(glint_prescription_zoom(&single, places[i], &error));
        set_zoom_position(places[i]);
        assert_memory_equal(&zoom, &single, sizeof zoom);
    }
}

/* Checks that with two columns f-numbers are interpolated linearly, and that
 * columns may be in descending order of focal length. */
TEST(two_columns_are_interpolated_linearly)
{
    static const char *const texts[] = {
        "name t\nfilm 36 24\nf-number 10/20\n" FRONT "4/6" BACK,
        "name t\nfilm 36 24\nf-number 10/20\n" FRONT "6/4" BACK};

    for (int k = 0; k < 2; k++) {
        struct glint_optics optics;
        double along = -1;

        parse_lens_text(&zoom, texts[k]);
        single = zoom;
        set_zoom_position(0.3);
        assert_near(zoom.f_number, 13, 1e-9);
        glint_optics_of(&zoom, &optics);
        assert_ok(glint_prescription_zoom_to(&single, optics.focal_mm, &along,
                                             &error));
        assert_near(along, 0.3, 1e-6);
    }
}

TEST(rejects_invalid_positions)
{
    double along;

    load_lens(&single, "heliar-tronnier");
    assert_int_equal(glint_prescription_zoom(&single, 0.5, &error),
                     GLINT_E_ARGUMENT);
    assert_non_null(strstr(error.text, "does not zoom"));
    assert_int_equal(glint_prescription_focus(&single, 0.1, &error),
                     GLINT_E_ARGUMENT);
    assert_non_null(strstr(error.text, "only down to 0.2"));
    load_zoom_lens("canon-zoom");
    assert_int_equal(glint_prescription_zoom(&zoom, 1.5, &error),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_prescription_zoom_to(&zoom, 300, &along, &error),
                     GLINT_E_ARGUMENT);
    assert_non_null(strstr(error.text, "from 72.12 mm to 193.9 mm"));
}
