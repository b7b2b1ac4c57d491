/* SPDX-License-Identifier: MIT
 *
 * Recipes: text files in tools/measure/recipes that define the rows and columns
 * of each table of measurements.
 */
#ifndef GLINT_TOOLS_MEASURE_RECIPES_H
#define GLINT_TOOLS_MEASURE_RECIPES_H

#include <stdbool.h>
#include <stddef.h>

enum { RECIPE_LINES = 128, RECIPE_ROWS = 512, ROW_PARAMETERS = 32 };

/* A row: texts PARAMETER=VALUE. If a parameter occurs several times, the last
 * value applies. */
struct recipe_row {
    const char *set[ROW_PARAMETERS];
    int n;
};

/* A column: its title and the template of its cells, with {PARAMETER},
 * {METRIC%FORMAT} or {METRIC%FORMAT~TOLERANCE}. */
struct recipe_column {
    const char *title, *cell;
    /* true: the column has no metrics; such columns identify the row */
    bool is_key;
};

struct recipe {
    const char *name;
    struct recipe_row row[RECIPE_ROWS];
    int n_rows;
    struct recipe_column column[RECIPE_LINES];
    int n_columns;
    const char *quick[RECIPE_LINES]; /* rows that --quick measures, selected by
                                        PARAMETER=VALUE words */
    int n_quick;
    int limit_s; /* max CPU seconds of a row; 0: no limit */
    char metrics[1024];
};

/* Sets RECIPE to the recipe NAME in TEXT, or to the first one with rows if NAME
 * is NULL. Modifies TEXT, which must outlive RECIPE. Returns the text after the
 * recipe, or NULL if NAME does not exist. */
char *recipe_parse(struct recipe *recipe, char *text, const char *name);

/* Returns the value of PARAMETER in ROW, or NULL if it is not set. The value of
 * the parameter "lens" is the lens's name. */
const char *recipe_find_value(const struct recipe_row *row,
                              const char *parameter);

/* Returns whether ROW has all PARAMETER=VALUE words in WORDS. */
bool recipe_row_has_parameter(const struct recipe_row *row, const char *words);

#endif
