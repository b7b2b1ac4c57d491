/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "measure/sweep.h"
#include "options/timed_text.h"

enum { QUALITY_STEPS = 8 };

/* Additional values of --quality, between its QUALITY_STEPS steps. 0.0625: half
 * resolution with finer grids; 0.505: the default with a finer model. */
static const double between_steps[] = {0.0625, 0.505};

enum { GRID, QUANTUM, CULL, DIM, WHOLE, HALF, TOLERANCE };

/* The last list of values of each parameter is used for combinations. Some
 * parameters are not combined: 'apart' and 'max_lights' cost much accuracy for
 * little time; 'wavelengths' costs colour; each value of the tolerance needs a
 * bake; 'tile' does not change the image. A single wavelength is the middle
 * one, drawn in grey. */
/* clang-format off */
const struct sweep_parameter sweep_parameter[] = {
    [GRID] = {"grid", "grid", 64, false, false, 9, 5,
     {256, 192, 128, 96, 64, 48, 32, 24, 16}, {128, 64, 40, 24, 16}, {0}},
    [QUANTUM] = {"quantum", "quantum", 1, false, false, 8, 4,
     {0, 0.25, 0.5, 1, 2, 4, 8, 16}, {0.25, 1, 3, 8}, {0}},
    [CULL] = {"cull", "cull", 0.125, false, false, 7, 2,
     {0, 0.0625, 0.125, 0.25, 0.5, 1, 2}, {0.125, 0.5}, {0}},
    [DIM] = {"dim", "dim", 0, false, true, 7, 0,
     {0, 0.5, 1, 2, 4, 8, 16}, {0}, {0}},
    [WHOLE] = {"whole", "whole", 4, false, false, 6, 2,
     {0, 1, 2, 4, 8, 16}, {1, 4}, {0}},
    [HALF] = {"half", "half", 0, false, false, 2, 2, {0, 1}, {0, 1}, {0}},
    [TOLERANCE] = {"tolerance", NULL, 1, true, false, 3, 0,
     {0.25, 1, 4}, {1}, {0}},
    {"wavelengths", "wavelengths", 3, true, false, 2, 0,
     {3, 1}, {3}, {"650,532,450", "532"}},
    {"tile", "tile", 6, false, false, 3, 0,
     {6, 5, 4}, {6}, {"64", "32", "16"}},
    {"apart", "apart", 0.125, false, true, 4, 0,
     {0.125, 0.5, 2, 8}, {0.125}, {0}},
    {"max_lights", "max-lights", 128, false, true, 4, 0,
     {128, 16, 8, 4}, {128}, {0}},
};
/* clang-format on */
const int n_sweep_parameters = sizeof sweep_parameter / sizeof *sweep_parameter;

typedef char parameters_fit[sizeof sweep_parameter / sizeof *sweep_parameter <=
                                    MAX_PARAMETERS
                                ? 1
                                : -1];

static void set_parameter_value(struct settings *s,
                                const struct sweep_parameter *p, double value)
{
    if (!p->words[0])
        settings_set_number(s, p->option, value);
    for (int i = 0; p->words[0] && i < p->n_values; i++)
        if (p->value[i] == value)
            settings_set_text(s, p->option, p->words[i]);
}

void sweep_apply_setting(struct settings *s, const struct sweep_setting *set,
                         bool opening)
{
    /* Removes the limit of work, which would make the grids coarser. */
    settings_set_number(s, "work", 0);
    if (!opening && set->quality >= 0)
        settings_set_quality(s, set->quality);
    for (int d = 0; d < n_sweep_parameters; d++) {
        const struct sweep_parameter *const p = &sweep_parameter[d];

        if (p->option && (set->quality < 0 || p->opens) &&
            (p->opens || !opening) && set->value[d] != p->standard)
            set_parameter_value(s, p, set->value[d]);
    }
    s->tolerance = set->value[TOLERANCE];
}

/* Copies those parameters that --quality determines from S to VALUE. */
static void read_quality_parameters(const struct settings *s, double *value)
{
    value[GRID] = s->dials.fineness;
    value[QUANTUM] = s->quantum;
    value[CULL] = s->dials.cull_codes;
    value[DIM] = s->dials.dim_codes;
    value[WHOLE] = s->dials.snap_codes_q8 / 256.0;
    value[HALF] = (s->dials.flags & GLINT_DIAL_HALF) != 0;
    value[TOLERANCE] = s->tolerance;
}

/* ------------------------------------------------------------------- points */

static struct sweep_setting make_default_setting(enum sweep_kind kind)
{
    struct sweep_setting set = {.kind = kind, .alone = -1, .quality = -1};

    for (int d = 0; d < n_sweep_parameters; d++)
        set.value[d] = sweep_parameter[d].standard;
    return set;
}

static enum glint_status add_sweep_point(struct sweep *s, int c,
                                         const struct sweep_setting *set)
{
    struct sweep_point *const point =
        text_grow_array(s->point, s->n_points, sizeof *point);

    if (!point)
        return GLINT_E_MEMORY;
    s->point = point;
    point[s->n_points] = (struct sweep_point){.set = *set, .of = c};
    for (int k = 0; k < SWEEP_METRICS; k++)
        point[s->n_points].metric[k] = (double)NAN;
    s->n_points++;
    s->scase[c].n++;
    return GLINT_OK;
}

/* Adds points that differ from the default in one parameter. A small sweep
 * skips parameters that need a bake, and all values but the first and last. */
static enum glint_status add_single_parameter_points(struct sweep *s, int c)
{
    enum glint_status status = GLINT_OK;

    for (int d = 0; d < n_sweep_parameters; d++) {
        const struct sweep_parameter *const p = &sweep_parameter[d];

        if ((p->many_lights && s->scase[c].n_lamps == 1) ||
            (s->small && p->opens))
            continue;
        for (int i = 0; i < p->n_values && status == GLINT_OK; i++) {
            struct sweep_setting set = make_default_setting(SWEEP_ALONE);

            set.alone = d;
            set.value[d] = p->value[i];
            if (p->value[i] != p->standard &&
                (!s->small || i == 0 || i + 1 == p->n_values))
                status = add_sweep_point(s, c, &set);
        }
    }
    return status;
}

/* Adds every combination of values in which at least two parameters differ from
 * the default. */
static enum glint_status add_combined_parameter_points(struct sweep *s, int c)
{
    enum glint_status status = GLINT_OK;
    int at[MAX_PARAMETERS] = {0}, d = 0;

    while (d < n_sweep_parameters && status == GLINT_OK) {
        struct sweep_setting set = make_default_setting(SWEEP_TOGETHER);
        int n_differ = 0;

        for (d = 0; d < n_sweep_parameters; d++)
            if (sweep_parameter[d].n_together > 1) {
                set.value[d] = sweep_parameter[d].together[at[d]];
                n_differ += set.value[d] != sweep_parameter[d].standard;
            }
        if (n_differ > 1)
            status = add_sweep_point(s, c, &set);
        for (d = 0; d < n_sweep_parameters; d++) {
            if (++at[d] <
                (s->small && d > 1 ? 1 : sweep_parameter[d].n_together))
                break;
            at[d] = 0;
        }
    }
    return status;
}

static enum glint_status add_quality_points(struct sweep *s, int c,
                                            double quality)
{
    struct sweep_setting set = make_default_setting(SWEEP_QUALITY);
    struct settings settings = s->base;

    set.quality = quality;
    settings_set_quality(&settings, quality);
    read_quality_parameters(&settings, set.value);
    if (s->small)
        set.value[TOLERANCE] = sweep_parameter[TOLERANCE].standard;
    return add_sweep_point(s, c, &set);
}

static enum glint_status plan_case_points(struct sweep *s, int c)
{
    const struct sweep_setting plain = make_default_setting(SWEEP_STANDARD);
    enum glint_status status = add_sweep_point(s, c, &plain);

    if (status == GLINT_OK)
        status = add_single_parameter_points(s, c);
    if (status == GLINT_OK && s->scase[c].together)
        status = add_combined_parameter_points(s, c);
    for (int i = 0; i <= QUALITY_STEPS && status == GLINT_OK; i++)
        status = add_quality_points(s, c, (double)i / QUALITY_STEPS);
    for (int i = 0; i < 2 && !s->small && status == GLINT_OK; i++)
        status = add_quality_points(s, c, between_steps[i]);
    return status;
}

enum glint_status sweep_plan_points(struct sweep *s)
{
    enum glint_status status = GLINT_OK;

    for (int c = 0; c < s->n_cases && status == GLINT_OK; c++) {
        s->scase[c].first = s->n_points;
        status = plan_case_points(s, c);
    }
    return status;
}

int sweep_find_quality_name_index(const struct sweep_point *p)
{
    const double at = p->set.quality * (GLINT_QUALITY_NAMES - 1);

    return p->set.kind == SWEEP_QUALITY && at == floor(at) ? (int)at : -1;
}
