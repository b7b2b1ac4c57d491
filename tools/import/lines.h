/* SPDX-License-Identifier: MIT
 *
 * lines.h - text in lines of words, as most lens files are.
 */
#ifndef GLINT_TOOLS_IMPORT_LINES_H
#define GLINT_TOOLS_IMPORT_LINES_H

#include "import/imported.h"

/* A line of so many bytes has no more words than that. */
enum { LINE_CHARS = 2048, LINE_WORDS = LINE_CHARS / 2 };

struct lines {
    struct imported *lens; /* which errors go to */
    const char *at, *end;
    int number;            /* of the line, from 1 */
    bool tabs;             /* words are divided at each tab, and at no blank */
    char divider;          /* also ends a line, for words, if not '\0' */
    bool within;           /* a divider has ended the last one */
    char text[LINE_CHARS]; /* the line, divided into its words */
    char rest[LINE_CHARS]; /* the line but for its first word */
    int n;
    const char *word[LINE_WORDS];
};

void lines_begin(struct lines *lines, struct imported *lens, const char *text,
                 size_t bytes);

/* Takes the next line that has words, divided at blanks and tabs. Quoted words
 * count as one; a quote begins a word and ends on its line, so that apostrophes
 * and inches are not quotes. What follows COMMENT is left out; '\0': there are
 * none. Returns false at the end, or after the error of a line that is too
 * long, which import_read() sees. */
bool lines_next(struct lines *lines, char comment);

/* Sets VALUE to word K. Returns false, after an error that states WHAT it is,
 * if there is none or it is no number. */
bool lines_number(const struct lines *lines, int k, const char *what,
                  double *value);

/* Returns whether the first word is WORD. */
bool lines_is(const struct lines *lines, const char *word);

/* Sets RADIUS to that of the curvature in word K. */
bool lines_curvature(const struct lines *lines, int k, double *radius);

/* Sets MOST to the largest of it and the sizes of the numbers behind the first
 * word. */
bool lines_fields(const struct lines *lines, double *most);

/* Refuses a mirror. */
bool lines_mirror(const struct lines *lines);

#endif
