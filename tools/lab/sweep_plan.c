/* SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "lab/sweep.h"
#include "options/timed_text.h"

enum { QUALITY_STEPS = 8 };

/* Values of --quality between its QUALITY_STEPS steps: half as many pixels with
 * finer grids, and the default with a finer model. */
static const double between_steps[] = {0.0625, 0.505};

static struct sweep_setting standard(enum sweep_kind kind)
{
    struct sweep_setting set = {.kind = kind, .dial = -1, .quality = -1};

    for (int d = 0; d < n_dials; d++)
        set.value[d] = dials[d].standard;
    return set;
}

static enum glint_status add(struct sweep *s, int c,
                             const struct sweep_setting *set)
{
    struct sweep_point *const point =
        text_grow(s->point, s->n_points, sizeof *point);

    if (!point)
        return GLINT_E_MEMORY;
    s->point = point;
    s->point[s->n_points++] =
        (struct sweep_point){.set = *set, .of = c, .picture = -1};
    s->scase[c].n++;
    return GLINT_OK;
}

/* Checks whether dial D is turned in case C. A small sweep has no time for
 * dials that need a bake. */
static bool is_swept(const struct sweep *s, const struct sweep_case *c,
                     const struct dial *d)
{
    return (!d->many_lights || c->n_lamps > 1) && !(s->small && d->opens);
}

static enum glint_status add_alone(struct sweep *s, int c)
{
    enum glint_status status = GLINT_OK;

    for (int d = 0; d < n_dials; d++)
        for (int i = 0; i < dials[d].n_values && status == GLINT_OK; i++) {
            struct sweep_setting set = standard(SWEEP_ALONE);

            if (!is_swept(s, &s->scase[c], &dials[d]) ||
                dials[d].value[i] == dials[d].standard ||
                (s->small && i > 0 && i + 1 < dials[d].n_values))
                continue;
            set.dial = d;
            set.value[d] = dials[d].value[i];
            status = add(s, c, &set);
        }
    return status;
}

/* Adds every combination of values in which at least two dials differ from the
 * standard. */
static enum glint_status add_together(struct sweep *s, int c)
{
    enum glint_status status = GLINT_OK;
    int at[MAX_DIALS] = {0}, d = 0;

    while (d < n_dials && status == GLINT_OK) {
        struct sweep_setting set = standard(SWEEP_TOGETHER);
        int n_differ = 0;

        for (d = 0; d < n_dials; d++)
            if (dials[d].n_together > 1) {
                set.value[d] = dials[d].together[at[d]];
                n_differ += set.value[d] != dials[d].standard;
            }
        if (n_differ > 1)
            status = add(s, c, &set);
        for (d = 0; d < n_dials; d++) {
            const int n = s->small && d > 1 ? 1 : dials[d].n_together;

            if (++at[d] < n)
                break;
            at[d] = 0;
        }
    }
    return status;
}

/* Adds the values that --quality QUALITY gives the dials. */
static enum glint_status add_quality(struct sweep *s, int c, double quality)
{
    struct sweep_setting set = standard(SWEEP_QUALITY);
    struct settings settings = s->base;

    for (int d = 0; d < n_dials; d++)
        dial_set(&settings, &dials[d], dials[d].standard);
    set.quality = quality;
    settings_set_quality(&settings, quality);
    for (int d = 0; d < n_dials; d++)
        if (!s->small || !dials[d].opens)
            set.value[d] = dial_get(&settings, &dials[d]);
    return add(s, c, &set);
}

static enum glint_status add_ladder(struct sweep *s, int c)
{
    enum glint_status status = GLINT_OK;

    for (int i = 0; i <= QUALITY_STEPS && status == GLINT_OK; i++)
        status = add_quality(s, c, (double)i / QUALITY_STEPS);
    for (int i = 0; i < 2 && !s->small && status == GLINT_OK; i++)
        status = add_quality(s, c, between_steps[i]);
    return status;
}

static enum glint_status plan_case(struct sweep *s, int c)
{
    const struct sweep_case *k = &s->scase[c];
    const struct sweep_setting plain =
        standard(k->growth ? SWEEP_GROWTH : SWEEP_STANDARD);
    enum glint_status status = add(s, c, &plain);

    if (k->growth)
        return status;
    if (status == GLINT_OK)
        status = add_alone(s, c);
    if (status == GLINT_OK && k->together)
        status = add_together(s, c);
    return status == GLINT_OK ? add_ladder(s, c) : status;
}

enum glint_status sweep_plan(struct sweep *s)
{
    enum glint_status status = GLINT_OK;

    for (int c = 0; c < s->n_cases && status == GLINT_OK; c++) {
        s->scase[c].first = s->n_points;
        status = plan_case(s, c);
    }
    return status;
}

void sweep_words(const struct sweep_setting *set, char *text, size_t bytes)
{
    size_t used = 0;

    text[0] = '\0';
    if (set->quality >= 0)
        used = (size_t)snprintf(text, bytes, "quality %g", set->quality);
    for (int d = 0; d < n_dials && used < bytes; d++)
        if (set->value[d] != dials[d].standard)
            used += (size_t)snprintf(text + used, bytes - used, "%s%s %g",
                                     used ? ", " : "", dials[d].name,
                                     set->value[d]);
    if (!used)
        snprintf(text, bytes, "default");
}
