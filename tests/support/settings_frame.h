/* SPDX-License-Identifier: MIT
 *
 * A frame by itself, as commands set it up, for tests of what engines are made
 * of.
 */
#ifndef GLINT_TESTS_SUPPORT_SETTINGS_FRAME_H
#define GLINT_TESTS_SUPPORT_SETTINGS_FRAME_H

#include "engine/frame/frame.h"
#include "model/settings.h"

/* Makes FRAME as the options say. Returns an exit code. */
int settings_frame(const struct tool *tool, const struct settings *settings,
                   struct glint_view view, struct glint_frame *frame);

#endif
