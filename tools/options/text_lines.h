/* SPDX-License-Identifier: MIT
 *
 * text_lines.h - the lines of a text file that say something.
 *
 *     text_lines_open(&lines, path, most_bytes, &error);
 *     while ((line = text_lines_next(&lines)))
 *         if ((cause = take(line)))
 *             return text_lines_fail(&lines, &error, cause);
 *     text_lines_close(&lines);
 *
 * Empty lines and those that begin with # are passed over.
 */
#ifndef GLINT_TOOLS_OPTIONS_TEXT_LINES_H
#define GLINT_TOOLS_OPTIONS_TEXT_LINES_H

#include <stddef.h>

#include "glint/status.h"

struct text_lines {
    const char *name; /* of the file, for errors */
    int number;       /* of the last line, counted from 1 */
    char *mem, *rest; /* private */
};

/* Reads PATH, which must outlive LINES and may have MOST_BYTES. GLINT_E_IO;
 * GLINT_E_FORMAT: it holds a zero byte; GLINT_E_MEMORY. */
enum glint_status text_lines_open(struct text_lines *lines, const char *path,
                                  size_t most_bytes, struct glint_error *error);

/* Does as text_lines_open() with TEXT[BYTES], which is copied. */
enum glint_status text_lines_copy(struct text_lines *lines, const char *name,
                                  const char *text, size_t bytes,
                                  struct glint_error *error);

/* Returns the next line, without blanks around it, for the caller to change, or
 * NULL at the end. */
char *text_lines_next(struct text_lines *lines);

/* Sets ERROR to "FILE:LINE: CAUSE" and returns GLINT_E_FORMAT. */
enum glint_status text_lines_fail(const struct text_lines *lines,
                                  struct glint_error *error, const char *cause);

void text_lines_close(struct text_lines *lines);

/* Returns the next field of *REST, up to a comma, without blanks around it, and
 * moves *REST past it. Returns NULL if none is left. */
char *text_field(char **rest);

#endif
