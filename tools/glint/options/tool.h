/* SPDX-License-Identifier: MIT
 *
 * Functions that all commands share: common options, exit codes, error
 * messages, progress, and parsing of numbers. */
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
    const char *help; /* help text of the command's own options */
    /* engine options that the command accepts: groups, one bit per enum
     * glint_option_group, and default values; NULL: no engine options */
    unsigned groups;
    const struct glint_options *defaults;
    /* help text that follows the engine options, or NULL */
    const char *help_end;
    bool json, quiet;
    /* whether a lens without a cached model is rejected; a reload of glint live
     * must not bake */
    bool no_bake;
    /* whether the command is glint bake, which sets no limit to the bake time
     * of files that its input names */
    bool is_bake;
    int verbose;
    int n_threads;
    int seed; /* random seed for synth, and for the noise of live -d test */
    /* instruction sets that kernels must not use, one bit each */
    unsigned sets_off;
    const char *kernels; /* argument of --kernels; NULL: not given */
    /* thread pool, created by tool_start_threads() */
    struct glint_workers *workers;
    /* output file of the command, which must not be an input of a scene; may be
     * NULL */
    const char *written;
    struct glint_error *cause; /* receives messages of tool_error(); may be
                                  NULL */
    /* "FILE:LINE" of the option that is parsed; NULL: command line */
    const char *where;
};

/* Starts the worker threads, which tool_stop_threads() ends. Returns an exit
 * code. */
int tool_start_threads(struct tool *tool);
void tool_stop_threads(struct tool *tool);

/* Detect failed writes to standard output. A program calls
 * tool_watch_closed_pipe() at its start and tool_close_stdout() at its end. The
 * latter returns CODE, or EXIT_OUTPUT if a write failed. A pipe that its reader
 * has closed is not a failure. */
void tool_watch_closed_pipe(void);
int tool_close_stdout(int code);

/* Returns the instruction sets that kernels may use, one bit each. */
unsigned tool_enabled_instruction_sets(const struct tool *tool);

/* Prints "glint COMMAND: ..." and copies the message to the tool's cause. */
void tool_error(const struct tool *tool, const char *format, ...);

/* Print an error like tool_error() and return an exit code. tool_usage()
 * returns EXIT_USAGE, or EXIT_INPUT if the option comes from a file.
 * tool_fail() returns the code of STATUS. For GLINT_E_CLOSED (the reader of a
 * pipe has closed it) tool_fail() prints nothing. */
int tool_usage(const struct tool *tool, const char *format, ...);
int tool_fail(const struct tool *tool, enum glint_status status,
              const char *text);

/* Subtracts WORK from *LEFT, the remaining bake work; LEFT is NULL if that is
 * not limited. If too little is left, returns GLINT_E_LENS with the reason in
 * ERROR: the bake of FILE would take more than about 30 s of processor time,
 * which only glint bake allows. */
enum glint_status tool_count_bake_work(int64_t *left, int64_t work,
                                       const char *file,
                                       struct glint_error *error);

/* Prints that OPTION does not accept VALUE, and which values it accepts.
 * Returns the code of tool_usage(). */
int tool_report_bad_value(const struct tool *tool, const char *option,
                          const char *value);

/* ------------------------------------------------------------------ numbers */

/* Parse all of TEXT. tool_parse_number() parses a finite number and returns
 * false on failure. tool_parse_numbers() parses up to MAX finite numbers,
 * separated by commas, and returns how many there are, 0 on failure. */
bool tool_parse_number(const char *text, double *value);
int tool_parse_numbers(const char *text, double *values, int max);

/* Parses all of TEXT as an integer, LOW .. HIGH. Returns false on failure. */
bool tool_parse_integer(const char *text, int low, int high, int *value);

/* Parses TEXT, "WxH", with W and H from 1 to GLINT_MAX_SIDE. Returns false on
 * failure. */
bool tool_parse_size(const char *text, int *width, int *height);

/* Returns the index of TEXT in the NULL-terminated WORDS, or -1 if TEXT is not
 * in WORDS. */
int tool_find_word_index(const char *text, const char *const *words);

/* Returns the time of a monotonic clock, s. */
double tool_clock_s(void);

/* ------------------------------------------------------------------- output */

/* Checks that a file can be created at PATH, before a lens is baked. Returns
 * EXIT_OK, or EXIT_OUTPUT after printing the reason. PATH may be a pattern of
 * numbered files. A pattern with the number in the name of a folder is not
 * checked. */
int tool_check_output(const struct tool *tool, const char *path);

/* Checks that PATH, an output of type WHAT, has the extension ENDING or none,
 * like "-" and /dev/stdout. Returns EXIT_OK, or the code of tool_usage(). */
int tool_check_ending(struct tool *tool, const char *path, const char *ending,
                      const char *what);

/* Write the file PATH and return an exit code. tool_save_file() writes DATA.
 * tool_save_text() closes FILE, opened by glint_memory_file_open() (NULL: no
 * memory), writes its TEXT and frees it. */
int tool_save_file(const struct tool *tool, const char *path,
                   enum glint_output_kind kind, const void *data, size_t bytes);
int tool_save_text(const struct tool *tool, const char *path, FILE *file,
                   char **text, const size_t *bytes);

/* ----------------------------------------------------------------- progress */

/* Progress on standard error: a bar on a terminal, else a line every ten
 * seconds. An estimate of the time is printed first if it is at least LEAST_S.
 * In the functions below PROGRESS is a struct tool_progress, and DONE is the
 * fraction of the work done, 0 .. 1. */
struct tool_progress {
    const char *what;
    /* option that shortens the work, printed if the work takes minutes; NULL:
     * none */
    const char *less;
    /* text after the estimate, about work that the estimate omits; NULL:
     * none */
    const char *besides;
    double from, share; /* see tool_progress_set_part() */
    /* min total time for which an estimate is printed, s */
    double least_s;
    /* whether the clock starts with the first call of tool_progress_show() */
    bool waits;
    /* fraction of the work that was done when the clock started */
    double before;
    bool shown, is_terminal;
    /* whether the estimate was printed or was too short to be printed */
    bool told;
    /* returns seconds; tool_clock_s() except in unit tests */
    double (*clock)(void);
    double started, last;
    double most; /* max fraction reported so far; the bar never moves back */
};

void tool_progress_start(struct tool_progress *p, const struct tool *tool,
                         const char *what);
/* Makes the following calls of tool_progress_show() a part of the work: DONE
 * counts as FROM + SHARE * DONE. Initially FROM is 0 and SHARE is 1. */
void tool_progress_set_part(struct tool_progress *p, double from, double share);
void tool_progress_show(void *progress, double done);
void tool_progress_end(struct tool_progress *p);

/* Run a command. ARGV[0] is the name of the command. Return exit codes. */
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
int cmd_draw(int argc, char **argv);
int cmd_import(int argc, char **argv);
int cmd_lint(int argc, char **argv);
int cmd_styles(int argc, char **argv);
int cmd_synth(int argc, char **argv);
int cmd_web(int argc, char **argv);

#endif
