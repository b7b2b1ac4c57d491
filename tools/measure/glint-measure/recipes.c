/* SPDX-License-Identifier: MIT */
#include "measure/glint-measure/recipes.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lines of a recipe that define its rows */
struct recipe_lines {
    const char *lens[RECIPE_LINES], *vary[RECIPE_LINES], *label[RECIPE_LINES];
    int n_lenses, n_vary, n_labels;
    const char *set[ROW_PARAMETERS];
    int n_set;
};

/* memory for the texts of the recipe that was read last */
static char pool[1 << 18];
static size_t pooled;

/* Returns a copy in the pool of PREFIX followed by TEXT[LENGTH], or an empty
 * text if the pool is full. */
static char *copy_to_pool(const char *prefix, const char *text, size_t length)
{
    char *const to = pool + pooled;
    const size_t bytes = strlen(prefix) + length + 1;

    if (bytes > sizeof pool - 1 - pooled)
        return pool + sizeof pool - 1;
    snprintf(to, bytes, "%s%.*s", prefix, (int)length, text);
    pooled += bytes;
    return to;
}

static void add_words_to_row(struct recipe_row *row, const char *text)
{
    char *word, *rest = copy_to_pool("", text, strlen(text));

    while ((word = strtok_r(rest, " ", &rest)))
        if (row->n < ROW_PARAMETERS)
            row->set[row->n++] = word;
}

const char *recipe_find_value(const struct recipe_row *row,
                              const char *parameter)
{
    const size_t length = strlen(parameter);

    for (int i = row->n - 1; i >= 0; i--)
        if (strncmp(row->set[i], parameter, length) == 0 &&
            row->set[i][length] == '=')
            return row->set[i] + length + 1;
    return NULL;
}

bool recipe_row_has_parameter(const struct recipe_row *row, const char *words)
{
    struct recipe_row wanted = {.n = 0};

    add_words_to_row(&wanted, words);
    for (int i = 0; i < wanted.n; i++) {
        const size_t length = strcspn(wanted.set[i], "=");
        char name[64];
        const char *value;

        if (length >= sizeof name || wanted.set[i][length] != '=')
            return false;
        memcpy(name, wanted.set[i], length);
        name[length] = '\0';
        value = recipe_find_value(row, name);
        if (!value || strcmp(value, wanted.set[i] + length + 1) != 0)
            return false;
    }
    return true;
}

/* -------------------------------------------------------------------- rows */

/* Replaces each row by one row per value in VARY, a text "NAME VALUE VALUE...".
 * The new rows have the parameter NAME=VALUE. */
static void multiply_rows_by_values(struct recipe *r, const char *vary)
{
    const int n = r->n_rows;
    const size_t length = strcspn(vary, " ");

    for (int i = 0; i < n; i++)
        for (const char *value = vary + length;
             *value && r->n_rows < RECIPE_ROWS; value += strcspn(value, " ")) {
            struct recipe_row *const row = &r->row[r->n_rows];
            char name[64];

            value += strspn(value, " ");
            *row = r->row[i];
            snprintf(name, sizeof name, "%.*s=", (int)length, vary);
            if (row->n < ROW_PARAMETERS)
                row->set[row->n++] =
                    copy_to_pool(name, value, strcspn(value, " "));
            r->n_rows++;
        }
    memmove(r->row, r->row + n, (size_t)(r->n_rows - n) * sizeof *r->row);
    r->n_rows -= n;
}

/* Replaces each row by one row per line "LABEL: NAME=VALUE ..." of the recipe.
 * The new rows have the label and the parameters of this line. */
static void multiply_rows_by_labels(struct recipe *r,
                                    const struct recipe_lines *l)
{
    const int n = r->n_rows;

    for (int i = 0; i < n && l->n_labels; i++)
        for (int k = 0; k < l->n_labels && r->n_rows < RECIPE_ROWS; k++) {
            const char *const colon = strchr(l->label[k], ':');
            struct recipe_row row = r->row[i];

            if (!colon || row.n == ROW_PARAMETERS)
                continue;
            row.set[row.n++] = copy_to_pool("label=", l->label[k],
                                            (size_t)(colon - l->label[k]));
            add_words_to_row(&row, colon + 1);
            r->row[r->n_rows++] = row;
        }
    if (l->n_labels) {
        memmove(r->row, r->row + n, (size_t)(r->n_rows - n) * sizeof *r->row);
        r->n_rows -= n;
    }
}

/* Adds a row for each lens file that matches PATTERN, a name or glob pattern.
 * The row has the parameters of all rows and those in LINE. */
static void add_rows_of_files(struct recipe *r, const struct recipe_lines *l,
                              const char *pattern, const char *line)
{
    char text[512];
    glob_t files;

    if (glob(pattern, GLOB_NOCHECK, NULL, &files) != 0)
        return;
    for (size_t i = 0; i < files.gl_pathc && r->n_rows < RECIPE_ROWS; i++) {
        struct recipe_row *const row = &r->row[r->n_rows++];

        row->n = 0;
        for (int k = 0; k < l->n_set; k++)
            add_words_to_row(row, l->set[k]);
        snprintf(text, sizeof text, "lens=%s %s", files.gl_pathv[i], line);
        add_words_to_row(row, text);
    }
    globfree(&files);
}

/* Adds a row for each lens at the start of LINE. The PARAMETER=VALUE words
 * after the lenses apply to these rows. */
static void add_rows_of_lenses(struct recipe *r, const struct recipe_lines *l,
                               const char *line)
{
    char *rest = copy_to_pool("", line, strlen(line)), *word;
    const char *set = line;

    for (; *set && strcspn(set, "=") >= strcspn(set, " ");
         set += strspn(set, " "))
        set += strcspn(set, " ");
    while ((word = strtok_r(rest, " ", &rest)) && !strchr(word, '='))
        add_rows_of_files(r, l, word, set);
}

static void make_recipe_rows(struct recipe *r, const struct recipe_lines *l)
{
    for (int i = 0; i < l->n_lenses; i++)
        add_rows_of_lenses(r, l, l->lens[i]);
    for (int i = 0; i < l->n_vary; i++)
        multiply_rows_by_values(r, l->vary[i]);
    multiply_rows_by_labels(r, l);
}

/* ------------------------------------------------------------------ reading */

/* Adds the metrics in column C to the recipe. A column without metrics is
 * marked as a key. */
static void collect_column_metrics(struct recipe *r, struct recipe_column *c)
{
    c->is_key = true;
    for (const char *at = strchr(c->cell, '{'); at; at = strchr(at + 1, '{')) {
        const size_t length = strcspn(at + 1, "%}");
        const size_t used = strlen(r->metrics);

        if (at[1 + length] != '%')
            continue;
        c->is_key = false;
        snprintf(r->metrics + used, sizeof r->metrics - used, "%s%.*s",
                 used ? "," : "", (int)length, at + 1);
    }
}

/* Parses "TITLE = CELL | TITLE = CELL ...". */
static void parse_table_columns(struct recipe *r, char *text)
{
    for (char *next; text && r->n_columns < RECIPE_LINES; text = next) {
        char *const equals = strstr(text, " = ");

        next = strstr(text, " | ");
        if (next) {
            *next = '\0';
            next += 3;
        }
        if (!equals)
            return;
        *equals = '\0';
        r->column[r->n_columns] = (struct recipe_column){text, equals + 3, 0};
        collect_column_metrics(r, &r->column[r->n_columns++]);
    }
}

static void parse_recipe_line(struct recipe *r, struct recipe_lines *l,
                              char *line)
{
    static const char *const words[] = {"lens",   "vary",  "case", "set",
                                        "column", "quick", "limit"};
    const size_t length = strcspn(line, " ");
    char *rest = line + length + strspn(line + length, " ");
    int word = 0;

    while (word < 7 && (strncmp(line, words[word], length) != 0 ||
                        words[word][length] != '\0'))
        word++;
    if (word == 0 && l->n_lenses < RECIPE_LINES)
        l->lens[l->n_lenses++] = rest;
    else if (word == 1 && l->n_vary < RECIPE_LINES)
        l->vary[l->n_vary++] = rest;
    else if (word == 2 && l->n_labels < RECIPE_LINES)
        l->label[l->n_labels++] = rest;
    else if (word == 3 && l->n_set < ROW_PARAMETERS)
        l->set[l->n_set++] = rest;
    else if (word == 4)
        parse_table_columns(r, rest);
    else if (word == 5 && r->n_quick < RECIPE_LINES)
        r->quick[r->n_quick++] = rest;
    else if (word == 6)
        r->limit_s = (int)strtol(rest, NULL, 10);
    else
        fprintf(stderr, "glint-measure: %s: unknown line: %s\n", r->name, line);
}

char *recipe_parse(struct recipe *r, char *text, const char *name)
{
    struct recipe_lines l = {.n_set = 0};
    char *line, *rest = text, *next = text;
    bool is_it = false;

    *r = (struct recipe){.name = NULL};
    pooled = 0;
    while ((line = strtok_r(rest, "\n", &rest))) {
        if (*line == '#')
            continue;
        if (*line != ' ') {
            if (is_it && (l.n_lenses || name)) {
                /* restores the line end because the text is parsed again */
                line[strlen(line)] = '\n';
                break;
            }
            line[strcspn(line, " ")] = '\0';
            is_it = !name || strcmp(line, name) == 0;
            r->name = line;
        } else if (is_it) {
            parse_recipe_line(r, &l, line + strspn(line, " "));
        }
        next = rest;
    }
    if (!is_it || !l.n_lenses)
        return NULL;
    make_recipe_rows(r, &l);
    return next;
}
