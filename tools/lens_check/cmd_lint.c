/* SPDX-License-Identifier: MIT
 *
 * glint lint: what patents and copies misprint.
 */
#include <stdlib.h>
#include <string.h>

#include "lens_check/one_digit.h"
#include "model/table_file.h"
#include "options/json_writer.h"
#include "model/settings.h"
#include "options/command_line.h"
#include "options/tool.h"
#include "posix/input.h"

static const char help[] =
    "glint lint LENS\n"
    "\n"
    "Looks for misprints in a table: rims that overlap, nd and Vd that no\n"
    "glass has, one nd with two Vd, focal lengths that are not the stated\n"
    "ones, and whatever else refuses it. Then it tries each number with one\n"
    "slip undone (a sign, two digits that changed places, a wrong digit, a\n"
    "decimal point) and proposes those after which the table is right, the\n"
    "likeliest first. Exit code 5 if something is wrong.\n"
    "\n"
    "Stated values decide: give focal-length and back-focal-length both.\n";

static const char help_end[] = COMMON_HELP;

static const char *slip_name(enum slip slip)
{
    return slip == SLIP_SIGN    ? "sign"
           : slip == SLIP_SWAP  ? "digits swapped"
           : slip == SLIP_DIGIT ? "digit"
                                : "decimal point";
}

static void print_text(const char *file, const char *wrong,
                       const struct mend *mend, int n)
{
    if (!*wrong) {
        printf("%s: nothing found\n", file);
        return;
    }
    puts(wrong);
    if (n == 0)
        puts("no single slip, undone, makes it right");
    for (int k = 0; k < n && k < MENDS; k++)
        printf("%s:%d:%d: %s for %s? (%s; then f = %.3f mm, back focus %.3f "
               "mm)\n",
               file, mend[k].line, mend[k].column, mend[k].to, mend[k].from,
               slip_name(mend[k].slip), mend[k].focal_mm, mend[k].back_mm);
    if (n > MENDS)
        printf("and %d more\n", n - MENDS);
}

static void print_json(const char *wrong, const struct mend *mend, int n)
{
    struct json_writer json = {.to = stdout};

    json_write(&json, "{wrong: %s, mends: %d, likeliest: [", wrong, n);
    for (int k = 0; k < n && k < MENDS; k++)
        json_write(&json,
                   "{line: %d, column: %d, from: %s, to: %s, slip: %s, "
                   "focal_length_mm: %.6f, back_focal_length_mm: %.6f}",
                   mend[k].line, mend[k].column, mend[k].from, mend[k].to,
                   slip_name(mend[k].slip), mend[k].focal_mm, mend[k].back_mm);
    json_write(&json, "]}\n");
}

static int lint(const struct tool *tool, const char *name)
{
    static struct glint_prescription lens;
    struct mend mend[MENDS];
    struct glint_error error = {""};
    char path[1024];
    const char *file = strcmp(name, "-") == 0
                           ? name
                           : tool_lens_file(tool, name, path, sizeof path);
    uint8_t *text = NULL;
    size_t bytes = 0;
    int n = 0;
    enum glint_status status;

    if (!file)
        return EXIT_LENS;
    status = glint_input_slurp(&text, &bytes, file, LENS_TEXT, &error);
    if (status != GLINT_OK) {
        free(text);
        return tool_fail(tool, status, error.text);
    }
    if (!table_is_right((const char *)text, bytes, file, &lens, &error))
        n = find_mends((const char *)text, bytes, mend);
    if (tool->json)
        print_json(error.text, mend, n);
    else
        print_text(file, error.text, mend, n);
    free(text);
    return error.text[0] ? EXIT_LENS : EXIT_OK;
}

int cmd_lint(int argc, char **argv)
{
    static const struct option options[] = {TOOL_COMMON_OPTIONS};
    struct tool tool = {.name = "lint", .help = help, .help_end = help_end};
    int c, code = -1;

    while (code < 0 &&
           (c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >= 0)
        code = tool_option(&tool, c, optarg);
    if (code < 0)
        code = tool_inputs(&tool, argc, argv, 1, "takes one lens");
    if (code >= 0)
        return code;
    code = tool_start(&tool);
    if (code == EXIT_OK)
        code = lint(&tool, argv[optind]);
    tool_finish(&tool);
    return code;
}
