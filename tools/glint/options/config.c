/* SPDX-License-Identifier: MIT
 *
 * Reads a configuration file. It splits the text into lines and passes them to
 * inih one by one, because inih would split long lines in two and treat an
 * indented line as a continuation of the previous value.
 */
#include "options/config.h"

#include <stdlib.h>
#include <string.h>

#include <ini.h>

#include "posix/error.h"
#include "posix/input.h"
#include "options/command_line.h"

#define MAX_BYTES   (1 << 20) /* max size of a file, bytes */
#define MAX_OPTIONS 256       /* max number of options of a command */
#define NAME_CHARS  100       /* max bytes of a file name in errors */

/* State of a pass over the file. The first pass checks all lines, the second
 * one applies them. */
struct pass {
    struct config *config;
    bool taking;
    const char *name;
    const char *at, *end; /* unread part of the text */
    int line, section_line;
    char section[64];            /* section of the previous entry */
    char where[NAME_CHARS + 32]; /* "FILE:LINE" */
    char *value;                 /* next free byte of config->values */
    bool stated[MAX_OPTIONS];
    int code; /* exit code; EXIT_OK: no error so far */
    struct glint_error *error;
};

/* Sets WHERE to "FILE:LINE". Of a long file name only the end is used. */
static void set_error_location(struct pass *p, int line)
{
    const size_t len = strlen(p->name);

    snprintf(p->where, sizeof p->where, "%s:%d",
             p->name + (len > NAME_CHARS ? len - NAME_CHARS : 0), line);
}

/* Sets the error message to FORMAT, whose %s is replaced by ABOUT, and ends the
 * pass. Returns 0, by which inih stops. */
static int report_config_error(struct pass *p, const char *format,
                               const char *about)
{
    char cause[160];

    snprintf(cause, sizeof cause, format, about);
    set_error_location(p, p->line);
    glint_error_report(p->error, GLINT_E_FORMAT, p->where, "%s", cause);
    p->code = EXIT_INPUT;
    return 0;
}

/* -------------------------------------------------------------------- lines */

static bool is_blank_character(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static bool is_text_option(const char *text, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (((unsigned char)text[i] < ' ' && text[i] != '\t') || text[i] == 127)
            return false;
    return true;
}

/* Sets LINE to the next line, without blanks around it. Returns its length. */
static size_t read_next_line(struct pass *p, const char **line)
{
    const char *const feed = memchr(p->at, '\n', (size_t)(p->end - p->at));
    const char *first = p->at, *last = feed ? feed : p->end;

    p->at = feed ? feed + 1 : p->end;
    p->line++;
    while (first < last && is_blank_character(*first))
        first++;
    while (first < last && is_blank_character(last[-1]))
        last--;
    *line = first;
    return (size_t)(last - first);
}

/* Reads a line for inih, which calls this function like fgets(). A comment
 * becomes an empty line. */
static char *read_line_for_inih(char *dst, int size, void *stream)
{
    struct pass *const p = stream;
    const char *line;
    size_t n;

    if (p->code != EXIT_OK || p->at == p->end)
        return NULL;
    n = read_next_line(p, &line);
    if (n > 0 && (*line == ';' || *line == '#'))
        n = 0;
    if (n > 0 && *line == '[')
        p->section_line = p->line;
    if (!is_text_option(line, n))
        return report_config_error(p, "contains a control character%s", ""),
               NULL;
    if (n > CONFIG_LINE || n + 2 > (size_t)size)
        return report_config_error(p, "has a line that is too long%s", ""),
               NULL;
    memcpy(dst, line, n);
    memcpy(dst + n, "\n", 2);
    return dst;
}

/* ------------------------------------------------------------------ entries */

static void record_section(struct pass *p, const char *section)
{
    static const char *const known[] = {"",      "camera", "lens", "light",
                                        "flare", "output", NULL};

    if (strcmp(section, p->section) == 0)
        return;
    snprintf(p->section, sizeof p->section, "%s", section);
    if (p->taking || p->config->tool->quiet ||
        tool_find_word_index(section, known) >= 0)
        return;
    set_error_location(p, p->section_line);
    fprintf(
        stderr,
        "glint %s: %s: the section [%s] is unknown, but its lines are used\n",
        p->config->tool->name, p->where, section);
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

static int check_config_entry(struct pass *p, const struct option *option,
                              const char *value)
{
    const ptrdiff_t index = option - p->config->options;

    if (option->has_arg == required_argument && !*value)
        return report_config_error(p, "%s needs a value", option->name);
    if (option->has_arg != no_argument)
        return 1;
    if (strcmp(value, "yes") != 0 && strcmp(value, "no") != 0)
        return report_config_error(p, "%s accepts yes or no", option->name);
    if (index < MAX_OPTIONS && p->stated[index])
        return report_config_error(p, "%s is set twice", option->name);
    if (index < MAX_OPTIONS)
        p->stated[index] = true;
    return 1;
}

/* Applies OPTION with a copy of VALUE, whose memory inih uses again. */
static int apply_config_entry(struct pass *p, const struct option *option,
                              const char *value)
{
    const bool plain = option->has_arg == no_argument;
    const size_t bytes = strlen(value) + 1;
    struct tool *const tool = p->config->tool;
    int code = -1;

    if (plain && strcmp(value, "no") == 0)
        return 1;
    memcpy(p->value, value, bytes);
    set_error_location(p, p->line);
    tool->where = p->where;
    code = p->config->take(p->config->ctx, option, plain ? NULL : p->value);
    tool->where = NULL;
    p->value += bytes;
    if (code ==
        EXIT_OK) /* The option ends the command, such as --list-devices. */
        return report_config_error(
            p, "%s is an option of the command line only", option->name);
    if (code > 0)
        p->code = code;
    return code < 0;
}

static int handle_config_entry(void *ctx, const char *section, const char *name,
                               const char *value)
{
    struct pass *const p = ctx;
    const struct option *option;

    if (p->code != EXIT_OK)
        return 0;
    record_section(p, section);
    option = find_option(p->config, name);
    if (!option)
        return report_config_error(
            p, "%s is not an option of configuration files", name);
    return p->taking ? apply_config_entry(p, option, value)
                     : check_config_entry(p, option, value);
}

/* ------------------------------------------------------------------- passes */

static void run_config_parser_pass(struct pass *p, const char *text,
                                   size_t bytes)
{
    int malformed;

    p->at = text;
    p->end = text + bytes;
    p->line = 0;
    p->section[0] = '\0';
    malformed = ini_parse_stream(read_line_for_inih, p, handle_config_entry, p);
    if (malformed > 0 && (p->code == EXIT_OK || malformed < p->line)) {
        p->line = malformed;
        report_config_error(p, "is neither [section] nor name = value%s", "");
    }
}

int config_parse(struct config *config, const char *name, const char *text,
                 size_t bytes, struct glint_error *error)
{
    static const char mark[] =
        "\xef\xbb\xbf"; /* UTF-8 byte order mark, which some editors write */
    struct pass p = {.config = config, .name = name, .error = error};

    error->text[0] = '\0';
    if (bytes >= 3 && memcmp(text, mark, 3) == 0) {
        text += 3;
        bytes -= 3;
    }
    run_config_parser_pass(&p, text, bytes);
    if (p.code != EXIT_OK)
        return p.code;
    /* Each value is shorter than its line, so all values fit into BYTES. */
    p.value = config->values = malloc(bytes + 1);
    if (!p.value) {
        glint_error_report(error, GLINT_E_MEMORY, name, "no memory for it");
        return EXIT_RUNTIME;
    }
    p.taking = true;
    run_config_parser_pass(&p, text, bytes);
    return p.code;
}

int config_read(struct config *config, const char *path)
{
    struct glint_error error;
    uint8_t *text = NULL;
    size_t bytes = 0;
    int code = EXIT_INPUT;

    if (glint_input_read_whole_file(&text, &bytes, path, MAX_BYTES, &error) ==
        GLINT_OK)
        code = config_parse(config, path, (const char *)text, bytes, &error);
    free(text);
    if (code != EXIT_OK && error.text[0])
        fprintf(stderr, "glint %s: %s\n", config->tool->name, error.text);
    if (code != EXIT_OK)
        config_free(config);
    return code;
}

void config_free(struct config *config)
{
    free(config->values);
    config->values = NULL;
}
