/* SPDX-License-Identifier: MIT
 *
 * glint-measure FIGURE [PARAMETER=VALUE...] - measures rows of the figure
 * FIGURE, which tools/measure/recipes defines, and prints its table. Rows that
 * are not measured are copied from its file in tests/figures. If some rows have
 * PARAMETER=VALUE, only these rows are measured; otherwise it is set in all
 * rows.
 *
 * glint-measure --quick - measures those rows that the recipes mark as quick.
 * Fails if a number differs from the number in the table by more than its
 * tolerance.
 *
 * glint-measure --row metrics=NAME,... lens=LENS PARAMETER=VALUE... - measures
 * one row and prints its metrics as JSON.
 *
 * All metrics are appended to build/measure.csv. Must run in the root of the
 * source tree.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "measure/canvas.h"
#include "measure/glint-measure/recipes.h"
#include "measure/glint-measure/row.h"
#include "options/json_writer.h"

#define RECIPES "tools/measure/recipes"
#define CSV     "build/measure.csv"
#define CALLGRIND                                               \
    "valgrind --tool=callgrind --callgrind-out-file=/dev/null " \
    "--toggle-collect=measured_frame "

enum { TEXT = 1 << 14, TABLE_ROWS = 2 * RECIPE_ROWS };

/* A Markdown table, "| a | b |" per line. */
struct table {
    char *line[TABLE_ROWS];
    int n;
};

/* --------------------------------------------------------------------- row */

static int measure_row(int n, char **assignments)
{
    static struct figure_row row;
    struct tool tool = {.name = "measure", .quiet = true};
    int code = row_parse(&row, &tool, n, assignments);

    if (code == EXIT_OK)
        code = tool_start_threads(&tool);
    if (code == EXIT_OK)
        code = row_measure(&row);
    opened_lens_close(&row.opened);
    tool_stop_threads(&tool);
    return code;
}

/* Runs a row in a child process, under callgrind if COUNTED. Sets TEXT to the
 * row's JSON, or to callgrind's count. Returns an exit code, or -1 if the row
 * reached its limit of CPU seconds. */
static int run_row_in_child(const struct recipe *r,
                            const struct recipe_row *row, const char *self,
                            bool counted, char text[TEXT])
{
    char line[TEXT], limit[32] = "";
    size_t used, bytes;
    FILE *pipe;
    int status;

    if (r->limit_s)
        snprintf(limit, sizeof limit, "ulimit -St %d; ", r->limit_s);
    used = (size_t)snprintf(line, sizeof line, "%sexec %s'%s' --row metrics=%s",
                            limit, counted ? CALLGRIND : "", self,
                            counted ? "minsn rounds=2" : r->metrics);
    for (int i = 0; i < row->n && used < sizeof line; i++)
        if (strncmp(row->set[i], "label=", 6) != 0)
            used += (size_t)snprintf(line + used, sizeof line - used, " '%s'",
                                     row->set[i]);
    if (counted && used < sizeof line)
        snprintf(line + used, sizeof line - used, " 2>&1");
    pipe = popen(line, "r"); /* NOLINT: made of glint's own recipes */
    if (!pipe)
        return EXIT_RUNTIME;
    bytes = fread(text, 1, TEXT - 1, pipe);
    text[bytes] = '\0';
    status = pclose(pipe);
    if (WIFSIGNALED(status) || WEXITSTATUS(status) > 128)
        return r->limit_s ? -1 : EXIT_RUNTIME;
    return WEXITSTATUS(status);
}

/* Returns the metric NAME of JSON, or NAN if it is missing. */
static double find_json_metric(const char *json, const char *name,
                               size_t length)
{
    for (const char *at = strchr(json, '"'); at; at = strchr(at + 1, '"'))
        if (strncmp(at + 1, name, length) == 0 &&
            strncmp(at + 1 + length, "\": ", 3) == 0 &&
            strncmp(at + 4 + length, "null", 4) != 0)
            return strtod(at + 4 + length, NULL);
    return (double)NAN;
}

/* Appends the instructions per frame to JSON, as an object on its own line.
 * Returns false without memory. */
static bool append_instruction_count(char json[TEXT], double instructions)
{
    const size_t used = strlen(json);
    struct json_writer more = {.to = fmemopen(json + used, TEXT - used, "w")};

    if (!more.to)
        return false;
    json_write(&more, "{minsn: %.6f}\n", 1e-6 * instructions);
    return fclose(more.to) == 0;
}

/* Measures ROW and writes the metrics to JSON. Counts instructions if they are
 * a metric. */
static int measure_row_to_json(const struct recipe *r,
                               const struct recipe_row *row, const char *self,
                               char json[TEXT])
{
    static char counted[TEXT];
    int code = run_row_in_child(r, row, self, false, json);
    const char *count;

    if (code != EXIT_OK || !strstr(r->metrics, "minsn"))
        return code;
    code = run_row_in_child(r, row, self, true, counted);
    count = strstr(counted, "Collected : ");
    if (code != EXIT_OK)
        return code;
    return count && append_instruction_count(json, strtod(count + 12, NULL))
               ? EXIT_OK
               : EXIT_RUNTIME;
}

/* --------------------------------------------------------------------- csv */

static void read_first_line_of_output(const char *command, char text[128])
{
    FILE *const pipe = popen(command, "r"); /* NOLINT: a fixed command */

    text[0] = '\0';
    if (pipe && fgets(text, 128, pipe))
        text[strcspn(text, "\n")] = '\0';
    if (pipe)
        pclose(pipe);
}

/* Appends the metrics of ROW to build/measure.csv. */
static void append_csv_line(const struct recipe *r,
                            const struct recipe_row *row, const char *json)
{
    static char conditions[2][128];
    const bool is_new = access(CSV, F_OK) != 0;
    FILE *const file = fopen(CSV, "a");

    if (!file)
        return;
    if (!conditions[0][0])
        read_first_line_of_output("git describe --always --dirty --abbrev=8",
                                  conditions[0]);
    read_first_line_of_output("cut -d ' ' -f 1 /proc/loadavg", conditions[1]);
    if (is_new)
        fputs("figure,parameters,metric,value,revision,machine,load\n", file);
    for (const char *at = r->metrics; at; at = strchr(at, ',')) {
        const size_t length = strcspn(at += *at == ',', ",");

        fprintf(file, "%s,", r->name);
        for (int i = 0; i < row->n; i++) {
            fprintf(file, "%s", i ? ";" : "");
            for (const char *c = row->set[i]; *c; c++)
                fputc(*c == ',' ? ' ' : *c, file);
        }
        fprintf(file, ",%.*s,%.9g,%s,%s,%s\n", (int)length, at,
                find_json_metric(json, at, length), conditions[0],
                canvas_describe_machine(), conditions[1]);
    }
    fclose(file);
}

/* ------------------------------------------------------------------- table */

/* Writes to TO the value of the placeholder at AT: the parameter {NAME}, or the
 * metric {NAME%FORMAT~TOLERANCE}. Returns false if the row does not have the
 * metric. */
static bool write_placeholder_value(const char *at,
                                    const struct recipe_row *row,
                                    const char *json, char *to, size_t bytes)
{
    const size_t length = strcspn(at, "%}");
    const char *value;
    char name[64], format[16];
    int digits = 6;
    double x;

    snprintf(name, sizeof name, "%.*s", (int)length, at);
    if (at[length] != '%') {
        value = recipe_find_value(row, name);
        if (value && strcmp(name, "lens") == 0) {
            const char *const slash = strrchr(value, '/');

            value = slash ? slash + 1 : value;
            snprintf(to, bytes, "%.*s", (int)strcspn(value, "."), value);
        } else {
            snprintf(to, bytes, "%s", value ? value : "");
        }
        return true;
    }
    snprintf(format, sizeof format, "%.*s", (int)strcspn(at + length, "~}"),
             at + length);
    x = find_json_metric(json, name, length);
    if (!isfinite(x))
        return false;
    if (format[1] == '.')
        digits = (int)strtol(format + 2, NULL, 10);
    switch (format[strlen(format) - 1]) {
    case 'f':
        snprintf(to, bytes, "%.*f", digits, x);
        return true;
    default:
        snprintf(to, bytes, "%.*g", digits, x);
        return true;
    }
}

/* Writes the cell of COLUMN to TO. The cell is empty if a metric is missing. */
static void write_table_cell(const struct recipe_column *column,
                             const struct recipe_row *row, const char *json,
                             char *to, size_t bytes)
{
    const char *at = column->cell;
    size_t used = 0;

    *to = '\0';
    for (; *at && used + 1 < bytes; at++) {
        if (*at != '{') {
            to[used++] = *at;
            to[used] = '\0';
            continue;
        }
        if (!write_placeholder_value(at + 1, row, json, to + used,
                                     bytes - used)) {
            *to = '\0';
            return;
        }
        used = strlen(to);
        at += strcspn(at, "}");
    }
}

/* Returns ROW as a line of the table, which the caller frees. Returns NULL if
 * the row has none of the metrics; for example, an anamorphic lens has no
 * projection. OVER: the row exceeded its CPU limit. */
static char *make_table_line(const struct recipe *r,
                             const struct recipe_row *row, const char *json,
                             bool over)
{
    static char line[TEXT];
    size_t used = 1;
    bool is_empty = true;

    strcpy(line, "|");
    for (int i = 0; i < r->n_columns; i++) {
        char cell[256];

        write_table_cell(&r->column[i], row, json, cell, sizeof cell);
        if (over && strncmp(r->column[i].cell, "{bake_s", 7) == 0)
            snprintf(cell, sizeof cell, "over %d", r->limit_s);
        is_empty = is_empty && (r->column[i].is_key || !*cell);
        used += (size_t)snprintf(line + used, sizeof line - used, "%s%s |",
                                 *cell ? " " : "", cell);
    }
    return is_empty ? NULL : strdup(line);
}

static void copy_table_cell(const char *line, int number, char cell[256])
{
    size_t length;

    for (int i = 0; i <= number && line; i++)
        line = strchr(line + (i > 0), '|');
    line = line ? line + 1 : "";
    line += strspn(line, " ");
    length = strcspn(line, "|");
    while (length > 0 && line[length - 1] == ' ')
        length--;
    snprintf(cell, 256, "%.*s", (int)length, line);
}

static bool have_lines_same_key_columns(const struct recipe *r, const char *a,
                                        const char *b)
{
    char cell[2][256];

    for (int i = 0; i < r->n_columns; i++) {
        copy_table_cell(a, i, cell[0]);
        copy_table_cell(b, i, cell[1]);
        if (r->column[i].is_key && strcmp(cell[0], cell[1]) != 0)
            return false;
    }
    return true;
}

/* Reads the rows between the markers of the figure's file, which may have other
 * tables. */
static void read_figure_table(const struct recipe *r, struct table *t)
{
    static char line[TEXT];
    char path[256];
    bool has_begun = false, inside = false;
    FILE *file;

    snprintf(path, sizeof path, "tests/figures/%s.md", r->name);
    file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, "<!-- begin", 10) == 0)
            has_begun = true;
        if (strncmp(line, "<!-- end", 8) == 0)
            break;
        if (inside && *line == '|' && t->n < TABLE_ROWS)
            t->line[t->n++] = strdup(line);
        if (has_begun && strncmp(line, "|---", 4) == 0)
            inside = true;
    }
    if (file)
        fclose(file);
}

static void print_figure_table(const struct recipe *r, const struct table *t)
{
    for (int i = 0; i < r->n_columns; i++)
        printf("%s %s |", i ? "" : "|", r->column[i].title);
    printf("\n|");
    for (int i = 0; i < r->n_columns; i++)
        printf("---|");
    printf("\n");
    for (int i = 0; i < t->n; i++)
        puts(t->line[i]);
}

/* Replaces the table row with the same keys as LINE by LINE, or appends LINE.
 * No-op if LINE is NULL. */
static void replace_or_append_line(const struct recipe *r, struct table *t,
                                   char *line)
{
    for (int i = 0; i < t->n && line; i++)
        if (have_lines_same_key_columns(r, t->line[i], line)) {
            t->line[i] = line;
            return;
        }
    if (line && t->n < TABLE_ROWS)
        t->line[t->n++] = line;
}

/* ------------------------------------------------------------------- quick */

/* Compares the numbers in CELL with those metrics of the row that have a
 * tolerance. Returns whether all differences are within tolerance. */
static bool compare_cell_numbers(const struct recipe *r,
                                 const struct recipe_column *column,
                                 const char *cell, const char *json)
{
    bool fine = true;

    for (const char *at = strchr(column->cell, '{'); at;
         at = strchr(at + 1, '{')) {
        const size_t length = strcspn(at + 1, "%}");
        const char *const tilde = at + strcspn(at, "~}");
        const double x = find_json_metric(json, at + 1, length);
        char *end;
        double was;

        cell += strcspn(cell, "0123456789-");
        was = strtod(cell, &end);
        if (*tilde == '~' && !(fabs(x - was) <= strtod(tilde + 1, NULL))) {
            fprintf(stderr,
                    "glint-measure: %s: %.*s is %g, in the table %g, "
                    "tolerance %g\n",
                    r->name, (int)length, at + 1, x, was,
                    strtod(tilde + 1, NULL));
            fine = false;
        }
        cell = end;
    }
    return fine;
}

/* Compares the metrics JSON with the row of the table that has the same
 * keys. Returns whether all are within tolerance. */
static bool compare_row_with_table(const struct recipe *r,
                                   const struct recipe_row *row,
                                   const struct table *t, const char *json)
{
    char *const line = make_table_line(r, row, json, false);
    char cell[256];
    bool fine = true;

    for (int i = 0; i < t->n; i++) {
        if (!line || !have_lines_same_key_columns(r, t->line[i], line))
            continue;
        for (int k = 0; k < r->n_columns; k++) {
            copy_table_cell(t->line[i], k, cell);
            fine = compare_cell_numbers(r, &r->column[k], cell, json) && fine;
        }
        printf("%s %s: %s\n", fine ? "ok" : "FAIL", r->name, line);
        free(line);
        return fine;
    }
    printf("FAIL %s: not in the table: %s\n", r->name, line ? line : "");
    free(line);
    return false;
}

static bool is_row_in_quick_run(const struct recipe *r,
                                const struct recipe_row *row)
{
    for (int i = 0; i < r->n_quick; i++)
        if (recipe_row_has_parameter(row, r->quick[i]))
            return true;
    return false;
}

/* ----------------------------------------------------------------- running */

/* If some rows have ASSIGNMENT, removes all other rows; else applies it to all
 * rows. */
static void select_rows_by_assignment(struct recipe *r, const char *assignment)
{
    int n = 0;

    for (int i = 0; i < r->n_rows; i++)
        n += recipe_row_has_parameter(&r->row[i], assignment);
    for (int i = 0; i < r->n_rows && n == 0; i++)
        if (r->row[i].n < ROW_PARAMETERS)
            r->row[i].set[r->row[i].n++] = assignment;
    for (int i = 0, kept = 0; i < r->n_rows && n > 0; i++)
        if (recipe_row_has_parameter(&r->row[i], assignment))
            r->row[kept++] = r->row[i];
    r->n_rows = n > 0 ? n : r->n_rows;
}

/* Measures the rows of R; QUICK: only those listed for --quick. Returns an exit
 * code. */
static int measure_recipe(struct recipe *r, const char *self, bool quick)
{
    static char json[TEXT];
    struct table t = {.n = 0};
    int code = EXIT_OK, bad = 0;

    read_figure_table(r, &t);
    for (int i = 0; i < r->n_rows && code == EXIT_OK; i++) {
        if (quick && !is_row_in_quick_run(r, &r->row[i]))
            continue;
        code = measure_row_to_json(r, &r->row[i], self, json);
        if (code > EXIT_OK)
            break;
        append_csv_line(r, &r->row[i], json);
        if (quick)
            bad += !compare_row_with_table(r, &r->row[i], &t, json);
        else
            replace_or_append_line(
                r, &t, make_table_line(r, &r->row[i], json, code == -1));
        code = EXIT_OK;
    }
    if (code == EXIT_OK && !quick)
        print_figure_table(r, &t);
    for (int i = 0; i < t.n; i++)
        free(t.line[i]);
    return code == EXIT_OK && bad ? EXIT_RUNTIME : code;
}

static char *read_recipes(void)
{
    FILE *const file = fopen(RECIPES, "r");
    char *const text = calloc(1, 1 << 16);

    if (!file || !text || fread(text, 1, (1 << 16) - 1, file) == 0)
        fprintf(stderr, "glint-measure: cannot read %s\n", RECIPES);
    if (file)
        fclose(file);
    return text;
}

int main(int argc, char **argv)
{
    static struct recipe r;
    char *text;
    int code = EXIT_OK;

    if (argc > 1 && strcmp(argv[1], "--row") == 0)
        return measure_row(argc - 2, argv + 2);
    if (argc < 2 || !(text = read_recipes())) {
        fprintf(stderr, "usage: glint-measure FIGURE [PARAMETER=VALUE...] | "
                        "--quick | --row PARAMETER=VALUE...\n");
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--quick") == 0) {
        for (char *at = text; (at = recipe_parse(&r, at, NULL));) {
            const int one = measure_recipe(&r, argv[0], true);

            code = code == EXIT_OK ? one : code;
        }
        return code;
    }
    if (!recipe_parse(&r, text, argv[1])) {
        fprintf(stderr, "glint-measure: no rows of %s in %s\n", argv[1],
                RECIPES);
        return EXIT_USAGE;
    }
    for (int i = 2; i < argc; i++)
        select_rows_by_assignment(&r, argv[i]);
    return measure_recipe(&r, argv[0], false);
}
