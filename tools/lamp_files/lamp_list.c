/* SPDX-License-Identifier: MIT */
#include "lamp_files/lamp_list.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/area.h"
#include "lamp_files/lamp_keys.h"
#include "options/text_lines.h"
#include "options/tool.h"

enum { FIELDS = 8 };

static const char *const names[FIELDS + 2] = {
    "frame", "x", "y", "power", "r", "g", "b", "size", "id", NULL};

static struct lamp_row row_of(const double *v)
{
    return (struct lamp_row){.frame = (int)v[0],
                             .x = v[1],
                             .y = v[2],
                             .power = v[3],
                             .rgb = {v[4], v[5], v[6]},
                             .size = v[7],
                             .shape = v[LAMP_SHAPE],
                             .turn = v[LAMP_TURN],
                             .level = v[LAMP_LEVEL],
                             .seen = v[LAMP_SEEN],
                             .id = (uint32_t)v[LAMP_ID],
                             .next = -1};
}

static bool frame_ok(double frame)
{
    return frame == -1 || (frame >= 0 && frame < 1e9 && frame == floor(frame));
}

bool lamp_power_ok(double power, const double rgb[3])
{
    const double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));

    return power >= 0 && power <= LAMP_MAX_POWER && most <= LAMP_MAX_POWER &&
           power * most <= LAMP_MAX_POWER;
}

/* Returns NULL, or what is wrong with the values V of a row. */
static const char *check_row(const double *v)
{
    if (!frame_ok(v[0]))
        return "frame must be a whole number from 0, or *";
    if (fabs(v[1]) > 1e6 || fabs(v[2]) > 1e6)
        return "x and y must be within a million pixels";
    for (int c = 4; c < 7; c++)
        if (v[c] < 0)
            return "r, g and b must not be negative";
    if (!lamp_power_ok(v[3], v + 4))
        return "power, also times r, g or b, must be 0 to 1e30";
    if (!(v[LAMP_LEVEL] > 0 && v[LAMP_LEVEL] <= 1))
        return "level must be above 0 and up to 1";
    if (!(v[LAMP_SEEN] >= 0 && v[LAMP_SEEN] <= 1e6))
        return "seen must be 0 to a million pixels";
    if (!(v[LAMP_SHAPE] >= 0 && v[LAMP_SHAPE] <= 1))
        return "shape must be 0 to 1";
    return v[7] >= 0 && v[7] <= 1e6 ? NULL
                                    : "size must be 0 to a million pixels";
}

/* Reads LINE, "frame,x,y,power[,r,g,b[,size]]" or as COLUMNS say, into V.
 * Returns NULL, or what is wrong with it. */
static const char *parse_csv(char *line, const struct lamp_columns *columns,
                             double *v)
{
    char *comma = strchr(line, ',');
    int n;

    if (columns->n > 0) {
        const char *cause = lamp_columns_row(columns, line, v);

        return cause ? cause : check_row(v);
    }
    if (!comma)
        return "expected frame,x,y,power[,r,g,b[,size]]";
    *comma = '\0';
    if (strcmp(line, "*") == 0 || *line == '\0')
        v[0] = -1;
    else if (!tool_number(line, &v[0]))
        return "the frame is not a number";
    n = tool_numbers(comma + 1, v + 1, FIELDS - 1);
    return n == 3 || n == 6 || n == 7
               ? check_row(v)
               : "expected 4, 7 or 8 numbers separated by commas";
}

static char *skip(char *at)
{
    while (isspace((unsigned char)*at))
        at++;
    return at;
}

/* Reads one "key": value at *AT into V and moves *AT past it; sets its bit in
 * GIVEN. Returns NULL, or what is wrong with it. */
static const char *parse_member(char **at, double *v, unsigned *given)
{
    char *key = skip(*at), *end, *number;
    int field;

    if (*key++ != '"' || !(end = strchr(key, '"')))
        return "expected a \"key\"";
    *end = '\0';
    field = tool_word(key, names);
    if (field < 0)
        return "a key is none of frame x y power r g b size id";
    number = skip(end + 1);
    if (*number++ != ':')
        return "expected : after a key";
    number = skip(number);
    if (field == LAMP_ID && *number == '"' && (end = strchr(number + 1, '"'))) {
        *end = '\0';
        v[LAMP_ID] = lamp_id_of(number + 1);
        *at = end + 1;
    } else if (field == 0 && strncmp(number, "\"*\"", 3) == 0) {
        v[0] = -1;
        *at = number + 3;
    } else {
        v[field] = strtod(number, at);
        if (*at == number || !isfinite(v[field]))
            return "a value is not a number";
        if (field == LAMP_ID && (v[field] < 0 || v[field] > UINT32_MAX))
            return "id must be a text, or 0 to 4294967295";
    }
    *given |= 1u << field;
    return NULL;
}

/* Reads LINE, a flat JSON object, into V. Returns NULL, or what is wrong. */
static const char *parse_json(char *line, double *v)
{
    unsigned given = 0;
    char *at = line + 1; /* after the brace */

    for (;;) {
        const char *cause = parse_member(&at, v, &given);

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
    return (given & 0xe) == 0xe ? check_row(v) : "x, y and power are needed";
}

static bool is_heading(const char *line)
{
    return strncmp(line, "frame", 5) == 0;
}

enum glint_status lamp_list_add(struct lamp_list *list,
                                const struct lamp_row *row)
{
    if (list->n == list->room) {
        const int room = list->room ? 2 * list->room : 64;
        struct lamp_row *more = realloc(list->row, (size_t)room * sizeof *more);

        if (!more)
            return GLINT_E_MEMORY;
        list->row = more;
        list->room = room;
    }
    list->row[list->n++] = *row;
    return GLINT_OK;
}

static const char no_memory[] = "no memory";

/* Takes LINE, which may be a heading if it is the first one, into LIST. Returns
 * NULL, or what is wrong with it. */
static const char *take_line(struct lamp_list *list, char *line,
                             struct lamp_columns *columns, bool is_first)
{
    double v[LAMP_COLUMNS] = {-1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 0, 1};
    const char *cause;
    struct lamp_row row;

    if (is_first && is_heading(line))
        return lamp_columns_read(columns, line);
    cause = *line == '{' ? parse_json(line, v) : parse_csv(line, columns, v);
    if (cause)
        return cause;
    if (list->n == LAMP_LIST_MAX_ROWS)
        return "more than 1048576 lights";
    row = row_of(v);
    return lamp_list_add(list, &row) == GLINT_OK ? NULL : no_memory;
}

static enum glint_status take_lines(struct lamp_list *list,
                                    struct text_lines *lines,
                                    struct glint_error *error)
{
    struct lamp_columns columns = {.n = 0};
    enum glint_status status = GLINT_OK;
    char *line;

    while (status == GLINT_OK && (line = text_lines_next(lines))) {
        const char *const cause =
            take_line(list, line, &columns, lines->number == 1);

        if (cause)
            status = text_lines_fail(lines, error, cause);
        if (cause == no_memory)
            status = GLINT_E_MEMORY;
    }
    text_lines_close(lines);
    if (status != GLINT_OK)
        lamp_list_free(list);
    return status;
}

enum glint_status lamp_list_parse(struct lamp_list *list, const char *text,
                                  size_t bytes, const char *name,
                                  struct glint_error *error)
{
    struct text_lines lines;
    const enum glint_status status =
        text_lines_copy(&lines, name, text, bytes, error);

    *list = (struct lamp_list){NULL, 0, 0};
    return status == GLINT_OK ? take_lines(list, &lines, error) : status;
}

enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error)
{
    struct text_lines lines;
    const enum glint_status status =
        text_lines_open(&lines, path, 1 << 28, error);

    *list = (struct lamp_list){NULL, 0, 0};
    return status == GLINT_OK ? take_lines(list, &lines, error) : status;
}

void lamp_list_free(struct lamp_list *list)
{
    free(list->row);
    *list = (struct lamp_list){NULL, 0, 0};
}

/* Sets the extent of LAMP by R: a disc if its shape is 1, else an ellipse.
 * TANGENT is that of a pixel. */
static void set_shape(struct glint_lamp *lamp, const struct lamp_row *r,
                      double tangent)
{
    const double major = r->size * tangent / sqrt(1 + r->shape * r->shape);

    glint_area_set_round(lamp, r->size * tangent);
    if (r->shape == 1)
        return;
    lamp->axis[0] = major;
    lamp->axis[1] = r->shape * major;
    lamp->turn_deg = r->turn;
}

int lamp_list_frame(const struct lamp_list *list, int frame,
                    const struct glint_view *view, double focal_mm,
                    struct glint_lamp *lamps, double *level, double *seen_px,
                    int max)
{
    int n = 0;

    for (int i = 0; i < list->n && n < max; i++) {
        struct lamp_row r;

        if (!lamp_keys_at(list, i, frame, &r))
            continue;
        glint_view_to_angles(view, focal_mm, r.x, r.y, &lamps[n]);
        lamps[n].power = r.power;
        memcpy(lamps[n].rgb, r.rgb, sizeof r.rgb);
        set_shape(&lamps[n], &r, glint_view_pixel_tangent(view, focal_mm));
        if (level)
            level[n] = r.level;
        if (seen_px)
            seen_px[n] = r.seen;
        n++;
    }
    return n;
}
