/* SPDX-License-Identifier: MIT
 *
 * Environments in the reference renderer (twin.h). */
#ifndef REFERENCE_SCENES_TWIN_AROUND_H
#define REFERENCE_SCENES_TWIN_AROUND_H

#include "reference/scenes/twin.h"
#include "reference/scenes/vec.h"

/* Adds to RGB what the environment shows a white surface of that normal. */
void twin_irradiance(const struct twin *twin, const double shading[3],
                     double rgb[3]);

/* Adds to RGB what HIT, of diffuse COLOUR, leaves of the environment along a
 * ray TOWARD it. */
void twin_add_around(const struct twin *twin, const struct twin_hit *hit,
                     const double toward[3], const double colour[3],
                     double rgb[3]);

/* Returns what metal at HIT shows, times its colour, of a light TO_LIGHT, of an
 * angular radius of that sine, that shows a white surface 1. */
double twin_shine(const struct twin *twin, const struct twin_hit *hit,
                  const double toward[3], const double to_light[3],
                  double radius);

/* Returns what the normal's turn within a pixel adds to squares of alphas. */
double twin_spread(const struct twin *twin, const struct twin_hit *hit,
                   const double toward[3]);

/* Sets FRAME to tangent, bitangent and normal of metal at HIT, in the axes of
 * baked scenes. */
void twin_lie(const struct twin *twin, const struct twin_hit *hit,
              double frame[3][3]);

/* Sets RGB to the background's light from TOWARD, in the mean of a spot of an
 * angular variance of SPREAD. */
void twin_behind(const struct twin *twin, const double toward[3], double spread,
                 double rgb[3]);

#endif
