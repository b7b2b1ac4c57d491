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
 * Numbers are read without the C library, whose decimal point depends on the
 * locale, and are correctly rounded.
 */
#ifndef GLINT_BAKE_TABLE_TEXT_H
#define GLINT_BAKE_TABLE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/status.h"

#define GLINT_TEXT_BYTES    65536 /* longest text */
#define GLINT_LINE_BYTES    200   /* longest line, without its end */
#define GLINT_NUMBER_DIGITS 15    /* most significant digits of a number */

struct glint_text_place {
    /* both count from 1, columns in bytes; line 0: no place */
    int line, column;
};

struct glint_word {
    const char *start; /* not terminated */
    int length;        /* 0: there is none, and place is where it would be */
    struct glint_text_place place;
};

struct glint_text {
    const char *file_name;
    struct glint_error *error;
    const char *next, *end;       /* unread lines */
    const char *line, *at, *stop; /* this line: start, unread words */
    int line_number;
};

/* The bytes stay where they are and must outlive TEXT, as must the other
 * pointers. False: they are no text, and ERROR says why. */
bool glint_text_open(struct glint_text *text, const char *data, size_t bytes,
                     const char *file_name, struct glint_error *error);

/* Steps to the next line; false at the end of the text. */
bool glint_text_next_line(struct glint_text *text);

/* The next word of the line. */
struct glint_word glint_text_next_word(struct glint_text *text);

/* All that is left of the line without blanks at either end. */
struct glint_word glint_text_rest(struct glint_text *text);

/* Returns the place where the text ends. */
struct glint_text_place glint_text_end(const struct glint_text *text);

/* Writes "FILE:LINE:COLUMN: FORMAT ..." into the error; always false. */
bool glint_text_fail(const struct glint_text *text,
                     struct glint_text_place place, const char *format, ...);

/* A quantity and the values it may take. */
struct glint_text_range {
    const char *name;
    double min, max;
};

/* WORD as a number called NAME, whatever its size. False: the error is
 * written, as by the three functions below. */
bool glint_text_number_of(const struct glint_text *text,
                          const struct glint_word *word, const char *name,
                          double *value);

bool glint_text_in_range(const struct glint_text *text,
                         struct glint_text_place place,
                         const struct glint_text_range *range, double value);

/* WORD as a number in RANGE. */
bool glint_text_value_of(const struct glint_text *text,
                         const struct glint_word *word,
                         const struct glint_text_range *range, double *value);

/* The next word as a number in RANGE; PLACE, unless NULL, is where it is. */
bool glint_text_value(struct glint_text *text,
                      const struct glint_text_range *range, double *value,
                      struct glint_text_place *place);

bool glint_word_is(const struct glint_word *word, const char *string);

/* WORD for an error message: printable ASCII only, and not too long. */
#define GLINT_QUOTE_BYTES 32
const char *glint_word_quote(const struct glint_word *word,
                             char quote[GLINT_QUOTE_BYTES]);

/* The value of WORD: [+-] digits [. digits] [e [+-] digits]. NULL, or what is
 * wrong with it, to follow the word in a message; VALUE is unchanged then. */
const char *glint_word_number(const struct glint_word *word, double *value);

#endif
