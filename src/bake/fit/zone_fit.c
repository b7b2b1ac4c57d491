/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/fit/critical.h"
#include "base/compiler.h"

STATIC_ASSERT((int)GLINT_MAX_TERMS == (int)GLINT_MAX_MODEL_TERMS);

/* max error of a single ray / RMS tolerance */
#define PEAK 5.0
/* min ratio of max to min energy at which a root of the energy is fitted */
#define WIDE_ENERGY 60

/* Fast lenses: outline errors are visible only at the rim of a ghost, position
 * errors everywhere. A box is divided because of outline errors only if they
 * are this many times as large. */
#define RIM 4.0
/* Min tolerance of a barrel / its max tolerance. LEAST_FAR: the same for lights
 * farther off the axis than GLINT_FAR degrees, whose light grazes a
 * hemispherical surface, so that the whole ghost lies within 0.003 of its
 * rim. */
#define LEAST     0.06
#define LEAST_FAR 5e-4
/* For lights farther off the axis than GLINT_FAR degrees: ratio of leaking rays
 * to visible rays that counts as an outline error of one tolerance. Leaking:
 * transmitted by the polynomials although the lens blocks the ray. */
#define LEAK 0.02
/* The second fit is discarded if its error is above one tolerance and above
 * this many times the first fit's error. */
#define HARM 1.5

/* CRITICAL: tolerance of the barrel at a critical angle / max tolerance of
 * barrels. MOST_CRITICAL: max error of such a barrel, in tolerances. */
#define CRITICAL      0.1
#define MOST_CRITICAL 5.0

/* ----------------------------------------------------------------- degrees */

enum {
    FEW_TERMS = 64,
    /* max number of terms of a position output in thorough fits */
    MANY_TERMS = 96,
    /* number of terms after which a fit stops if its error is far too large */
    PATIENCE = 36
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

/* Terms for thorough fits of energies that vary strongly over the pupil, and
 * for all thorough energy fits of fast lenses, where films make the energy
 * oscillate with angle and wavelength. */
static const struct glint_degrees steep_degrees = {.most = {8, 6, 4, 8},
                                                   .weight = {1, 1, 1, 1},
                                                   .total = 12,
                                                   .terms = MANY_TERMS};

/* Terms for skew zones; powers of s, p and w are below GLINT_LENS_POWERS and
 * GLINT_LENS_WAVE_POWERS. */
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

/* Returns the allowed terms for output KIND. STEEP: the energy varies strongly
 * over the pupil. */
static struct glint_degrees
choose_allowed_terms(const struct glint_zone_task *task,
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

/* state of one fit: task, tolerances, memory, and errors so far */
struct fit {
    const struct glint_zone_task *task;
    const struct glint_zone_aim *aim;
    struct glint_zone_buffers *buffers;
    struct glint_zone_errors *errors;
};

static bool is_fast_lens(const struct fit *f)
{
    return f->task->visible->wide;
}

/* Returns a factor on the weight of a blocked ray whose max relative radius is
 * EXCESS. For fast lenses it decreases with EXCESS: towards total reflection
 * positions diverge, and the large errors there, which are invisible, would
 * dominate the fit. */
static double compute_blocked_ray_weight(const struct fit *f, double excess)
{
    return !is_fast_lens(f) ? 1
                            : 1 / (1 + 10 * fmax(0, excess * excess - 1.25));
}

/* Returns the weight of a ray whose max relative radius is EXCESS: 1 up to
 * slightly outside the edge, as grid cells straddle it; nearly 0 far outside,
 * where the polynomials only have to keep the ray invisible. */
static double compute_edge_weight(const struct fit *f, double excess)
{
    const double past = (excess - 1.02) / 0.05;

    return past <= 0 ? 1
                     : fmax(0.002 * compute_blocked_ray_weight(f, excess),
                            exp(-past * past));
}

/* Returns a factor on the weight of the position of a ray that hits the sensor
 * plane FIELDS field radii from the centre. Rays outside the field only have to
 * stay outside: their error may be 1/5 of their distance from the field. */
static double compute_field_weight(const struct fit *f, double fields)
{
    const double out_mm = (fields - 1.01) * f->task->visible->field_mm;

    return out_mm <= 0 ? 1 : 1 / (1 + 0.2 * out_mm / f->aim->sensor_mm);
}

/* Sets the brightness weights of all rays; 1 for round lenses with spherical
 * surfaces. */
static void set_brightness_weights(struct fit *f)
{
    if (glint_zone_is_weighted_by_brightness(f->task->zone, f->task->visible))
        glint_zone_aim_set_ray_brightness(f->task->tolerance, f->task->zone,
                                          f->aim, &f->buffers->rays,
                                          f->buffers->light);
    else
        for (int i = 0; i < f->buffers->rays.n; i++)
            f->buffers->light[i] = 1;
}

static void set_ray_weights(struct fit *f)
{
    const struct glint_zone_rays *r = &f->buffers->rays;

    set_brightness_weights(f);
    for (int i = 0; i < r->n; i++) {
        f->buffers->weight[i] = compute_edge_weight(f, r->at[RAY_EXCESS][i]);
        f->buffers->sensor_weight[i] =
            f->buffers->weight[i] * f->buffers->light[i] *
            compute_field_weight(f, r->at[RAY_FIELD][i]);
        if (r->at[RAY_FIELD][i] > 1.05)
            f->buffers->weight[i] *= 0.1;
    }
}

/* Returns whether the polynomials transmit the ray at the zone coordinates X to
 * the field. */
static bool is_ray_transmitted(const struct glint_fitted_system *system,
                               const double x[GLINT_VARIABLES], double field_mm)
{
    double at[GLINT_OUT_KINDS] = {0};
    bool passes = true;

    for (int k = 0; k < system->n_outputs && passes; k++) {
        const struct glint_fitted_output *o = &system->output[k];

        if (o->kind != GLINT_OUT_ENERGY)
            at[o->kind] = glint_poly_evaluate(o->n_terms, o->power, o->coef, x);
        if (o->kind >= GLINT_OUT_BARREL_0)
            passes = at[o->kind] < 1;
    }
    return passes && hypot(at[GLINT_OUT_STOP_X], at[GLINT_OUT_STOP_Y]) < 1 &&
           hypot(at[GLINT_OUT_SENSOR_X], at[GLINT_OUT_SENSOR_Y]) < field_mm;
}

/* Returns whether the polynomials transmit ray I although the lens clearly
 * blocks it at this and all neighbouring zoom positions. FIELD_MM: radius of
 * the field. */
static bool is_leaking_ray(const struct glint_zone_rays *r, int i,
                           const struct glint_fitted_system *system,
                           double field_mm)
{
    double x[GLINT_VARIABLES];

    glint_zone_rays_get_coordinates(r, i, x);
    return r->at[RAY_EXCESS][i] > 1.05 &&
           is_ray_transmitted(system, x, field_mm);
}

/* Increases the weights of leaking rays, so that the next fit blocks them.
 * Returns whether any ray leaks. */
static bool raise_leaking_ray_weights(struct fit *f,
                                      const struct glint_fitted_system *system)
{
    bool any = false;

    for (int i = 0; i < f->buffers->rays.n; i++)
        if (is_leaking_ray(&f->buffers->rays, i, system,
                           f->task->visible->field_mm)) {
            f->buffers->weight[i] =
                fmax(f->buffers->weight[i],
                     0.1 * compute_blocked_ray_weight(
                               f, f->buffers->rays.at[RAY_EXCESS][i]));
            any = true;
        }
    return any;
}

/* Returns the number of leaking rays / number of visible rays. */
static double
compute_leaking_ray_ratio(const struct fit *f,
                          const struct glint_fitted_system *system)
{
    const struct glint_zone_rays *r = &f->buffers->rays;
    int n = 0, n_seen = 0;

    for (int i = 0; i < r->n; i++) {
        n += is_leaking_ray(r, i, system, f->task->visible->field_mm);
        n_seen += glint_zone_rays_is_visible(r, i);
    }
    return n / fmax(1, n_seen);
}

static enum glint_status
append_fitted_output(struct glint_fitted_system *system,
                     enum glint_channel kind, const struct glint_poly *poly,
                     double rms, bool met)
{
    struct glint_fitted_output *o = &system->output[system->n_outputs];

    o->coef = malloc((size_t)poly->n * sizeof *o->coef);
    if (!o->coef)
        return GLINT_E_MEMORY;
    o->kind = kind;
    o->n_terms = poly->n;
    /* rounding errors of a few dozen coefficients then add up to less than 1/3
     * of the tolerance */
    o->grain = rms / 6;
    o->met = met;
    memcpy(o->power, poly->power, (size_t)poly->n * sizeof *o->power);
    memcpy(o->coef, poly->coef, (size_t)poly->n * sizeof *o->coef);
    system->n_outputs++;
    return GLINT_OK;
}

/* Fits a polynomial to buffers->value for the rays R, weighted by
 * channel_weight. RMS: tolerance. Returns the residual in tolerances. */
static double fit_polynomial(struct fit *f, const struct glint_zone_rays *r,
                             enum glint_channel kind, double rms,
                             struct glint_poly *poly)
{
    const struct glint_regress_samples samples = {
        r->n,
        {r->x[0], r->x[1], r->x[2], r->x[3], r->x[4]},
        f->buffers->channel_weight};
    const bool steep =
        f->task->thorough && kind == GLINT_OUT_ENERGY &&
        glint_zone_rays_compute_energy_ratio(&f->buffers->rays) > GLINT_STEEP;
    const struct glint_degrees degrees =
        choose_allowed_terms(f->task, kind, steep);

    return glint_regress_fit_polynomial(f->buffers->scratch, &samples,
                                        f->buffers->value, &degrees, rms,
                                        PEAK * rms, poly);
}

/* Fits output KIND and appends it to SYSTEM. Raises *WORST to its residual, in
 * tolerances. */
static enum glint_status
fit_and_append_output(struct fit *f, const struct glint_zone_rays *r,
                      enum glint_channel kind, double rms,
                      struct glint_fitted_system *system, double *worst)
{
    struct glint_poly poly;
    const double left = fit_polynomial(f, r, kind, rms, &poly);

    *worst = fmax(*worst, left);
    return append_fitted_output(system, kind, &poly, rms, left <= 1);
}

/* Returns a factor on the weight of the position of ray I. A stop of radius rho
 * transmits only rays within rho; its ghost is smaller, so smaller errors are
 * visible. For fast lenses the factor accounts for stops down to 1/8 of the
 * full radius. */
static double compute_stop_weight(const struct fit *f, int i)
{
    const struct glint_zone_rays *r = &f->buffers->rays;
    const double rho = hypot(r->at[RAY_STOP_X][i], r->at[RAY_STOP_Y][i]);

    return is_fast_lens(f) ? 1 / fmax(0.125, fmin(1, rho)) : 1;
}

static enum glint_status
fit_position_channel(struct fit *f, int channel, double rms,
                     struct glint_fitted_system *system, double *worst)
{
    const size_t bytes = (size_t)f->buffers->rays.n * sizeof *f->buffers->value;

    memcpy(f->buffers->value, f->buffers->rays.at[channel], bytes);
    for (int i = 0; i < f->buffers->rays.n; i++)
        f->buffers->channel_weight[i] =
            (channel <= RAY_SENSOR_Y ? f->buffers->sensor_weight
                                     : f->buffers->weight)[i] *
            compute_stop_weight(f, i);
    return fit_and_append_output(
        f, &f->buffers->rays, (enum glint_channel)channel, rms, system, worst);
}

/* Extends the range *LEAST .. *MOST by the energies of all visible rays. */
static void extend_energy_range(const struct glint_zone_rays *r, double *least,
                                double *most)
{
    for (int i = 0; i < r->n; i++)
        if (glint_zone_rays_is_visible(r, i)) {
            *least = fmin(*least, r->at[RAY_ENERGY][i]);
            *most = fmax(*most, r->at[RAY_ENERGY][i]);
        }
}

/* Returns whether coatings of several films reflect the ghost and its energy
 * hardly varies over the pupil. */
static bool is_energy_smooth_over_pupil(const struct fit *f,
                                        const struct glint_zone_rays *r)
{
    return f->task->stacks &&
           glint_zone_rays_compute_energy_ratio(r) <= GLINT_STEEP;
}

/* Returns the min energy by which energy errors are divided to get relative
 * errors. If two coatings of several films reflect almost no light at some
 * wavelengths, it is half of the band's mean energy. */
static double compute_min_energy(const struct fit *f,
                                 const struct glint_zone_rays *r, double most)
{
    double sum = 0, n = 1e-9;

    for (int i = 0; i < r->n && f->task->stacks; i++)
        if (glint_zone_rays_is_visible(r, i))
            sum += r->at[RAY_ENERGY][i], n++;
    return fmax(0.005 * most,
                is_energy_smooth_over_pupil(f, r) ? 0.5 * sum / n : 0);
}

/* Sets buffers->value to the energies, or to their fourth roots, and
 * channel_weight such that errors are relative to the energy or to
 * compute_min_energy(), whichever is larger. Returns the max weight. */
static double set_energy_values(struct fit *f, const struct glint_zone_rays *r,
                                double most, bool root)
{
    const double least = compute_min_energy(f, r, most);
    double largest = 0;

    for (int i = 0; i < r->n; i++) {
        const double out = fmax(r->at[RAY_EXCESS][i], r->at[RAY_FIELD][i]);
        const double energy = r->at[RAY_ENERGY][i];
        const double share = fmax(energy, least);

        /* the relative error of the fourth root is a quarter of that of the
         * energy */
        f->buffers->value[i] = root ? sqrt(sqrt(energy)) : energy;
        f->buffers->channel_weight[i] =
            fmax(compute_edge_weight(f, out), 0.001) /
            (root ? 0.25 * sqrt(sqrt(share)) : share);
        largest = fmax(largest, f->buffers->channel_weight[i]);
    }
    return largest;
}

/* Returns the rays for fitting energies. Traces them if this is the first fit
 * of the zone that gets as far as its energy. */
static const struct glint_zone_rays *get_energy_rays(struct fit *f)
{
    struct glint_zone_buffers *const b = f->buffers;

    if (!f->task->zone->skew && !b->has_energies)
        glint_zone_trace_energies(f->task->zone, f->task->visible, &b->rays,
                                  &b->energies);
    b->has_energies = true;
    return !f->task->zone->skew && b->energies.n ? &b->energies : &b->rays;
}

/* Fits the energy or its fourth root. Towards total reflection the energy grows
 * a thousandfold, while its fourth root is as smooth as a position. If a
 * coating reflects nothing at some wavelength, the root has a cusp there, while
 * the energy is smooth. */
static enum glint_status fit_energy_output(struct fit *f,
                                           struct glint_fitted_system *system,
                                           double *worst)
{
    const struct glint_zone_rays *const r = get_energy_rays(f);
    struct glint_fitted_output *o = &system->output[system->n_outputs];
    double least = HUGE_VAL, most = 1e-30, left, grain;
    struct glint_poly poly, other;
    bool root;

    extend_energy_range(r, &least, &most);
    extend_energy_range(&f->buffers->rays, &least, &most);
    root = f->task->thorough && !is_energy_smooth_over_pupil(f, r) &&
           most > WIDE_ENERGY * least;
    grain = f->aim->energy / set_energy_values(f, r, most, root);
    left = fit_polynomial(f, r, GLINT_OUT_ENERGY, f->aim->energy, &poly);
    if (root && left > 1) {
        const double other_grain =
            f->aim->energy / set_energy_values(f, r, most, false);
        const double other_left =
            fit_polynomial(f, r, GLINT_OUT_ENERGY, f->aim->energy, &other);

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
    return append_fitted_output(system, GLINT_OUT_ENERGY, &poly,
                                fmin(grain, f->aim->energy), left <= 1);
}

/* Chooses the barrels of the zone, unless they are known, and traces its rays
 * again with their radii at these barrels. */
static void find_barrels(struct fit *f)
{
    const struct glint_zone_task *const t = f->task;
    struct glint_zone_rays *const rays = &f->buffers->rays;

    if (f->buffers->has_barrels)
        return;
    f->buffers->has_barrels = true;
    glint_zone_choose_barrels(t->zone, t->visible, t->tolerance->escape,
                              t->sampling, rays);
    if (rays->n_barrels > 0)
        glint_zone_trace_rays(t->zone, t->visible, rays);
}

/* Fits the relative radius at barrel number BARREL, (1 + r^2) / 2. Rays near
 * its rim have most weight. */
static enum glint_status fit_barrel_radius(struct fit *f, int barrel,
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
    stretch = glint_zone_aim_compute_stretch(r, f->buffers->value, NULL, 0.8);
    system->output[system->n_outputs].event = r->barrel[barrel];
    return fit_and_append_output(
        f, r, (enum glint_channel)(GLINT_OUT_BARREL_0 + barrel),
        glint_zone_aim_get_outline_tolerance(
            f->aim, f->task->visible->far ? LEAST_FAR : LEAST, f->task->barrel,
            stretch),
        system, worst);
}

static void free_system_outputs(struct glint_fitted_system *system)
{
    while (system->n_outputs > 0)
        free(system->output[--system->n_outputs].coef);
}

static void combine_output_errors(struct fit *f, double energy)
{
    struct glint_zone_errors *const e = f->errors;

    e->shows = fmax(e->places, e->outlines / (is_fast_lens(f) ? RIM : 1));
    e->dims = is_fast_lens(f) ? fmax(e->shows, energy) : e->shows;
    e->worst = fmax(fmax(e->places, e->outlines), energy);
}

/* Returns whether the errors of the remaining outputs cannot change the next
 * step for the zone. */
static bool is_next_step_decided(const struct fit *f)
{
    const struct glint_zone_task *t = f->task;
    const struct glint_zone_errors *e = f->errors;
    const double left = t->zone->skew ? fmax(e->places, e->outlines)
                        : t->thorough ? e->dims
                                      : e->worst;

    return (t->hopeless > 0 && left > t->hopeless) ||
           (t->settled > 0 && left > t->settled);
}

/* Returns the tolerance of a position channel: mm on the sensor, or stop
 * radii. */
static double get_position_tolerance(const struct fit *f, int channel)
{
    return channel <= RAY_SENSOR_Y
               ? f->aim->sensor_mm * f->aim->thin[channel - RAY_SENSOR_X]
               : f->aim->stop;
}

static enum glint_status fit_all_outputs(struct fit *f,
                                         struct glint_fitted_system *system)
{
    struct glint_zone_errors *const e = f->errors;
    enum glint_status status = GLINT_OK;
    double energy = 0;

    *e = (struct glint_zone_errors){.worst = 0};
    for (int c = RAY_SENSOR_X; c <= RAY_STOP_Y && status == GLINT_OK; c++) {
        const bool sensor = c <= RAY_SENSOR_Y;

        status =
            fit_position_channel(f, c, get_position_tolerance(f, c), system,
                                 sensor ? &e->places : &e->outlines);
        combine_output_errors(f, 0);
        if (is_next_step_decided(f))
            return status;
    }
    if (status == GLINT_OK)
        status = fit_energy_output(f, system, &energy);
    e->energy = energy;
    combine_output_errors(f, energy);
    if (status == GLINT_OK && !is_next_step_decided(f))
        find_barrels(f);
    for (int b = 0; b < f->buffers->rays.n_barrels && status == GLINT_OK &&
                    !is_next_step_decided(f);
         b++) {
        status = fit_barrel_radius(f, b, system, &e->outlines);
        combine_output_errors(f, energy);
    }
    return status;
}

/* ---------------------------------------------------------- critical angles */

/* Min number of leaking invalid rays / number of visible rays for which a
 * barrel is fitted. */
#define INVALID 0.002

/* max number of invalid rays that are compared with the polynomials */
enum { MOST_INVALID = 600 };

/* Lists the invalid rays, every STEP-th, that the polynomials transmit. Returns
 * their number. */
static int list_transmitted_rays(const struct fit *f,
                                 const struct glint_fitted_system *system,
                                 int step, int index[MOST_INVALID])
{
    const struct glint_zone_rays *const r = &f->buffers->rays;
    int n = 0;

    for (int i = 0; i < r->n_invalid; i += step) {
        double x[GLINT_VARIABLES];

        glint_zone_rays_get_invalid(r, i, x);
        if (is_ray_transmitted(system, x, f->task->visible->field_mm))
            index[n++] = i;
    }
    return n;
}

/* Fits the barrel that stops rays at the critical angle C. */
static enum glint_status fit_critical_angle(struct fit *f,
                                            struct glint_critical c,
                                            enum glint_channel kind,
                                            struct glint_fitted_system *system)
{
    struct glint_zone_rays *const r = &f->buffers->energies;
    double worst = 0;
    enum glint_status status;

    f->buffers->has_energies = false;
    glint_critical_trace_rays(f->task->zone, f->task->visible,
                              &f->buffers->rays, c, r);
    if (r->n == 0)
        return GLINT_OK;
    for (int i = 0; i < r->n; i++) {
        const double r2 = r->radius[0][i] * r->radius[0][i];
        const double off = (r2 - 1) / 0.3;

        f->buffers->value[i] = 0.5 * (1 + r2);
        f->buffers->channel_weight[i] =
            compute_edge_weight(f, r->at[RAY_EXCESS][i]) *
            fmax(0.05, 1 / (1 + off * off));
    }
    system->output[system->n_outputs].event = c.event;
    system->output[system->n_outputs].critical = true;
    status = fit_and_append_output(f, r, kind, CRITICAL * f->task->barrel,
                                   system, &worst);
    if (status == GLINT_OK && !(worst <= MOST_CRITICAL))
        free(system->output[--system->n_outputs].coef);
    return status;
}

/* Adds barrels for rays that end at critical angles although the polynomials
 * transmit them. */
static enum glint_status fit_critical_angles(struct fit *f,
                                             struct glint_fitted_system *system)
{
    const int step = 1 + f->buffers->rays.n_invalid / MOST_INVALID;
    int index[MOST_INVALID], n_seen = 0;
    enum glint_status status = GLINT_OK;

    for (int i = 0; i < f->buffers->rays.n; i++)
        n_seen += glint_zone_rays_is_visible(&f->buffers->rays, i);
    for (int kind = GLINT_OUT_BARREL_0 + f->buffers->rays.n_barrels;
         kind < GLINT_OUT_KINDS && status == GLINT_OK; kind++) {
        const int n = list_transmitted_rays(f, system, step, index);
        const int n_outputs = system->n_outputs;
        struct glint_critical c;

        if (n * step <= INVALID * n_seen)
            break;
        c = glint_critical_find(f->task->zone, f->task->visible,
                                &f->buffers->rays, index, n);
        if (c.event < 0)
            break;
        status = fit_critical_angle(f, c, (enum glint_channel)kind, system);
        if (system->n_outputs == n_outputs)
            break;
    }
    return status;
}

/* ------------------------------------------------------------------ checks */

/* max RMS error, in tolerances, of rays between the fitted ones */
#define CHECK_RMS 1.6

/* Measures the position errors of rays between the fitted ones, in units of
 * CHECK_RMS tolerances, and raises the errors of the fit to these: a fit can be
 * good at every node and bad in between. */
static void check_rays_between_samples(struct fit *f,
                                       const struct glint_fitted_system *system)
{
    struct glint_zone_errors *const e = f->errors;
    const bool shaped = f->task->visible->shaped;
    const bool by_light =
        glint_zone_is_weighted_by_brightness(f->task->zone, f->task->visible);

    glint_zone_trace_check_rays(f->task->zone, f->task->visible,
                                &f->buffers->rays);
    set_brightness_weights(f);
    for (int k = 0; k < 4 && k < system->n_outputs; k++) {
        const bool sensor = k <= RAY_SENSOR_Y;
        double *const error = sensor ? &e->places : &e->outlines;
        const double left =
            glint_zone_aim_compute_rms_error(
                &f->buffers->rays, &system->output[k],
                sensor && by_light ? f->buffers->light : NULL, shaped ? 3 : 1) /
            get_position_tolerance(f, k);

        *error = fmax(*error, left / CHECK_RMS);
    }
    combine_output_errors(f, e->worst);
}

/* --------------------------------------------------------------------- all */

/* Fits SYSTEM again with the new weights. Fast lenses: restores the first fit
 * if removing leaks would cause larger visible errors. */
static enum glint_status
refit_without_leaking_rays(struct fit *f, struct glint_fitted_system *system)
{
    const struct glint_zone_errors errors = *f->errors;
    struct glint_fitted_system leaky = *system;
    enum glint_status status;

    system->n_outputs = 0;
    status = fit_all_outputs(f, system);
    if (is_fast_lens(f) &&
        fmax(f->errors->places, f->errors->outlines) >
            fmax(1, HARM * fmax(errors.places, errors.outlines))) {
        free_system_outputs(system);
        *system = leaky;
        *f->errors = errors;
    } else {
        free_system_outputs(&leaky);
    }
    return status;
}

enum glint_status glint_zone_fit_outputs(const struct glint_zone_task *task,
                                         const struct glint_zone_aim *aim,
                                         struct glint_zone_buffers *buffers,
                                         struct glint_fitted_system *system,
                                         struct glint_zone_errors *errors)
{
    struct fit f = {task, aim, buffers, errors};
    enum glint_status status;

    buffers->has_energies = false;
    buffers->has_barrels = !task->sampling;
    set_ray_weights(&f);
    status = fit_all_outputs(&f, system);
    if (status != GLINT_OK || is_next_step_decided(&f))
        return status;
    if ((task->thorough || errors->worst <= 1) &&
        raise_leaking_ray_weights(&f, system))
        status = refit_without_leaking_rays(&f, system);
    if (status == GLINT_OK && task->visible->far)
        errors->outlines = fmax(errors->outlines,
                                compute_leaking_ray_ratio(&f, system) / LEAK);
    if (status == GLINT_OK && !task->zone->skew && !task->visible->shaped &&
        task->visible->n_beside == 0 && !is_next_step_decided(&f))
        status = fit_critical_angles(&f, system);
    if (status == GLINT_OK)
        check_rays_between_samples(&f, system);
    return status;
}
