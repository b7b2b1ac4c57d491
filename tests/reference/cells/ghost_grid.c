/* SPDX-License-Identifier: MIT */
#include "reference/cells/ghost_grid.h"

#include <stddef.h>

#include "base/compiler.h"
#include "base/q.h"
#include "reference/cells/clip.h"

/* Marks of cells: log2 of the side of the block that starts at the cell, or
 * COVERED if the cell belongs to a block that starts at another. */
enum { COVERED = 255 };

static int node(const struct glint_ghost_grid *g, int i, int j)
{
    return j * (g->bundle->n_cells + 1) + i;
}

static int vertex_valid(const struct glint_vertex *v)
{
    return v->energy_q16 >= 0 && v->x_q8 > -GLINT_VERTEX_LIMIT_Q8 &&
           v->x_q8 < GLINT_VERTEX_LIMIT_Q8 &&
           v->y_q8 > -GLINT_VERTEX_LIMIT_Q8 && v->y_q8 < GLINT_VERTEX_LIMIT_Q8;
}

/* Returns the sign of the turn at each corner if it is the same at all four,
 * else 0. */
static int convexity(const struct glint_vertex *v, const int32_t *q)
{
    int positive = 0, negative = 0;

    for (int i = 0; i < 4; i++) {
        const struct glint_vertex *a = &v[q[i]];
        const struct glint_vertex *b = &v[q[(i + 1) & 3]];
        const struct glint_vertex *c = &v[q[(i + 2) & 3]];
        const int64_t turn = glint_turn_q16(a->x_q8, a->y_q8, b->x_q8, b->y_q8,
                                            c->x_q8, c->y_q8);

        positive += turn > 0;
        negative += turn < 0;
    }
    return positive == 4 ? 1 : negative == 4 ? -1 : 0;
}

/* Sets Q to the corners of the block of 2^SIZE_LOG2 cells a side at (I, J), in
 * order. */
static void block_corners(const struct glint_ghost_grid *g, int i, int j,
                          int size_log2, int32_t *q)
{
    const int h = 1 << size_log2;

    q[0] = node(g, i, j);
    q[1] = node(g, i + h, j);
    q[2] = node(g, i + h, j + h);
    q[3] = node(g, i, j + h);
}

/* Returns whether edges A to B and B to C differ by no more than GAMMA of the
 * longer one. */
static int edges_agree(const struct glint_vertex *a,
                       const struct glint_vertex *b,
                       const struct glint_vertex *c, int32_t gamma_q16)
{
    const int64_t ex = b->x_q8 - a->x_q8, ey = b->y_q8 - a->y_q8;
    const int64_t fx = c->x_q8 - b->x_q8, fy = c->y_q8 - b->y_q8;
    /* squares below 2^61; compared as |e - f| <= gamma max(|e|, |f|) */
    const int64_t e2 = ex * ex + ey * ey, f2 = fx * fx + fy * fy;
    const int64_t dx = ex - fx, dy = ey - fy;
    const int64_t longest = e2 > f2 ? e2 : f2;
    const int64_t gamma2_q24 = ((int64_t)gamma_q16 * gamma_q16) >> 8;
    const int64_t allowed = longest < INT64_C(1) << 38
                                ? (longest * gamma2_q24) >> 24
                                : (longest >> 24) * gamma2_q24;

    return dx * dx + dy * dy <= allowed + 2; /* 2 is two units of rounding */
}

/* Returns whether 2 B differs from A + C by no more than GAMMA. */
static int halfway(int32_t a, int32_t b, int32_t c, int32_t gamma)
{
    const int64_t off = (int64_t)a + c - 2 * (int64_t)b;

    return off <= gamma && -off <= gamma;
}

/* Returns whether cuts are straight from A over B to C, within GAMMA in stop
 * radii and in the values of barrels. */
static int cuts_agree(const struct glint_vertex *a,
                      const struct glint_vertex *b,
                      const struct glint_vertex *c, int32_t gamma_q16)
{
    for (int k = 0; k < 2; k++)
        if (!halfway(a->barrel_q16[k], b->barrel_q16[k], c->barrel_q16[k],
                     gamma_q16))
            return 0;
    return halfway(a->stop_x_q16, b->stop_x_q16, c->stop_x_q16, gamma_q16) &&
           halfway(a->stop_y_q16, b->stop_y_q16, c->stop_y_q16, gamma_q16);
}

/* Returns whether the three rows and three columns of nodes of a block are
 * straight enough; CUT is nonzero if a cut may cross it. */
static int block_straight(const struct glint_ghost_grid *g, int i, int j,
                          int half, int cut)
{
    for (int k = 0; k <= 2; k++) {
        const struct glint_vertex *row[3], *column[3];

        for (int m = 0; m <= 2; m++) {
            row[m] = &g->vertex[node(g, i + m * half, j + k * half)];
            column[m] = &g->vertex[node(g, i + k * half, j + m * half)];
        }
        if (!edges_agree(row[0], row[1], row[2], g->merge_gamma_q16) ||
            !edges_agree(column[0], column[1], column[2], g->merge_gamma_q16))
            return 0;
        if (cut &&
            (!cuts_agree(row[0], row[1], row[2], g->merge_gamma_q16) ||
             !cuts_agree(column[0], column[1], column[2], g->merge_gamma_q16)))
            return 0;
    }
    return 1;
}

static int block_cut(const struct glint_ghost_grid *g, const int32_t *q)
{
    struct glint_corners corners;

    glint_corners_gather(&corners, g->vertex, q, 4);
    if (corners.area2_q16 < 0)
        corners.area2_q16 = -corners.area2_q16;
    return glint_clip_classify(&corners, g->stop);
}

/* Returns whether the block of 2^SIZE_LOG2 cells a side at (I, J) can be one
 * primitive: its quarters are merged already, all are convex, turned alike, and
 * straight enough. */
static int block_merges(const struct glint_ghost_grid *g, int i, int j,
                        int size_log2)
{
    const int half = 1 << (size_log2 - 1), n = g->bundle->n_cells;
    int32_t q[4];
    int turn;

    block_corners(g, i, j, size_log2, q);
    for (int k = 0; k < 4; k++)
        if (!vertex_valid(&g->vertex[q[k]]))
            return 0;
    turn = convexity(g->vertex, q);
    if (turn == 0)
        return 0;
    for (int k = 0; k < 4; k++) {
        const int ci = i + (k & 1) * half, cj = j + (k >> 1) * half;

        if (g->level[cj * n + ci] != size_log2 - 1)
            return 0;
        block_corners(g, ci, cj, size_log2 - 1, q);
        for (int m = 0; m < 4; m++)
            if (!vertex_valid(&g->vertex[q[m]]))
                return 0;
        if (convexity(g->vertex, q) != turn)
            return 0;
    }
    block_corners(g, i, j, size_log2, q);
    return block_straight(g, i, j, half, block_cut(g, q) != 0);
}

static void block_cover(struct glint_ghost_grid *g, int i, int j, int size)
{
    const int n = g->bundle->n_cells;

    for (int y = j; y < j + size; y++)
        for (int x = i; x < i + size; x++)
            g->level[y * n + x] = COVERED;
}

void glint_ghost_grid_merge(struct glint_ghost_grid *grid)
{
    const int n = grid->bundle->n_cells;

    grid->n_merged = 0;
    for (int k = 0; k < n * n; k++)
        grid->level[k] = 0;
    for (int step = 1; step <= grid->merge_steps; step++) {
        const int size = 1 << step;

        for (int j = 0; j + size <= n; j += size)
            for (int i = 0; i + size <= n; i += size)
                if (block_merges(grid, i, j, step)) {
                    block_cover(grid, i, j, size);
                    grid->level[j * n + i] = (uint8_t)step;
                }
    }
    for (int k = 0; k < n * n; k++)
        grid->n_merged += grid->level[k] != 0;
}

/* Returns light as a primitive stores it: _q20, clamped. */
static int32_t held_q20(int64_t light_q22)
{
    return q_clamp_sat(q_shift(light_q22, 2), 0, INT32_MAX);
}

/* Adds a primitive far smaller than a pixel, with the flux of its cells. */
static int emit_point(struct glint_ghost_grid *g,
                      const struct glint_corners *corners,
                      struct glint_primitive *p, struct glint_primitive *out)
{
    if (glint_box_empty(glint_corners_pixel(corners, g->width, g->height)) ||
        !glint_clip_middle(corners, g->stop))
        return 0;
    p->flags = GLINT_POINT;
    p->irradiance_q20 = held_q20(glint_irradiance_q22(
        g->bundle, p->share_log2, 1, 0, GLINT_LIMIT_Q8, &g->n_held));
    out[g->n_primitives++] = *p;
    return 0;
}

/* Adds a primitive if pixel centres can see it; returns whether light was
 * dropped because it has no area. */
static int emit_cell(struct glint_ghost_grid *g,
                     const struct glint_corners *corners,
                     struct glint_primitive *p, struct glint_primitive *out)
{
    int cut;

    if (g->focused && glint_corners_tiny(corners, 2))
        return emit_point(g, corners, p, out);
    if (corners->area2_q16 == 0)
        return 1;
    p->flags = g->sampled ? GLINT_SAMPLED : 0;
    if (glint_box_empty(glint_primitive_box(p, corners, g->width, g->height)))
        return 0;
    cut = glint_clip_classify(corners, g->stop);
    if (cut < 0)
        return 0;
    p->flags |= (uint8_t)cut;
    p->irradiance_q20 = held_q20(glint_irradiance_q22(
        g->bundle, p->share_log2, corners->area2_q16, 2 * GLINT_VERTEX_FRAC + 1,
        GLINT_LIMIT_Q8, &g->n_held));
    out[g->n_primitives++] = *p;
    return 0;
}

/* Adds one primitive with the corners Q if any of it can be seen. Returns
 * whether its light was dropped. */
static int emit_one(struct glint_ghost_grid *g, const int32_t *q, int n,
                    int share_log2, struct glint_primitive *out)
{
    struct glint_primitive p = {.share_log2 = (int8_t)share_log2};
    struct glint_corners corners;

    glint_corners_gather(&corners, g->vertex, q, n);
    for (int i = 0; i < n; i++)
        p.vertex[i] = corners.area2_q16 > 0 ? q[i] : q[n - 1 - i];
    if (n == 3)
        p.vertex[3] = -1;
    glint_corners_gather(&corners, g->vertex, p.vertex, n);
    return emit_cell(g, &corners, &p, out);
}

/* Adds a cell that is not a convex quad: as two triangles, or as the one
 * triangle whose corners are not lost. Returns whether light was dropped. */
static int emit_triangles(struct glint_ghost_grid *g, const int32_t *q,
                          struct glint_primitive *out)
{
    static const int half[2][3] = {{0, 1, 2}, {0, 2, 3}};
    int32_t left[4];
    int n = 0, dropped = 0;

    for (int i = 0; i < 4; i++)
        if (vertex_valid(&g->vertex[q[i]]))
            left[n++] = q[i];
    if (n < 3)
        return 1;
    if (n == 3)
        return 1 | emit_one(g, left, 3, -1, out);
    for (int k = 0; k < 2; k++) {
        const int32_t t[3] = {q[half[k][0]], q[half[k][1]], q[half[k][2]]};

        dropped |= emit_one(g, t, 3, -1, out);
    }
    return dropped;
}

/* Returns whether a block is too small to show that it is folded. */
static int block_tiny(const struct glint_ghost_grid *g, const int32_t *q)
{
    struct glint_corners corners;

    glint_corners_gather(&corners, g->vertex, q, 4);
    return g->focused && glint_corners_tiny(&corners, 2);
}

static int emit_block(struct glint_ghost_grid *g, int i, int j, int size_log2,
                      struct glint_primitive *out)
{
    int32_t q[4];

    block_corners(g, i, j, size_log2, q);
    for (int k = 0; k < 4; k++)
        if (!vertex_valid(&g->vertex[q[k]]))
            return emit_triangles(g, q, out);
    if (convexity(g->vertex, q) == 0 && !block_tiny(g, q))
        return emit_triangles(g, q, out);
    return emit_one(g, q, 4, 2 * size_log2, out);
}

/* Returns whether all rays land within four pixels of the first. */
static int is_focused(const struct glint_ghost_grid *g)
{
    const int n = g->bundle->n_cells;
    const struct glint_vertex *v = g->vertex, *seen = NULL;

    for (int k = 0; k < (n + 1) * (n + 1); k++) {
        if (!vertex_valid(&v[k]))
            continue;
        if (!seen)
            seen = &v[k];
        if (v[k].x_q8 - seen->x_q8 > 1024 || seen->x_q8 - v[k].x_q8 > 1024 ||
            v[k].y_q8 - seen->y_q8 > 1024 || seen->y_q8 - v[k].y_q8 > 1024)
            return 0;
    }
    return 1;
}

static int is_near(const struct glint_vertex *a, const struct glint_vertex *b)
{
    const int64_t x = (int64_t)b->x_q8 - a->x_q8;
    const int64_t y = (int64_t)b->y_q8 - a->y_q8;

    return x < 1024 && x > -1024 && y < 1024 && y > -1024;
}

/* Returns whether all neighbours land within four pixels of each other. Folds
 * of such grids have rims of hundreds of times white that pixel centres miss.
 */
static int has_small_cells(const struct glint_ghost_grid *g)
{
    const int n = g->bundle->n_cells;
    const struct glint_vertex *v = g->vertex;

    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++, v++)
            if (vertex_valid(v) &&
                ((i < n && vertex_valid(v + 1) && !is_near(v, v + 1)) ||
                 (j < n && vertex_valid(v + n + 1) && !is_near(v, v + n + 1))))
                return 0;
    return 1;
}

void glint_ghost_grid_emit(struct glint_ghost_grid *grid,
                           struct glint_primitive *out)
{
    const int n = grid->bundle->n_cells;

    grid->focused = is_focused(grid);
    grid->sampled = grid->antialias && !grid->focused && has_small_cells(grid);
    grid->n_primitives = 0;
    grid->n_dropped = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            if (grid->level[j * n + i] != COVERED)
                grid->n_dropped +=
                    emit_block(grid, i, j, grid->level[j * n + i], out);
}
