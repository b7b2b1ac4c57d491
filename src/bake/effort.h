/* SPDX-License-Identifier: MIT
 *
 * How much of the work of a bake is done: an estimate, as nobody knows how
 * often the zones of a ghost will be halved before they have been fitted.
 *
 *     glint_effort_begin(&effort, ghost);              worker 0, for each of
 *     glint_effort_spend(&effort, work, share); ...    its ghosts
 *     glint_effort_end(&effort);
 *     ... glint_effort_done(&effort) ...
 *
 * Work is counted in fits of a zone, about 40 ms. What a ghost will have taken
 * is what it took so far by the fraction of its angles that this was for; what
 * ghosts take that nobody began is the mean of those that one did. Only worker
 * 0 counts; the others are taken to be as fast. Limits: ghosts differ a
 * hundredfold, so that the work left may be off by two or three times in the
 * first half of a bake.
 */
#ifndef GLINT_BAKE_EFFORT_H
#define GLINT_BAKE_EFFORT_H

#include <stdbool.h>

struct glint_effort {
    int n_ghosts, n_workers;
    double head;     /* work before ghosts are begun */
    double look;     /* work of finding the angles of a ghost */
    double typical;  /* work of a ghost, before any is known */
    double expected; /* work of all ghosts; 0: nobody knows */
    int ghost;       /* the largest that was begun; -1: none */
    int n_ended;     /* number of ghosts that worker 0 ended */
    double ended;    /* work of these */
    double work;     /* of the ghost that worker 0 is at */
    double share;    /* fraction of its angles that are done, 0 .. 1 */
};

/* What makes the ghosts of a lens take long: it opens wider than GLINT_WIDE, or
 * has surfaces that are not spheres. */
enum glint_effort_kind {
    GLINT_EFFORT_NARROW,
    GLINT_EFFORT_WIDE,
    GLINT_EFFORT_SHAPED
};

void glint_effort_init(struct glint_effort *effort, int n_ghosts, int n_workers,
                       enum glint_effort_kind kind);

/* Replaces what is expected by HEAD and TYPICAL: N times TYPICAL is the work of
 * all ghosts. Of lenses that are not round the last ghosts fold, and take a
 * hundred times as long as the first ones. */
void glint_effort_expect(struct glint_effort *effort, double head,
                         double typical);

void glint_effort_begin(struct glint_effort *effort, int ghost);

/* The ghost has taken WORK fits so far, for the fraction of its angles. */
void glint_effort_spend(struct glint_effort *effort, double work, double share);

void glint_effort_end(struct glint_effort *effort);

/* Returns the fraction of the work that is done, 0 .. 1: less than before where
 * a ghost turns out to take longer. */
double glint_effort_done(const struct glint_effort *effort);

#endif
