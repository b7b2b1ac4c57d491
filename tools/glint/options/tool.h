/* SPDX-License-Identifier: MIT
 *
 * The parts that all commands share: common options, exit codes, errors,
 * progress, and the reading of numbers.
 */
#ifndef GLINT_TOOLS_OPTIONS_TOOL_H
#define GLINT_TOOLS_OPTIONS_TOOL_H

#include <stdbool.h>
#include <stdio.h>

#include "glint/glint.h"
#include "posix/output.h"

enum exit_code {
    EXIT_OK = 0,
    EXIT_RUNTIME = 1,
    EXIT_USAGE = 2,
    EXIT_INPUT = 3,
    EXIT_DEVICE = 4,
    EXIT_LENS = 5,
    EXIT_OUTPUT = 6
};

struct tool {
    const char *name; /* name of the command */
    const char *help; /* of its own options */
    /* Groups of the engine's options that it has, a bit each by enum
     * glint_option_group, and their defaults; NULL where there are none. */
    unsigned groups;
    const struct glint_options *defaults;
    const char *help_end; /* what comes behind the help of these, or NULL */
    bool json, quiet;
    bool
        no_bake; /* A lens whose model is not kept is refused: for reloading. */
    int verbose;
    int n_threads;
    int seed; /* seed of all that is random: the noise of live -d test */
    unsigned sets_off;             /* instruction sets not to use */
    const char *kernels;           /* argument of --kernels, or NULL */
    struct glint_workers *workers; /* made by tool_start */
    const char *written;           /* file that no scene may read, or NULL */
    struct glint_error *cause;     /* last message of tool_error(), or NULL */
    const char *where; /* "FILE:LINE" of the option being taken, or NULL for the
                          command line */
};

/* Makes the workers, which tool_finish() ends. Returns an exit code. */
int tool_start(struct tool *tool);
void tool_finish(struct tool *tool);

/* Watch standard output: tool_watch_reader() at the start of a program,
 * tool_end() at its end. The latter returns CODE, or EXIT_OUTPUT if output was
 * lost, unless the reader of a pipe went away. */
void tool_watch_reader(void);
int tool_end(int code);

/* Returns the instruction sets that kernels may use. */
unsigned tool_sets(const struct tool *tool);

/* Prints "glint COMMAND: ..." and copies the message to the tool's cause. */
void tool_error(const struct tool *tool, const char *format, ...);

/* Do so and return an exit code: tool_usage() EXIT_USAGE,
 * or EXIT_INPUT if the option comes from a file; tool_fail() that of STATUS,
 * but for GLINT_E_CLOSED, a reader that went away, it prints nothing. */
int tool_usage(const struct tool *tool, const char *format, ...);
int tool_fail(const struct tool *tool, enum glint_status status,
              const char *text);

/* Prints that OPTION does not accept VALUE, and what it accepts. Returns the
 * code of tool_usage(). */
int tool_refuse(const struct tool *tool, const char *option, const char *value);

/* ------------------------------------------------------------------ numbers */

/* Read all of TEXT as a finite number, or as up to MAX numbers with commas.
 * They return how many they have read, 0 on failure. */
bool tool_number(const char *text, double *value);
int tool_numbers(const char *text, double *values, int max);

/* Reads all of TEXT as an integer within LOW .. HIGH. Returns false on
 * failure. */
bool tool_integer(const char *text, int low, int high, int *value);

/* Reads TEXT, "WxH", sides of 1 .. GLINT_MAX_SIDE. Returns false on failure. */
bool tool_size(const char *text, int *width, int *height);

/* Returns the index of TEXT in the NULL-terminated WORDS, or -1. */
int tool_word(const char *text, const char *const *words);

/* Returns the seconds since some moment, by a clock that does not jump. */
double tool_seconds(void);

/* ------------------------------------------------------------------- output */

/* Checks, before a lens is baked, whether a file can be created at PATH.
 * Returns EXIT_OK, or EXIT_OUTPUT after printing the reason. PATH may be a
 * pattern; it is not checked if its folders have the number. */
int tool_check_output(const struct tool *tool, const char *path);

/* Checks that PATH has the ENDING of WHAT is written there, or none, as "-" or
 * /dev/stdout. Returns EXIT_OK, or the code of tool_usage(). */
int tool_check_ending(struct tool *tool, const char *path, const char *ending,
                      const char *what);

/* Write DATA, or the TEXT of a FILE of glint_memory_file_open(), NULL without
 * memory, to the file PATH. The latter closes FILE and frees TEXT. They return
 * an exit code. */
int tool_save(const struct tool *tool, const char *path,
              enum glint_output_kind kind, const void *data, size_t bytes);
int tool_save_text(const struct tool *tool, const char *path, FILE *file,
                   char **text, const size_t *bytes);

/* ----------------------------------------------------------------- progress */

/* Progress as a bar on a terminal's standard error, elsewhere as a line every
 * ten seconds; work of more than twenty says so as soon as any is done.
 * PROGRESS below is such a struct, and DONE is 0 .. 1. */
struct tool_progress {
    const char *what;
    const char *less;    /* how to make it faster, printed if it takes minutes;
                            NULL: nothing */
    const char *besides; /* what the estimate does not include, printed
                            likewise; NULL: nothing */
    double from, share;  /* see tool_progress_part() */
    bool shown, is_terminal;
    bool told;             /* the estimate was printed, or the work is short */
    double (*clock)(void); /* seconds; tool_seconds(), but in unit tests */
    double started, last;
    double most; /* shown: more work than was thought takes nothing back */
};

void tool_progress_start(struct tool_progress *p, const struct tool *tool,
                         const char *what);
/* DONE is from now on of the part of the work that begins at FROM and is
 * SHARE of it; at first of all: 0 and 1. */
void tool_progress_part(struct tool_progress *p, double from, double share);
void tool_progress_show(void *progress, double done);
void tool_progress_end(struct tool_progress *p);

/* The commands. ARGV[0] is the command's name. They return exit codes. */
int cmd_info(int argc, char **argv);
int cmd_trace(int argc, char **argv);
int cmd_render(int argc, char **argv);
int cmd_overlay(int argc, char **argv);
int cmd_explain(int argc, char **argv);
int cmd_compare(int argc, char **argv);
int cmd_live(int argc, char **argv);
int cmd_bake(int argc, char **argv);
int cmd_bench(int argc, char **argv);
int cmd_sweep(int argc, char **argv);
int cmd_lenses(int argc, char **argv);
int cmd_coat(int argc, char **argv);
int cmd_draw(int argc, char **argv);
int cmd_import(int argc, char **argv);
int cmd_lint(int argc, char **argv);
int cmd_styles(int argc, char **argv);
int cmd_synth(int argc, char **argv);

#endif
