/* SPDX-License-Identifier: MIT */
#include "bake/fit/next.h"

#include <math.h>

#include "engine/setup/degrees.h"

/* Degrees: narrower zones are not halved. */
#define LEAST_DEG 0.7
/* The widths of zones of ghosts with less ease, which are bright, count
 * twice, so that they are halved once more. */
#define BRIGHT_EASE 1.5
/* If a half of a zone still has more than this fraction of the whole zone's
 * error, halving did not help. */
#define STUCK 0.75
/* Degrees: narrower zones are not halved again if halving did not help, nor
 * are wider ones whose error is at most endured_error(). */
#define STUCK_DEG 1.2
/* Factor on STUCK_DEG for lenses that open wide; applies to nearly all of
 * their zones. */
#define WIDE_STUCK 16
/* Factor on STUCK_DEG for lenses with surfaces that are not spheres, and for
 * lights far off the axis. Zones several degrees wide would get parts that
 * do not join without gaps. */
#define SHAPED_STUCK 3
/* Error, in tolerances, above which a zone is divided into parts. For ghosts
 * so faint that errors are hidden, the limit is up to MOST_HIDDEN times as
 * large. */
#define PART_LEFT   5.0
#define MOST_HIDDEN 3.0
/* Error, in units of bearable_error(), above which a zone is divided without
 * trying more terms, which would not help. */
#define HOPELESS 20.0
/* Error, in tolerances, above which a wide zone will be halved anyway. */
#define HALVES_ANYWAY 10.0
/* If a box moves or grows over the band by more than this, in half widths,
 * the band is halved. */
#define WANDERS 0.5
/* Min width in w, of 0 .. 2, of a band that is halved. */
#define LEAST_BAND 0.6
/* Ease of ghosts in lenses with surfaces that are not spheres. Up to
 * NOT_FAINT every means to reduce errors is tried; from FAINT on any
 * bearable error is accepted. */
#define NOT_FAINT 1.5
#define FAINT     6.0

bool glint_next_stacks(const struct glint_visible *visible)
{
    const struct glint_setup *setup = visible->setup;
    const struct glint_ghost ghost = setup->ghost[visible->ghost];

    return setup->lens->surface[ghost.i].coating.n_films > 1 ||
           setup->lens->surface[ghost.j].coating.n_films > 1;
}

double glint_next_degrees(double lo, double hi)
{
    return (asin(hi) - asin(lo)) * (180 / GLINT_PI);
}

/* Returns the error of a zone, in tolerances, above which it is divided into
 * parts. */
static double bearable_error(const struct glint_zone_aim *aim)
{
    return PART_LEFT * fmin(aim->hidden, MOST_HIDDEN);
}

/* Returns the error, in tolerances, up to which P is accepted at once. */
static double acceptable_error(const struct glint_next_rules *f,
                               const struct glint_zone_aim *aim)
{
    const double faint =
        fmin(1, fmax(0, (aim->ease - NOT_FAINT) / (FAINT - NOT_FAINT)));

    return f->visible->shaped ? 1 + faint * (bearable_error(aim) - 1) : 1;
}

/* Returns the error, in tolerances, up to which a zone of any width is not
 * halved again if halving did not help; 0: a wide zone is always halved. */
static double endured_error(const struct glint_next_rules *f,
                            const struct glint_zone_aim *aim)
{
    return f->visible->wide ? bearable_error(aim) : 0;
}

/* Returns the width in degrees below which a zone is not halved again if
 * halving did not help. It is larger for lenses that open wide: where their
 * rays fold in the stop, halving angles does not help, but dividing the box
 * does, and narrower zones would need as many parts each. */
static double stuck_deg(const struct glint_next_rules *f)
{
    return f->visible->shaped || f->visible->far ? SHAPED_STUCK * STUCK_DEG
           : f->visible->wide                    ? WIDE_STUCK * STUCK_DEG
                                                 : STUCK_DEG;
}

/* Returns the max number of times that the box of P may be halved. */
static int max_depth(const struct glint_next_rules *f,
                     const struct glint_zone_piece *p)
{
    const int off_axis =
        f->visible->shaped ? GLINT_SHAPED_DEPTH : GLINT_PART_DEPTH;

    return p->lo <= 0 && f->tolerance->axis_depth > off_axis
               ? f->tolerance->axis_depth
               : off_axis;
}

double glint_next_hopeless(const struct glint_next_rules *f,
                           const struct glint_zone_piece *p,
                           const struct glint_zone_aim *aim)
{
    if (p->thorough)
        return p->depth < max_depth(f, p) ? HOPELESS * bearable_error(aim) : 0;
    return glint_next_degrees(p->lo, p->hi) > 2 * stuck_deg(f)
               ? fmax(HALVES_ANYWAY, acceptable_error(f, aim))
               : 0;
}

/* Returns the width of P in degrees, doubled for bright ghosts. */
static double weighted_width(const struct glint_zone_piece *p,
                             const struct glint_zone_aim *aim)
{
    return glint_next_degrees(p->lo, p->hi) * (aim->ease < BRIGHT_EASE ? 2 : 1);
}

/* Returns the factor on LEAST_DEG and STUCK_DEG for P. */
static double min_width_factor(const struct glint_next_rules *f,
                               const struct glint_zone_piece *p)
{
    return p->lo <= 0 ? f->tolerance->axis : 1;
}

double glint_next_settled(const struct glint_next_rules *f,
                          const struct glint_zone_piece *p,
                          const struct glint_zone_aim *aim)
{
    const double least = min_width_factor(f, p), width = weighted_width(p, aim);
    const double kept = acceptable_error(f, aim);

    if (p->thorough)
        return p->depth < max_depth(f, p) ? bearable_error(aim) : 0;
    if (width >= least * stuck_deg(f) && endured_error(f, aim) > 0)
        return fmax(endured_error(f, aim), kept);
    /* The lower half is narrower in degrees. If even that half is wider than
     * stuck_deg(), glint_next() halves it whether halving helped or not. */
    if (glint_next_degrees(p->lo, 0.5 * (p->lo + p->hi)) >= stuck_deg(f) ||
        width < least * LEAST_DEG)
        return kept;
    return width < least * stuck_deg(f) ? fmax(kept, STUCK * p->before) : 0;
}

enum glint_next glint_next(const struct glint_next_rules *f,
                           const struct glint_zone_piece *p,
                           const struct glint_attempt *a)
{
    const double left = a->errors.worst;
    const bool helped = left <= STUCK * p->before;
    const double width = weighted_width(p, &a->aim),
                 least = min_width_factor(f, p);
    /* In coatings of several films the energy oscillates with the
     * wavelength. Dividing the band helps against this, narrower zones would
     * not. */
    const bool swings = glint_next_stacks(f->visible) && p->depth == 0 &&
                        left > 1 && left < HUGE_VAL && a->errors.shows <= 1 &&
                        p->w1 - p->w0 > LEAST_BAND;
    const bool stuck = width < least * LEAST_DEG ||
                       (!helped && (width < least * stuck_deg(f) ||
                                    left <= endured_error(f, &a->aim)));

    if (swings)
        return GLINT_BANDS;
    if (p->thorough && a->errors.dims <= bearable_error(&a->aim))
        return GLINT_KEEP;
    if (p->thorough && p->depth == 0 && a->wanders > WANDERS &&
        p->w1 - p->w0 > LEAST_BAND)
        return GLINT_BANDS;
    if (p->thorough)
        return p->depth < max_depth(f, p) ? GLINT_PART : GLINT_KEEP;
    if (left <= acceptable_error(f, &a->aim))
        return GLINT_KEEP;
    return stuck && left < HUGE_VAL ? GLINT_THOROUGH : GLINT_HALVE;
}
