/* SPDX-License-Identifier: MIT
 *
 * A single frame, set up like that of a command, for tests of the parts of an
 * engine.
 */
#ifndef GLINT_TESTS_SUPPORT_SETTINGS_FRAME_H
#define GLINT_TESTS_SUPPORT_SETTINGS_FRAME_H

#include "engine/frame/frame.h"
#include "model/settings.h"

/* Makes FRAME as the options say. Returns an exit code. */
int settings_frame(const struct tool *tool, const struct settings *settings,
                   struct glint_view view, struct glint_frame *frame);

#endif
