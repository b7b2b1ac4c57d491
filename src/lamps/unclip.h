/* SPDX-License-Identifier: MIT
 *
 * Estimates the power, colour and extent of a lamp whose core is clipped, from
 * the sums of light around it (rings.h). */
#ifndef GLINT_LAMPS_UNCLIP_H
#define GLINT_LAMPS_UNCLIP_H

#include "lamps/rings.h"

/* Number of features from which the power of a clipped core is predicted. All
 * are logarithms: the core's area; the core's area relative to the clipped area
 * of the channel that clips least; the area of each level relative to the
 * core's; spread and light of the background; the largest channel of the colour
 * at luminance 1; the minor semi-axis of the lamp without glare, from the areas
 * alone. The major semi-axis is not a feature. For two lamps in one spot it is
 * the distance between them. */
enum { GLINT_UNCLIP_FEATURES = 6 + GLINT_PROFILE_LEVELS };

/* Sets FEATURE to the features of SPOT, whose colour must have been set. */
void glint_unclip_compute_features(int32_t feature_q16[GLINT_UNCLIP_FEATURES],
                                   const struct glint_spot *spot,
                                   const struct glint_profile_sums *sums);

/* Sets SEEN to the visible light of SPOT, above the background, and CORE to the
 * light that the clipped core would have if its brightest channel were exactly
 * white. Unit: light of one white pixel. */
void glint_unclip_compute_shown_light(int64_t *seen_q16, int64_t *core_q16,
                                      const struct glint_spot *spot,
                                      const struct glint_profile_sums *sums);

/* Sets the estimated power, colour and extent of SPOT. */
void glint_unclip_estimate_lamp(struct glint_spot *spot,
                                const struct glint_profile_sums *sums);

#endif
