/* SPDX-License-Identifier: MIT
 *
 * Probes a bundle: traces a few of its rays by its polynomials, and computes
 * their extent on the sensor and how all outputs change from ray to ray.
 *
 *    in   the polynomials of a bundle, the number of rays
 *    out  extents, sums of differences, numbers of cells by orientation
 */
#ifndef GLINT_FLARE_PROBE_H
#define GLINT_FLARE_PROBE_H

#include "glint/transfer.h"

/* A bounding box of rays on the sensor, in units of the sensor outputs: min and
 * max x and y. If the bundle is symmetric in y, y_low is -y_high. */
struct glint_probe_extent {
    int64_t low, high, y_low, y_high;
};

/* Max number of cells across the pupil box, and down half of it. */
enum { GLINT_PROBE_ACROSS = 16, GLINT_PROBE_DOWN = 8 };

struct glint_probe_node {
    int32_t at[GLINT_OUT_KINDS];
    int inside; /* nonzero: the ray passes the stop and the barrels, or misses
                   by at most 5 % of their radius */
};

/* Changes of one output from ray to ray: sums of the squared first and second
 * differences in both directions; and the sum of second differences in each
 * direction (bent: across, down). */
struct glint_probe_change {
    uint64_t first, second;
    int64_t bent[2];
};

struct glint_probe {
    /* the last three rows of rays, indexed by row number modulo 3 */
    struct glint_probe_node row[3][GLINT_PROBE_ACROSS + 1];
    struct glint_probe_change change[GLINT_OUT_KINDS];
    /* Numbers of cells: across the window (across); down half the window, or
     * down all of it if rays have no mirror image (down); down all of the
     * window (rows). */
    int across, down, rows;
    int whole;  /* as in struct glint_transfer */
    int n_rays; /* number of rays of all probes of the bundle */
    int n_bends, n_bent[2], n_inside, n_kinds;
    /* [n_kinds]: outputs that this bundle has, except energy */
    uint8_t kind[GLINT_OUT_KINDS];
    int n_up, n_down; /* numbers of half cells of positive (n_up) and negative
                         (n_down) orientation; both are above 0 if the ghost is
                         folded */
    /* extent of the rays that pass the stop and the barrels */
    struct glint_probe_extent seen;
    /* extent of all corners of cells with at least one ray inside, which
     * contains the light between rays, too */
    struct glint_probe_extent reach;
    int64_t energy;
    uint64_t least_area;            /* min area on the sensor of half a cell */
    int64_t limit[GLINT_OUT_KINDS]; /* for each output, the magnitude below
                                       which a ray counts as inside */
};

/* Differences are shifted right by this before they are squared. */
enum { GLINT_PROBE_FINE_LOG2 = 6 };

/* Traces the rays of a grid of ACROSS x DOWN cells over half the window of T,
 * or of ACROSS x 2 DOWN cells over the complete window if T is whole. The
 * stop's radius is OPENING_Q30 times that of the model. Adds to n_rays of
 * PROBE, and sets all other members. */
void glint_probe_trace_bundle(struct glint_probe *probe,
                              struct glint_transfer *t, int32_t opening_q30,
                              int across, int down);

#endif
