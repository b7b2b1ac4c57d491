/* SPDX-License-Identifier: MIT */
#include "bake/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/degrees.h"
#include "bake/zone.h"

#define PEAK       5.0  /* times the root mean square */
#define LEAST_FILL 0.5  /* of a box; below it the grids waste their cells */
#define LEAST_DEG  0.3  /* of a zone */
#define STUCK      0.75 /* half a zone that is left with so much of the whole
                           one's error gains nothing from halving... */
#define STUCK_DEG  2.5  /* ...once it is this narrow */

struct fitter {
    const struct glint_hunt *hunt;
    const struct glint_tolerance *tolerance;
    struct glint_profile profile;
    struct glint_rays rays;
    glint_survey survey;
    double weight[GLINT_ZONE_RAYS], channel_weight[GLINT_ZONE_RAYS],
        value[GLINT_ZONE_RAYS];
    double *scratch;
    struct glint_fitted_ghost *out;
};

/* ----------------------------------------------------------------- outputs */

static const struct glint_degrees position_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 3},
    .weight = {1, 1, 1, 2},
    .total = 10,
    .terms = GLINT_MAX_TERMS};

static const struct glint_degrees energy_degrees = {
    .most = {4, 4, 4, 3}, .weight = {1, 1, 1, 1}, .total = 6, .terms = 30};

/* Full weight a little past the edge, where cells straddle it; hardly any where
 * nothing is seen, which only has to stay unseen. */
static double weight_of(double excess)
{
    const double past = (excess - 1.02) / 0.05;

    return past <= 0 ? 1 : fmax(0.002, exp(-past * past));
}

static enum glint_status keep(struct glint_fitted_system *system,
                              enum glint_channel kind,
                              const struct glint_poly *poly, bool met)
{
    struct glint_fitted_output *o = &system->output[system->n_outputs];

    o->coef = malloc((size_t)poly->n * sizeof *o->coef);
    if (!o->coef)
        return GLINT_E_MEMORY;
    o->kind = kind;
    o->n_terms = poly->n;
    o->met = met;
    memcpy(o->power, poly->power, (size_t)poly->n * sizeof *o->power);
    memcpy(o->coef, poly->coef, (size_t)poly->n * sizeof *o->coef);
    system->n_outputs++;
    return GLINT_OK;
}

/* Fits VALUE with CHANNEL_WEIGHT; *WORST becomes what is left, if larger. */
static enum glint_status fit_output(struct fitter *f,
                                    enum glint_channel kind, double rms,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    const struct glint_rays *r = &f->rays;
    const struct glint_samples samples = {
        r->n, {r->x[0], r->x[1], r->x[2], r->x[3]}, f->channel_weight};
    struct glint_degrees degrees =
        kind == GLINT_OUT_ENERGY ? energy_degrees : position_degrees;
    struct glint_poly poly;
    double left;

    degrees.parity = kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y;
    left = glint_regress_fit(f->scratch, &samples, f->value, &degrees, rms,
                             PEAK * rms, &poly);
    *worst = fmax(*worst, left);
    return keep(system, kind, &poly, left <= 1);
}

static enum glint_status fit_channel(struct fitter *f, int channel, double rms,
                                     struct glint_fitted_system *system,
                                     double *worst)
{
    const size_t bytes = (size_t)f->rays.n * sizeof *f->value;

    memcpy(f->value, f->rays.at[channel], bytes);
    memcpy(f->channel_weight, f->weight, bytes);
    return fit_output(f, (enum glint_channel)channel, rms, system, worst);
}

/* Energy counts by its share. */
static enum glint_status fit_energy(struct fitter *f,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    const struct glint_rays *r = &f->rays;
    double most = 0;

    for (int i = 0; i < r->n; i++)
        if (r->at[RAY_EXCESS][i] <= 1)
            most = fmax(most, r->at[RAY_ENERGY][i]);
    for (int i = 0; i < r->n; i++) {
        f->value[i] = r->at[RAY_ENERGY][i];
        f->channel_weight[i] =
            f->weight[i] / fmax(f->value[i], fmax(0.1 * most, 1e-30));
    }
    return fit_output(f, GLINT_OUT_ENERGY, f->tolerance->energy, system, worst);
}

/* Where the barrel cuts is what counts. */
static enum glint_status fit_barrel(struct fitter *f, int barrel,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    const struct glint_rays *r = &f->rays;

    for (int i = 0; i < r->n; i++) {
        const double radius = r->radius[barrel][i];
        const double off = (radius - 1) / 0.15;

        f->value[i] = 0.5 * (1 + radius * radius);
        f->channel_weight[i] =
            f->weight[i] * fmax(0.05, 1 / (1 + off * off));
    }
    return fit_output(f, (enum glint_channel)(GLINT_OUT_BARREL_0 + barrel),
                      f->tolerance->barrel, system, worst);
}

static enum glint_status fit_outputs(struct fitter *f,
                                     struct glint_fitted_system *system,
                                     double *worst)
{
    const struct glint_tolerance *t = f->tolerance;
    enum glint_status status = GLINT_OK;

    for (int i = 0; i < f->rays.n; i++)
        f->weight[i] = weight_of(f->rays.at[RAY_EXCESS][i]);
    for (int c = RAY_SENSOR_X; c <= RAY_STOP_Y && status == GLINT_OK; c++)
        status = fit_channel(f, c, c <= RAY_SENSOR_Y ? t->sensor_mm : t->stop,
                             system, worst);
    if (status == GLINT_OK)
        status = fit_energy(f, system, worst);
    for (int b = 0; b < f->rays.n_barrels && status == GLINT_OK; b++)
        status = fit_barrel(f, b, system, worst);
    return status;
}

/* ------------------------------------------------------------------- zones */

static void system_finish(struct glint_fitted_system *system)
{
    for (int k = 0; k < system->n_outputs; k++)
        free(system->output[k].coef);
    free(system->knot);
    free(system->box);
}

void glint_fitted_finish(struct glint_fitted_ghost *ghost)
{
    for (int k = 0; k < ghost->n_systems; k++)
        system_finish(&ghost->system[k]);
    free(ghost->system);
}

static enum glint_status append(struct glint_fitted_ghost *ghost,
                                const struct glint_fitted_system *system)
{
    const size_t n = (size_t)ghost->n_systems;
    struct glint_fitted_system *all =
        realloc(ghost->system, (n + 1) * sizeof *all);

    if (!all)
        return GLINT_E_MEMORY;
    all[ghost->n_systems++] = *system;
    ghost->system = all;
    return GLINT_OK;
}

static enum glint_status set_box(struct glint_fitted_system *system,
                                 const struct glint_zone *zone)
{
    const size_t bytes = GLINT_BOX_TERMS * sizeof(double);

    system->box = malloc(3 * bytes);
    if (!system->box)
        return GLINT_E_MEMORY;
    memcpy(system->box, zone->middle, bytes);
    memcpy(system->box + GLINT_BOX_TERMS, zone->half_x, bytes);
    memcpy(system->box + 2 * GLINT_BOX_TERMS, zone->half_y, bytes);
    return GLINT_OK;
}

static double degrees_between(double lo, double hi)
{
    return (asin(hi) - asin(lo)) * (180 / GLINT_PI);
}

/* A zone to be fitted; BEFORE is what was left of the one it is half of. */
struct pending {
    double lo, hi, before;
};

/* Fits a zone. *DONE: it is kept, because it is good or because halving does
 * not help; else *LEFT says how bad it was. */
static enum glint_status fit_zone(struct fitter *f, const struct pending *p,
                                  bool *done, double *left)
{
    const bool least = degrees_between(p->lo, p->hi) < 2 * LEAST_DEG;
    struct glint_fitted_system system = {
        .ghost = f->hunt->ghost,
        .sine_lo = p->lo,
        .sine_hi = p->hi,
        .wave_lo = f->hunt->wave_lo,
        .wave_hi = f->hunt->wave_hi};
    struct glint_zone zone;
    enum glint_status status;

    *done = false;
    *left = HUGE_VAL;
    glint_zone_init(&zone, &f->profile, p->lo, p->hi);
    if (zone.fill < LEAST_FILL && !least)
        return GLINT_OK;
    glint_zone_trace(&zone, f->hunt, &f->survey, &f->rays);
    *left = 0;
    status = set_box(&system, &zone);
    if (status == GLINT_OK)
        status = fit_outputs(f, &system, left);
    system.met = *left <= 1;
    *done = system.met || least ||
            (*left > STUCK * p->before &&
             degrees_between(p->lo, p->hi) < STUCK_DEG);
    if (status == GLINT_OK && *done)
        status = append(f->out, &system);
    if (status != GLINT_OK || !*done)
        system_finish(&system);
    return status;
}

/* Zones from the lowest angle up; the upper halves wait on a stack. */
static enum glint_status fit_range(struct fitter *f, const double range[2])
{
    enum { DEEP = 24 }; /* halvings from 90 degrees down to LEAST_DEG: 10 */
    struct pending stack[DEEP] = {{range[0], range[1], HUGE_VAL}};
    enum glint_status status = GLINT_OK;
    int n = 1;

    glint_hunt_profile(f->hunt, range, &f->profile);
    if (f->profile.n == 0)
        return GLINT_OK;
    while (n > 0 && status == GLINT_OK) {
        const struct pending p = stack[--n];
        const double middle = 0.5 * (p.lo + p.hi);
        double left;
        bool done;

        status = fit_zone(f, &p, &done, &left);
        if (done)
            continue;
        stack[n++] = (struct pending){middle, p.hi, left};
        stack[n++] = (struct pending){p.lo, middle, left};
    }
    return status;
}

enum glint_status glint_fit_ghost(const struct glint_hunt *hunt, double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  struct glint_fitted_ghost *out)
{
    struct fitter *f = malloc(sizeof *f);
    enum glint_status status = GLINT_E_MEMORY;
    double range[GLINT_MAX_RANGES][2];

    *out = (struct glint_fitted_ghost){0};
    if (!f)
        return status;
    f->hunt = hunt;
    f->tolerance = tolerance;
    f->out = out;
    f->scratch =
        malloc(glint_regress_doubles(GLINT_ZONE_RAYS) * sizeof *f->scratch);
    if (f->scratch) {
        const int n = glint_hunt_ranges(hunt, max_deg, range);

        status = GLINT_OK;
        for (int k = 0; k < n && status == GLINT_OK; k++)
            status = fit_range(f, range[k]);
    }
    free(f->scratch);
    free(f);
    return status;
}
