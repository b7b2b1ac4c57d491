/* SPDX-License-Identifier: MIT
 *
 * Blends several passes, from back to front, and hides the picture behind them.
 * Light and cover accumulate from pass to pass:
 *
 *    light = light (1 - cover of the pass) + light of the pass
 *    cover = 1 - (1 - cover) (1 - cover of the pass)
 */
#ifndef GLINT_TILE_BLEND_H
#define GLINT_TILE_BLEND_H

#include "tile/pass.h"

/* Table of the functions that blend several passes. Programs that blend set
 * member blend of struct glint_tiles to its address. */
extern const struct glint_blend glint_blend;

#endif
