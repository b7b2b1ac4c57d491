/* SPDX-License-Identifier: MIT
 *
 * Blends several passes, and hides parts of the picture behind them.
 *
 *    light = light (1 - cover of the next) + light of the next
 *    cover = 1 - (1 - cover) (1 - cover of the next)
 */
#ifndef GLINT_TILE_BLEND_H
#define GLINT_TILE_BLEND_H

#include "tile/pass.h"

/* The functions that draw several passes: set tiles->blend to its address. */
extern const struct glint_blend glint_blend;

#endif
