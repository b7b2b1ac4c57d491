/* SPDX-License-Identifier: MIT
 *
 * Estimates the power, colour and extent that a lamp would have without
 * clipping, from the sums of a profile. */
#ifndef GLINT_LAMPS_UNCLIP_H
#define GLINT_LAMPS_UNCLIP_H

#include "lamps/rings.h"

/* Number of the features that predict the power of a clipped core, as
 * logarithms: its area; its area relative to the area in the channel that
 * clips least; the area of each level relative to its area; spread and light
 * of the background; the max channel at luminance 1; the minor semi-axis of
 * the lamp, without glare, from the areas alone. The major semi-axis is left
 * out, as for two lamps in one spot it is their distance. */
enum { GLINT_UNCLIP_FEATURES = 6 + GLINT_PROFILE_LEVELS };

/* Sets FEATURE to the features of SPOT, whose colour must be set. */
void glint_unclip_features(int32_t feature_q16[GLINT_UNCLIP_FEATURES],
                           const struct glint_spot *spot,
                           const struct glint_profile_sums *sums);

/* Sets SEEN to the light above the background that the picture shows, and CORE
 * to the light of the clipped core with its brightest channel at exactly white.
 * Unit: white pixels. */
void glint_unclip_light(int64_t *seen_q16, int64_t *core_q16,
                        const struct glint_spot *spot,
                        const struct glint_profile_sums *sums);

/* Sets power, colour and extent of SPOT. */
void glint_unclip(struct glint_spot *spot,
                  const struct glint_profile_sums *sums);

#endif
