/* SPDX-License-Identifier: MIT
 *
 * Holds the frame rate by reducing quality, a step at a time.
 *
 * It goes a step down at once when frames are missed or hardly any time is
 * left, or several steps if a frame takes several periods. It goes a step up
 * only after a while with time to spare, and that while is doubled each time
 * that a step up proves to be too early. Steps go down the table of --quality;
 * below its end there are fewer lights.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_ADAPT_H
#define GLINT_TOOLS_LIVE_LIVE_ADAPT_H

#include <stdbool.h>

#include "glint/dials.h"

#define LIVE_MAX_STEP 7

struct live_adapt {
    int step;       /* 0 .. LIVE_MAX_STEP; 0: as requested */
    double busy_ms; /* smoothed time of a frame; -1: none since the last step */
    /* below_s: seconds for which there has been time to spare; hold_s: seconds
     * of that which a step up needs. */
    double below_s, hold_s;
    double since_s; /* seconds since the last step */
    /* true: the last change was a step up, to better quality (STEP fell) */
    bool rose;
};

void live_adapt_init(struct live_adapt *adapt);

/* Notes a frame that took BUSY_MS of its period PERIOD_MS, after N_MISSED lost
 * ones. Returns whether the step has changed. */
bool live_adapt_note(struct live_adapt *adapt, double busy_ms, double period_ms,
                     int n_missed);

/* Returns the dials Requested, made as coarse as ADAPT's step. */
struct glint_dials live_adapt_dials(const struct live_adapt *adapt,
                                    struct glint_dials asked);

/* Returns the quality, as of --quality, that a scene is drawn no finer than. */
double live_adapt_quality(const struct live_adapt *adapt);

#endif
