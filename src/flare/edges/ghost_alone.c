/* SPDX-License-Identifier: MIT
 *
 * Draws cells that do not share edges with their neighbours, each with a closed
 * outline of its own. */
#include "base/compiler.h"
#include "base/q.h"
#include "flare/edges/ghost_shade.h"
#include "flare/edges/patch.h"

typedef int32_t point_q8[2];

/* Adds the edges of the closed outline O. */
static void add_outline(struct glint_ghost_edges *g,
                        const struct glint_outline *o, int32_t light)
{
    point_q8 first, last, here;

    for (int i = 0; i < o->n; i++) {
        here[0] = q_narrow(q_shift(o->x_q16[i], 8));
        here[1] = q_narrow(q_shift(o->y_q16[i], 8));
        if (i > 0)
            glint_ghost_add_edge(g, last, here, light, 0);
        for (int k = 0; k < 2; k++) {
            last[k] = here[k];
            first[k] = i ? first[k] : here[k];
        }
    }
    if (o->n > 0)
        glint_ghost_add_edge(g, last, first, light, 0);
}

void glint_ghost_add_alone(struct glint_ghost_edges *g,
                           const struct glint_vertex *const *corner, int n,
                           int share_log2)
{
    struct glint_outline *o = &g->rows->outline;
    const struct glint_vertex *turned[4];
    struct glint_corners c;
    int32_t light;
    int cut, thin;

    glint_corners_set(&c, corner, n);
    for (int i = 0; i < n; i++)
        turned[i] = corner[c.area2_q16 >= 0 ? i : n - 1 - i];
    glint_corners_set(&c, turned, n);
    cut = glint_outline_classify(&c, g->stop);
    if (cut < 0 ||
        glint_box_empty(glint_corners_reach(&c, g->width, g->height)))
        return;
    cut |= cut && g->transfer ? GLINT_CUT_LOWERED : 0;
    thin = glint_corners_thin(&c);
    for (int k = 0; k < (cut ? n - 2 : 1); k++) {
        int64_t area2 = c.area2_q16, share_q28;
        int frac = 2 * GLINT_VERTEX_FRAC + 1, share = share_log2;

        if (cut)
            glint_outline_cut(o, &c, k, g->stop, cut);
        else
            glint_outline_whole(o, &c);
        if (o->n == 0)
            continue;
        share_q28 = 1 << 28;
        if (thin) {
            share_q28 = o->share_q28;
            share -= cut && n == 4;
            area2 = glint_outline_widen_q32(o);
            frac = 33;
        }
        light = glint_ghost_light(g, area2, frac, share,
                                  q_shift(o->energy_q16 * share_q28, 28), 1);
        if (g->patch)
            g->stop->shade->method->patch(g, light);
        if (!g->patch || g->patch->clear)
            add_outline(g, o, light);
    }
}

void glint_ghost_add_triangles(struct glint_ghost_edges *g,
                               const struct glint_ghost_cell *c)
{
    static const int half[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const struct glint_vertex *left[4];
    int n = 0;

    for (int k = 0; k < 4; k++)
        if (!(c->at[k].barrels & NODE_LOST))
            left[n++] = c->corner[k];
    g->n_dropped += n < 4;
    if (n == 3)
        glint_ghost_add_alone(g, left, 3, -1);
    for (int k = 0; n == 4 && k < 2; k++) {
        const struct glint_vertex *const t[3] = {c->corner[half[k][0]],
                                                 c->corner[half[k][1]],
                                                 c->corner[half[k][2]]};

        glint_ghost_add_alone(g, t, 3, -1);
    }
}

void glint_ghost_add_odd(struct glint_ghost_edges *g,
                         const struct glint_ghost_cell *c,
                         const struct glint_corners *corners, int turn)
{
    if (turn == 0 && !glint_corners_tiny(corners, 16))
        glint_ghost_add_triangles(g, c);
    else
        glint_ghost_add_alone(g, c->corner, 4, 0);
}
