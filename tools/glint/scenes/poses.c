/* SPDX-License-Identifier: MIT */
#include "scenes/poses.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/suggest.h"

enum { MAX_BYTES = 1 << 28, FRAME = 0, OBJECT, PLACE, TURN = 5, COLUMNS = 9 };

static const struct text_column columns[COLUMNS] = {
    {"frame", 0, TEXT_MAX_FRAME - 1,
     "frame must be a whole number from 0 to 999999999, or *"},
    {"object", 0, 0, ""},
    {"x", -DBL_MAX, DBL_MAX, ""},
    {"y", -DBL_MAX, DBL_MAX, ""},
    {"z", -DBL_MAX, DBL_MAX, ""},
    {"qw", -DBL_MAX, DBL_MAX, ""},
    {"qx", -DBL_MAX, DBL_MAX, ""},
    {"qy", -DBL_MAX, DBL_MAX, ""},
    {"qz", -DBL_MAX, DBL_MAX, ""},
};

/* --------------------------------------------------------------------- line */

/* Returns the index of the object NAME, n_objects plus that of the light NAME,
 * or POSES_CAMERA if NAME is "camera". Returns -2 with an error message in
 * LINES if there is none. */
static int find_pose_target(const struct glint_scene_model *m, const char *name,
                            struct text_lines *lines)
{
    const int n = (int)m->header->n_objects;
    struct suggest suggest;
    const int object = glint_scene_find(m, name);

    if (strcmp(name, "camera") == 0)
        return POSES_CAMERA;
    if (object >= 0)
        return object;
    suggest_begin(&suggest, name);
    suggest_add_candidate(&suggest, "camera", 6);
    for (int i = 0; i < n; i++)
        suggest_add_candidate(&suggest, m->object[i].name,
                              strlen(m->object[i].name));
    for (uint32_t i = 0; i < m->header->n_lights; i++) {
        const char *const light = m->light[i].name;

        if (strcmp(name, light) == 0)
            return n + (int)i;
        suggest_add_candidate(&suggest, light, strlen(light));
    }
    text_lines_format_cause(lines, "the scene has no '%.24s'%s", name,
                            suggest_from_words(&suggest));
    return -2;
}

/* Sets TO to X[N] divided by its length, Q30. For a right-handed scene negates
 * z of a vector (N = 3), or x and y of a quaternion w, x, y, z (N = 4). Returns
 * false if the length is outside 1e-15 .. 1e15. */
static bool set_unit_vector_q30(const struct glint_scene_model *m,
                                const double *x, int n, int32_t *to)
{
    const double hand = m->header->variant == GLINT_HAND_RIGHT ? -1 : 1;
    double square = 0;

    for (int i = 0; i < n; i++)
        square += x[i] * x[i];
    if (!(square > 1e-30 && square < 1e30))
        return false;
    for (int i = 0; i < n; i++)
        to[i] =
            (int32_t)lround(0x1p30 * x[i] / sqrt(square) *
                            ((n == 4 ? i == 1 || i == 2 : i == 2) ? hand : 1));
    return true;
}

static bool set_pose_position(const struct glint_scene_model *m,
                              const double at[3], int32_t to[3])
{
    const double hand = m->header->variant == GLINT_HAND_RIGHT ? -1 : 1;

    for (int i = 0; i < 3; i++) {
        const double steps = ldexp(at[i], m->header->unit_log2);

        if (!(fabs(steps) < GLINT_SCENE_SPAN - 1))
            return false;
        to[i] = (int32_t)lround(i == 2 ? hand * steps : steps);
    }
    return true;
}

/* Sets POSE to the values V of a line for the object NAME. Returns NULL or an
 * error message. */
static const char *make_pose(const struct glint_scene_model *m,
                             struct text_lines *lines, const char *name,
                             const double v[COLUMNS], struct pose *pose)
{
    const int n = (int)m->header->n_objects;
    bool is_sun;

    if (v[FRAME] != floor(v[FRAME]))
        return columns[FRAME].range;
    pose->frame = v[FRAME] < 0 ? 0 : (int)v[FRAME];
    pose->thing = find_pose_target(m, name, lines);
    if (pose->thing == -2)
        return lines->cause;
    is_sun =
        pose->thing >= n && m->light[pose->thing - n].kind == GLINT_LIGHT_SUN;
    if (is_sun ? !set_unit_vector_q30(m, v + PLACE, 3, pose->at)
               : !set_pose_position(m, v + PLACE, pose->at))
        return is_sun ? "the direction to a sun must not be 0 0 0"
                      : "x, y or z is out of the range that the scene was "
                        "baked for";
    if (pose->has_turn && !set_unit_vector_q30(m, v + TURN, 4, pose->turn_q30))
        return "qw, qx, qy, qz must not be all 0";
    return NULL;
}

static const char *split_line_into_columns(struct text_lines *lines, char *line,
                                           char *field[COLUMNS])
{
    const char *cause;
    int n = 0;

    if (*line != '{') {
        n = text_split_fields(line, field, COLUMNS);
        return n == TURN || n == COLUMNS
                   ? NULL
                   : "expected frame,object,x,y,z[,qw,qx,qy,qz]";
    }
    cause = text_parse_json_object(lines, line, columns, COLUMNS, field);
    if (field[OBJECT] && *field[OBJECT]++ != '"')
        return "object must be a \"name\"";
    if (cause)
        return cause;
    for (int k = TURN; k < COLUMNS; k++)
        n += field[k] != NULL;
    if (!field[OBJECT] || !field[PLACE] || !field[PLACE + 1] ||
        !field[PLACE + 2])
        return "object, x, y and z are needed";
    return n == 0 || n == COLUMNS - TURN
               ? NULL
               : "give all of qw, qx, qy and qz, or none";
}

static const char *parse_pose_columns(const struct poses *p,
                                      struct text_lines *lines, char *line,
                                      struct pose *pose)
{
    const bool is_object = *line == '{';
    double v[COLUMNS] = {-1};
    char *field[COLUMNS] = {NULL};
    const char *const late = split_line_into_columns(lines, line, field);
    const char *cause = NULL;

    for (int k = 0; k < COLUMNS && !cause; k++)
        if (field[k] && k != OBJECT &&
            (k != FRAME || strcmp(field[k], is_object ? "\"*" : "*") != 0))
            cause = text_parse_value(
                &columns[k], field[k],
                is_object    ? "a value is not a number"
                : k == FRAME ? columns[k].range
                             : "x, y, z, qw, qx, qy and qz must be numbers",
                &v[k]);
    *pose = (struct pose){.has_turn = field[TURN] != NULL};
    if (cause || late)
        return cause ? cause : late;
    return make_pose(&p->model, lines, field[OBJECT], v, pose);
}

static const char *check_column_heading(char *line)
{
    char *name[COLUMNS];
    const int n = text_split_fields(line, name, COLUMNS);
    int same = 0;

    while (same < n && same < COLUMNS &&
           strcmp(name[same], columns[same].name) == 0)
        same++;
    return n >= TURN && same == n
               ? NULL
               : "the heading must be frame,object,x,y,z[,qw,qx,qy,qz]";
}

static int compare_pose_frames(const void *a, const void *b)
{
    const struct pose *p = a, *q = b;

    if (p->frame != q->frame)
        return p->frame < q->frame ? -1 : 1;
    return p->order < q->order ? -1 : p->order > q->order;
}

/* Inserts POSE: at the end for a file, which is sorted later; for a pipe after
 * the last pose of the same frame. Returns NULL or an error message. */
static const char *insert_pose(struct poses *p, const struct pose *pose)
{
    struct pose *more;
    int i = p->n;

    if (p->lines.is_pipe && p->next == p->n)
        i = p->next = p->n = 0;
    if (p->lines.is_pipe && p->n == POSES_AHEAD)
        return "more than 65536 poses of later frames are queued";
    more = text_grow_array(p->row, p->n, sizeof *more);
    if (!more)
        return text_no_memory;
    p->row = more;
    p->n++;
    while (p->lines.is_pipe && i > p->next && more[i - 1].frame > pose->frame) {
        more[i] = more[i - 1];
        i--;
    }
    more[i] = *pose;
    more[i].order = i;
    return NULL;
}

static const char *parse_pose_line(void *ctx, struct text_lines *lines,
                                   char *line)
{
    struct poses *const p = ctx;
    struct pose pose;
    const char *cause;

    if (lines->number == 1 && strncmp(line, "frame", 5) == 0)
        return check_column_heading(line);
    cause = parse_pose_columns(p, lines, line, &pose);
    return cause ? cause : insert_pose(p, &pose);
}

/* --------------------------------------------------------------------- file */

enum glint_status poses_open(struct poses *poses, const char *path,
                             bool is_live,
                             const struct glint_scene_model *model,
                             struct glint_error *error)
{
    enum glint_status status;

    *poses = (struct poses){.is_open = true, .model = *model, .read_at = -1};
    if (is_live && text_is_named_pipe(path))
        return text_lines_open_pipe(&poses->lines, path, error);
    status = text_lines_open(&poses->lines, path, NULL, MAX_BYTES, error);
    if (status == GLINT_OK)
        status =
            text_lines_parse_each(&poses->lines, parse_pose_line, poses, error);
    if (poses->n > 0)
        qsort(poses->row, (size_t)poses->n, sizeof *poses->row,
              compare_pose_frames);
    if (status != GLINT_OK)
        poses_close(poses);
    return status;
}

void poses_close(struct poses *poses)
{
    text_lines_close(&poses->lines);
    free(poses->row);
    *poses = (struct poses){.is_open = false};
}

/* --------------------------------------------------------------------- pipe */

/* Counts the last line as skipped. Records CAUSE as the error if no line was
 * skipped before. */
static void record_line_error(struct poses *p, const char *cause)
{
    if (p->n_bad++ == 0)
        text_lines_report_error(&p->lines, &p->bad, cause);
}

static void read_poses_from_pipe(struct poses *p)
{
    const char *cause;
    char *line;

    text_lines_reset_read_limit(&p->lines);
    while ((line = text_lines_read_next(&p->lines))) {
        cause = p->lines.is_long ? "the line is longer than 511 bytes"
                                 : parse_pose_line(p, &p->lines, line);
        if (cause)
            record_line_error(p, cause);
    }
}

const struct pose *poses_next_pose(struct poses *poses, int frame)
{
    struct poses *p = poses;

    if (p->lines.is_pipe && p->read_at != frame) {
        read_poses_from_pipe(p);
        p->read_at = frame;
    }
    if (p->next == p->n || p->row[p->next].frame > frame)
        return NULL;
    return &p->row[p->next++];
}

bool poses_rewind(struct poses *poses)
{
    if (!poses->lines.is_pipe)
        poses->next = 0;
    return !poses->lines.is_pipe;
}

void poses_reject_line(struct poses *poses, const struct pose *pose)
{
    if (poses->n_bad++ == 0)
        glint_error_report(
            &poses->bad, GLINT_E_FORMAT, poses->lines.name,
            "a pose of frame %d moves an object out of the scene's range",
            pose->frame);
}
