/* SPDX-License-Identifier: MIT
 *
 * Estimates from the sums of a profile how a lamp would be without clipping. */
#ifndef GLINT_LAMPS_UNCLIP_H
#define GLINT_LAMPS_UNCLIP_H

#include "lamps/rings.h"

/* What tells the power of a clipped core, as logarithms: its area; how much
 * less the channel has that clips least; how much more area there is at each
 * level; spread and light of the background; the brightest channel at luminance
 * 1; the minor semi-axis, which is that of the lamp in its glare, by the areas
 * alone. The major one is left out: of two lamps that become one spot it is
 * their distance. */
enum { GLINT_UNCLIP_FEATURES = 6 + GLINT_PROFILE_LEVELS };

/* Of SPOT, whose colour is set. */
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
