/* SPDX-License-Identifier: MIT
 *
 * config.h - a command's options from a file, before those of its line.
 *
 *     struct config config = {tool, options, take, &live, NULL};
 *     path = tool_value_of(argc, argv, "o:", options, OPT_CONFIG);
 *     if (path && (code = config_read(&config, path)) != EXIT_OK)
 *         return code;
 *     ... getopt_long() as ever: the line comes later and wins
 *     config_free(&config);
 *
 * A file has lines "name = value", name being that of a long option; "name:
 * value" is the same. Options without a value are "name = yes" or "no". An
 * option that may be repeated on the line may be repeated here. Sections
 * [camera], [lens], [light], [flare] and [output] have no effect; any other
 * gives a warning.
 * Lines that begin with ; or # are comments, and so is the end of a line from a
 * ; after a blank. There are no quotes and no continued lines; a line has up to
 * CONFIG_LINE characters.
 *
 * Nothing is taken from a file with a line that is malformed or an option that
 * does not exist. inih parses the file; built without it, config_read() fails
 * with a message.
 */
#ifndef GLINT_TOOLS_OPTIONS_CONFIG_H
#define GLINT_TOOLS_OPTIONS_CONFIG_H

#include "options/command_line.h"

/* most bytes of a line, for which any build of inih has room */
#define CONFIG_LINE 190

/* Takes OPTION as from the command line; VALUE is NULL where it has none.
 * Returns -1 to continue, else an exit code, after printing why by
 * tool_usage(), which adds file and line. */
typedef int config_take_fn(void *ctx, const struct option *option,
                           const char *value);

struct config {
    struct tool *tool;
    const struct option *options; /* ended by one without a name */
    config_take_fn *take;
    void *ctx;
    char *values; /* private: values that were given to take; NULL at first */
};

/* Reads PATH and takes its options. Values stay in memory until config_free().
 * Returns an exit code, EXIT_INPUT for a bad file; on failure prints the reason
 * and frees CONFIG. */
int config_read(struct config *config, const char *path);

/* Takes the options in TEXT[BYTES]. NAME is for errors. Returns EXIT_OK; or
 * EXIT_RUNTIME or EXIT_INPUT with ERROR set; or what take returned, with ERROR
 * empty. */
int config_parse(struct config *config, const char *name, const char *text,
                 size_t bytes, struct glint_error *error);

void config_free(struct config *config);

#endif
