/* SPDX-License-Identifier: MIT
 *
 * One dial for all: quality 0 to 1 along the measured front of accuracy over
 * time, as a table of levels.
 */
#ifndef GLINT_ENGINE_FRAME_QUALITY_H
#define GLINT_ENGINE_FRAME_QUALITY_H

#include <stdbool.h>

#include "glint/dials.h"

/* Names of qualities, the coarsest first. */
enum { GLINT_QUALITY_NAMES = 5, GLINT_QUALITY_LEVELS = 10 };
extern const char
    *const glint_quality_name[GLINT_QUALITY_NAMES + 1]; /* the last is NULL */
double glint_quality_named(int name);

/* Returns the place of QUALITY among the levels, 0 to GLINT_QUALITY_LEVELS - 1:
 * between two of them, but on either where one draws four pixels at once and
 * the other does not. */
double glint_quality_place(double quality);

/* A setting, with what is no dial of a frame. */
struct glint_quality {
    struct glint_dials dials;
    double quantum;   /* percent, which irradiance_steps are made of */
    double tolerance; /* tolerance that a model is baked with */
};

/* Returns the settings of QUALITY, 0 to 1; 0.5 is the default. */
struct glint_quality glint_quality_at(double quality);

/* The least quality whose outlines are off by PX pixels in the mean at most. */
double glint_quality_for_error(double px);

/* Steps of irradiance an octave for a quantum in percent: the mean step, as
 * steps are even within an octave. */
int glint_quality_steps(double quantum);

/* Returns whether DIALS draw half as many pixels each way. */
static inline bool glint_dials_half(const struct glint_dials *dials)
{
    return (dials->flags & (GLINT_DIAL_HALF | GLINT_DIAL_ALWAYS_HALF)) != 0;
}

#endif
