/* SPDX-License-Identifier: MIT
 *
 * Tests the functions of glint sweep that do not measure images: parameters
 * and quality levels.
 */

#include "measure/sweep.h"
#include "support/test.h"

/* Returns a hash of all settings in S except the parameter NAME. */
static uint64_t hash_settings_without(const struct settings *s,
                                      const char *name)
{
    const double all[] = {
        strcmp(name, "grid") ? s->dials.fineness : 0,
        strcmp(name, "quantum") ? s->dials.irradiance_steps : 0,
        strcmp(name, "cull") ? s->dials.cull_codes : 0,
        strcmp(name, "dim") ? s->dials.dim_codes : 0,
        strcmp(name, "whole") ? s->dials.snap_codes_q8 : 0,
        strcmp(name, "half") ? s->dials.flags : 0,
        strcmp(name, "tolerance") ? s->tolerance : 0,
        strcmp(name, "wavelengths") ? s->wavelength_nm[0] : 0,
        strcmp(name, "tile") ? s->options.tile : 0,
        strcmp(name, "apart") ? s->options.apart : 0,
        strcmp(name, "max_lights") ? s->options.max_lights : 0,
    };
    uint64_t hash = 0;

    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        hash = hash * 1000003 + (uint64_t)(all[i] * 4096);
    return hash;
}

/* Checks that setting a parameter to each non-default value changes this
 * parameter and no other. */
TEST(each_parameter_changes_the_settings)
{
    struct sweep_setting standard = {.alone = -1, .quality = -1};
    struct settings plain;

    for (int d = 0; d < n_sweep_parameters; d++)
        standard.value[d] = sweep_parameter[d].standard;
    settings_set_defaults(&plain);
    sweep_apply_setting(&plain, &standard, false);
    for (int d = 0; d < n_sweep_parameters; d++) {
        const struct sweep_parameter *const p = &sweep_parameter[d];
        int has_standard = 0;

        for (int i = 0; i < p->n_values; i++) {
            struct sweep_setting set = standard;
            struct settings other;

            settings_set_defaults(&other);
            set.value[d] = p->value[i];
            sweep_apply_setting(&other, &set, false);
            has_standard |= p->value[i] == p->standard;
            assert_true(hash_settings_without(&other, p->name) ==
                        hash_settings_without(&plain, p->name));
            assert_true((hash_settings_without(&other, "") ==
                         hash_settings_without(&plain, "")) ==
                        (p->value[i] == p->standard));
        }
        assert_true(has_standard);
    }
}

static int is_at_half_resolution(const struct settings *settings)
{
    return glint_dials_half(&settings->dials);
}

/* Checks that better quality levels are never coarser, separately for full and
 * half resolution, and that the middle level has the default settings. */
TEST(better_levels_are_never_coarser)
{
    struct settings last, settings, plain;

    settings_set_defaults(&plain);
    settings_set_defaults(&settings);
    settings_set_quality(&settings, 0.5);
    assert_int_equal(settings.dials.fineness, 64);
    assert_true(settings.quantum == plain.quantum &&
                settings.dials.cull_codes == plain.dials.cull_codes &&
                settings.tolerance == plain.tolerance &&
                settings.options.rays == plain.options.rays);
    settings_set_quality(&settings, 1);
    assert_int_equal(settings.dials.fineness, 256);
    settings_set_defaults(&settings);
    settings_set_defaults(&last);
    settings_set_quality(&last, 0);
    for (int i = 1; i <= 100; i++) {
        settings_set_quality(&settings, i / 100.);
        if (is_at_half_resolution(&settings) ==
            /* Where the resolution changes from half to full, quality levels
             * cannot be compared. */
            is_at_half_resolution(&last)) {
            assert_in_range(settings.dials.fineness, last.dials.fineness,
                            GLINT_MAX_CELLS);
            assert_true(settings.quantum <= last.quantum);
        }
        assert_true(settings.dials.cull_codes <= last.dials.cull_codes);
        assert_true(settings.tolerance <= last.tolerance);
        assert_true(is_at_half_resolution(&settings) <=
                    is_at_half_resolution(&last));
        last = settings;
    }
    assert_true(settings_set_text(&settings, "quality", "0.25") &&
                settings_set_text(&last, "quality", "draft"));
    assert_int_equal(settings.dials.fineness, last.dials.fineness);
    assert_true(settings_set_text(&settings, "quality", "exact"));
    assert_int_equal(settings.options.rays, GLINT_RAYS_EXACT);
    assert_false(settings_set_text(&settings, "quality", "1.01"));
    assert_false(settings_set_text(&settings, "quality", "best"));
}
