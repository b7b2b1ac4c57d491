/* SPDX-License-Identifier: MIT
 *
 * Writes the output of glint render: linear light if the file format stores
 * floats, else sRGB codes.
 */
#ifndef GLINT_TOOLS_DESK_RENDER_FILE_H
#define GLINT_TOOLS_DESK_RENDER_FILE_H

#include "glint/measure.h"
#include "options/tool.h"

/* Checks before rendering whether PATH can be written. Sets *IS_LINEAR to
 * whether PATH's file format stores floats. Returns EXIT_OK, or EXIT_OUTPUT
 * after printing the reason. */
int render_file_check_path(const struct tool *tool, const char *path,
                           bool *is_linear);

/* The same of a picture of 8-bit codes. */
int render_file_check_codes(const struct tool *tool, const char *path);

/* Writes IMAGE to PATH, after render_file_check_path(): unchanged if IS_LINEAR,
 * else as sRGB codes of the light times EXPOSURE (0: an exposure that makes the
 * 99.9th percentile white). Returns EXIT_OK or the code of tool_fail(). */
int render_file_save(const struct tool *tool, const char *path, bool is_linear,
                     const struct glint_float_image *image, double exposure);

/* Prints that WHAT was written to PATH, unless --quiet or --json. */
void render_file_print_summary(const struct tool *tool, const char *path,
                               int width, int height, const char *what,
                               double seconds);

#endif
