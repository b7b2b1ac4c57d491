/* SPDX-License-Identifier: MIT
 *
 * Reads a line of a scene text: its first word, and behind that clauses in any
 * order, each a word and its values.
 *
 *     struct glint_clause clause[] = {
 *         {"at", 3, -REACH, REACH, at, .required = true},
 *         {"material", .name = &material},
 *         {0}};
 *     glint_clauses_read(&text, "sphere", clause); */
#ifndef GLINT_BAKE_SCENE_CLAUSES_H
#define GLINT_BAKE_SCENE_CLAUSES_H

#include "bake/table/text.h"

struct glint_clause {
    const char *word;        /* NULL: the end of the list */
    int n;                   /* numbers that follow; 0: a name, or nothing */
    double min, max;         /* range of the numbers */
    double *value;           /* [n]; unchanged if the clause is not there */
    struct glint_word *name; /* word that follows, or NULL */
    bool required;
    /* Place of the clause's word; line 0 if it was not there. */
    struct glint_text_place place;
};

/* Reads the rest of the line as clauses of CLAUSE, each at most once in LINE.
 * Returns false, with the error of TEXT set, if there is anything else. */
bool glint_clauses_read(struct glint_text *text, const char *line,
                        struct glint_clause *clause);

/* Reads N numbers of MIN .. MAX that belong to WHAT. */
bool glint_numbers_read(struct glint_text *text, const char *what, int n,
                        double min, double max, double *value);

/* Reads a name into NAME: a letter, then letters, digits, - and _. */
bool glint_name_read(struct glint_text *text, const char *what, char *name,
                     int bytes);

/* Sets INDEX to the index of WORD among N names; the first name is at NAMES,
 * the next names follow every STRIDE bytes. Rejects a word that is not among
 * them. */
bool glint_name_find(struct glint_text *text, const struct glint_word *word,
                     const char *what, const char *names, size_t stride, int n,
                     int *index);

/* Reads one of NAMES, terminated by NULL, and returns its index, or -1. LIST is
 * the list of names and LINE the line for the error message. */
int glint_choice_read(struct glint_text *text, const char *line,
                      const char *list, const char *const *names);

/* A line of a text, by its first word. */
struct glint_text_line {
    const char *word;
    bool many; /* it may stand more than once */
};

/* Reads the first word of the line and sets INDEX to its index among N LINES,
 * or to -1 if the line is empty. FIRST[n], initially 0, holds the number of the
 * line where each was last read, or 0. */
bool glint_line_begin(struct glint_text *text,
                      const struct glint_text_line *lines, int n, int *first,
                      int *index);

/* Checks that nothing is left of the line. */
bool glint_line_ends(struct glint_text *text, const char *line);

#endif
