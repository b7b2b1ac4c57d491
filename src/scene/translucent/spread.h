/* SPDX-License-Identifier: MIT
 *
 * Spreads the light on a map of texels as a baked translucent medium does
 * (glint/scene/translucent.h), strip by strip.
 *
 *   in light that enters, 0 .. 32767 of any unit; the translucent medium
 *   out light that leaves, 0 .. 32767 of that unit, saturates
 *
 * A strip is GLINT_STRIP columns of one channel. For each plane of the kernel
 * the strip's rows are convolved, two at a time, and then its columns;
 * intermediate values stay in the CPU's cache. */
#ifndef GLINT_SCENE_TRANSLUCENT_SPREAD_H
#define GLINT_SCENE_TRANSLUCENT_SPREAD_H

#include "base/arena.h"
#include "glint/scene/translucent.h"
#include "kernels/maps/maps.h"

enum { GLINT_STRIP = 32 };

struct glint_spread {
    const struct glint_translucent *stone;
    glint_convolve_fn *convolve;
    /* Size of the map, powers of two; the translucent medium is tiled over it.
     * If is_ball is set, columns wrap around and rows continue across the
     * poles; otherwise there is no light outside the map. */
    int width, height;
    int is_ball;
    int16_t *light[3]; /* [height][width] */
    int16_t *map[3];   /* [height][width] */
};

enum { GLINT_SPREAD_PAIRS = (GLINT_TRANSLUCENT_MOST_KERNEL + 1) / 2 };

/* Taps of one rank of a plane, as pairs, from the last tap to the first;
 * padding is 0. */
struct glint_spread_taps {
    int n, shift;
    int32_t row[GLINT_SPREAD_PAIRS];
    /* Taps of columns that begin at the first, or at the second row of a pair
     * of rows. */
    int32_t even[GLINT_SPREAD_PAIRS], odd[GLINT_SPREAD_PAIRS];
};

/* Scratch of one worker. */
struct glint_spread_scratch {
    struct glint_spread_taps *taps; /* of one rank */
    int32_t *any;   /* [height + kernel]: nonzero if the row has light */
    int32_t *pair;  /* [height + kernel][GLINT_STRIP + kernel]: light that
                       enters, as pairs of neighbours */
    int32_t *value; /* [(height + kernel) / 2][GLINT_STRIP] pairs of rows */
    int32_t *sum;   /* [height][GLINT_STRIP]: sum of one plane */
    int32_t *total; /* [height][GLINT_STRIP]: sum of all planes, weighted by
                       f */
};

/* Allocates the scratch of one worker for STONE on maps of HEIGHT rows. */
struct glint_spread_scratch
glint_spread_carve(struct glint_arena *arena,
                   const struct glint_translucent *stone, int height);

/* Sets rows Y0 .. Y1 - 1 of the map of channel C in the strip from column X0
 * on. */
void glint_spread_strip(const struct glint_spread *spread, int c, int x0,
                        int y0, int y1, struct glint_spread_scratch *scratch);

#endif
