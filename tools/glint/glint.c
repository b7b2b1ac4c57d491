/* SPDX-License-Identifier: MIT
 *
 * The glint command: runs the subcommand that is named on the command line.
 */
#include <stdio.h>
#include <string.h>

#include "posix/process.h"
#include "options/suggest.h"
#include "options/command_line.h"

static const char help[] =
    "glint: lens flare of real lenses, on pictures and video, without a GPU\n"
    "\n"
    "  glint lenses                    list the lenses that come with glint\n"
    "  glint info LENS|MODEL           print the data of a lens: focal length, "
    "ghosts\n"
    "  glint draw LENS -o FILE.svg     draw a lens's section, rays, ghosts, "
    "spots\n"
    "  glint import FILE -o FILE.lens  convert lens files of other programs\n"
    "  glint lint LENS                 find misprints in a lens table\n"
    "  glint bake LENS -o MODEL        bake a lens model: its ghosts, in "
    "integers\n"
    "  glint trace LENS --ghost K ...  trace rays through a lens, as a table\n"
    "  glint render LENS|MODEL -o OUT  render the flare alone\n"
    "  glint overlay IN -o OUT ...     add the flare of the lamps in a picture "
    "or\n"
    "                                  video to it\n"
    "  glint live                      show a camera's pictures with flares\n"
    "  glint explain IN | --size WxH   report the drawn and skipped ghosts of "
    "a frame\n"
    "  glint styles -o OUT             draw a photograph in each --style\n"
    "  glint synth BACKGROUNDS ...     draw pairs to train flare removal with\n"
    "  glint web [PHOTO]               show a page that adds flares, for "
    "browsers\n"
    "  glint compare A B               measure the difference of two pictures\n"
    "  glint bench                     measure the time of a frame\n"
    "  glint sweep -o FILE             measure time against accuracy\n"
    "\n"
    "  glint help COMMAND              print the common options of a command, "
    "like\n"
    "                                  glint COMMAND --help; --help-all: all\n"
    "  glint --version [--json]\n"
    "\n"
    "LENS is a .lens file or the name of one that comes with glint, such as\n"
    "nikon-zoom-short. Exit codes: 0 ok, 1 run-time failure, 2 usage, 3 input\n"
    "or format, 4 device, 5 lens or model data, 6 output.\n";

struct command {
    const char *name;
    int (*run)(int argc, char **argv);
};

static const struct command commands[] = {
    {"info", cmd_info},       {"trace", cmd_trace},     {"render", cmd_render},
    {"overlay", cmd_overlay}, {"explain", cmd_explain}, {"live", cmd_live},
    {"compare", cmd_compare}, {"bake", cmd_bake},       {"bench", cmd_bench},
    {"sweep", cmd_sweep},     {"lenses", cmd_lenses},   {"styles", cmd_styles},
    {"draw", cmd_draw},       {"synth", cmd_synth},     {"import", cmd_import},
    {"lint", cmd_lint},       {"web", cmd_web},
};

enum { N_COMMANDS = sizeof commands / sizeof *commands };

/* Runs COMMAND with "glint COMMAND" as ARGV[0], because getopt_long() prints
 * ARGV[0] in error messages. */
static int run_command(const struct command *command, int argc, char **argv)
{
    char name[32];

    snprintf(name, sizeof name, "glint %s", command->name);
    argv[0] = name;
    tool_set_command_line(argv);
    return command->run(argc, argv);
}

static const struct command *find_command(const char *name)
{
    for (int i = 0; i < N_COMMANDS; i++)
        if (strcmp(name, commands[i].name) == 0)
            return &commands[i];
    return NULL;
}

static int report_missing_command(const char *name)
{
    struct suggest s;

    suggest_begin(&s, name);
    for (int i = 0; i < N_COMMANDS; i++)
        suggest_add_candidate(&s, commands[i].name, strlen(commands[i].name));
    fprintf(stderr, "glint: no command '%s'\n", name);
    if (suggest_find_best(&s))
        fprintf(stderr, "Did you mean 'glint %s'? ", s.best);
    fputs("Try 'glint --help'.\n", stderr);
    return EXIT_USAGE;
}

/* Prints the help of the command NAME, or that of glint if NAME is NULL. */
static int print_command_help(const char *name)
{
    char argument[] = "--help", *argv[] = {NULL, argument, NULL};
    const struct command *command;

    if (!name) {
        fputs(help, stdout);
        return EXIT_OK;
    }
    command = find_command(name);
    return command ? run_command(command, 2, argv)
                   : report_missing_command(name);
}

static int run_command_by_name(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    const struct command *command = find_command(name);

    if (command)
        return run_command(command, argc - 1, argv + 1);
    if (strcmp(name, "help") == 0)
        return print_command_help(argc > 2 ? argv[2] : NULL);
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0)
        return print_command_help(NULL);
    if (strcmp(name, "--commands") == 0) { /* for shell completion */
        for (int i = 0; i < N_COMMANDS; i++)
            puts(commands[i].name);
        return EXIT_OK;
    }
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0 ||
        strcmp(name, "version") == 0) {
        struct tool tool = {.name = "version", .help = help};

        tool.json = argc > 2 && strcmp(argv[2], "--json") == 0;
        return tool_apply_option(&tool, 'V', NULL);
    }
    if (*name)
        return report_missing_command(name);
    fputs(help, stderr);
    return EXIT_USAGE;
}

struct words {
    int argc;
    char **argv;
};

static int run_command_words(void *ctx)
{
    const struct words *words = ctx;

    return run_command_by_name(words->argc, words->argv);
}

/* Runs the command on a large stack, as baking needs more stack than some
 * systems provide. */
int main(int argc, char **argv)
{
    struct words words = {argc, argv};

    glint_process_open_closed_streams();
    tool_watch_closed_pipe();
    return tool_close_stdout(glint_process_run_with_stack(
        GLINT_WORKER_STACK_BYTES, run_command_words, &words));
}
