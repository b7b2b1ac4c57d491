/* SPDX-License-Identifier: MIT
 *
 * Shells about foods that are seen, lines to the sensors that see them, and the
 * box of all frames: where they are in a picture. */
#include "scene/motion/over.h"

#include "base/divide.h"

enum {
    MOST_HALF_Q8 = GLINT_LINE_MOST_HALF_Q8,
    LEAST_HALF_Q8 = 96 /* half of the width that a line has at least */
};

/* ---------------------------------------------------------------- projection
 */

/* A plane that lines are cut at: inside of it the product is not negative. */
struct side {
    int64_t by[3];
};

static int64_t inside(const struct side *side, const int32_t v[3])
{
    return side->by[0] * v[0] + side->by[1] * v[1] + side->by[2] * v[2];
}

/* Cuts what of A .. B is outside of SIDE; returns 0 if nothing is left. */
static int cut(const struct side *side, int32_t a[3], int32_t b[3])
{
    const int64_t in[2] = {inside(side, a), inside(side, b)};
    int32_t part_q30;

    if (in[0] >= 0 && in[1] >= 0)
        return 1;
    if (in[0] < 0 && in[1] < 0)
        return 0;
    part_q30 =
        q_part_q30(q_magnitude(in[0]), q_magnitude(in[0]) + q_magnitude(in[1]));
    for (int k = 0; k < 3; k++) {
        int32_t *const out = in[0] < 0 ? a : b;
        const int32_t at =
            q_narrow(a[k] + q_shift(((int64_t)b[k] - a[k]) * part_q30, 30));

        out[k] = at;
    }
    return 1;
}

/* Sets SIDE[2] to planes along axis K of the picture, as far outside of its
 * edges as the widest line reaches and two pixels more. FAR steps are below
 * 2^72, so they are cut to 30 bits, and coordinates are below 2^30. */
static void set_sides(const struct glint_scene_view *v, int k,
                      struct side side[2])
{
    const int64_t far_q8 =
        128 * (k ? v->height : v->width) + MOST_HALF_Q8 + 512;
    const int64_t step_q56 = v->step_q56[k];
    const int down = q_larger(0, bit_length(q_magnitude(step_q56)) +
                                     bit_length(q_magnitude(far_q8)) - 62);
    const int64_t tan = (step_q56 >> down) * far_q8; /* 56 - down bits */
    const int more = q_larger(26 - down, bit_length(q_magnitude(tan)) - 30);

    for (int i = 0; i < 2; i++) {
        side[i] = (struct side){{0, 0, (tan >> more) + 1}};
        side[i].by[k] = (i ? -1 : 1) * (INT64_C(1) << (56 - down - more));
    }
}

/* Cuts A .. B, camera coordinates, to what is well ahead and near the picture.
 */
static int cut_all(const struct glint_scene_view *v, int32_t near, int32_t a[3],
                   int32_t b[3])
{
    struct side side[4];
    const int32_t behind[2] = {a[2] - near, b[2] - near};

    set_sides(v, 0, side);
    set_sides(v, 1, side + 2);
    if (behind[0] < 0 && behind[1] < 0)
        return 0;
    if (behind[0] < 0 || behind[1] < 0) {
        const int32_t part_q30 =
            q_part_q30(q_magnitude(behind[0]),
                       q_magnitude(behind[0]) + q_magnitude(behind[1]));
        int32_t *const out = behind[0] < 0 ? a : b;

        for (int k = 0; k < 3; k++)
            out[k] =
                q_narrow(a[k] + q_shift(((int64_t)b[k] - a[k]) * part_q30, 30));
        out[2] = q_larger(out[2], near);
    }
    for (int k = 0; k < 4; k++)
        if (!cut(&side[k], a, b))
            return 0;
    return a[2] > 0 && b[2] > 0;
}

static struct glint_motion_layer *next_layer(struct glint_motion_state *m)
{
    return m->n_layers < m->max_layers ? &m->layer[m->n_layers] : NULL;
}

/* Sets the box of L to the pixels within FAR_Q8 of its two ends. */
static void set_box(const struct glint_scene *s, struct glint_motion_layer *l,
                    const struct glint_corner end[2], int32_t far_q8)
{
    const struct glint_box all = {0, 0, s->view.width, s->view.height};
    const int32_t x_q8 = 128 * (s->view.width - 1);
    const int32_t y_q8 = 128 * (s->view.height - 1);

    l->box = glint_box_cut(
        all, (struct glint_box){
                 (q_smaller(end[0].x, end[1].x) + x_q8 - far_q8) >> 8,
                 (q_smaller(end[0].y, end[1].y) + y_q8 - far_q8) >> 8,
                 ((q_larger(end[0].x, end[1].x) + x_q8 + far_q8) >> 8) + 2,
                 ((q_larger(end[0].y, end[1].y) + y_q8 + far_q8) >> 8) + 2});
}

/* Adds a line of KIND, WIDTH steps wide, from A to B, places. */
static void add_line(struct glint_scene *s, const int32_t a[3],
                     const int32_t b[3], int32_t width,
                     enum glint_scene_kind kind)
{
    struct glint_motion_layer *l = next_layer(s->motion);
    const int32_t near = s->nearest / 2 + 1; /* depths are below 2^31 */
    int32_t v[2][3];
    struct glint_corner end[2];
    int64_t along[3];
    int32_t unit_q30[3], most = 0;

    glint_view_seen(&s->view, a, v[0]);
    glint_view_seen(&s->view, b, v[1]);
    if (!l || width < 1 || !cut_all(&s->view, near, v[0], v[1]))
        return;
    for (int k = 0; k < 2; k++) {
        end[k] = glint_view_corner(&s->view, v[k]);
        l->half_q8[k] = q_clamp_sat(
            glint_ratio((uint64_t)width * (uint64_t)s->view.per_tan_q8 / 2,
                        (uint64_t)v[k][2]),
            LEAST_HALF_Q8, 1 << 30);
        l->depth[k] = q_larger(
            1, glint_ratio((uint64_t)s->nearest << 30, (uint64_t)v[k][2]));
        most = q_larger(most, q_smaller(MOST_HALF_Q8, l->half_q8[k]));
    }
    along[0] = (int64_t)end[1].x - end[0].x;
    along[1] = (int64_t)end[1].y - end[0].y;
    along[2] = 0;
    if (end[0].w != 1 || end[1].w != 1 || !glint_unit(along, unit_q30))
        return;
    l->ball = NULL;
    l->kind = kind;
    l->material = kind == GLINT_KIND_BOX ? s->motion->how->box_material
                                         : s->motion->how->line_material;
    l->x_q8 = end[0].x;
    l->y_q8 = end[0].y;
    l->length_q8 = (int32_t)glint_root(
        (uint64_t)(along[0] * along[0] + along[1] * along[1]));
    for (int k = 0; k < 2; k++)
        l->along_q14[k] = (int32_t)q_shift(unit_q30[k], 16);
    l->z = v[0][2] / 2 + v[1][2] / 2;
    set_box(s, l, end, most + 128);
    s->motion->n_layers += !glint_box_empty(l->box) && l->length_q8 > 0;
}

/* Moves A towards B by STEPS; returns 0 if they are nearer than that. */
static int shorten(int32_t a[3], const int32_t b[3], int32_t steps)
{
    int64_t off[3];
    int32_t d[3], unit_q30[3];

    v3_minus(b, a, d);
    for (int k = 0; k < 3; k++)
        off[k] = d[k];
    if (!glint_unit(off, unit_q30) ||
        (uint64_t)v3_dot(d, d) <= (uint64_t)((int64_t)steps * steps))
        return 0;
    for (int k = 0; k < 3; k++)
        a[k] += q_mul(unit_q30[k], steps, 30);
    return 1;
}

/* Returns the radius of object FIRST + I, 0 if there is none. */
static int32_t radius_of(const struct glint_scene *s, uint32_t first,
                         uint32_t i)
{
    return first == GLINT_SCENE_NONE ? 0 : s->placed[first + i].radius;
}

/* Lines from the surface of food F to that of each sensor that sees it. */
static void add_lines(struct glint_scene *s, uint32_t f)
{
    const struct glint_motion_state *m = s->motion;

    for (uint32_t i = 0; i < m->motion.header.n_sensors; i++) {
        int32_t a[3], b[3];

        if (!(m->seen_by[f] >> i & 1) || (int)i == m->sensor)
            continue;
        for (int k = 0; k < 3; k++) {
            a[k] = m->food_at[f][k];
            b[k] = m->sensor_at[i][k];
        }
        if (shorten(a, b, radius_of(s, m->how->food, f)) &&
            shorten(b, a, radius_of(s, m->how->sensor, i)))
            add_line(s, a, b, m->line, GLINT_KIND_LINES);
    }
}

/* Returns the least cosine, between P's normal and a ray, of pixels that see it
 * with all samples. */
static int32_t inner_q30(const struct glint_placed *p)
{
    const int64_t within = (int64_t)p->radius - p->margin;
    int64_t sine_q30;

    if (within <= 0)
        return INT32_MAX;
    sine_q30 = q_part_q30((uint64_t)within, (uint64_t)p->radius);
    return (int32_t)glint_root((UINT64_C(1) << 60) -
                               (uint64_t)(sine_q30 * sine_q30)) +
           1;
}

static void add_shell(struct glint_scene *s, uint32_t f)
{
    struct glint_motion_state *m = s->motion;
    struct glint_motion_layer *l = next_layer(m);
    struct glint_placed *p = &m->ball[f];

    if (!l || m->shell < 1 || m->how->food == GLINT_SCENE_NONE)
        return;
    *p = (struct glint_placed){.object = &s->model.object[m->how->food + f],
                               .radius = m->shell,
                               .reach = m->shell,
                               .is_shown = 1};
    for (int k = 0; k < 3; k++)
        p->at[k] = p->centre[k] = m->food_at[f][k];
    glint_scene_place(s, p);
    if (!p->is_seen)
        return;
    glint_quick_ball(s, p);
    l->ball = p;
    l->kind = GLINT_KIND_SHELLS;
    l->depth[0] = q_larger(1, glint_ratio((uint64_t)s->nearest << 30,
                                          (uint64_t)q_larger(p->z[1], 1)));
    l->inner_q30 = inner_q30(p);
    l->material = m->how->shell_material;
    l->z = p->z[0] / 2 + p->z[1] / 2;
    l->box = p->box;
    m->n_layers++;
}

static void add_box(struct glint_scene *s)
{
    const struct glint_motion_state *m = s->motion;
    const int32_t *end[2] = {m->low, m->high};

    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 4; k++) {
            const int i = (axis + 1) % 3, j = (axis + 2) % 3;
            int32_t a[3], b[3];

            a[i] = b[i] = end[k & 1][i];
            a[j] = b[j] = end[k >> 1][j];
            a[axis] = m->low[axis];
            b[axis] = m->high[axis];
            add_line(s, a, b, m->edge, GLINT_KIND_BOX);
        }
}

/* From back to front; of two as far away the first stays the first. */
static void sort(struct glint_motion_state *m)
{
    for (int i = 1; i < m->n_layers; i++) {
        const struct glint_motion_layer l = m->layer[i];
        int k = i;

        for (; k > 0 && m->layer[k - 1].z < l.z; k--)
            m->layer[k] = m->layer[k - 1];
        m->layer[k] = l;
    }
}

static void project(struct glint_scene *s)
{
    struct glint_motion_state *m = s->motion;

    m->n_layers = 0;
    if (glint_motion_shows(m, GLINT_KIND_BOX))
        add_box(s);
    for (uint32_t f = 0; f < m->motion.header.n_foods; f++) {
        if (!m->seen_by[f])
            continue;
        if (glint_motion_shows(m, GLINT_KIND_SHELLS))
            add_shell(s, f);
        if (glint_motion_shows(m, GLINT_KIND_LINES))
            add_lines(s, f);
    }
    sort(m);
}

static int count(const struct glint_scene *s, enum glint_scene_kind kind)
{
    int n = 0;

    for (int i = 0; i < s->motion->n_layers; i++)
        n += s->motion->layer[i].kind == kind;
    return n;
}

static void carve_worker(const struct glint_scene *s, struct glint_arena *arena,
                         struct glint_scene_worker *worker)
{
    worker->span = glint_arena_take(arena, glint_motion_layers(s->model.motion),
                                    sizeof *worker->span);
    worker->over = glint_arena_take(arena, glint_motion_layers(s->model.motion),
                                    sizeof *worker->over);
}

const struct glint_scene_motions glint_scene_motions = {glint_motion_carve,
                                                        carve_worker,
                                                        glint_motion_begin,
                                                        project,
                                                        count,
                                                        glint_layers_touch,
                                                        glint_layers_list,
                                                        glint_layers_next,
                                                        glint_layers_over};
