/* SPDX-License-Identifier: MIT
 *
 * The files that glint render writes: linear light where the format takes
 * floats, else sRGB codes. */
#ifndef GLINT_TOOLS_DESK_RENDER_FILE_H
#define GLINT_TOOLS_DESK_RENDER_FILE_H

#include "glint/measure.h"
#include "options/tool.h"

/* Checks, before there is much work, whether PATH can be written. Sets
 * IS_LINEAR if its format takes floats. Returns EXIT_OK, or EXIT_OUTPUT after
 * printing the reason. */
int render_file_check(const struct tool *tool, const char *path,
                      bool *is_linear);

/* Writes IMAGE to PATH, which render_file_check() passed: as it is if
 * IS_LINEAR, else as codes of its light times EXPOSURE (0: so that its 99.9th
 * percentile is white). Returns EXIT_OK or what tool_fail() returns. */
int render_file_save(const struct tool *tool, const char *path, bool is_linear,
                     const struct glint_float_image *image, double exposure);

/* States that WHAT was written to PATH, in a line, unless --quiet or --json. */
void render_file_say(const struct tool *tool, const char *path, int width,
                     int height, const char *what, double seconds);

#endif
