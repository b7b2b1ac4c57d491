/* SPDX-License-Identifier: MIT
 *
 * Parses a line of a scene text: its first word, then clauses in any order. A
 * clause is a keyword followed by numbers or a name.
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
    /* count of numbers after the keyword; 0: a name or nothing follows */
    int n;
    double min, max; /* allowed range of the numbers */
    /* receives the numbers, [n]; unchanged if the clause is missing */
    double *value;
    /* receives the name after the keyword; NULL: no name follows */
    struct glint_word *name;
    bool required;
    /* position of the keyword; line 0: the clause is missing */
    struct glint_text_place place;
};

/* Parses the rest of the line, which may contain each of the clauses in CLAUSE
 * once. LINE names the line in error texts. Returns false and sets the error of
 * TEXT if the rest contains anything else or a required clause is missing. */
bool glint_clauses_read(struct glint_text *text, const char *line,
                        struct glint_clause *clause);

/* Parses N numbers within MIN .. MAX. WHAT names them in error texts. */
bool glint_numbers_read(struct glint_text *text, const char *what, int n,
                        double min, double max, double *value);

/* Copies WORD to NAME[BYTES]; rejects words that are not names. */
bool glint_name_copy(struct glint_text *text, const struct glint_word *word,
                     char *name, int bytes);

/* Parses a name into NAME[BYTES]: a letter, then letters, digits, - and _. WHAT
 * names it in error texts. */
bool glint_name_read(struct glint_text *text, const char *what, char *name,
                     int bytes);

/* Sets INDEX to the index of WORD in a table of N names. NAMES is the first
 * name; the others follow every STRIDE bytes. Rejects unknown names. WHAT
 * describes the named objects in error texts. */
bool glint_name_find_index(struct glint_text *text,
                           const struct glint_word *word, const char *what,
                           const char *names, size_t stride, int n, int *index);

/* Parses one word, which must be in NAMES, a list terminated by NULL. Returns
 * its index, or -1 after an error. LIST describes the accepted words in the
 * error text about LINE. */
int glint_choice_read(struct glint_text *text, const char *line,
                      const char *list, const char *const *names);

/* a type of line, identified by its first word */
struct glint_text_line {
    const char *word;
    bool many; /* true: the line may be repeated */
};

/* Parses the first word of the line. Sets INDEX to its index among N LINES, or
 * to -1 if the line is empty. Stores the line's number in FIRST[INDEX]; FIRST
 * must initially be 0. Rejects a second line of a type that must not be
 * repeated. */
bool glint_line_read_first_word(struct glint_text *text,
                                const struct glint_text_line *lines, int n,
                                int *first, int *index);

/* Rejects any further words on the line. LINE names the line in error texts. */
bool glint_line_check_end(struct glint_text *text, const char *line);

#endif
