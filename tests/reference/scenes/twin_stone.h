/* SPDX-License-Identifier: MIT
 *
 * Translucent objects in the reference renderer (twin.h): scatters light with
 * the baked tables of the run time, in double precision.
 */
#ifndef REFERENCE_SCENES_TWIN_STONE_H
#define REFERENCE_SCENES_TWIN_STONE_H

#include "reference/scenes/twin.h"

/* Allocates the light maps of all translucent objects. May return
 * GLINT_E_MEMORY. */
enum glint_status reference_allocate_media_maps(struct twin *twin);
void reference_free_media_maps(struct twin *twin);

/* Computes all light maps, with shadow_points shadow rays per light. */
void reference_compute_media_maps(const struct twin *twin);

/* Completes the light RGB of a translucent object. On entry RGB is the light
 * that the coat at HIT would mirror at its reflectance for normal incidence.
 * Scales RGB to the reflectance for direction TOWARD, and adds the light that
 * leaves the medium. */
void reference_add_medium_light(const struct twin *twin,
                                const struct twin_hit *hit,
                                const double toward[3], double rgb[3]);

#endif
