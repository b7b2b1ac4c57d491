/* SPDX-License-Identifier: MIT
 *
 * Traces a few rays of a bundle through its polynomials: finds their positions
 * on the sensor, their extent, and how the outputs change from ray to ray.
 *
 *    in   the polynomials of a bundle, the number of rays
 *    out  extents, sums of differences, numbers of cells by orientation
 */
#ifndef GLINT_FLARE_PROBE_H
#define GLINT_FLARE_PROBE_H

#include "glint/transfer.h"

/* The bounding box of the light on the sensor, in units of the sensor outputs:
 * min and max x and y. If the light is symmetric in y, y_low is -y_high. */
struct glint_probe_extent {
    int64_t low, high, y_low, y_high;
};

/* Max cells across the pupil, and down half of it. */
enum { GLINT_PROBE_ACROSS = 16, GLINT_PROBE_DOWN = 8 };

struct glint_probe_node {
    int32_t at[GLINT_OUT_KINDS];
    int inside; /* nonzero: the ray passes the stop and the barrels, or misses
                   by at most 5 % of their radius */
};

/* How an output changes from ray to ray, across and down: sums of squares of
 * first and of second differences over both directions, and the plain sum of
 * second differences for each direction. */
struct glint_probe_change {
    uint64_t first, second;
    int64_t bent[2];
};

struct glint_probe {
    /* The last three rows of rays, by row number modulo 3. */
    struct glint_probe_node row[3][GLINT_PROBE_ACROSS + 1];
    struct glint_probe_change change[GLINT_OUT_KINDS];
    /* Numbers of cells. across: across the window; down: down half the
     * window, or down all of it if rays have no mirror image; rows: down all
     * of the window. */
    int across, down, rows;
    int whole;  /* as in struct glint_transfer */
    int n_rays; /* number of rays of all probes of the bundle */
    int n_bends, n_bent[2], n_inside, n_kinds;
    /* Kinds of outputs of this bundle, except energy: [n_kinds]. */
    uint8_t kind[GLINT_OUT_KINDS];
    int n_up, n_down; /* numbers of cells of positive and of negative
                         orientation */
    /* Range of the rays that pass the stop and the barrels. */
    struct glint_probe_extent seen;
    /* Range of all corners of the cells that have a ray inside; it also
     * contains the light between rays. */
    struct glint_probe_extent reach;
    int64_t energy;
    uint64_t least_area; /* area of the smallest half of a cell on the sensor */
    int64_t limit[GLINT_OUT_KINDS]; /* max magnitude of an output that counts as
                                       inside */
};

/* log2 of the divisor of differences before they are squared */
enum { GLINT_PROBE_FINE_LOG2 = 6 };

/* Traces the rays of a grid of ACROSS x DOWN cells over half the window of T,
 * or of ACROSS x 2 DOWN cells over all of it if T is whole. The stop has
 * OPENING_Q30 times the model's radius. Adds to n_rays; resets all other
 * members. */
void glint_probe_trace_bundle(struct glint_probe *probe,
                              struct glint_transfer *t, int32_t opening_q30,
                              int across, int down);

#endif
