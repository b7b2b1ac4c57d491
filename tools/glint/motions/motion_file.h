/* SPDX-License-Identifier: MIT
 *
 * Opens recorded motions: bakes a recording, or reads a baked file.
 */
#ifndef GLINT_TOOLS_MOTIONS_MOTION_FILE_H
#define GLINT_TOOLS_MOTIONS_MOTION_FILE_H

#include "glint/scene/motion_bake.h"
#include "options/tool.h"

struct motion_file {
    void *data; /* contents of the baked motion, owned; MOTION points into it */
    size_t bytes;
    struct glint_motion motion;
    struct glint_motion_report report; /* report of the bake, if is_baked_now */
    bool is_baked_now;
};

/* Return whether ARGUMENT is a recording, NAME.json, or a file that begins
 * with the magic number of baked motions. */
bool motion_file_is_source(const char *argument);
bool motion_file_is_baked(const char *argument);

/* Open PATH: bake a recording, or read a baked file. Reject PATH if it is
 * WRITTEN, the output file. motion_file_open() prints the reason of a failure
 * and returns an exit code. */
enum glint_status motion_file_read(const char *path, const char *written,
                                   struct motion_file *file,
                                   struct glint_error *error);
int motion_file_open(const struct tool *tool, const char *path,
                     struct motion_file *file);
void motion_file_close(struct motion_file *file);

/* Prints the contents of FILE; with --json, as one object. */
void motion_file_print_contents(const struct tool *tool,
                                struct motion_file *file);

/* Writes the pose of each frame, in the units of the recording, to a CSV file:
 * frame,x,y,z,qw,qx,qy,qz. Returns an exit code. */
int motion_file_write_poses(const struct tool *tool, struct motion_file *file,
                            const char *to);

/* The command glint bake for motions; see options/tool.h. */
int cmd_bake_motion(struct tool *tool, int argc, char **argv);

#endif
