/* SPDX-License-Identifier: MIT
 *
 * Sets up a single frame as glint's commands do, for tests of modules that the
 * engine uses.
 */
#ifndef GLINT_TESTS_SUPPORT_SETTINGS_FRAME_H
#define GLINT_TESTS_SUPPORT_SETTINGS_FRAME_H

#include "engine/frame/frame.h"
#include "model/opened_lens.h"

/* Command settings, and the lens opened with them. */
struct opened {
    struct settings settings;
    struct opened_lens lens;
};

/* Makes FRAME for an image of WIDTH x HEIGHT with the settings of OPENED.
 * Returns an exit code. */
int make_frame_from_settings(const struct tool *tool,
                             const struct opened *opened, int width, int height,
                             struct glint_frame *frame);

#endif
