/* SPDX-License-Identifier: MIT
 *
 * Functions for the end of a process must run whatever ends it.
 */
#include <stdint.h>

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/at_death.h"
#include "support/test.h"

static int told[2]; /* pipe from the child */

static void tell(char c)
{
    if (write(told[1], &c, 1) != 1)
        _exit(98);
}

static void first(void)
{
    tell('1');
}

static void second(void)
{
    tell('2');
}

/* Runs DIE in a child that has two functions to run at its end. It must end
 * with the exit code CODE, as of a shell: 128 and more for a signal; the
 * functions must write TEXT. */
static void must_end(void (*die)(int), int number, int code, const char *text)
{
    const struct rlimit no_core = {0, 0};
    ssize_t n;
    pid_t child;
    char wrote[8];
    int how;

    assert_int_equal(pipe(told), 0);
    child = fork();
    if (child == 0) {
        for (int i = 1; i < SIGRTMIN; i++)
            signal(i, SIG_DFL); /* in place of cmocka's */
        close(told[0]);
        setrlimit(RLIMIT_CORE, &no_core);
        if (!glint_at_death(first) || !glint_at_death(second) ||
            !glint_at_death(first))
            _exit(97);
        die(number);
        _exit(0);
    }
    close(told[1]);
    assert_int_equal(waitpid(child, &how, 0), child);
    n = read(told[0], wrote, 7);
    assert_true(n >= 0);
    wrote[n] = 0;
    close(told[0]);
    assert_int_equal(WIFSIGNALED(how) ? 128 + WTERMSIG(how) : WEXITSTATUS(how),
                     code);
    assert_string_equal(wrote, text);
}

static void by_raise(int number)
{
    raise(number);
}

static void by_exit(int number)
{
    exit(number);
}

static void by_abort(int number)
{
    (void)number;
    abort();
}

static int report_at_work(void)
{
    tell('r');
    return 1;
}

static int report_idle(void)
{
    return 0;
}

static void by_library(int number)
{
    glint_at_death_in_library(number ? report_at_work : report_idle);
    abort();
}

static void by_exit_of_library(int number)
{
    glint_at_death_in_library(report_at_work);
    exit(number);
}

static void by_quick_exit(int number)
{
    _exit(number);
}

/* Ends the process by a true fault, not one that a sanitizer sees coming. */
static void by_fault(int number)
{
    const size_t bytes = (size_t)sysconf(_SC_PAGESIZE);
    volatile char *const page =
        mmap(NULL, bytes, PROT_NONE, MAP_SHARED, open("/dev/zero", O_RDWR), 0);

    (void)number;
    *page = 1;
}

static void handle_own(int number)
{
    tell('h');
    glint_at_death_by(number);
}

static void by_own_handler(int number)
{
    signal(number, handle_own);
    raise(number);
}

static void by_ignored(int number)
{
    signal(number, SIG_IGN);
    raise(number);
    _exit(5);
}

TEST(signals)
{
    static const int deadly[] = {SIGHUP,  SIGINT,  SIGTERM, SIGQUIT, SIGUSR1,
                                 SIGUSR2, SIGALRM, SIGABRT, SIGSEGV, SIGBUS,
                                 SIGILL,  SIGFPE,  SIGTRAP};

    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++)
        must_end(by_raise, deadly[i], 128 + deadly[i], "21");
}

TEST(faults)
{
    must_end(by_fault, 0, 128 + SIGSEGV, "21");
    must_end(by_abort, 0, 128 + SIGABRT, "21");
}

/* An abort in a library is an exit with 1, one of glint itself a death. */
TEST(library)
{
    must_end(by_library, 1, 1, "21r");
    must_end(by_exit_of_library, 4, 4, "21r");
    must_end(by_library, 0, 128 + SIGABRT, "21");
}

TEST(exit)
{
    must_end(by_exit, 3, 3, "21");
    must_end(by_quick_exit, 3, 3, "");
}

/* A handler of the application's own that ends the process by
 * glint_at_death_by() must have the functions run. */
TEST(own_handler)
{
    must_end(by_own_handler, SIGINT, 128 + SIGINT, "h21");
}

/* SIGPIPE and SIGXFSZ are ignored from the first call on, so that the child
 * comes to its exit code 0. */
TEST(ignored)
{
    must_end(by_ignored, SIGHUP, 5, "");
    must_end(by_raise, SIGPIPE, 0, "");
    must_end(by_raise, SIGXFSZ, 0, "");
}
