/* SPDX-License-Identifier: MIT
 *
 * Bakes the model of a lens in a child process, while frames are drawn by exact
 * rays.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_BAKE_H
#define GLINT_TOOLS_LIVE_LIVE_BAKE_H

#include <sys/types.h>

#include "model/settings.h"

enum live_bake_state {
    LIVE_BAKE_NONE,    /* no bake was started, or its end was reported */
    LIVE_BAKE_RUNNING, /* the child process bakes */
    LIVE_BAKE_DONE,    /* the model is in the cache */
    LIVE_BAKE_FAILED   /* the child process has printed the reason, or was
                          killed */
};

struct live_bake {
    pid_t child; /* 0: no child process */
};

/* Starts the bake of the lens of SETTINGS, at a low priority, into the
 * cache of models. Devices must not be open, because the child process would
 * keep them open. Returns false if no process can be started, or if there is no
 * folder for the cache. */
bool live_bake_start(struct live_bake *bake, const struct tool *tool,
                     const struct settings *settings);

/* Returns the state of the bake. LIVE_BAKE_DONE and LIVE_BAKE_FAILED are
 * returned once. */
enum live_bake_state live_bake_poll(struct live_bake *bake);

/* Ends the child process, if there is one. */
void live_bake_stop(struct live_bake *bake);

#endif
