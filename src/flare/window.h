/* SPDX-License-Identifier: MIT
 *
 * Narrows the window of a ray bundle, a rectangle of its pupil box, to the rays
 * that pass a stop that is narrower than the stop of the model.
 *
 *   in   the polynomials of a bundle, the stop's radius
 *   out  a window of the box
 *
 * Method: the polynomials of stop and barrel apertures are evaluated at the
 * nodes of a coarse grid over the window. A cell is discarded if all four
 * corners lie outside the same side of an octagon around the stop, or outside
 * the same barrel, by more than the outputs deviate from straight lines between
 * nodes. The window shrinks to the remaining cells, repeatedly, until it
 * shrinks by less than an eighth. Where cells are small, the sides of the
 * window are placed where the stop's circle crosses the lines of the grid, so
 * that they move smoothly with the stop's radius. */
#ifndef GLINT_FLARE_WINDOW_H
#define GLINT_FLARE_WINDOW_H

#include "glint/transfer.h"

/* Number of grid nodes across the window, and down half of it. */
enum { GLINT_WINDOW_ACROSS = 2 * GLINT_RAYS, GLINT_WINDOW_DOWN = GLINT_RAYS };

/* Scratch memory of a worker: the outputs at all nodes, in their own units
 * (struct glint_transfer), and values derived from them. */
struct glint_window_nodes {
    int32_t at[GLINT_OUT_KINDS][GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int32_t bend[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    uint32_t beyond[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    /* nonzero: the ray of the node passes through the stop */
    uint8_t inside[GLINT_WINDOW_DOWN][GLINT_WINDOW_ACROSS];
    int64_t radius; /* radius of the stop, in the unit of the stop position */
    int n_rays;     /* number of rays traced so far */
};

/* Narrows the window of T to the rays that may pass the stop. The stop has
 * OPENING_Q30 times the model's radius, 2^20 .. 2^30. Returns 0 if no ray
 * passes. */
int glint_window_narrow_to_stop(struct glint_window_nodes *nodes,
                                struct glint_transfer *t, int32_t opening_q30);

#endif
