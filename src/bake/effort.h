/* SPDX-License-Identifier: MIT
 *
 * Estimates the progress of a bake. The number of zones of a ghost is not known
 * before they are fitted.
 *
 *     for each ghost that worker 0 fits:
 *         glint_effort_begin_ghost(&effort, ghost);
 *         glint_effort_record_work(&effort, work, share); ...
 *         glint_effort_end_ghost(&effort);
 *     glint_effort_estimate_progress(&effort) at any time
 *
 * Work is counted in fits of a zone, about 40 ms each. The total work of the
 * current ghost is extrapolated from the fraction of its angles that are done;
 * the work of a ghost that was not begun is the mean of the finished ghosts.
 * Only worker 0 counts; the others are assumed to be as fast. Limits: the work
 * of ghosts differs by factors up to 100, so the estimate of the remaining work
 * may be wrong by a factor of 2 or 3 in the first half of a bake.
 */
#ifndef GLINT_BAKE_EFFORT_H
#define GLINT_BAKE_EFFORT_H

#include <stdbool.h>

struct glint_effort {
    int n_ghosts, n_workers;
    double head; /* zone fits of work before the first ghost is fitted */
    double look; /* work of finding the visible angles of one ghost */
    /* assumed work per ghost until the first one is finished */
    double typical;
    /* work of all ghosts as set by glint_effort_set_estimates(); 0: unknown */
    double expected;
    /* largest index of the ghosts that worker 0 has begun; -1: none */
    int ghost;
    int n_ended;  /* number of ghosts that worker 0 has finished */
    double ended; /* work of the finished ghosts, zone fits */
    double work;  /* work so far of worker 0's current ghost, zone fits */
    /* fraction of the current ghost's angles that are done, 0 .. 1 */
    double share;
};

/* Classes of lenses by bake time. Fast lenses (f-number below GLINT_WIDE) and
 * lenses with non-spherical surfaces take longer per ghost. */
enum glint_effort_kind {
    GLINT_EFFORT_NARROW,
    GLINT_EFFORT_WIDE,
    GLINT_EFFORT_SHAPED
};

void glint_effort_init(struct glint_effort *effort, int n_ghosts, int n_workers,
                       enum glint_effort_kind kind);

/* Sets the estimates HEAD (work before the first ghost) and TYPICAL (mean work
 * of a ghost). Used for lenses that are not round. Their last ghosts cost a
 * hundred times as much as the first ones, because the rays of the last ghosts
 * form caustics. */
void glint_effort_set_estimates(struct glint_effort *effort, double head,
                                double typical);

void glint_effort_begin_ghost(struct glint_effort *effort, int ghost);

/* Records that worker 0 has spent WORK zone fits on its current ghost so far
 * and finished the fraction SHARE of the ghost's angles. */
void glint_effort_record_work(struct glint_effort *effort, double work,
                              double share);

void glint_effort_end_ghost(struct glint_effort *effort);

/* Returns the estimated fraction of the bake that is done, 0 .. 1. It decreases
 * when a ghost costs more than expected. */
double glint_effort_estimate_progress(const struct glint_effort *effort);

#endif
