/* SPDX-License-Identifier: MIT
 *
 * Where the stop and the barrels cut a primitive.
 *
 * A clip is a function over the primitive, positive inside the opening, linear
 * between the corners, and scaled to pixels: its value at a pixel's centre is
 * the distance to the cut, so that cover = value + 1/2, held to 0 .. 1. The
 * sides of a polygonal stop and the barrels are such functions; a
 * circle and a mask are looked up at the interpolated stop position instead and
 * share one scale.
 */
#ifndef GLINT_PUBLISHED_CLIP_H
#define GLINT_PUBLISHED_CLIP_H

#include <stdint.h>

#include "flare/edges/primitive.h"
#include "glint/light.h"

struct glint_clip {
    int n;                                  /* linear functions */
    int32_t at_q8[GLINT_MAX_BLADES + 2][4]; /* pixels, at each corner */
    int field;         /* the stop is looked up per pixel */
    int32_t field_q16; /* pixels per stop radius, for the lookup */
};

/* Returns the cuts that may matter: a set of GLINT_CUT_, or -1 where nothing of
 * the primitive is seen. */
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

/* Signed distance to the outline of a circle or mask, stop radii. */
int32_t glint_clip_field_q16(const struct glint_stop *stop, int32_t x_q16,
                             int32_t y_q16);

#endif
