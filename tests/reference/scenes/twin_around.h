/* SPDX-License-Identifier: MIT
 *
 * Environment light in the reference renderer (twin.h).
 */
#ifndef REFERENCE_SCENES_TWIN_AROUND_H
#define REFERENCE_SCENES_TWIN_AROUND_H

#include "reference/scenes/twin.h"
#include "reference/scenes/vec.h"

/* Adds to RGB the irradiance that a white surface with normal SHADING gets from
 * the environment. */
void reference_add_irradiance(const struct twin *twin, const double shading[3],
                              double rgb[3]);

/* Adds the environment light that the surface at HIT with diffuse COLOUR
 * reflects towards the origin of a ray along TOWARD. */
void reference_add_environment(const struct twin *twin,
                               const struct twin_hit *hit,
                               const double toward[3], const double colour[3],
                               double rgb[3]);

/* Returns the light that metal at HIT reflects from a light source in direction
 * TO_LIGHT whose angular radius has the sine RADIUS. The unit is the light of a
 * white surface under the source; the metal's colour is not included. */
double reference_compute_metal_reflection(const struct twin *twin,
                                          const struct twin_hit *hit,
                                          const double toward[3],
                                          const double to_light[3],
                                          double radius);

/* Returns the value to add to the squared alphas of Ward's lobe to account for
 * the change of the normal within a pixel. */
double reference_compute_alpha_widening(const struct twin *twin,
                                        const struct twin_hit *hit,
                                        const double toward[3]);

/* Sets FRAME to tangent, bitangent and normal of the metal at HIT, in the axes
 * of baked scenes. */
void reference_make_metal_frame(const struct twin *twin,
                                const struct twin_hit *hit, double frame[3][3]);

/* Sets RGB to the background light in direction TOWARD, averaged over
 * directions with the angular variance SPREAD. */
void reference_compute_background_light(const struct twin *twin,
                                        const double toward[3], double spread,
                                        double rgb[3]);

#endif
