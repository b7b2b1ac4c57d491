/* SPDX-License-Identifier: MIT
 *
 * timed_text.h - reads text files with one line per event of a video, line by
 * line: key frames, lists of lamps, poses and control lines.
 *
 *     text_lines_open(&lines, path, NULL, max_bytes, &error);
 *     status = text_lines_parse_each(&lines, take, ctx, &error);
 *
 * or from a pipe, without waiting for data:
 *
 *     text_lines_open_pipe(&lines, path, &error);
 *     text_lines_reset_read_limit(&lines);         each picture
 *     while ((line = text_lines_read_next(&lines)))
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
    /* max bytes of a line of a pipe, with terminator */
    TEXT_PIPE_BYTES = 512
};

struct text_lines {
    const char *name; /* name of the file, for errors */
    int number;       /* number of the last line, counted from 1 */
    bool is_pipe;
    /* whether the last line of the pipe was truncated */
    bool is_long;
    char cause[200]; /* text of text_lines_format_cause() */

    /* Private. */
    char *mem, *rest; /* contents of a file, and the part not yet read */
    int fd; /* descriptor of the pipe; members from here on are for pipes */
    char text[TEXT_PIPE_BYTES], bytes[4096];
    size_t n_text, at, n_bytes;
    bool is_cut, has_ended;
    int left; /* number of read() calls left until the limit is reset */
};

/* ------------------------------------------------------------------- lines */

/* Open a copy of TEXT[BYTES]. If TEXT is NULL, text_lines_open() opens the file
 * NAME, which must have at most BYTES bytes (0: any size). NAME must outlive
 * LINES. Errors: GLINT_E_IO, GLINT_E_MEMORY, and GLINT_E_FORMAT if the text
 * contains a zero byte. */
enum glint_status text_lines_open_text(struct text_lines *lines,
                                       const char *name, const char *text,
                                       size_t bytes, struct glint_error *error);
enum glint_status text_lines_open(struct text_lines *lines, const char *name,
                                  const char *text, size_t bytes,
                                  struct glint_error *error);

/* Returns whether PATH is a FIFO. */
bool text_is_named_pipe(const char *path);

/* Opens the FIFO PATH, or standard input if PATH is "-". At most 64 KiB are
 * read until the next text_lines_reset_read_limit(), which is called once per
 * picture. Zero bytes become '?'. Error: GLINT_E_IO. */
enum glint_status text_lines_open_pipe(struct text_lines *lines,
                                       const char *path,
                                       struct glint_error *error);
void text_lines_reset_read_limit(struct text_lines *lines);

/* Return the next line, which the caller may change. Return NULL at the end of
 * the file or if a pipe has no more lines for now. text_lines_read_untrimmed()
 * returns every line unchanged. text_lines_read_next() trims lines, and skips
 * empty lines and those that begin with '#'. */
char *text_lines_read_untrimmed(struct text_lines *lines);
char *text_lines_read_next(struct text_lines *lines);

/* Calls TAKE with each line until the end or the first failure, then closes
 * LINES. TAKE returns NULL on success, else a message, which may be
 * text_no_memory. On failure sets ERROR to "FILE:LINE: MESSAGE" and returns
 * GLINT_E_FORMAT or GLINT_E_MEMORY. */
typedef const char *text_take_fn(void *ctx, struct text_lines *lines,
                                 char *line);
enum glint_status text_lines_parse_each(struct text_lines *lines,
                                        text_take_fn *take, void *ctx,
                                        struct glint_error *error);
extern const char text_no_memory[];

/* Sets ERROR to "FILE:LINE: CAUSE" and returns GLINT_E_FORMAT. */
enum glint_status text_lines_report_error(const struct text_lines *lines,
                                          struct glint_error *error,
                                          const char *cause);

/* Formats a message into lines->cause and returns lines->cause. */
const char *text_lines_format_cause(struct text_lines *lines,
                                    const char *format, ...) GLINT_PRINTF(2, 3);

void text_lines_close(struct text_lines *lines);

/* Returns TEXT without the blanks around it; changes TEXT. */
char *text_trim_blanks(char *text);

/* ------------------------------------------------------------------ fields */

struct text_column {
    const char *name;
    double low, high;
    const char *range; /* error message for values out of range */
};

/* Splits LINE at commas into FIELD[MAX] without blanks around the fields.
 * Returns the number of fields, or MAX + 1 if there are more. */
int text_split_fields(char *line, char **field, int max);

/* Returns the index in COLUMN[N] of the column NAME, or -1 if there is none. */
int text_find_column(const struct text_column *column, int n, const char *name);

/* Parses LINE, a flat JSON object with keys that are names in COLUMN[N]. Sets
 * FIELD[K] to the value of column K; a string keeps its opening quote. Returns
 * NULL on success, or an error message. */
const char *text_parse_json_object(struct text_lines *lines, char *line,
                                   const struct text_column *column, int n,
                                   char **field);

/* ------------------------------------------------------------------ values */

/* Sets VALUE to the number TEXT. Returns NULL on success, else an error
 * message: OTHER if TEXT is not a number, column->range if the number is out of
 * range. */
const char *text_parse_value(const struct text_column *column, const char *text,
                             const char *other, double *value);

/* Reallocates ROWS, N rows of SIZE bytes, so that one more row fits. Must be
 * called for each row. Returns the new address, or NULL, with ROWS unchanged,
 * if there is no memory. */
void *text_grow_array(void *rows, int n, size_t size);

#endif
