/* SPDX-License-Identifier: MIT
 *
 * Parses a line of a scene text: its first word, then clauses in any order. A
 * clause is a word followed by its values.
 *
 *     struct glint_clause clause[] = {
 *         {"at", 3, -REACH, REACH, at, .required = true},
 *         {"material", .name = &material},
 *         {0}};
 *     glint_clauses_read(&text, "sphere", clause);
 */
#ifndef GLINT_BAKE_SCENE_CLAUSES_H
#define GLINT_BAKE_SCENE_CLAUSES_H

#include "bake/table/text.h"

struct glint_clause {
    const char *word; /* keyword; NULL: end of the list */
    int n; /* count of numbers that follow; 0: a name or nothing follows */
    double min, max; /* allowed range of the numbers */
    double *value;   /* [n]; unchanged if the clause is missing */
    /* receives the name that follows; NULL: no name follows */
    struct glint_word *name;
    bool required;
    /* Position of the keyword; line 0: the clause is missing. */
    struct glint_text_place place;
};

/* Parses the rest of the line as clauses listed in CLAUSE, each at most
 * once. LINE names the line in errors. Returns false, with the error of TEXT
 * set, if anything else is found. */
bool glint_clauses_read(struct glint_text *text, const char *line,
                        struct glint_clause *clause);

/* Parses N numbers within MIN .. MAX. WHAT names them in errors. */
bool glint_numbers_read(struct glint_text *text, const char *what, int n,
                        double min, double max, double *value);

/* Parses a name into NAME[BYTES]: a letter, then letters, digits, - and _. */
bool glint_name_read(struct glint_text *text, const char *what, char *name,
                     int bytes);

/* Sets INDEX to the index of WORD among N names; the first is at NAMES, the
 * next ones follow every STRIDE bytes. Rejects an unknown word. */
bool glint_name_find(struct glint_text *text, const struct glint_word *word,
                     const char *what, const char *names, size_t stride, int n,
                     int *index);

/* Parses one of NAMES, terminated by NULL. Returns its index, or -1. LIST is
 * the list of names and LINE the name of the line for the error message. */
int glint_choice_read(struct glint_text *text, const char *line,
                      const char *list, const char *const *names);

/* A line of a text, identified by its first word. */
struct glint_text_line {
    const char *word;
    bool many; /* true: the line may be repeated */
};

/* Reads the first word of the line. Sets INDEX to its index among N LINES,
 * or to -1 if the line is empty. FIRST[n], initially 0, stores the number of
 * the line on which each was last read. */
bool glint_line_begin(struct glint_text *text,
                      const struct glint_text_line *lines, int n, int *first,
                      int *index);

/* Rejects further words on the line. */
bool glint_line_ends(struct glint_text *text, const char *line);

#endif
