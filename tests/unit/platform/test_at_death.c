/* SPDX-License-Identifier: MIT
 *
 * Tests glint_at_death_register(): registered functions run however a process
 * ends: by signal, fault, abort() or exit().
 */
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/at_death.h"
#include "support/test.h"

static int child_pipe[2]; /* pipe from the child to the test */

static void write_child_pipe(char c)
{
    if (write(child_pipe[1], &c, 1) != 1)
        _exit(98);
}

static void write_1_at_exit(void)
{
    write_child_pipe('1');
}

static void write_2_at_exit(void)
{
    write_child_pipe('2');
}

/* Runs DIE(NUMBER) in a child process that has registered two functions. Checks
 * that the child's exit code, as a shell reports it (128 + N for signal N), is
 * CODE, and that the functions have written TEXT. */
static void expect_end_of_child(void (*die)(int), int number, int code,
                                const char *text)
{
    const struct rlimit no_core = {0, 0};
    ssize_t n;
    pid_t child;
    char wrote[8];
    int how;

    assert_int_equal(pipe(child_pipe), 0);
    child = fork();
    if (child == 0) {
        for (int i = 1; i <= SIGRTMAX; i++)
            signal(i, SIG_DFL); /* replaces cmocka's handler */
        close(child_pipe[0]);
        setrlimit(RLIMIT_CORE, &no_core);
        if (!glint_at_death_register(write_1_at_exit) ||
            !glint_at_death_register(write_2_at_exit) ||
            !glint_at_death_register(write_1_at_exit))
            _exit(97);
        die(number);
        _exit(0);
    }
    close(child_pipe[1]);
    assert_int_equal(waitpid(child, &how, 0), child);
    n = read(child_pipe[0], wrote, 7);
    assert_true(n >= 0);
    wrote[n] = 0;
    close(child_pipe[0]);
    assert_int_equal(WIFSIGNALED(how) ? 128 + WTERMSIG(how) : WEXITSTATUS(how),
                     code);
    assert_string_equal(wrote, text);
}

static void end_by_raise(int number)
{
    raise(number);
}

static void end_by_exit(int number)
{
    exit(number);
}

static void end_by_abort(int number)
{
    (void)number;
    abort();
}

static int report_library_busy(void)
{
    write_child_pipe('r');
    return 1;
}

static int report_library_idle(void)
{
    return 0;
}

static void end_by_abort_in_library(int number)
{
    glint_at_death_set_library_report(number ? report_library_busy
                                             : report_library_idle);
    abort();
}

static void end_by_exit_in_library(int number)
{
    glint_at_death_set_library_report(report_library_busy);
    exit(number);
}

static void end_by_quick_exit(int number)
{
    _exit(number);
}

/* Ends the process by a page fault that sanitizers do not intercept. */
static void end_by_page_fault(int number)
{
    const size_t bytes = (size_t)sysconf(_SC_PAGESIZE);
    volatile char *const page =
        mmap(NULL, bytes, PROT_NONE, MAP_SHARED, open("/dev/zero", O_RDWR), 0);

    (void)number;
    *page = 1;
}

static void run_own_signal_handler(int number)
{
    write_child_pipe('h');
    glint_at_death_end_by_signal(number);
}

static void end_by_own_handler(int number)
{
    signal(number, run_own_signal_handler);
    raise(number);
}

static void end_after_ignored_signals(int number)
{
    signal(number, SIG_IGN);
    raise(number);
    _exit(5);
}

TEST(functions_run_at_every_deadly_signal)
{
    const int deadly[] = {SIGHUP,    SIGINT,  SIGTERM, SIGQUIT, SIGUSR1,
                          SIGUSR2,   SIGALRM, SIGABRT, SIGSEGV, SIGBUS,
                          SIGILL,    SIGFPE,  SIGTRAP, SIGPOLL,
#ifdef SIGPWR
                          SIGPWR,
#endif
#ifdef SIGSTKFLT
                          SIGSTKFLT,
#endif
                          SIGRTMIN};

    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++)
        expect_end_of_child(end_by_raise, deadly[i], 128 + deadly[i], "21");
}

TEST(functions_run_at_faults)
{
    expect_end_of_child(end_by_page_fault, 0, 128 + SIGSEGV, "21");
    expect_end_of_child(end_by_abort, 0, 128 + SIGABRT, "21");
}

/* Checks two calls of abort(). In a library, it must end the process with exit
 * code 1. In glint itself, it must end the process by SIGABRT. */
TEST(abort_in_a_library_ends_with_code_1)
{
    expect_end_of_child(end_by_abort_in_library, 1, 1, "21r");
    expect_end_of_child(end_by_exit_in_library, 4, 4, "21r");
    expect_end_of_child(end_by_abort_in_library, 0, 128 + SIGABRT, "21");
}

TEST(functions_run_at_exit)
{
    expect_end_of_child(end_by_exit, 3, 3, "21");
    expect_end_of_child(end_by_quick_exit, 3, 3, "");
}

/* Checks that the functions run if an application has a signal handler of its
 * own that calls glint_at_death_end_by_signal(). */
TEST(functions_run_from_own_handler)
{
    expect_end_of_child(end_by_own_handler, SIGINT, 128 + SIGINT, "h21");
}

/* Checks that SIGPIPE and SIGXFSZ are ignored from the first call on: the
 * child survives both and ends with its own exit code. */
TEST(ignores_sigpipe_and_sigxfsz)
{
    expect_end_of_child(end_after_ignored_signals, SIGHUP, 5, "");
    expect_end_of_child(end_by_raise, SIGPIPE, 0, "");
    expect_end_of_child(end_by_raise, SIGXFSZ, 0, "");
}
