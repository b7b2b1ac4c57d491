/* SPDX-License-Identifier: MIT
 *
 * Baked motions: from recordings, and from files. */
#ifndef GLINT_TOOLS_MOTIONS_MOTION_FILE_H
#define GLINT_TOOLS_MOTIONS_MOTION_FILE_H

#include "glint/scene/motion_bake.h"
#include "options/tool.h"

struct motion_file {
    void *data; /* malloc'ed; MOTION points into it */
    size_t bytes;
    struct glint_motion motion;
    struct glint_motion_report report; /* of what was baked now */
    bool is_baked_now;
};

/* Returns whether ARGUMENT is a recording, NAME.json, or a baked motion by how
 * the file begins. */
bool motion_file_is_source(const char *argument);
bool motion_file_is_baked(const char *argument);

/* Opens the recording, which it bakes, or the baked file PATH,
 * unless it is the file WRITTEN. _open returns an exit code, after printing the
 * reason on failure. */
enum glint_status motion_file_read(const char *path, const char *written,
                                   struct motion_file *file,
                                   struct glint_error *error);
int motion_file_open(const struct tool *tool, const char *path,
                     struct motion_file *file);
void motion_file_close(struct motion_file *file);

/* Prints what is in FILE; with --json, as one object. */
void motion_file_print(const struct tool *tool, struct motion_file *file);

/* Writes the pose of each frame, in the units of the recording:
 * frame,x,y,z,qw,qx,qy,qz. Returns an exit code. */
int motion_file_poses(const struct tool *tool, struct motion_file *file,
                      const char *to);

/* glint bake of motions, as the commands of options/tool.h. */
int cmd_bake_motion(struct tool *tool, int argc, char **argv);

#endif
