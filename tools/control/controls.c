/* SPDX-License-Identifier: MIT */
#include "control/controls.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_LINES = 1 << 20 };

static void say_where(const struct controls *in, int number, char *where)
{
    const char *const name = strcmp(in->name, "-") == 0 ? "control" : in->name;

    if (number > 0)
        snprintf(where, CONTROL_WHERE, "%.140s:%d", name, number);
    else
        snprintf(where, CONTROL_WHERE, "%.140s", name);
}

/* Takes the line TEXT, which the pipe read last, into LINE. */
static enum glint_status take(const struct controls *in, const char *text,
                              struct control_line *line,
                              struct glint_error *error)
{
    char where[CONTROL_WHERE];

    say_where(in, in->pipe.number, where);
    return control_parse(text, where, line, error);
}

/* -------------------------------------------------------------------- files */

static enum glint_status add(struct controls *in,
                             const struct control_line *line)
{
    if (in->n == MOST_LINES)
        return GLINT_E_MEMORY;
    if (in->n == in->room) {
        const size_t room = in->room ? 2 * (size_t)in->room : 64;
        void *const row = realloc(in->row, room * sizeof *in->row);
        void *const number =
            row ? realloc(in->number, room * sizeof *in->number) : NULL;

        if (row)
            in->row = row;
        if (number)
            in->number = number;
        if (!row || !number)
            return GLINT_E_MEMORY;
        in->room = (int)room;
    }
    in->row[in->n] = *line;
    in->number[in->n++] = in->pipe.number;
    return GLINT_OK;
}

/* Reads all of the file. */
static enum glint_status read_all(struct controls *in,
                                  struct glint_error *error)
{
    enum glint_status status = GLINT_OK;

    in->pipe.waits = true;
    while (status == GLINT_OK && !in->pipe.has_ended) {
        const char *text;

        line_pipe_turn(&in->pipe);
        while (status == GLINT_OK && (text = line_pipe_next(&in->pipe))) {
            struct control_line line;

            status = take(in, text, &line, error);
            if (status == GLINT_OK && line.verb != CONTROL_NONE)
                status = add(in, &line);
        }
    }
    return status == GLINT_E_MEMORY
               ? glint_error_report(error, status, in->name, "no memory")
               : status;
}

static void close_pipe(struct controls *in)
{
    if (in->pipe.fd > STDIN_FILENO)
        close(in->pipe.fd);
    in->pipe.fd = -1;
}

enum glint_status controls_open(struct controls *input, const char *path,
                                bool is_live, struct glint_error *error)
{
    struct controls *const in = input;
    const bool is_input = strcmp(path, "-") == 0;
    enum glint_status status;
    struct stat st;
    int fd = STDIN_FILENO;
    bool comes;

    *in = (struct controls){.is_open = true, .name = path, .read_at = -1};
    line_pipe_init(&in->pipe, -1);
    comes =
        is_live && (is_input || (stat(path, &st) == 0 && S_ISFIFO(st.st_mode)));
    if (is_input && isatty(fd) && comes) {
        in->is_keys = keyboard_open(&in->keys, fd) == GLINT_OK;
        return in->is_keys ? GLINT_OK
                           : glint_error_report(error, GLINT_E_IO, path, "%s",
                                                strerror(errno));
    }
    if (!is_input)
        fd = open(path, (comes ? O_NONBLOCK : 0) | O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return glint_error_report(error, GLINT_E_IO, path, "%s",
                                  strerror(errno));
    line_pipe_init(&in->pipe, fd);
    if (comes)
        return GLINT_OK;
    status = read_all(in, error);
    close_pipe(in);
    if (status != GLINT_OK)
        controls_close(in);
    return status;
}

void controls_close(struct controls *input)
{
    if (input->is_open) {
        close_pipe(input);
        if (input->is_keys)
            keyboard_close(&input->keys);
    }
    free(input->row);
    free(input->number);
    *input = (struct controls){.is_open = false};
}

/* -------------------------------------------------------------------- lines */

/* Reads the next line of the pipe that says something into in->ahead; returns
 * false if none has come. */
static bool read_ahead(struct controls *in)
{
    const char *text;

    while (in->pipe.fd >= 0 && (text = line_pipe_next(&in->pipe))) {
        struct glint_error error;

        in->ahead_number = in->pipe.number;
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
        line_pipe_turn(&in->pipe);
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

    say_where(input,
              input->is_keys ? 0
              : row >= 0     ? input->number[row]
                             : input->ahead_number,
              where);
}

void controls_refuse(struct controls *input, const struct glint_error *error)
{
    input->n_bad++;
    input->bad = *error;
}
