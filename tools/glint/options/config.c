/* SPDX-License-Identifier: MIT */
#include "options/config.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#define MAX_BYTES (1 << 20) /* max size of a file */

static const char malformed[] = "is neither [section] nor name = value";

struct entry {
    int line;
    const struct option *option;
    const char *value;
};

struct entries {
    struct config *config;
    struct entry *entry;
    int n;
};

static bool has_control_character(const char *text)
{
    for (; *text; text++)
        if (((unsigned char)*text < ' ' && *text != '\t') || *text == 127)
            return true;
    return false;
}

/* Removes a comment from LINE: a ; after a blank, and all text behind it. */
static void remove_comment(char *line)
{
    for (char *at = line + 1; at[-1] && *at; at++)
        if (*at == ';' && (at[-1] == ' ' || at[-1] == '\t'))
            *at = '\0';
}

static void warn_of_unknown_section(const struct config *config,
                                    const char *section)
{
    static const char *const known[] = {"",      "camera", "lens", "light",
                                        "flare", "output", NULL};

    if (!config->tool->quiet && tool_find_word_index(section, known) < 0)
        fprintf(stderr,
                "glint %s: %s:%d: the section [%s] is unknown, but its lines "
                "are used\n",
                config->tool->name, config->lines.name, config->lines.number,
                section);
}

/* Returns the option NAME. Returns NULL if the option does not exist or is not
 * allowed in files: options for help and version, and a further configuration
 * file. */
static const struct option *find_option(const struct config *config,
                                        const char *name)
{
    static const char *const line_only[] = {"help", "version", "config", NULL};
    const struct option *o = config->options;

    if (tool_find_word_index(name, line_only) >= 0)
        return NULL;
    while (o->name && strcmp(o->name, name) != 0)
        o++;
    return o->name ? o : NULL;
}

/* Appends the entry NAME = VALUE to E. Returns NULL or an error message. */
static const char *add_entry(struct entries *e, const char *name,
                             const char *value)
{
    const struct option *const option = find_option(e->config, name);
    struct text_lines *const lines = &e->config->lines;
    const bool is_flag = option && option->has_arg == no_argument;
    struct entry *more;

    if (!option)
        return text_lines_format_cause(
            lines, "%.100s is not an option of configuration files", name);
    if (option->has_arg == required_argument && !*value)
        return text_lines_format_cause(lines, "%s needs a value", name);
    if (is_flag && strcmp(value, "yes") != 0 && strcmp(value, "no") != 0)
        return text_lines_format_cause(lines, "%s accepts yes or no", name);
    for (int i = 0; i < e->n && is_flag; i++)
        if (e->entry[i].option == option)
            return text_lines_format_cause(lines, "%s is set twice", name);
    more = text_grow_array(e->entry, e->n, sizeof *more);
    if (!more)
        return text_no_memory;
    e->entry = more;
    more[e->n++] = (struct entry){lines->number, option, value};
    return NULL;
}

static const char *parse_config_line(struct entries *e, char *line)
{
    char *end;

    if (*line == ';')
        return NULL;
    if (has_control_character(line))
        return "contains a control character";
    remove_comment(line);
    end = *line == '[' ? strchr(line, ']') : strpbrk(line, "=:");
    if (!end)
        return malformed;
    *end = '\0';
    if (*line != '[')
        return add_entry(e, text_trim_blanks(line), text_trim_blanks(end + 1));
    warn_of_unknown_section(e->config, line + 1);
    return NULL;
}

/* Applies ENTRY. Returns an exit code. */
static int apply_entry(const struct config *config, const struct entry *entry,
                       struct glint_error *error)
{
    const bool is_flag = entry->option->has_arg == no_argument;
    char where[PATH_MAX + 16];
    int code;

    if (is_flag && strcmp(entry->value, "no") == 0)
        return EXIT_OK;
    snprintf(where, sizeof where, "%s:%d", config->lines.name, entry->line);
    config->tool->where = where;
    code =
        config->take(config->ctx, entry->option, is_flag ? NULL : entry->value);
    config->tool->where = NULL;
    if (code != EXIT_OK)
        return code < 0 ? EXIT_OK : code;
    /* The option ends the command, such as --list-devices. */
    glint_error_report(error, GLINT_E_FORMAT, where,
                       "%s is an option of the command line only",
                       entry->option->name);
    return EXIT_INPUT;
}

int config_parse(struct config *config, const char *name, const char *text,
                 size_t bytes, struct glint_error *error)
{
    struct text_lines *const lines = &config->lines;
    struct entries e = {.config = config};
    enum glint_status status = text_lines_open(lines, name, text, bytes, error);
    const char *cause = NULL;
    char *line;
    int code;

    while (status == GLINT_OK && !cause && (line = text_lines_read_next(lines)))
        cause = parse_config_line(&e, line);
    if (cause)
        status = text_lines_report_error(lines, error, cause);
    code = status == GLINT_OK                                    ? EXIT_OK
           : status == GLINT_E_MEMORY || cause == text_no_memory ? EXIT_RUNTIME
                                                                 : EXIT_INPUT;
    if (code == EXIT_OK)
        error->text[0] = '\0';
    for (int i = 0; i < e.n && code == EXIT_OK; i++)
        code = apply_entry(config, &e.entry[i], error);
    free(e.entry);
    return code;
}

int config_read(struct config *config, const char *path)
{
    struct glint_error error;
    const int code = config_parse(config, path, NULL, MAX_BYTES, &error);

    if (code != EXIT_OK && error.text[0])
        fprintf(stderr, "glint %s: %s\n", config->tool->name, error.text);
    if (code != EXIT_OK)
        config_free(config);
    return code;
}

void config_free(struct config *config)
{
    text_lines_close(&config->lines);
}
