/* SPDX-License-Identifier: MIT
 *
 * Internal state of a veil, shared by the files of this folder.
 */
#ifndef GLINT_VEIL_PARTS_H
#define GLINT_VEIL_PARTS_H

#include "image/light_sum.h"
#include "tile/blend.h"
#include "veil/glare.h"

/* Number of pixels that are computed per vector operation. Tables have this
 * number of extra entries at their end. */
enum { GLINT_VEIL_LANES = 8 };

/* Position of the pixels of one axis (columns or rows) among the cells: for
 * each pixel, its cell and the weights for interpolation between cells. */
struct glint_veil_axis {
    uint8_t *cell;  /* index of the cell of each pixel, [side] */
    int32_t *start; /* index of the first pixel of each cell, [cells + 1] */
    /* Quadratic spline weights of each pixel, [side + LANES]. With t = 0 .. 1,
     * the position in the cell, they are (1 - t)^2 / 2 for the previous cell,
     * t^2 / 2 for the next cell, and the rest to 1 for the pixel's cell. */
    uint16_t *share_q16[3];
    /* for each cell, exact width / number of pixels summed, so that a uniform
     * picture gives uniform cells */
    uint32_t *fill_q16;
};

/* State of a worker that reads a picture, or draws a row of tiles. */
struct glint_veil_row {
    const struct glint_veil *veil;
    struct glint_box tile;
    /* Used while a picture is read: codes of its pixels, and the light of each
     * cell in one row of cells. */
    struct glint_codes codes;
    int64_t sum_q20[GLINT_VEIL_CELLS][3];
};

struct glint_veil {
    struct glint_veil_config cfg;
    int n_x, n_y; /* number of cells across (n_x) and down (n_y) */
    struct glint_veil_axis across, down;
    /* Light of the cells, [3][n_y][n_x], white times pixels, in three stages:
     * summed (light), scaled to 31 bits (narrow), convolved along x (along).
     */
    int64_t *light_q16;
    int32_t *narrow, *along;
    int64_t *sum_q30;  /* veil of each cell, 1 = white */
    int32_t *cell_q20; /* veil of each cell, 1 = white, clamped to 0 .. 2^28 */
    /* is_linear: 1 if the picture is linear. any: 1 if the veil is not
     * black. */
    int is_linear, any;
    const struct glint_veil_front *front; /* cover table of the front element,
                                             or NULL */
    int32_t *front_q20; /* light that dirt on the front element scatters to each
                           cell, in units of cell_q20; NULL without has_front */
    int any_front;      /* 1: dirt on the front element scatters light */
    int front_down;     /* right shift from front_q20 to the 16-bit light of
                           pictures in codes, at least 4 */
    struct glint_light_curve *curve;
    /* transfer function for which CURVE was made; valid if has_curve is 1 */
    enum glint_tone transfer;
    int has_curve;
    struct glint_veil_row *worker; /* [n_workers] */
    struct glint_blend_rows *rows; /* [n_workers] */
};

/* Sets CELL to the light of all cells convolved with the sum of N Gaussians.
 * Returns whether any cell has light. */
int glint_veil_spread_light_to(struct glint_veil *veil,
                               const struct glint_veil_spread *spreads, int n,
                               int32_t *cell_q20);

/* Interpolates channel C of CELL for the pixels of row Y of the tile. Writes
 * the result to TO, in units of white 2^(DOWN - 20) and clamped to 65534; or to
 * TO_Q20. The pointer that is not used is NULL. */
void glint_veil_interpolate_row(const struct glint_veil_row *row,
                                const int32_t *cell_q20, int c, int y, int down,
                                uint16_t *to, int32_t *to_q20);

/* Returns the index of the cell that is BY cells after cell I, clamped to 0 ..
 * N - 1. */
static inline int glint_veil_neighbour_index(int i, int by, int n)
{
    const int k = i + by;

    return k < 0 ? 0 : k >= n ? n - 1 : k;
}

#endif
