/* SPDX-License-Identifier: MIT
 *
 * Which blocks of a map may be seen. More of them cost time, fewer would show
 * as black. */
#include "base/compiler.h"
#include "base/divide.h"
#include "scene/mesh.h"
#include "scene/translucent/scene_stone.h"

static void see_all(struct glint_stone_skin *skin)
{
    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] |= GLINT_BLOCK_SEEN;
}

/* --------------------------------------------------------------------- balls
 */

/* A quarter of a block of a ball's map reaches 12.6 degrees from its middle
 * where that is 256 wide, 25.2 where it is 128, and in both a texel more. */
struct reach {
    int32_t cosine_q30, sine_q30;
};

static struct reach reach_of(const struct glint_stone_skin *skin)
{
    const struct reach wide = {Q_CONST(.88, 30), Q_CONST(.475, 30)};
    const struct reach less = {Q_CONST(.97, 30), Q_CONST(.244, 30)};

    return skin->spread.width < 256 ? wide : less;
}

/* Returns whether the texel at (X, Y) of ball P has a cosine above LIMIT to the
 * camera. */
static int faces(const struct glint_placed *p,
                 const struct glint_stone_skin *skin, int x, int y,
                 const int32_t toward_q30[3], int32_t limit_q30)
{
    const int32_t *round_q30 = skin->turn_q30[x];
    const int32_t *down_q30 = skin->turn_q30[skin->spread.width + y];
    const int32_t n_q30[3] = {q_mul(round_q30[1], down_q30[1], 30), down_q30[0],
                              -q_mul(round_q30[0], down_q30[1], 30)};
    int32_t turned_q30[3];

    v3_turn(&p->turn, n_q30, turned_q30);
    return v3_cosine_q30(turned_q30, toward_q30) > limit_q30;
}

/* Sees the blocks of which a place faces the camera: n.d > R / D, of a unit
 * vector d to the camera, D away. Seen from within all are. */
static void see_ball(const struct glint_scene *s, const struct glint_placed *p,
                     struct glint_stone_skin *skin)
{
    const struct reach reach = reach_of(skin);
    int32_t off[3], toward_q30[3], limit_q30;
    int64_t wide[3];
    uint32_t away;

    v3_minus(s->view.at, p->at, off);
    away = glint_root((uint64_t)v3_dot(off, off));
    for (int k = 0; k < 3; k++)
        wide[k] = off[k];
    if (skin->spread.width < 128 || away <= (uint32_t)p->radius ||
        !glint_unit(wide, toward_q30)) {
        see_all(skin);
        return;
    }
    limit_q30 =
        q_mul(q_part_q30((uint64_t)p->radius, away), reach.cosine_q30, 30) -
        reach.sine_q30 - (1 << 20);
    for (int i = 0; i < skin->across * skin->down; i++)
        for (int k = 0; k < 4; k++)
            if (faces(p, skin,
                      i % skin->across * GLINT_BLOCK_WIDTH +
                          (k & 1 ? 3 : 1) * GLINT_BLOCK_WIDTH / 4,
                      i / skin->across * GLINT_BLOCK_HEIGHT +
                          (k & 2 ? 3 : 1) * GLINT_BLOCK_HEIGHT / 4,
                      toward_q30, limit_q30))
                skin->block[i] |= GLINT_BLOCK_SEEN;
}

/* -------------------------------------------------------------------- meshes
 */

/* Returns whether triangle T may be seen: it reaches into the picture, and does
 * not show its back. */
static int is_seen(const struct glint_scene *s, const struct glint_placed *p,
                   const struct glint_stone_skin *skin,
                   const struct glint_scene_triangle *t)
{
    const struct glint_box all = {-128 * s->view.width, -128 * s->view.height,
                                  128 * s->view.width, 128 * s->view.height};
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};
    const struct glint_corner *c[3];
    int64_t area;

    for (int k = 0; k < 3; k++) {
        c[k] = &s->corner[p->first_vertex + t->vertex[k]];
        if (c[k]->w != 1)
            return 1;
        lo[0] = q_smaller(lo[0], c[k]->x);
        lo[1] = q_smaller(lo[1], c[k]->y);
        hi[0] = q_larger(hi[0], c[k]->x);
        hi[1] = q_larger(hi[1], c[k]->y);
    }
    area = ((int64_t)c[1]->x - c[0]->x) * ((int64_t)c[2]->y - c[0]->y) -
           ((int64_t)c[1]->y - c[0]->y) * ((int64_t)c[2]->x - c[0]->x);
    return (area >= 0 || !skin->of->closed) && hi[0] >= all.x0 - 512 &&
           lo[0] <= all.x1 + 512 && hi[1] >= all.y0 - 512 &&
           lo[1] <= all.y1 + 512;
}

/* Sees the blocks that the triangle of UV touches, and a texel more. */
static void see_uv(struct glint_stone_skin *skin,
                   const int32_t *const uv_q16[3])
{
    const int size_log2[2] = {bit_length(GLINT_BLOCK_WIDTH) - 1,
                              bit_length(GLINT_BLOCK_HEIGHT) - 1};
    const int n[2] = {skin->across, skin->down};
    const int log2 = (int)skin->stone.header->side_log2;
    int lo[2], hi[2];

    for (int i = 0; i < 2; i++) {
        const int32_t a = uv_q16[0][i], b = uv_q16[1][i], c = uv_q16[2][i];
        const int64_t least = q_smaller(a, q_smaller(b, c));
        const int64_t most = q_larger(a, q_larger(b, c));

        lo[i] = q_clamp_sat(((least << log2 >> 16) - 1) >> size_log2[i], 0,
                            n[i] - 1);
        hi[i] = q_clamp_sat(((most << log2 >> 16) + 1) >> size_log2[i], 0,
                            n[i] - 1);
    }
    for (int y = lo[1]; y <= hi[1]; y++)
        for (int x = lo[0]; x <= hi[0]; x++)
            skin->block[y * skin->across + x] |= GLINT_BLOCK_SEEN;
}

static void see_mesh(const struct glint_scene *s, const struct glint_placed *p,
                     struct glint_stone_skin *skin)
{
    const struct glint_scene_mesh *m = glint_mesh_of(s, skin->of->object);
    const int32_t *uv_q16 = glint_mesh_table(s, m->uv_at);

    for (uint32_t i = 0; i < m->n_triangles; i++) {
        const struct glint_scene_triangle *t = glint_mesh_triangle(s, m, i);
        const int32_t *corner_q16[3];

        if (!is_seen(s, p, skin, t))
            continue;
        for (int k = 0; k < 3; k++)
            corner_q16[k] = uv_q16 + 2 * (size_t)t->vertex[k];
        see_uv(skin, corner_q16);
    }
}

void glint_stone_see(const struct glint_scene *scene,
                     struct glint_stone_skin *skin)
{
    const struct glint_placed *p = &scene->placed[skin->of->object];

    for (int i = 0; i < skin->across * skin->down; i++)
        skin->block[i] &= (uint8_t)~GLINT_BLOCK_SEEN;
    if (scene->has_split) /* mirrors show what the camera does not see */
        see_all(skin);
    else if (!p->is_seen)
        return;
    else if (skin->spread.is_ball)
        see_ball(scene, p, skin);
    else
        see_mesh(scene, p, skin);
}
