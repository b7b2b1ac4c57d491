/* SPDX-License-Identifier: MIT
 *
 * The published way to localise [Bodonyi26]: a place has weights in four points
 * that are no plane, which sum to 1 and are the same wherever these move.
 *
 * It is kept as a baseline, in two arithmetics. float32 rounds each result of
 * double, which gives the bits of float: double has more than twice its digits.
 */
#ifndef GLINT_BAKE_MOTION_FOUR_H
#define GLINT_BAKE_MOTION_FOUR_H

#include <stdbool.h>

enum glint_arithmetic { GLINT_DOUBLE, GLINT_FLOAT32 };

/* Returns X as ARITHMETIC has it. */
double glint_rounded(enum glint_arithmetic arithmetic, double x);

/* Returns the determinant of FROM[4] as edges from the last, over the product
 * of their lengths, in double precision: 0 .. 1. */
double glint_four_spans(const double (*const from[4])[3]);

/* Sets MAP to how points move if FROM[4] move to TO[4]: the columns of a 3 x 4
 * matrix, where the axes go and where the origin. Returns false if
 * glint_four_spans() is below 2^-20. */
bool glint_four_map(enum glint_arithmetic arithmetic,
                    const double (*const from[4])[3],
                    const double (*const to[4])[3], double map[4][3]);

#endif
