/* SPDX-License-Identifier: MIT */
#include "bake/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/compiler.h"
#include "bake/degrees.h"
#include "bake/zone.h"

STATIC_ASSERT((int)GLINT_MAX_TERMS == (int)GLINT_MAX_MODEL_TERMS);

#define PEAK        5.0  /* times the root mean square */
#define WIDE_ENERGY 60   /* most over least energy of which to take a root */
#define LEAST_FILL  0.33 /* of a box; below it the grids waste their cells */
#define CROWD_DEG                                                            \
    1.5               /* a vertex has room for two barrels: more make a zone \
                         worth halving down to here */
#define FILL_DEG  0.6 /* narrower zones need not care for that */
#define LEAST_DEG 0.7
#define BRIGHT_EASE                                         \
    1.5 /* zones of ghosts as bright as that may be half as \
           wide */
#define STUCK                                                  \
    0.75 /* half a zone that is left with so much of the whole \
            one's error gains nothing from halving... */
#define STUCK_DEG     1.2  /* ...once it is this narrow */
#define PART_LEFT     5.0  /* zones that show more than that are parted */
#define HOPELESS      20.0 /* times that is what more terms cannot mend, */
#define HALVES_ANYWAY 10.0 /* nor, where it can be halved, so much */
#define WANDERS                                                  \
    0.5 /* boxes that do so more make it worth to halve the band \
         */
#define LEAST_BAND 0.6
#define WORTH_CROP 0.8 /* as long as cropping a part leaves less, */

enum {
    FEW_TERMS = 64,
    PATIENCE = 36,   /* terms, with what looks like another part */
    MANY_TERMS = 96, /* of places, by all means */
    BAND_DEPTH = 3,
    PART_DEPTH = 4, /* times that a zone's box is halved */
    CROPS = 2       /* it is done so many times */
};

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
    double ease; /* of this zone, its tolerances, and how far they are below
                    what its ghost would show: */
    double sensor_mm, edge_mm, stop, energy, hidden;
    double off; /* how far places are off, in tolerances */
    bool by_all_means;
    int n_parts;                  /* of the zone so far */
    const struct glint_hunt *now; /* in the band of what is fitted: */
    struct glint_hunt in_band, in_part;
    struct glint_profile band_profile;
    double profiled[4]; /* what it is of: angles and band */
    double wanders;     /* the box with the colour, half widths */
    double hopeless;    /* left of what is to be parted anyway; 0: is not */
};

/* ----------------------------------------------------------------- outputs */

static const struct glint_degrees position_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 4},
    .weight = {1, 1, 1, 2},
    .total = 12,
    .terms = FEW_TERMS};

static const struct glint_degrees energy_degrees = {.most = {6, 4, 4, 8},
                                                    .weight = {1, 1, 1, 1},
                                                    .total = 10,
                                                    .terms = FEW_TERMS};

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

static bool is_seen(const struct glint_rays *r, int i)
{
    return r->at[RAY_EXCESS][i] <= 1 && r->at[RAY_FIELD][i] <= 1;
}

/* The rays of one angle and wavelength from FIRST on: what is seen of them. */
struct sight {
    int n, n_all;
    double low[2], high[2]; /* on the sensor */
    double energy;          /* mean */
};

static struct sight look(const struct glint_rays *r, int first)
{
    struct sight s = {.low = {HUGE_VAL, HUGE_VAL},
                      .high = {-HUGE_VAL, -HUGE_VAL}};

    for (int i = first; i < r->n && r->x[2][i] == r->x[2][first] &&
                        r->x[3][i] == r->x[3][first];
         i++, s.n_all++) {
        if (!is_seen(r, i))
            continue;
        for (int k = 0; k < 2; k++) {
            s.low[k] = fmin(s.low[k], r->at[RAY_SENSOR_X + k][i]);
            s.high[k] = fmax(s.high[k], r->at[RAY_SENSOR_X + k][i]);
        }
        s.energy += r->at[RAY_ENERGY][i];
        s.n++;
    }
    s.energy /= s.n > 0 ? s.n : 1;
    return s;
}

/* How bright the ghost is at its brightest in the zone, as a share of what is
 * as bright as counts. */
static double share_of(const struct fitter *f, const struct glint_zone *zone)
{
    enum { FEW = 4 }; /* rays have no area to speak of */
    const struct glint_rays *r = &f->rays;
    double most = 0;

    for (int i = 0, next; i < r->n; i = next) {
        const struct sight v = look(r, i);
        const double s = r->x[2][i], w = r->x[3][i];
        const double pupil = (zone->hollow ? 2 : 4) *
                             glint_zone_at(zone->half_x, s, w) *
                             glint_zone_at(zone->half_y, s, w) * v.n / v.n_all;
        const double level = glint_brightness_at(
            f->tolerance->brightness,
            0.5 * (zone->lo + zone->hi) + 0.5 * s * (zone->hi - zone->lo));
        const double y = fmax(fabs(v.low[1]), fabs(v.high[1])); /* mirrored */

        next = i + v.n_all;
        if (v.n >= FEW)
            most = fmax(most, v.energy * pupil /
                                  fmax(1e-9, (v.high[0] - v.low[0]) * 1.6 * y) /
                                  fmax(level, 1e-30));
    }
    return most;
}

/* Sensor millimetres for a unit of the place A, B (or A alone), root mean
 * square over neighbours; of barrels only where they cut. */
static double stretch_of(const struct glint_rays *r, const double *a,
                         const double *b, double near)
{
    double moved2 = 0, change2 = 0;

    for (int i = 1; i < r->n; i++) {
        const double *x = r->at[RAY_SENSOR_X], *y = r->at[RAY_SENSOR_Y];

        if (r->x[1][i] != r->x[1][i - 1] || r->x[2][i] != r->x[2][i - 1] ||
            r->x[3][i] != r->x[3][i - 1] || !is_seen(r, i) ||
            !is_seen(r, i - 1) || a[i] < near)
            continue;
        moved2 += (x[i] - x[i - 1]) * (x[i] - x[i - 1]) +
                  (y[i] - y[i - 1]) * (y[i] - y[i - 1]);
        change2 += (a[i] - a[i - 1]) * (a[i] - a[i - 1]);
        if (b)
            change2 += (b[i] - b[i - 1]) * (b[i] - b[i - 1]);
    }
    return change2 > 0 ? sqrt(moved2 / change2) : 0;
}

/* What an outline may be off, in units of which STRETCH_MM are a millimetre. */
static double outline_tolerance(const struct fitter *f, double most,
                                double stretch_mm)
{
    return fmax(0.06 * most, fmin(most, f->edge_mm / fmax(1e-12, stretch_mm)));
}

static void set_tolerances(struct fitter *f, const struct glint_zone *zone)
{
    const struct glint_tolerance *t = f->tolerance;
    const struct glint_rays *r = &f->rays;
    const double share = share_of(f, zone);
    const double shows = fmax(1, pow(fmax(share, 1e-9), -0.42));
    const double ease = fmin(t->ease, shows);

    f->ease = ease;
    f->edge_mm = ease * t->edge_mm;
    f->sensor_mm = fmin(ease * t->sensor_mm, t->faint_sensor_mm);
    f->hidden = shows * t->sensor_mm / f->sensor_mm;
    f->stop = outline_tolerance(
        f, t->stop,
        stretch_of(r, r->at[RAY_STOP_X], r->at[RAY_STOP_Y], -HUGE_VAL));
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

/* The polynomials let ray I pass, which the lens stops by far. */
static bool leaks(const struct glint_rays *r, int i,
                  const struct glint_fitted_system *system, double field_mm)
{
    const double x[GLINT_VARIABLES] = {r->x[0][i], r->x[1][i], r->x[2][i],
                                       r->x[3][i]};
    double at[GLINT_OUT_KINDS] = {0};
    bool passes = r->at[RAY_EXCESS][i] > 1.05;

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

/* Gives rays that leak a weight that they are heard with. Returns whether there
 * are any. */
static bool stop_leaks(struct fitter *f,
                       const struct glint_fitted_system *system)
{
    bool any = false;

    for (int i = 0; i < f->rays.n; i++)
        if (leaks(&f->rays, i, system, f->hunt->field_mm)) {
            f->weight[i] = fmax(f->weight[i], 0.1);
            any = true;
        }
    return any;
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
    o->grain = rms / 6; /* a few dozen of these stay below a third of it */
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

    if (f->by_all_means && kind != GLINT_OUT_ENERGY)
        degrees.terms = MANY_TERMS;
    degrees.hopeless = kind == GLINT_OUT_ENERGY ? 0 : f->hopeless;
    degrees.patience = PATIENCE;
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

/* Least and most energy of what is seen. */
static void energies_of(const struct glint_rays *r, double *least, double *most)
{
    for (int i = 0; i < r->n; i++)
        if (is_seen(r, i)) {
            *least = fmin(*least, r->at[RAY_ENERGY][i]);
            *most = fmax(*most, r->at[RAY_ENERGY][i]);
        }
}

/* Energy counts by its share, down to a two-hundredth of the most that is seen.
 * Towards total reflection it grows a thousandfold; its fourth root is as tame
 * as a position. */
static enum glint_status
fit_energy(struct fitter *f, struct glint_fitted_system *system, double *worst)
{
    const struct glint_rays *r = f->energies.n ? &f->energies : &f->rays;
    struct glint_fitted_output *o = &system->output[system->n_outputs];
    double least = HUGE_VAL, most = 1e-30;

    energies_of(r, &least, &most);
    energies_of(&f->rays, &least, &most);
    o->roots = f->by_all_means && most > WIDE_ENERGY * least ? 2 : 0;
    o->most = least > most ? 0 : o->roots ? sqrt(sqrt(most)) : most;
    for (int i = 0; i < r->n; i++) {
        const double out = fmax(r->at[RAY_EXCESS][i], r->at[RAY_FIELD][i]);
        const double energy = r->at[RAY_ENERGY][i];
        const double share = fmax(energy, 0.005 * most);

        /* an error of the root is a quarter of the energy's */
        f->value[i] = o->roots ? sqrt(sqrt(energy)) : energy;
        f->channel_weight[i] = fmax(weight_past_edge(out), 0.001) /
                               (o->roots ? 0.25 * sqrt(sqrt(share)) : share);
    }
    return fit_output(f, r, GLINT_OUT_ENERGY, f->energy, system, worst);
}

/* Where the barrel cuts is what counts. */
static enum glint_status fit_barrel(struct fitter *f, int barrel,
                                    struct glint_fitted_system *system,
                                    double *worst)
{
    const struct glint_rays *r = &f->rays;
    double stretch;

    for (int i = 0; i < r->n; i++) {
        const double radius = r->radius[barrel][i];
        const double off = (radius - 1) / 0.15;

        f->value[i] = 0.5 * (1 + radius * radius);
        f->channel_weight[i] = f->weight[i] * fmax(0.05, 1 / (1 + off * off));
    }
    stretch = stretch_of(r, f->value, NULL, 0.8);
    system->output[system->n_outputs].event = r->barrel[barrel];
    return fit_output(f, r, (enum glint_channel)(GLINT_OUT_BARREL_0 + barrel),
                      outline_tolerance(f, f->tolerance->barrel, stretch),
                      system, worst);
}

static void drop_outputs(struct glint_fitted_system *system)
{
    while (system->n_outputs > 0)
        free(system->output[--system->n_outputs].coef);
}

static bool is_hopeless(const struct fitter *f)
{
    return f->hopeless > 0 && f->off > f->hopeless;
}

static enum glint_status
fit_outputs(struct fitter *f, struct glint_fitted_system *system, double *worst)
{
    enum glint_status status = GLINT_OK;

    *worst = 0;
    for (int c = RAY_SENSOR_X; c <= RAY_STOP_Y && status == GLINT_OK; c++) {
        status = fit_channel(f, c, c <= RAY_SENSOR_Y ? f->sensor_mm : f->stop,
                             system, worst);
        f->off = *worst;
        if (is_hopeless(f))
            return status;
    }
    if (status == GLINT_OK)
        status = fit_energy(f, system, worst);
    for (int b = 0; b < f->rays.n_barrels && status == GLINT_OK; b++)
        status = fit_barrel(f, b, system, &f->off);
    *worst = fmax(*worst, f->off);
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

    glint_zone_check(zone, f->now, &f->rays);
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

/* A zone, or a part of one, to be fitted; BEFORE is what was left of it at the
 * last attempt. By all means: with a box that follows the colours, a root of
 * the energy, and more terms. */
struct pending {
    double lo, hi, before;
    double w0, w1; /* the part of the band, -1 .. 1 */
    bool by_all_means;
    struct glint_part part;
    int depth; /* of the part; 0: the whole zone */
};

static bool nothing_seen(const struct glint_rays *r)
{
    for (int i = 0; i < r->n; i++)
        if (is_seen(r, i))
            return false;
    return true;
}

static bool is_whole_band(double w0, double w1)
{
    return w0 <= -1 && w1 >= 1;
}

/* The boxes for the angles and the part of the band of P. */
static const struct glint_profile *profile_of(struct fitter *f,
                                              const struct pending *p)
{
    const double range[2] = {p->lo, p->hi};
    const double key[4] = {p->lo, p->hi, p->w0, p->w1};

    if (is_whole_band(p->w0, p->w1))
        return &f->profile;
    if (memcmp(key, f->profiled, sizeof key) != 0) {
        glint_hunt_narrow(&f->in_band, f->hunt, p->w0, p->w1);
        glint_hunt_profile(&f->in_band, range, &f->band_profile);
        memcpy(f->profiled, key, sizeof key);
    }
    return &f->band_profile;
}

static void cut_out(struct fitter *f, const struct pending *p,
                    struct glint_zone *zone)
{
    const struct glint_part *part = &p->part;
    const struct glint_hunt *band =
        is_whole_band(p->w0, p->w1) ? f->hunt : &f->in_band;

    glint_zone_cut(zone, part);
    f->now = band;
    if (!is_whole_band(part->w0, part->w1)) {
        glint_hunt_narrow(&f->in_part, band, part->w0, part->w1);
        f->now = &f->in_part;
    }
}

/* Cuts P out of ZONE, and by all means leaves off what is not seen: a ghost
 * that comes through here in red and there in blue leaves much. */
static void set_part(struct fitter *f, struct pending *p,
                     struct glint_zone *zone)
{
    const struct glint_zone whole = *zone;
    double rest = p->by_all_means ? 0 : 1;

    cut_out(f, p, zone);
    for (int round = 0; round < CROPS && rest < WORTH_CROP; round++) {
        rest = glint_zone_crop(zone, f->now, &p->part);
        *zone = whole;
        cut_out(f, p, zone);
    }
}

/* What is left of P that will be halved or parted, whatever comes of it. The
 * halves of wide zones are not yet at the end of halving, where what is left
 * has to be known. */
static double hopeless(const struct fitter *f, const struct pending *p)
{
    if (p->by_all_means)
        return p->depth < PART_DEPTH ? HOPELESS * PART_LEFT * f->hidden : 0;
    return degrees_between(p->lo, p->hi) > 2 * STUCK_DEG ? HALVES_ANYWAY : 0;
}

/* Fits a zone; *LEFT becomes how bad it is: at most 1 if good. A part that
 * nothing comes through has no outputs afterwards. P's part may shrink. */
static enum glint_status try_zone(struct fitter *f, struct pending *p,
                                  struct glint_fitted_system *system,
                                  double *left)
{
    const struct glint_profile *profile = profile_of(f, p);
    enum glint_status status;
    struct glint_zone zone;

    *system = (struct glint_fitted_system){.ghost = f->hunt->ghost,
                                           .hollow = p->part.hollow,
                                           .sine_lo = p->lo,
                                           .sine_hi = p->hi};
    f->by_all_means = p->by_all_means;
    *left = f->off = 0;
    if (profile->n == 0)
        return GLINT_OK;
    *left = HUGE_VAL;
    glint_zone_init(&zone, profile, p->lo, p->hi, p->by_all_means);
    f->wanders = (fabs(zone.middle[GLINT_BOX_POWERS]) +
                  fabs(zone.half_x[GLINT_BOX_POWERS])) /
                 zone.half_x[0];
    if (!p->by_all_means && zone.fill < LEAST_FILL &&
        degrees_between(p->lo, p->hi) > FILL_DEG)
        return GLINT_OK;
    set_part(f, p, &zone);
    system->wave_lo = f->now->wave_lo;
    system->wave_hi = f->now->wave_hi;
    glint_zone_survey_barrels(&zone, f->now, &f->survey, &f->rays);
    if (f->rays.n_barrels > 2 && degrees_between(p->lo, p->hi) > CROWD_DEG)
        return GLINT_OK;
    glint_zone_trace(&zone, f->now, &f->rays, &f->energies);
    *left = 0;
    if ((p->depth > 0 || !is_whole_band(p->w0, p->w1)) &&
        nothing_seen(&f->rays))
        return GLINT_OK;
    status = set_box(system, &zone);
    set_tolerances(f, &zone);
    set_weights(f);
    f->hopeless = hopeless(f, p);
    if (status == GLINT_OK)
        status = fit_outputs(f, system, left);
    if (status != GLINT_OK || is_hopeless(f))
        return status;
    if ((p->by_all_means || *left <= 1) && stop_leaks(f, system)) {
        drop_outputs(system);
        status = fit_outputs(f, system, left);
    }
    if (status == GLINT_OK)
        f->off = fmax(f->off, check_zone(f, &zone, system));
    *left = fmax(*left, f->off);
    system->met = *left <= 1;
    return status;
}

/* What to do about a zone that is left with LEFT. Halves of bright ones are
 * worth more. */
enum next { KEEP, HALVE, ALL_MEANS, BANDS, PART };

static enum next next_step(const struct fitter *f, const struct pending *p,
                           double left)
{
    const bool helped = left <= STUCK * p->before;
    const double width =
        degrees_between(p->lo, p->hi) * (f->ease < BRIGHT_EASE ? 2 : 1);
    const bool stuck = width < LEAST_DEG || (!helped && width < STUCK_DEG);

    if (p->by_all_means && f->off <= PART_LEFT * f->hidden)
        return KEEP;
    if (p->by_all_means && p->depth == 0 && f->wanders > WANDERS &&
        p->w1 - p->w0 > LEAST_BAND)
        return BANDS;
    if (p->by_all_means)
        return p->depth < PART_DEPTH ? PART : KEEP;
    if (left <= 1)
        return KEEP;
    return stuck && left < HUGE_VAL ? ALL_MEANS : HALVE;
}

static const struct glint_part whole = {-1, 1, 1, -1, 1, false};

/* Puts the halves of P on the stack: along v first, so that what is seen
 * through the middle gets apart from what is seen through the rim. Returns how
 * many there are then. */
static int push_halves(struct pending *stack, int n, struct pending p,
                       enum next how)
{
    const double angle = 0.5 * (p.lo + p.hi);
    const double u = 0.5 * (p.part.u0 + p.part.u1);
    struct pending a = p, b = p;

    if (how == HALVE) {
        a.hi = b.lo = angle;
    } else if (how == BANDS) {
        a.w1 = b.w0 = 0.5 * (p.w0 + p.w1);
        a.part = b.part = whole;
    } else {
        a.depth = b.depth = p.depth + 1;
        if (p.depth % 2 || p.part.hollow) {
            a.part.u1 = b.part.u0 = u;
        } else {
            a.part.top *= 0.5;
            b.part.hollow = true;
        }
    }
    stack[n] = b;
    stack[n + 1] = a;
    return n + 2;
}

/* Zones from the lowest angle up; the upper halves wait on a stack. */
static enum glint_status fit_range(struct fitter *f, const double range[2])
{
    /* halvings of a sine down to half of LEAST_DEG: 13 at most */
    enum { DEEP = 24 + BAND_DEPTH + PART_DEPTH };
    struct pending stack[DEEP] = {
        {range[0], range[1], HUGE_VAL, -1, 1, false, whole, 0}};
    enum glint_status status = GLINT_OK;
    int n = 1;

    glint_hunt_profile(f->hunt, range, &f->profile);
    if (f->profile.n == 0)
        return GLINT_OK;
    while (n > 0 && status == GLINT_OK) {
        struct pending p = stack[--n];
        struct glint_fitted_system system;
        enum next next = KEEP;
        double left;

        status = try_zone(f, &p, &system, &left);
        if (status == GLINT_OK)
            next = n + 2 > DEEP ? KEEP : next_step(f, &p, left);
        if (p.depth == 0 && p.w0 <= -1)
            f->n_parts = 0;
        system.part = f->n_parts;
        if (status == GLINT_OK && next == KEEP && system.n_outputs > 0) {
            status = append(f->out, &system);
            f->n_parts++;
        } else {
            system_finish(&system);
        }
        p.before = left;
        if (next == ALL_MEANS) {
            p.by_all_means = true;
            stack[n++] = p;
        } else if (next != KEEP) {
            n = push_halves(stack, n, p, next);
        }
    }
    return status;
}

enum glint_status glint_fit_ghost(const struct glint_hunt *hunt, double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  struct glint_fitted_ghost *out)
{
    struct fitter *f = calloc(1, sizeof *f);
    enum glint_status status = GLINT_E_MEMORY;
    double range[GLINT_MAX_RANGES][2];

    *out = (struct glint_fitted_ghost){0};
    if (!f)
        return status;
    f->hunt = hunt;
    f->tolerance = tolerance;
    f->profiled[0] = HUGE_VAL; /* of nothing yet */
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
