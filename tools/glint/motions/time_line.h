/* SPDX-License-Identifier: MIT
 *
 * Draws the time line of a recorded motion on images of any 8-bit format.
 */
#ifndef GLINT_TOOLS_MOTIONS_TIME_LINE_H
#define GLINT_TOOLS_MOTIONS_TIME_LINE_H

#include "glint/image.h"
#include "glint/scene/motion.h"

/* Draws a bar along the lower edge of IMAGE: the position of FRAME in MOTION,
 * ticks at the frames in which landmarks were replaced, and the frame
 * number. */
void draw_time_line(const struct glint_image *image,
                    struct glint_motion *motion, int frame);

#endif
