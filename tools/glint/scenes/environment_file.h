/* SPDX-License-Identifier: MIT
 *
 * Baked environments: from pictures and texts, and from files.
 */
#ifndef GLINT_TOOLS_SCENES_ENVIRONMENT_FILE_H
#define GLINT_TOOLS_SCENES_ENVIRONMENT_FILE_H

#include "glint/scene/environment_bake.h"
#include "options/tool.h"

struct environment_file {
    void *data; /* malloc'ed; ENVIRONMENT points into it */
    size_t bytes;
    struct glint_environment environment;
    struct glint_environment_report report; /* of what was baked now */
    bool is_baked_now;
};

/* Returns whether ARGUMENT is a picture of light (.exr, .hdr, .pfm, .dds), the
 * text of an environment, or a baked one by how the file begins. */
bool environment_file_is_source(const char *argument);
bool environment_file_is_baked(const char *argument);

/* Opens the picture, text or baked file PATH, unless it, or the picture of a
 * text, is the file WRITTEN. OVERRIDE, unless NULL, changes the options of what
 * is to be baked, after those of a text were read. _open returns an exit code,
 * after printing the reason on failure, and keeps what TOOL writes. */
enum glint_status environment_file_read(
    const char *path, const char *written,
    void (*override)(void *ctx, struct glint_environment_options *), void *ctx,
    struct environment_file *file, struct glint_error *error);

int environment_file_open(const struct tool *tool, const char *path,
                          void (*override)(void *ctx,
                                           struct glint_environment_options *),
                          void *ctx, struct environment_file *file);

void environment_file_close(struct environment_file *file);

/* Prints what is in FILE; with --json, as one object. */
void environment_file_print(const struct tool *tool,
                            const struct environment_file *file);

/* glint bake of environments, as the commands of options/tool.h. */
int cmd_bake_environment(struct tool *tool, int argc, char **argv);

#endif
