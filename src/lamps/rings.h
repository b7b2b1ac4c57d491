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
 * All pixels of a small disc are read, of a larger disc every s-th pixel of
 * every s-th row; in each ring, samples are twice as far apart as in the ring
 * inside it. The background is the light of the outermost ring: its eight
 * sectors are sorted by light, and the middle half of its samples is averaged,
 * so that bright or dark objects beside the lamp do not affect it. Light is
 * expressed as u = (light - background) / (white - background).
 *
 * The area of level k counts pixels of u above 2^(1-k) fully and those of u
 * above 2^-k in part, by a linear ramp. The clipped area has such a ramp of
 * light from CLIP_FIRST to CLIP_LAST. So these sums change continuously with
 * the light.
 *
 * The rim of a large core is also sampled along rays from the middle. What is
 * measured is the drop of light, as a fraction of white, from the end of the
 * core to an eighth of its radius further out. A glare that falls off as 1 /
 * r^3 drops by 0.3 there; the surface of a large lamp ends abruptly, however
 * bright its surroundings are.
 *
 * Limits: the pixels that samples represent sum up to 2^30 at most, the pixels
 * of the largest picture; u_q16 is 2^16 at most; offsets from the middle are
 * below 2^15. */
#ifndef GLINT_LAMPS_RINGS_H
#define GLINT_LAMPS_RINGS_H

#include "lamps/bright.h"
#include "glint/lamps.h"

enum {
    GLINT_PROFILE_RINGS = 3,
    GLINT_PROFILE_LEVELS = 7,
    /* brightness levels up to this one are only counted in the disc and the
     * first ring */
    GLINT_PROFILE_NEAR = 3,
    GLINT_PROFILE_SPOTS = 1024
};

struct glint_profile_channel {
    int32_t black_q20, scale_q16; /* black_q20: light of the background, linear;
                                     scale_q16: 1 / (1 - background), at most 16
                                     */
    int32_t spread_q16;           /* spread of the background's light, in the
                                     unit of u: white minus background */
    int32_t step_q16; /* difference of u to the next higher code at the
                         background if codes have fewer than 8 bits, else 0 */
    /* With u, the light above the background: [k]: number of pixels of u from
     * 2^(1 - k) on, plus 2^k u - 1 for each pixel of u from 2^-k to 2^(1 - k);
     * [0]: number of clipped pixels */
    int64_t area_q8[GLINT_PROFILE_LEVELS + 1];
    /* [k]: number of pixels whose u is 2^-k or more and below 2^(1 - k); [0]:
     * number of pixels whose u is 1 or more */
    int64_t n[GLINT_PROFILE_LEVELS + 1];
    int64_t fringe_q16; /* sums of light, weighted by the max of u over a
                           pixel's channels; fringe: of unclipped pixels; white:
                           of clipped pixels */
    int64_t white_q16;
};

struct glint_profile_sums {
    struct glint_profile_channel of[3];
    /* Sums over the pixels of the core: weights, first and second moments.
     * Positions are relative to the middle pixel of the window, in steps. */
    int64_t w_q16, moment_q16[2], square_q16[3]; /* xx, yy, xy */
    int step;        /* distance between samples of the core, pixels */
    int32_t rim_q15; /* drop of light at the rim of the core as a fraction of
                        white, the median over all rays; 0 for a small core, or
                        if too few rays end in the picture */
};

struct glint_rings {
    struct glint_bright bright;        /* reader of the picture */
    int32_t by_x[GLINT_PROFILE_SPOTS]; /* indices of the spots, from left to
                                          right */
};

/* Prepares for summing the light of the N SPOTS of IMAGE. N must be at most
 * GLINT_PROFILE_SPOTS, and rings->bright must be initialized. */
void glint_rings_begin_picture(struct glint_rings *rings,
                               const struct glint_image *image,
                               const struct glint_spot *spots, int n);

/* Sums the light around the I-th spot from the left. */
void glint_rings_sum_spot_light(struct glint_profile_sums *sums,
                                struct glint_rings *rings,
                                const struct glint_spot *spots, int n, int i);

#endif
