/* SPDX-License-Identifier: MIT */
#include "bake/fit/next.h"

#include <math.h>

#include "engine/setup/degrees.h"

/* Min width of a zone that is halved, degrees. */
#define LEAST_DEG 0.7
/* Ghosts whose ease (factor on tolerances) is below this are bright: the widths
 * of their zones count twice, so that they are halved once more. */
#define BRIGHT_EASE 1.5
/* Halving a zone did not help if a half still has more than this fraction of
 * the zone's error. */
#define STUCK 0.75
/* Zones narrower than this, degrees, are not halved again if the last halving
 * did not help. Wider zones are halved again unless their error is at most
 * get_max_unhelped_error(). */
#define STUCK_DEG 1.2
/* Factor on STUCK_DEG for fast lenses; with it nearly all of their zones count
 * as narrow. */
#define WIDE_STUCK 16
/* Factor on STUCK_DEG for non-spherical surfaces and for lights far off the
 * axis: zones several degrees wide would get parts that do not join without
 * gaps. */
#define SHAPED_STUCK 3
/* PART_LEFT: min error, in tolerances, at which a zone's box is divided.
 * MOST_HIDDEN: max factor on it for ghosts so faint that errors are
 * invisible. */
#define PART_LEFT   5.0
#define MOST_HIDDEN 3.0
/* Min error, in units of get_max_undivided_error(), at which a box is divided
 * without trying more terms, which would not help. */
#define HOPELESS 20.0
/* Min error, in tolerances, at which a wide zone is halved in any case. */
#define HALVES_ANYWAY 10.0
/* If a box moves or grows over the band by more than this many half widths, the
 * band is halved. */
#define WANDERS 0.5
/* Min width in w (0 .. 2) of a band that is halved. */
#define LEAST_BAND 0.6
/* Lenses with non-spherical surfaces, limits of a ghost's ease (factor on
 * tolerances): below NOT_FAINT all means are used to reduce errors; above FAINT
 * any error up to get_max_undivided_error() is accepted. */
#define NOT_FAINT 1.5
#define FAINT     6.0

bool glint_next_has_film_stack(const struct glint_visible *visible)
{
    const struct glint_setup *setup = visible->setup;
    const struct glint_ghost ghost = setup->ghost[visible->ghost];

    return setup->lens->surface[ghost.i].coating.n_films > 1 ||
           setup->lens->surface[ghost.j].coating.n_films > 1;
}

double glint_next_compute_width_deg(double lo, double hi)
{
    return (asin(hi) - asin(lo)) * (180 / GLINT_PI);
}

/* Returns the max error, in tolerances, up to which a zone's box is not
 * divided. */
static double get_max_undivided_error(const struct glint_zone_aim *aim)
{
    return PART_LEFT * fmin(aim->hidden, MOST_HIDDEN);
}

/* Returns the max error, in tolerances, with which a zone is accepted at
 * once. */
static double get_max_accepted_error(const struct glint_next_rules *f,
                                     const struct glint_zone_aim *aim)
{
    const double faint =
        fmin(1, fmax(0, (aim->ease - NOT_FAINT) / (FAINT - NOT_FAINT)));

    return f->visible->shaped ? 1 + faint * (get_max_undivided_error(aim) - 1)
                              : 1;
}

/* Returns the max error, in tolerances, up to which a zone of any width is not
 * halved again after a halving that did not help; 0: wide zones are always
 * halved. */
static double get_max_unhelped_error(const struct glint_next_rules *f,
                                     const struct glint_zone_aim *aim)
{
    return f->visible->wide ? get_max_undivided_error(aim) : 0;
}

/* Returns the width in degrees below which a zone is not halved again if
 * halving did not help. It is larger for fast lenses: where their rays fold in
 * the stop, halving angles does not help but dividing the box does, and each
 * narrower zone would need as many parts. */
static double get_max_unhelped_width_deg(const struct glint_next_rules *f)
{
    return f->visible->shaped || f->visible->far ? SHAPED_STUCK * STUCK_DEG
           : f->visible->wide                    ? WIDE_STUCK * STUCK_DEG
                                                 : STUCK_DEG;
}

/* Returns the max number of times that the box of P may be halved. */
static int get_max_box_halvings(const struct glint_next_rules *f,
                                const struct glint_zone_piece *p)
{
    const int off_axis =
        f->visible->shaped ? GLINT_SHAPED_DEPTH : GLINT_PART_DEPTH;

    return p->lo <= 0 && f->tolerance->axis_depth > off_axis
               ? f->tolerance->axis_depth
               : off_axis;
}

double glint_next_get_hopeless_error(const struct glint_next_rules *f,
                                     const struct glint_zone_piece *p,
                                     const struct glint_zone_aim *aim)
{
    if (p->thorough)
        return p->depth < get_max_box_halvings(f, p)
                   ? HOPELESS * get_max_undivided_error(aim)
                   : 0;
    return glint_next_compute_width_deg(p->lo, p->hi) >
                   2 * get_max_unhelped_width_deg(f)
               ? fmax(HALVES_ANYWAY, get_max_accepted_error(f, aim))
               : 0;
}

/* Returns the width of P in degrees, doubled for bright ghosts. */
static double
compute_brightness_weighted_width(const struct glint_zone_piece *p,
                                  const struct glint_zone_aim *aim)
{
    return glint_next_compute_width_deg(p->lo, p->hi) *
           (aim->ease < BRIGHT_EASE ? 2 : 1);
}

/* Returns the factor on LEAST_DEG and STUCK_DEG for zone P. */
static double compute_min_width_factor(const struct glint_next_rules *f,
                                       const struct glint_zone_piece *p)
{
    return p->lo <= 0 ? f->tolerance->axis : 1;
}

double glint_next_get_settled_error(const struct glint_next_rules *f,
                                    const struct glint_zone_piece *p,
                                    const struct glint_zone_aim *aim)
{
    const double least = compute_min_width_factor(f, p),
                 width = compute_brightness_weighted_width(p, aim);
    const double kept = get_max_accepted_error(f, aim);

    if (p->thorough)
        return p->depth < get_max_box_halvings(f, p)
                   ? get_max_undivided_error(aim)
                   : 0;
    if (width >= least * get_max_unhelped_width_deg(f) &&
        get_max_unhelped_error(f, aim) > 0)
        return fmax(get_max_unhelped_error(f, aim), kept);
    /* The lower half is the narrower one in degrees. If even that is wider than
     * get_max_unhelped_width_deg(), glint_next_choose_step() halves it whether
     * halving helped or not. */
    if (glint_next_compute_width_deg(p->lo, 0.5 * (p->lo + p->hi)) >=
            get_max_unhelped_width_deg(f) ||
        width < least * LEAST_DEG)
        return kept;
    return width < least * get_max_unhelped_width_deg(f)
               ? fmax(kept, STUCK * p->before)
               : 0;
}

enum glint_next glint_next_choose_step(const struct glint_next_rules *f,
                                       const struct glint_zone_piece *p,
                                       const struct glint_attempt *a)
{
    const double left = a->errors.worst;
    const bool helped = left <= STUCK * p->before;
    const double width = compute_brightness_weighted_width(p, &a->aim),
                 least = compute_min_width_factor(f, p);
    /* With coatings of several films the energy oscillates with the wavelength.
     * Dividing the band reduces this error; halving the angles does not. */
    const bool swings = glint_next_has_film_stack(f->visible) &&
                        p->depth == 0 && left > 1 && left < HUGE_VAL &&
                        a->errors.shows <= 1 && p->w1 - p->w0 > LEAST_BAND;
    const bool stuck =
        width < least * LEAST_DEG ||
        (!helped && (width < least * get_max_unhelped_width_deg(f) ||
                     left <= get_max_unhelped_error(f, &a->aim)));

    if (swings)
        return GLINT_BANDS;
    if (p->thorough && a->errors.dims <= get_max_undivided_error(&a->aim))
        return GLINT_KEEP;
    if (p->thorough && p->depth == 0 && a->wanders > WANDERS &&
        p->w1 - p->w0 > LEAST_BAND)
        return GLINT_BANDS;
    if (p->thorough)
        return p->depth < get_max_box_halvings(f, p) ? GLINT_PART : GLINT_KEEP;
    if (left <= get_max_accepted_error(f, &a->aim))
        return GLINT_KEEP;
    return stuck && left < HUGE_VAL ? GLINT_THOROUGH : GLINT_HALVE;
}
