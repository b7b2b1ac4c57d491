/* SPDX-License-Identifier: MIT */
#include "lamp_files/lamp_list.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/area.h"
#include "glint/options.h"
#include "lamp_files/lamp_keys.h"
#include "options/timed_text.h"

enum {
    FRAME,
    X,
    Y,
    POWER,
    RED,
    GREEN,
    BLUE,
    SIZE,
    ID,
    /* number of keys of a JSON row; a plain list has the columns above ID */
    KEYS,
    SHAPE = KEYS,
    TURN,
    LEVEL,
    SEEN,
    COLUMNS
};

#define FAR      "x and y must be within a million pixels"
#define NEGATIVE "r, g and b must not be negative"
#define POWERS   "power, also times r, g or b, must be 0 to 1e30"

static const struct text_column columns[COLUMNS] = {
    {"frame", 0, TEXT_MAX_FRAME - 1,
     "frame must be a whole number from 0 to 999999999, or *"},
    {"x", -1e6, 1e6, FAR},
    {"y", -1e6, 1e6, FAR},
    {"power", 0, GLINT_MAX_LAMP_POWER, POWERS},
    {"r", 0, DBL_MAX, NEGATIVE},
    {"g", 0, DBL_MAX, NEGATIVE},
    {"b", 0, DBL_MAX, NEGATIVE},
    {"size", 0, 1e6, "size must be 0 to a million pixels"},
    {"id", 0, UINT32_MAX, "id must be a text, or 0 to 4294967295"},
    {"shape", 0, 1, "shape must be 0 to 1"},
    {"turn", -DBL_MAX, DBL_MAX, ""},
    {"level", DBL_MIN, 1, "level must be above 0 and up to 1"},
    {"seen", 0, 1e6, "seen must be 0 to a million pixels"},
};

static const char plain[] = "expected 4, 7 or 8 numbers separated by commas: "
                            "frame,x,y,power[,r,g,b[,size]]";

/* Parser state of a lamp list */
struct reading {
    struct lamp_list *list;
    /* index in COLUMNS of each field of a row; n is 0 in a plain list, which
     * has no "id" in its heading */
    int n, column[COLUMNS];
};

static struct lamp_row make_lamp_row(const double *v)
{
    return (struct lamp_row){.frame = (int)v[FRAME],
                             .x = v[X],
                             .y = v[Y],
                             .power = v[POWER],
                             .rgb = {v[RED], v[GREEN], v[BLUE]},
                             .size = v[SIZE],
                             .shape = v[SHAPE],
                             .turn = v[TURN],
                             .level = v[LEVEL],
                             .seen = v[SEEN],
                             .id = (uint32_t)v[ID],
                             .next = -1};
}

/* Parses the fields that are not NULL into V, which must contain the defaults.
 * IS_OBJECT: fields are JSON values. Returns NULL or an error message: OTHER
 * for a field that is not a number. */
static const char *parse_row_fields(char *const field[COLUMNS], bool is_object,
                                    const char *other, double *v)
{
    const char *cause = NULL;

    for (int k = 0; k < COLUMNS && !cause; k++) {
        const char *const text = field[k];
        const bool is_text = text && (!is_object || *text == '"');

        if (text && k == ID && is_text)
            v[k] = *text ? lamp_hash_id(text + is_object) : 0;
        else if (text && k == FRAME && is_text &&
                 (strcmp(text + is_object, "*") == 0 || !*text))
            v[k] = -1;
        else if (text)
            cause = text_parse_value(&columns[k], text,
                                     k == FRAME && other == plain
                                         ? "the frame is not a number"
                                         : other,
                                     &v[k]);
    }
    if (cause)
        return cause;
    if (v[FRAME] != floor(v[FRAME]))
        return columns[FRAME].range;
    return glint_lamp_power_is_valid(v[POWER], v + RED) ? NULL : POWERS;
}

/* Parses LINE, "frame,x,y,power[,r,g,b[,size]]" or the columns named by the
 * heading. */
static const char *parse_lamp_row(const struct reading *r, char *line,
                                  double *v)
{
    char *row[COLUMNS], *field[COLUMNS] = {NULL};
    const int n = text_split_fields(line, row, r->n ? r->n : ID);

    if (r->n ? n != r->n : n != 4 && n != 7 && n != 8)
        return r->n     ? "expected as many values as the heading has names"
               : n == 1 ? "expected frame,x,y,power[,r,g,b[,size]]"
                        : plain;
    for (int i = 0; i < n; i++)
        field[r->n ? r->column[i] : i] = row[i];
    return parse_row_fields(
        field, false,
        r->n ? "expected numbers, as many as the heading has names" : plain, v);
}

static const char *parse_lamp_object(struct text_lines *lines, char *line,
                                     double *v)
{
    char *field[COLUMNS] = {NULL};
    const char *const cause =
        text_parse_json_object(lines, line, columns, KEYS, field);

    if (cause)
        return cause;
    if (!field[X] || !field[Y] || !field[POWER])
        return "x, y and power are needed";
    return parse_row_fields(field, true, "a value is not a number", v);
}

/* Sets the columns from LINE, a heading, if the heading contains "id". Returns
 * NULL or an error message. */
static const char *parse_column_heading(struct reading *r, char *line)
{
    char *name[COLUMNS];
    const int n = text_split_fields(line, name, COLUMNS);
    unsigned seen = 0;

    for (int i = 0; i < n && i < COLUMNS; i++) {
        r->column[i] = text_find_column(columns, COLUMNS, name[i]);
        seen |= 1u << (r->column[i] < 0 ? COLUMNS : r->column[i]);
    }
    if (!(seen >> ID & 1))
        return NULL;
    if (seen >> COLUMNS & 1)
        return "a column is unknown; expected frame x y power r g b size id "
               "shape turn level seen";
    r->n = n;
    return (seen & 0xf) == 0xf && n <= COLUMNS
               ? NULL
               : "columns frame, x, y and power are needed, each once";
}

enum glint_status lamp_list_add(struct lamp_list *list,
                                const struct lamp_row *row)
{
    struct lamp_row *const more =
        text_grow_array(list->row, list->n, sizeof *more);

    if (!more)
        return GLINT_E_MEMORY;
    list->row = more;
    more[list->n++] = *row;
    return GLINT_OK;
}

static const char *parse_lamp_line(void *ctx, struct text_lines *lines,
                                   char *line)
{
    double v[COLUMNS] = {-1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 0, 1};
    struct reading *const r = ctx;
    const char *cause;
    struct lamp_row row;

    if (lines->number == 1 && strncmp(line, "frame", 5) == 0)
        return parse_column_heading(r, line);
    cause = *line == '{' ? parse_lamp_object(lines, line, v)
                         : parse_lamp_row(r, line, v);
    if (cause)
        return cause;
    if (r->list->n == LAMP_LIST_MAX_ROWS)
        return "more than 1048576 lights";
    row = make_lamp_row(v);
    return lamp_list_add(r->list, &row) == GLINT_OK ? NULL : text_no_memory;
}

enum glint_status lamp_list_parse(struct lamp_list *list, const char *text,
                                  size_t bytes, const char *name,
                                  struct glint_error *error)
{
    struct reading r = {.list = list};
    struct text_lines lines;
    enum glint_status status =
        text_lines_open(&lines, name, text, bytes, error);

    *list = (struct lamp_list){NULL, 0};
    if (status == GLINT_OK)
        status = text_lines_parse_each(&lines, parse_lamp_line, &r, error);
    if (status != GLINT_OK)
        lamp_list_free(list);
    return status;
}

enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error)
{
    return lamp_list_parse(list, NULL, 1 << 28, path, error);
}

void lamp_list_free(struct lamp_list *list)
{
    free(list->row);
    *list = (struct lamp_list){NULL, 0};
}

/* Sets the extent of LAMP from R: a disc if R's shape is 1, else an ellipse.
 * TANGENT is the tangent of a pixel's angle. */
static void set_lamp_shape(struct glint_lamp *lamp, const struct lamp_row *r,
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

int lamp_list_get_frame(const struct lamp_list *list, int frame,
                        const struct glint_view *view, double focal_mm,
                        struct glint_engine_lamp *lamps, int max)
{
    uint32_t largest = 0;
    int n = 0;

    for (int i = 0; i < list->n; i++)
        if (list->row[i].id < LAMP_ID_TEXT && list->row[i].id > largest)
            largest = list->row[i].id;
    for (int i = 0; i < list->n && n < max; i++) {
        struct glint_lamp lamp = {.power = 0};
        struct lamp_row r;

        if (!lamp_keys_interpolate_at(list, i, frame, &r))
            continue;
        glint_view_to_angles(view, focal_mm, r.x, r.y, &lamp);
        lamp.power = r.power;
        memcpy(lamp.rgb, r.rgb, sizeof r.rgb);
        set_lamp_shape(&lamp, &r, glint_view_pixel_tangent(view, focal_mm));
        lamps[n] = glint_engine_lamp_of(
            &lamp, r.id ? r.id : largest + 1 + (uint32_t)n);
        lamps[n].level = r.level;
        lamps[n].seen_px = r.seen;
        n++;
    }
    return n;
}
