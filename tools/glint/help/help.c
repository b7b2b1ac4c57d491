/* SPDX-License-Identifier: MIT */
#include "help/help.h"

#include <stdio.h>
#include <string.h>

enum { NAME_CHARS = 48, ABOUT = 22 /* column at which descriptions begin */ };

/* The most common options of each command with a help text longer than
 * HELP_SCREEN lines. Without --help-all only these are printed. */
static const struct {
    /* option names, each with a blank before and after */
    const char *command, *options;
} usual[] = {
    {"overlay", " output lens light-at strength layer style scene f-number "
                "starburst quality "},
    {"live", " device output list-devices size fps lens strength style scene "
             "quality stats config "},
    {"render", " output size light lens f-number only starburst exposure gain "
               "quality "},
    {"explain", " output scene size save-ghosts top lens "
                "light-at quality "},
    {"bench", " size repeat quality rays "},
    {"styles", " output width lens light-at strength gain quality "},
};

void help_print_complete(const struct help *help)
{
    for (int i = 0; i < HELP_PARTS; i++)
        if (help->part[i])
            fputs(help->part[i], stdout);
}

static size_t get_help_line_length(const char *line)
{
    const size_t n = strcspn(line, "\n");

    return line[n] ? n + 1 : n;
}

/* Sets NAME to the long option at the beginning of LINE, " --name" or "  -x,
 * --name". Returns false if the line has none. */
static bool parse_option_name(const char *line, char name[NAME_CHARS])
{
    size_t n;

    if (strncmp(line, "  -", 3) != 0)
        return false;
    line += 2;
    if (line[1] != '-')
        line += strncmp(line + 2, ", ", 2) == 0 ? 4 : 0;
    if (strncmp(line, "--", 2) != 0)
        return false;
    n = strspn(line + 2, "abcdefghijklmnopqrstuvwxyz-");
    if (n == 0 || n >= NAME_CHARS)
        return false;
    memcpy(name, line + 2, n);
    name[n] = '\0';
    return true;
}

static bool is_continuation_line(const char *line)
{
    return strncmp(line, "          ", 10) == 0;
}

static int count_help_lines(const char *text)
{
    int n = 0;

    for (; *text; text += get_help_line_length(text))
        n++;
    return n;
}

static bool contains_option_name(const char *options, const char *name)
{
    char word[NAME_CHARS + 2];

    snprintf(word, sizeof word, " %s ", name);
    return strstr(options, word) != NULL;
}

/* Prints the lines of TEXT that describe OPTIONS. If INTRO, prints also the
 * lines above the first option. */
static void print_common_options(const char *text, const char *options,
                                 bool intro)
{
    char name[NAME_CHARS];
    bool shown = intro;

    for (; *text; text += get_help_line_length(text)) {
        if (parse_option_name(text, name))
            shown = contains_option_name(options, name);
        else if (!intro && !is_continuation_line(text))
            shown = false;
        if (parse_option_name(text, name))
            intro = false;
        if (shown)
            fwrite(text, 1, get_help_line_length(text), stdout);
    }
}

void help_print_screen(const struct help *help)
{
    const char *options = NULL;
    int lines = 0;

    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (strcmp(usual[i].command, help->command) == 0)
            options = usual[i].options;
    for (int i = 0; i < HELP_PARTS; i++)
        lines += help->part[i] ? count_help_lines(help->part[i]) : 0;
    if (!options || lines <= HELP_SCREEN) {
        help_print_complete(help);
        return;
    }
    for (int i = 0; i < HELP_PARTS; i++)
        if (help->part[i])
            print_common_options(help->part[i], options, i == 0);
    printf("  --help-all          all options\n");
}

/* ------------------------------------------------------------------ options */

static bool print_option_summary(const char *text, const char *name)
{
    char at[NAME_CHARS];

    for (; *text; text += get_help_line_length(text)) {
        size_t n = strcspn(text, "\n"), from = ABOUT;

        if (!parse_option_name(text, at) || strcmp(at, name) != 0)
            continue;
        while (from < n && (text[from - 1] != ' ' || text[from] == ' '))
            from++;
        if (from < n)
            fwrite(text + from, 1, n - from, stdout);
        return true;
    }
    return false;
}

void help_print_options(const struct help *help, const struct option *options)
{
    for (const struct option *o = options; o && o->name; o++) {
        printf("--%s%s\t", o->name, o->has_arg == required_argument ? "=" : "");
        for (int i = 0; i < HELP_PARTS; i++)
            if (help->part[i] && print_option_summary(help->part[i], o->name))
                break;
        putchar('\n');
    }
}
