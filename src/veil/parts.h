/* SPDX-License-Identifier: MIT
 *
 * State of a veil. */
#ifndef GLINT_VEIL_PARTS_H
#define GLINT_VEIL_PARTS_H

#include "image/light_sum.h"
#include "tile/blend.h"
#include "veil/glare.h"

/* Pixels of a row are computed in groups of this size; tables are padded by
 * it. */
enum { GLINT_VEIL_LANES = 8 };

/* Where the middles of columns or rows of pixels lie among the cells. */
struct glint_veil_axis {
    uint8_t *cell;  /* [side]: the cell of each pixel */
    int32_t *start; /* [cells + 1]: the first pixel of each cell */
    /* [side + LANES]: weights of the previous cell, the pixel's cell and the
     * next cell in a quadratic spline: with t = 0 .. 1 through the cell, (1 -
     * t)^2 / 2, 1 minus both others, t^2 / 2. */
    uint16_t *share_q16[3];
    /* For each cell, its width in pixels / the number of pixels that are summed
     * in it, so that a uniform picture gives uniform cells. */
    uint32_t *fill_q16;
};

/* A worker's state in a row of tiles. */
struct glint_veil_row {
    const struct glint_veil *veil;
    struct glint_box tile;
    /* While looking: codes, and the light of each cell of a row. */
    struct glint_codes codes;
    int64_t sum_q20[GLINT_VEIL_CELLS][3];
};

struct glint_veil {
    struct glint_veil_config cfg;
    int n_x, n_y; /* cells */
    struct glint_veil_axis across, down;
    /* [3][n_y][n_x]: light, white times pixels, and the same in 31 bits and
     * spread along one axis */
    int64_t *light_q16;
    int32_t *narrow, *along;
    int64_t *sum_q30;   /* veil, white */
    int32_t *cell_q20;  /* the same, 0 .. 2^28 */
    int is_linear, any; /* 1: the picture is linear; there is light */
    const struct glint_veil_front *front; /* cover of the front element, or
                                             NULL */
    int32_t *front_q20; /* light of the front's cells, as cell_q20; NULL without
                           has_front */
    int any_front;      /* 1: the front has light */
    int front_down;     /* bits of that light that codes leave out, 4 or more */
    struct glint_light_curve *curve;
    enum glint_tone transfer; /* of the curve, if there is one yet */
    int has_curve;
    struct glint_veil_row *worker; /* [n_workers] */
    struct glint_blend_rows *rows; /* [n_workers] */
};

/* Sets CELL to the light of N spreads. Returns whether there is any light. */
int glint_veil_spread_to(struct glint_veil *veil,
                         const struct glint_veil_spread *spreads, int n,
                         int32_t *cell_q20);

/* Sets one of both outputs to the light of CELLS in row Y of the tile, channel
 * C: white times 2^20 >> DOWN, at most 65534, or _q20. */
void glint_veil_row(const struct glint_veil_row *row, const int32_t *cell_q20,
                    int c, int y, int down, uint16_t *to, int32_t *to_q20);

/* Returns the index of the cell BY cells from cell I of N, mirrored at the
 * borders. */
static inline int glint_veil_beside(int i, int by, int n)
{
    const int k = i + by;

    return k < 0 ? 0 : k >= n ? n - 1 : k;
}

#endif
