/* SPDX-License-Identifier: MIT
 *
 * Recipes of figures: what tools/measure/recipes says of one, and its rows.
 */
#ifndef GLINT_TOOLS_MEASURE_RECIPES_H
#define GLINT_TOOLS_MEASURE_RECIPES_H

#include <stdbool.h>
#include <stddef.h>

enum { RECIPE_LINES = 128, RECIPE_ROWS = 512, ROW_PARAMETERS = 32 };

/* A row: PARAMETER=VALUE texts, of which the last one of a name counts. */
struct recipe_row {
    const char *set[ROW_PARAMETERS];
    int n;
};

/* A column: its title, and its cells with {PARAMETER}, {METRIC%FORMAT} or
 * {METRIC%FORMAT~TOLERANCE}. */
struct recipe_column {
    const char *title, *cell;
    bool is_key; /* no metric in it: it tells rows apart */
};

struct recipe {
    const char *name;
    struct recipe_row row[RECIPE_ROWS];
    int n_rows;
    struct recipe_column column[RECIPE_LINES];
    int n_columns;
    const char *quick[RECIPE_LINES]; /* rows that --quick measures, by words
                                        PARAMETER=VALUE */
    int n_quick;
    int limit_s; /* processor seconds of a row; 0: no limit */
    char metrics[1024];
};

/* Sets RECIPE to the one of NAME in TEXT, which is changed and kept. NAME NULL:
 * the first one with rows. Returns the text behind it; NULL: there is none. */
char *recipe_read(struct recipe *recipe, char *text, const char *name);

/* Returns the value of PARAMETER of ROW; of a lens its name; NULL: not set. */
const char *recipe_value(const struct recipe_row *row, const char *parameter);

/* Returns whether ROW has all of WORDS. */
bool recipe_row_has(const struct recipe_row *row, const char *words);

#endif
