/* SPDX-License-Identifier: MIT
 *
 * live_signals.h - signals to a live run. A signal that arrives while the run
 * waits wakes it; none is lost between checking and waiting.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_SIGNALS_H
#define GLINT_TOOLS_LIVE_LIVE_SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

enum live_signal {
    LIVE_STOP,       /* SIGINT, SIGTERM; the second one kills */
    LIVE_RELOAD,     /* SIGHUP */
    LIVE_REPORT_NOW, /* SIGUSR1 */
    LIVE_SNAPSHOT,   /* SIGUSR2 */
    LIVE_N_SIGNALS
};

void live_signals_take(void);

/* Returns whether WHICH was requested since the last call; a stop stays. */
bool live_signal(enum live_signal which);

/* Waits until FD (unless -1) is readable, has an event or an error, a signal
 * has arrived that live_signal() has not told yet (except for a snapshot, which
 * needs a frame), or MS have passed. */
void live_signals_wait(int fd, int ms);

#endif
