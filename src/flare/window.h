/* SPDX-License-Identifier: MIT
 *
 * Finds the part of a bundle's box from which rays get through a stop that is
 * narrower than the one the model was baked for.
 *
 *   in   the polynomials of a bundle, the stop's radius
 *   out  a window of the box
 *
 * Method: rays of a coarse grid over the window go through the polynomials of
 * stop and barrels. A cell is left out if all four corners lie beyond the same
 * side of an octagon around the stop, or beyond the same barrel, by more than
 * the outputs bend between rays. The window shrinks to the cells that are left,
 * repeatedly, until it barely gets smaller. Where cells are fine, its sides lie
 * where the stop's circle crosses the lines of the grid, so that they move with
 * the stop's radius without steps. */
#ifndef GLINT_FLARE_WINDOW_H
#define GLINT_FLARE_WINDOW_H

#include "glint/transfer.h"

/* Number of nodes across the window, and down half of it. */
enum { GLINT_WINDOW_ACROSS = 2 * GLINT_RAYS, GLINT_WINDOW_DOWN = GLINT_RAYS };

/* Scratch of a worker. Outputs are in their own units. */
struct glint_window_nodes {
    int32_t at[GLINT_OUT_KINDS][GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int32_t bend[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    uint32_t beyond[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    /* nonzero: the ray passes inside the stop */
    uint8_t inside[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int64_t radius; /* radius of the stop, in units of the stop position */
    int n_rays;     /* number of rays sent so far */
};

/* Narrows the window of T to the part that a stop of OPENING_Q30, 2^20 .. 2^30,
 * of the model's radius lets through. Returns 0 if no ray gets through. */
int glint_window_find(struct glint_window_nodes *nodes,
                      struct glint_transfer *t, int32_t opening_q30);

#endif
