/* SPDX-License-Identifier: MIT
 *
 * Holds a frame rate by giving up accuracy, a step at a time.
 *
 * A step down at once when frames are missed or hardly any time is left,
 * several where a frame takes several periods; a step up only after a while
 * with time to spare, and a longer while each time that proved to be too early.
 * Steps go down the table of --quality; below it there are fewer lights.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_ADAPT_H
#define GLINT_TOOLS_LIVE_LIVE_ADAPT_H

#include <stdbool.h>

#include "glint/dials.h"

#define LIVE_MAX_STEP 7

struct live_adapt {
    int step;       /* 0: as asked for .. LIVE_MAX_STEP */
    double busy_ms; /* smoothed time of a frame; -1: none since the last step */
    /* Seconds for which there has been time to spare; seconds of that which a
     * step up needs. */
    double below_s, hold_s;
    double since_s; /* seconds since the last step */
    bool rose;      /* the last step was one up */
};

void live_adapt_init(struct live_adapt *adapt);

/* Notes a frame that took BUSY_MS of the PERIOD_MS there are, after N_MISSED
 * that were lost. Returns whether step has changed. */
bool live_adapt_note(struct live_adapt *adapt, double busy_ms, double period_ms,
                     int n_missed);

/* What becomes of the dials ASKED for at its step. */
struct glint_dials live_adapt_dials(const struct live_adapt *adapt,
                                    struct glint_dials asked);

#endif
