/* SPDX-License-Identifier: MIT
 *
 * Translucent objects in the reference renderer (twin.h): maps as the run time
 * has them, by the same codes and taps, in double precision. */
#ifndef REFERENCE_SCENES_TWIN_STONE_H
#define REFERENCE_SCENES_TWIN_STONE_H

#include "reference/scenes/twin.h"

/* Makes room for the maps of all objects. GLINT_E_MEMORY. */
enum glint_status twin_open_stones(struct twin *twin);
void twin_close_stones(struct twin *twin);

/* Works out all maps, once shadow points are known. */
void twin_fill_maps(const struct twin *twin);

/* RGB is what the coat at HIT mirrors along a ray TOWARD it, were it seen from
 * ahead: sets it to what it mirrors there, and what comes out. */
void twin_add_stone(const struct twin *twin, const struct twin_hit *hit,
                    const double toward[3], double rgb[3]);

#endif
