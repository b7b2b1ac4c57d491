/* SPDX-License-Identifier: MIT
 *
 * glint import: converts lens files of other programs to lens tables.
 */
#include <stdlib.h>
#include <string.h>

#include "overlay/apart.h"
#include "import/imported.h"
#include "help/values.h"
#include "posix/input.h"
#include "posix/output.h"

static const char help[] =
    "glint import FILE -o NAME.lens [--strict] [--format F]\n"
    "             [--film WxH] [--f-number N] [--position N] [--lens KEY]\n"
    "\n"
    "Converts a lens file of another program to a lens table: Zemax\n"
    ".zmx (sequential; STANDARD, EVENASPH; text or UTF-16), CODE V .seq,\n"
    "OSLO .len, pbrt .dat, FlareSim .lens, realflare .json, OpenLensFlare "
    ".xml,\n"
    "polyflare .fx, PhotonsToPhotos' Optical Bench .txt. Lengths become\n"
    "millimetres. A glass becomes that of the catalogue (lenses/README.md), or "
    "the\n"
    "nd and Vd of the file. Each guess and omission is reported with its line "
    "and\n"
    "listed at the top of the table.\n"
    "\n"
    "  -o, --output FILE   the .lens, or - for standard output\n"
    "  --strict            list what would be guessed or left out, and reject "
    "the\n"
    "                      file if there is any\n"
    "  --format F          zmx, seq, oslo, pbrt, flaresim, realflare, lentil,\n"
    "                      openlensflare, polyflare or opticalbench (default: "
    "by\n"
    "                      the suffix of the name)\n"
    "  --film WxH          film in mm (default: from the field of the file)\n"
    "  --f-number N        f-number (default: that of the file)\n"
    "  --position N        position of a zoom lens, from 1 (default: the "
    "first)\n"
    "  --lens KEY          lens in a file of several (lenses.json of lentil)\n";

static const char help_end[] = COMMON_HELP;

struct import {
    struct imported lens;
    const struct import_format *format;
    const char *output;
    bool strict;
    int position;
    const char *key;
    double film_mm[2], f_number;
};

static bool parse_import_format(struct import *o, const char *value)
{
    for (int k = 0; (o->format = import_get_format(k)) != NULL; k++)
        if (strcmp(o->format->name, value) == 0)
            return true;
    return false;
}

static bool parse_film_size(struct import *o, const char *value)
{
    const char *by = strchr(value, 'x');
    char width[24];

    if (!by || by - value >= (ptrdiff_t)sizeof width)
        return false;
    memcpy(width, value, (size_t)(by - value));
    width[by - value] = '\0';
    return tool_parse_number(width, &o->film_mm[0]) &&
           tool_parse_number(by + 1, &o->film_mm[1]) && o->film_mm[0] >= 0.1 &&
           o->film_mm[1] >= 0.1 && o->film_mm[0] <= 1000 &&
           o->film_mm[1] <= 1000;
}

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct import *o = ctx;
    bool good = true;

    if (c == 'o')
        o->output = value;
    else if (c == 's')
        o->strict = true;
    else if (c == 'F')
        good = parse_import_format(o, value);
    else if (c == 'm')
        good = parse_film_size(o, value);
    else if (c == 'f')
        good = tool_parse_number(value, &o->f_number) && o->f_number >= 0.5 &&
               o->f_number <= 1000;
    else if (c == 'p')
        good = tool_parse_integer(value, 1, 16, &o->position);
    else if (c == 'k')
        o->key = value;
    else
        return tool_apply_option(tool, c, value);
    return good ? -1 : -2;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct import *o)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"strict", no_argument, NULL, 's'},
        {"format", required_argument, NULL, 'F'},
        {"film", required_argument, NULL, 'm'},
        {"f-number", required_argument, NULL, 'f'},
        {"position", required_argument, NULL, 'p'},
        {"lens", required_argument, NULL, 'k'},
        TOOL_COMMON_OPTIONS};
    struct apart files = {.n_read = 0};
    int code = tool_parse_options(
        tool, argc, argv, TOOL_COMMON_SHORT "o:", options, parse_option, o);

    if (code < 0)
        code = tool_check_inputs(tool, argc, argv, 1, "expects one file");
    if (code >= 0)
        return code;
    if (!o->output)
        return tool_usage(tool, "needs -o, a .lens");
    if (!o->format)
        o->format = import_find_format(argv[optind]);
    if (!o->format)
        return tool_usage(tool,
                          "%s: the suffix is not that of one lens format; "
                          "choose --format %s",
                          argv[optind], values_describe("import", "format"));
    file_conflicts_add_input(&files, NULL, argv[optind]);
    file_conflicts_add_output(&files, "-o", o->output);
    code = file_conflicts_check_outputs(tool, &files);
    if (code == EXIT_OK)
        code = tool_check_output(tool, o->output);
    return code == EXIT_OK ? -1 : code;
}

/* Sets NAME to the name of the file PATH, reduced to the characters allowed
 * in lens names. */
static void set_lens_name(char name[GLINT_NAME_BYTES], const char *path)
{
    const char *stem = strrchr(path, '/');
    const char *end;
    size_t n = 0;

    stem = stem ? stem + 1 : path;
    end = strrchr(stem, '.');
    if (!end || end == stem)
        end = stem + strlen(stem);
    for (; stem < end && n < GLINT_NAME_BYTES - 1; stem++) {
        const char c =
            *stem >= 'A' && *stem <= 'Z' ? (char)(*stem - 'A' + 'a') : *stem;

        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
            name[n++] = c;
        else if (n > 0 && name[n - 1] != '-')
            name[n++] = '-';
    }
    while (n > 0 && name[n - 1] == '-')
        n--;
    if (n == 0)
        memcpy(name, "lens", n = 4);
    name[n] = '\0';
}

/* Prints all notes of the import. If --strict rejects the lens, prints only
 * notes about guessed values. */
static void print_import_notes(const struct tool *tool,
                               const struct imported *lens)
{
    const bool refused = lens->strict && lens->n_guesses > 0;

    if (tool->quiet && !refused)
        return;
    for (int k = 0; k < lens->n_notes && k < IMPORT_NOTES; k++) {
        const struct imported_note *const note = &lens->note[k];

        if (refused && !note->guess)
            continue;
        if (note->line > 0)
            fprintf(stderr, "%s:%d: %s\n", lens->file, note->line, note->text);
        else
            fprintf(stderr, "%s: %s\n", lens->file, note->text);
    }
    if (lens->n_notes > IMPORT_NOTES)
        fprintf(stderr, "%s: and %d more\n", lens->file,
                lens->n_notes - IMPORT_NOTES);
}

static void print_import_json(const struct imported *lens,
                              const struct glint_prescription *read)
{
    struct json_writer json = {.to = stdout};
    struct glint_optics optics;

    glint_optics_of(read, &optics);
    json_write(&json,
               "{name: %s, focal_length_mm: %.6f, back_focal_length_mm: %.6f, "
               "f_number: %g, film_mm: [%g, %g], surfaces: %d, notes: [",
               read->name, optics.focal_mm, optics.back_focal_mm,
               read->f_number, read->film_width_mm, read->film_height_mm,
               read->n_surfaces);
    for (int k = 0; k < lens->n_notes && k < IMPORT_NOTES; k++)
        json_write(&json, "{line: %d, text: %s}", lens->note[k].line,
                   lens->note[k].text);
    json_write(&json, "]}\n");
}

static int save_lens_table(const struct tool *tool, const struct import *o,
                           const char *text, size_t bytes)
{
    struct glint_prescription read;
    struct glint_error error = {""};
    char name[160];
    enum glint_status status;
    int code;

    snprintf(name, sizeof name, "%.120s as a table", o->lens.file);
    status = glint_prescription_parse(&read, text, bytes, name, &error);
    if (status != GLINT_OK) {
        tool_fail(tool, status, error.text);
        return EXIT_INPUT;
    }
    code = tool_save_file(tool, o->output, GLINT_OUTPUT_TEXT, text, bytes);
    if (code == EXIT_OK && tool->json)
        print_import_json(&o->lens, &read);
    return code;
}

static int import_lens_file(struct tool *tool, struct import *o,
                            const char *path)
{
    struct glint_error error = {""};
    enum glint_status status;
    uint8_t *data = NULL;
    size_t bytes = 0;
    char *text;
    int code;

    status = glint_input_read_whole_file(&data, &bytes, path, 1 << 22, &error);
    if (status != GLINT_OK) {
        free(data);
        return tool_fail(tool, status, error.text);
    }
    imported_init(&o->lens, path, o->strict);
    set_lens_name(o->lens.name, strcmp(o->output, "-") == 0 ? path : o->output);
    memcpy(o->lens.film_mm, o->film_mm, sizeof o->film_mm);
    o->lens.f_number_given = o->f_number;
    o->lens.position = o->position;
    o->lens.key = o->key;
    text = import_parse_file(&o->lens, o->format, data, &bytes);
    free(data);
    imported_sort_notes(&o->lens);
    print_import_notes(tool, &o->lens);
    if (!text) {
        fprintf(stderr, "glint import: %s\n", o->lens.error);
        return EXIT_INPUT;
    }
    code = save_lens_table(tool, o, text, bytes);
    free(text);
    return code;
}

int cmd_import(int argc, char **argv)
{
    struct tool tool = {.name = "import", .help = help, .help_end = help_end};
    struct import *o = calloc(1, sizeof *o);
    int code;

    if (!o)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    code = parse_options(&tool, argc, argv, o);
    if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = import_lens_file(&tool, o, argv[optind]);
        tool_stop_threads(&tool);
    }
    free(o);
    return code;
}
