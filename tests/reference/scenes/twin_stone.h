/* SPDX-License-Identifier: MIT
 *
 * Translucent objects in the reference renderer (twin.h): uses the maps, codes
 * and taps of the run time, in double precision.
 */
#ifndef REFERENCE_SCENES_TWIN_STONE_H
#define REFERENCE_SCENES_TWIN_STONE_H

#include "reference/scenes/twin.h"

/* Allocates the maps of all objects. May return GLINT_E_MEMORY. */
enum glint_status reference_allocate_media_maps(struct twin *twin);
void reference_free_media_maps(struct twin *twin);

/* Computes all maps. Requires the final value of shadow_points. */
void reference_compute_media_maps(const struct twin *twin);

/* On entry RGB is the light that the coat at HIT would mirror at normal
 * incidence. Scales it for the direction TOWARD and adds the light that
 * leaves the medium. */
void reference_add_medium_light(const struct twin *twin,
                                const struct twin_hit *hit,
                                const double toward[3], double rgb[3]);

#endif
