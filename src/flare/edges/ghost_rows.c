/* SPDX-License-Identifier: MIT
 *
 * Computes rows of nodes of a ray grid: the vertex of each node, and bit masks
 * of what the node lies outside of, which are sides of the stop, barrel
 * apertures, and sides of the picture. */
#include "flare/edges/ghost_parts.h"

#include <stddef.h>

#include "base/q.h"

static int is_vertex_valid(const struct glint_vertex *v)
{
    const uint32_t most = GLINT_VERTEX_LIMIT_Q8 - 1;

    return v->energy_q16 >= 0 && (uint32_t)v->x_q8 + most <= 2 * most &&
           (uint32_t)v->y_q8 + most <= 2 * most;
}

/* Corrects a row of vertices for the error of linear interpolation (sags,
 * struct glint_bundle_plan). Subtracts the sags from the barrels' values and,
 * if the stop is round, moves the stop positions inwards. */
static struct glint_vertex *subtract_row_sags(const struct glint_ghost_edges *g,
                                              struct glint_vertex *row)
{
    const int64_t nearer_q16 = g->sag_q16[2];
    const int lowers = g->sag_q16[0] | g->sag_q16[1];

    for (int i = 0; lowers && i <= g->bundle->n_cells; i++)
        for (int k = 0; k < 2; k++)
            row[i].barrel_q16[k] -= g->sag_q16[k];
    for (int i = 0; nearer_q16 && i <= g->bundle->n_cells; i++) {
        row[i].stop_x_q16 -=
            q_narrow(q_shift(row[i].stop_x_q16 * nearer_q16, 16));
        row[i].stop_y_q16 -=
            q_narrow(q_shift(row[i].stop_y_q16 * nearer_q16, 16));
    }
    return row;
}

/* Returns the vertices of row J of the grid, which are computed or stored. They
 * are valid until row J + 2 is requested. */
static const struct glint_vertex *get_grid_row(struct glint_ghost_edges *g,
                                               int j)
{
    const int n = g->bundle->n_cells;
    struct glint_ghost_rows *r = g->rows;
    struct glint_vertex *row = r->vertex[j & 1];

    if (g->rays) {
        g->rays->row(g->rays->ctx, g->worker, j, row);
        return row;
    }
    if (!g->transfer)
        return g->vertex + (ptrdiff_t)j * (n + 1);
    if (n > GLINT_HELD_CELLS || 2 * j == n)
        glint_transfer_row(g->transfer, &g->place, n, j, row);
    else if (2 * j < n)
        glint_transfer_rows(g->transfer, &g->place, n, j, row, r->held[j]);
    else
        return subtract_row_sags(g, r->held[n - j]);
    return subtract_row_sags(g, row);
}

void glint_ghost_fill_node_row(struct glint_ghost_edges *g, int j)
{
    const int n = g->bundle->n_cells;
    uint64_t *sides = g->rows->sides[j & 1];
    uint8_t *barrels = g->rows->barrels[j & 1];
    const int32_t top = g->top * 256, floor = g->height * 256;
    const int32_t right = g->width * 256;

    g->row[j & 1] = get_grid_row(g, j);
    glint_cuts_classify_row(g->stop, g->row[j & 1], n + 1, sides, barrels);
    for (int i = 0; i <= n; i++) {
        const struct glint_vertex *v = get_ghost_node(g, i, j);

        if (!is_vertex_valid(v)) {
            sides[i] = 0;
            barrels[i] = NODE_LOST;
        } else
            barrels[i] |= (uint8_t)(NODE_ABOVE * (v->y_q8 <= top) +
                                    NODE_BELOW * (v->y_q8 >= floor) +
                                    NODE_RIGHT * (v->x_q8 >= right));
    }
}
