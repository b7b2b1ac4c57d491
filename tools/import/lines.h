/* SPDX-License-Identifier: MIT
 *
 * lines.h - splits a text into lines and words, for the lens files of most
 * programs.
 */
#ifndef GLINT_TOOLS_IMPORT_LINES_H
#define GLINT_TOOLS_IMPORT_LINES_H

#include "import/imported.h"

/* A line of LINE_CHARS bytes has at most LINE_WORDS words. */
enum { LINE_CHARS = 2048, LINE_WORDS = LINE_CHARS / 2 };

struct lines {
    struct imported *lens; /* lens that receives errors */
    const char *at, *end;
    int number;   /* line number, from 1 */
    bool tabs;    /* whether only tabs separate words */
    char divider; /* character that ends a line like '\n'; '\0': none */
    /* true: the divider ended the last line, so that the line number does not
     * change */
    bool within;
    char text[LINE_CHARS]; /* the line, split into its words */
    char rest[LINE_CHARS]; /* the line without its first word */
    int n;
    const char *word[LINE_WORDS];
};

void lines_init(struct lines *lines, struct imported *lens, const char *text,
                size_t bytes);

/* Reads the next line that is not blank, and splits it at blanks and tabs. Text
 * in quotes is one word. A quote must be at the start of a word and be closed
 * on the same line; other quotes are apostrophes or inches. Text after the
 * character COMMENT is ignored; '\0': no comments. Returns false at the end of
 * the text, or with the error set if the line is too long. */
bool lines_read_next(struct lines *lines, char comment);

/* Sets VALUE to word K. If there is no such word or the word is not a number,
 * sets an error that names WHAT and returns false. */
bool lines_parse_number(const struct lines *lines, int k, const char *what,
                        double *value);

bool lines_first_word_is(const struct lines *lines, const char *word);

/* Sets RADIUS to 1 / c, where c is the curvature in word K. Sets it to 0
 * (plane) if c is 0. */
bool lines_parse_curvature(const struct lines *lines, int k, double *radius);

/* Sets MOST to the max of MOST and the absolute values of all numbers after the
 * first word. */
bool lines_parse_fields(const struct lines *lines, double *most);

/* Sets the error that mirrors are not supported; returns false. */
bool lines_reject_mirror(const struct lines *lines);

#endif
