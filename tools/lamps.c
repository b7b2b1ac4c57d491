/* SPDX-License-Identifier: MIT */
#include "lamps.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "posix/error.h"
#include "posix/input.h"
#include "tool.h"

enum { FIELDS = 8 };

static const char *const names[FIELDS + 1] = {
    "frame", "x", "y", "power", "r", "g", "b", "size", NULL};

static struct lamp_row row_of(const double *v)
{
    return (struct lamp_row){(int)v[0],          v[1], v[2], v[3],
                             {v[4], v[5], v[6]}, v[7]};
}

static bool frame_ok(double frame)
{
    return frame == -1 || (frame >= 0 && frame < 1e9 && frame == floor(frame));
}

/* NULL, or what is wrong with the values of a row. */
static const char *check_row(const double *v)
{
    if (!frame_ok(v[0]))
        return "frame must be a whole number from 0, or *";
    if (fabs(v[1]) > 1e6 || fabs(v[2]) > 1e6)
        return "x and y must be within a million pixels";
    if (v[3] < 0 || v[3] > 1e30)
        return "power must be 0 to 1e30";
    for (int c = 4; c < 7; c++)
        if (v[c] < 0)
            return "r, g and b must not be negative";
    return v[7] < 0 ? "size must not be negative" : NULL;
}

/* "frame,x,y,power[,r,g,b[,size]]" */
static const char *parse_csv(char *line, double *v)
{
    char *comma = strchr(line, ',');
    int n;

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

/* One "key": number; *AT moves behind it. */
static const char *parse_member(char **at, double *v, unsigned *given)
{
    char *key = skip(*at), *end, *number;
    int field;

    if (*key++ != '"' || !(end = strchr(key, '"')))
        return "expected a \"key\"";
    *end = '\0';
    field = tool_word(key, names);
    if (field < 0)
        return "a key is none of frame x y power r g b size";
    number = skip(end + 1);
    if (*number++ != ':')
        return "expected : after a key";
    number = skip(number);
    if (field == 0 && strncmp(number, "\"*\"", 3) == 0) {
        v[0] = -1;
        *at = number + 3;
    } else {
        v[field] = strtod(number, at);
        if (*at == number || !isfinite(v[field]))
            return "a value is not a number";
    }
    *given |= 1u << field;
    return NULL;
}

/* A flat object of numbers. */
static const char *parse_json(char *line, double *v)
{
    unsigned given = 0;
    char *at = line + 1; /* behind the brace */

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

static enum glint_status add_row(struct lamp_list *list, int *room,
                                 const double *v)
{
    struct lamp_row *more;

    if (list->n == *room) {
        *room = *room ? 2 * *room : 64;
        more = realloc(list->row, (size_t)*room * sizeof *more);
        if (!more)
            return GLINT_E_MEMORY;
        list->row = more;
    }
    list->row[list->n++] = row_of(v);
    return GLINT_OK;
}

static enum glint_status parse_text(struct lamp_list *list, char *text,
                                    const char *path, struct glint_error *error)
{
    int number = 1, room = 0;

    for (char *next; text; text = next, number++) {
        double v[FIELDS] = {-1, 0, 0, 1, 1, 1, 1, 0};
        const char *cause;
        char *line;

        next = strchr(text, '\n');
        if (next)
            *next++ = '\0';
        line = skip(text);
        for (size_t n = strlen(line); n && isspace((unsigned char)line[n - 1]);)
            line[--n] = '\0';
        if (!*line || *line == '#' || (number == 1 && is_heading(line)))
            continue;
        cause = *line == '{' ? parse_json(line, v) : parse_csv(line, v);
        if (cause)
            return glint_error_report(error, GLINT_E_FORMAT, path, "%d: %s",
                                      number, cause);
        if (list->n == LAMP_LIST_MAX_ROWS)
            return glint_error_report(error, GLINT_E_FORMAT, path,
                                      "%d: more than %d lights", number,
                                      LAMP_LIST_MAX_ROWS);
        if (add_row(list, &room, v) != GLINT_OK)
            return glint_error_report(error, GLINT_E_MEMORY, path,
                                      "%d: no memory", number);
    }
    return GLINT_OK;
}

enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    char *text;
    enum glint_status status =
        glint_input_slurp(&data, &bytes, path, 1 << 28, error);

    *list = (struct lamp_list){NULL, 0};
    if (status != GLINT_OK)
        return status;
    if (memchr(data, '\0', bytes)) {
        free(data);
        return glint_error_report(error, GLINT_E_FORMAT, path,
                                  "not a text file");
    }
    text = realloc(data, bytes + 1);
    if (!text) {
        free(data);
        return glint_error_report(error, GLINT_E_MEMORY, path, "no memory");
    }
    text[bytes] = '\0';
    status = parse_text(list, text, path, error);
    free(text);
    if (status != GLINT_OK)
        lamp_list_free(list);
    return status;
}

void lamp_list_free(struct lamp_list *list)
{
    free(list->row);
    *list = (struct lamp_list){NULL, 0};
}

int lamp_list_frame(const struct lamp_list *list, int frame,
                    const struct glint_view *view, double focal_mm,
                    struct glint_lamp *lamps, int max)
{
    int n = 0;

    for (int i = 0; i < list->n && n < max; i++) {
        const struct lamp_row *r = &list->row[i];

        if (r->frame != -1 && r->frame != frame)
            continue;
        glint_view_to_angles(view, focal_mm, r->x, r->y, &lamps[n]);
        lamps[n].power = r->power;
        memcpy(lamps[n].rgb, r->rgb, sizeof r->rgb);
        n++;
    }
    return n;
}

/* ------------------------------------------------------------------- finder */

enum glint_status lamp_finder_open(struct lamp_finder *finder,
                                   const struct glint_lights_config *cfg)
{
    const size_t bytes = glint_lights_bytes(cfg);
    enum glint_status status;

    finder->cfg = *cfg;
    finder->mem = NULL;
    if (bytes == 0)
        return GLINT_E_ARGUMENT;
    if (posix_memalign(&finder->mem, 64, bytes) != 0)
        return GLINT_E_MEMORY;
    status = glint_lights_init(&finder->lights, cfg, finder->mem, bytes);
    if (status != GLINT_OK)
        lamp_finder_close(finder);
    return status;
}

void lamp_finder_close(struct lamp_finder *finder)
{
    free(finder->mem);
    finder->mem = NULL;
}

/* Clipped pixels count for what they would be without clipping. */
static double power_of(const struct lamp_finder *f,
                       const struct glint_spot *spot)
{
    return (double)spot->flux_q16 / 65536 +
           spot->n_clipped * (exp2(f->headroom_ev) - 1);
}

int lamp_finder_frame(struct lamp_finder *finder,
                      const struct glint_image *image,
                      const struct glint_view *view, double focal_mm,
                      struct glint_lamp *lamps)
{
    struct glint_spot spots[LAMP_FINDER_MAX];
    const int n = glint_lights_find(finder->lights, image, spots, finder->max);

    for (int i = 0; i < n; i++) {
        glint_view_to_angles(view, focal_mm, spots[i].x_q8 / 256.0,
                             spots[i].y_q8 / 256.0, &lamps[i]);
        lamps[i].power = power_of(finder, &spots[i]);
        for (int c = 0; c < 3; c++)
            lamps[i].rgb[c] = spots[i].rgb_q15[c] / 32768.0;
    }
    return n;
}
