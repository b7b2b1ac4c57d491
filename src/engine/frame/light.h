/* SPDX-License-Identifier: MIT
 *
 * Converts lamps (doubles, angles in degrees) and wavelengths (nm) to the
 * integer lights and wavelengths from which flares are drawn, and back. */
#ifndef GLINT_ENGINE_FRAME_LIGHT_H
#define GLINT_ENGINE_FRAME_LIGHT_H

#include "glint/bake.h"
#include "glint/flare.h"

struct glint_wave glint_wave_from_nm(double nm, const double rgb[3],
                                     double unit_flux);

/* Returns LAMP as a point light. SCALE is a factor on its power. */
struct glint_light glint_light_from_lamp(const struct glint_lamp *lamp,
                                         double scale);

/* Returns LIGHT as a lamp without extent. */
struct glint_lamp glint_lamp_from_light(const struct glint_light *light);

/* Returns whether the angle of LIGHT exceeds the max angle of the model LENS.
 * Returns 0 if LENS is NULL. */
int glint_light_is_outside_model(const struct glint_lens *lens,
                                 const struct glint_light *light);

#endif
