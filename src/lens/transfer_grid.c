/* SPDX-License-Identifier: MIT
 *
 * Converts grids of rays to vertices in the picture. Values of the polynomials
 * become pixels, stop radii and energies in fixed-point formats. Positions are
 * rotated by the azimuth of the light. Rays whose values exceed these formats
 * are marked invalid. */
#include "glint/transfer.h"

#include <stddef.h>

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"
#include "kernels/rays/rays.h"
#include "lens/terms.h"

enum { RAYS = GLINT_RAYS, LIMIT_Q16 = 1 << 30 };

STATIC_ASSERT((int)RAYS == (int)GLINT_TURNED);

/* ---------------------------------------------------------------- vertices */

/* a block of rays that are computed together, before they become vertices */
struct block {
    /* x and y of the rays, then x and y of their mirror images */
    int32_t sensor_q8[4][RAYS], stop_q16[4][RAYS];
    int32_t barrel_q16[2][RAYS];
    int32_t energy_q16[RAYS];
    /* Masks: all bits set if the ray is invalid, else 0. [0]: rays, [1]: their
     * mirror images. */
    int32_t invalid[2][RAYS];
};

/* Sets SCALED to X / 2^SHIFT, rounded. Marks rays whose value reaches LIMIT in
 * magnitude as invalid in INVALID. */
static void scale_ray_values(const int32_t *x, int shift, int32_t limit,
                             int32_t *scaled, int32_t *invalid)
{
    if (shift < 1 || shift > 30 || limit < LIMIT_Q16) {
        for (int i = 0; i < RAYS; i++)
            scaled[i] = q_scaled(x[i], shift, limit, &invalid[i]);
        return;
    }
    /* X is about 2^30 at most, the added half 2^29: no overflow */
    for (int i = 0; i < RAYS; i++)
        scaled[i] = (x[i] + (INT32_C(1) << (shift - 1))) >> shift;
}

static void set_radius_barrel(const struct glint_transfer *t,
                              const int32_t *rays, struct block *b)
{
    int32_t r_q16[RAYS];

    scale_ray_values(rays, -(t->exponent[GLINT_OUT_RADIUS] + 16), 1 << 23,
                     r_q16, b->invalid[0]);
    for (int i = 0; i < RAYS; i++)
        b->barrel_q16[0][i] =
            (int32_t)(((INT64_C(1) << 16) +
                       q_shift((int64_t)r_q16[i] * r_q16[i], 16)) /
                      2);
}

static void set_barrel_values(const struct glint_transfer *t,
                              const int32_t (*rays)[RAYS], struct block *b)
{
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < RAYS; i++)
            b->barrel_q16[k][i] = 0;
    if (has_transfer_output(t, GLINT_OUT_RADIUS))
        set_radius_barrel(t, rays[GLINT_OUT_RADIUS], b);
    for (int kind = GLINT_OUT_BARREL_0; kind < GLINT_OUT_KINDS; kind++) {
        int32_t *to = b->barrel_q16[kind > GLINT_OUT_BARREL_0];
        int32_t more[RAYS];

        if (!has_transfer_output(t, kind))
            continue;
        scale_ray_values(rays[kind], -(t->exponent[kind] + 16), LIMIT_Q16, more,
                         b->invalid[0]);
        for (int i = 0; i < RAYS; i++) {
            b->invalid[0][i] |= more[i] >> 31;
            to[i] = more[i] > to[i] ? more[i] : to[i];
        }
    }
}

/* Converts energies from _q29 times 2^UP to _q16, clamped to 0 .. 1. */
static void convert_ray_energies(const int32_t *energy, int up,
                                 int32_t *energy_q16)
{
    const int raise = up > 13 ? up - 13 : 0, lower = up < 13 ? 13 - up : 0;
    const int32_t half = lower ? INT32_C(1) << (lower - 1) : 0;
    const int32_t most = (INT32_C(1) << 16) >> raise;

    for (int i = 0; i < RAYS; i++) {
        const int32_t e = (energy[i] + half) >> lower;

        energy_q16[i] = (e < 0 ? 0 : e > most ? most : e) * (1 << raise);
    }
}

/* Rotations of positions on the sensor and in the stop by the azimuth of the
 * light, including the shifts to the formats of a vertex. The rotation on the
 * sensor includes the scale from mm to pixels. */
struct rotations {
    struct glint_turn sensor, stop;
};

static struct glint_turn compute_vertex_rotation(const struct glint_place *p,
                                                 struct glint_real size,
                                                 int exponent, int frac,
                                                 int32_t limit)
{
    return (struct glint_turn){
        (int32_t)q_shift((int64_t)p->cos_q30 * size.mantissa, 30),
        (int32_t)q_shift((int64_t)p->sin_q30 * size.mantissa, 30),
        -(exponent + size.exponent + frac), limit};
}

static struct rotations compute_vertex_rotations(const struct glint_transfer *t,
                                                 const struct glint_place *p)
{
    const struct glint_real one = {TRANSFER_ONE_Q30, -30};
    const struct glint_real stop = p->stop_scale.mantissa ? p->stop_scale : one;

    return (struct rotations){
        compute_vertex_rotation(p, p->pixels_per_mm,
                                t->exponent[GLINT_OUT_SENSOR_X], 8,
                                GLINT_VERTEX_LIMIT_Q8 / 2),
        compute_vertex_rotation(p, stop, t->exponent[GLINT_OUT_STOP_X], 16,
                                LIMIT_Q16)};
}

static void rotate_ray_positions(const struct glint_turn *turn, unsigned sets,
                                 const int32_t *x, const int32_t *y,
                                 int32_t (*out)[RAYS], int32_t (*invalid)[RAYS])
{
    const int usual = turn->shift >= 1 && turn->shift <= 62;

    glint_choose_turn_kernel(usual ? sets : 0)(turn, x, y, out, invalid);
}

static void convert_ray_block(const struct glint_transfer *t,
                              const struct rotations *rotations,
                              const int32_t (*rays)[RAYS], struct block *b)
{
    for (int i = 0; i < RAYS; i++)
        b->invalid[0][i] = 0;
    set_barrel_values(t, rays, b);
    for (int i = 0; i < RAYS; i++)
        b->invalid[1][i] = b->invalid[0][i];
    convert_ray_energies(rays[GLINT_OUT_ENERGY], t->energy_up, b->energy_q16);
    rotate_ray_positions(&rotations->sensor, t->sets, rays[GLINT_OUT_SENSOR_X],
                         rays[GLINT_OUT_SENSOR_Y], b->sensor_q8, b->invalid);
    rotate_ray_positions(&rotations->stop, t->sets, rays[GLINT_OUT_STOP_X],
                         rays[GLINT_OUT_STOP_Y], b->stop_q16, b->invalid);
}

/* Writes the first N rays of B as vertices if SIDE is 0, or their mirror images
 * if SIDE is 1. */
static void write_block_vertices(const struct block *b,
                                 const struct glint_place *p, int side, int n,
                                 struct glint_vertex *v)
{
    for (int i = 0; i < n; i++)
        v[i] = (struct glint_vertex){
            .x_q8 = p->middle_x_q8 + b->sensor_q8[2 * side][i],
            .y_q8 = p->middle_y_q8 - b->sensor_q8[2 * side + 1][i],
            .stop_x_q16 = b->stop_q16[2 * side][i],
            .stop_y_q16 = b->stop_q16[2 * side + 1][i],
            .barrel_q16 = {b->barrel_q16[0][i], b->barrel_q16[1][i]},
            .energy_q16 = b->energy_q16[i] | b->invalid[side][i]};
}

/* --------------------------------------------------------------------- rows */

/* Returns the coordinate of vertex K, 0 .. N_CELLS, of a row of N_CELLS cells
 * that spans MIDDLE_Q30 +- HALF_Q30. */
static int32_t compute_node_position_q30(int32_t middle_q30, int32_t half_q30,
                                         int k, int n_cells)
{
    return middle_q30 +
           (int32_t)q_divide((int64_t)(2 * k - n_cells) * half_q30, n_cells);
}

int32_t glint_transfer_u(const struct glint_transfer *transfer, int32_t x_q30)
{
    const struct glint_box_window *w = &transfer->window;

    return w->u_middle_q30 + q_mul(w->u_half_q30, x_q30, 30);
}

int32_t glint_transfer_v(const struct glint_transfer *transfer, int j, int n)
{
    const struct glint_box_window *w = &transfer->window;
    const int rim = transfer->annulus;
    const int64_t high_q30 = (int64_t)w->v_to_q30 - w->v_from_q30;

    /* NOLINTNEXTLINE: N is at least 1 */
    return (int32_t)q_divide(
        ((int64_t)rim * TRANSFER_ONE_Q30 + w->v_from_q30) * n + high_q30 * j,
        (rim + 1) * n);
}

/* Returns whether row J is the middle row of an annular box, which has no
 * rays. */
static int is_row_without_rays(const struct glint_transfer *t, int n_cells,
                               int j)
{
    return t->annulus && 2 * j == n_cells;
}

static int32_t compute_row_v_q30(const struct glint_transfer *t, int n_cells,
                                 int j)
{
    /* index of the last row below the middle */
    const int last = n_cells / 2 - 1;

    if (t->whole)
        return glint_transfer_v(t, j, n_cells);
    if (!t->annulus)
        return compute_node_position_q30(0, t->window.v_to_q30, j, n_cells);
    return j <= last ? -glint_transfer_v(t, last - j, last)
                     : glint_transfer_v(t, last - (n_cells - j), last);
}

/* Sets ROW to row J of the grid and MIRRORED to its mirror image, row N_CELLS -
 * J. Either may be NULL; MIRRORED must be NULL if rows have no mirror
 * images. */
static void compute_mirrored_row_pair(struct glint_transfer *t,
                                      const struct glint_place *place,
                                      int n_cells, int j,
                                      struct glint_vertex *row,
                                      struct glint_vertex *mirrored)
{
    const struct rotations rotations = compute_vertex_rotations(t, place);
    const int32_t v_q30 = compute_row_v_q30(t, n_cells, j);

    if (t->n_nodes != n_cells + 1) {
        t->n_nodes = n_cells + 1;
        for (int i = 0; i < n_cells + RAYS; i++)
            t->node_q30[i] = compute_node_position_q30(
                t->window.u_middle_q30, t->window.u_half_q30,
                i < n_cells ? i : n_cells, n_cells);
    }
    for (int first = 0; first <= n_cells; first += RAYS) {
        const int n = n_cells + 1 - first < RAYS ? n_cells + 1 - first : RAYS;
        int32_t rays[GLINT_OUT_KINDS][RAYS];
        struct block b;

        glint_transfer_rays(t, v_q30, t->node_q30 + first, first == 0, rays);
        convert_ray_block(t, &rotations, (const int32_t(*)[RAYS])rays, &b);
        if (row)
            write_block_vertices(&b, place, t->side, n, row + first);
        if (mirrored)
            write_block_vertices(&b, place, 1, n, mirrored + first);
    }
}

static void invalidate_row(struct glint_vertex *row, int n_cells)
{
    for (int i = 0; i <= n_cells; i++)
        row[i].energy_q16 = -1;
}

void glint_transfer_row(struct glint_transfer *transfer,
                        const struct glint_place *place, int n_cells, int j,
                        struct glint_vertex *row)
{
    if (is_row_without_rays(transfer, n_cells, j))
        invalidate_row(row, n_cells);
    else if (transfer->whole || 2 * j <= n_cells)
        compute_mirrored_row_pair(transfer, place, n_cells, j, row, NULL);
    else
        compute_mirrored_row_pair(transfer, place, n_cells, n_cells - j, NULL,
                                  row);
}

void glint_transfer_rows(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells, int j,
                         struct glint_vertex *row,
                         struct glint_vertex *mirrored)
{
    if (is_row_without_rays(transfer, n_cells, j)) {
        invalidate_row(row, n_cells);
        invalidate_row(mirrored, n_cells);
    } else if (transfer->whole) {
        compute_mirrored_row_pair(transfer, place, n_cells, j, row, NULL);
        compute_mirrored_row_pair(transfer, place, n_cells, n_cells - j,
                                  mirrored, NULL);
    } else {
        compute_mirrored_row_pair(transfer, place, n_cells, j, row, mirrored);
    }
}

void glint_transfer_grid(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells,
                         struct glint_vertex *vertices)
{
    const int alone = transfer->whole;
    const int nodes = n_cells + 1;

    for (int j = 0; j < nodes; j++) {
        struct glint_vertex *row = vertices + (ptrdiff_t)j * nodes;
        struct glint_vertex *mirrored =
            vertices + (ptrdiff_t)(n_cells - j) * nodes;

        if (is_row_without_rays(transfer, n_cells, j))
            invalidate_row(row, n_cells);
        else if (alone)
            compute_mirrored_row_pair(transfer, place, n_cells, j, row, NULL);
        else if (2 * j <= n_cells)
            compute_mirrored_row_pair(transfer, place, n_cells, j, row,
                                      mirrored);
    }
}
