/* SPDX-License-Identifier: MIT
 *
 * Decides how to proceed with a zone, or a part of a zone, after an attempt to
 * fit it.
 *
 *   in   its width, and the errors of its fit in tolerances
 *   out  whether to accept, halve, fit thoroughly, or divide it by wavelength
 *        or into parts; and the error at which a fit may stop early
 *
 * In lenses with surfaces that are not spheres, faint zones are accepted with
 * larger errors: aspheric powers leave errors at every width, and halving does
 * not help.
 */
#ifndef GLINT_BAKE_FIT_NEXT_H
#define GLINT_BAKE_FIT_NEXT_H

#include "bake/fit/brightness.h"
#include "bake/visible/visible.h"
#include "bake/fit/zone_fit.h"

/* A zone, or a part of a zone, that waits to be fitted. BEFORE is the error
 * of the last attempt at the wider zone that contains it. THOROUGH: fit it
 * with a box that depends on the wavelength, a root of the energy, and more
 * terms. */
struct glint_zone_piece {
    double lo, hi, before;
    double w0, w1; /* range of the part within the band, -1 .. 1 */
    bool thorough;
    struct glint_zone_part part;
    int depth; /* number of halvings that led to the part; 0: the whole zone */
};

/* The result of an attempt to fit a zone. */
struct glint_attempt {
    struct glint_zone_aim aim;
    /* errors in tolerances, at most 1 if the fit is good; worst is HUGE_VAL
     * if nothing was fitted */
    struct glint_zone_errors errors;
    double wanders; /* displacement or growth of the box over the band, in half
                       widths */
};

enum glint_next {
    GLINT_KEEP,
    GLINT_HALVE,
    GLINT_THOROUGH,
    GLINT_BANDS,
    GLINT_PART
};

/* Returns asin(HI) - asin(LO) in degrees. */
double glint_next_degrees(double lo, double hi);

/* Returns whether a coating of several films reflects the ghost. */
bool glint_next_stacks(const struct glint_visible *visible);

/* A ghost, and the tolerances that determine how its zones are divided. */
struct glint_next_rules {
    const struct glint_visible *visible;
    const struct glint_tolerance *tolerance;
};

/* Returns the error, in tolerances, above which P will be halved or divided
 * in any case, so that its fit may stop early; 0: no such error. There is
 * none for narrow zones, as halving may end there and the error must be
 * known. */
double glint_next_hopeless(const struct glint_next_rules *f,
                           const struct glint_zone_piece *p,
                           const struct glint_zone_aim *aim);

/* Returns the error, in tolerances, above which the decisions of
 * glint_next() for P, and later for its halves, no longer depend on the
 * error; 0: no such error. */
double glint_next_settled(const struct glint_next_rules *f,
                          const struct glint_zone_piece *p,
                          const struct glint_zone_aim *aim);

/* Returns the next step for P after attempt A. Zones of bright ghosts are
 * halved further. */
enum glint_next glint_next(const struct glint_next_rules *f,
                           const struct glint_zone_piece *p,
                           const struct glint_attempt *a);

#endif
