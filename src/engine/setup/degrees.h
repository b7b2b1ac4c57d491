/* SPDX-License-Identifier: MIT
 *
 * Computes sine and cosine of angles in degrees. They are exact at multiples of
 * 90, so that the flare of a light on the x or y axis is symmetric to the
 * bit. */
#ifndef GLINT_ENGINE_SETUP_DEGREES_H
#define GLINT_ENGINE_SETUP_DEGREES_H

#include <math.h>

#include "glint/view.h"

static inline double glint_sin_deg(double degrees)
{
    const double r = remainder(degrees, 360.0); /* -180 .. 180 */
    const double side = r > 90 ? 180 - r : r < -90 ? -180 - r : r;

    return fabs(side) == 90 ? side / 90
           : fabs(side) > 45
               ? copysign(cos((90 - fabs(side)) * (GLINT_PI / 180)), side)
               : sin(side * (GLINT_PI / 180));
}

static inline double glint_cos_deg(double degrees)
{
    return glint_sin_deg(90 - fabs(remainder(degrees, 360.0)));
}

#endif
