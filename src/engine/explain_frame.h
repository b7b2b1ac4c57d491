/* SPDX-License-Identifier: MIT
 *
 * Explains a frame that no engine has drawn. */
#ifndef GLINT_ENGINE_EXPLAIN_FRAME_H
#define GLINT_ENGINE_EXPLAIN_FRAME_H

#include "engine/frame/frame.h"
#include "glint/explain.h"

/* Does as glint_explain_open(), of what FRAME drew last. */
enum glint_status glint_explain_frame(struct glint_explain *explain,
                                      struct glint_frame *frame, double unit);

#endif
