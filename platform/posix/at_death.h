/* SPDX-License-Identifier: MIT
 *
 * posix/at_death.h - clean-up functions that run when the process exits or is
 * killed by a signal.
 *
 *     glint_at_death_register(remove_files);       once
 *
 * Registered functions run at exit() and when a signal kills the process, the
 * latest first. The signal may be a request to end (SIGHUP, SIGINT, SIGTERM,
 * SIGQUIT ...) or a fault of the process (SIGSEGV, SIGABRT ...). The signal's
 * default action follows, so that a parent sees the status that it expects. No
 * function runs after SIGKILL, _exit() or a stack overflow.
 *
 * The first call changes the actions of signals, except those for which the
 * application has set an action. SIGPIPE and SIGXFSZ are ignored, so that
 * writing fails instead. Signals that kill the process get a handler. An
 * application with handlers of its own must end by exit() or
 * glint_at_death_end_by_signal().
 */
#ifndef GLINT_PLATFORM_POSIX_AT_DEATH_H
#define GLINT_PLATFORM_POSIX_AT_DEATH_H

#include <stdbool.h>

/* A function to run at death. It must be async-signal-safe and preserve errno.
 * It may run more than once, and while other threads run. */
typedef void glint_at_death_fn(void);

/* Registers FN for the rest of the process; does nothing if FN is registered
 * already. Returns false if 8 other functions are registered, which is a bug in
 * glint. */
bool glint_at_death_register(glint_at_death_fn *fn);

/* Sets REPORT, which replaces an earlier one. It is called when a library may
 * have ended the process: by exit(), as libjpeg does; by an abort (SIGABRT, an
 * assertion, std::terminate) or an access to invalid memory; both then become
 * exit code 1. REPORT must be async-signal-safe. It must return 0 if the
 * library is not running; otherwise it prints a message and returns 1. */
void glint_at_death_set_library_report(int (*report)(void));

/* Runs all registered functions, then ends the process by the default action of
 * SIGNAL_NUMBER. Signal handlers of an application call it.
 * Async-signal-safe. */
void glint_at_death_end_by_signal(int signal_number);

#endif
