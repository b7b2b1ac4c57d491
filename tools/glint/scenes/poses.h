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
 * may be this heading, or flat JSON objects with these keys. object is the name
 * of an object or light of the scene, or camera. Frames count from 0; * is
 * every frame until a later line for the object. x, y, z are scene units, for a
 * sun the direction to it, in the handedness of the scene's text. The
 * quaternion rotates from the object's own axes (camera: x right, y up, looking
 * in the direction of a camera that is not rotated) to those of the scene;
 * without it the rotation does not change. A pose is valid until the next pose
 * of its object.
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
    int frame, order; /* frame number, and index of the line, by which poses of
                       * one frame are sorted */
    int thing;        /* index of an object, n_objects + index of a light, or
                         POSES_CAMERA */
    bool has_turn;
    /* position in scene steps; for a sun a unit vector, Q30 */
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

/* Opens PATH. PATH and the data of MODEL must outlive POSES. If IS_LIVE, a
 * FIFO is read line by line without waiting for data; else the file is read
 * to its end. Errors: GLINT_E_IO, GLINT_E_MEMORY, and GLINT_E_FORMAT with
 * "FILE:LINE: cause" in ERROR. */
enum glint_status poses_open(struct poses *poses, const char *path,
                             bool is_live,
                             const struct glint_scene_model *model,
                             struct glint_error *error);

/* Returns the next pose for FRAME or an earlier frame, or NULL if there are
 * no more. FRAME must not decrease from call to call. */
const struct pose *poses_next_pose(struct poses *poses, int frame);

/* Restarts before the first frame. Returns false for a pipe, which cannot
 * restart. */
bool poses_rewind(struct poses *poses);

/* Counts POSE as skipped because it would move an object out of the scene's
 * range. */
void poses_reject_line(struct poses *poses, const struct pose *pose);

void poses_close(struct poses *poses);

#endif
