/* SPDX-License-Identifier: MIT */
#include "options/timed_text.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "options/tool.h"
#include "posix/input.h"

/* max number of read() calls between two calls of
 * text_lines_reset_read_limit() */
enum { READINGS = 16 };

const char text_no_memory[] = "no memory";

static const char blanks[] = " \t\r\v\f";
static const char numerals[] = "0123456789+-.eE";

/* ----------------------------------------------------------------- sources */

enum glint_status text_lines_open_text(struct text_lines *lines,
                                       const char *name, const char *text,
                                       size_t bytes, struct glint_error *error)
{
    *lines = (struct text_lines){.name = name};
    if (bytes && memchr(text, '\0', bytes))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "not a text file");
    lines->mem = calloc(bytes + 1, 1);
    if (!lines->mem)
        return glint_error_report(error, GLINT_E_MEMORY, name, "%s",
                                  text_no_memory);
    if (bytes)
        memcpy(lines->mem, text, bytes);
    lines->rest = lines->mem;
    if (strncmp(lines->mem, "\xef\xbb\xbf", 3) == 0)
        lines->rest += 3; /* UTF-8 byte order mark, which some editors write */
    return GLINT_OK;
}

enum glint_status text_lines_open(struct text_lines *lines, const char *name,
                                  const char *text, size_t bytes,
                                  struct glint_error *error)
{
    enum glint_status status = GLINT_OK;
    uint8_t *data = NULL;

    *lines = (struct text_lines){.name = name};
    if (!text && bytes) {
        status = glint_input_read_whole_file(&data, &bytes, name, bytes, error);
        text = (const char *)data;
    }
    if (status == GLINT_OK)
        status = text_lines_open_text(lines, name, text, bytes, error);
    free(data);
    return status;
}

bool text_is_named_pipe(const char *path)
{
    struct stat st;

    return stat(path, &st) == 0 && S_ISFIFO(st.st_mode);
}

enum glint_status text_lines_open_pipe(struct text_lines *lines,
                                       const char *path,
                                       struct glint_error *error)
{
    const int fd = strcmp(path, "-") == 0
                       ? STDIN_FILENO
                       : open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);

    *lines = (struct text_lines){.name = path, .is_pipe = true, .fd = fd};
    return fd >= 0 ? GLINT_OK
                   : glint_error_report(error, GLINT_E_IO, path, "%s",
                                        strerror(errno));
}

void text_lines_reset_read_limit(struct text_lines *lines)
{
    lines->left = READINGS;
}

void text_lines_close(struct text_lines *lines)
{
    if (lines->is_pipe && lines->fd > STDIN_FILENO)
        close(lines->fd);
    free(lines->mem);
    *lines = (struct text_lines){.name = lines->name, .number = lines->number};
}

/* ------------------------------------------------------------------- lines */

/* Reads new data from the pipe. Returns false if none is available. */
static bool read_from_pipe(struct text_lines *l)
{
    struct pollfd there = {.fd = l->fd, .events = POLLIN};
    ssize_t n;

    if (l->left == 0 || poll(&there, 1, 0) <= 0)
        return false;
    l->left--;
    do
        n = read(l->fd, l->bytes, sizeof l->bytes);
    while (n < 0 && errno == EINTR);
    l->has_ended = n == 0 || (n < 0 && errno != EAGAIN);
    l->at = 0;
    l->n_bytes = n > 0 ? (size_t)n : 0;
    return n > 0;
}

static char *terminate_line(struct text_lines *l)
{
    l->text[l->n_text] = '\0';
    l->n_text = 0;
    l->is_long = l->is_cut;
    l->is_cut = false;
    l->number++;
    return l->text;
}

static char *read_next_pipe_line(struct text_lines *l)
{
    for (;;) {
        while (l->at < l->n_bytes) {
            const char c = l->bytes[l->at++];

            if (c == '\n')
                return terminate_line(l);
            if (l->n_text < TEXT_PIPE_BYTES - 1)
                l->text[l->n_text++] = c ? c : '?';
            else
                l->is_cut = true;
        }
        if (!read_from_pipe(l)) /* The last line may end without a line feed. */
            return l->has_ended && l->n_text ? terminate_line(l) : NULL;
    }
}

char *text_lines_read_untrimmed(struct text_lines *lines)
{
    char *const line = lines->rest, *end;

    if (lines->is_pipe)
        return read_next_pipe_line(lines);
    if (!line)
        return NULL;
    end = strchr(line, '\n');
    lines->rest = end ? end + 1 : NULL;
    lines->number++;
    if (end)
        *end = '\0';
    return line;
}

char *text_trim_blanks(char *text)
{
    char *end = text + strlen(text);

    text += strspn(text, blanks);
    while (end > text && strchr(blanks, end[-1]))
        *--end = '\0';
    return text;
}

char *text_lines_read_next(struct text_lines *lines)
{
    char *line;

    while ((line = text_lines_read_untrimmed(lines))) {
        line = text_trim_blanks(line);
        if (*line && *line != '#')
            return line;
    }
    return NULL;
}

enum glint_status text_lines_parse_each(struct text_lines *lines,
                                        text_take_fn *take, void *ctx,
                                        struct glint_error *error)
{
    enum glint_status status = GLINT_OK;
    char *line;

    while (status == GLINT_OK && (line = text_lines_read_next(lines))) {
        const char *const cause = take(ctx, lines, line);

        if (cause)
            status = text_lines_report_error(lines, error, cause);
        if (cause == text_no_memory)
            status = GLINT_E_MEMORY;
    }
    text_lines_close(lines);
    return status;
}

enum glint_status text_lines_report_error(const struct text_lines *lines,
                                          struct glint_error *error,
                                          const char *cause)
{
    char where[PATH_MAX + 16];

    snprintf(where, sizeof where, "%s:%d", lines->name, lines->number);
    return glint_error_report(error, GLINT_E_FORMAT, where, "%s", cause);
}

const char *text_lines_format_cause(struct text_lines *lines,
                                    const char *format, ...)
{
    va_list values;

    va_start(values, format);
    vsnprintf(lines->cause, sizeof lines->cause, format, values);
    va_end(values);
    return lines->cause;
}

/* ------------------------------------------------------------------ fields */

int text_split_fields(char *line, char **field, int max)
{
    int n = 0;

    for (char *end = line; end; n++) {
        char *const from = line;

        end = strchr(from, ',');
        if (end)
            *end = '\0';
        line = end ? end + 1 : NULL;
        if (n == max)
            return n + 1;
        field[n] = text_trim_blanks(from);
    }
    return n;
}

int text_find_column(const struct text_column *column, int n, const char *name)
{
    while (n > 0 && strcmp(column[n - 1].name, name) != 0)
        n--;
    return n - 1;
}

static char *skip_blanks(char *at)
{
    return at + strspn(at, blanks);
}

static const char *report_missing_column(struct text_lines *lines,
                                         const struct text_column *column,
                                         int n)
{
    int at = snprintf(lines->cause, sizeof lines->cause,
                      "unknown key; expected one of");

    for (int i = 0; i < n; i++)
        at += snprintf(lines->cause + at, sizeof lines->cause - (size_t)at,
                       " %s", column[i].name);
    return lines->cause;
}

const char *text_parse_json_object(struct text_lines *lines, char *line,
                                   const struct text_column *column, int n,
                                   char **field)
{
    /* AT is the position of the opening brace or of the comma before a key. */
    char *at = line, mark = ',';

    while (mark == ',') {
        char *key = skip_blanks(at + 1), *value, *end = NULL;
        int k;

        if (*key++ == '"')
            end = strchr(key, '"');
        if (!end)
            return "expected a \"key\"";
        *end = '\0';
        k = text_find_column(column, n, key);
        if (k < 0)
            return report_missing_column(lines, column, n);
        value = skip_blanks(end + 1);
        if (*value != ':')
            return "a colon is missing after a key";
        value = skip_blanks(value + 1);
        end = *value == '"' ? strchr(value + 1, '"') : NULL;
        at = end ? end + 1 : value + strspn(value, numerals);
        field[k] = value;
        if (at == value)
            return "a value is not a number";
        end = end ? end : at;
        at = skip_blanks(at);
        mark = *at;
        *end = '\0';
    }
    if (mark != '}')
        return "expected , or }";
    return *skip_blanks(at + 1) ? "text follows the closing brace" : NULL;
}

/* ------------------------------------------------------------------ values */

const char *text_parse_value(const struct text_column *column, const char *text,
                             const char *other, double *value)
{
    if (!tool_parse_number(text, value))
        return other;
    return *value >= column->low && *value <= column->high ? NULL
                                                           : column->range;
}

void *text_grow_array(void *rows, int n, size_t size)
{
    return n & (n - 1) ? rows : realloc(rows, 2 * ((size_t)n + 1) * size);
}
