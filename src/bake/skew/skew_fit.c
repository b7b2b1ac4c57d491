/* SPDX-License-Identifier: MIT */
#include "bake/skew/skew_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/fit/next.h"
#include "bake/fit/zone_fit.h"
#include "bake/skew/directions.h"
#include "bake/skew/pieces.h"
#include "engine/setup/degrees.h"

/* max width and height of a patch, as a difference of sines */
#define MOST_SIDE 0.22
/* patches whose larger side is at most this difference of sines are not
 * halved */
#define LEAST_SIDE 0.04
/* A patch is accepted although its error is above attempt.kept if three
 * conditions hold: its larger side is below this difference of sines, the last
 * halving did not help, and its error is at most attempt.bearable. */
#define STUCK_SIDE 0.12
/* Halving a patch did not help if a half still has more than this fraction of
 * the patch's error. */
#define STUCK 0.75
/* LEAST_FILL: min fraction of a pupil box that visible light must fill;
 * otherwise the patch is halved. Applies only to patches whose larger side is
 * above FILL_SIDE, a difference of sines. */
#define LEAST_FILL 0.25
#define FILL_SIDE  0.05
/* Min error, in tolerances, at which the fit of a patch is abandoned. */
#define HOPELESS 10.0
/* Min width in w (0 .. 2) of a band that is halved. */
#define LEAST_BAND 0.6
/* If visible light fills more than this fraction of a patch's pupil box, the
 * search for light in its two halves is limited to this box. The search grid is
 * then fine enough not to miss light. */
#define SOLID 0.08
/* PART_LEFT: min error, in tolerances, at which a pupil box is divided into
 * parts (see next.c). MOST_HIDDEN: upper limit of the factor that raises
 * PART_LEFT for ghosts so faint that errors are invisible. */
#define PART_LEFT   5.0
#define MOST_HIDDEN 3.0
/* A part of a box is accepted if its error is at most this fraction of
 * attempt.bearable. */
#define PART_KEPT 0.4
/* Ratio of the error to attempt.bearable above which a fit stops early and the
 * box is divided. */
#define PART_HOPELESS 20.0
/* max number of halvings of a box */
#define MOST_PARTS 5
/* The box is divided instead of the patch if dividing the box would remove at
 * least this many times as much of the error. Parts of a box cost more at run
 * time: each light draws all parts of a box, but uses only one patch. */
#define RATHER 1.5
/* Limits of a ghost's ease, the factor by which its tolerances are raised
 * because it is faint. Below NOT_FAINT only errors within the tolerance are
 * accepted at once; above FAINT errors up to attempt.bearable are. Between them
 * the limit is interpolated. */
#define NOT_FAINT 1.5
#define FAINT     6.0
/* Constants of the work estimate, measured with anamorphic-schneider baked up
 * to 4 and up to 8 degrees. SEEN_DEG: angle from the axis beyond which few
 * ghosts have light. HEAD: zone fits per ghost and direction. PER_AREA: zone
 * fits per ghost, surface and unit of area; the area is that of all directions,
 * in sines. */
#define SEEN_DEG 25.0
#define HEAD     0.16
#define PER_AREA 175.0

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
    glint_fit_progress_fn *progress;
    void *progress_ctx;
    /* work: number of fits so far; share: fraction of the area that is done;
     * both are passed to progress(). area: total area of all patches. */
    double work, share, area;
};

/* result of an attempt to fit a patch */
struct attempt {
    /* errors of the fit; worst is HUGE_VAL if nothing was fitted */
    struct glint_zone_errors errors;
    double bearable; /* error, in tolerances, above which the box is divided */
    /* max error, in tolerances, with which the patch is accepted at once */
    double kept;
    bool dark;
};

void glint_skew_estimate_work(const struct glint_prescription *lens,
                              int n_ghosts, double max_deg, double tolerance,
                              double *head, double *typical)
{
    const uint32_t mirrors = glint_skew_find_mirror_planes(lens);
    const int quarters = (mirrors & GLINT_MIRRORS_X ? 1 : 2) *
                         (mirrors & GLINT_MIRRORS_Y ? 1 : 2);
    /* few ghosts have light beyond SEEN_DEG */
    const double side = glint_sin_deg(fmin(max_deg, SEEN_DEG));

    /* brightness is measured at up to 30 directions */
    *head = HEAD * n_ghosts * fmin(30, 3 + 2 * max_deg / 3);
    *typical = 1 + PER_AREA * lens->n_surfaces * quarters * side * side *
                       pow(tolerance, -0.7);
}

static struct glint_directions get_piece_patch(const struct glint_skew_piece *p)
{
    const struct glint_zone *const z = &p->zone;

    return (struct glint_directions){z->lo, z->hi, z->y_lo, z->y_hi};
}

static double compute_patch_width(const struct glint_skew_piece *p)
{
    return p->zone.hi - p->zone.lo;
}

static double compute_patch_height(const struct glint_skew_piece *p)
{
    return p->zone.y_hi - p->zone.y_lo;
}

static double compute_larger_patch_side(const struct glint_skew_piece *p)
{
    return fmax(compute_patch_width(p), compute_patch_height(p));
}

static double compute_piece_area(const struct glint_skew_piece *p)
{
    return ldexp(compute_patch_width(p) * compute_patch_height(p) * 0.5 *
                     (p->w1 - p->w0),
                 -p->parts);
}

static enum glint_status copy_zone_box(struct glint_fitted_system *system,
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

static bool can_halve_patch(const struct glint_skew_piece *p)
{
    return compute_larger_patch_side(p) > LEAST_SIDE && p->depth < DEEP - 2;
}

static bool can_divide_box(const struct glint_skew_piece *p)
{
    return p->parts < MOST_PARTS && p->depth < DEEP - 2;
}

/* Sets the limits bearable and kept for the error of attempt A. */
static void set_attempt_error_limits(const struct glint_skew_piece *p,
                                     const struct glint_zone_aim *aim,
                                     struct attempt *a)
{
    const double faint =
        fmin(1, fmax(0, (aim->ease - NOT_FAINT) / (FAINT - NOT_FAINT)));

    a->bearable = PART_LEFT * fmin(aim->hidden, MOST_HIDDEN);
    a->kept =
        p->parts > 0 ? PART_KEPT * a->bearable : 1 + faint * (a->bearable - 1);
}

/* Fits the outputs of P's zone. BAND: visibility of the ghost in the band of
 * P. */
static enum glint_status fit_piece_zone(struct fitter *f,
                                        const struct glint_skew_piece *p,
                                        const struct glint_visible *band,
                                        struct glint_fitted_system *system,
                                        struct attempt *a)
{
    const bool settled =
        can_halve_patch(p) && compute_larger_patch_side(p) > STUCK_SIDE;
    struct glint_zone_buffers *const b = &f->buffers;
    struct glint_zone_task task = {.zone = &p->zone,
                                   .tolerance = f->tolerance,
                                   .visible = band,
                                   .barrel = f->tolerance->barrel,
                                   .thorough = !settled,
                                   .stacks =
                                       glint_next_has_film_stack(f->visible)};
    struct glint_zone_aim aim;
    enum glint_status status;

    glint_zone_choose_barrels(&p->zone, band, f->tolerance->escape,
                              &f->sampling, &b->rays);
    glint_zone_trace_rays(&p->zone, band, &b->rays);
    /* If light passes only at the rim of the patch, none of the sampled rays
     * shows it. The halves of the patch are then fitted instead. */
    if (glint_zone_rays_are_all_blocked(&b->rays))
        return GLINT_OK;
    status = copy_zone_box(system, &p->zone);
    aim = glint_zone_aim_compute_tolerances(f->tolerance, &p->zone, &b->rays);
    set_attempt_error_limits(p, &aim, a);
    task.settled = settled ? a->kept : 0;
    task.hopeless = can_halve_patch(p)  ? fmax(HOPELESS, a->kept)
                    : can_divide_box(p) ? PART_HOPELESS * a->bearable
                                        : 0;
    if (status == GLINT_OK)
        status = glint_zone_fit_outputs(&task, &aim, b, system, &a->errors);
    system->met = a->errors.worst <= 1;
    return status;
}

/* Sets the pupil box of P. Returns whether P should be fitted: light passes,
 * and visible light fills enough of the box. */
static bool find_piece_box(struct fitter *f, struct glint_skew_piece *p,
                           const struct glint_visible *band, struct attempt *a)
{
    const struct glint_directions patch = get_piece_patch(p);
    const struct glint_zone within = p->zone;

    if (p->parts > 0) {
        glint_piece_crop_box(p, band);
        return true;
    }
    glint_sights_find_boxes(band, &patch, f->sine_hi, p->known ? &within : NULL,
                            &f->sights);
    a->dark = f->sights.n == 0;
    if (a->dark)
        return false;
    glint_sights_fit_zone(&f->sights, &patch, &p->zone);
    return p->zone.fill >= LEAST_FILL ||
           compute_larger_patch_side(p) <= FILL_SIDE;
}

static enum glint_status try_piece_fit(struct fitter *f,
                                       struct glint_skew_piece *p,
                                       struct glint_fitted_system *system,
                                       struct attempt *a)
{
    const struct glint_visible *band = f->visible;

    if (p->w0 > -1 || p->w1 < 1) {
        glint_visible_narrow_band(&f->in_band, f->visible, p->w0, p->w1);
        band = &f->in_band;
    }
    *system = (struct glint_fitted_system){.ghost = f->visible->ghost,
                                           .sine_lo = p->zone.lo,
                                           .sine_hi = p->zone.hi,
                                           .skew = true,
                                           .y_lo = p->zone.y_lo,
                                           .y_hi = p->zone.y_hi,
                                           .wave_lo = band->wave_lo,
                                           .wave_hi = band->wave_hi};
    *a = (struct attempt){.errors = {.places = HUGE_VAL, .worst = HUGE_VAL},
                          .bearable = PART_LEFT};
    return find_piece_box(f, p, band, a) ? fit_piece_zone(f, p, band, system, a)
                                         : GLINT_OK;
}

/* ------------------------------------------------------------------ halves */

enum { KEEP = -1 };

/* Returns how much the pupil box moves and grows over the range of one
 * variable, relative to its half sizes. FIRST, SQUARE: indices of the linear
 * and the quadratic term of this variable in the box polynomials. */
static double compute_box_motion(const struct glint_zone *z, int first,
                                 int square)
{
    return (fabs(z->middle[first]) + fabs(z->middle[square]) +
            fabs(z->half_x[first])) /
               fmax(1e-9, z->half_x[0]) +
           (fabs(z->middle_y[first]) + fabs(z->middle_y[square]) +
            fabs(z->half_y[first])) /
               fmax(1e-9, z->half_y[0]);
}

/* Returns the direction component, GLINT_S or GLINT_P, in which to halve P.
 * SHARE: fraction of the error that halving each variable would remove. */
static int choose_direction_component(const struct glint_skew_piece *p,
                                      const double share[GLINT_VARIABLES])
{
    const double times = 2;

    if (compute_patch_width(p) > 3 * compute_patch_height(p) ||
        compute_patch_height(p) > 3 * compute_patch_width(p))
        return compute_patch_height(p) > compute_patch_width(p) ? GLINT_P
                                                                : GLINT_S;
    if (share[GLINT_S] > times * share[GLINT_P] ||
        share[GLINT_P] > times * share[GLINT_S])
        return share[GLINT_P] > share[GLINT_S] ? GLINT_P : GLINT_S;
    return compute_patch_height(p) > compute_patch_width(p) ||
                   (compute_patch_height(p) == compute_patch_width(p) &&
                    p->depth % 2)
               ? GLINT_P
               : GLINT_S;
}

/* Returns the max error of positions and outlines, in tolerances. */
static double get_position_and_outline_error(const struct attempt *a)
{
    return fmax(a->errors.places, a->errors.outlines);
}

/* Returns the variable in which to halve P after attempt A; KEEP if P should
 * not be halved. */
static int choose_halving_variable(const struct glint_skew_piece *p,
                                   const struct attempt *a,
                                   const struct glint_fitted_system *system)
{
    const bool parts = can_divide_box(p) &&
                       get_position_and_outline_error(a) > a->bearable &&
                       system->n_outputs > 0;
    double share[GLINT_VARIABLES];
    int along, across;

    glint_piece_compute_shares(system, share);
    across = share[GLINT_V] > share[GLINT_U] ? GLINT_V : GLINT_U;
    if (system->n_outputs == 0) {
        share[GLINT_S] = compute_box_motion(&p->zone, 1, 2);
        share[GLINT_P] = compute_box_motion(&p->zone, 3, 5);
    }
    along = choose_direction_component(p, share);
    if (parts && (!can_halve_patch(p) || share[across] > RATHER * share[along]))
        return across;
    return can_halve_patch(p) ? along : KEEP;
}

static int choose_step_after_fit(const struct glint_skew_piece *p,
                                 const struct attempt *a,
                                 const struct glint_fitted_system *system)
{
    const double left = get_position_and_outline_error(a);
    const bool helped = left <= STUCK * p->before;

    if (a->dark || (p->parts > 0 && system->n_outputs == 0))
        return KEEP;
    /* Coatings make energies oscillate with the wavelength. Dividing the band
     * reduces this error, with 1/5 of the terms that smaller patches would
     * need. */
    if (left <= a->kept)
        return a->errors.energy > 1 && p->parts == 0 &&
                       p->w1 - p->w0 > LEAST_BAND
                   ? GLINT_W
                   : KEEP;
    if (!helped && compute_larger_patch_side(p) < STUCK_SIDE &&
        left <= fmin(HOPELESS, a->bearable))
        return KEEP;
    return choose_halving_variable(p, a, system);
}

/* Fits PATCH. Halves it repeatedly until each piece is accurate enough. */
static enum glint_status fit_patch(struct fitter *f,
                                   const struct glint_directions *patch)
{
    struct glint_skew_piece stack[DEEP + 2] = {{.zone = {.lo = patch->x0,
                                                         .hi = patch->x1,
                                                         .y_lo = patch->y0,
                                                         .y_hi = patch->y1,
                                                         .skew = true},
                                                .w0 = -1,
                                                .w1 = 1,
                                                .before = HUGE_VAL}};
    enum glint_status status = GLINT_OK;

    for (int n = 1; n > 0 && status == GLINT_OK;) {
        struct glint_skew_piece p = stack[--n];
        const struct glint_directions at = get_piece_patch(&p);
        struct glint_fitted_system system = {.ghost = f->visible->ghost};
        struct attempt a = {.dark = true};
        int next = KEEP;

        if (glint_directions_get_min_sine(&at) < f->sine_hi)
            status = try_piece_fit(f, &p, &system, &a);
        if (status == GLINT_OK)
            next = choose_step_after_fit(&p, &a, &system);
        f->work++;
        f->share += next == KEEP ? compute_piece_area(&p) / f->area : 0;
        if (f->progress && status == GLINT_OK)
            status = f->progress(f->progress_ctx, f->work, f->share);
        if (status == GLINT_OK && next == KEEP && system.n_outputs > 0) {
            system.part = glint_piece_choose_part_number(f->out, &system);
            status = glint_fitted_append_system(f->out, &system);
        } else {
            glint_fitted_free_system(&system);
        }
        p.before = get_position_and_outline_error(&a);
        p.known = next != GLINT_W && p.zone.fill > SOLID;
        if (next != KEEP) {
            glint_piece_halve(&p, next, &stack[n + 1], &stack[n]);
            n += 2;
        }
    }
    return status;
}

/* Fits all patches of directions, starting with squares of the max side. */
static enum glint_status fit_all_patches(struct fitter *f, uint32_t mirrors)
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

enum glint_status glint_skew_fit_ghost(const struct glint_visible *visible,
                                       double max_deg,
                                       const struct glint_tolerance *tolerance,
                                       glint_fit_progress_fn *progress,
                                       void *ctx,
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
    f->progress = progress;
    f->progress_ctx = ctx;
    f->buffers.scratch =
        malloc(GLINT_ZONE_SCRATCH * sizeof *f->buffers.scratch);
    if (f->buffers.scratch)
        status = fit_all_patches(
            f, glint_skew_find_mirror_planes(visible->setup->lens));
    free(f->buffers.scratch);
    free(f);
    return status;
}
