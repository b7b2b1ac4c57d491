/* SPDX-License-Identifier: MIT
 *
 * The struct behind glint/profile.h: the light around the spots of one picture.
 */
#ifndef GLINT_LAMPS_PROFILE_H
#define GLINT_LAMPS_PROFILE_H

#include "glint/profile.h"
#include "lamps/rings.h"

struct glint_profile {
    struct glint_rings rings;
};

#endif
