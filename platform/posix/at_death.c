/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* for SIGPROF, SIGSYS and others */
#include "posix/at_death.h"

#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <unistd.h>

#define MAX_FN 8

static const int deadly[] = {
    SIGHUP,    SIGINT,    SIGTERM, SIGQUIT, SIGUSR1, SIGUSR2,
    SIGALRM,   SIGVTALRM, SIGPROF, SIGXCPU, SIGSYS,  SIGABRT,
    SIGSEGV,   SIGBUS,    SIGILL,  SIGFPE,  SIGTRAP,
#ifdef SIGPOLL
    SIGPOLL,
#endif
#ifdef SIGPWR
    SIGPWR,
#endif
#ifdef SIGSTKFLT
    SIGSTKFLT,
#endif
};

/* registered functions, NULL after the last one; atomic */
static glint_at_death_fn *fns[MAX_FN];

static void run_all_handlers(void)
{
    for (int i = MAX_FN - 1; i >= 0; i--) {
        glint_at_death_fn *const fn =
            __atomic_load_n(&fns[i], __ATOMIC_SEQ_CST);

        if (fn)
            fn();
    }
}

/* function that reports an abort in a library, or NULL; atomic */
static int (*library_report)(void);

/* Prints a message and returns true if a library has ended the process. */
static bool report_library_abort(void)
{
    int (*const report)(void) =
        __atomic_load_n(&library_report, __ATOMIC_SEQ_CST);

    return report && report();
}

static void run_handlers_at_exit(void)
{
    run_all_handlers();
    report_library_abort();
}

/* These signals end the process if a library crashes on a malformed file. */
static bool is_library_fault(int signal_number)
{
    return signal_number == SIGABRT || signal_number == SIGSEGV ||
           signal_number == SIGBUS;
}

/* Signal handler. Runs all registered functions, then lets the signal kill the
 * process. After a fault in a library, exits with status 1 instead.
 * SA_RESETHAND has restored the default action, so the signal raised here kills
 * the process when the handler returns. */
static void handle_signal(int signal_number)
{
    run_all_handlers();
    if (is_library_fault(signal_number) && report_library_abort())
        _exit(EXIT_FAILURE);
    raise(signal_number);
}

/* Sets the action of SIGNAL_NUMBER to ACT, unless the application has set an
 * action. */
static void replace_default_action(int signal_number,
                                   const struct sigaction *act)
{
    struct sigaction old;

    if (!sigaction(signal_number, NULL, &old) && old.sa_handler == SIG_DFL)
        sigaction(signal_number, act, NULL);
}

static void install_signal_handlers(void)
{
    static const int broken[] = {SIGPIPE, SIGXFSZ};
    struct sigaction act = {.sa_handler = SIG_IGN};

    sigemptyset(&act.sa_mask);
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++)
        replace_default_action(broken[i], &act);
    act.sa_handler = handle_signal;
    act.sa_flags = (int)SA_RESETHAND;
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++)
        replace_default_action(deadly[i], &act);
#ifdef SIGRTMIN
    for (int i = SIGRTMIN; i <= SIGRTMAX; i++)
        replace_default_action(i, &act);
#endif
    atexit(run_handlers_at_exit);
}

static void install_signal_handlers_once(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    pthread_once(&once, install_signal_handlers);
}

void glint_at_death_set_library_report(int (*report)(void))
{
    install_signal_handlers_once();
    __atomic_store_n(&library_report, report, __ATOMIC_SEQ_CST);
}

bool glint_at_death_register(glint_at_death_fn *fn)
{
    install_signal_handlers_once();
    for (int i = 0; i < MAX_FN; i++) {
        glint_at_death_fn *none = NULL;

        if (__atomic_compare_exchange_n(&fns[i], &none, fn, false,
                                        __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST) ||
            none == fn)
            return true;
    }
    return false;
}

void glint_at_death_end_by_signal(int signal_number)
{
    struct sigaction act = {.sa_handler = SIG_DFL};
    sigset_t open;

    run_all_handlers();
    sigemptyset(&act.sa_mask);
    sigaction(signal_number, &act, NULL);
    sigemptyset(&open);
    sigaddset(&open, signal_number);
    pthread_sigmask(SIG_UNBLOCK, &open, NULL);
    raise(signal_number);
}
