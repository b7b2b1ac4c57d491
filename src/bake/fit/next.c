/* SPDX-License-Identifier: MIT */
#include "bake/fit/next.h"

#include <math.h>

#include "engine/setup/degrees.h"

/* Degrees: narrower zones are not halved. */
#define LEAST_DEG 0.7
/* Zones of ghosts with less ease are bright and may be half as wide. */
#define BRIGHT_EASE 1.5
/* Fraction of the error of the whole zone: a half whose error is larger gained
 * nothing from halving. */
#define STUCK 0.75
/* Degrees: a narrower zone which gained nothing is not halved again, nor is a
 * wider one whose error is endured(). */
#define STUCK_DEG 1.2
/* Factor on STUCK_DEG for wide stops: nearly all of their zones. */
#define WIDE_STUCK 16
/* The same factor for shaped lenses and far lights. Their zones of several
 * degrees would leave parts that do not meet. */
#define SHAPED_STUCK 3
/* Tolerances: zones with a larger error are divided into parts. If the ghost is
 * so faint that it hides more, the error may be up to MOST_HIDDEN times as
 * large. */
#define PART_LEFT   5.0
#define MOST_HIDDEN 3.0
/* Multiples of bearable(), which returns PART_LEFT, or more for faint ghosts:
 * zones with a larger error are divided at once, as more terms would not
 * help. */
#define HOPELESS 20.0
/* Tolerances: a wide zone with a larger error will be halved anyway. */
#define HALVES_ANYWAY 10.0
/* Half widths. If a box moves or grows by more over the band, the band is
 * halved. */
#define WANDERS 0.5
/* Width of a band in w, 0 .. 2: narrower ones are not halved. */
#define LEAST_BAND 0.6
/* Tolerance ease of shaped lenses up to which every attempt to reduce errors is
 * made, and from which any bearable error is accepted. */
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

/* Returns the max error of positions of a zone, in tolerances. */
static double bearable(const struct glint_zone_aim *aim)
{
    return PART_LEFT * fmin(aim->hidden, MOST_HIDDEN);
}

/* Returns the max error, in tolerances, at which P is accepted at once. */
static double acceptable(const struct glint_next_rules *f,
                         const struct glint_zone_aim *aim)
{
    const double faint =
        fmin(1, fmax(0, (aim->ease - NOT_FAINT) / (FAINT - NOT_FAINT)));

    return f->visible->shaped ? 1 + faint * (bearable(aim) - 1) : 1;
}

/* Returns up to which error, in tolerances, a zone of any width is not halved
 * if that gained nothing; 0: a wide zone always is. */
static double endured(const struct glint_next_rules *f,
                      const struct glint_zone_aim *aim)
{
    return f->visible->wide ? bearable(aim) : 0;
}

/* Returns STUCK_DEG, or for wide stops more. Where their rays turn around in
 * the stop, halving angles gains nothing, but parts of the box do, and narrower
 * zones need as many parts each. */
static double stuck_deg(const struct glint_next_rules *f)
{
    return f->visible->shaped || f->visible->far ? SHAPED_STUCK * STUCK_DEG
           : f->visible->wide                    ? WIDE_STUCK * STUCK_DEG
                                                 : STUCK_DEG;
}

/* Returns how many times P's box may be halved. */
static int most_depth(const struct glint_next_rules *f,
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
        return p->depth < most_depth(f, p) ? HOPELESS * bearable(aim) : 0;
    return glint_next_degrees(p->lo, p->hi) > 2 * stuck_deg(f)
               ? fmax(HALVES_ANYWAY, acceptable(f, aim))
               : 0;
}

/* Returns the width of P in degrees for halving, where zones of bright ghosts
 * count twice. */
static double width_of(const struct glint_zone_piece *p,
                       const struct glint_zone_aim *aim)
{
    return glint_next_degrees(p->lo, p->hi) * (aim->ease < BRIGHT_EASE ? 2 : 1);
}

/* Returns the factor on LEAST_DEG and STUCK_DEG for P. */
static double least_of(const struct glint_next_rules *f,
                       const struct glint_zone_piece *p)
{
    return p->lo <= 0 ? f->tolerance->axis : 1;
}

double glint_next_settled(const struct glint_next_rules *f,
                          const struct glint_zone_piece *p,
                          const struct glint_zone_aim *aim)
{
    const double least = least_of(f, p), width = width_of(p, aim);
    const double kept = acceptable(f, aim);

    if (p->thorough)
        return p->depth < most_depth(f, p) ? bearable(aim) : 0;
    if (width >= least * stuck_deg(f) && endured(f, aim) > 0)
        return fmax(endured(f, aim), kept);
    /* The lower half is the narrower one in degrees. If even that is still
     * wide, glint_next() ignores the gain of halving. */
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
    const double width = width_of(p, &a->aim), least = least_of(f, p);
    /* Stacks of films make energies swing with the wavelength. Parts of the
     * band follow that, narrower zones would not. */
    const bool swings = glint_next_stacks(f->visible) && p->depth == 0 &&
                        left > 1 && left < HUGE_VAL && a->errors.shows <= 1 &&
                        p->w1 - p->w0 > LEAST_BAND;
    const bool stuck = width < least * LEAST_DEG ||
                       (!helped && (width < least * stuck_deg(f) ||
                                    left <= endured(f, &a->aim)));

    if (swings)
        return GLINT_BANDS;
    if (p->thorough && a->errors.dims <= bearable(&a->aim))
        return GLINT_KEEP;
    if (p->thorough && p->depth == 0 && a->wanders > WANDERS &&
        p->w1 - p->w0 > LEAST_BAND)
        return GLINT_BANDS;
    if (p->thorough)
        return p->depth < most_depth(f, p) ? GLINT_PART : GLINT_KEEP;
    if (left <= acceptable(f, &a->aim))
        return GLINT_KEEP;
    return stuck && left < HUGE_VAL ? GLINT_THOROUGH : GLINT_HALVE;
}
