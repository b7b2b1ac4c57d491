/* SPDX-License-Identifier: MIT
 *
 * poses.h - reads positions and rotations of the objects of a scene, frame by
 * frame.
 *
 *     poses_open(&poses, path, is_live, &model, &error);
 *     while ((pose = poses_next_pose(&poses, frame)))           each frame
 *         ...
 *     poses_close(&poses);
 *
 * The text is CSV, "frame,object,x,y,z[,qw,qx,qy,qz]", of which the first line
 * may be this heading, or flat JSON objects with these keys. "object" is the
 * name of an object or light of the scene, or "camera". Frames count from 0. A
 * frame "*" means every frame until a later line for the object. x, y, z are
 * the position in scene units, or for a sun the direction to it. Their axes
 * have the handedness of the scene text. The quaternion rotates the object's
 * own axes to those of the scene. The own axes of a camera are x right, y up,
 * and the view direction of a camera that is not rotated. Without a quaternion
 * the rotation does not change. A pose is valid until the next pose of its
 * object.
 */
#ifndef GLINT_TOOLS_SCENES_POSES_H
#define GLINT_TOOLS_SCENES_POSES_H

#include "glint/scene/model.h"
#include "options/timed_text.h"

enum {
    POSES_CAMERA = -1,
    /* max number of queued poses from a pipe */
    POSES_AHEAD = 1 << 16
};

struct pose {
    /* frame number; index of the line, by which the poses of a frame are
     * sorted */
    int frame, order;
    /* index of an object, n_objects + index of a light, or POSES_CAMERA */
    int thing;
    bool has_turn;
    /* position, scene steps; for a sun the direction to it, Q30 */
    int32_t at[3];
    int32_t turn_q30[4]; /* unit quaternion w, x, y, z */
};

struct poses {
    long n_bad;             /* number of lines of a pipe that were skipped */
    struct glint_error bad; /* error of the first skipped line */

    /* Private. */
    bool is_open;
    struct glint_scene_model model;
    /* lines of the file; closed after a file was read */
    struct text_lines lines;
    struct pose *row; /* poses sorted by frame */
    int n, next;
    int read_at; /* frame at which the pipe was last read */
};

/* Opens PATH. PATH and the data of MODEL must outlive POSES. If IS_LIVE and
 * PATH is a FIFO, lines are read as they arrive, without waiting. Otherwise all
 * lines are read now. Errors: GLINT_E_IO, GLINT_E_MEMORY, and GLINT_E_FORMAT
 * with "FILE:LINE: cause" in ERROR. */
enum glint_status poses_open(struct poses *poses, const char *path,
                             bool is_live,
                             const struct glint_scene_model *model,
                             struct glint_error *error);

/* Returns the next pose for FRAME or an earlier frame, or NULL if there are
 * no more. FRAME must not decrease from call to call. */
const struct pose *poses_next_pose(struct poses *poses, int frame);

/* Starts again before the first frame. Returns false for a pipe, which cannot
 * do this. */
bool poses_rewind(struct poses *poses);

/* Counts the line of POSE as skipped, because it would move an object out of
 * the range of the scene. */
void poses_reject_line(struct poses *poses, const struct pose *pose);

void poses_close(struct poses *poses);

#endif
