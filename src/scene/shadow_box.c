/* SPDX-License-Identifier: MIT
 *
 * Where shadows on a plane may be. */
#include "base/divide.h"
#include "scene/state.h"

/* Finds the place of plane P that the sun sees at (U, V); returns 0 if it is
 * out of the grid's reach. */
static int plane_place(const struct glint_shadow *shadow,
                       const struct glint_placed *p, int32_t u, int32_t v,
                       int32_t place[3])
{
    int32_t at[3], n_q30[3], to[3] = {u, v, 0};
    int64_t off_q30, h;

    v3_turn(&shadow->turn, p->at, at);
    v3_turn(&shadow->turn, p->centre, n_q30);
    if (q_magnitude(n_q30[2]) < 1 << 20)
        return 0;
    off_q30 = ((int64_t)u - at[0]) * n_q30[0] + ((int64_t)v - at[1]) * n_q30[1];
    h = at[2] - q_divide(off_q30, n_q30[2]);
    if (h < shadow->lowest || h <= -(1 << 29) || h >= 1 << 29 ||
        q_magnitude(u) >= 1 << 29 || q_magnitude(v) >= 1 << 29)
        return 0;
    to[2] = (int32_t)h;
    v3_turn_back(&shadow->turn, to, place);
    return 1;
}

struct glint_box glint_shadow_box(const struct glint_scene *s,
                                  const struct glint_shadow *shadow,
                                  const struct glint_placed *p)
{
    const struct glint_box all = {0, 0, s->view.width, s->view.height};
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};

    if (shadow->is_empty)
        return (struct glint_box){0, 0, 0, 0};
    for (int k = 0; k < 4; k++) {
        int32_t place[3], seen[3];
        struct glint_corner c;

        if (!plane_place(shadow, p, k & 1 ? shadow->lo[0] : shadow->hi[0],
                         k & 2 ? shadow->lo[1] : shadow->hi[1], place))
            return all;
        glint_view_seen(&s->view, place, seen);
        c = glint_view_corner(&s->view, seen);
        if (seen[2] <= 0 || c.w != 1)
            return all;
        lo[0] = q_smaller(lo[0], c.x);
        lo[1] = q_smaller(lo[1], c.y);
        hi[0] = q_larger(hi[0], c.x);
        hi[1] = q_larger(hi[1], c.y);
    }
    return glint_box_cut(
        all, (struct glint_box){((lo[0] + 128 * (all.x1 - 1)) >> 8) - 1,
                                ((lo[1] + 128 * (all.y1 - 1)) >> 8) - 1,
                                ((hi[0] + 128 * (all.x1 - 1)) >> 8) + 2,
                                ((hi[1] + 128 * (all.y1 - 1)) >> 8) + 2});
}
