/* SPDX-License-Identifier: MIT
 *
 * Collects statistics of a drawn frame per ghost, per light and per wavelength.
 * It is for programs that draw frames without an engine. */
#ifndef GLINT_ENGINE_EXPLAIN_FRAME_H
#define GLINT_ENGINE_EXPLAIN_FRAME_H

#include "engine/frame/frame.h"
#include "glint/explain.h"

/* Like glint_explain_open(), collects statistics of the last picture that FRAME
 * drew. UNIT: light in the report / light in the frame. */
enum glint_status glint_explain_open_for_frame(struct glint_explain *explain,
                                               struct glint_frame *frame,
                                               double unit);

#endif
