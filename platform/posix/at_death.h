/* SPDX-License-Identifier: MIT
 *
 * posix/at_death.h - what must be put right whatever ends the process.
 *
 *     glint_at_death(remove_files);       once
 *
 * Functions given here run, the newest first, at exit() and when a signal kills
 * the process: those that ask it to end (SIGHUP, SIGINT, SIGTERM, SIGQUIT ...)
 * and those of its own faults (SIGSEGV, SIGABRT ...). The signal then does what
 * it does by default, so that a parent sees the status it expects. SIGKILL,
 * _exit() and a fault for want of stack are beyond all this.
 *
 * The first call changes how the process takes signals, where the application
 * has not: SIGPIPE and SIGXFSZ are ignored, so that writing fails instead, and
 * the deadly ones get a handler. An application with handlers of its own ends
 * by itself and with exit(), or calls glint_at_death_by().
 */
#ifndef GLINT_PLATFORM_POSIX_AT_DEATH_H
#define GLINT_PLATFORM_POSIX_AT_DEATH_H

#include <stdbool.h>

/* Async-signal-safe, keeps errno, and may run more than once and while another
 * thread goes on. */
typedef void glint_at_death_fn(void);

/* Adds FN, for good; again does nothing. False: there are too many, which is
 * a mistake of ours. */
bool glint_at_death(glint_at_death_fn *fn);

/* Runs them all and dies of SIGNAL_NUMBER, as if nobody had handled it; for
 * signal handlers that have waited long enough. Async-signal-safe. */
void glint_at_death_by(int signal_number);

#endif
