/* SPDX-License-Identifier: MIT
 *
 * Finds the range of a bundle's pupil box whose rays pass a stop that is
 * narrower than the stop of the model.
 *
 *   in   the polynomials of a bundle, the stop's radius
 *   out  a window of the box
 *
 * Method: rays of a coarse grid over the window go through the polynomials of
 * stop and barrels. A cell is left out if all four corners lie outside the same
 * side of an octagon around the stop, or outside the same barrel, by more than
 * the outputs deviate from straight lines between rays. The window shrinks to
 * the cells that are left, repeatedly, until it barely gets smaller. Where
 * cells are fine, the sides of the window lie where the stop's circle crosses
 * the lines of the grid, so that they move smoothly with the stop's radius. */
#ifndef GLINT_FLARE_WINDOW_H
#define GLINT_FLARE_WINDOW_H

#include "glint/transfer.h"

/* Number of nodes across the window, and down half of it. */
enum { GLINT_WINDOW_ACROSS = 2 * GLINT_RAYS, GLINT_WINDOW_DOWN = GLINT_RAYS };

/* Scratch of a worker. Each output is in its own unit, see struct
 * glint_transfer. */
struct glint_window_nodes {
    int32_t at[GLINT_OUT_KINDS][GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int32_t bend[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    uint32_t beyond[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    /* nonzero: the ray passes through the stop */
    uint8_t inside[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int64_t radius; /* radius of the stop, in units of the stop outputs */
    int n_rays;     /* number of rays traced so far */
};

/* Narrows the window of T to the range that a stop of OPENING_Q30 times the
 * model's radius, 2^20 .. 2^30, lets through. Returns 0 if no ray gets
 * through. */
int glint_window_narrow_to_stop(struct glint_window_nodes *nodes,
                                struct glint_transfer *t, int32_t opening_q30);

#endif
