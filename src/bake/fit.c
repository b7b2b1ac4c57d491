/* SPDX-License-Identifier: MIT */
#include "bake/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/compiler.h"
#include "bake/degrees.h"
#include "bake/zone.h"

STATIC_ASSERT((int)GLINT_MAX_TERMS == (int)GLINT_MAX_MODEL_TERMS);

#define PEAK       5.0  /* times the root mean square */
#define LEAST_FILL 0.33 /* of a box; below it the grids waste their cells */
#define FILL_DEG   0.6  /* narrower zones need not care for that */
#define LEAST_DEG  0.7
#define STUCK                                                               \
    0.75              /* half a zone that is left with so much of the whole \
                         one's error gains nothing from halving... */
#define STUCK_DEG 1.2 /* ...once it is this narrow */

struct fitter {
    const struct glint_hunt *hunt;
    const struct glint_tolerance *tolerance;
    struct glint_profile profile;
    struct glint_rays rays, energies;
    glint_zone_survey survey;
    double weight[GLINT_ZONE_RAYS], sensor_weight[GLINT_ZONE_RAYS];
    double channel_weight[GLINT_ZONE_RAYS], value[GLINT_ZONE_RAYS];
    double *scratch;
    struct glint_fitted_ghost *out;
    double sensor_mm, stop, barrel, energy; /* tolerances of this zone */
};

/* ----------------------------------------------------------------- outputs */

static const struct glint_degrees position_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 4},
    .weight = {1, 1, 1, 2},
    .total = 12,
    .terms = GLINT_MAX_TERMS};

static const struct glint_degrees energy_degrees = {.most = {6, 4, 4, 8},
                                                    .weight = {1, 1, 1, 1},
                                                    .total = 10,
                                                    .terms = GLINT_MAX_TERMS};

/* Full weight a little past the edge, where cells straddle it; hardly any where
 * nothing is seen, which only has to stay unseen. */
static double weight_past_edge(double excess)
{
    const double past = (excess - 1.02) / 0.05;

    return past <= 0 ? 1 : fmax(0.002, exp(-past * past));
}

/* Light beyond the field only has to stay there: it may be off by a fifth of
 * how far it is out. */
static double weight_past_field(const struct fitter *f, double fields)
{
    const double out_mm = (fields - 1.01) * f->hunt->field_mm;

    return out_mm <= 0 ? 1 : 1 / (1 + 0.2 * out_mm / f->sensor_mm);
}

/* Light that is seen: where, and how strong on average. */
struct sight {
    int n, n_all;
    double low[3], high[3]; /* sensor x and y, stop x */
    double energy;
};

static struct sight look(const struct glint_rays *r)
{
    static const int channel[3] = {RAY_SENSOR_X, RAY_SENSOR_Y, RAY_STOP_X};
    struct sight s = {.low = {HUGE_VAL, HUGE_VAL, HUGE_VAL},
                      .high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL},
                      .n_all = r->n};

    for (int i = 0; i < r->n; i++) {
        if (r->at[RAY_EXCESS][i] > 1 || r->at[RAY_FIELD][i] > 1)
            continue;
        for (int k = 0; k < 3; k++) {
            s.low[k] = fmin(s.low[k], r->at[channel[k]][i]);
            s.high[k] = fmax(s.high[k], r->at[channel[k]][i]);
        }
        s.energy += r->at[RAY_ENERGY][i];
        s.n++;
    }
    s.energy /= s.n > 0 ? s.n : 1;
    return s;
}

/* How much worse a zone may be than one that is as bright as counts. */
static double ease_of(const struct fitter *f, const struct glint_zone *zone,
                      const struct sight *s)
{
    const double level = glint_brightness_at(f->tolerance->brightness,
                                             0.5 * (zone->lo + zone->hi));
    const double pupil = 4 * zone->half_x[0] * zone->half_y[0] * fmax(s->n, 1) /
                         fmax(s->n_all, 1);
    const double y = fmax(fabs(s->low[1]), fabs(s->high[1])); /* mirrored */
    const double sensor = fmax(1e-9, (s->high[0] - s->low[0]) * 2 * y * 0.8);
    const double share = s->energy * pupil / sensor / fmax(level, 1e-30);

    return s->n ? fmin(f->tolerance->ease, fmax(1, pow(share, -0.42)))
                : f->tolerance->ease;
}

static void set_tolerances(struct fitter *f, const struct glint_zone *zone)
{
    const struct glint_tolerance *t = f->tolerance;
    const struct sight s = look(&f->rays);
    const double ease = ease_of(f, zone, &s);
    const double per_stop =
        s.n > 1 ? (s.high[0] - s.low[0]) / (s.high[2] - s.low[2] + 1e-12) : 0;
    const double edge = ease * t->edge_mm / fmax(1e-12, per_stop);

    f->sensor_mm = fmin(ease * t->sensor_mm, t->faint_sensor_mm);
    f->stop = fmax(0.06 * t->stop, fmin(t->stop, edge));
    f->barrel = fmax(0.06 * t->barrel, fmin(t->barrel, edge));
    f->energy = ease * t->energy;
}

static void set_weights(struct fitter *f)
{
    const struct glint_rays *r = &f->rays;

    for (int i = 0; i < r->n; i++) {
        f->weight[i] = weight_past_edge(r->at[RAY_EXCESS][i]);
        f->sensor_weight[i] =
            f->weight[i] * weight_past_field(f, r->at[RAY_FIELD][i]);
        if (r->at[RAY_FIELD][i] > 1.05)
            f->weight[i] *= 0.1;
    }
}

static enum glint_status keep(struct glint_fitted_system *system,
                              enum glint_channel kind,
                              const struct glint_poly *poly, double rms,
                              bool met)
{
    struct glint_fitted_output *o = &system->output[system->n_outputs];

    o->coef = malloc((size_t)poly->n * sizeof *o->coef);
    if (!o->coef)
        return GLINT_E_MEMORY;
    o->kind = kind;
    o->n_terms = poly->n;
    o->grain = rms / 8; /* a few dozen of these stay below a quarter of it */
    o->met = met;
    memcpy(o->power, poly->power, (size_t)poly->n * sizeof *o->power);
    memcpy(o->coef, poly->coef, (size_t)poly->n * sizeof *o->coef);
    system->n_outputs++;
    return GLINT_OK;
}

/* Fits VALUE over RAYS with CHANNEL_WEIGHT; *WORST becomes what is left, if
 * larger. */
static enum glint_status fit_output(struct fitter *f,
                                    const struct glint_rays *r,
                                    enum glint_channel kind, double rms,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    const struct glint_samples samples = {
        r->n, {r->x[0], r->x[1], r->x[2], r->x[3]}, f->channel_weight};
    struct glint_degrees degrees =
        kind == GLINT_OUT_ENERGY ? energy_degrees : position_degrees;
    struct glint_poly poly;
    double left, grain = rms; /* energy's is a share */

    degrees.parity = kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y;
    left = glint_regress_fit(f->scratch, &samples, f->value, &degrees, rms,
                             PEAK * rms, &poly);
    *worst = fmax(*worst, left);
    if (kind == GLINT_OUT_ENERGY)
        for (int i = 0; i < r->n; i++)
            grain = fmin(grain, rms / f->channel_weight[i]);
    return keep(system, kind, &poly, grain, left <= 1);
}

static enum glint_status fit_channel(struct fitter *f, int channel, double rms,
                                     struct glint_fitted_system *system,
                                     double *worst)
{
    const size_t bytes = (size_t)f->rays.n * sizeof *f->value;

    memcpy(f->value, f->rays.at[channel], bytes);
    memcpy(f->channel_weight,
           channel <= RAY_SENSOR_Y ? f->sensor_weight : f->weight, bytes);
    return fit_output(f, &f->rays, (enum glint_channel)channel, rms, system,
                      worst);
}

/* Energy counts by its share, down to a fiftieth of the most that is
 * seen. */
static enum glint_status
fit_energy(struct fitter *f, struct glint_fitted_system *system, double *worst)
{
    const struct glint_rays *r = &f->energies;
    double most = 1e-30;

    for (int i = 0; i < r->n; i++)
        if (fmax(r->at[RAY_EXCESS][i], r->at[RAY_FIELD][i]) <= 1)
            most = fmax(most, r->at[RAY_ENERGY][i]);
    for (int i = 0; i < r->n; i++) {
        const double out = fmax(r->at[RAY_EXCESS][i], r->at[RAY_FIELD][i]);

        f->value[i] = r->at[RAY_ENERGY][i];
        f->channel_weight[i] = fmax(weight_past_edge(out), 0.001) /
                               fmax(f->value[i], 0.005 * most);
    }
    return fit_output(f, r, GLINT_OUT_ENERGY, f->energy, system, worst);
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
        f->channel_weight[i] = f->weight[i] * fmax(0.05, 1 / (1 + off * off));
    }
    system->output[system->n_outputs].event = r->barrel[barrel];
    return fit_output(f, r, (enum glint_channel)(GLINT_OUT_BARREL_0 + barrel),
                      f->barrel, system, worst);
}

static enum glint_status fit_outputs(struct fitter *f,
                                     const struct glint_zone *zone,
                                     struct glint_fitted_system *system,
                                     double *worst)
{
    enum glint_status status = GLINT_OK;

    set_tolerances(f, zone);
    set_weights(f);
    for (int c = RAY_SENSOR_X; c <= RAY_STOP_Y && status == GLINT_OK; c++)
        status = fit_channel(f, c, c <= RAY_SENSOR_Y ? f->sensor_mm : f->stop,
                             system, worst);
    if (status == GLINT_OK)
        status = fit_energy(f, system, worst);
    for (int b = 0; b < f->rays.n_barrels && status == GLINT_OK; b++)
        status = fit_barrel(f, b, system, worst);
    return status;
}

/* ------------------------------------------------------------------ checks */

/* What may be left of rays that were not fitted, in tolerances. */
#define CHECK_RMS 1.6

/* The root mean square error of one output over the rays that get through, in
 * units of RMS. */
static double check_output(const struct fitter *f,
                           const struct glint_fitted_output *o,
                           const double *value, double rms)
{
    const struct glint_rays *r = &f->rays;
    double sum2 = 0;
    int n = 0;

    for (int i = 0; i < r->n; i++) {
        const double x[GLINT_VARIABLES] = {r->x[0][i], r->x[1][i], r->x[2][i],
                                           r->x[3][i]};
        double error;

        if (r->at[RAY_EXCESS][i] > 1.02 || r->at[RAY_FIELD][i] > 1)
            continue;
        error = glint_poly_at(o->n_terms, o->power, o->coef, x) - value[i];
        sum2 += error * error;
        n++;
    }
    return n ? sqrt(sum2 / n) / rms : 0;
}

/* How much worse than it may be the zone is at rays between those that were
 * fitted: a fit can be good at every node and nowhere else. */
static double check_zone(struct fitter *f, const struct glint_zone *zone,
                         const struct glint_fitted_system *system)
{
    double worst = 0;

    glint_zone_check(zone, f->hunt, &f->rays);
    for (int k = 0; k < system->n_outputs; k++) {
        const struct glint_fitted_output *o = &system->output[k];

        if (o->kind <= GLINT_OUT_STOP_Y)
            worst = fmax(worst, check_output(f, o, f->rays.at[o->kind],
                                             o->kind <= GLINT_OUT_SENSOR_Y
                                                 ? f->sensor_mm
                                                 : f->stop));
    }
    return worst / CHECK_RMS;
}

/* ------------------------------------------------------------------- zones */

static void system_finish(struct glint_fitted_system *system)
{
    for (int k = 0; k < system->n_outputs; k++)
        free(system->output[k].coef);
    free(system->knot);
    free(system->box);
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

/* A zone to be fitted, with a box that follows its colours or one for all; BEFORE
 * is what was left of it at the last attempt. */
struct pending {
    double lo, hi, before;
    bool by_colour;
};

/* Fits a zone; *LEFT becomes how bad it is: at most 1 if good. */
static enum glint_status try_zone(struct fitter *f, const struct pending *p,
                                  struct glint_fitted_system *system,
                                  double *left)
{
    enum glint_status status;
    struct glint_zone zone;

    *system = (struct glint_fitted_system){.ghost = f->hunt->ghost,
                                           .sine_lo = p->lo,
                                           .sine_hi = p->hi,
                                           .wave_lo = f->hunt->wave_lo,
                                           .wave_hi = f->hunt->wave_hi};
    *left = HUGE_VAL;
    glint_zone_init(&zone, &f->profile, p->lo, p->hi, p->by_colour);
    if (!p->by_colour && zone.fill < LEAST_FILL &&
        degrees_between(p->lo, p->hi) > FILL_DEG)
        return GLINT_OK;
    glint_zone_trace(&zone, f->hunt, &f->survey, &f->rays, &f->energies);
    *left = 0;
    status = set_box(system, &zone);
    if (status == GLINT_OK)
        status = fit_outputs(f, &zone, system, left);
    if (status == GLINT_OK)
        *left = fmax(*left, check_zone(f, &zone, system));
    system->met = *left <= 1;
    return status;
}

/* What to do about a zone that is left with LEFT. */
enum next { KEEP, HALVE, COLOURS };

static enum next next_step(const struct pending *p, double left)
{
    const double width = degrees_between(p->lo, p->hi);
    const bool stuck = width < LEAST_DEG ||
                       (left > STUCK * p->before && width < STUCK_DEG);

    if (left <= 1 || p->by_colour)
        return KEEP;
    return stuck && left < HUGE_VAL ? COLOURS : HALVE;
}

/* Zones from the lowest angle up; the upper halves wait on a stack. */
static enum glint_status fit_range(struct fitter *f, const double range[2])
{
    enum { DEEP = 24 }; /* halvings of a sine down to LEAST_DEG: 13 at most */
    struct pending stack[DEEP] = {{range[0], range[1], HUGE_VAL, false}};
    enum glint_status status = GLINT_OK;
    int n = 1;

    glint_hunt_profile(f->hunt, range, &f->profile);
    if (f->profile.n == 0)
        return GLINT_OK;
    while (n > 0 && status == GLINT_OK) {
        struct pending p = stack[--n];
        const double middle = 0.5 * (p.lo + p.hi);
        struct glint_fitted_system system;
        enum next next = KEEP;
        double left;

        status = try_zone(f, &p, &system, &left);
        if (status == GLINT_OK)
            next = next_step(&p, left);
        if (status == GLINT_OK && next == KEEP)
            status = append(f->out, &system);
        if (status != GLINT_OK || next != KEEP)
            system_finish(&system);
        p.before = left;
        if (next == HALVE) {
            stack[n++] = (struct pending){middle, p.hi, left, p.by_colour};
            stack[n++] = (struct pending){p.lo, middle, left, p.by_colour};
        } else if (next == COLOURS) {
            p.by_colour = true;
            stack[n++] = p;
        }
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
