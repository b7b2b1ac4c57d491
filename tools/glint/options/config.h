/* SPDX-License-Identifier: MIT
 *
 * config.h - reads options of a command from a file, before its command line.
 *
 *     struct config config = {.tool = tool, .options = options, ...};
 *     path = tool_find_option_value(argc, argv, "o:", options, OPT_CONFIG);
 *     if (path && (code = config_read(&config, path)) != EXIT_OK)
 *         return code;
 *     ... getopt_long() as usual: the command line overrides the file
 *     config_free(&config);
 *
 * A file has lines "name = value" or "name: value", where name is a long
 * option. Flags are "name = yes" or "no". An option that may be repeated on the
 * command line may be repeated here. Section headings [camera], [lens],
 * [light], [flare] and [output] have no effect; any other heading gives a
 * warning. Lines that begin with ; or # are comments. A ; after a blank begins
 * a comment that ends with the line. Quotes and continuation lines are not
 * supported.
 *
 * If any line is malformed or any option does not exist, no option of the file
 * is applied.
 */
#ifndef GLINT_TOOLS_OPTIONS_CONFIG_H
#define GLINT_TOOLS_OPTIONS_CONFIG_H

#include "options/command_line.h"
#include "options/timed_text.h"

/* Applies OPTION with VALUE, which is NULL for a flag, as from the command
 * line. Returns -1 to continue. Otherwise prints the reason by tool_usage(),
 * which adds file and line, and returns its exit code. */
typedef int config_take_fn(void *ctx, const struct option *option,
                           const char *value);

struct config {
    struct tool *tool;
    const struct option *options; /* ends with a row without a name */
    config_take_fn *take;
    void *ctx;
    struct text_lines lines; /* private: memory of the values passed to TAKE */
};

/* Reads the file PATH and applies its options. Their values stay valid until
 * config_free(). On failure prints the reason, frees CONFIG and returns an exit
 * code: EXIT_INPUT for an invalid file. */
int config_read(struct config *config, const char *path);

/* Applies the options in TEXT[BYTES]; NAME is the file's name in errors. If
 * TEXT is NULL, reads the file NAME, which must have at most BYTES bytes.
 * Returns EXIT_OK; EXIT_RUNTIME or EXIT_INPUT with the reason in ERROR; or the
 * exit code of TAKE, which has printed the reason. */
int config_parse(struct config *config, const char *name, const char *text,
                 size_t bytes, struct glint_error *error);

void config_free(struct config *config);

#endif
