/* SPDX-License-Identifier: MIT */
#include "bake/skew/skew_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/fit/next.h"
#include "bake/fit/zone_fit.h"
#include "bake/skew/directions.h"
#include "engine/setup/degrees.h"

/* Largest side of a patch, as a difference of sines. */
#define MOST_SIDE 0.22
/* A smaller patch is not halved. */
#define LEAST_SIDE 0.04
/* A smaller one is kept if halving gained nothing and its error is endured. */
#define STUCK_SIDE 0.12
/* Share of the error of the whole patch: see fit.c. */
#define STUCK   0.75
#define ENDURED 3.0
/* Least share of a box that a ghost must fill, in patches wider than FILL_SIDE.
 */
#define LEAST_FILL 0.25
#define FILL_SIDE  0.05
/* Tolerances: the fit of a patch with a larger error is given up. */
#define HOPELESS 10.0
/* Width of a band in w, 0 .. 2: narrower ones are not halved. */
#define LEAST_BAND 0.6
/* Boxes that move so many times as much along one component as along the other
 * are halved along that. */
#define MOVES 2.0
/* Fill of a box in which grids miss nothing that they would find elsewhere. */
#define SOLID 0.08

enum { DEEP = 64 };

struct fitter {
    const struct glint_visible *visible;
    const struct glint_tolerance *tolerance;
    double sine_hi;
    struct glint_fitted_ghost *out;
    struct glint_zone_buffers buffers;
    glint_zone_sampling sampling;
    struct glint_visible in_band;
    struct glint_sights sights;
    glint_fit_told_fn *told;
    void *told_ctx;
    double work, share, area; /* area: of all patches */
};

/* A patch that waits to be fitted. */
struct pending {
    struct glint_directions patch;
    double w0, w1, before;
    int depth;
    bool known; /* true: WITHIN holds all light that comes through */
    struct glint_zone within;
};

/* What became of a patch. */
struct attempt {
    struct glint_zone zone;
    struct glint_zone_errors errors; /* worst: HUGE_VAL if nothing was fitted */
    double hidden;
    bool dark;
};

uint32_t glint_skew_mirrors(const struct glint_prescription *lens)
{
    uint32_t mirrors = GLINT_MIRRORS_X | GLINT_MIRRORS_Y;

    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_shape *const a = &lens->surface[k].shape;

        /* A turn about the y axis moves what lies at x. */
        if (a->decentre_mm[0] != 0.0 || a->tilt_deg[1] != 0.0)
            mirrors &= ~(uint32_t)GLINT_MIRRORS_X;
        if (a->decentre_mm[1] != 0.0 || a->tilt_deg[0] != 0.0)
            mirrors &= ~(uint32_t)GLINT_MIRRORS_Y;
    }
    return mirrors;
}

static double larger_side(const struct glint_directions *p)
{
    return fmax(p->x1 - p->x0, p->y1 - p->y0);
}

static double area_of(const struct pending *p)
{
    return (p->patch.x1 - p->patch.x0) * (p->patch.y1 - p->patch.y0) * 0.5 *
           (p->w1 - p->w0);
}

static enum glint_status set_box(struct glint_fitted_system *system,
                                 const struct glint_zone *zone)
{
    const double *const side[GLINT_LENS_SIDES] = {zone->middle, zone->half_x,
                                                  zone->half_y, zone->middle_y};

    system->box =
        malloc(sizeof *system->box * GLINT_LENS_SIDES * GLINT_BOX_TERMS);
    if (!system->box)
        return GLINT_E_MEMORY;
    for (int k = 0; k < GLINT_LENS_SIDES; k++)
        memcpy(system->box + k * GLINT_BOX_TERMS, side[k],
               sizeof *system->box * GLINT_BOX_TERMS);
    return GLINT_OK;
}

static bool may_halve(const struct pending *p)
{
    return larger_side(&p->patch) > LEAST_SIDE && p->depth < DEEP - 2;
}

/* Fits the zone of A in BAND. */
static enum glint_status fit_zone(struct fitter *f, const struct pending *p,
                                  const struct glint_visible *band,
                                  struct glint_fitted_system *system,
                                  struct attempt *a)
{
    const double side = larger_side(&p->patch);
    struct glint_zone_buffers *const b = &f->buffers;
    struct glint_zone_task task = {.zone = &a->zone,
                                   .visible = band,
                                   .barrel = f->tolerance->barrel,
                                   .thorough = !may_halve(p),
                                   .stacks = glint_next_stacks(f->visible),
                                   .hopeless = may_halve(p) ? HOPELESS : 0,
                                   .settled =
                                       may_halve(p) && side > STUCK_SIDE};
    struct glint_zone_aim aim;
    enum glint_status status;

    glint_zone_choose_barrels(&a->zone, band, f->tolerance->escape,
                              &f->sampling, &b->rays);
    glint_zone_trace(&a->zone, band, &b->rays, &b->energies);
    /* A sliver at the rim of the patch is seen by its halves. */
    if (glint_zone_rays_dark(&b->rays))
        return GLINT_OK;
    status = set_box(system, &a->zone);
    aim = glint_zone_aim_of(f->tolerance, &a->zone, &b->rays);
    a->hidden = aim.hidden;
    if (status == GLINT_OK)
        status = glint_zone_fit(&task, &aim, b, system, &a->errors);
    system->met = a->errors.worst <= 1;
    return status;
}

static enum glint_status try_patch(struct fitter *f, const struct pending *p,
                                   struct glint_fitted_system *system,
                                   struct attempt *a)
{
    const struct glint_visible *band = f->visible;

    if (p->w0 > -1 || p->w1 < 1) {
        glint_visible_narrow(&f->in_band, f->visible, p->w0, p->w1);
        band = &f->in_band;
    }
    *system = (struct glint_fitted_system){.ghost = f->visible->ghost,
                                           .sine_lo = p->patch.x0,
                                           .sine_hi = p->patch.x1,
                                           .skew = true,
                                           .y_lo = p->patch.y0,
                                           .y_hi = p->patch.y1,
                                           .wave_lo = band->wave_lo,
                                           .wave_hi = band->wave_hi};
    *a = (struct attempt){.errors = {.worst = HUGE_VAL, .shows = HUGE_VAL}};
    glint_sights_find(band, &p->patch, f->sine_hi, p->known ? &p->within : NULL,
                      &f->sights);
    a->dark = f->sights.n == 0;
    if (a->dark)
        return GLINT_OK;
    glint_sights_zone(&f->sights, &p->patch, &a->zone);
    if (a->zone.fill < LEAST_FILL && larger_side(&p->patch) > FILL_SIDE)
        return GLINT_OK;
    return fit_zone(f, p, band, system, a);
}

enum next { KEEP, HALVE, BANDS };

static enum next next_step(const struct fitter *f, const struct pending *p,
                           const struct attempt *a)
{
    const double left = a->errors.worst, side = larger_side(&p->patch);
    const bool helped = left <= STUCK * p->before;

    if (a->dark || left <= 1 || !may_halve(p))
        return KEEP;
    if (glint_next_stacks(f->visible) && a->errors.shows <= 1 &&
        p->w1 - p->w0 > LEAST_BAND)
        return BANDS;
    return !helped && side < STUCK_SIDE &&
                   left <= fmin(HOPELESS, ENDURED * fmin(a->hidden, 3.0))
               ? KEEP
               : HALVE;
}

/* Returns how much the box moves and grows with terms FIRST and SQUARE, over
 * its half sizes. */
static double moves(const struct glint_zone *z, int first, int square)
{
    return (fabs(z->middle[first]) + fabs(z->middle[square]) +
            fabs(z->half_x[first])) /
               fmax(1e-9, z->half_x[0]) +
           (fabs(z->middle_y[first]) + fabs(z->middle_y[square]) +
            fabs(z->half_y[first])) /
               fmax(1e-9, z->half_y[0]);
}

/* Returns whether to halve along y. */
static bool is_along_y(const struct pending *p, const struct glint_zone *zone)
{
    const double x = moves(zone, 1, 2), y = moves(zone, 3, 5);
    const double wide = p->patch.x1 - p->patch.x0;
    const double high = p->patch.y1 - p->patch.y0;

    if (wide > 3 * high || high > 3 * wide)
        return high > wide;
    if (x > MOVES * y || y > MOVES * x)
        return y > x;
    return high > wide || (high == wide && p->depth % 2);
}

static int push_halves(struct pending *stack, int n, const struct pending *p,
                       const struct glint_zone *zone, enum next how)
{
    struct pending a = *p, b = *p;

    a.depth = b.depth = p->depth + 1;
    a.within = b.within = *zone;
    a.known = b.known = how == HALVE && zone->fill > SOLID;
    if (how == BANDS)
        a.w1 = b.w0 = 0.5 * (p->w0 + p->w1);
    else if (is_along_y(p, zone))
        a.patch.y1 = b.patch.y0 = 0.5 * (p->patch.y0 + p->patch.y1);
    else
        a.patch.x1 = b.patch.x0 = 0.5 * (p->patch.x0 + p->patch.x1);
    stack[n] = b;
    stack[n + 1] = a;
    return n + 2;
}

/* Fits PATCH and, if it has to be, its halves. */
static enum glint_status fit_patch(struct fitter *f,
                                   const struct glint_directions *patch)
{
    struct pending stack[DEEP + 2] = {
        {.patch = *patch, .w0 = -1, .w1 = 1, .before = HUGE_VAL}};
    enum glint_status status = GLINT_OK;

    for (int n = 1; n > 0 && status == GLINT_OK;) {
        struct pending p = stack[--n];
        struct glint_fitted_system system = {.ghost = f->visible->ghost};
        struct attempt a = {.dark = true};
        enum next next = KEEP;

        if (glint_directions_nearest(&p.patch) < f->sine_hi)
            status = try_patch(f, &p, &system, &a);
        if (status == GLINT_OK)
            next = next_step(f, &p, &a);
        f->work++;
        f->share += next == KEEP ? area_of(&p) / f->area : 0;
        if (f->told)
            f->told(f->told_ctx, f->work, f->share);
        if (status == GLINT_OK && next == KEEP && system.n_outputs > 0)
            status = glint_fitted_append(f->out, &system);
        else
            glint_fitted_drop(&system);
        p.before = a.errors.worst;
        if (next != KEEP)
            n = push_halves(stack, n, &p, &a.zone, next);
    }
    return status;
}

/* Fits all patches, beginning with squares as large as they may be. */
static enum glint_status fit_all(struct fitter *f, uint32_t mirrors)
{
    const int half = (int)ceil(f->sine_hi / MOST_SIDE);
    const double side = f->sine_hi / half;
    const int i0 = mirrors & GLINT_MIRRORS_X ? 0 : -half;
    const int j0 = mirrors & GLINT_MIRRORS_Y ? 0 : -half;
    enum glint_status status = GLINT_OK;

    f->area = side * side * (half - i0) * (half - j0);
    for (int j = j0; j < half; j++)
        for (int i = i0; i < half && status == GLINT_OK; i++) {
            const struct glint_directions patch = {i * side, (i + 1) * side,
                                                   j * side, (j + 1) * side};

            status = fit_patch(f, &patch);
        }
    return status;
}

enum glint_status glint_skew_fit(const struct glint_visible *visible,
                                 double max_deg,
                                 const struct glint_tolerance *tolerance,
                                 glint_fit_told_fn *told, void *ctx,
                                 struct glint_fitted_ghost *out)
{
    struct fitter *f = calloc(1, sizeof *f);
    enum glint_status status = GLINT_E_MEMORY;

    *out = (struct glint_fitted_ghost){0};
    if (!f)
        return status;
    f->visible = visible;
    f->tolerance = tolerance;
    f->sine_hi = glint_sin_deg(max_deg);
    f->out = out;
    f->told = told;
    f->told_ctx = ctx;
    f->buffers.scratch =
        malloc(GLINT_ZONE_SCRATCH * sizeof *f->buffers.scratch);
    if (f->buffers.scratch)
        status = fit_all(f, glint_skew_mirrors(visible->setup->lens));
    free(f->buffers.scratch);
    free(f);
    return status;
}
