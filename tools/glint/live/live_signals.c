/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* for ppoll() */
#include "live/live_signals.h"

#include <poll.h>
#include <signal.h>
#include <stddef.h>
#include <time.h>

#include "posix/at_death.h"

static const struct {
    int number;
    enum live_signal meaning;
} taken[] = {{SIGINT, LIVE_STOP},
             {SIGTERM, LIVE_STOP},
             {SIGHUP, LIVE_RELOAD},
             {SIGUSR1, LIVE_REPORT_NOW},
             {SIGUSR2, LIVE_SNAPSHOT}};

enum { N_TAKEN = (int)(sizeof taken / sizeof *taken) };

static volatile sig_atomic_t asked[LIVE_N_SIGNALS];

/* Records that signal NUMBER arrived. A second signal to stop kills the
 * process. */
static void handle_signal(int number)
{
    for (int i = 0; i < N_TAKEN; i++)
        if (taken[i].number == number) {
            if (taken[i].meaning == LIVE_STOP && asked[LIVE_STOP])
                glint_at_death_end_by_signal(number);
            asked[taken[i].meaning] = 1;
        }
}

void live_signals_install(void)
{
    struct sigaction act = {.sa_handler = handle_signal};

    sigemptyset(&act.sa_mask);
    for (int i = 0; i < N_TAKEN; i++)
        sigaction(taken[i].number, &act, NULL);
    signal(SIGPIPE, SIG_IGN);
}

bool live_signals_has_arrived(enum live_signal which)
{
    const bool was = asked[which];

    /* The flag is reset only if it was set, because a signal that arrives
     * between the read and the reset would be lost otherwise. */
    if (was && which != LIVE_STOP)
        asked[which] = 0;
    return was;
}

/* Returns whether a signal must be handled before the next frame. A snapshot
 * needs a frame, so it does not count. */
static bool is_signal_pending(void)
{
    for (int i = 0; i < LIVE_N_SIGNALS; i++)
        if (asked[i] && i != LIVE_SNAPSHOT)
            return true;
    return false;
}

void live_signals_wait(int fd, int ms)
{
    struct pollfd p = {.fd = fd, .events = POLLIN | POLLPRI};
    const struct timespec timeout = {ms / 1000, ms % 1000 * 1000000L};
    sigset_t block, before;

    sigemptyset(&block);
    for (int i = 0; i < N_TAKEN; i++)
        sigaddset(&block, taken[i].number);
    sigprocmask(SIG_BLOCK, &block, &before);
    if (!is_signal_pending())
        ppoll(&p, 1, &timeout, &before);
    sigprocmask(SIG_SETMASK, &before, NULL);
}
