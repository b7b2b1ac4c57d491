/* SPDX-License-Identifier: MIT
 *
 * A time line of a recorded motion, over pictures of 8 bits in any format. */
#ifndef GLINT_TOOLS_MOTIONS_TIME_LINE_H
#define GLINT_TOOLS_MOTIONS_TIME_LINE_H

#include "glint/image.h"
#include "glint/scene/motion.h"

/* Draws, along the lower edge of IMAGE, how far FRAME is in MOTION, where foods
 * were replaced, and the frame's number. */
void time_line_draw(const struct glint_image *image,
                    struct glint_motion *motion, int frame);

#endif
