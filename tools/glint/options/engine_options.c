/* SPDX-License-Identifier: MIT */
#include "options/engine_options.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static bool has_option_group(const struct tool *tool,
                             enum glint_option_group group)
{
    return (tool->groups >> group & 1) != 0;
}

int engine_apply_option(const struct tool *tool, struct glint_options *values,
                        int code, const char *value)
{
    const struct glint_option *const row = glint_option(code - ENGINE_OPTION);
    struct glint_error error;

    if (!row)
        return -2;
    if (row->type != GLINT_OPTION_FLAG && !*value)
        return tool_report_bad_value(tool, row->name, value);
    return glint_options_set_text(values, row->name, value, &error) == GLINT_OK
               ? -1
               : tool_report_bad_value(tool, row->name, value);
}

/* -------------------------------------------------------------------- help */

enum { ABOUT_COLUMN = 22, LINE = 79 };

/* Buffer of a help text that is written line by line */
struct page {
    char *at, *end;
    int column;
};

static void write_help_text(struct page *page, const char *text, size_t n)
{
    for (; n > 0 && page->at < page->end; n--, text++) {
        page->column = *text == '\n' ? 0 : page->column + 1;
        *page->at++ = *text;
    }
    *page->at = '\0';
}

static void write_help_blanks(struct page *page, int column)
{
    while (page->column < column && page->at < page->end)
        write_help_text(page, " ", 1);
}

static void write_explanation_words(struct page *page, const char *text)
{
    while (*text) {
        const size_t n = strcspn(text, " ");

        if (page->column + 1 + (int)n > LINE)
            write_help_text(page, "\n", 1);
        else if (page->column > ABOUT_COLUMN)
            write_help_text(page, " ", 1);
        write_help_blanks(page, ABOUT_COLUMN);
        write_help_text(page, text, n);
        text += n + (text[n] == ' ');
    }
}

/* Sets VALUE and TEXT to the default of row I of the option table. VALUE is NAN
 * and TEXT is NULL if the default has not this type or does not exist. */
static void find_option_default(const struct glint_options *defaults, int i,
                                double *value, const char **text)
{
    *value = NAN;
    *text = NULL;
    switch (i) {
#define GLINT_ROW_REAL(member, ...) \
    case GLINT_OPTION_OF_##member:  \
        *value = defaults->member;  \
        break;
#define GLINT_ROW_INTEGER(member, ...) GLINT_ROW_REAL(member, )
#define GLINT_ROW_WORD(member, ...)    GLINT_ROW_REAL(member, )
#define GLINT_ROW_FLAG(member, ...)
#define GLINT_ROW_TEXT(member, ...) \
    case GLINT_OPTION_OF_##member:  \
        *text = defaults->member;   \
        break;
#include "glint/options.inc"
    }
    if (isnan(glint_option(i)->initial))
        *value = NAN;
}

/* Returns the text that begins a range with the lower limit LOW: "LOW to ", or
 * "above 0, up to " if LOW is above 0 but below 1e-5. START is memory for it.
 */
static const char *format_range_start(double low, char start[32])
{
    if (low > 0 && low < 1e-5)
        return "above 0, up to ";
    snprintf(start, 32, "%.10g to ", low);
    return start;
}

/* Writes "(LOW to HIGH, default VALUE)" for row I of the option table. Omits
 * values that the row's help text states already. */
static void write_option_limits(struct page *page,
                                const struct glint_options *defaults, int i)
{
    const struct glint_option *const row = glint_option(i);
    const bool is_number =
        row->type == GLINT_OPTION_REAL || row->type == GLINT_OPTION_INTEGER;
    const char *word = row->accepts, *text;
    char range[64] = "", all[160], start[32], text_in_brackets[164];
    double value;

    find_option_default(defaults, i, &value, &text);
    if (is_number && row->high < INT_MAX)
        snprintf(range, sizeof range, "%s%.10g",
                 format_range_start(row->low, start), row->high);
    snprintf(all, sizeof all, "%s", range);
    if (!strstr(row->help, "default")) {
        const char *const comma = *range ? ", " : "";

        if (text)
            snprintf(all, sizeof all, "%s%sdefault %s", range, comma, text);
        else if (is_number && !isnan(value))
            snprintf(all, sizeof all, "%s%sdefault %g", range, comma, value);
        else if (row->type == GLINT_OPTION_WORD && value >= 0) {
            for (int k = 0; k < (int)value; k++)
                word += strcspn(word, "|") + 1;
            snprintf(all, sizeof all, "default %.*s", (int)strcspn(word, "|"),
                     word);
        }
    }
    if (*all) {
        snprintf(text_in_brackets, sizeof text_in_brackets, "(%s)", all);
        write_explanation_words(page, text_in_brackets);
    }
}

static void write_option_row(struct page *page, const struct tool *tool, int i)
{
    const struct glint_option *const row = glint_option(i);
    char text[96];

    snprintf(text, sizeof text, "  --%s%s%s", row->name, *row->value ? " " : "",
             row->value);
    write_help_text(page, text, strlen(text));
    write_help_blanks(page, page->column < ABOUT_COLUMN - 1 ? ABOUT_COLUMN
                                                            : page->column + 2);
    write_explanation_words(page, row->help);
    write_option_limits(page, tool->defaults, i);
    write_help_text(page, "\n", 1);
}

void engine_write_help(const struct tool *tool, char text[ENGINE_HELP_BYTES])
{
    static const char *const headings[GLINT_OPTION_GROUPS] = {
        "Lamps and layers\n",  "Artist controls\n", "Scenes\n",
        "Shading of scenes\n", "The lens\n",        "Brightness\n",
        "Speed and accuracy\n"};
    struct page page = {text, text + ENGINE_HELP_BYTES - 1, 0};
    const struct glint_option *row;

    text[0] = '\0';
    for (int group = 0; group < GLINT_OPTION_GROUPS; group++) {
        if (!has_option_group(tool, (enum glint_option_group)group))
            continue;
        write_help_text(&page, headings[group], strlen(headings[group]));
        for (int i = 0; (row = glint_option(i)) != NULL; i++)
            if ((int)row->group == group)
                write_option_row(&page, tool, i);
    }
}
