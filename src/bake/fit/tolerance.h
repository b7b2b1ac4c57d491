/* SPDX-License-Identifier: MIT
 *
 * What polynomials of a lens are held to.
 */
#ifndef GLINT_BAKE_FIT_TOLERANCE_H
#define GLINT_BAKE_FIT_TOLERANCE_H

#include "bake/fit/brightness.h"

/* Times that a zone's box may be halved. */
enum { GLINT_PART_DEPTH = 4, GLINT_MAX_AXIS_DEPTH = 8 };

/* The root mean square that is aimed at; single rays may be off by five times
 * as much. Stop and barrel positions draw the outline: EDGE_MM is what they may
 * shift it on the sensor, but neither is asked for less than STOP (stop radii)
 * and BARREL (of its radius), or more than STOP_LEAST and a sixteenth of
 * BARREL: the outline of a ghost that is larger than the picture may lie beyond
 * it, but where the stop closes it comes in.
 *
 * For ghosts of the brightness that counts; sRGB shows an error in a ghost of a
 * share v of that by v^0.42 as much, so edges and energy may be off by more
 * there, up to EASE times. */
struct glint_tolerance {
    double sensor_mm, edge_mm, stop, stop_least, barrel, energy;
    double faint_sensor_mm; /* the most for any ghost */
    double escape; /* past a barrel that is left out, relative radius */
    double ease;
    double axis;    /* zones at the axis, where light folds into rings: how
                       narrow they may become, and how far off places may be,
                       over the same of others */
    int axis_depth; /* times that their boxes may be halved, GLINT_PART_DEPTH
                       to GLINT_MAX_AXIS_DEPTH */
    const struct glint_brightness *brightness;
};

#endif
