/* SPDX-License-Identifier: MIT
 *
 * Sums the light around a spot.
 *
 *   in   a picture, a spot in it
 *   out  per channel: areas by brightness, flux, clipped area; the colour of
 *        the fringe; second moments of the core; sharpness of its rim
 *
 * Method: the window around the spot is a disc, which covers the core and its
 * rim, and GLINT_PROFILE_RINGS rings, each twice as wide as the ring before.
 * All pixels of a small disc are read, else every s-th pixel of every s-th row;
 * each ring is sampled half as densely as the ring inside it. The background is
 * the light of the outermost ring: the mean of the middle half of its eight
 * sectors in order of light, so that bright or dark objects beside the lamp do
 * not affect it. Light is expressed as u = (light - background) / (white -
 * background).
 *
 * A pixel counts to the areas by ramps: to the area of level k by a ramp of u
 * from 2^-k to 2^(1-k), to the clipped area by a ramp of its light from
 * CLIP_FIRST to CLIP_LAST. So sums change continuously.
 *
 * The rim of a large core is also sampled along rays from the middle: the drop,
 * as a fraction of white, from the end of the core to an eighth of its radius
 * further out. A glare that falls off as 1 / r^3 drops by three tenths there;
 * the face of a lamp ends abruptly, however bright its surroundings are.
 *
 * Limits: weights of samples sum to 2^30 at most, the pixels of the largest
 * picture; u_q16 is 2^16 at most; offsets from the centre are below 2^15. */
#ifndef GLINT_LAMPS_RINGS_H
#define GLINT_LAMPS_RINGS_H

#include "lamps/bright.h"
#include "glint/lamps.h"

enum {
    GLINT_PROFILE_RINGS = 3,
    GLINT_PROFILE_LEVELS = 7,
    /* Levels up to this one are not counted outside the first ring. */
    GLINT_PROFILE_NEAR = 3,
    GLINT_PROFILE_SPOTS = 1024
};

struct glint_profile_channel {
    int32_t black_q20, scale_q16; /* background, linear light; 1 / (1 -
                                     background), at most 16 */
    int32_t spread_q16;           /* spread of the background's light, in u */
    int32_t step_q16; /* distance in u from the background to the next code if
                         codes have fewer than 8 bits; else 0 */
    /* [k]: number of pixels whose u is 2^-k or more, where pixels below 2^(1
     * - k) count as fractions; [0]: number of clipped pixels */
    int64_t area_q8[GLINT_PROFILE_LEVELS + 1];
    /* [k]: number of pixels with u from 2^-k to below 2^(1 - k); [0]: with u of
     * 1 or more. */
    int64_t n[GLINT_PROFILE_LEVELS + 1];
    int64_t fringe_q16; /* sums of the light of unclipped pixels (fringe) and of
                           clipped pixels (white), each weighted by its max u */
    int64_t white_q16;
};

struct glint_profile_sums {
    struct glint_profile_channel of[3];
    /* Weight and moments of the core about the middle pixel of the window, in
     * steps. */
    int64_t w_q16, moment_q16[2], square_q16[3]; /* xx, yy, xy */
    int step;        /* pixels between samples of the core */
    int32_t rim_q15; /* drop of light at the rim as a fraction of white, the
                        median over all rays; 0 for a small core, or if too few
                        rays end inside the picture */
};

struct glint_rings {
    struct glint_bright bright;        /* reader of the picture */
    int32_t by_x[GLINT_PROFILE_SPOTS]; /* indices of the spots, from left to
                                          right */
};

/* Prepares for the N SPOTS of IMAGE. N must be at most GLINT_PROFILE_SPOTS, and
 * rings->bright must be initialized. */
void glint_rings_begin(struct glint_rings *rings,
                       const struct glint_image *image,
                       const struct glint_spot *spots, int n);

/* Sums the light around the I-th spot from the left. */
void glint_rings_sum(struct glint_profile_sums *sums, struct glint_rings *rings,
                     const struct glint_spot *spots, int n, int i);

#endif
