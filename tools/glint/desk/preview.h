/* SPDX-License-Identifier: MIT
 *
 * preview.h - draws the numbers of ghosts on an image.
 */
#ifndef GLINT_TOOLS_DESK_PREVIEW_H
#define GLINT_TOOLS_DESK_PREVIEW_H

#include "glint/engine.h"

/* Draws on IMAGE the number of each of the brightest ghosts, at the ghost's
 * brightest point. ENGINE finds these points by drawing the ghosts of N LAMPS
 * at a small size, with the lamps' power multiplied by SCALE. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status
preview_draw_ghost_numbers(struct glint_engine *engine,
                           const struct glint_engine_lamp *lamps, int n,
                           double scale, const struct glint_image *image);

#endif
