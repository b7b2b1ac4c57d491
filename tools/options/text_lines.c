/* SPDX-License-Identifier: MIT */
#include "options/text_lines.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "posix/error.h"
#include "posix/input.h"

static const char blanks[] = " \t\r\v\f";

enum glint_status text_lines_copy(struct text_lines *lines, const char *name,
                                  const char *text, size_t bytes,
                                  struct glint_error *error)
{
    *lines = (struct text_lines){.name = name};
    if (bytes && memchr(text, '\0', bytes))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "not a text file");
    lines->mem = calloc(bytes + 1, 1);
    if (!lines->mem)
        return glint_error_report(error, GLINT_E_MEMORY, name, "no memory");
    if (bytes)
        memcpy(lines->mem, text, bytes);
    lines->rest = lines->mem;
    return GLINT_OK;
}

enum glint_status text_lines_open(struct text_lines *lines, const char *path,
                                  size_t most_bytes, struct glint_error *error)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    enum glint_status status =
        glint_input_slurp(&data, &bytes, path, most_bytes, error);

    *lines = (struct text_lines){.name = path};
    if (status == GLINT_OK)
        status = text_lines_copy(lines, path, (const char *)data, bytes, error);
    free(data);
    return status;
}

/* Returns TEXT without the blanks around it, which it cuts off. */
static char *trim(char *text)
{
    char *end = text + strlen(text);

    text += strspn(text, blanks);
    while (end > text && strchr(blanks, end[-1]))
        *--end = '\0';
    return text;
}

char *text_lines_next(struct text_lines *lines)
{
    while (lines->rest) {
        char *line = lines->rest, *const end = strchr(line, '\n');

        lines->rest = end ? end + 1 : NULL;
        lines->number++;
        if (end)
            *end = '\0';
        line = trim(line);
        if (*line && *line != '#')
            return line;
    }
    return NULL;
}

enum glint_status text_lines_fail(const struct text_lines *lines,
                                  struct glint_error *error, const char *cause)
{
    char where[sizeof error->text];

    snprintf(where, sizeof where, "%s:%d", lines->name, lines->number);
    return glint_error_report(error, GLINT_E_FORMAT, where, "%s", cause);
}

void text_lines_close(struct text_lines *lines)
{
    free(lines->mem);
    lines->mem = lines->rest = NULL;
}

char *text_field(char **rest)
{
    char *field = *rest, *end;

    if (!field)
        return NULL;
    end = strchr(field, ',');
    *rest = end ? end + 1 : NULL;
    if (end)
        *end = '\0';
    return trim(field);
}
