/* SPDX-License-Identifier: MIT */
#include "control/controls.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_BYTES = 1 << 28 };

static void print_where(const struct controls *in, int number, char *where)
{
    const char *const name =
        strcmp(in->lines.name, "-") == 0 ? "control" : in->lines.name;

    snprintf(where, CONTROL_WHERE, number > 0 ? "%.140s:%d" : "%.140s", name,
             number);
}

/* Takes TEXT, which was read last, into LINE. */
static enum glint_status take(const struct controls *in, const char *text,
                              struct control_line *line,
                              struct glint_error *error)
{
    char where[CONTROL_WHERE];
    enum glint_status status;

    print_where(in, in->lines.number, where);
    status = control_parse(text, where, line, error);
    line->number = in->lines.number;
    return status;
}

/* Reads all of the file. */
static enum glint_status read_all(struct controls *in,
                                  struct glint_error *error)
{
    enum glint_status status = GLINT_OK;
    struct control_line line;
    const char *text;

    while (status == GLINT_OK && (text = text_lines_raw(&in->lines))) {
        struct control_line *const more =
            text_grow(in->row, in->n, sizeof *more);

        if (!more)
            return glint_error_report(error, GLINT_E_MEMORY, in->lines.name,
                                      "%s", text_no_memory);
        in->row = more;
        status = take(in, text, &line, error);
        if (status == GLINT_OK && line.verb != CONTROL_NONE)
            more[in->n++] = line;
    }
    return status;
}

enum glint_status controls_open(struct controls *input, const char *path,
                                bool is_live, struct glint_error *error)
{
    struct controls *const in = input;
    const bool is_input = strcmp(path, "-") == 0;
    enum glint_status status;

    *in = (struct controls){
        .is_open = true, .lines = {.name = path}, .read_at = -1};
    if (is_input && is_live && isatty(STDIN_FILENO)) {
        in->is_keys = keyboard_open(&in->keys, STDIN_FILENO) == GLINT_OK;
        return in->is_keys ? GLINT_OK
                           : glint_error_report(error, GLINT_E_IO, path, "%s",
                                                strerror(errno));
    }
    if (is_live && (is_input || text_is_pipe(path)))
        return text_lines_pipe(&in->lines, path, error);
    status = text_lines_open(&in->lines, path, NULL, MAX_BYTES, error);
    if (status == GLINT_OK)
        status = read_all(in, error);
    text_lines_close(&in->lines);
    if (status != GLINT_OK)
        controls_close(in);
    return status;
}

void controls_close(struct controls *input)
{
    text_lines_close(&input->lines);
    if (input->is_open && input->is_keys)
        keyboard_close(&input->keys);
    free(input->row);
    *input = (struct controls){.is_open = false};
}

/* -------------------------------------------------------------------- lines */

/* Reads the next command of the pipe into in->ahead; returns false if none has
 * come. */
static bool read_ahead(struct controls *in)
{
    const char *text;

    while (in->lines.is_pipe && (text = text_lines_raw(&in->lines))) {
        struct glint_error error;

        if (take(in, text, &in->ahead, &error) != GLINT_OK)
            controls_refuse(in, &error);
        else if (in->ahead.verb != CONTROL_NONE)
            return true;
    }
    return false;
}

const struct control_line *controls_next(struct controls *input, int picture)
{
    struct controls *const in = input;

    if (!in->is_open)
        return NULL;
    if (in->is_keys)
        return keyboard_next(&in->keys, &in->ahead) ? &in->ahead : NULL;
    if (in->next < in->n)
        return in->row[in->next].frame > picture ? NULL : &in->row[in->next++];
    if (in->read_at != picture)
        text_lines_turn(&in->lines);
    in->read_at = picture;
    in->has_ahead = in->has_ahead || read_ahead(in);
    if (!in->has_ahead || in->ahead.frame > picture)
        return NULL;
    in->has_ahead = false;
    return &in->ahead;
}

const struct control_line *controls_row(const struct controls *input, int i)
{
    return i < input->n ? &input->row[i] : NULL;
}

void controls_where(const struct controls *input, int i, char *where)
{
    const int row = i >= 0 ? i : input->next - 1;

    print_where(input,
                input->is_keys ? 0
                : row >= 0     ? input->row[row].number
                               : input->ahead.number,
                where);
}

void controls_refuse(struct controls *input, const struct glint_error *error)
{
    input->n_bad++;
    input->bad = *error;
}
