/* SPDX-License-Identifier: MIT
 *
 * A dense grid of exact rays over a ghost's pupil, clipped exactly.
 *
 *   in   a path, a light in the x-z plane, the visible region of the pupil
 *   out  triangles of the grid, clipped by the stop and by the circle of each
 *        barrel that blocks rays of this path
 *
 * All channels are interpolated linearly between rays. In each triangle a
 * curved edge becomes a chord, so errors decrease with the square of the cell
 * size.
 */
#ifndef GLINT_BAKE_TRACE_CELLS_H
#define GLINT_BAKE_TRACE_CELLS_H

#include "engine/setup/iris.h"
#include "glint/setup.h"
#include "glint/trace.h"

enum { GLINT_MAX_CUTS = 48, GLINT_MAX_PIECE = 192 };

/* Channels: indices of the numbers that each node (ray) of the grid stores.
 * NODE_CUT and all later channels hold x and y at the barrels that may block
 * rays, in semi-diameters. */
enum {
    /* state of the ray: 0: invalid; 1: blocked by the stop or a barrel; 2:
     * passes the stop and all barrels */
    NODE_STATE,
    /* position on the sensor, mm in the camera's frame; callers may convert it
     * to other units */
    NODE_X,
    NODE_Y,
    NODE_STOP_X, /* position in the stop, stop radii, in the camera's frame */
    NODE_STOP_Y,
    NODE_ENERGY,
    NODE_CUT
};

struct glint_cells {
    const struct glint_setup *setup;
    const struct glint_path *path;
    struct glint_pupil pupil;
    double direction[3];
    /* cosine and sine of the rotation from the light's frame to the camera's */
    double cos_phi, sin_phi;
    int n; /* number of cells per side, even */
    int n_cuts;
    int cut_event[GLINT_MAX_CUTS];
    struct glint_iris_sides sides; /* of the stop */
    int stride;                    /* number of doubles per node */
    double *node; /* channels of all nodes, [n + 1][n + 1][stride] */
};

/* Sets all members except node, for a light at angle THETA_DEG and azimuth
 * PHI_DEG and for N cells per side; lists the barrels that block rays. Returns
 * false if no light passes. */
bool glint_cells_init(struct glint_cells *cells,
                      const struct glint_setup *setup,
                      const struct glint_path *path, double theta_deg,
                      double phi_deg, int n);

/* Returns the size of the member node in bytes. */
size_t glint_cells_compute_bytes(const struct glint_cells *cells);

/* Returns the number of rows of nodes that must be traced. */
int glint_cells_count_traced_rows(const struct glint_cells *cells);

/* Traces row ROW of the nodes. Round lenses: also sets its mirror image, row n
 * - ROW. */
void glint_cells_trace_row(const struct glint_cells *cells, int row);

/* The visible part of a triangle: a convex polygon in the channels NODE_X and
 * NODE_Y. */
struct glint_piece {
    int n; /* number of corners; 0: nothing is visible */
    double xy[GLINT_MAX_PIECE][2];
    /* visible fraction of the triangle, by area on the pupil, 0 .. 1 */
    double share;
    double energy; /* mean energy over the piece */
};

/* Clips triangle HALF (0 or 1) of cell (I, J) and sets PIECE to its visible
 * part. */
void glint_cells_clip_triangle(const struct glint_cells *cells, int i, int j,
                               int half, struct glint_piece *piece);

/* Returns whether cell (I, J) overlaps the range LOW .. HIGH of NODE_Y. */
bool glint_cells_overlap_range(const struct glint_cells *cells, int i, int j,
                               double low, double high);

/* Returns the area of a cell on the pupil, mm^2. */
double glint_cells_compute_cell_area(const struct glint_cells *cells);

/* numbers of cells per side of the pupil for glint_direct_compute_flux() */
enum { GLINT_FLUX_CELLS = 256, GLINT_FLUX_DRAFT_CELLS = 32 };

/* Returns the flux of the direct image of a light on the axis at irradiance 1,
 * mm^2, from rays at the corners of N x N cells; -1 if there is no
 * memory. */
double glint_direct_compute_flux(const struct glint_setup *setup,
                                 double wavelength_nm, int n);

#endif
