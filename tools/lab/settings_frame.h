/* SPDX-License-Identifier: MIT
 *
 * A frame by itself, for measurements of what engines are made of.
 */
#ifndef GLINT_TOOLS_LAB_SETTINGS_FRAME_H
#define GLINT_TOOLS_LAB_SETTINGS_FRAME_H

#include "engine/frame/frame.h"
#include "model/settings.h"

/* Makes FRAME as the options say. Returns an exit code. */
int settings_frame(const struct tool *tool, const struct settings *settings,
                   struct glint_view view, struct glint_frame *frame);

#endif
