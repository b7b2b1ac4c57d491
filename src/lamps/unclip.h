/* SPDX-License-Identifier: MIT
 *
 * Estimates power, colour and extent of a lamp without clipping from the sums
 * of a profile. */
#ifndef GLINT_LAMPS_UNCLIP_H
#define GLINT_LAMPS_UNCLIP_H

#include "lamps/rings.h"

/* The features that predict the power of a clipped core, as logarithms: its
 * area; how much smaller the area is in the channel that clips least; how much
 * larger the area of each level is; spread and light of the background; the
 * brightest channel at luminance 1; the minor semi-axis of the lamp in its
 * glare, by the areas alone. The major one is left out: where two lamps become
 * one spot it is their distance. */
enum { GLINT_UNCLIP_FEATURES = 6 + GLINT_PROFILE_LEVELS };

/* Sets FEATURE to the features of SPOT, whose colour must be set. */
void glint_unclip_features(int32_t feature_q16[GLINT_UNCLIP_FEATURES],
                           const struct glint_spot *spot,
                           const struct glint_profile_sums *sums);

/* Sets SEEN to the light that the picture shows, over the background, and CORE
 * to the light of the clipped core if its brightest channel were just white.
 * Unit: white pixels. */
void glint_unclip_light(int64_t *seen_q16, int64_t *core_q16,
                        const struct glint_spot *spot,
                        const struct glint_profile_sums *sums);

/* Sets power, colour and extent of SPOT. */
void glint_unclip(struct glint_spot *spot,
                  const struct glint_profile_sums *sums);

#endif
