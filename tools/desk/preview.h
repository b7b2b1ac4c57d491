/* SPDX-License-Identifier: MIT
 *
 * preview.h - the numbers of ghosts, on the picture that shows them.
 */
#ifndef GLINT_TOOLS_DESK_PREVIEW_H
#define GLINT_TOOLS_DESK_PREVIEW_H

#include "engine/frame/frame.h"

/* Writes onto IMAGE the numbers of the brightest ghosts that N LAMPS times
 * SCALE make in FRAME, each where the ghost is brightest. The ghosts are drawn
 * small, one by one, to find these places. GLINT_E_MEMORY. */
enum glint_status preview_number(const struct glint_frame *frame,
                                 const struct glint_lamp *lamps, int n,
                                 double scale, const struct glint_image *image);

#endif
