/* SPDX-License-Identifier: MIT
 *
 * live_signals.h - signals to a live run. A signal ends a wait even if it
 * arrives just before the wait begins.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_SIGNALS_H
#define GLINT_TOOLS_LIVE_LIVE_SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

enum live_signal {
    LIVE_STOP,       /* SIGINT, SIGTERM; the second signal kills the process */
    LIVE_RELOAD,     /* SIGHUP: reads configuration and lens again */
    LIVE_REPORT_NOW, /* SIGUSR1: prints the statistics now */
    LIVE_SNAPSHOT,   /* SIGUSR2: saves a snapshot */
    LIVE_N_SIGNALS
};

void live_signals_install(void);

/* Returns whether signal WHICH arrived since the last call. LIVE_STOP stays
 * true. */
bool live_signals_has_arrived(enum live_signal which);

/* Waits until FD (-1: none) is readable or has an event or an error, or for MS
 * milliseconds. A signal ends the wait at once, even a signal that arrived
 * before the wait, unless live_signals_has_arrived() has returned it already.
 * LIVE_SNAPSHOT, which needs a frame, does not end the wait. */
void live_signals_wait(int fd, int ms);

#endif
