/* SPDX-License-Identifier: MIT
 *
 * preview.h - draws the numbers of ghosts on an image.
 */
#ifndef GLINT_TOOLS_DESK_PREVIEW_H
#define GLINT_TOOLS_DESK_PREVIEW_H

#include "glint/engine.h"

/* Draws on IMAGE the numbers of the brightest ghosts of N LAMPS, times
 * SCALE, each at the brightest point of its ghost. To find these points,
 * ENGINE draws each ghost at a small size. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status
preview_draw_ghost_numbers(struct glint_engine *engine,
                           const struct glint_engine_lamp *lamps, int n,
                           double scale, const struct glint_image *image);

#endif
