/* SPDX-License-Identifier: MIT
 *
 * Traces a few rays of a bundle through its polynomials: where they land, how
 * they spread, how the outputs change from ray to ray.
 *
 *   in   the polynomials of a bundle, how many rays
 *   out  extents, sums of differences, numbers of cells by orientation */
#ifndef GLINT_FLARE_PROBE_H
#define GLINT_FLARE_PROBE_H

#include "glint/transfer.h"

/* The range in which light lands, in units of the sensor outputs: least and
 * largest x and y. Where light is symmetric in y, both y are each other's
 * negative. */
struct glint_probe_extent {
    int64_t low, high, y_low, y_high;
};

/* Most cells across the pupil, and down half of it. */
enum { GLINT_PROBE_ACROSS = 16, GLINT_PROBE_DOWN = 8 };

struct glint_probe_node {
    int32_t at[GLINT_OUT_KINDS];
    int inside; /* nonzero: the ray passes the stop and the barrels, or nearly
                 */
};

/* How an output changes from ray to ray, across and down: sums of squares of
 * first and of second differences, and the plain sum of second differences for
 * each of the two ways. */
struct glint_probe_change {
    uint64_t first, second;
    int64_t bent[2];
};

struct glint_probe {
    /* The last three rows of rays. */
    struct glint_probe_node row[3][GLINT_PROBE_ACROSS + 1];
    struct glint_probe_change change[GLINT_OUT_KINDS];
    /* Number of cells across the window and down half of it, or down all of it
     * where rays have no mirror image; and down all of it in any case. */
    int across, down, rows;
    int whole;  /* as in struct glint_transfer */
    int n_rays; /* number of rays of all probes of the bundle */
    int n_bends, n_bent[2], n_inside, n_kinds;
    /* Kinds of outputs of this bundle, without energy: [n_kinds]. */
    uint8_t kind[GLINT_OUT_KINDS];
    int n_up, n_down; /* numbers of cells turned one way and the other */
    /* Range of the rays inside stop and barrels. */
    struct glint_probe_extent seen;
    /* Range of all corners of the cells that have a ray inside, and so of the
     * light between rays, too. */
    struct glint_probe_extent reach;
    int64_t energy;
    uint64_t least_area; /* area of the smallest half of a cell on the sensor */
    int64_t limit[GLINT_OUT_KINDS]; /* largest value that counts as inside */
};

/* log2 of the divisor of differences before they are squared */
enum { GLINT_PROBE_FINE_LOG2 = 6 };

/* Sends the rays of a grid of ACROSS x DOWN cells over half the window of T
 * towards a stop of OPENING_Q30 of the model's radius; over all of it, with
 * twice as many DOWN, where T is whole. Adds to n_rays; all
 * other members restart. */
void glint_probe_run(struct glint_probe *probe, struct glint_transfer *t,
                     int32_t opening_q30, int across, int down);

#endif
