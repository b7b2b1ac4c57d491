/* SPDX-License-Identifier: MIT
 *
 * Decides the next step for a zone, or a part of its box, after a fit.
 *
 *   in   width of the zone; errors of its fit in tolerances
 *   out  accept the fit, halve the zone, fit it thoroughly, or divide its band
 *        or box; also the error at which a fit may stop early
 *
 * In lenses with non-spherical surfaces faint zones are accepted with larger
 * errors: aspheric powers leave errors at every width, so halving does not
 * help.
 */
#ifndef GLINT_BAKE_FIT_NEXT_H
#define GLINT_BAKE_FIT_NEXT_H

#include "bake/fit/brightness.h"
#include "bake/visible/visible.h"
#include "bake/fit/zone_fit.h"

/* A zone, or a part of a zone's box, that is to be fitted. before: error of the
 * last fit of the wider zone that contains it, in tolerances. thorough: fit
 * with a box that depends on the wavelength, a root of the energy, and more
 * terms. */
struct glint_zone_piece {
    double lo, hi, before;
    double w0, w1; /* range of wavelengths within the band, -1 .. 1 */
    bool thorough;
    struct glint_zone_part part;
    /* number of times that the box was halved; 0: the zone's whole box */
    int depth;
};

/* result of an attempt to fit a zone */
struct glint_attempt {
    struct glint_zone_aim aim;
    /* in tolerances; at most 1 if the fit is good; worst is HUGE_VAL if nothing
     * was fitted */
    struct glint_zone_errors errors;
    /* shift or growth of the box over the band, in half widths */
    double wanders;
};

/* next step: accept; halve the angles; fit thoroughly; halve the band; halve
 * the box */
enum glint_next {
    GLINT_KEEP,
    GLINT_HALVE,
    GLINT_THOROUGH,
    GLINT_BANDS,
    GLINT_PART
};

/* Returns the width, degrees, of the angle range whose sines are LO .. HI. */
double glint_next_compute_width_deg(double lo, double hi);

/* Returns whether at least one of the ghost's two reflections is at a coating
 * of several films. */
bool glint_next_has_film_stack(const struct glint_visible *visible);

/* A ghost and its tolerances, which determine how its zones are divided. */
struct glint_next_rules {
    const struct glint_visible *visible;
    const struct glint_tolerance *tolerance;
};

/* Returns the error, in tolerances, above which a fit of P may stop early
 * because P will be halved or divided in any case; 0: never. Narrow zones never
 * stop early: they may not be halved again, so their error must be known. */
double glint_next_get_hopeless_error(const struct glint_next_rules *f,
                                     const struct glint_zone_piece *p,
                                     const struct glint_zone_aim *aim);

/* Returns an error, in tolerances, above which the exact value no longer
 * matters: glint_next_choose_step() decides the same for P, and later for its
 * halves; 0: there is no such error. */
double glint_next_get_settled_error(const struct glint_next_rules *f,
                                    const struct glint_zone_piece *p,
                                    const struct glint_zone_aim *aim);

/* Returns the next step for P after the fit A. Zones of bright ghosts are
 * halved more often. */
enum glint_next glint_next_choose_step(const struct glint_next_rules *f,
                                       const struct glint_zone_piece *p,
                                       const struct glint_attempt *a);

#endif
