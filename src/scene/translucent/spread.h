/* SPDX-License-Identifier: MIT
 *
 * Spreads the light that enters a translucent object over the object's light
 * map, strip by strip, by the kernel of a baked translucent medium
 * (glint/scene/translucent.h).
 *
 *   in  light that enters, 0 .. 32767 in any unit; the translucent medium
 *   out light that leaves, 0 .. 32767 in the same unit, saturated
 *
 * A strip is GLINT_STRIP columns of one colour channel. For each plane of the
 * kernel (a term of its fit, or a cluster of texels) the strip's rows are
 * convolved, two at a time, and then its columns; intermediate values stay in
 * the CPU's cache. */
#ifndef GLINT_SCENE_TRANSLUCENT_SPREAD_H
#define GLINT_SCENE_TRANSLUCENT_SPREAD_H

#include "base/arena.h"
#include "glint/scene/translucent.h"
#include "kernels/maps/maps.h"

enum { GLINT_STRIP = 32 };

struct glint_spread {
    const struct glint_translucent *stone;
    glint_convolve_fn *convolve;
    /* Size of the map in texels, powers of two. The translucent medium is tiled
     * over the map. If is_ball is set, columns wrap around and rows continue
     * across the poles. Otherwise no light enters outside the map. */
    int width, height;
    int is_ball;
    int16_t *light[3]; /* [height][width]: light that enters */
    int16_t *map[3];   /* [height][width]: light that leaves */
};

enum { GLINT_SPREAD_PAIRS = (GLINT_TRANSLUCENT_MOST_KERNEL + 1) / 2 };

/* Filter taps of one separable term (rank) of a kernel plane. Taps are stored
 * in reverse order, as pairs of neighbours, padded with 0. */
struct glint_spread_taps {
    int n, shift;
    int32_t row[GLINT_SPREAD_PAIRS];
    /* Column taps for sums that begin with the first row (even) or the second
     * row (odd) of a pair of rows. */
    int32_t even[GLINT_SPREAD_PAIRS], odd[GLINT_SPREAD_PAIRS];
};

/* Scratch memory of one worker. */
struct glint_spread_scratch {
    struct glint_spread_taps *taps; /* taps of one rank */
    int32_t *any;   /* [height + kernel]: nonzero if light enters in the row at
                       any texel */
    int32_t *pair;  /* [height + kernel][GLINT_STRIP + kernel]: light that
                       enters, as pairs of neighbouring texels */
    int32_t *value; /* [(height + kernel) / 2][GLINT_STRIP]: convolved rows, in
                       pairs */
    int32_t *sum;   /* [height][GLINT_STRIP]: result of one plane */
    int32_t *total; /* [height][GLINT_STRIP]: sum of all planes' results,
                       weighted per texel */
};

/* Allocates the scratch memory of one worker for translucent medium STONE and
 * maps of HEIGHT rows. */
struct glint_spread_scratch
glint_spread_carve(struct glint_arena *arena,
                   const struct glint_translucent *stone, int height);

/* Computes rows Y0 .. Y1 - 1 of the map of channel C in the strip that begins
 * at column X0. */
void glint_spread_light_in_strip(const struct glint_spread *spread, int c,
                                 int x0, int y0, int y1,
                                 struct glint_spread_scratch *scratch);

#endif
