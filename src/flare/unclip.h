/* SPDX-License-Identifier: MIT
 *
 * From the sums of a profile to what a lamp is without clipping.
 */
#ifndef GLINT_FLARE_UNCLIP_H
#define GLINT_FLARE_UNCLIP_H

#include "flare/profile.h"

/* Sets power, colour and extent of SPOT. */
void glint_unclip(struct glint_spot *spot,
                  const struct glint_profile_sums *sums);

#endif
