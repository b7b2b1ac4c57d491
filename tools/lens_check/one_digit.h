/* SPDX-License-Identifier: MIT
 *
 * one_digit.h - which single slip, undone, makes a table right.
 */
#ifndef GLINT_TOOLS_LENS_CHECK_ONE_DIGIT_H
#define GLINT_TOOLS_LENS_CHECK_ONE_DIGIT_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/prescription.h"

enum slip { SLIP_SIGN, SLIP_SWAP, SLIP_DIGIT, SLIP_POINT };

struct mend {
    int line, column; /* of the number */
    enum slip slip;
    char from[24], to[24];
    double focal_mm, back_mm; /* then */
    bool listed; /* the glass is the catalogue's, or another surface's */
    double off;  /* how far these are from the stated ones, relative */
};

enum { MENDS = 8, LENS_TEXT = 1 << 16 };

/* Returns whether TEXT[BYTES] is a table without fault, which it reads into
 * LENS; else ERROR says what is wrong. */
bool table_is_right(const char *text, size_t bytes, const char *file,
                    struct glint_prescription *lens, struct glint_error *error);

/* Tries all slips of one number of surfaces and the stop: a sign, two digits
 * that changed places, a wrong digit, a decimal point. If all but a glass is
 * right, only its nd and Vd are tried. Fills MEND with those
 * after which TEXT is right, the likeliest first, MENDS at most; returns how
 * many there are. */
int find_mends(const char *text, size_t bytes, struct mend mend[MENDS]);

#endif
