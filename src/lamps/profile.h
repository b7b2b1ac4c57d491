/* SPDX-License-Identifier: MIT
 *
 * Defines struct glint_profile (glint/profile.h), the state of the functions
 * that measure the light around spots. */
#ifndef GLINT_LAMPS_PROFILE_H
#define GLINT_LAMPS_PROFILE_H

#include "glint/profile.h"
#include "lamps/rings.h"

struct glint_profile {
    struct glint_rings rings;
};

#endif
