/* SPDX-License-Identifier: MIT
 *
 * Opens environment maps: bakes a picture or text, or reads a baked file.
 */
#ifndef GLINT_TOOLS_SCENES_ENVIRONMENT_FILE_H
#define GLINT_TOOLS_SCENES_ENVIRONMENT_FILE_H

#include "glint/scene/environment_bake.h"
#include "options/tool.h"

struct environment_file {
    void *data; /* contents of the baked environment, owned; ENVIRONMENT points
                   into it */
    size_t bytes;
    struct glint_environment environment;
    /* report of the bake, if is_baked_now */
    struct glint_environment_report report;
    bool is_baked_now;
};

/* environment_file_is_source() returns whether ARGUMENT is a picture of light
 * (.exr, .hdr, .pfm, .dds) or the text of an environment.
 * environment_file_is_baked() returns whether ARGUMENT begins with the magic
 * number of baked environments. */
bool environment_file_is_source(const char *argument);
bool environment_file_is_baked(const char *argument);

/* Open PATH, a picture, text or baked file. Reject PATH, or the picture that a
 * text names, if it is the output file WRITTEN. OVERRIDE (may be NULL) is
 * called after the options of a text were read, and may change them. LEFT (may
 * be NULL) is the remaining bake work, see tool_count_bake_work(). The work of
 * a bake is the cube of the number of texels along a side.
 * environment_file_open() prints the reason of a failure and returns an exit
 * code. */
enum glint_status environment_file_read(
    const char *path, const char *written,
    void (*override)(void *ctx, struct glint_environment_options *), void *ctx,
    int64_t *left, struct environment_file *file, struct glint_error *error);

int environment_file_open(const struct tool *tool, const char *path,
                          void (*override)(void *ctx,
                                           struct glint_environment_options *),
                          void *ctx, struct environment_file *file);

void environment_file_close(struct environment_file *file);

/* Prints the contents of FILE; with --json, as one object. */
void environment_file_print_contents(const struct tool *tool,
                                     const struct environment_file *file);

/* The command glint bake for environments; see options/tool.h. */
int cmd_bake_environment(struct tool *tool, int argc, char **argv);

#endif
