/* SPDX-License-Identifier: MIT
 *
 * lines.h - text in lines of words, as most lens files are.
 */
#ifndef GLINT_TOOLS_IMPORT_LINES_H
#define GLINT_TOOLS_IMPORT_LINES_H

#include "import/imported.h"

enum { LINE_WORDS = 24, LINE_CHARS = 512 };

struct lines {
    const char *at, *end;
    int number;            /* of the line, from 1 */
    char divider;          /* also ends a line, for words, if not '\0' */
    bool within;           /* a divider has ended the last one */
    char text[LINE_CHARS]; /* the line, divided into its words */
    char rest[LINE_CHARS]; /* the line but for its first word */
    int n;
    const char *word[LINE_WORDS];
};

void lines_begin(struct lines *lines, const char *text, size_t bytes);

/* Takes the next line that has words, divided at blanks and tabs. Words in
 * quotes are one. What follows COMMENT is left out; '\0': there are none.
 * Returns false at the end. */
bool lines_next(struct lines *lines, char comment);

/* Sets VALUE to word K. Returns false, after an error that says WHAT it is, if
 * there is none or it is no number. */
bool lines_number(struct imported *lens, const struct lines *lines, int k,
                  const char *what, double *value);

/* Returns whether the first word is WORD. */
bool lines_is(const struct lines *lines, const char *word);

#endif
