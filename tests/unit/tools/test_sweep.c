/* SPDX-License-Identifier: MIT
 *
 * Tests the functions of glint sweep that do not measure images: Pareto
 * fronts, PNG files, parameters and quality levels.
 */
#include "support/rng.h"
#include "measure/plots/plot.h"
#include "measure/sweep.h"
#include "support/test.h"

/* Returns whether A dominates B: A is cheaper and not worse, or better and not
 * more expensive. */
static int point_dominates_point(const double *cost, const double *quality,
                                 int a, int b)
{
    return cost[a] <= cost[b] && quality[a] >= quality[b] &&
           (cost[a] < cost[b] || quality[a] > quality[b]);
}

TEST(pareto_front_matches_hand_computation)
{
    static const double cost[] = {5, 1, 3, 2, 4, 3, 0, 2};
    static const double quality[] = {50, 20, 40, 10, 40, 30, (double)NAN, 35};
    int front[8];

    assert_int_equal(sweep_find_front(cost, quality, 8, front), 4);
    assert_int_equal(front[0], 1);
    assert_int_equal(front[1], 7);
    assert_int_equal(front[2], 2);
    assert_int_equal(front[3], 0);
    assert_int_equal(sweep_find_front(cost, quality, 0, front), 0);
}

/* Checks how many dB a setting is above the line through the quality levels.
 * The settings lie on the line between two levels, above it, at the quality of
 * a level but a higher cost, below the cost of all levels, and between a level
 * at half resolution and one at full resolution. */
TEST(measures_db_above_the_quality_levels)
{
    struct sweep_setting level = {.kind = SWEEP_QUALITY}, halves = level;
    const struct sweep_setting dial = {.kind = SWEEP_ALONE};
    struct sweep_mean mean[] = {
        {&dial, 0.2, 30, 30, 0, false}, {&halves, 0.5, 40, 40, 0, false},
        {&dial, 0.7, 42, 42, 0, false}, {&level, 1, 50, 50, 0, false},
        {&dial, 1.9, 55, 55, 0, false}, {&dial, 2, 56.5, 57, 0, false},
        {&level, 4, 60, 60, 0, false},  {&dial, 4.05, 60.2, 60, 0, false},
        {&dial, 9, 58, 58, 0, false},
    };
    const int n = sizeof mean / sizeof *mean;

    for (int d = 0; d < n_sweep_parameters; d++)
        halves.value[d] = strcmp(sweep_parameter[d].name, "half") == 0;
    assert_true(isinf(sweep_compute_gain_above_front(mean, n, 0)));
    assert_true(fabs(sweep_compute_gain_above_front(mean, n, 2) - 2) < 1e-9);
    assert_true(fabs(sweep_compute_gain_above_front(mean, n, 4) -
                     (5 - 10 * log(1.02 * 1.9) / log(4))) < 1e-9);
    assert_true(fabs(sweep_compute_gain_above_front(mean, n, 5) -
                     (6.5 - 10 * log(1.02 * 2) / log(4))) < 1e-9);
    assert_true(fabs(sweep_compute_gain_above_front(mean, n, 7) - 0.2) < 1e-9);
    assert_true(fabs(sweep_compute_gain_above_front(mean, n, 8) + 2) < 1e-9);
}

/* Checks the Pareto front of many settings: no setting may dominate one on the
 * front, and one on the front must dominate each other setting. Values are few
 * numbers, so that many are equal. */
TEST(pareto_front_of_many_settings)
{
    enum { N = 60 };
    double cost[N], quality[N];
    int front[N];
    uint32_t seed = 1;

    for (int round = 0; round < 200; round++) {
        int on[N] = {0}, n;

        for (int i = 0; i < N; i++) {
            rng_bits32(&seed);
            cost[i] = seed >> 24 & 31;
            quality[i] = seed >> 16 & 31;
        }
        n = sweep_find_front(cost, quality, N, front);
        for (int i = 0; i < n; i++)
            on[front[i]] = 1;
        for (int i = 0; i < N; i++) {
            int is_beaten = 0, is_met = 0;

            for (int k = 0; k < N; k++) {
                is_beaten |= point_dominates_point(cost, quality, k, i);
                is_met |=
                    on[k] && cost[k] == cost[i] && quality[k] == quality[i];
            }
            assert_true(is_beaten ? !on[i] : is_met);
        }
    }
}

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
