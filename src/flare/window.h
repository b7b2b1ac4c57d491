/* SPDX-License-Identifier: MIT
 *
 * Which part of a bundle's box the rays come from that a stop lets through
 * which is narrower than the one that the model was baked for.
 *
 *   in   the polynomials of a bundle, the stop's radius
 *   out  a window of the box
 *
 * Method: rays of a coarse grid over the window go through the polynomials of
 * stop and barrels. A cell is left out where all four corners lie beyond the
 * same side of an octagon around the stop, or beyond the same barrel, by more
 * than what is bent between rays. The window shrinks to what is left until that
 * is resolved; then its sides lie where the stop's circle crosses the lines of
 * the grid, so that they move with the stop's radius without steps.
 */
#ifndef GLINT_FLARE_WINDOW_H
#define GLINT_FLARE_WINDOW_H

#include "glint/transfer.h"

/* Nodes across the window and down half of it. */
enum { GLINT_WINDOW_ACROSS = 2 * GLINT_RAYS, GLINT_WINDOW_DOWN = GLINT_RAYS };

/* Scratch of a worker: outputs in their own units. */
struct glint_window_nodes {
    int32_t at[GLINT_OUT_KINDS][GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int32_t bend[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    uint32_t beyond[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    /* nonzero: the ray is inside of the stop */
    uint8_t inside[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int64_t radius; /* radius of the stop, in the units of positions in it */
    int n_rays;     /* number of all rays sent */
};

/* Narrows the window of T to what a stop of OPENING_Q30, 2^20 .. 2^30, of the
 * model's radius lets through. Returns 0 where that is nothing. */
int glint_window_find(struct glint_window_nodes *nodes,
                      struct glint_transfer *t, int32_t opening_q30);

#endif
