/* SPDX-License-Identifier: MIT */
#include "model/table_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "model/lens_files.h"
#include "model/model_file.h"
#include "options/suggest.h"
#include "posix/ending.h"
#include "posix/error.h"
#include "posix/input.h"

static bool suggest_lens_name(void *suggest, const char *name)
{
    suggest_add_candidate(suggest, name, strlen(name));
    return true;
}

/* Lenses with similar names, collected for a message */
struct lens_matches {
    const char *word;
    int n;
    char text[400]; /* list of the names found: ", NAME, NAME or NAME" */
    size_t last;    /* offset of the last comma in TEXT */
};

static bool print_matching_lens(void *matches, const char *name)
{
    struct lens_matches *m = matches;
    const size_t at = strlen(m->text);

    if (!strstr(name, m->word) || at + strlen(name) + 8 > sizeof m->text)
        return true;
    m->last = at;
    m->n++;
    snprintf(m->text + at, sizeof m->text - at, ", %s", name);
    return true;
}

/* Prints the lenses whose names contain NAME, if there are several. Returns
 * their number, or 0 if NAME has fewer than three letters. */
static int print_matching_lenses(const struct tool *tool, const char *name)
{
    struct lens_matches m = {.word = name};

    if (strlen(name) >= 3)
        lens_files_visit_all(print_matching_lens, &m);
    if (m.n > 1)
        tool_error(
            tool,
            "%s: the names of %d lenses contain this (did you mean %.*s or %s)",
            name, m.n, (int)m.last - 2, m.text + 2, m.text + m.last + 2);
    return m.n;
}

void tool_report_unknown_lens(const struct tool *tool, const char *name)
{
    struct suggest s;

    if (access(name, F_OK) == 0) {
        tool_error(tool,
                   "%s: no lens that comes with glint has this name; for the "
                   "file write ./%s",
                   name, name);
        return;
    }
    if (print_matching_lenses(tool, name) > 1)
        return;
    suggest_begin(&s, name);
    lens_files_visit_all(suggest_lens_name, &s);
    tool_error(tool,
               "%s: neither a file nor a lens that comes with glint "
               "(%s%s)",
               name,
               suggest_find_best(&s) ? "did you mean "
                                     : "glint lenses lists them",
               suggest_find_best(&s) ? s.best : "");
}

/* Returns whether NAME is an existing lens file in a format of glint import. */
static bool is_importable_file(const char *name)
{
    static const char *const endings[] = {".zmx", ".seq", ".len", ".fx",
                                          ".xml"};
    bool is = false;

    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        is = is || glint_has_extension(name, endings[i]);
    return is && access(name, F_OK) == 0;
}

/* Reads the lens table FILE. If FILE is binary, such as an image, the error
 * message has no line and column. */
static enum glint_status parse_lens_table(const char *file,
                                          struct glint_prescription *lens,
                                          struct glint_error *error)
{
    enum glint_status status;
    uint8_t *text = NULL;
    size_t bytes = 0;

    status = glint_input_read_whole_file(&text, &bytes, file, 1 << 20, error);
    if (status == GLINT_E_UNSUPPORTED ||
        (status == GLINT_OK && bytes > 0 && memchr(text, 0, bytes)))
        status = glint_error_report(
            error, GLINT_E_FORMAT, file,
            "is not a lens table; glint lenses lists the installed ones");
    else if (status == GLINT_OK && bytes > 5 && memcmp(text, "name:", 5) == 0)
        status = glint_error_report(
            error, GLINT_E_FORMAT, file,
            "a lens file of FlareSim; glint import converts it");
    else if (status == GLINT_OK)
        status = glint_prescription_parse(lens, (const char *)text, bytes, file,
                                          error);
    free(text);
    return status;
}

const char *tool_find_lens_file(const struct tool *tool, const char *argument,
                                char *path, size_t bytes)
{
    if (is_importable_file(argument)) {
        tool_error(
            tool,
            "%s: a lens file of another program; glint import converts it",
            argument);
        return NULL;
    }
    if (tool_is_model(argument)) {
        tool_error(tool, "%s: a baked model; this command needs the lens table",
                   argument);
        return NULL;
    }
    if (tool_is_file_name(argument))
        return argument;
    if (lens_find_file(argument, path, bytes))
        return path;
    tool_report_unknown_lens(tool, argument);
    return NULL;
}

int tool_read_lens(const struct tool *tool, const char *argument,
                   struct glint_prescription *lens)
{
    struct glint_error error = {""};
    char path[1024];
    const char *file = tool_find_lens_file(tool, argument, path, sizeof path);
    enum glint_status status;

    if (!file)
        return EXIT_LENS;
    status = parse_lens_table(file, lens, &error);
    if (status == GLINT_OK) {
        if (error.text[0] && !tool->quiet)
            fprintf(stderr, "glint %s: warning: %s\n", tool->name, error.text);
        return EXIT_OK;
    }
    if (status == GLINT_E_LENS && !glint_has_extension(file, ".lens"))
        tool_error(tool, "%s; glint import reads lens files of other programs",
                   error.text);
    else
        tool_fail(tool, status, error.text);
    return status == GLINT_E_MEMORY ? EXIT_RUNTIME : EXIT_LENS;
}
