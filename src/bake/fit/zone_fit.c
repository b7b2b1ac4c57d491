/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/compiler.h"

STATIC_ASSERT((int)GLINT_MAX_TERMS == (int)GLINT_MAX_MODEL_TERMS);

/* Max error of a single ray, as a multiple of the RMS error aimed at. */
#define PEAK 5.0
/* Ratio of max to min energy above which a root of it is fitted. */
#define WIDE_ENERGY 60

/* Outline errors of wide stops show at the rim of a ghost, position errors all
 * over it: a box is divided for outline errors only if they are this many times
 * as large. */
#define RIM 4.0
/* Least tolerance of a barrel, as a fraction of its largest; where light grazes
 * a half sphere a ghost lies within 0.003 of its rim. */
#define LEAST     0.06
#define LEAST_FAR 5e-4
/* For lights beyond GLINT_FAR: leaking rays / visible rays that count as one
 * tolerance of outlines. */
#define LEAK 0.02
/* If a fit missed its tolerance, a second fit is discarded when its error
 * exceeds the first error times this factor. */
#define HARM 1.5

/* ----------------------------------------------------------------- degrees */

enum {
    FEW_TERMS = 64,
    MANY_TERMS = 96, /* terms of each position output in thorough fits */
    PATIENCE = 36    /* number of terms after which a hopeless fit stops */
};

static const struct glint_degrees position_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 4},
    .weight = {1, 1, 1, 2},
    .total = 12,
    .terms = FEW_TERMS};

static const struct glint_degrees energy_degrees = {.most = {6, 4, 4, 8},
                                                    .weight = {1, 1, 1, 1},
                                                    .total = 10,
                                                    .terms = FEW_TERMS};

/* Terms of thorough fits of energies that change a lot over the pupil, and of
 * all energies of wide stops, as films make them swing with angle and
 * wavelength at once. */
static const struct glint_degrees steep_degrees = {.most = {8, 6, 4, 8},
                                                   .weight = {1, 1, 1, 1},
                                                   .total = 12,
                                                   .terms = MANY_TERMS};

/* Terms of skew zones, whose powers of s, p and w are below
 * GLINT_LENS_POWERS and GLINT_LENS_WAVE_POWERS. */
static const struct glint_degrees skew_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 4, 5},
    .weight = {1, 1, 1, 2, 1},
    .total = 10,
    .terms = MANY_TERMS};
static const struct glint_degrees skew_energy_degrees = {
    .most = {8, 8, 4, 6, 4},
    .weight = {1, 1, 1, 1, 1},
    .total = 10,
    .terms = MANY_TERMS};

/* Returns the terms of output KIND in TASK. STEEP: energies change a lot over
 * the pupil. */
static struct glint_degrees degrees_of(const struct glint_zone_task *task,
                                       enum glint_channel kind, bool steep)
{
    const bool energy = kind == GLINT_OUT_ENERGY, wide = task->visible->wide;
    const bool skew = task->zone->skew;
    struct glint_degrees degrees =
        skew      ? energy ? skew_energy_degrees : skew_degrees
        : !energy ? position_degrees
        : task->thorough && (wide || steep) ? steep_degrees
                                            : energy_degrees;

    if (task->thorough && !energy)
        degrees.terms = MANY_TERMS;
    degrees.hopeless = energy ? 0 : task->hopeless;
    degrees.patience = PATIENCE;
    degrees.leaps = wide;
    degrees.parity =
        skew ? -1 : kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y;
    return degrees;
}

/* --------------------------------------------------------------------- fits */

/* One fit: its task and tolerances, memory, and the errors so far. */
struct fit {
    const struct glint_zone_task *task;
    const struct glint_zone_aim *aim;
    struct glint_zone_buffers *buffers;
    struct glint_zone_errors *errors;
};

static bool is_wide(const struct fit *f)
{
    return f->task->visible->wide;
}

/* Returns the factor on the weight of a ray whose relative radius is EXCESS.
 * For wide stops it falls with EXCESS: positions go to infinity towards total
 * reflection, and errors there, which are invisible, would dominate the fit. */
static double far_out(const struct fit *f, double excess)
{
    return !is_wide(f) ? 1 : 1 / (1 + 10 * fmax(0, excess * excess - 1.25));
}

/* Returns the weight of a ray: full up to a little past the edge, as cells
 * straddle it, and nearly 0 far outside, where a ray only has to stay
 * invisible. */
static double weight_past_edge(const struct fit *f, double excess)
{
    const double past = (excess - 1.02) / 0.05;

    return past <= 0 ? 1 : fmax(0.002 * far_out(f, excess), exp(-past * past));
}

/* Returns the factor on the weight of a ray's position for light outside the
 * field, which only has to stay outside: its error may be a fifth of its
 * distance from the field. */
static double weight_past_field(const struct fit *f, double fields)
{
    const double out_mm = (fields - 1.01) * f->task->visible->field_mm;

    return out_mm <= 0 ? 1 : 1 / (1 + 0.2 * out_mm / f->aim->sensor_mm);
}

/* Sets the light of the rays; of round lenses of spheres, 1. */
static void find_light(struct fit *f)
{
    if (glint_zone_by_light(f->task->zone, f->task->visible))
        glint_zone_aim_light(f->task->tolerance, f->task->zone, f->aim,
                             &f->buffers->rays, f->buffers->light);
    else
        for (int i = 0; i < f->buffers->rays.n; i++)
            f->buffers->light[i] = 1;
}

static void set_weights(struct fit *f)
{
    const struct glint_zone_rays *r = &f->buffers->rays;

    find_light(f);
    for (int i = 0; i < r->n; i++) {
        f->buffers->weight[i] = weight_past_edge(f, r->at[RAY_EXCESS][i]);
        f->buffers->sensor_weight[i] =
            f->buffers->weight[i] * f->buffers->light[i] *
            weight_past_field(f, r->at[RAY_FIELD][i]);
        if (r->at[RAY_FIELD][i] > 1.05)
            f->buffers->weight[i] *= 0.1;
    }
}

/* Returns whether the polynomials let ray I pass although the lens, at its own
 * position and at every position beside it, stops the ray by far. */
static bool leaks(const struct glint_zone_rays *r, int i,
                  const struct glint_fitted_system *system, double field_mm)
{
    double x[GLINT_VARIABLES], at[GLINT_OUT_KINDS] = {0};
    bool passes = r->at[RAY_EXCESS][i] > 1.05;

    glint_zone_rays_x(r, i, x);
    for (int k = 0; k < system->n_outputs && passes; k++) {
        const struct glint_fitted_output *o = &system->output[k];

        if (o->kind != GLINT_OUT_ENERGY)
            at[o->kind] = glint_poly_at(o->n_terms, o->power, o->coef, x);
        if (o->kind >= GLINT_OUT_BARREL_0)
            passes = at[o->kind] < 1;
    }
    return passes && hypot(at[GLINT_OUT_STOP_X], at[GLINT_OUT_STOP_Y]) < 1 &&
           hypot(at[GLINT_OUT_SENSOR_X], at[GLINT_OUT_SENSOR_Y]) < field_mm;
}

/* Gives rays that leak enough weight to matter in the next fit. Returns whether
 * there are any. */
static bool stop_leaks(struct fit *f, const struct glint_fitted_system *system)
{
    bool any = false;

    for (int i = 0; i < f->buffers->rays.n; i++)
        if (leaks(&f->buffers->rays, i, system, f->task->visible->field_mm)) {
            f->buffers->weight[i] =
                fmax(f->buffers->weight[i],
                     0.1 * far_out(f, f->buffers->rays.at[RAY_EXCESS][i]));
            any = true;
        }
    return any;
}

/* Returns the number of leaking rays / visible rays. */
static double leaking(const struct fit *f,
                      const struct glint_fitted_system *system)
{
    const struct glint_zone_rays *r = &f->buffers->rays;
    int n = 0, n_seen = 0;

    for (int i = 0; i < r->n; i++) {
        n += leaks(r, i, system, f->task->visible->field_mm);
        n_seen += glint_zone_rays_seen(r, i);
    }
    return n / fmax(1, n_seen);
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
    o->grain = rms / 6; /* a few dozen of these sum up to less than a third of
                           the tolerance */
    o->met = met;
    memcpy(o->power, poly->power, (size_t)poly->n * sizeof *o->power);
    memcpy(o->coef, poly->coef, (size_t)poly->n * sizeof *o->coef);
    system->n_outputs++;
    return GLINT_OK;
}

/* Fits the values in the buffers over the rays R, weighted by channel_weight;
 * returns the residual in tolerances. */
static double fit_poly(struct fit *f, const struct glint_zone_rays *r,
                       enum glint_channel kind, double rms,
                       struct glint_poly *poly)
{
    const struct glint_regress_samples samples = {
        r->n,
        {r->x[0], r->x[1], r->x[2], r->x[3], r->x[4]},
        f->buffers->channel_weight};
    const bool steep = f->task->thorough && kind == GLINT_OUT_ENERGY &&
                       glint_zone_rays_spread(&f->buffers->rays) > GLINT_STEEP;
    const struct glint_degrees degrees = degrees_of(f->task, kind, steep);

    return glint_regress_fit(f->buffers->scratch, &samples, f->buffers->value,
                             &degrees, rms, PEAK * rms, poly);
}

/* Fits one output and adds it to SYSTEM; *WORST becomes its residual if that is
 * larger. */
static enum glint_status fit_output(struct fit *f,
                                    const struct glint_zone_rays *r,
                                    enum glint_channel kind, double rms,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    struct glint_poly poly;
    const double left = fit_poly(f, r, kind, rms, &poly);

    *worst = fmax(*worst, left);
    return keep(system, kind, &poly, rms, left <= 1);
}

/* Returns the factor on the weight of places of ray I. A stop of radius RHO
 * passes only the rays within RHO, and its smaller ghost shows smaller errors.
 * For wide stops the factor accounts for radii down to an eighth of the full
 * radius. */
static double weight_inside(const struct fit *f, int i)
{
    const struct glint_zone_rays *r = &f->buffers->rays;
    const double rho = hypot(r->at[RAY_STOP_X][i], r->at[RAY_STOP_Y][i]);

    return is_wide(f) ? 1 / fmax(0.125, fmin(1, rho)) : 1;
}

static enum glint_status fit_channel(struct fit *f, int channel, double rms,
                                     struct glint_fitted_system *system,
                                     double *worst)
{
    const size_t bytes = (size_t)f->buffers->rays.n * sizeof *f->buffers->value;

    memcpy(f->buffers->value, f->buffers->rays.at[channel], bytes);
    for (int i = 0; i < f->buffers->rays.n; i++)
        f->buffers->channel_weight[i] =
            (channel <= RAY_SENSOR_Y ? f->buffers->sensor_weight
                                     : f->buffers->weight)[i] *
            weight_inside(f, i);
    return fit_output(f, &f->buffers->rays, (enum glint_channel)channel, rms,
                      system, worst);
}

/* Lowers *LEAST and raises *MOST to the energies of visible rays. */
static void energies_of(const struct glint_zone_rays *r, double *least,
                        double *most)
{
    for (int i = 0; i < r->n; i++)
        if (glint_zone_rays_seen(r, i)) {
            *least = fmin(*least, r->at[RAY_ENERGY][i]);
            *most = fmax(*most, r->at[RAY_ENERGY][i]);
        }
}

/* Returns whether energies vary by their wavelength alone, with stacks. */
static bool is_smooth(const struct fit *f, const struct glint_zone_rays *r)
{
    return f->task->stacks && glint_zone_rays_spread(r) <= GLINT_STEEP;
}

/* Returns the min energy that errors are divided by; errors of smaller energies
 * are also divided by it. Two stacks of films let almost no light of some
 * wavelengths into a ghost; for them the min is half of the band's mean. */
static double least_share(const struct fit *f, const struct glint_zone_rays *r,
                          double most)
{
    double sum = 0, n = 1e-9;

    for (int i = 0; i < r->n && f->task->stacks; i++)
        if (glint_zone_rays_seen(r, i))
            sum += r->at[RAY_ENERGY][i], n++;
    return fmax(0.005 * most, is_smooth(f, r) ? 0.5 * sum / n : 0);
}

/* Sets VALUE to the energy, or to its fourth root, and CHANNEL_WEIGHT so that
 * errors count as fractions of the energy, or of least_share() if that is more.
 * Returns the largest weight. */
static double set_energies(struct fit *f, const struct glint_zone_rays *r,
                           double most, bool root)
{
    const double least = least_share(f, r, most);
    double largest = 0;

    for (int i = 0; i < r->n; i++) {
        const double out = fmax(r->at[RAY_EXCESS][i], r->at[RAY_FIELD][i]);
        const double energy = r->at[RAY_ENERGY][i];
        const double share = fmax(energy, least);

        /* The relative error of the root is a quarter of the energy's. */
        f->buffers->value[i] = root ? sqrt(sqrt(energy)) : energy;
        f->buffers->channel_weight[i] =
            fmax(weight_past_edge(f, out), 0.001) /
            (root ? 0.25 * sqrt(sqrt(share)) : share);
        largest = fmax(largest, f->buffers->channel_weight[i]);
    }
    return largest;
}

/* Fits the energy. Towards total reflection it grows a thousandfold, while its
 * fourth root is as smooth as a position. If a coating lets all light of some
 * colour through, the root has a cusp and energy itself is smooth. */
static enum glint_status
fit_energy(struct fit *f, struct glint_fitted_system *system, double *worst)
{
    const struct glint_zone_rays *r =
        f->buffers->energies.n ? &f->buffers->energies : &f->buffers->rays;
    struct glint_fitted_output *o = &system->output[system->n_outputs];
    double least = HUGE_VAL, most = 1e-30, left, grain;
    struct glint_poly poly, other;
    bool root;

    energies_of(r, &least, &most);
    energies_of(&f->buffers->rays, &least, &most);
    root = f->task->thorough && !is_smooth(f, r) && most > WIDE_ENERGY * least;
    grain = f->aim->energy / set_energies(f, r, most, root);
    left = fit_poly(f, r, GLINT_OUT_ENERGY, f->aim->energy, &poly);
    if (root && left > 1) {
        const double other_grain =
            f->aim->energy / set_energies(f, r, most, false);
        const double other_left =
            fit_poly(f, r, GLINT_OUT_ENERGY, f->aim->energy, &other);

        if (other_left < left) {
            root = false;
            left = other_left;
            grain = other_grain;
            poly = other;
        }
    }
    o->roots = root ? 2 : 0;
    o->most = least > most ? 0 : root ? sqrt(sqrt(most)) : most;
    *worst = fmax(*worst, left);
    return keep(system, GLINT_OUT_ENERGY, &poly, fmin(grain, f->aim->energy),
                left <= 1);
}

/* Fits a barrel, with most weight where it cuts. */
static enum glint_status fit_barrel(struct fit *f, int barrel,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    const struct glint_zone_rays *r = &f->buffers->rays;
    double stretch;

    for (int i = 0; i < r->n; i++) {
        const double radius = r->radius[barrel][i];
        const double off = (radius - 1) / 0.15;

        f->buffers->value[i] = 0.5 * (1 + radius * radius);
        f->buffers->channel_weight[i] =
            f->buffers->weight[i] * fmax(0.05, 1 / (1 + off * off));
    }
    stretch = glint_zone_aim_stretch(r, f->buffers->value, NULL, 0.8);
    system->output[system->n_outputs].event = r->barrel[barrel];
    return fit_output(f, r, (enum glint_channel)(GLINT_OUT_BARREL_0 + barrel),
                      glint_zone_aim_outline(
                          f->aim, f->task->visible->far ? LEAST_FAR : LEAST,
                          f->task->barrel, stretch),
                      system, worst);
}

static void drop_outputs(struct glint_fitted_system *system)
{
    while (system->n_outputs > 0)
        free(system->output[--system->n_outputs].coef);
}

static void sum_up(struct fit *f, double energy)
{
    struct glint_zone_errors *const e = f->errors;

    e->shows = fmax(e->places, e->outlines / (is_wide(f) ? RIM : 1));
    e->dims = is_wide(f) ? fmax(e->shows, energy) : e->shows;
    e->worst = fmax(fmax(e->places, e->outlines), energy);
}

/* Returns whether the next step for the zone is the same whatever the errors of
 * the outputs still to be fitted. */
static bool is_decided(const struct fit *f)
{
    const struct glint_zone_task *t = f->task;
    const struct glint_zone_errors *e = f->errors;
    const double left = t->zone->skew ? fmax(e->places, e->outlines)
                        : t->thorough ? e->dims
                                      : e->worst;

    return (t->hopeless > 0 && left > t->hopeless) ||
           (t->settled > 0 && left > t->settled);
}

/* Returns the tolerance of a position on the sensor or in the stop. */
static double tolerance_of(const struct fit *f, int channel)
{
    return channel <= RAY_SENSOR_Y
               ? f->aim->sensor_mm * f->aim->thin[channel - RAY_SENSOR_X]
               : f->aim->stop;
}

static enum glint_status fit_outputs(struct fit *f,
                                     struct glint_fitted_system *system)
{
    struct glint_zone_errors *const e = f->errors;
    enum glint_status status = GLINT_OK;
    double energy = 0;

    *e = (struct glint_zone_errors){.worst = 0};
    for (int c = RAY_SENSOR_X; c <= RAY_STOP_Y && status == GLINT_OK; c++) {
        const bool sensor = c <= RAY_SENSOR_Y;

        status = fit_channel(f, c, tolerance_of(f, c), system,
                             sensor ? &e->places : &e->outlines);
        sum_up(f, 0);
        if (is_decided(f))
            return status;
    }
    if (status == GLINT_OK)
        status = fit_energy(f, system, &energy);
    e->energy = energy;
    sum_up(f, energy);
    for (int b = 0;
         b < f->buffers->rays.n_barrels && status == GLINT_OK && !is_decided(f);
         b++) {
        status = fit_barrel(f, b, system, &e->outlines);
        sum_up(f, energy);
    }
    return status;
}

/* ------------------------------------------------------------------ checks */

/* Largest root mean square error, in tolerances, of rays that were not fitted.
 */
#define CHECK_RMS 1.6

/* Raises the position errors on sensor and stop to the errors at rays between
 * the fitted rays, divided by the CHECK_RMS tolerances allowed there. A fit can
 * be good at every node and nowhere else. */
static void check_zone(struct fit *f, const struct glint_fitted_system *system)
{
    struct glint_zone_errors *const e = f->errors;
    const bool shaped = f->task->visible->shaped;
    const bool by_light = glint_zone_by_light(f->task->zone, f->task->visible);

    glint_zone_check(f->task->zone, f->task->visible, &f->buffers->rays);
    find_light(f);
    for (int k = 0; k < 4 && k < system->n_outputs; k++) {
        const bool sensor = k <= RAY_SENSOR_Y;
        double *const error = sensor ? &e->places : &e->outlines;
        const double left =
            glint_zone_aim_off(&f->buffers->rays, &system->output[k],
                               sensor && by_light ? f->buffers->light : NULL,
                               shaped ? 3 : 1) /
            tolerance_of(f, k);

        *error = fmax(*error, left / CHECK_RMS);
    }
    sum_up(f, e->worst);
}

/* --------------------------------------------------------------------- all */

/* Fits SYSTEM again with new weights. With wide stops, restores the previous
 * fit if leaks cannot be removed without larger visible errors. */
static enum glint_status fit_again(struct fit *f,
                                   struct glint_fitted_system *system)
{
    const struct glint_zone_errors errors = *f->errors;
    struct glint_fitted_system leaky = *system;
    enum glint_status status;

    system->n_outputs = 0;
    status = fit_outputs(f, system);
    if (is_wide(f) &&
        fmax(f->errors->places, f->errors->outlines) >
            fmax(1, HARM * fmax(errors.places, errors.outlines))) {
        drop_outputs(system);
        *system = leaky;
        *f->errors = errors;
    } else {
        drop_outputs(&leaky);
    }
    return status;
}

enum glint_status glint_zone_fit(const struct glint_zone_task *task,
                                 const struct glint_zone_aim *aim,
                                 struct glint_zone_buffers *buffers,
                                 struct glint_fitted_system *system,
                                 struct glint_zone_errors *errors)
{
    struct fit f = {task, aim, buffers, errors};
    enum glint_status status;

    set_weights(&f);
    status = fit_outputs(&f, system);
    if (status != GLINT_OK || is_decided(&f))
        return status;
    if ((task->thorough || errors->worst <= 1) && stop_leaks(&f, system))
        status = fit_again(&f, system);
    if (status == GLINT_OK && task->visible->far)
        errors->outlines = fmax(errors->outlines, leaking(&f, system) / LEAK);
    if (status == GLINT_OK)
        check_zone(&f, system);
    return status;
}
