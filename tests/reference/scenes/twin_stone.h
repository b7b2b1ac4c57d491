/* SPDX-License-Identifier: MIT
 *
 * Translucent objects in the reference renderer (twin.h): uses the maps, codes
 * and taps of the run time, in double precision.
 */
#ifndef REFERENCE_SCENES_TWIN_STONE_H
#define REFERENCE_SCENES_TWIN_STONE_H

#include "reference/scenes/twin.h"

/* Allocates the maps of all objects. May return GLINT_E_MEMORY. */
enum glint_status twin_open_stones(struct twin *twin);
void twin_close_stones(struct twin *twin);

/* Computes all maps. Requires the final value of shadow_points. */
void twin_fill_maps(const struct twin *twin);

/* On entry RGB is the light that the coat at HIT would mirror at normal
 * incidence. Scales it for the direction TOWARD and adds the light that
 * leaves the medium. */
void twin_add_stone(const struct twin *twin, const struct twin_hit *hit,
                    const double toward[3], double rgb[3]);

#endif
