/* SPDX-License-Identifier: MIT
 *
 * engine_options.h - the engine's options on a command line: parsing, help and
 * values, all generated from the table in glint/options.h.
 *
 *     static const struct option own[] = {{"output", ...}, {NULL, 0, NULL, 0}};
 *     options = engine_build_options(&tool, ENGINE_ALL, &values, own);
 *     code = engine_apply_option(&tool, &values, c, optarg);
 */
#ifndef GLINT_TOOLS_OPTIONS_ENGINE_OPTIONS_H
#define GLINT_TOOLS_OPTIONS_ENGINE_OPTIONS_H

#include "glint/options.h"
#include "options/tool.h"

/* getopt_long() codes of the engine's options. Commands number their own
 * options from ENGINE_OPTIONS_END on. */
enum {
    ENGINE_OPTION = 1000,
    ENGINE_OPTIONS_END = ENGINE_OPTION + GLINT_N_OPTIONS
};
#define ENGINE_OPTION_OF(member) (ENGINE_OPTION + GLINT_OPTION_OF_##member)

/* Bit of an option group in tool.groups */
#define ENGINE_GROUP(group) (1U << GLINT_OPTIONS_##group)
#define ENGINE_DRAWING \
    (ENGINE_GROUP(LENS) | ENGINE_GROUP(BRIGHTNESS) | ENGINE_GROUP(SPEED))
#define ENGINE_ALL (~0U)

/* Sets the option with getopt code CODE in VALUES to VALUE, which is NULL for a
 * flag. Returns -1 on success and -2 if CODE is not an engine option. If VALUE
 * is invalid, prints which values the option accepts and returns an exit
 * code. */
int engine_apply_option(const struct tool *tool, struct glint_options *values,
                        int code, const char *value);

/* Writes the help of TOOL's option groups to TEXT, with TOOL's defaults. */
enum { ENGINE_HELP_BYTES = 24576 };
void engine_write_help(const struct tool *tool, char text[ENGINE_HELP_BYTES]);

#endif
