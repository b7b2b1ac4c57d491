/* SPDX-License-Identifier: MIT
 *
 * A few rays of a bundle through its polynomials: where they land, how they
 * spread, how the outputs change from ray to ray.
 *
 *   in   the polynomials of a bundle, how many rays
 *   out  extents, sums of differences, cells by the way they are turned
 */
#ifndef GLINT_FLARE_PROBE_H
#define GLINT_FLARE_PROBE_H

#include "glint/transfer.h"

/* The range in which light lands: least and largest x on the sensor, and
 * largest y. */
struct glint_probe_extent {
    int64_t low, high, wide;
};

/* Most cells across the pupil and down half of it. */
enum { GLINT_PROBE_ACROSS = 16, GLINT_PROBE_DOWN = 8 };

struct glint_probe_node {
    int32_t at[GLINT_OUT_KINDS];
    int inside; /* nonzero: the ray passes the stop and the barrels, or nearly
                 */
};

/* How a quantity changes from ray to ray: sums of squares of differences, and
 * of second differences as they are, across the pupil and down. */
struct glint_probe_change {
    uint64_t first, second;
    int64_t bent[2];
};

struct glint_probe {
    struct glint_probe_node row[3][GLINT_PROBE_ACROSS + 1]; /* the last three */
    struct glint_probe_change change[GLINT_OUT_KINDS];
    int across, down; /* cells */
    int n_rays;       /* rays of all probes of the bundle */
    int n_bends, n_bent[2], n_inside, n_kinds;
    /* Kinds of outputs that there are, but energy. */
    uint8_t kind[GLINT_OUT_KINDS];
    int n_up, n_down;               /* cells by the way they are turned */
    struct glint_probe_extent seen; /* range of the rays inside */
    /* Range of the cells that have a ray inside, and so of what lies between
     * rays, too. */
    struct glint_probe_extent reach;
    int64_t energy;
    uint64_t least_area; /* area of the smallest half of a cell on the sensor */
    int64_t limit[GLINT_OUT_KINDS]; /* largest value that counts as inside */
};

/* log2 of what differences are divided by before they are squared */
enum { GLINT_PROBE_FINE_LOG2 = 6 };

/* Sends the rays of a grid of ACROSS x DOWN cells over half the window of T,
 * towards a stop of OPENING_Q30 of the model's radius. RUN adds to n_rays, and
 * begins all else anew. */
void glint_probe_run(struct glint_probe *probe, struct glint_transfer *t,
                     int32_t opening_q30, int across, int down);

#endif
