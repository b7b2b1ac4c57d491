/* SPDX-License-Identifier: MIT
 *
 * glint/quality.h - one parameter that sets all dials: quality 0 to 1, along
 * the measured Pareto front of error and time, as a table of levels. */
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
    *const glint_quality_name[GLINT_QUALITY_NAMES + 1]; /* the last is NULL */
double glint_quality_named(int name);

/* Returns the fractional level of QUALITY, 0 to GLINT_QUALITY_LEVELS - 1. It is
 * whole between a level that draws at half resolution and a level that does
 * not. */
double glint_quality_place(double quality);

/* The parameters of a quality: the dials of a frame, and two others. */
struct glint_quality {
    struct glint_dials dials;
    double quantum;   /* percent by which irradiance is rounded; determines
                         irradiance_steps */
    double tolerance; /* tolerance with which the model is baked, as in struct
                         glint_bake_options */
};

/* Returns the settings of QUALITY, 0 to 1; 0.5 is the default. */
struct glint_quality glint_quality_at(double quality);

/* Returns the lowest quality at which outlines are off by at most PX pixels on
 * average. */
double glint_quality_for_error(double px);

/* Returns irradiance_steps for a mean step of QUANTUM percent. */
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
