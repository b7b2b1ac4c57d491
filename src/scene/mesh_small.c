/* SPDX-License-Identifier: MIT
 *
 * Small triangles in the picture: all samples of a pixel at once, in 32 bits,
 * which compilers turn into vectors. Samples are inside where mesh.c says so;
 * depths are those of the corners where the picture has them, straight between
 * these. */
#include "base/divide.h"
#include "scene/mesh.h"
#include "scene/visible.h"

/* The same of a small triangle, in 32 bits. */
struct small {
    uint32_t id;
    int32_t across[3], down[3]; /* of lines, from pixel to pixel */
    int32_t at[3];              /* at the first pixel of the box */
    struct glint_depth depth;
    int32_t off[3][GLINT_SCENE_SAMPLES], deeper[GLINT_SCENE_SAMPLES];
};

enum { DEPTH_BITS = 12, MOST_DEEPER = 1 << 28 };

/* Sets DEPTH_Q30 to the depths of the corners of a triangle; returns 0 if one
 * is out of range. */
static inline int corner_depths(const struct glint_scene *s, uint32_t object,
                                const struct glint_scene_triangle *t,
                                int32_t depth_q30[3])
{
    const uint32_t first = s->placed[object].first_vertex;
    int fits = 1;

    for (int k = 0; k < 3; k++) {
        const int32_t z = s->seen[first + t->vertex[k]][2];

        depth_q30[k] =
            glint_ratio((uint64_t)s->nearest << 30, (uint64_t)q_larger(1, z));
        fits &= depth_q30[k] < GLINT_FAR;
    }
    return fits;
}

/* Returns whether all samples of BOX see what is nearer than DEPTH_Q30. */
static int is_nearer(const struct glint_scene_worker *w, struct glint_box b,
                     int32_t depth_q30)
{
    const int n = w->scene->cfg.edge_samples * (b.x1 - b.x0);

    for (int y = b.y0; y < b.y1; y++) {
        const int32_t *at_q30 = w->depth + glint_sample_index(w, b.x0, y, 0);
        int32_t least_q30 = at_q30[0];

        for (int i = 1; i < n; i++)
            least_q30 = q_smaller(least_q30, at_q30[i]);
        if (least_q30 <= depth_q30)
            return 0;
    }
    return 1;
}

/* Samples inside lie between the corners, but for rounding: lines may be 1 too
 * low (mesh.c), three of them, which are at most half of twice an area of 6,
 * and slopes of depth are cut. Slopes, at most 2 * 2 * 48 * 256 range / area,
 * are below 2^20, so that depths are set as below. */
int glint_mesh_is_hidden(const struct glint_scene_worker *w, uint32_t id,
                         const struct glint_scene_triangle *t,
                         struct glint_box b)
{
    enum { LEAST_AREA = 6, SLACK = 16, MOST_RANGE = 1 << 28 };
    const struct glint_scene *s = w->scene;
    const struct glint_corner *c[3];
    int32_t depth_q30[3], most, range;
    int64_t area;

    for (int k = 0; k < 3; k++)
        c[k] = &s->corner[s->placed[id >> 20].first_vertex + t->vertex[k]];
    area = (int64_t)q_magnitude(
        (int64_t)(c[1]->x - c[0]->x) * (c[2]->y - c[0]->y) -
        (int64_t)(c[1]->y - c[0]->y) * (c[2]->x - c[0]->x));
    if (area < LEAST_AREA || !corner_depths(s, id >> 20, t, depth_q30))
        return 0;
    most = q_larger(depth_q30[0], q_larger(depth_q30[1], depth_q30[2]));
    range =
        most - q_smaller(depth_q30[0], q_smaller(depth_q30[1], depth_q30[2]));
    return range < MOST_RANGE && range <= 16 * area &&
           is_nearer(w, b, most + range + SLACK);
}

/* Sets depths by those of the corners, of which the lines say the shares.
 * Returns 0 if they change too much for 32 bits. */
static int set_depths(const struct glint_scene *s, uint32_t object,
                      const struct glint_scene_triangle *t,
                      const struct glint_line line[3], struct small *small)
{
    const struct glint_corner *c =
        &s->corner[s->placed[object].first_vertex + t->vertex[0]];
    int32_t depth_q30[3];
    int64_t all = 0, across = 0, down = 0;

    if (!corner_depths(s, object, t, depth_q30))
        return 0;
    for (int k = 0; k < 3; k++)
        all += glint_line_at(&line[k], c->x, c->y);
    if (all <= 0)
        return 0;
    for (int k = 1; k < 3; k++) { /* below 2^46 */
        across += line[k].across * (depth_q30[k] - depth_q30[0]);
        down += line[k].down * (depth_q30[k] - depth_q30[0]);
    }
    across = q_divide(across * (1 << DEPTH_BITS), all);
    down = q_divide(down * (1 << DEPTH_BITS), all);
    if (q_magnitude(across) > (uint64_t)(MOST_DEEPER >> 8) << DEPTH_BITS ||
        q_magnitude(down) > (uint64_t)(MOST_DEEPER >> 8) << DEPTH_BITS)
        return 0;
    small->depth = (struct glint_depth){
        across, down,
        (int64_t)depth_q30[0] * (1 << DEPTH_BITS) - across * c->x - down * c->y,
        DEPTH_BITS};
    return 1;
}

/* Sets what samples of all pixels have in common; the first is at (X, Y). */
static inline void set_small(const struct glint_scene *s, int n,
                             const struct glint_line line[3], int32_t x_q8,
                             int32_t y_q8, struct small *small)
{
    for (int i = 0; i < 3; i++) {
        const int32_t across = (int32_t)line[i].across;
        const int32_t down = (int32_t)line[i].down;
        int32_t most = INT32_MIN;

        for (int k = 0; k < n; k++) {
            small->off[i][k] =
                across * glint_sample(s, k, 0) + down * glint_sample(s, k, 1);
            most = q_larger(most, small->off[i][k]);
        }
        for (int k = 0; k < n; k++)
            small->off[i][k] -= most;
        small->across[i] = 256 * across;
        small->down[i] = 256 * down;
        small->at[i] = (int32_t)glint_line_at(&line[i], x_q8, y_q8) + most;
    }
    for (int k = 0; k < n; k++)
        small->deeper[k] =
            (int32_t)((small->depth.across * glint_sample(s, k, 0) +
                       small->depth.down * glint_sample(s, k, 1)) >>
                      DEPTH_BITS);
}

/* Draws N samples of a pixel, whose middle is at depth Z, AT its lines: as one
 * vector, if no compiler unrolls the loop before it looks for them. */
static inline void look_at_samples(const struct small *small, int n,
                                   const int32_t at[3], int32_t z,
                                   int32_t *restrict depth,
                                   uint32_t *restrict id)
{
    const uint32_t own = small->id;

#pragma GCC unroll 1
    for (int k = 0; k < n; k++) {
        const int32_t in = (at[0] + small->off[0][k]) |
                           (at[1] + small->off[1][k]) |
                           (at[2] + small->off[2][k]);
        const int32_t here = q_larger(1, z + small->deeper[k]);
        const int is = (in >= 0) & ((here > depth[k]) |
                                    ((here == depth[k]) & (own < id[k])));

        depth[k] = is ? here : depth[k];
        id[k] = is ? own : id[k];
    }
}

static inline void look_at_rows(struct glint_scene_worker *w, int n,
                                const struct small *small, struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const struct glint_depth d = small->depth;
    const int32_t x_q8 = glint_place(s, b.x0, 0);
    int32_t first[3] = {small->at[0], small->at[1], small->at[2]};

    for (int y = b.y0; y < b.y1; y++) {
        int64_t depth = d.across * x_q8 + d.down * glint_place(s, y, 1) + d.at;
        int32_t at[3] = {first[0], first[1], first[2]};
        int k = glint_sample_index(w, b.x0, y, 0);

        for (int x = b.x0; x < b.x1; x++, k += n) {
            if ((at[0] | at[1] | at[2]) >= 0)
                look_at_samples(
                    small, n, at,
                    q_clamp_sat(depth >> DEPTH_BITS, -(3 << 29), 3 << 29),
                    w->depth + k, w->id + k);
            for (int i = 0; i < 3; i++)
                at[i] += small->across[i];
            depth += 256 * d.across;
        }
        for (int i = 0; i < 3; i++)
            first[i] += small->down[i];
    }
}

int glint_mesh_look_small(struct glint_scene_worker *w, uint32_t id,
                          const struct glint_scene_triangle *t,
                          const struct glint_line line[3], struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const int n = s->cfg.edge_samples;
    const int32_t x_q8 = glint_place(s, b.x0, 0);
    const int32_t y_q8 = glint_place(s, b.y0, 1);
    struct small small;

    small.id = id;
    if (!set_depths(s, id >> 20, t, line, &small))
        return 0;
    if (n == 1) {
        set_small(s, 1, line, x_q8, y_q8, &small);
        look_at_rows(w, 1, &small, b);
    } else if (n == 4) {
        set_small(s, 4, line, x_q8, y_q8, &small);
        look_at_rows(w, 4, &small, b);
    } else {
        set_small(s, n, line, x_q8, y_q8, &small);
        look_at_rows(w, n, &small, b);
    }
    return 1;
}
