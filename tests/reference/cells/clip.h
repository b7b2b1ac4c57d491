/* SPDX-License-Identifier: MIT
 *
 * Clips a primitive by the stop and the barrels.
 *
 * A clip is a function over the primitive, positive inside the opening, linear
 * between the corners, and scaled to pixels: its value at a pixel's centre is
 * the distance to the cut, so that cover = value + 1/2, clamped to 0 .. 1. The
 * sides of a polygonal stop and the barrels are such functions; a circle is
 * looked up at the interpolated stop position instead, and scaled by one
 * factor.
 */
#ifndef REFERENCE_CELLS_CLIP_H
#define REFERENCE_CELLS_CLIP_H

#include <stdint.h>

#include "reference/cells/cell.h"
#include "glint/light.h"

struct glint_clip {
    int n; /* number of linear functions */
    /* Pixels: value of each function at each corner. */
    int32_t at_q8[GLINT_MAX_BLADES + 2][4];
    int field;         /* 1: the stop is looked up per pixel */
    int32_t field_q16; /* pixels per stop radius, for the lookup */
};

/* Returns the set of GLINT_CUT_ that may cross the primitive, or -1 if nothing
 * of it is seen. */
int glint_clip_classify(const struct glint_corners *corners,
                        const struct glint_stop *stop);

/* Returns whether the middle of CORNERS lies in the opening, for cells that are
 * too small to be cut. */
int glint_clip_middle(const struct glint_corners *corners,
                      const struct glint_stop *stop);

/* Fills CLIP for the cuts CUT of a primitive. */
void glint_clip_init(struct glint_clip *clip,
                     const struct glint_corners *corners,
                     const struct glint_stop *stop, int cut);

/* Returns the signed distance, in stop radii, to the outline of a circular stop
 * at (X, Y), positive inside. */
int32_t glint_clip_field_q16(int32_t x_q16, int32_t y_q16);

#endif
