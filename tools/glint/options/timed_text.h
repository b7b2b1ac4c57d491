/* SPDX-License-Identifier: MIT
 *
 * timed_text.h - text that describes frames, line by line: key frames, lists of
 * lamps, poses and lines of control.
 *
 *     text_lines_open(&lines, path, NULL, max_bytes, &error);
 *     status = text_lines_each(&lines, take, ctx, &error);
 *
 * or of a pipe, which is never waited for:
 *
 *     text_lines_pipe(&lines, path, &error);
 *     text_lines_turn(&lines);                             each picture
 *     while ((line = text_lines_next(&lines)))
 *         ...
 *     text_lines_close(&lines);
 */
#ifndef GLINT_TOOLS_OPTIONS_TIMED_TEXT_H
#define GLINT_TOOLS_OPTIONS_TIMED_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "posix/error.h"

enum {
    TEXT_MAX_FRAME = 1000000000,
    TEXT_PIPE_BYTES = 512 /* of a line of a pipe with its end */
};

struct text_lines {
    const char *name; /* of the file, for errors */
    int number;       /* of the last line, counted from 1 */
    bool is_pipe;
    bool is_long;    /* the last line of the pipe was longer, and is cut */
    char cause[200]; /* of text_lines_cause() */

    /* Private. */
    char *mem, *rest; /* of a file */
    int fd;           /* of a pipe, as what follows */
    char text[TEXT_PIPE_BYTES], bytes[4096];
    size_t n_text, at, n_bytes;
    bool is_cut, has_ended;
    int left; /* readings in this turn */
};

/* ------------------------------------------------------------------- lines */

/* Copies TEXT[BYTES]; of NULL it reads the file NAME, of up to BYTES, unless 0.
 * NAME must outlive LINES. GLINT_E_IO; GLINT_E_FORMAT: there is a zero byte;
 * GLINT_E_MEMORY. */
enum glint_status text_lines_open(struct text_lines *lines, const char *name,
                                  const char *text, size_t bytes,
                                  struct glint_error *error);

/* Returns whether PATH is a FIFO. */
bool text_is_pipe(const char *path);

/* Opens the FIFO PATH, or the standard input if PATH is -. A turn returns at
 * most 64 KiB. A zero byte becomes a ?. GLINT_E_IO. */
enum glint_status text_lines_pipe(struct text_lines *lines, const char *path,
                                  struct glint_error *error);
void text_lines_turn(struct text_lines *lines);

/* Returns the next line, which the caller may change, or NULL at the end of
 * the file or turn: as it is, or trimmed, without empty lines and those that
 * begin with #. */
char *text_lines_raw(struct text_lines *lines);
char *text_lines_next(struct text_lines *lines);

/* Calls TAKE with each line to the end or the first failure, and closes LINES.
 * TAKE returns NULL, the cause of the failure, or text_no_memory. ERROR is
 * "FILE:LINE: CAUSE". GLINT_E_FORMAT, GLINT_E_MEMORY. */
typedef const char *text_take_fn(void *ctx, struct text_lines *lines,
                                 char *line);
enum glint_status text_lines_each(struct text_lines *lines, text_take_fn *take,
                                  void *ctx, struct glint_error *error);
extern const char text_no_memory[];

/* Sets ERROR to "FILE:LINE: CAUSE" and returns GLINT_E_FORMAT. */
enum glint_status text_lines_fail(const struct text_lines *lines,
                                  struct glint_error *error, const char *cause);

/* Returns lines->cause after printing it. */
const char *text_lines_cause(struct text_lines *lines, const char *format, ...)
    GLINT_PRINTF(2, 3);

void text_lines_close(struct text_lines *lines);

/* ------------------------------------------------------------------ fields */

struct text_column {
    const char *name;
    double low, high;
    const char *range; /* the cause if a value is out of range */
};

/* Splits LINE at commas into FIELD[MAX], trimmed. Returns their number; above
 * MAX: there are more. */
int text_fields(char *line, char **field, int max);

/* Returns the index in COLUMN[N] of NAME, or -1. */
int text_column(const struct text_column *column, int n, const char *name);

/* Sets FIELD[N] to the values of LINE, a flat JSON object with names of COLUMN
 * as keys; a text keeps its first quote. Returns NULL or the cause of a
 * failure. */
const char *text_object(struct text_lines *lines, char *line,
                        const struct text_column *column, int n, char **field);

/* Sets VALUE to the number TEXT. Returns NULL, OTHER if it is not a number, or
 * the range of COLUMN. */
const char *text_value(const struct text_column *column, const char *text,
                       const char *other, double *value);

/* ------------------------------------------------------------------ values */

/* Returns ROWS, of N rows of SIZE bytes, with room for one more; NULL: no
 * memory, and ROWS is as it was. */
void *text_grow(void *rows, int n, size_t size);

#endif
