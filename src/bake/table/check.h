/* SPDX-License-Identifier: MIT
 *
 * Checks whether a lens table whose values are all in range is physically
 * possible.
 *
 *   in   a completely parsed prescription, and the positions of its numbers
 *   out  true, or the first mistake as the error of the text
 *
 * Order of the checks: surfaces are defined up to their semi-diameters; the
 * last medium is air; elements do not overlap and the sensor lies behind them;
 * the lens has a focus behind it, and its stop opens wide enough for the
 * f-number; stated focal lengths agree with the paraxial ones. A new f-number
 * must pass the same check of the stop. Limits: spheres are compared at one
 * height, CLEAR_SHARE of the smaller semi-diameter; whether rays pass the
 * barrels is not checked.
 */
#ifndef GLINT_BAKE_TABLE_CHECK_H
#define GLINT_BAKE_TABLE_CHECK_H

#include <stdbool.h>

#include "bake/table/elements.h"
#include "bake/table/text.h"

/* Max focal length, mm; a lens with a longer one counts as having no power. */
#define GLINT_MAX_FOCAL_MM 1e6
#define GLINT_MIN_F_NUMBER 0.5
#define GLINT_MAX_F_NUMBER 1000.0

/* where each number of a lens table stands in the table's text */
struct glint_places {
    /* position of the f-number and of the stop's semi-diameter */
    struct glint_text_place f_number, stop;
    /* positions of stated focal lengths; line 0: not stated */
    struct glint_text_place focal, back_focal;
    struct glint_text_place thickness[GLINT_MAX_ELEMENTS];
    struct glint_text_place semi[GLINT_MAX_SURFACES];
    /* position of the medium behind the last surface */
    struct glint_text_place medium;
};

/* Returns whether LENS passes all checks; otherwise sets the error of TEXT. */
bool glint_prescription_check(const struct glint_prescription *lens,
                              const struct glint_text *text,
                              const struct glint_places *places);

#endif
