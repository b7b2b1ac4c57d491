/* SPDX-License-Identifier: MIT
 *
 * Checks the special rules for lights beyond 60 degrees: for which lenses they
 * apply, and how they treat barrel apertures that the light of a fisheye
 * grazes.
 */
#include "bake/fit/zone_fit.h"
#include "bake/visible/visible.h"
#include "engine/setup/degrees.h"
#include "support/lens_check.h"

static const double band_nm[2] = {400, 700};
static struct glint_prescription lens;
static struct glint_setup setup;
static struct glint_visible visible;
static struct glint_zone zone;

static void open_ghost_of_lens(const char *name, double f_number, int ghost,
                               double max_deg)
{
    struct glint_error error = {""};

    load_lens(&lens, name);
    assert_ok(glint_prescription_set_f_number(&lens, f_number, &error));
    assert_ok(glint_setup_init(&setup, &lens, 0, 0, band_nm, 2, &error));
    glint_visible_init(&visible, &setup, ghost, 12.65, band_nm);
    glint_visible_set_max_angle(&visible, max_deg);
}

TEST(wide_angle_ghosts_are_marked_far)
{
    static struct glint_visible part;

    open_ghost_of_lens("wide/fisheye-zuiko-8", 11, 37, 60);
    assert_false(visible.far || visible.wide);
    open_ghost_of_lens("wide/fisheye-zuiko-8", 11, 37, 61);
    assert_true(visible.far && visible.wide && !visible.shaped);
    glint_visible_narrow_band(&part, &visible, -1, 0);
    assert_true(part.far && part.wide);
    open_ghost_of_lens("anamorphic/anamorphic-schneider", 11, 7, 85);
    assert_false(visible.far);
}

/* Makes the zone of GHOST (its range of angles DEG) and chooses the barrel
 * apertures. FAR: by the rules for lights beyond 60 degrees. */
static void find_barrels_of_zone(int ghost, const double deg[2], bool far,
                                 struct glint_zone_rays *rays)
{
    static struct glint_visible_profile profile;
    static glint_zone_sampling sampling;
    const double range[2] = {glint_sin_deg(deg[0]), glint_sin_deg(deg[1])};

    open_ghost_of_lens("wide/fisheye-zuiko-8", 11, ghost, 85);
    glint_visible_find_profile(&visible, range, &profile);
    assert_true(profile.n > 0);
    glint_zone_init(&zone, &profile, range[0], range[1], true);
    visible.far = far;
    glint_zone_choose_barrels(&zone, &visible, 1e-3, &sampling, rays);
}

enum { GRAZED = 61 };
static const double grazed_deg[2] = {82.85, 83.25};

/* Checks a ghost whose rays strike the second surface, almost a hemisphere, up
 * to 0.003 semi-diameters inside its rim. Rays that miss it are invalid.
 * The barrel aperture there must be found, as it blocks a part of the light,
 * although no ray strikes the surface 1e-3 semi-diameters outside the rim. */
TEST(grazed_barrel_is_found)
{
    static struct glint_zone_rays rays;

    find_barrels_of_zone(GRAZED, grazed_deg, true, &rays);
    assert_int_equal(rays.n_barrels, 1);
    assert_int_equal(visible.path[0].event[rays.barrel[0]].surface, 1);
    find_barrels_of_zone(GRAZED, grazed_deg, false, &rays);
    assert_int_equal(rays.n_barrels, 0);
    assert_true(rays.missed_cut > 1e-4);
}

/* Checks that the barrel aperture that blocks most of the rays that pass the
 * glass is chosen first, even if others block more rays in total. Rays that
 * miss a surface count as outside its rim: here four barrel apertures block all
 * such rays. */
TEST(barrel_that_blocks_most_is_first)
{
    static struct glint_zone_rays rays;
    static const double deg[2] = {80, 84};

    find_barrels_of_zone(24, deg, true, &rays);
    assert_int_equal(visible.path[0].event[rays.barrel[0]].surface, 1);
    assert_true(rays.missed_cut <= 1e-3);
    find_barrels_of_zone(24, deg, false, &rays);
    assert_int_equal(visible.path[0].event[rays.barrel[0]].surface, 8);
}

/* --------------------------------------------------------------------- fits */

/* tolerances of a bake for a sensor 36 mm wide */
static struct glint_brightness brightness;
static const struct glint_tolerance tolerance = {.sensor_mm = 7.5e-4,
                                                 .faint_sensor_mm = 1.3e-3,
                                                 .edge_mm = 7.5e-4,
                                                 .stop = 4.5e-4,
                                                 .stop_least = 2.7e-5,
                                                 .barrel = 4e-4,
                                                 .escape = 1e-3,
                                                 .energy = 1.2e-3,
                                                 .ease = 10,
                                                 .pixel_mm = 0.01875,
                                                 .axis = 1,
                                                 .axis_depth = 4,
                                                 .brightness = &brightness};
static struct glint_zone_buffers buffers;

/* Fits the zone of the grazed barrel aperture. FAR: by the rules for lights
 * beyond 60 degrees. One in STOPPED rays is marked as blocked for a reason that
 * the fit cannot represent; STOPPED 0: none is. */
static void fit_zone_of_grazed_barrel(bool far, int stopped,
                                      struct glint_fitted_system *system,
                                      struct glint_zone_errors *errors)
{
    struct glint_zone_task task = {.zone = &zone,
                                   .visible = &visible,
                                   .tolerance = &tolerance,
                                   .barrel = tolerance.barrel,
                                   .thorough = true};
    struct glint_zone_aim aim;

    glint_brightness_set_angles(&brightness, 85);
    for (int k = 0; k < GLINT_BRIGHTNESS_ANGLES; k++)
        /* far below the brightness of this ghost */
        brightness.level[k] = 1e-9;
    find_barrels_of_zone(GRAZED, grazed_deg, true, &buffers.rays);
    visible.far = far;
    glint_zone_trace_rays(&zone, &visible, &buffers.rays);
    for (int i = 0; stopped && i < buffers.rays.n; i += stopped)
        buffers.rays.at[RAY_EXCESS][i] = 2;
    aim = glint_zone_aim_compute_tolerances(&tolerance, &zone, &buffers.rays);
    *system = (struct glint_fitted_system){.ghost = GRAZED};
    assert_ok(glint_zone_fit_outputs(&task, &aim, &buffers, system, errors));
}

static void free_fitted_system(struct glint_fitted_system *system)
{
    while (system->n_outputs > 0)
        free(system->output[--system->n_outputs].coef);
}

/* Returns the RMS error of the fitted barrel aperture over the rays that graze
 * it. */
static double compute_barrel_rms_error(const struct glint_fitted_system *system)
{
    const struct glint_fitted_output *o =
        &system->output[system->n_outputs - 1];
    static glint_zone_sampling sampling;
    double sum = 0, n = 0;

    glint_zone_choose_barrels(&zone, &visible, tolerance.escape, &sampling,
                              &buffers.rays);
    glint_zone_trace_rays(&zone, &visible, &buffers.rays);
    for (int i = 0; i < buffers.rays.n; i++) {
        const double radius = buffers.rays.radius[0][i];
        double x[GLINT_VARIABLES], off;

        glint_zone_rays_get_coordinates(&buffers.rays, i, x);
        off = glint_poly_evaluate(o->n_terms, o->power, o->coef, x) -
              0.5 * (1 + radius * radius);
        if (fabs(radius - 1) < 0.003) {
            sum += off * off;
            n++;
        }
    }
    assert_true(n > 100);
    return sqrt(sum / n);
}

/* All rays of the ghost pass within 0.003 semi-diameters of the rim of the
 * barrel aperture. Checks that the rules for lights beyond 60 degrees fit this
 * aperture with an RMS error below 1e-5. The rules for lights nearer to the
 * axis must fit it less precisely, as grazed apertures matter little there. */
TEST(grazed_barrel_is_fitted_within_its_margin)
{
    struct glint_fitted_system system;
    struct glint_zone_errors errors;

    for (int far = 0; far < 2; far++) {
        fit_zone_of_grazed_barrel(far, 0, &system, &errors);
        assert_true((compute_barrel_rms_error(&system) < 1e-5) == far);
        free_fitted_system(&system);
    }
}

/* Checks the rules for lights beyond 60 degrees: rays that pass although barrel
 * apertures should block them count as errors of the outline. Here these are a
 * tenth of the visible rays, five times the tolerance. */
TEST(leaking_rays_count_as_outline_errors)
{
    struct glint_fitted_system system;
    struct glint_zone_errors errors;

    fit_zone_of_grazed_barrel(true, 0, &system, &errors);
    assert_true(errors.outlines < 1);
    free_fitted_system(&system);
    fit_zone_of_grazed_barrel(true, 10, &system, &errors);
    assert_near(errors.outlines, 5.5, 0.5);
    free_fitted_system(&system);
    fit_zone_of_grazed_barrel(false, 10, &system, &errors);
    assert_true(errors.outlines < 1);
    free_fitted_system(&system);
}

TEST_OPEN
{
    buffers.scratch = malloc(GLINT_ZONE_SCRATCH * sizeof *buffers.scratch);
    assert_true(buffers.scratch);
}

TEST_CLOSE
{
    free(buffers.scratch);
}
