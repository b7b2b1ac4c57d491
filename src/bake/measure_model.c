/* SPDX-License-Identifier: MIT */
#include "bake/measure_model.h"

#include <math.h>
#include <stdlib.h>

#include "bake/fit/zone_rays.h"
#include "engine/setup/degrees.h"
#include "glint/transfer.h"

enum { RAYS = 400, TRIES = 1600, PER_BUNDLE = 16 };

struct random {
    uint64_t state;
};

/* Returns a uniform random number, -1 .. 1. [Steele14] */
static double draw_random_number(struct random *r)
{
    uint64_t z = r->state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/* A bundle is the set of rays of one ghost, direction and wavelength. This
 * struct holds the model's data and the exact path of a bundle, and the errors
 * measured so far. */
struct meter {
    const struct glint_visible *visible;
    const struct glint_fitted_system *fitted;
    struct glint_transfer transfer;
    struct glint_path path;
    double direction[3];
    int n;
    /* error of each ray, for each output: [RAYS] */
    double *error[GLINT_OUT_KINDS];
    double *energy; /* exact energy of each ray, [RAYS] */
    int n_of[GLINT_OUT_KINDS];
    struct glint_measured *out;
};

static double get_output_value(const struct meter *b,
                               const struct glint_outputs *o, int kind)
{
    return ldexp(o->at[kind], b->transfer.exponent[kind]);
}

static bool is_output_in_system(const struct meter *b, int kind)
{
    return (b->transfer.outputs >> kind & 1) != 0;
}

static void record_output_error(struct meter *b, int kind, double error)
{
    b->error[kind][b->n_of[kind]++] = fabs(error);
}

/* Records the errors of the barrel polynomials, which approximate (1 + r^2) / 2
 * (r: relative radius of the ray at the barrel). Only rays near the rim, r = 1,
 * count, because there an error changes which rays are blocked. At the rim the
 * error of (1 + r^2) / 2 equals the error of r. */
static void record_barrel_errors(struct meter *b, const struct glint_outputs *o,
                                 double (*hits)[2])
{
    for (int k = 0; k < b->fitted->n_outputs; k++) {
        const struct glint_fitted_output *f = &b->fitted->output[k];
        double r;

        if (f->kind < GLINT_OUT_BARREL_0 || f->critical)
            continue;
        r = hypot(hits[f->event][0], hits[f->event][1]) /
            b->path.event[f->event].semi_mm;
        if (fabs(r - 1) < 0.2)
            record_output_error(b, (int)f->kind,
                                get_output_value(b, o, (int)f->kind) -
                                    0.5 * (1 + r * r));
    }
}

static void record_ray_errors(struct meter *b, const struct glint_ray *ray,
                              const struct glint_outputs *o, double (*hits)[2])
{
    const struct glint_setup *s = b->visible->setup;
    const double px = 1920 / s->lens->film_width_mm;
    const double stop = s->optics.stop_radius_mm;

    record_output_error(
        b, GLINT_OUT_SENSOR_X,
        px * (get_output_value(b, o, GLINT_OUT_SENSOR_X) - ray->sensor_x_mm));
    record_output_error(
        b, GLINT_OUT_SENSOR_Y,
        px * (get_output_value(b, o, GLINT_OUT_SENSOR_Y) - ray->sensor_y_mm));
    record_output_error(b, GLINT_OUT_STOP_X,
                        get_output_value(b, o, GLINT_OUT_STOP_X) -
                            ray->stop_x_mm / stop);
    record_output_error(b, GLINT_OUT_STOP_Y,
                        get_output_value(b, o, GLINT_OUT_STOP_Y) -
                            ray->stop_y_mm / stop);
    record_output_error(b, GLINT_OUT_ENERGY,
                        get_output_value(b, o, GLINT_OUT_ENERGY) - ray->energy);
    b->energy[b->n++] = ray->energy;
    if (is_output_in_system(b, GLINT_OUT_RADIUS))
        record_output_error(b, GLINT_OUT_RADIUS,
                            get_output_value(b, o, GLINT_OUT_RADIUS) -
                                ray->rel_radius);
    record_barrel_errors(b, o, hits);
}

static bool is_ray_passed_by_model(const struct meter *b,
                                   const struct glint_outputs *o)
{
    bool clear = hypot(get_output_value(b, o, GLINT_OUT_STOP_X),
                       get_output_value(b, o, GLINT_OUT_STOP_Y)) <= 1 &&
                 hypot(get_output_value(b, o, GLINT_OUT_SENSOR_X),
                       get_output_value(b, o, GLINT_OUT_SENSOR_Y)) <=
                     b->visible->field_mm;

    for (int kind = GLINT_OUT_RADIUS; kind < GLINT_OUT_KINDS; kind++)
        clear &=
            !is_output_in_system(b, kind) || get_output_value(b, o, kind) <= 1;
    return clear;
}

/* Returns whether the exact ray is blocked by a margin larger than any
 * tolerance. */
static bool is_ray_clearly_blocked(const struct meter *b,
                                   enum glint_ray_status status,
                                   const struct glint_ray *ray)
{
    return status != GLINT_RAY_OK || ray->rel_radius > 1.03 ||
           hypot(ray->stop_x_mm, ray->stop_y_mm) >
               1.03 * b->visible->setup->optics.stop_radius_mm;
}

static void measure_ray_errors(struct meter *b, double u, double v)
{
    const double scale = ldexp(1, b->transfer.box_exponent);
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct glint_outputs o;
    struct glint_ray ray;
    const enum glint_ray_status status = glint_trace(
        &b->path, scale * (b->transfer.box[0] + u * b->transfer.box[1]),
        scale * (b->transfer.box[3] + v * b->transfer.box[2]), b->direction,
        &ray, hits);

    glint_transfer_ray(&b->transfer, (int32_t)lrint(u * 0x1p30),
                       (int32_t)lrint(v * 0x1p30), &o);
    if (status == GLINT_RAY_OK &&
        glint_visible_is_ray_visible(b->visible, &ray))
        record_ray_errors(b, &ray, &o, hits);
    else if (is_ray_clearly_blocked(b, status, &ray) &&
             is_ray_passed_by_model(b, &o))
        b->out->intruders++;
}

/* Divides each energy error by the ray's energy, or by 1/50 of the largest
 * energy if that is more. */
static void normalise_energy_errors(struct meter *b)
{
    double most = 1e-30;

    for (int i = 0; i < b->n; i++)
        most = fmax(most, b->energy[i]);
    for (int i = 0; i < b->n; i++)
        b->error[GLINT_OUT_ENERGY][i] /= fmax(b->energy[i], 0.02 * most);
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static struct glint_errors compute_error_statistics(double *error, int n)
{
    struct glint_errors e = {0, 0, 0, 0};

    if (n == 0)
        return e;
    qsort(error, (size_t)n, sizeof *error, compare_doubles);
    for (int i = 0; i < n; i++)
        e.rms += error[i] * error[i] / n;
    e.rms = sqrt(e.rms);
    e.p50 = error[n / 2];
    e.p99 = error[(n - 1) * 99 / 100];
    e.max = error[n - 1];
    return e;
}

/* Substitutes direction and wavelength of the bundle into the model's
 * polynomials. Returns whether the model has light there. */
static bool init_bundle_transfer(struct meter *b, const struct glint_lens *lens,
                                 int32_t wave_q24)
{
    const double sine = hypot(b->direction[0], b->direction[1]);
    const double c = sine > 0 ? b->direction[0] / sine : 1;
    const double s = sine > 0 ? b->direction[1] / sine : 0;

    return glint_transfer_init_at(
               &b->transfer, lens, b->visible->ghost,
               (int32_t)lrint(sine * 0x1p30),
               (struct glint_azimuth){(int32_t)lrint(c * 0x1p30),
                                      (int32_t)lrint(s * 0x1p30)},
               wave_q24) != 0;
}

/* Sets the bundle to a random angle and wavelength of system S. Returns
 * false if the model uses another system there. */
static bool choose_random_bundle(struct meter *b, const struct glint_lens *lens,
                                 const struct glint_model_system *s,
                                 struct random *r)
{
    const struct glint_fitted_system *f = b->fitted;
    const double part = 0.5 + 0.5 * draw_random_number(r),
                 w = draw_random_number(r);
    const double wave = 0.5 * ((double)s->wave_lo_q24 + s->wave_hi_q24) +
                        0.5 * w * ((double)s->wave_hi_q24 - s->wave_lo_q24);
    const int32_t sine_q30 =
        s->sine_lo_q30 +
        (int32_t)(part * ((double)s->sine_hi_q30 - s->sine_lo_q30));
    const int32_t wave_q24 = (int32_t)lrint(wave);

    b->direction[0] = sine_q30 * 0x1p-30;
    b->direction[1] = f->skew ? f->y_lo + (0.5 + 0.5 * draw_random_number(r)) *
                                              (f->y_hi - f->y_lo)
                              : 0;
    /* A bundle on the border of system S may belong to the next system, and a
     * corner of the box of directions may not be a valid direction. */
    if (hypot(b->direction[0], b->direction[1]) >= 1 ||
        !init_bundle_transfer(b, lens, wave_q24) || b->transfer.system != s)
        return false;
    b->direction[2] = sqrt(1 - b->direction[0] * b->direction[0] -
                           b->direction[1] * b->direction[1]);
    glint_path_init(&b->path, b->visible->setup->lens,
                    &b->visible->setup->ghost[b->visible->ghost],
                    1e3 / sqrt(wave_q24 * 0x1p-24));
    return true;
}

void glint_measure_system_errors(const struct glint_visible *visible,
                                 const struct glint_lens *lens, int system,
                                 const struct glint_fitted_system *fitted,
                                 struct glint_measured *out)
{
    const double rim = glint_zone_get_inner_rim(fitted->annulus);
    struct random random = {(uint64_t)system * 977 + 1};
    double error[GLINT_OUT_KINDS][RAYS], energy[RAYS];
    struct meter b = {
        .visible = visible, .fitted = fitted, .energy = energy, .out = out};

    *out = (struct glint_measured){0};
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        b.error[kind] = error[kind];
    for (int k = 0; k < TRIES / PER_BUNDLE && b.n < RAYS; k++) {
        if (!choose_random_bundle(&b, lens, &lens->system[system], &random))
            continue;
        for (int i = 0; i < PER_BUNDLE && b.n < RAYS; i++) {
            const double u = draw_random_number(&random),
                         v = draw_random_number(&random);

            measure_ray_errors(
                &b, u, fitted->skew ? v : rim + (1 - rim) * (0.5 + 0.5 * v));
        }
    }
    out->rays = b.n;
    normalise_energy_errors(&b);
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        out->of[kind] = compute_error_statistics(error[kind], b.n_of[kind]);
}
