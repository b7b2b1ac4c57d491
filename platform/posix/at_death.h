/* SPDX-License-Identifier: MIT
 *
 * posix/at_death.h - functions that put objects right whatever ends the
 * process.
 *
 *     glint_at_death(remove_files);       once
 *
 * Functions given here run, the newest first, at exit() and when a signal kills
 * the process: those that ask it to end (SIGHUP, SIGINT, SIGTERM, SIGQUIT ...)
 * and those of its own faults (SIGSEGV, SIGABRT ...). The signal then does what
 * it does by default, so that a parent sees the status it expects. After
 * SIGKILL, _exit() and a fault for want of stack no function runs.
 *
 * The first call changes how the process takes signals that the application
 * has left at their default: SIGPIPE and SIGXFSZ are ignored, so that writing
 * fails instead, and deadly ones get a handler. An application with handlers of
 * its own must end by exit() or glint_at_death_by().
 */
#ifndef GLINT_PLATFORM_POSIX_AT_DEATH_H
#define GLINT_PLATFORM_POSIX_AT_DEATH_H

#include <stdbool.h>

/* A function to run at death. It must be async-signal-safe and keep errno, and
 * may run more than once and while other threads continue. */
typedef void glint_at_death_fn(void);

/* Adds FN for the rest of the process; does nothing if it was added before.
 * Returns false if there are 8 others already, which is a mistake in glint. */
bool glint_at_death(glint_at_death_fn *fn);

/* Has a library that ends the process reported: by exit(), as libjpeg does, or
 * by an abort (SIGABRT, an assertion, std::terminate), which becomes exit code
 * 1. REPORT, which must be async-signal-safe, returns 0 if the library is not
 * at work, else prints a message. A later REPORT replaces it. */
void glint_at_death_in_library(int (*report)(void));

/* Runs all functions and dies of SIGNAL_NUMBER by its default action; for
 * signal handlers that have waited long enough. Async-signal-safe. */
void glint_at_death_by(int signal_number);

#endif
