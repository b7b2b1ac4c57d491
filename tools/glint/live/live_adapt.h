/* SPDX-License-Identifier: MIT
 *
 * Keeps the frame rate by changing quality in steps.
 *
 * Quality falls by one step if frames are missed or hardly any time is left,
 * and by several steps if a frame takes several frame periods. It rises only
 * after some seconds with spare time. Each time that a step up was too early,
 * this wait is doubled. If even the last step leaves too little time, quality
 * returns to the finest step that is as fast: the time of exact rays, for
 * example, depends little on quality. It then stays until the time changes, or
 * for that wait. Steps follow the table of --quality; steps
 * after the end of the table reduce the number of lights.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_ADAPT_H
#define GLINT_TOOLS_LIVE_LIVE_ADAPT_H

#include <stdbool.h>

#include "glint/dials.h"

#define LIVE_MAX_STEP 7

struct live_adapt {
    /* present step: 0, the requested quality, to LIVE_MAX_STEP, the coarsest */
    int step;
    /* number of frames since the last step; -1: before the first frame, which
     * also measures the lens and allocates memory */
    int n_frames;
    /* smoothed processing time of a frame, ms; -1: no frame since the last
     * step */
    double busy_ms;
    /* below_s: consecutive seconds with spare time so far; hold_s: min of
     * below_s for a step up */
    double below_s, hold_s;
    double since_s; /* seconds since the last step */
    /* min time of a frame at each step since time became scarce, ms; 0: none */
    double min_ms[LIVE_MAX_STEP + 1];
    /* Lower quality saved no time: time of a frame then, ms (0: it may save
     * time), and seconds until it is tried again. */
    double futile_ms, futile_s;
    /* whether the last change was a step up, to better quality */
    bool rose;
};

void live_adapt_init(struct live_adapt *adapt);

/* Records a frame that took BUSY_MS of its period PERIOD_MS, after N_MISSED
 * lost frames. Ignores the first frame. Returns whether the step has
 * changed. */
bool live_adapt_add_frame(struct live_adapt *adapt, double busy_ms,
                          double period_ms, int n_missed);

/* Returns the quality parameters ASKED, coarsened to ADAPT's step. */
struct glint_dials live_adapt_coarsen_parameters(const struct live_adapt *adapt,
                                                 struct glint_dials asked);

/* Returns the max --quality for drawing a scene at this step. */
double live_adapt_get_max_scene_quality(const struct live_adapt *adapt);

#endif
