/* SPDX-License-Identifier: MIT
 *
 * glint/quality.h - sets all quality parameters of a frame by one number, the
 * quality 0 to 1: a position on the measured Pareto front of error and time,
 * stored as a table of levels. */
#ifndef GLINT_QUALITY_H
#define GLINT_QUALITY_H

#include <stdbool.h>

#include "glint/dials.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names of qualities, the coarsest first; glint_quality_named() returns the
 * quality, 0 to 1, of name number NAME. */
enum { GLINT_QUALITY_NAMES = 5, GLINT_QUALITY_LEVELS = 10 };
extern const char
    *const glint_quality_name[GLINT_QUALITY_NAMES + 1]; /* names of qualities;
                                                           the last is NULL */
double glint_quality_named(int name);

/* Returns the level of QUALITY, a real number from 0 to GLINT_QUALITY_LEVELS -
 * 1. If QUALITY lies between a level at half resolution and a level at full
 * resolution, the result is one of these two levels. */
double glint_quality_place(double quality);

/* All parameters that a quality selects: the parameters of a frame (dials), and
 * two others. */
struct glint_quality {
    struct glint_dials dials;
    /* Mean step to which irradiance is rounded, percent. irradiance_steps of
     * DIALS follows from it. */
    double quantum;
    /* Tolerance with which the model is baked, as in struct
     * glint_bake_options. */
    double tolerance;
};

/* Returns the parameters that QUALITY, 0 to 1, selects; 0.5 is the default. */
struct glint_quality glint_quality_at(double quality);

/* Returns the lowest quality at which the mean error of outlines is at most PX
 * pixels. */
double glint_quality_for_error(double px);

/* Returns the irradiance_steps whose mean step is QUANTUM percent. */
int glint_quality_steps(double quantum);

/* Returns whether DIALS select half resolution. */
static inline bool glint_dials_half(const struct glint_dials *dials)
{
    return (dials->flags & (GLINT_DIAL_HALF | GLINT_DIAL_ALWAYS_HALF)) != 0;
}

#ifdef __cplusplus
}
#endif

#endif
