/* SPDX-License-Identifier: MIT */
#include "bake/fit/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/setup/degrees.h"
#include "bake/fit/next.h"

/* Min fraction of a zone's box that visible light must fill. In emptier boxes
 * most cells of the ray grids would be wasted. */
#define LEAST_FILL 0.33
/* Max width of a zone with more than two barrels, degrees; wider ones are
 * halved. A vertex stores radii at two barrels only. */
#define CROWD_DEG 1.5
/* Zones narrower than this, degrees, may fill less than LEAST_FILL of their
 * boxes. */
#define FILL_DEG 0.6
/* A part of a box is cropped again if the last crop left less than this
 * fraction of its size. */
#define WORTH_CROP 0.8

enum {
    /* max number of times that a zone's band is halved; follows from
     * LEAST_BAND */
    BAND_DEPTH = 2,
    CROPS = 2 /* max number of times that a part of a box is cropped */
};

struct fitter {
    const struct glint_visible *visible;
    const struct glint_tolerance *tolerance;
    /* rules for dividing zones, from visible and tolerance */
    struct glint_next_rules rules;
    struct glint_fitted_ghost *out;
    struct glint_zone_buffers buffers;
    glint_zone_sampling sampling;
    struct glint_visible_profile profile;
    struct glint_visible in_band, in_part;
    struct glint_visible beside_band[GLINT_MAX_BESIDE];
    struct glint_visible beside_part[GLINT_MAX_BESIDE];
    struct glint_visible_profile band_profile;
    /* angles and band to which band_profile applies: lo, hi, w0, w1 */
    double profiled[4];
    /* number of fitted parts of the current zone's box */
    int n_parts;
    glint_fit_progress_fn *progress; /* NULL: no progress reports */
    void *progress_ctx;
    double work, share; /* arguments of the next call of progress() */
    double sines; /* sum of the widths of all visible angle ranges, sines */
};

/* ------------------------------------------------------------------- zones */

static enum glint_status copy_zone_box(struct glint_fitted_system *system,
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

static bool is_full_band(double w0, double w1)
{
    return w0 <= -1 && w1 >= 1;
}

/* Returns the visible boxes at all angles of the zone for the band of P.
 * Computes them only if the band or the angles have changed. */
static const struct glint_visible_profile *
find_band_profile(struct fitter *f, const struct glint_zone_piece *p)
{
    const double range[2] = {p->lo, p->hi};
    const double key[4] = {p->lo, p->hi, p->w0, p->w1};

    if (is_full_band(p->w0, p->w1))
        return &f->profile;
    /* NOLINTNEXTLINE: -0 != 0 here only recomputes a profile */
    if (memcmp(key, f->profiled, sizeof key) != 0) {
        glint_visible_narrow_band(&f->in_band, f->visible, p->w0, p->w1);
        glint_visible_find_profile(&f->in_band, range, &f->band_profile);
        memcpy(f->profiled, key, sizeof key);
    }
    return &f->band_profile;
}

/* Cuts the box and band of ZONE to the part of P. Returns the visibility of the
 * ghost in the part's band. */
static const struct glint_visible *
cut_zone_to_part(struct fitter *f, const struct glint_zone_piece *p,
                 struct glint_zone *zone)
{
    const struct glint_zone_part *part = &p->part;
    const struct glint_visible *band =
        is_full_band(p->w0, p->w1) ? f->visible : &f->in_band;

    glint_zone_cut_to_part(zone, part);
    if (is_full_band(part->w0, part->w1))
        return band;
    glint_visible_narrow_band(&f->in_part, band, part->w0, part->w1);
    return &f->in_part;
}

/* Cuts ZONE to the part of P. If P is thorough, first crops the part to its
 * visible region, because much of the box is dark if red and blue light enter
 * at different places. Returns the visibility of the ghost in the part's
 * band. */
static const struct glint_visible *crop_zone_to_part(struct fitter *f,
                                                     struct glint_zone_piece *p,
                                                     struct glint_zone *zone)
{
    const struct glint_zone uncropped = *zone;
    const struct glint_visible *band = cut_zone_to_part(f, p, zone);
    double rest = p->thorough ? 0 : 1;

    for (int round = 0; round < CROPS && rest < WORTH_CROP; round++) {
        rest = glint_zone_crop_part(zone, band, &p->part);
        *zone = uncropped;
        band = cut_zone_to_part(f, p, zone);
    }
    return band;
}

/* Traces rays of ZONE within BAND and fits its outputs. HAS_BARRELS: its
 * barrels are chosen already. Adds no outputs if no light passes the part. */
static enum glint_status
fit_zone_outputs(struct fitter *f, const struct glint_zone_piece *p,
                 const struct glint_zone *zone,
                 const struct glint_visible *band, bool has_barrels,
                 struct glint_fitted_system *system, struct glint_attempt *a)
{
    struct glint_zone_buffers *buffers = &f->buffers;
    struct glint_zone_task task = {
        .zone = zone,
        .visible = band,
        .tolerance = f->tolerance,
        .barrel = f->tolerance->barrel,
        .thorough = p->thorough,
        .stacks = glint_next_has_film_stack(f->visible),
        .sampling = has_barrels ? NULL : &f->sampling};
    enum glint_status status;

    if (!has_barrels)
        buffers->rays.n_barrels = 0;
    glint_zone_trace_rays(zone, band, &buffers->rays);
    a->errors.worst = 0;
    if ((p->depth > 0 || !is_full_band(p->w0, p->w1)) &&
        glint_zone_rays_are_all_blocked(&buffers->rays))
        return GLINT_OK;
    status = copy_zone_box(system, zone);
    a->aim =
        glint_zone_aim_compute_tolerances(f->tolerance, zone, &buffers->rays);
    task.hopeless = glint_next_get_hopeless_error(&f->rules, p, &a->aim);
    task.settled = glint_next_get_settled_error(&f->rules, p, &a->aim);
    if (status == GLINT_OK)
        status =
            glint_zone_fit_outputs(&task, &a->aim, buffers, system, &a->errors);
    system->met = a->errors.worst <= 1;
    return status;
}

/* Fits the zone or part P, and may crop it. Sets an infinite error without
 * fitting, so that P is halved, if visible light fills too little of the box or
 * if too many barrels block rays. */
static enum glint_status try_zone_fit(struct fitter *f,
                                      struct glint_zone_piece *p,
                                      struct glint_fitted_system *system,
                                      struct glint_attempt *a)
{
    const struct glint_visible_profile *profile = find_band_profile(f, p);
    /* true: the zone may be too wide for the number of its barrels */
    const bool crowds = !p->thorough && !f->visible->shaped &&
                        glint_next_compute_width_deg(p->lo, p->hi) > CROWD_DEG;
    const struct glint_visible *band;
    struct glint_zone zone;

    *system = (struct glint_fitted_system){.ghost = f->visible->ghost,
                                           .annulus = p->part.annulus,
                                           .sine_lo = p->lo,
                                           .sine_hi = p->hi};
    *a = (struct glint_attempt){.wanders = 0};
    if (profile->n == 0)
        return GLINT_OK;
    a->errors.worst = HUGE_VAL;
    glint_zone_init(&zone, profile, p->lo, p->hi, p->thorough);
    a->wanders = (fabs(zone.middle[GLINT_BOX_POWERS]) +
                  fabs(zone.half_x[GLINT_BOX_POWERS])) /
                 zone.half_x[0];
    if (!p->thorough && zone.fill < LEAST_FILL &&
        glint_next_compute_width_deg(p->lo, p->hi) > FILL_DEG)
        return GLINT_OK;
    band = crop_zone_to_part(f, p, &zone);
    system->wave_lo = band->wave_lo;
    system->wave_hi = band->wave_hi;
    if (crowds)
        glint_zone_choose_barrels(&zone, band, f->tolerance->escape,
                                  &f->sampling, &f->buffers.rays);
    if (crowds && f->buffers.rays.n_barrels > 2)
        return GLINT_OK;
    return fit_zone_outputs(f, p, &zone, band, crowds, system, a);
}

static const struct glint_zone_part full_part = {-1, 1, 1, -1, 1, 0};

/* Pushes both halves of P onto STACK and returns the new number of entries. HOW
 * selects what is halved: the angles, the band or the box. Boxes are halved
 * along v first, which separates the pupil's centre from its rim. */
static int push_piece_halves(struct glint_zone_piece *stack, int n,
                             struct glint_zone_piece p, enum glint_next how)
{
    const double angle = 0.5 * (p.lo + p.hi);
    struct glint_zone_piece a = p, b = p;

    if (how == GLINT_HALVE) {
        a.hi = b.lo = angle;
    } else if (how == GLINT_BANDS) {
        a.w1 = b.w0 = 0.5 * (p.w0 + p.w1);
        a.part = b.part = full_part;
    } else {
        a.depth = b.depth = p.depth + 1;
        glint_zone_halve_part(&p.part, p.depth % 2 == 0, &a.part, &b.part);
    }
    stack[n] = b;
    stack[n + 1] = a;
    return n + 2;
}

/* Adds the fit of P to the reported work. ACCEPTED: the fit is final, so the
 * angles of P are done. Returns the status of the callback progress().
 */
static enum glint_status record_zone_fit(struct fitter *f,
                                         const struct glint_zone_piece *p,
                                         bool accepted)
{
    f->work += p->thorough ? 2 : 1;
    if (accepted)
        f->share += (p->hi - p->lo) / f->sines * 0.5 * (p->w1 - p->w0) /
                    (double)(1 << p->depth);
    return f->progress ? f->progress(f->progress_ctx, f->work, f->share)
                       : GLINT_OK;
}

/* Fits all zones of the angle range RANGE, sines, in ascending order. The upper
 * halves of divided zones wait on a stack. */
static enum glint_status fit_angle_range(struct fitter *f,
                                         const double range[2])
{
    /* Zones shrink to half of LEAST_DEG in less than 20 halvings; at the axis
     * to a tenth of that. */
    enum { DEEP = 24 + BAND_DEPTH + GLINT_MAX_AXIS_DEPTH };
    struct glint_zone_piece stack[DEEP] = {
        {range[0], range[1], HUGE_VAL, -1, 1, false, full_part, 0}};
    enum glint_status status = GLINT_OK;
    int n = 1;

    glint_visible_find_profile(f->visible, range, &f->profile);
    if (f->profile.n == 0)
        return GLINT_OK;
    while (n > 0 && status == GLINT_OK) {
        struct glint_zone_piece p = stack[--n];
        struct glint_fitted_system system;
        struct glint_attempt attempt;
        enum glint_next next = GLINT_KEEP;

        status = try_zone_fit(f, &p, &system, &attempt);
        if (status == GLINT_OK) {
            next = n + 2 > DEEP
                       ? GLINT_KEEP
                       : glint_next_choose_step(&f->rules, &p, &attempt);
            status = record_zone_fit(f, &p, next == GLINT_KEEP);
        }
        if (p.depth == 0 && p.w0 <= -1)
            f->n_parts = 0;
        system.part = f->n_parts;
        if (status == GLINT_OK && next == GLINT_KEEP && system.n_outputs > 0) {
            status = glint_fitted_append_system(f->out, &system);
            f->n_parts++;
        } else {
            glint_fitted_free_system(&system);
        }
        p.before = attempt.errors.worst;
        p.thorough |= next == GLINT_THOROUGH || next == GLINT_BANDS;
        if (next == GLINT_THOROUGH) {
            stack[n++] = p;
        } else if (next != GLINT_KEEP) {
            n = push_piece_halves(stack, n, p, next);
        }
    }
    return status;
}

enum glint_status glint_fit_ghost(const struct glint_visible *visible,
                                  double max_deg,
                                  const struct glint_tolerance *tolerance,
                                  glint_fit_progress_fn *progress, void *ctx,
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
    f->rules = (struct glint_next_rules){visible, tolerance};
    f->in_band.beside = f->beside_band;
    f->in_part.beside = f->beside_part;
    /* marks that no band_profile has been computed yet */
    f->profiled[0] = HUGE_VAL;
    f->out = out;
    f->progress = progress;
    f->progress_ctx = ctx;
    f->buffers.scratch =
        malloc(GLINT_ZONE_SCRATCH * sizeof *f->buffers.scratch);
    if (f->buffers.scratch) {
        const int n = glint_visible_find_ranges(visible, max_deg, range);

        status = GLINT_OK;
        for (int k = 0; k < n; k++)
            f->sines += range[k][1] - range[k][0];
        for (int k = 0; k < n && status == GLINT_OK; k++)
            status = fit_angle_range(f, range[k]);
    }
    free(f->buffers.scratch);
    free(f);
    return status;
}
