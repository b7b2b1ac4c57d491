/* SPDX-License-Identifier: MIT
 *
 * preview.h - the numbers of ghosts, on the picture that shows them.
 */
#ifndef GLINT_TOOLS_DESK_PREVIEW_H
#define GLINT_TOOLS_DESK_PREVIEW_H

#include "glint/engine.h"

/* Writes onto IMAGE the numbers of the brightest ghosts that ENGINE draws of N
 * LAMPS times SCALE, each where the ghost is brightest. The ghosts are drawn
 * small, one by one, to find these places. GLINT_E_MEMORY. */
enum glint_status preview_number(struct glint_engine *engine,
                                 const struct glint_engine_lamp *lamps, int n,
                                 double scale, const struct glint_image *image);

#endif
