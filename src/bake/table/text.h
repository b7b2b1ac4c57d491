/* SPDX-License-Identifier: MIT
 *
 * Lines, words and numbers of a text that may hold anything.
 *
 *     glint_text_open(&text, data, bytes, "x.lens", error);
 *     while (glint_text_next_line(&text))
 *         while ((word = glint_text_next_word(&text)).length)
 *             ...
 *
 * Opening checks every byte, so that reading cannot fail: lines of at most
 * GLINT_LINE_BYTES, no control characters except tab, newline and the return
 * of a CRLF, and well-formed UTF-8. Blanks (space, tab) divide words; a # at
 * the start of a word begins a comment. Every word knows its place, and
 * glint_text_fail writes "FILE:LINE:COLUMN: cause" for it.
 *
 * Numbers do not depend on the locale, and are the nearest doubles.
 */
#ifndef GLINT_BAKE_TABLE_TEXT_H
#define GLINT_BAKE_TABLE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/status.h"

#define GLINT_TEXT_BYTES    65536 /* longest text */
#define GLINT_LINE_BYTES    200   /* longest line, without its end */
#define GLINT_NUMBER_DIGITS 15    /* that fit a double, whichever they are */

struct glint_text_place {
    /* both count from 1, columns in bytes; line 0: no position */
    int line, column;
};

struct glint_word {
    const char *start; /* not terminated */
    int length;        /* 0: there is no word, and PLACE is where it would be */
    struct glint_text_place place;
};

struct glint_text {
    const char *file_name;
    struct glint_error *error;
    const char *next, *end;       /* lines not read yet */
    const char *line, *at, *stop; /* the line being read: its start, and its
                                     unread words AT .. STOP */
    int line_number;
};

/* Opens DATA[BYTES] without a copy. DATA, FILE_NAME and ERROR must outlive
 * TEXT. Returns false if DATA is not text; ERROR states why. */
bool glint_text_open(struct glint_text *text, const char *data, size_t bytes,
                     const char *file_name, struct glint_error *error);

/* Opens DATA[BYTES], at most INT32_MAX, with lines of any length and any bytes
 * in them, for files that programs write. */
void glint_text_open_data(struct glint_text *text, const char *data,
                          size_t bytes, const char *file_name,
                          struct glint_error *error);

/* Goes to the next line; returns false at the end of the text. */
bool glint_text_next_line(struct glint_text *text);

/* Returns the next word of the line. */
struct glint_word glint_text_next_word(struct glint_text *text);

/* Reads the next word of the line into WORD, of length 0 if no word is left.
 * Rejects any word but ONLY. */
bool glint_text_may_follow(struct glint_text *text, const char *only,
                           struct glint_word *word);

/* Returns all that is left of the line, without blanks at either end. */
struct glint_word glint_text_rest(struct glint_text *text);

/* Returns the position of the end of the text. */
struct glint_text_place glint_text_end(const struct glint_text *text);

/* Writes "FILE:LINE:COLUMN: FORMAT ..." into the error; always false. */
bool glint_text_fail(const struct glint_text *text,
                     struct glint_text_place place, const char *format, ...);

/* The name of a quantity and the range of its values. */
struct glint_text_range {
    const char *name;
    double min, max;
};

/* Reads WORD as a number called NAME, of any size. Returns false and writes the
 * error if WORD is not a number, as do the next three functions. */
bool glint_text_number_of(const struct glint_text *text,
                          const struct glint_word *word, const char *name,
                          double *value);

bool glint_text_in_range(const struct glint_text *text,
                         struct glint_text_place place,
                         const struct glint_text_range *range, double value);

/* Reads WORD as a number in RANGE. */
bool glint_text_value_of(const struct glint_text *text,
                         const struct glint_word *word,
                         const struct glint_text_range *range, double *value);

/* Reads the next word as a number in RANGE. PLACE, unless NULL, receives the
 * position of the word. */
bool glint_text_value(struct glint_text *text,
                      const struct glint_text_range *range, double *value,
                      struct glint_text_place *place);

bool glint_word_is(const struct glint_word *word, const char *string);

/* Returns WORD for an error message: printable ASCII only, and cut if it is
 * long. */
#define GLINT_QUOTE_BYTES 32
const char *glint_word_quote(const struct glint_word *word,
                             char quote[GLINT_QUOTE_BYTES]);

/* Reads WORD as [+-] digits [. digits] [e [+-] digits]. Returns NULL, or an
 * error text to print after the word; VALUE is then unchanged. */
const char *glint_word_number(const struct glint_word *word, double *value);

/* Reads WORD likewise, with any number of digits: VALUE is within 4e-15 of it.
 * Returns false if it is no number or too large for a double. */
bool glint_word_number_about(const struct glint_word *word, double *value);

#endif
