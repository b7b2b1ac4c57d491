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

/* Runs DIE in a child that has two functions to run at its end. Returns how the
 * child ended, and sets TEXT to what the functions wrote. */
static int end_of(void (*die)(int), int number, char text[8])
{
    const struct rlimit no_core = {0, 0};
    ssize_t n;
    pid_t child;
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
    n = read(told[0], text, 7);
    assert_true(n >= 0);
    text[n] = 0;
    close(told[0]);
    return how;
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
    char text[8];

    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) {
        int how;

        how = end_of(by_raise, deadly[i], text);
        assert_true(WIFSIGNALED(how));
        assert_int_equal(WTERMSIG(how), deadly[i]);
        assert_string_equal(text, "21");
    }
}

TEST(faults)
{
    char text[8];
    int how;

    how = end_of(by_fault, 0, text);
    assert_true(WIFSIGNALED(how));
    assert_int_equal(WTERMSIG(how), SIGSEGV);
    assert_string_equal(text, "21");
    how = end_of(by_abort, 0, text);
    assert_true(WIFSIGNALED(how));
    assert_int_equal(WTERMSIG(how), SIGABRT);
    assert_string_equal(text, "21");
}

/* An abort in a library is an exit with 1, one of glint itself a death. */
TEST(library)
{
    char text[8];
    int how;

    how = end_of(by_library, 1, text);
    assert_true(WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 1);
    assert_string_equal(text, "21r");
    how = end_of(by_exit_of_library, 4, text);
    assert_true(WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 4);
    assert_string_equal(text, "21r");
    how = end_of(by_library, 0, text);
    assert_true(WIFSIGNALED(how));
    assert_int_equal(WTERMSIG(how), SIGABRT);
    assert_string_equal(text, "21");
}

TEST(exit)
{
    char text[8];
    int how;

    how = end_of(by_exit, 3, text);
    assert_true(WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 3);
    assert_string_equal(text, "21");
    end_of(by_quick_exit, 3, text);
    assert_string_equal(text, "");
}

/* A handler of the application's own that ends the process by
 * glint_at_death_by() must have the functions run. */
TEST(own_handler)
{
    char text[8];
    int how;

    how = end_of(by_own_handler, SIGINT, text);
    assert_true(WIFSIGNALED(how));
    assert_int_equal(WTERMSIG(how), SIGINT);
    assert_string_equal(text, "h21");
}

TEST(ignored)
{
    char text[8];
    int how;

    how = end_of(by_ignored, SIGHUP, text);
    assert_true(WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 5);
    /* SIGPIPE and SIGXFSZ are ignored from the first call on, so that end_of()
     * comes to its exit code 0. */
    how = end_of(by_raise, SIGPIPE, text);
    assert_true(WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 0);
    how = end_of(by_raise, SIGXFSZ, text);
    assert_true(WIFEXITED(how));
}
