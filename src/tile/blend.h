/* SPDX-License-Identifier: MIT
 *
 * Blends several passes, and lets them cover the picture.
 *
 *   light = light (1 - cover of the next) + light of the next
 *   cover = 1 - (1 - cover) (1 - cover of the next) */
#ifndef GLINT_TILE_BLEND_H
#define GLINT_TILE_BLEND_H

#include "tile/pass.h"

/* Set tiles->blend to it to draw several passes. */
extern const struct glint_blend glint_blend;

#endif
