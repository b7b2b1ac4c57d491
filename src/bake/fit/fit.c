/* SPDX-License-Identifier: MIT */
#include "bake/fit/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/setup/degrees.h"
#include "bake/fit/zone_fit.h"

/* Least share of a box that a ghost must fill: less would waste cells of the
 * grids. */
#define LEAST_FILL 0.33
/* Degrees: a wider zone with more than two barrels is halved, as a vertex has
 * room for two, unless that was found to gain nothing. */
#define CROWD_DEG 1.5
/* Degrees: narrower zones may fill their boxes less. */
#define FILL_DEG 0.6
/* Degrees: narrower zones are not halved. */
#define LEAST_DEG 0.7
/* Zones of ghosts with less ease are bright and may be half as wide. */
#define BRIGHT_EASE 1.5
/* Share of the error of the whole zone: a half whose error is larger gained
 * nothing from halving. */
#define STUCK 0.75
/* Degrees: a narrower zone which gained nothing is not halved again, nor is a
 * wider one whose error is endured(). */
#define STUCK_DEG 1.2
/* Factor on STUCK_DEG for wide stops: nearly all of their zones. */
#define WIDE_STUCK 16
/* Tolerances: zones with a larger error are divided into parts. If the ghost is
 * so faint that it hides more, the error may be up to MOST_HIDDEN times as
 * large. */
#define PART_LEFT   5.0
#define MOST_HIDDEN 3.0
/* Multiples of bearable(), which is PART_LEFT and more for faint ghosts: zones
 * with a larger error are divided at once, as more terms would not help. */
#define HOPELESS 20.0
/* Tolerances: a wide zone with a larger error will be halved anyway. */
#define HALVES_ANYWAY 10.0
/* Half widths: if a box moves or grows by more over the band, the band is
 * halved. */
#define WANDERS 0.5
/* Width of a band in w, 0 .. 2: narrower ones are not halved. */
#define LEAST_BAND 0.6
/* Share of a part: cropping goes on while it leaves less. */
#define WORTH_CROP 0.8

enum {
    /* Times that a band can be halved, which follows from LEAST_BAND. */
    BAND_DEPTH = 2,
    CROPS = 2 /* most times that a part is cropped */
};

struct fitter {
    const struct glint_visible *visible;
    const struct glint_tolerance *tolerance;
    struct glint_fitted_ghost *out;
    struct glint_zone_buffers buffers;
    glint_zone_sampling sampling;
    struct glint_visible_profile profile;
    struct glint_visible in_band, in_part;
    struct glint_visible_profile band_profile;
    double profiled[4];      /* angles and band of band_profile */
    int n_parts;             /* number of parts of the zone so far */
    glint_fit_told_fn *told; /* NULL: nobody is told */
    void *told_ctx;
    double work, share; /* see glint_fit_told_fn */
    double sines;       /* width of all ranges */
};

/* Returns whether a coating of several films reflects the ghost. */
static bool has_stacks(const struct glint_visible *visible)
{
    const struct glint_setup *setup = visible->setup;
    const struct glint_ghost ghost = setup->ghost[visible->ghost];

    return setup->lens->surface[ghost.i].coating.n_films > 1 ||
           setup->lens->surface[ghost.j].coating.n_films > 1;
}

/* ------------------------------------------------------------------- zones */

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

/* A zone, or a part of one, that waits to be fitted. BEFORE is the error of the
 * last attempt at the wider zone that it is a piece of. THOROUGH: it is fitted
 * with a box that follows the colours, a root of the energy, and more terms. */
struct pending {
    double lo, hi, before;
    double w0, w1; /* the part of the band, -1 .. 1 */
    bool thorough;
    struct glint_zone_part part;
    int depth; /* number of halvings that led to the part; 0: it is the whole
                  zone */
};

static bool is_whole_band(double w0, double w1)
{
    return w0 <= -1 && w1 >= 1;
}

/* Returns the boxes for the angles and the part of the band of P. */
static const struct glint_visible_profile *profile_of(struct fitter *f,
                                                      const struct pending *p)
{
    const double range[2] = {p->lo, p->hi};
    const double key[4] = {p->lo, p->hi, p->w0, p->w1};

    if (is_whole_band(p->w0, p->w1))
        return &f->profile;
    /* NOLINTNEXTLINE: 0 and -0 may differ: a profile is then found again. */
    if (memcmp(key, f->profiled, sizeof key) != 0) {
        glint_visible_narrow(&f->in_band, f->visible, p->w0, p->w1);
        glint_visible_profile_find(&f->in_band, range, &f->band_profile);
        memcpy(f->profiled, key, sizeof key);
    }
    return &f->band_profile;
}

/* Cuts ZONE to the part of P; returns the visibility of the ghost in its band.
 */
static const struct glint_visible *
cut_out(struct fitter *f, const struct pending *p, struct glint_zone *zone)
{
    const struct glint_zone_part *part = &p->part;
    const struct glint_visible *band =
        is_whole_band(p->w0, p->w1) ? f->visible : &f->in_band;

    glint_zone_cut(zone, part);
    if (is_whole_band(part->w0, part->w1))
        return band;
    glint_visible_narrow(&f->in_part, band, part->w0, part->w1);
    return &f->in_part;
}

/* Cuts the part of P out of ZONE. A thorough fit also crops the part to what is
 * seen: if a ghost comes through in red at one place and in blue at another,
 * much of its box is dark. Returns the visibility of the ghost in the part's
 * band. */
static const struct glint_visible *set_part(struct fitter *f, struct pending *p,
                                            struct glint_zone *zone)
{
    const struct glint_zone uncropped = *zone;
    const struct glint_visible *band = cut_out(f, p, zone);
    double rest = p->thorough ? 0 : 1;

    for (int round = 0; round < CROPS && rest < WORTH_CROP; round++) {
        rest = glint_zone_crop(zone, band, &p->part);
        *zone = uncropped;
        band = cut_out(f, p, zone);
    }
    return band;
}

/* Returns how large the error of places of a zone may be, in tolerances. */
static double bearable(const struct glint_zone_aim *aim)
{
    return PART_LEFT * fmin(aim->hidden, MOST_HIDDEN);
}

/* Returns up to which error, in tolerances, a zone of any width is not halved
 * if that gained nothing; 0: a wide zone always is. */
static double endured(const struct fitter *f, const struct glint_zone_aim *aim)
{
    return f->visible->wide ? bearable(aim) : 0;
}

/* Returns STUCK_DEG, or for wide stops more. Where their rays turn around in
 * the stop, halving angles gains nothing, but parts of the box do, and narrower
 * zones need as many parts each. */
static double stuck_deg(const struct fitter *f)
{
    return f->visible->wide ? WIDE_STUCK * STUCK_DEG : STUCK_DEG;
}

/* Returns how many times P's box may be halved. */
static int most_depth(const struct fitter *f, const struct pending *p)
{
    return p->lo <= 0 ? f->tolerance->axis_depth : GLINT_PART_DEPTH;
}

/* Returns the error, in tolerances, beyond which P will be halved or divided
 * anyway, so that its fit may stop early; 0: there is none. Narrow zones may be
 * at the end of halving, where the error has to be known. */
static double hopeless(const struct fitter *f, const struct pending *p,
                       const struct glint_zone_aim *aim)
{
    if (p->thorough)
        return p->depth < most_depth(f, p) ? HOPELESS * bearable(aim) : 0;
    return degrees_between(p->lo, p->hi) > 2 * stuck_deg(f) ? HALVES_ANYWAY : 0;
}

/* Returns the width of P in degrees for halving, where zones of bright ghosts
 * count twice. */
static double width_of(const struct pending *p,
                       const struct glint_zone_aim *aim)
{
    return degrees_between(p->lo, p->hi) * (aim->ease < BRIGHT_EASE ? 2 : 1);
}

/* Returns the factor on LEAST_DEG and STUCK_DEG for P. */
static double least_of(const struct fitter *f, const struct pending *p)
{
    return p->lo <= 0 ? f->tolerance->axis : 1;
}

/* Returns the error, in tolerances, above which next_step() decides the same
 * for P, and later for its halves, however large the error is; 0: there is
 * none. */
static double settled(const struct fitter *f, const struct pending *p,
                      const struct glint_zone_aim *aim)
{
    const double least = least_of(f, p), width = width_of(p, aim);

    if (p->thorough)
        return p->depth < most_depth(f, p) ? bearable(aim) : 0;
    if (width >= least * stuck_deg(f) && endured(f, aim) > 0)
        return endured(f, aim);
    /* The lower half is the narrower one in degrees. If even that is too wide
     * to be stuck, next_step() does not ask what halving gained. */
    if (degrees_between(p->lo, 0.5 * (p->lo + p->hi)) >= stuck_deg(f) ||
        width < least * LEAST_DEG)
        return 1;
    return width < least * stuck_deg(f) ? fmax(1, STUCK * p->before) : 0;
}

/* The outcome of an attempt at a zone. */
struct attempt {
    struct glint_zone_aim aim;
    /* Errors in tolerances, at most 1 if good; worst is HUGE_VAL if nothing was
     * fitted. */
    struct glint_zone_errors errors;
    double wanders; /* half widths that the box moves or grows over the band */
};

/* Traces and fits ZONE in BAND. If nothing comes through a part of a zone, it
 * gets no outputs. */
static enum glint_status fit_zone(struct fitter *f, const struct pending *p,
                                  const struct glint_zone *zone,
                                  const struct glint_visible *band,
                                  struct glint_fitted_system *system,
                                  struct attempt *a)
{
    struct glint_zone_buffers *buffers = &f->buffers;
    struct glint_zone_task task = {.zone = zone,
                                   .visible = band,
                                   .barrel = f->tolerance->barrel,
                                   .thorough = p->thorough,
                                   .stacks = has_stacks(f->visible)};
    enum glint_status status;

    glint_zone_trace(zone, band, &buffers->rays, &buffers->energies);
    a->errors.worst = 0;
    if ((p->depth > 0 || !is_whole_band(p->w0, p->w1)) &&
        glint_zone_rays_dark(&buffers->rays))
        return GLINT_OK;
    status = set_box(system, zone);
    a->aim = glint_zone_aim_of(f->tolerance, zone, &buffers->rays);
    task.hopeless = hopeless(f, p, &a->aim);
    task.settled = settled(f, p, &a->aim);
    if (status == GLINT_OK)
        status = glint_zone_fit(&task, &a->aim, buffers, system, &a->errors);
    system->met = a->errors.worst <= 1;
    return status;
}

/* Fits P, unless its box or its barrels show that it is too wide. May crop P's
 * part. */
static enum glint_status try_zone(struct fitter *f, struct pending *p,
                                  struct glint_fitted_system *system,
                                  struct attempt *a)
{
    const struct glint_visible_profile *profile = profile_of(f, p);
    const struct glint_visible *band;
    struct glint_zone zone;

    *system = (struct glint_fitted_system){.ghost = f->visible->ghost,
                                           .annulus = p->part.annulus,
                                           .sine_lo = p->lo,
                                           .sine_hi = p->hi};
    *a = (struct attempt){.wanders = 0};
    if (profile->n == 0)
        return GLINT_OK;
    a->errors.worst = HUGE_VAL;
    glint_zone_init(&zone, profile, p->lo, p->hi, p->thorough);
    a->wanders = (fabs(zone.middle[GLINT_BOX_POWERS]) +
                  fabs(zone.half_x[GLINT_BOX_POWERS])) /
                 zone.half_x[0];
    if (!p->thorough && zone.fill < LEAST_FILL &&
        degrees_between(p->lo, p->hi) > FILL_DEG)
        return GLINT_OK;
    band = set_part(f, p, &zone);
    system->wave_lo = band->wave_lo;
    system->wave_hi = band->wave_hi;
    glint_zone_choose_barrels(&zone, band, f->tolerance->escape, &f->sampling,
                              &f->buffers.rays);
    if (!p->thorough && f->buffers.rays.n_barrels > 2 &&
        degrees_between(p->lo, p->hi) > CROWD_DEG)
        return GLINT_OK;
    return fit_zone(f, p, &zone, band, system, a);
}

/* The next step for a zone after attempt A. For bright ghosts zones are halved
 * further. */
enum next { KEEP, HALVE, THOROUGH, BANDS, PART };

static enum next next_step(const struct fitter *f, const struct pending *p,
                           const struct attempt *a)
{
    const double left = a->errors.worst;
    const bool helped = left <= STUCK * p->before;
    const double width = width_of(p, &a->aim), least = least_of(f, p);
    /* Stacks of films make energies swing with the wavelength, which parts of
     * the band follow and narrower zones would not. */
    const bool swings = has_stacks(f->visible) && p->depth == 0 && left > 1 &&
                        left < HUGE_VAL && a->errors.shows <= 1 &&
                        p->w1 - p->w0 > LEAST_BAND;
    const bool stuck = width < least * LEAST_DEG ||
                       (!helped && (width < least * stuck_deg(f) ||
                                    left <= endured(f, &a->aim)));

    if (swings)
        return BANDS;
    if (p->thorough && a->errors.dims <= bearable(&a->aim))
        return KEEP;
    if (p->thorough && p->depth == 0 && a->wanders > WANDERS &&
        p->w1 - p->w0 > LEAST_BAND)
        return BANDS;
    if (p->thorough)
        return p->depth < most_depth(f, p) ? PART : KEEP;
    if (left <= 1)
        return KEEP;
    return stuck && left < HUGE_VAL ? THOROUGH : HALVE;
}

static const struct glint_zone_part whole = {-1, 1, 1, -1, 1, 0};

/* Puts the halves of P on the stack and returns how many entries it has then.
 * Parts are halved along v first, which separates the middle from the rim. */
static int push_halves(struct pending *stack, int n, struct pending p,
                       enum next how)
{
    const double angle = 0.5 * (p.lo + p.hi);
    struct pending a = p, b = p;

    if (how == HALVE) {
        a.hi = b.lo = angle;
    } else if (how == BANDS) {
        a.w1 = b.w0 = 0.5 * (p.w0 + p.w1);
        a.part = b.part = whole;
    } else {
        a.depth = b.depth = p.depth + 1;
        glint_zone_part_halve(&p.part, p.depth % 2 == 0, &a.part, &b.part);
    }
    stack[n] = b;
    stack[n + 1] = a;
    return n + 2;
}

/* Counts the fit of P, which is done if KEPT. */
static void tell(struct fitter *f, const struct pending *p, bool kept)
{
    f->work += p->thorough ? 2 : 1;
    if (kept)
        f->share += (p->hi - p->lo) / f->sines * 0.5 * (p->w1 - p->w0) /
                    (double)(1 << p->depth);
    if (f->told)
        f->told(f->told_ctx, f->work, f->share);
}

/* Fits the zones of a range from the lowest angle up; upper halves wait on a
 * stack. */
static enum glint_status fit_range(struct fitter *f, const double range[2])
{
    /* Fewer than 20 halvings take a zone down to half of LEAST_DEG, or at the
     * axis to a tenth of that. */
    enum { DEEP = 24 + BAND_DEPTH + GLINT_MAX_AXIS_DEPTH };
    struct pending stack[DEEP] = {
        {range[0], range[1], HUGE_VAL, -1, 1, false, whole, 0}};
    enum glint_status status = GLINT_OK;
    int n = 1;

    glint_visible_profile_find(f->visible, range, &f->profile);
    if (f->profile.n == 0)
        return GLINT_OK;
    while (n > 0 && status == GLINT_OK) {
        struct pending p = stack[--n];
        struct glint_fitted_system system;
        struct attempt attempt;
        enum next next = KEEP;

        status = try_zone(f, &p, &system, &attempt);
        if (status == GLINT_OK)
            next = n + 2 > DEEP ? KEEP : next_step(f, &p, &attempt);
        tell(f, &p, next == KEEP);
        if (p.depth == 0 && p.w0 <= -1)
            f->n_parts = 0;
        system.part = f->n_parts;
        if (status == GLINT_OK && next == KEEP && system.n_outputs > 0) {
            status = glint_fitted_append(f->out, &system);
            f->n_parts++;
        } else {
            glint_fitted_drop(&system);
        }
        p.before = attempt.errors.worst;
        p.thorough |= next == THOROUGH || next == BANDS;
        if (next == THOROUGH) {
            stack[n++] = p;
        } else if (next != KEEP) {
            n = push_halves(stack, n, p, next);
        }
    }
    return status;
}

enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  glint_fit_told_fn *told, void *ctx,
                                  struct glint_fitted_ghost *out)
{
    struct fitter *f = calloc(1, sizeof *f);
    enum glint_status status = GLINT_E_MEMORY;
    double range[GLINT_MAX_RANGES][2];

    *out = (struct glint_fitted_ghost){0};
    if (!f)
        return status;
    f->visible = visible;
    f->tolerance = tolerance;
    /* There is no profile of a part of the band yet. */
    f->profiled[0] = HUGE_VAL;
    f->out = out;
    f->told = told;
    f->told_ctx = ctx;
    f->buffers.scratch =
        malloc(GLINT_ZONE_SCRATCH * sizeof *f->buffers.scratch);
    if (f->buffers.scratch) {
        const int n = glint_visible_ranges(visible, max_deg, range);

        status = GLINT_OK;
        for (int k = 0; k < n; k++)
            f->sines += range[k][1] - range[k][0];
        for (int k = 0; k < n && status == GLINT_OK; k++)
            status = fit_range(f, range[k]);
    }
    free(f->buffers.scratch);
    free(f);
    return status;
}
