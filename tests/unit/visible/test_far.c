/* SPDX-License-Identifier: MIT
 *
 * Lights beyond 60 degrees: which lenses have the rules for them, and barrels
 * that light of a fisheye grazes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "bake/fit/zone_rays.h"
#include "bake/visible/visible.h"
#include "engine/setup/degrees.h"
#include "support/lens_check.h"

static const double band_nm[2] = {400, 700};
static struct glint_prescription lens;
static struct glint_setup setup;
static struct glint_visible visible;

static void open_ghost(const char *name, double f_number, int ghost,
                       double max_deg)
{
    struct glint_error error = {""};

    load_lens(&lens, name);
    assert_int_equal(glint_prescription_set_f_number(&lens, f_number, &error),
                     GLINT_OK);
    assert_int_equal(glint_setup_init(&setup, &lens, 0, 0, band_nm, 2, &error),
                     GLINT_OK);
    glint_visible_init(&visible, &setup, ghost, 12.65, band_nm);
    glint_visible_reach(&visible, max_deg);
}

static void test_reach(void **state)
{
    static struct glint_visible part;

    (void)state;
    open_ghost("wide/fisheye-zuiko-8", 11, 37, 60);
    assert_false(visible.far || visible.wide);
    open_ghost("wide/fisheye-zuiko-8", 11, 37, 61);
    assert_true(visible.far && visible.wide && !visible.shaped);
    glint_visible_narrow(&part, &visible, -1, 0);
    assert_true(part.far && part.wide);
    open_ghost("anamorphic/anamorphic-schneider", 11, 7, 85);
    assert_false(visible.far);
}

/* Finds the barrels of the ghost, by the rules for FAR lights or not. */
static void choose(bool far, struct glint_zone_rays *rays)
{
    static struct glint_visible_profile profile;
    static glint_zone_sampling sampling;
    const double range[2] = {glint_sin_deg(82.85), glint_sin_deg(83.25)};
    struct glint_zone zone;

    open_ghost("wide/fisheye-zuiko-8", 11, 61, 85);
    glint_visible_profile_find(&visible, range, &profile);
    assert_true(profile.n > 0);
    glint_zone_init(&zone, &profile, range[0], range[1], true);
    visible.far = far;
    glint_zone_choose_barrels(&zone, &visible, 1e-3, &sampling, rays);
}

/* Rays of this ghost pass the second surface, nearly a half sphere, within
 * 0.003 of its rim, and are lost beyond: it stops a part of the light, though
 * no ray gets past by 1e-3. */
static void test_grazed_barrel(void **state)
{
    static struct glint_zone_rays rays;

    (void)state;
    choose(true, &rays);
    assert_int_equal(rays.n_barrels, 1);
    assert_int_equal(visible.path[0].event[rays.barrel[0]].surface, 1);
    choose(false, &rays);
    assert_int_equal(rays.n_barrels, 0);
    assert_true(rays.missed_cut > 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reach),
        cmocka_unit_test(test_grazed_barrel),
    };

    return cmocka_run_group_tests_name("far", tests, NULL, NULL);
}
