/* SPDX-License-Identifier: MIT
 *
 * Splits a text, which may contain any bytes, into lines, words and numbers.
 *
 *     glint_text_open(&text, data, bytes, "x.lens", error);
 *     while (glint_text_next_line(&text))
 *         while ((word = glint_text_next_word(&text)).length)
 *             ...
 *
 * glint_text_open() checks every byte, so that the other functions cannot fail:
 * lines of at most GLINT_LINE_BYTES, no control characters except tab, newline
 * and the return of a CRLF, and well-formed UTF-8. Spaces and tabs separate
 * words; a # at the start of a word begins a comment. Each word has its
 * position, for which glint_text_set_error() writes "FILE:LINE:COLUMN: cause".
 *
 * Numbers do not depend on the locale and are rounded to the nearest double.
 */
#ifndef GLINT_BAKE_TABLE_TEXT_H
#define GLINT_BAKE_TABLE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/status.h"

#define GLINT_TEXT_BYTES 65536 /* max bytes of a text */
#define GLINT_LINE_BYTES 200   /* max bytes of a line, without its line end */
/* number of decimal digits that a double can always represent */
#define GLINT_NUMBER_DIGITS 15

struct glint_text_place {
    /* Line and column (in bytes), both counted from 1. Line 0: no position. */
    int line, column;
};

struct glint_word {
    const char *start; /* the word's bytes, without a terminating 0 */
    /* number of bytes; 0 at the end of the line, which is then at PLACE */
    int length;
    struct glint_text_place place;
};

struct glint_text {
    const char *file_name;
    struct glint_error *error;
    const char *next, *end; /* start and end of the unread lines */
    /* start of the current line; start and end of its unread part */
    const char *line, *at, *stop;
    int line_number;
};

/* Opens DATA[BYTES] without copying it. DATA, FILE_NAME and ERROR must
 * outlive TEXT. Returns false if DATA is not text; ERROR states the reason. */
bool glint_text_open(struct glint_text *text, const char *data, size_t bytes,
                     const char *file_name, struct glint_error *error);

/* Opens DATA[BYTES], at most INT32_MAX bytes, without checks: lines may have
 * any length and any bytes. For files that programs write. */
void glint_text_open_data(struct glint_text *text, const char *data,
                          size_t bytes, const char *file_name,
                          struct glint_error *error);

/* Advances to the next line. Returns false at the end of the text. */
bool glint_text_next_line(struct glint_text *text);

/* Returns the next word of the line. */
struct glint_word glint_text_next_word(struct glint_text *text);

/* Reads the next word of the line, if any, into WORD. At the end of the line
 * the length of WORD is 0. Rejects a word that differs from ONLY. */
bool glint_text_read_optional_word(struct glint_text *text, const char *only,
                                   struct glint_word *word);

/* Returns the rest of the line, without blanks at either end. */
struct glint_word glint_text_get_rest(struct glint_text *text);

/* Returns the position of the end of the text. */
struct glint_text_place glint_text_get_end_place(const struct glint_text *text);

/* Sets the error to "FILE:LINE:COLUMN: FORMAT ...". Returns false. */
bool glint_text_set_error(const struct glint_text *text,
                          struct glint_text_place place, const char *format,
                          ...);

/* A quantity: its name in error texts and the range of its values. */
struct glint_text_range {
    const char *name;
    double min, max;
};

/* Reads WORD as a number of any magnitude. NAME names the number in error
 * texts. Sets the error of TEXT and returns false if WORD is not a number. */
bool glint_text_parse_number(const struct glint_text *text,
                             const struct glint_word *word, const char *name,
                             double *value);

bool glint_text_check_range(const struct glint_text *text,
                            struct glint_text_place place,
                            const struct glint_text_range *range, double value);

/* Reads WORD as a number in RANGE. Sets the error of TEXT and returns false if
 * it is not. */
bool glint_text_parse_value(const struct glint_text *text,
                            const struct glint_word *word,
                            const struct glint_text_range *range,
                            double *value);

/* Reads the next word as a number in RANGE; errors as above. PLACE, unless
 * NULL, receives the word's position. */
bool glint_text_read_value(struct glint_text *text,
                           const struct glint_text_range *range, double *value,
                           struct glint_text_place *place);

bool glint_word_equals(const struct glint_word *word, const char *string);

/* Returns WORD as quoted in error texts: printable ASCII characters only,
 * truncated if it is long. */
#define GLINT_QUOTE_BYTES 32
const char *glint_word_quote(const struct glint_word *word,
                             char quote[GLINT_QUOTE_BYTES]);

/* Parses WORD as [+-] digits [. digits] [e [+-] digits]. Returns NULL on
 * success, otherwise the end of an error text that begins with the quoted word,
 * such as "is not a number"; VALUE is then unchanged. */
const char *glint_word_parse_number(const struct glint_word *word,
                                    double *value);

/* Parses WORD as a number with any number of digits; the relative error of
 * VALUE is at most 4e-15. Returns false if WORD is not a number or is too large
 * for a double. */
bool glint_word_parse_long_number(const struct glint_word *word, double *value);

#endif
