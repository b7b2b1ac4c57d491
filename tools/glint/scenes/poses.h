/* SPDX-License-Identifier: MIT
 *
 * poses.h - where the objects of a scene are, frame by frame.
 *
 *     poses_open(&poses, path, is_live, &model, &error);
 *     while ((pose = poses_next(&poses, frame)))           each frame
 *         ...
 *     poses_close(&poses);
 *
 * Lines of text, CSV "frame,object,x,y,z[,qw,qx,qy,qz]" or flat JSON objects
 * with these keys; the first may be that heading. object is the name of an
 * object or light of the scene, or camera; frames count from 0, * is every
 * frame until a later line says otherwise. x, y, z are scene units, of a sun
 * the direction to it, in the hand of the scene's text; the quaternion turns
 * from the object's own axes (of the camera: x right, y up, looking as one that
 * is not turned) to the scene's; without it the turn stays. A pose holds until
 * the next.
 */
#ifndef GLINT_TOOLS_SCENES_POSES_H
#define GLINT_TOOLS_SCENES_POSES_H

#include "glint/scene/model.h"
#include "options/timed_text.h"

enum {
    POSES_CAMERA = -1,
    POSES_AHEAD = 1 << 16 /* poses of a pipe that wait for their frames */
};

struct pose {
    int frame, order; /* order: of the lines of a file */
    int thing;        /* index of an object, n_objects + index of a light, or
                         POSES_CAMERA */
    bool has_turn;
    /* In steps; of a sun a unit vector, _q30. */
    int32_t at[3];
    int32_t turn_q30[4]; /* unit quaternion w, x, y, z */
};

struct poses {
    long n_bad;             /* lines of a pipe that were skipped */
    struct glint_error bad; /* the first of them */

    /* Private. */
    bool is_open;
    struct glint_scene_model model;
    struct text_lines lines; /* closed at the end of a file */
    struct pose *row;        /* by frames */
    int n, next;
    int read_at; /* frame at which a pipe was read last */
};

/* Opens PATH, which like what MODEL points to must outlive POSES. IS_LIVE: if
 * it is a FIFO its lines are taken as they come, and it is never waited for;
 * else it is read to its end. GLINT_E_IO; GLINT_E_FORMAT, ERROR then says
 * FILE:LINE: cause; GLINT_E_MEMORY. */
enum glint_status poses_open(struct poses *poses, const char *path,
                             bool is_live,
                             const struct glint_scene_model *model,
                             struct glint_error *error);

/* Returns the next pose that FRAME, which rises, has or had, or NULL. */
const struct pose *poses_next(struct poses *poses, int frame);

/* Goes back before the first frame; returns false of a pipe, which cannot. */
bool poses_rewind(struct poses *poses);

/* Notes that POSE, of which the scene would leave its range, was skipped.
 */
void poses_refuse(struct poses *poses, const struct pose *pose);

void poses_close(struct poses *poses);

#endif
