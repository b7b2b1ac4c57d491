/* SPDX-License-Identifier: MIT
 *
 * frame.h - frames of OBS as glint's images.
 */
#ifndef GLINT_TOOLS_OBS_FRAME_H
#define GLINT_TOOLS_OBS_FRAME_H

#include <stdbool.h>

#include <obs.h>

#include "glint/image.h"

/* Sets IMAGE to the pixels of FRAME where they lie, upside down where OBS will
 * turn them. Returns false for frames that glint does not draw on: of more than
 * 8 bits, of HDR curves, of a format or size that it does not have. */
bool frame_image(const struct obs_source_frame *frame,
                 struct glint_image *image);

#endif
