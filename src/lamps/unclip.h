/* SPDX-License-Identifier: MIT
 *
 * From the sums of a profile to what a lamp is without clipping.
 */
#ifndef GLINT_LAMPS_UNCLIP_H
#define GLINT_LAMPS_UNCLIP_H

#include "lamps/profile.h"

/* Sets power, colour and extent of SPOT. */
void glint_unclip(struct glint_spot *spot,
                  const struct glint_profile_sums *sums);

#endif
