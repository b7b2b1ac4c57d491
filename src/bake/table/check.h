/* SPDX-License-Identifier: MIT
 *
 * Checks whether a lens whose values are all in range can exist and work.
 *
 *   in   a prescription read to the end, and the places of its numbers
 *   out  true, or the first mistake written as the error of the text
 *
 * Checked in this order: surfaces reach as far as their barrels; the last
 * medium is air; elements do not overlap and
 * the sensor lies behind them; the lens has a focus behind it, and its stop
 * opens wide enough for the f-number; stated focal lengths agree with those of
 * the paraxial matrices. A new f-number must pass the same test of the stop.
 * Limits: neighbours are compared at one height, CLEAR_SHARE of the smaller
 * semi-diameter; whether rays pass the barrels is not checked. */
#ifndef GLINT_BAKE_TABLE_CHECK_H
#define GLINT_BAKE_TABLE_CHECK_H

#include <stdbool.h>

#include "bake/table/elements.h"
#include "bake/table/text.h"

/* Longest focal length; a lens with a longer one counts as without power. */
#define GLINT_MAX_FOCAL_MM 1e6
#define GLINT_MIN_F_NUMBER 0.5
#define GLINT_MAX_F_NUMBER 1000.0

/* Positions of the table's numbers in its text. */
struct glint_places {
    /* Places of the f-number and of the stop's semi-diameter. */
    struct glint_text_place f_number, stop;
    struct glint_text_place focal, back_focal; /* line 0: not stated */
    struct glint_text_place thickness[GLINT_MAX_ELEMENTS];
    struct glint_text_place semi[GLINT_MAX_SURFACES];
    struct glint_text_place medium; /* position of the last surface's medium */
};

/* Returns whether LENS is good; if not, the error of TEXT is written. */
bool glint_prescription_check(const struct glint_prescription *lens,
                              const struct glint_text *text,
                              const struct glint_places *places);

#endif
