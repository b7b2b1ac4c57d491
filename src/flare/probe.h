/* SPDX-License-Identifier: MIT
 *
 * Traces a few rays of a bundle by its polynomials. Computes their extent on
 * the sensor, and how all outputs of the polynomials change from ray to ray.
 *
 *    in   the polynomials of a bundle, the number of rays
 *    out  extents, sums of differences, numbers of cells by orientation */
#ifndef GLINT_FLARE_PROBE_H
#define GLINT_FLARE_PROBE_H

#include "glint/transfer.h"

/* A bounding box of rays on the sensor, in units of the sensor outputs. If the
 * ray bundle is symmetric in y, y_low is -y_high. */
struct glint_probe_extent {
    int64_t low, high, y_low, y_high;
};

/* Max number of cells across the pupil box, and down half of the box. */
enum { GLINT_PROBE_ACROSS = 16, GLINT_PROBE_DOWN = 8 };

struct glint_probe_node {
    int32_t at[GLINT_OUT_KINDS];
    int inside; /* nonzero: the ray passes the stop and the barrel apertures, or
                   misses by at most 5 % of their radius */
};

/* Changes of one output from ray to ray: sums of the squared first and second
 * differences in both directions. bent: sums of the second differences
 * themselves, across and down. */
struct glint_probe_change {
    uint64_t first, second;
    int64_t bent[2];
};

struct glint_probe {
    /* [j % 3]: row j of rays, one of the last three */
    struct glint_probe_node row[3][GLINT_PROBE_ACROSS + 1];
    struct glint_probe_change change[GLINT_OUT_KINDS];
    /* Numbers of cells. across: across the window. rows: down the window. down:
     * rows that are traced, half of them if rays have mirror images. */
    int across, down, rows;
    int whole;  /* 1: rays have no mirror image */
    int n_rays; /* number of rays traced for this ray bundle, over all its
                   probes */
    int n_bends, n_bent[2], n_inside, n_kinds;
    /* [n_kinds]: the outputs of this ray bundle's polynomials, except energy */
    uint8_t kind[GLINT_OUT_KINDS];
    int n_up, n_down; /* numbers of half cells of positive (n_up) and negative
                         (n_down) orientation on the sensor; a ghost with both
                         is folded */
    /* extent of the rays that pass the stop and the barrel apertures */
    struct glint_probe_extent seen;
    /* extent of all cells with at least one corner ray inside, which contains
     * the light between rays, too */
    struct glint_probe_extent reach;
    int64_t energy;
    uint64_t least_area;            /* min area on the sensor of half a cell */
    int64_t limit[GLINT_OUT_KINDS]; /* [kind]: max magnitude of an output of
                                       this kind for a ray inside */
};

/* number of bits by which differences are shifted right before they are
 * squared */
enum { GLINT_PROBE_FINE_LOG2 = 6 };

/* Traces a grid of ACROSS x DOWN cells over half the window of T. If member
 * whole of T is set, traces ACROSS x 2 DOWN cells over the complete window. The
 * stop's radius is OPENING_Q30 times that of the model. Adds to n_rays of
 * PROBE, and sets all other members. */
void glint_probe_trace_bundle(struct glint_probe *probe,
                              struct glint_transfer *t, int32_t opening_q30,
                              int across, int down);

#endif
