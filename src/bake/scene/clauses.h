/* SPDX-License-Identifier: MIT
 *
 * Reads a line of a scene text behind its first words: clauses in any order,
 * each a word and its values.
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

/* Reads the rest of the line as CLAUSE, of which LINE takes each once. Returns
 * false if it is something else; the error of TEXT is written. */
bool glint_clauses_read(struct glint_text *text, const char *line,
                        struct glint_clause *clause);

/* Reads N numbers of MIN .. MAX that belong to WHAT. */
bool glint_numbers_read(struct glint_text *text, const char *what, int n,
                        double min, double max, double *value);

/* Reads a name into NAME: a letter, then letters, digits, - and _. */
bool glint_name_read(struct glint_text *text, const char *what, char *name,
                     int bytes);

/* Checks that nothing is left of the line. */
bool glint_line_ends(struct glint_text *text, const char *line);

#endif
