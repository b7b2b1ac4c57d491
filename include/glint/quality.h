/* SPDX-License-Identifier: MIT
 *
 * glint/quality.h - one parameter for all: quality 0 to 1 along the measured
 * Pareto front of error and time, as a table of levels. */
#ifndef GLINT_QUALITY_H
#define GLINT_QUALITY_H

#include <stdbool.h>

#include "glint/dials.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names of qualities, from the coarsest. */
enum { GLINT_QUALITY_NAMES = 5, GLINT_QUALITY_LEVELS = 10 };
extern const char
    *const glint_quality_name[GLINT_QUALITY_NAMES + 1]; /* the last is NULL */
double glint_quality_named(int name);

/* Returns the place of QUALITY among the levels, 0 to GLINT_QUALITY_LEVELS - 1.
 * It may lie between two levels, but not between one that draws four pixels at
 * once and one that does not. */
double glint_quality_place(double quality);

/* The dials of a quality, and its parameters that are not dials of a frame. */
struct glint_quality {
    struct glint_dials dials;
    double quantum;   /* percent of irradiance, from which irradiance_steps
                         follows */
    double tolerance; /* tolerance with which the model is baked */
};

/* Returns the settings of QUALITY, 0 to 1; 0.5 is the default. */
struct glint_quality glint_quality_at(double quality);

/* Returns the lowest quality whose outlines are off by at most PX pixels in
 * the mean. */
double glint_quality_for_error(double px);

/* Returns the steps of irradiance an octave for a mean step of QUANTUM percent;
 * steps are equal within an octave. */
int glint_quality_steps(double quantum);

/* Returns whether DIALS draw at half resolution. */
static inline bool glint_dials_half(const struct glint_dials *dials)
{
    return (dials->flags & (GLINT_DIAL_HALF | GLINT_DIAL_ALWAYS_HALF)) != 0;
}

#ifdef __cplusplus
}
#endif

#endif
