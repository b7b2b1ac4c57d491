/* SPDX-License-Identifier: MIT */
#include "scenes/poses.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "options/suggest.h"
#include "options/text_lines.h"
#include "options/tool.h"
#include "posix/error.h"

enum { MOST_BYTES = 1 << 28, NUMBERS = 7 };

static const char no_memory[] = "no memory";

/* --------------------------------------------------------------------- line */

/* A line as it stands. */
struct said {
    double frame; /* -1: every frame */
    const char *thing;
    double v[NUMBERS]; /* x y z, and w x y z of the turn */
    unsigned given;    /* bits of V */
};

/* Returns the index of the thing NAME, or -2 with the cause in CAUSE[96]. */
static int find_thing(const struct glint_scene_model *m, const char *name,
                      char *cause)
{
    const int n = (int)m->header->n_objects;
    struct suggest suggest;
    const char *best;
    const int object = glint_scene_find(m, name);

    if (strcmp(name, "camera") == 0)
        return POSES_CAMERA;
    if (object >= 0)
        return object;
    suggest_begin(&suggest, name);
    suggest_try(&suggest, "camera", 6);
    for (int i = 0; i < n; i++)
        suggest_try(&suggest, m->object[i].name, strlen(m->object[i].name));
    for (uint32_t i = 0; i < m->header->n_lights; i++) {
        const char *const light = m->light[i].name;

        if (strcmp(name, light) == 0)
            return n + (int)i;
        suggest_try(&suggest, light, strlen(light));
    }
    best = suggest_best(&suggest);
    snprintf(cause, 96, "the scene has no '%.24s'%s%.24s%s", name,
             best ? "; did you mean '" : "", best ? best : "",
             best ? "'?" : "");
    return -2;
}

/* Sets TO to X over its length, _q30, z as the file has it; of a turn, which a
 * mirror turns the other way, x and y. Returns false if there is no length. */
static bool set_unit(const struct glint_scene_model *m, const double *x, int n,
                     int32_t *to)
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

static bool set_place(const struct glint_scene_model *m, const double at[3],
                      int32_t to[3])
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

/* Sets POSE to what SAID says. Returns NULL, or what is wrong with it, which
 * may be in CAUSE[96]. */
static const char *make(const struct glint_scene_model *m,
                        const struct said *said, struct pose *pose, char *cause)
{
    const int n = (int)m->header->n_objects;
    bool is_sun;

    if (!(said->frame == -1 || (said->frame >= 0 && said->frame < 1e9 &&
                                said->frame == floor(said->frame))))
        return "frame must be a whole number from 0, or *";
    *pose = (struct pose){.frame = said->frame < 0 ? 0 : (int)said->frame};
    pose->thing = find_thing(m, said->thing, cause);
    if (pose->thing == -2)
        return cause;
    is_sun =
        pose->thing >= n && m->light[pose->thing - n].kind == GLINT_LIGHT_SUN;
    if (is_sun ? !set_unit(m, said->v, 3, pose->at)
               : !set_place(m, said->v, pose->at))
        return is_sun ? "the direction to a sun must not be 0 0 0"
                      : "x, y or z is beyond what the scene was baked for";
    pose->has_turn = said->given >> 3;
    if (pose->has_turn && !set_unit(m, said->v + 3, 4, pose->turn_q30))
        return "qw, qx, qy, qz must not be all 0";
    return NULL;
}

static const char wanted[] = "expected frame,object,x,y,z[,qw,qx,qy,qz]";

static const char *parse_csv(char *line, struct said *said)
{
    char *rest = line, *field = text_field(&rest);
    int n = 0;

    if (strcmp(field, "*") == 0)
        said->frame = -1;
    else if (!tool_number(field, &said->frame))
        return "frame must be a whole number from 0, or *";
    said->thing = text_field(&rest);
    while (said->thing && (field = text_field(&rest))) {
        if (n == NUMBERS)
            return wanted;
        if (!tool_number(field, &said->v[n]))
            return "x, y, z, qw, qx, qy and qz are numbers";
        said->given |= 1U << n++;
    }
    return n == 3 || n == NUMBERS ? NULL : wanted;
}

static char *skip(char *at)
{
    while (isspace((unsigned char)*at))
        at++;
    return at;
}

/* Reads the text at *AT, which it ends, and moves *AT past it. Returns NULL if
 * there is none. */
static char *parse_text(char **at)
{
    char *text = skip(*at), *end;

    if (*text++ != '"' || !(end = strchr(text, '"')))
        return NULL;
    *end = '\0';
    *at = end + 1;
    return text;
}

/* Reads one "key": value at *AT and moves *AT past it. */
static const char *parse_member(char **at, struct said *said)
{
    static const char *const keys[] = {"x",  "y",  "z",     "qw",     "qx",
                                       "qy", "qz", "frame", "object", NULL};
    const char *const key = parse_text(at);
    const int field = key ? tool_word(key, keys) : -1;
    char *from;
    double v;

    if (!key)
        return "expected a \"key\"";
    if (field < 0)
        return "a key is none of frame object x y z qw qx qy qz";
    *at = skip(*at);
    if (*(*at)++ != ':')
        return "expected : after a key";
    from = *at = skip(*at);
    if (field == 8)
        return (said->thing = parse_text(at)) ? NULL : "object is a \"name\"";
    if (field == 7 && strncmp(from, "\"*\"", 3) == 0) {
        said->frame = -1;
        *at = from + 3;
        return NULL;
    }
    v = strtod(from, at);
    if (*at == from || !isfinite(v))
        return "a value is not a number";
    if (field == 7)
        said->frame = v;
    else {
        said->v[field] = v;
        said->given |= 1U << field;
    }
    return NULL;
}

static const char *parse_json(char *line, struct said *said)
{
    char *at = line + 1; /* after the brace */

    for (;;) {
        const char *const cause = parse_member(&at, said);

        if (cause)
            return cause;
        at = skip(at);
        if (*at == '}')
            break;
        if (*at++ != ',')
            return "expected , or }";
    }
    if (*skip(at + 1))
        return "something follows the object";
    if (!said->thing || (said->given & 7) != 7)
        return "object, x, y and z are needed";
    return said->given == 7 || said->given == 127
               ? NULL
               : "qw, qx, qy and qz belong together";
}

static const char *add(struct poses *p, const struct pose *pose)
{
    if (p->n == p->room) {
        const int room = p->room ? 2 * p->room : 64;
        struct pose *more = realloc(p->row, (size_t)room * sizeof *more);

        if (!more)
            return no_memory;
        p->row = more;
        p->room = room;
    }
    p->row[p->n] = *pose;
    p->row[p->n].order = p->n;
    p->n++;
    return NULL;
}

static bool is_heading(char *line)
{
    static const char *const names[] = {"frame", "object", "x",  "y", "z",
                                        "qw",    "qx",     "qy", "qz"};
    char *rest = line;
    const char *name;
    int n = 0;

    while (n < 9 && (name = text_field(&rest)) && strcmp(name, names[n]) == 0)
        n++;
    return n >= 5 && !rest;
}

/* Takes LINE, the first if IS_FIRST, into POSE; *IS_POSE: it is one. */
static const char *take_line(const struct poses *p, char *line, bool is_first,
                             struct pose *pose, bool *is_pose, char *cause)
{
    struct said said = {.frame = -1};
    const char *wrong;

    *is_pose = false;
    if (is_first && strncmp(line, "frame", 5) == 0)
        return is_heading(line)
                   ? NULL
                   : "the heading must be frame,object,x,y,z[,qw,qx,qy,qz]";
    wrong = *line == '{' ? parse_json(line, &said) : parse_csv(line, &said);
    if (wrong)
        return wrong;
    *is_pose = true;
    return make(&p->model, &said, pose, cause);
}

/* --------------------------------------------------------------------- file */

static int by_frame(const void *a, const void *b)
{
    const struct pose *p = a, *q = b;

    if (p->frame != q->frame)
        return p->frame < q->frame ? -1 : 1;
    return p->order < q->order ? -1 : p->order > q->order;
}

static enum glint_status read_file(struct poses *p, struct glint_error *error)
{
    struct text_lines lines;
    enum glint_status status =
        text_lines_open(&lines, p->name, MOST_BYTES, error);
    char *line;

    while (status == GLINT_OK && (line = text_lines_next(&lines))) {
        char text[96];
        struct pose pose;
        bool is_pose;
        const char *cause =
            take_line(p, line, lines.number == 1, &pose, &is_pose, text);

        if (!cause && is_pose)
            cause = add(p, &pose);
        if (cause)
            status = text_lines_fail(&lines, error, cause);
        if (cause == no_memory)
            status = GLINT_E_MEMORY;
    }
    text_lines_close(&lines);
    if (p->n > 0)
        qsort(p->row, (size_t)p->n, sizeof *p->row, by_frame);
    return status;
}

enum glint_status poses_open(struct poses *poses, const char *path,
                             bool is_live,
                             const struct glint_scene_model *model,
                             struct glint_error *error)
{
    enum glint_status status;
    struct stat st;

    *poses = (struct poses){
        .is_open = true, .model = *model, .name = path, .read_at = -1};
    line_pipe_init(&poses->pipe, -1);
    if (is_live && stat(path, &st) == 0 && S_ISFIFO(st.st_mode)) {
        line_pipe_init(&poses->pipe,
                       open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC));
        return poses->pipe.fd >= 0 ? GLINT_OK
                                   : glint_error_report(error, GLINT_E_IO, path,
                                                        "%s", strerror(errno));
    }
    status = read_file(poses, error);
    if (status != GLINT_OK)
        poses_close(poses);
    return status;
}

void poses_close(struct poses *poses)
{
    if (poses->is_open && poses->pipe.fd >= 0)
        close(poses->pipe.fd);
    free(poses->row);
    *poses = (struct poses){.pipe = {.fd = -1}};
}

/* --------------------------------------------------------------------- pipe */

static void note_bad(struct poses *p, int line, const char *cause)
{
    char where[sizeof p->bad.text];

    if (p->n_bad++ > 0)
        return;
    if (line > 0)
        snprintf(where, sizeof where, "%s:%d", p->name, line);
    else
        snprintf(where, sizeof where, "%s", p->name);
    glint_error_report(&p->bad, GLINT_E_FORMAT, where, "%s", cause);
}

/* Adds POSE behind those of its frame. */
static const char *insert(struct poses *p, const struct pose *pose)
{
    const char *cause;
    int i;

    if (p->next == p->n)
        p->next = p->n = 0;
    if (p->n == POSES_AHEAD)
        return "too many poses wait for their frames";
    cause = add(p, pose);
    for (i = p->n - 1;
         !cause && i > p->next && p->row[i - 1].frame > pose->frame; i--)
        p->row[i] = p->row[i - 1];
    if (!cause)
        p->row[i] = *pose;
    return cause;
}

static void take_piped(struct poses *p, char *line)
{
    struct pose pose;
    bool is_pose;
    const char *cause;
    char text[96], *end = line + strlen(line);

    line = skip(line);
    while (end > line && isspace((unsigned char)end[-1]))
        *--end = '\0';
    if (!*line || *line == '#')
        return;
    cause = take_line(p, line, p->pipe.number == 1, &pose, &is_pose, text);
    if (!cause && is_pose)
        cause = insert(p, &pose);
    if (cause)
        note_bad(p, p->pipe.number, cause);
}

static void read_pipe(struct poses *p)
{
    char *line;

    line_pipe_turn(&p->pipe);
    while ((line = line_pipe_next(&p->pipe)))
        if (p->pipe.is_long)
            note_bad(p, p->pipe.number, "the line is longer than 511 bytes");
        else
            take_piped(p, line);
}

const struct pose *poses_next(struct poses *poses, int frame)
{
    struct poses *p = poses;

    if (p->pipe.fd >= 0 && p->read_at != frame) {
        read_pipe(p);
        p->read_at = frame;
    }
    if (p->next == p->n || p->row[p->next].frame > frame)
        return NULL;
    return &p->row[p->next++];
}

bool poses_rewind(struct poses *poses)
{
    if (poses->pipe.fd < 0)
        poses->next = 0;
    return poses->pipe.fd < 0;
}

void poses_refuse(struct poses *poses, const struct pose *pose)
{
    char cause[96];

    snprintf(cause, sizeof cause,
             "a pose of frame %d takes a thing out of the scene's range",
             pose->frame);
    note_bad(poses, 0, cause);
}
