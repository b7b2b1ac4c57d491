/* SPDX-License-Identifier: MIT
 *
 * From lamps and wavelengths in degrees and nanometres to what the run-time
 * half draws.
 */
#ifndef GLINT_ENGINE_FRAME_LIGHT_H
#define GLINT_ENGINE_FRAME_LIGHT_H

#include "glint/bake.h"
#include "glint/flare.h"

struct glint_wave glint_wave_of(double nm, const double rgb[3],
                                double unit_flux);

/* LAMP as a point, its power times SCALE. */
struct glint_light glint_light_of(const struct glint_lamp *lamp, double scale);

/* The reverse, a point. */
struct glint_lamp glint_lamp_of(const struct glint_light *light);

/* Returns whether LENS, unless NULL, ends before LIGHT. */
int glint_light_is_beyond(const struct glint_lens *lens,
                          const struct glint_light *light);

#endif
