/* SPDX-License-Identifier: MIT
 *
 * Internal state of a veil.
 */
#ifndef GLINT_VEIL_PARTS_H
#define GLINT_VEIL_PARTS_H

#include "image/light_sum.h"
#include "tile/blend.h"
#include "veil/glare.h"

/* Pixels per vectorised group of a row; tables are padded by as much. */
enum { GLINT_VEIL_LANES = 8 };

/* Positions of pixel centres among the cells, along one axis. */
struct glint_veil_axis {
    uint8_t *cell;  /* [side]: index of the cell of each pixel */
    int32_t *start; /* [cells + 1]: index of the first pixel of each cell */
    /* [side + LANES]: quadratic spline weights of the previous cell, the
     * pixel's cell and the next cell: (1 - t)^2 / 2, 1 minus both others,
     * t^2 / 2, where t = 0 .. 1 is the position in the cell. */
    uint16_t *share_q16[3];
    /* For each cell, width in pixels / number of pixels summed, so that a
     * uniform picture gives uniform cells. */
    uint32_t *fill_q16;
};

/* State of a worker that reads or draws a row of tiles. */
struct glint_veil_row {
    const struct glint_veil *veil;
    struct glint_box tile;
    /* Used while reading a picture: codes, and the light of each cell of a
     * row. */
    struct glint_codes codes;
    int64_t sum_q20[GLINT_VEIL_CELLS][3];
};

struct glint_veil {
    struct glint_veil_config cfg;
    int n_x, n_y; /* number of cells across and down */
    struct glint_veil_axis across, down;
    /* Light of the cells [3][n_y][n_x], white times pixels: in 64 bits;
     * scaled to 31 bits; scaled and convolved along x. */
    int64_t *light_q16;
    int32_t *narrow, *along;
    int64_t *sum_q30;   /* veil per cell, white */
    int32_t *cell_q20;  /* veil per cell, clamped to 0 .. 2^28 */
    int is_linear, any; /* 1: the picture is linear; 1: the veil has light */
    const struct glint_veil_front *front; /* cover of the front element, or
                                             NULL */
    int32_t *front_q20; /* light that the front element scatters, per cell, as
                           cell_q20; NULL without has_front */
    int any_front;      /* 1: the front element scatters light */
    int front_down; /* bits by which front_q20 is shifted right when codes are
                       drawn, 4 or more */
    struct glint_light_curve *curve;
    /* transfer function of CURVE; defined if has_curve is set */
    enum glint_tone transfer;
    int has_curve;
    struct glint_veil_row *worker; /* [n_workers] */
    struct glint_blend_rows *rows; /* [n_workers] */
};

/* Sets CELL to the light of N Gaussians. Returns whether there is any light. */
int glint_veil_spread_light_to(struct glint_veil *veil,
                               const struct glint_veil_spread *spreads, int n,
                               int32_t *cell_q20);

/* Interpolates the light of CELLS, channel C, along row Y of the tile.
 * Writes one of two outputs, the other is NULL: TO in units of white 2^(DOWN
 * - 20), at most 65534, or TO_Q20. */
void glint_veil_interpolate_row(const struct glint_veil_row *row,
                                const int32_t *cell_q20, int c, int y, int down,
                                uint16_t *to, int32_t *to_q20);

/* Returns the index I + BY, clamped to 0 .. N - 1. */
static inline int glint_veil_beside(int i, int by, int n)
{
    const int k = i + by;

    return k < 0 ? 0 : k >= n ? n - 1 : k;
}

#endif
