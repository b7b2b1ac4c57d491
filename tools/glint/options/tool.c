/* SPDX-License-Identifier: MIT */
#include "options/tool.h"

#include "glint/options.h"
#include "glint/pool.h"
#include "help/values.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "linux/sets.h"
#include "posix/ending.h"
#include "posix/error.h"

/* Prints an error message and copies it to tool->cause unless that is NULL. */
static void print_tool_error(const struct tool *tool, const char *format,
                             va_list args)
{
    struct glint_error *const cause = tool->cause;
    va_list again;

    va_copy(again, args);
    if (cause)
        vsnprintf(cause->text, sizeof cause->text, format, again);
    va_end(again);
    vfprintf(stderr, format, args);
}

void tool_error(const struct tool *tool, const char *format, ...)
{
    va_list args;

    fprintf(stderr, "glint %s: ", tool->name);
    va_start(args, format);
    print_tool_error(tool, format, args);
    va_end(args);
    fputc('\n', stderr);
}

int tool_usage(const struct tool *tool, const char *format, ...)
{
    va_list args;

    fprintf(stderr, "glint %s: ", tool->name);
    if (tool->where)
        fprintf(stderr, "%s: ", tool->where);
    va_start(args, format);
    print_tool_error(tool, format, args);
    va_end(args);
    if (tool->where) {
        fputc('\n', stderr);
        return EXIT_INPUT;
    }
    fprintf(stderr, "\nTry 'glint %s --help'.\n", tool->name);
    return EXIT_USAGE;
}

int tool_report_bad_value(const struct tool *tool, const char *option,
                          const char *value)
{
    const char *takes = values_describe(tool->name, option);

    return tool_usage(tool, "--%s: '%s' is not valid%s%s", option, value,
                      takes ? "; expected " : "", takes ? takes : "");
}

enum glint_status tool_count_bake_work(int64_t *left, int64_t work,
                                       const char *file,
                                       struct glint_error *error)
{
    if (!left || work <= *left) {
        if (left)
            *left -= work;
        return GLINT_OK;
    }
    snprintf(
        error->text, sizeof error->text,
        "%.100s: baking takes more than about 30 s of processor time; bake it "
        "by glint bake, which has no limit, and name its output here",
        file);
    return GLINT_E_LENS;
}

int tool_fail(const struct tool *tool, enum glint_status status,
              const char *text)
{
    static const int code[] = {[GLINT_OK] = EXIT_OK,
                               [GLINT_E_ARGUMENT] = EXIT_USAGE,
                               [GLINT_E_MEMORY] = EXIT_RUNTIME,
                               [GLINT_E_FORMAT] = EXIT_INPUT,
                               [GLINT_E_UNSUPPORTED] = EXIT_INPUT,
                               [GLINT_E_LENS] = EXIT_LENS,
                               [GLINT_E_IO] = EXIT_INPUT,
                               [GLINT_E_OUTPUT] = EXIT_OUTPUT,
                               [GLINT_E_CLOSED] = EXIT_OK,
                               [GLINT_E_DEVICE] = EXIT_DEVICE};

    /* A reader that closes the pipe before its end is not an error. */
    if (status == GLINT_E_CLOSED)
        return EXIT_OK;
    tool_error(tool, "%s", text && *text ? text : glint_status_text(status));
    return code[status];
}

int tool_start_threads(struct tool *tool)
{
    const enum glint_status status =
        glint_pool_create(&tool->workers, tool->n_threads);

    if (status != GLINT_OK)
        return tool_fail(tool, status, NULL);
    if (tool->n_threads > tool->workers->n && !tool->quiet)
        fprintf(stderr, "glint %s: the system provides %d of %d threads\n",
                tool->name, tool->workers->n, tool->n_threads);
    return EXIT_OK;
}

void tool_stop_threads(struct tool *tool)
{
    glint_pool_destroy(tool->workers);
    tool->workers = NULL;
}

static volatile sig_atomic_t reader_gone;

static void record_closed_pipe(int signal_number)
{
    (void)signal_number;
    reader_gone = 1;
}

void tool_watch_closed_pipe(void)
{
    struct sigaction note = {.sa_handler = record_closed_pipe};

    /* The handler only records the signal. The write that caused the signal
     * fails with an error, which is handled. */
    sigaction(SIGPIPE, &note, NULL);
}

int tool_close_stdout(int code)
{
    errno = 0;
    if ((fflush(stdout) == 0 && !ferror(stdout)) || reader_gone)
        return code;
    fprintf(stderr, "glint: standard output: %s\n",
            errno ? strerror(errno) : "write failed");
    return code == EXIT_OK ? EXIT_OUTPUT : code;
}

unsigned tool_enabled_instruction_sets(const struct tool *tool)
{
    return glint_system_sets() & ~tool->sets_off;
}

double tool_clock_s(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int tool_save_file(const struct tool *tool, const char *path,
                   enum glint_output_kind kind, const void *data, size_t bytes)
{
    struct glint_error error = {""};
    const enum glint_status status =
        glint_output_save_file(path, kind, data, bytes, &error);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

int tool_save_text(const struct tool *tool, const char *path, FILE *file,
                   char **text, const size_t *bytes)
{
    const int code =
        file && glint_memory_file_close(file)
            ? tool_save_file(tool, path, GLINT_OUTPUT_TEXT, *text, *bytes)
            : tool_fail(tool, GLINT_E_MEMORY, NULL);

    free(*text);
    return code;
}

int tool_check_output(const struct tool *tool, const char *path)
{
    struct glint_error error = {""};
    const char *const slash = strrchr(path, '/'), *pattern = strchr(path, '%');

    /* A numbered pattern in the name of a folder is not checked. */
    if (slash && pattern && pattern < slash)
        return EXIT_OK;
    if (glint_output_check_path(path, &error) == GLINT_OK)
        return EXIT_OK;
    tool_fail(tool, GLINT_E_OUTPUT, error.text);
    return EXIT_OUTPUT;
}

int tool_check_ending(struct tool *tool, const char *path, const char *ending,
                      const char *what)
{
    return !*glint_get_extension(path) || glint_has_extension(path, ending)
               ? EXIT_OK
               : tool_usage(tool, "%s must be a %s, not '%s'", what, ending,
                            path);
}

/* ----------------------------------------------------------------- progress */

void tool_progress_start(struct tool_progress *p, const struct tool *tool,
                         const char *what)
{
    p->what = what;
    p->less = p->besides = NULL;
    tool_progress_set_part(p, 0, 1);
    p->clock = tool_clock_s;
    p->started = p->clock();
    p->last = 0;
    p->most = 0;
    p->least_s = 20;
    p->waits = false;
    p->before = 0;
    p->shown = !tool->quiet;
    p->told = false;
    p->is_terminal = isatty(STDERR_FILENO);
}

void tool_progress_set_part(struct tool_progress *p, double from, double share)
{
    p->from = from;
    p->share = share;
}

/* Returns the estimated time left, seconds. SPENT are the seconds since the
 * start of the clock, DONE is the fraction of the work done. */
static double estimate_time_left_s(const struct tool_progress *p, double spent,
                                   double done)
{
    return done > p->before ? spent * (1 - done) / (done - p->before) : 0;
}

/* Prints a progress line, at most every ten seconds. Used if standard error is
 * not a terminal. */
static void print_progress_line(struct tool_progress *p, double now,
                                double done)
{
    const double spent = now - p->started;

    if (spent < 10 || now - p->last < 10 || done <= 0 || done >= 1)
        return;
    p->last = now;
    fprintf(stderr, "%s: %.0f %% in %.0f s, about %.0f s left\n", p->what,
            100 * p->most, spent, estimate_time_left_s(p, spent, done));
}

/* Prints an estimate of the remaining time once, if the total is at least
 * p->least_s. Waits for a quarter of that time first, because the first ghosts
 * of a bake do not represent the others. */
static void print_time_estimate(struct tool_progress *p, double spent,
                                double done)
{
    const double left = estimate_time_left_s(p, spent, done);

    if (spent < p->least_s / 4)
        return;
    p->told = true;
    if (spent + left < p->least_s)
        return;
    if (left < 120)
        fprintf(stderr, "%s: will take about %.0f s%s\n", p->what, left,
                p->besides ? p->besides : "");
    else
        fprintf(stderr, "%s: will take about %.0f minutes%s%s%s\n", p->what,
                left / 60, p->besides ? p->besides : "",
                p->less ? "; less with " : "", p->less ? p->less : "");
}

void tool_progress_show(void *progress, double done)
{
    struct tool_progress *p = progress;
    const double now = p->clock();
    const int width = 30;
    double spent;
    char bar[32];
    int filled;

    done = p->from + p->share * done;
    if (p->waits) {
        p->started = now;
        p->before = done;
        p->waits = false;
    }
    spent = now - p->started;
    p->most = fmax(done, p->most);
    filled = (int)(p->most * width);
    if (p->shown && !p->told && done > p->before)
        print_time_estimate(p, spent, done);
    if (p->shown && !p->is_terminal)
        print_progress_line(p, now, done);
    if (!p->shown || !p->is_terminal || (now - p->last < 0.1 && done < 1))
        return;
    p->last = now;
    for (int i = 0; i < width; i++)
        bar[i] = i < filled ? '#' : '.';
    bar[width] = '\0';
    fprintf(stderr, "\r%s [%s] %3.0f %%  %.0f s left \033[K", p->what, bar,
            100 * p->most,
            done > p->before + 0.01 ? estimate_time_left_s(p, spent, done) : 0);
    fflush(stderr);
}

void tool_progress_end(struct tool_progress *p)
{
    if (p->shown && p->is_terminal && p->last > 0)
        fputs("\r\033[K", stderr);
}
