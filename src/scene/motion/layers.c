/* SPDX-License-Identifier: MIT
 *
 * Draws the overlays of a recorded motion. The recording has a body with
 * sensors, and food items (landmarks that the sensors detect). Overlays are
 * shells around visible food items, lines from food items to the sensors that
 * see them, and the box that encloses the motion of all frames. They are
 * projected to the picture and composited over the pixels of a tile.
 *
 * A line has a width in space, which is projected to pixels at the point of the
 * line nearest to the pixel's middle; it is at least 3/4 of a pixel. The
 * coverage of a pixel, in 1/256, is its overlap with a strip of this width. The
 * rims of shells are found by exact rays. Inside the rim, the coverage by a
 * shell has an error of 2^-11. */
#include "base/compiler.h"
#include "base/divide.h"
#include "scene/motion/play.h"

enum {
    ALL_Q8 = 256,
    SUMMED = 4,
    MOST_HALF_Q8 = 1 << 16, /* max half width of a line, 1/256 pixel */
    LEAST_HALF_Q8 = 96      /* min half width of a line, 1/256 pixel */
};

/* -------------------------------------------------------------- projection */

/* A clipping plane: points whose dot product with the normal BY is 0 or more
 * are inside. */
struct side {
    int64_t by[3];
};

static int64_t compute_distance_to_clip_plane(const struct side *side,
                                              const int32_t v[3])
{
    return side->by[0] * v[0] + side->by[1] * v[1] + side->by[2] * v[2];
}

/* Clips the line from A to B to the inner side of plane SIDE; returns 0 if the
 * whole line is outside. */
static int clip_line_to_plane(const struct side *side, int32_t a[3],
                              int32_t b[3])
{
    const int64_t in[2] = {compute_distance_to_clip_plane(side, a),
                           compute_distance_to_clip_plane(side, b)};
    int32_t part_q30;

    if (in[0] >= 0 && in[1] >= 0)
        return 1;
    if (in[0] < 0 && in[1] < 0)
        return 0;
    part_q30 = q_divide_to_fraction_q30(
        q_magnitude(in[0]), q_magnitude(in[0]) + q_magnitude(in[1]));
    for (int k = 0; k < 3; k++) {
        int32_t *const out = in[0] < 0 ? a : b;
        const int32_t at =
            q_narrow(a[k] + q_shift(((int64_t)b[k] - a[k]) * part_q30, 30));

        out[k] = at;
    }
    return 1;
}

/* Sets SIDE[2] to the clipping planes at both edges of the picture along axis
 * K, moved outwards by the max half width of a line plus two pixels. Their
 * coefficients are below 2^72. They are truncated to 30 bits, like coordinates,
 * so that products fit into 64 bits. */
static void set_clip_planes(const struct glint_scene_view *v, int k,
                            struct side side[2])
{
    const int64_t far_q8 =
        128 * (k ? v->height : v->width) + MOST_HALF_Q8 + 512;
    const int64_t step_q56 = v->step_q56[k];
    const int down = q_larger(0, bit_length(q_magnitude(step_q56)) +
                                     bit_length(q_magnitude(far_q8)) - 62);
    /* tangent of the clipping plane, with 56 - DOWN fraction bits */
    const int64_t tan = (step_q56 >> down) * far_q8;
    const int more = q_larger(26 - down, bit_length(q_magnitude(tan)) - 30);

    for (int i = 0; i < 2; i++) {
        side[i] = (struct side){{0, 0, (tan >> more) + 1}};
        side[i].by[k] = (i ? -1 : 1) * (INT64_C(1) << (56 - down - more));
    }
}

/* Clips the line from A to B, in camera coordinates, to the region in front of
 * the camera and near the picture; returns 0 if no part of it is there. */
static int clip_line_to_view(const struct glint_scene_view *v, int32_t near,
                             int32_t a[3], int32_t b[3])
{
    struct side side[4];
    const int32_t behind[2] = {a[2] - near, b[2] - near};

    set_clip_planes(v, 0, side);
    set_clip_planes(v, 1, side + 2);
    if (behind[0] < 0 && behind[1] < 0)
        return 0;
    if (behind[0] < 0 || behind[1] < 0) {
        const int32_t part_q30 = q_divide_to_fraction_q30(
            q_magnitude(behind[0]),
            q_magnitude(behind[0]) + q_magnitude(behind[1]));
        int32_t *const out = behind[0] < 0 ? a : b;

        for (int k = 0; k < 3; k++)
            out[k] =
                q_narrow(a[k] + q_shift(((int64_t)b[k] - a[k]) * part_q30, 30));
        out[2] = q_larger(out[2], near);
    }
    for (int k = 0; k < 4; k++)
        if (!clip_line_to_plane(&side[k], a, b))
            return 0;
    return a[2] > 0 && b[2] > 0;
}

static struct glint_motion_layer *get_free_overlay(struct glint_motion_state *m)
{
    return m->n_layers < m->max_layers ? &m->layer[m->n_layers] : NULL;
}

/* Sets the box of line L to the pixels within FAR_Q8 of the line between its
 * ends. */
static void set_line_box(const struct glint_scene *s,
                         struct glint_motion_layer *l,
                         const struct glint_corner end[2], int32_t far_q8)
{
    const struct glint_box all = {0, 0, s->view.width, s->view.height};
    const int32_t x_q8 = 128 * (s->view.width - 1);
    const int32_t y_q8 = 128 * (s->view.height - 1);

    l->box = glint_box_intersect(
        all, (struct glint_box){
                 (q_smaller(end[0].x, end[1].x) + x_q8 - far_q8) >> 8,
                 (q_smaller(end[0].y, end[1].y) + y_q8 - far_q8) >> 8,
                 ((q_larger(end[0].x, end[1].x) + x_q8 + far_q8) >> 8) + 2,
                 ((q_larger(end[0].y, end[1].y) + y_q8 + far_q8) >> 8) + 2});
}

/* Adds a line of type KIND (enum glint_scene_kind), WIDTH steps wide, from
 * point A to point B, if it is visible and the list is not full. */
static void append_line_overlay(struct glint_scene *s, const int32_t a[3],
                                const int32_t b[3], int32_t width,
                                enum glint_scene_kind kind)
{
    struct glint_motion_layer *l = get_free_overlay(s->motion);
    /* min z of a line, steps, so that depths, 2^30 nearest / z, are below
     * 2^31 */
    const int32_t near = s->nearest / 2 + 1;
    int32_t v[2][3];
    struct glint_corner end[2];
    int64_t along[3];
    int32_t unit_q30[3], most = 0;

    glint_view_convert_to_camera(&s->view, a, v[0]);
    glint_view_convert_to_camera(&s->view, b, v[1]);
    if (!l || width < 1 || !clip_line_to_view(&s->view, near, v[0], v[1]))
        return;
    for (int k = 0; k < 2; k++) {
        end[k] = glint_view_project_vertex(&s->view, v[k]);
        l->half_q8[k] =
            q_clamp_sat(glint_divide_rounded(
                            (uint64_t)width * (uint64_t)s->view.per_tan_q8 / 2,
                            (uint64_t)v[k][2]),
                        LEAST_HALF_Q8, 1 << 30);
        l->depth[k] =
            q_larger(1, glint_divide_rounded((uint64_t)s->nearest << 30,
                                             (uint64_t)v[k][2]));
        most = q_larger(most, q_smaller(MOST_HALF_Q8, l->half_q8[k]));
    }
    along[0] = (int64_t)end[1].x - end[0].x;
    along[1] = (int64_t)end[1].y - end[0].y;
    along[2] = 0;
    if (end[0].w != 1 || end[1].w != 1 ||
        !glint_normalise_vector(along, unit_q30))
        return;
    l->ball = NULL;
    l->kind = kind;
    l->material = kind == GLINT_KIND_BOX ? s->motion->how->box_material
                                         : s->motion->how->line_material;
    l->x_q8 = end[0].x;
    l->y_q8 = end[0].y;
    l->length_q8 = (int32_t)glint_compute_square_root(
        (uint64_t)(along[0] * along[0] + along[1] * along[1]));
    for (int k = 0; k < 2; k++)
        l->along_q14[k] = (int32_t)q_shift(unit_q30[k], 16);
    l->z = v[0][2] / 2 + v[1][2] / 2;
    set_line_box(s, l, end, most + 128);
    s->motion->n_layers += !glint_box_is_empty(l->box) && l->length_q8 > 0;
}

/* Moves point A by STEPS towards B; returns 0 if the distance from A to B is at
 * most STEPS. */
static int move_point_towards(int32_t a[3], const int32_t b[3], int32_t steps)
{
    int64_t off[3];
    int32_t d[3], unit_q30[3];

    v3_subtract(b, a, d);
    for (int k = 0; k < 3; k++)
        off[k] = d[k];
    if (!glint_normalise_vector(off, unit_q30) ||
        (uint64_t)v3_dot(d, d) <= (uint64_t)((int64_t)steps * steps))
        return 0;
    for (int k = 0; k < 3; k++)
        a[k] += q_mul(unit_q30[k], steps, 30);
    return 1;
}

/* Returns the radius of object FIRST + I, steps, or 0 if FIRST is
 * GLINT_SCENE_NONE. */
static int32_t get_ball_radius(const struct glint_scene *s, uint32_t first,
                               uint32_t i)
{
    return first == GLINT_SCENE_NONE ? 0 : s->placed[first + i].radius;
}

/* Adds lines from the surface of food item F to the surface of each sensor that
 * sees it, except the sensor that the camera is attached to. */
static void append_lines_from_food_to_sensors(struct glint_scene *s, uint32_t f)
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
        if (move_point_towards(a, b, get_ball_radius(s, m->how->food, f)) &&
            move_point_towards(b, a, get_ball_radius(s, m->how->sensor, i)))
            append_line_overlay(s, a, b, m->line, GLINT_KIND_LINES);
    }
}

/* Returns the cosine between the normal of ball P and a ray through a pixel's
 * middle above which the rays through all samples of the pixel hit P; INT32_MAX
 * if P is smaller than a pixel. */
static int32_t compute_min_cosine_inside_rim_q30(const struct glint_placed *p)
{
    const int64_t within = (int64_t)p->radius - p->margin;
    int64_t sine_q30;

    if (within <= 0)
        return INT32_MAX;
    sine_q30 = q_divide_to_fraction_q30((uint64_t)within, (uint64_t)p->radius);
    return (int32_t)glint_compute_square_root((UINT64_C(1) << 60) -
                                              (uint64_t)(sine_q30 * sine_q30)) +
           1;
}

static void append_shell_overlay(struct glint_scene *s, uint32_t f)
{
    struct glint_motion_state *m = s->motion;
    struct glint_motion_layer *l = get_free_overlay(m);
    struct glint_placed *p = &m->ball[f];

    if (!l || m->shell < 1 || m->how->food == GLINT_SCENE_NONE)
        return;
    *p = (struct glint_placed){.object = &s->model.object[m->how->food + f],
                               .radius = m->shell,
                               .reach = m->shell,
                               .is_shown = 1};
    for (int k = 0; k < 3; k++)
        p->at[k] = p->centre[k] = m->food_at[f][k];
    glint_scene_find_object_box(s, p);
    if (!p->is_seen)
        return;
    glint_quick_prepare_ball(s, p);
    l->ball = p;
    l->kind = GLINT_KIND_SHELLS;
    l->depth[0] =
        q_larger(1, glint_divide_rounded((uint64_t)s->nearest << 30,
                                         (uint64_t)q_larger(p->z[1], 1)));
    l->inner_q30 = compute_min_cosine_inside_rim_q30(p);
    l->material = m->how->shell_material;
    l->z = p->z[0] / 2 + p->z[1] / 2;
    l->box = p->box;
    m->n_layers++;
}

static void append_box_edges(struct glint_scene *s)
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
            append_line_overlay(s, a, b, m->edge, GLINT_KIND_BOX);
        }
}

/* Sorts the overlays from back to front; a stable sort. */
static void sort_overlays_back_to_front(struct glint_motion_state *m)
{
    for (int i = 1; i < m->n_layers; i++) {
        const struct glint_motion_layer l = m->layer[i];
        int k = i;

        for (; k > 0 && m->layer[k - 1].z < l.z; k--)
            m->layer[k] = m->layer[k - 1];
        m->layer[k] = l;
    }
}

static void project_overlays(struct glint_scene *s)
{
    struct glint_motion_state *m = s->motion;

    m->n_layers = 0;
    if (glint_motion_is_kind_shown(m, GLINT_KIND_BOX))
        append_box_edges(s);
    for (uint32_t f = 0; f < m->motion.header.n_foods; f++) {
        if (!m->seen_by[f])
            continue;
        if (glint_motion_is_kind_shown(m, GLINT_KIND_SHELLS))
            append_shell_overlay(s, f);
        if (glint_motion_is_kind_shown(m, GLINT_KIND_LINES))
            append_lines_from_food_to_sensors(s, f);
    }
    sort_overlays_back_to_front(m);
}

static int count_overlays_of_kind(const struct glint_scene *s,
                                  enum glint_scene_kind kind)
{
    int n = 0;

    for (int i = 0; i < s->motion->n_layers; i++)
        n += s->motion->layer[i].kind == kind;
    return n;
}

/* ------------------------------------------------------------------- tiles */

static struct glint_box find_overlay_box(const struct glint_scene *s,
                                         struct glint_box tile)
{
    struct glint_box all = {0, 0, 0, 0};

    for (int i = 0; i < s->motion->n_layers; i++)
        all = glint_box_unite(
            all, glint_box_intersect(tile, s->motion->layer[i].box));
    return all;
}

/* Narrows the pixel range X0 .. X1 - 1 to the pixels of row Y that line L may
 * cover; keeps it if the line is almost parallel to the row. */
static void narrow_column_range_to_line(const struct glint_scene *s,
                                        const struct glint_motion_layer *l,
                                        int y, int *x0, int *x1)
{
    const int32_t down = glint_pixel_position_q8(s, y, 1) - l->y_q8;
    const int32_t *u = l->along_q14;
    const int64_t reach =
        (int64_t)(q_smaller(MOST_HALF_Q8,
                            q_larger(l->half_q8[0], l->half_q8[1])) +
                  128)
        << 14;
    int64_t at[2];

    if (q_magnitude(u[1]) < 1 << 8) /* the line is nearly parallel to the row */
        return;
    for (int k = 0; k < 2; k++)
        at[k] = q_divide((int64_t)down * u[0] + (k ? reach : -reach), u[1]) +
                l->x_q8 + 128 * (s->view.width - 1);
    if (at[0] > at[1]) {
        const int64_t swap = at[0];

        at[0] = at[1];
        at[1] = swap;
    }
    *x0 = q_larger(*x0, q_clamp_sat((at[0] >> 8) - 1, 0, INT32_MAX));
    *x1 = q_smaller(*x1, q_clamp_sat((at[1] >> 8) + 2, 0, INT32_MAX));
}

static void list_overlays_in_row(struct glint_scene_worker *w, int y)
{
    const struct glint_motion_state *m = w->scene->motion;

    w->n_spans = 0;
    for (int i = 0; i < m->n_layers; i++) {
        const struct glint_box b =
            glint_box_intersect(w->tile, m->layer[i].box);
        struct glint_layer_span span = {i, m->layer[i].kind, b.x0, b.x1};

        if (y < b.y0 || y >= b.y1)
            continue;
        if (!m->layer[i].ball)
            narrow_column_range_to_line(w->scene, &m->layer[i], y, &span.x0,
                                        &span.x1);
        else if (!glint_scene_find_ball_span(w->scene, m->layer[i].ball, y,
                                             &span.x0, &span.x1))
            continue;
        if (span.x0 < span.x1)
            w->span[w->n_spans++] = span;
    }
}

/* Returns the fraction of the samples of pixel (X, Y) at which no object is
 * nearer than DEPTH, q8. */
static int compute_unoccluded_fraction_q8(const struct glint_scene_worker *w,
                                          int x, int y, int32_t depth)
{
    const int n = w->scene->cfg.edge_samples;
    const int first = glint_get_sample_index(w, x, y, 0);
    int seen = 0;

    for (int k = 0; k < n; k++)
        seen += w->depth[first + k] <= depth;
    return seen * ALL_Q8 >> glint_get_samples_log2(n);
}

/* Returns the fraction of pixel (X, Y) that line L covers, q8. */
static int compute_line_cover_q8(const struct glint_scene_worker *w,
                                 const struct glint_motion_layer *l, int x,
                                 int y)
{
    const int64_t dx = glint_pixel_position_q8(w->scene, x, 0) - l->x_q8;
    const int64_t dy = glint_pixel_position_q8(w->scene, y, 1) - l->y_q8;
    const int32_t along =
        (int32_t)q_shift(dx * l->along_q14[0] + dy * l->along_q14[1], 14);
    const int32_t across = (int32_t)q_magnitude(
        q_shift(dx * l->along_q14[1] - dy * l->along_q14[0], 14));
    const int32_t end =
        q_smaller(ALL_Q8, q_smaller(along, l->length_q8 - along) + 128);
    const int32_t most =
        q_larger(l->half_q8[0], l->half_q8[1]); /* below 2^30 */
    int32_t part_q30, half, cover;

    if (end <= 0 || across >= most + 128)
        return 0;
    part_q30 = q_divide_to_fraction_q30(
        (uint64_t)q_smaller(q_larger(along, 0), l->length_q8),
        (uint64_t)l->length_q8);
    half = l->half_q8[0] + q_mul(l->half_q8[1] - l->half_q8[0], part_q30, 30);
    half = q_smaller(MOST_HALF_Q8, half);
    cover = q_smaller(q_smaller(ALL_Q8, 2 * half), half + 128 - across);
    if (cover <= 0)
        return 0;
    return (cover * end >> 8) *
               compute_unoccluded_fraction_q8(
                   w, x, y,
                   l->depth[0] +
                       q_mul(l->depth[1] - l->depth[0], part_q30, 30)) >>
           8;
}

/* Returns the depth of the point T steps away in direction SEEN_Q30. */
static int32_t compute_depth_at_distance(const struct glint_scene *s, int32_t t,
                                         const int32_t seen_q30[3])
{
    const int32_t z = t <= 0 ? 1 : q_larger(1, q_mul(t, seen_q30[2], 30));

    return q_larger(
        1, glint_divide_rounded((uint64_t)s->nearest << 30, (uint64_t)z));
}

/* Sets CHORD to the chord of the ray through (X, Y) in BALL, and DEPTH to the
 * depth at which the ray enters BALL; returns 0 if the ray misses BALL. */
static int find_ball_entry(const struct glint_scene *s,
                           const struct glint_placed *ball, int32_t x_q8,
                           int32_t y_q8, struct glint_chord *chord,
                           int32_t *depth)
{
    struct glint_scene_ray ray;
    int32_t seen_q30[3];

    glint_view_set_ray(&s->view, x_q8, y_q8, &ray, seen_q30);
    if (!glint_ray_intersect_sphere(&ray, ball->at, ball->radius, chord) ||
        chord->t[1] <= 0)
        return 0;
    *depth = compute_depth_at_distance(s, chord->t[0], seen_q30);
    return 1;
}

/* Returns the opacity of a shell at a point where COSINE_Q15 is the cosine
 * between normal and ray: (1 - transmission) (1 - cosine / 2). So it is highest
 * at the rim and half of that in the middle. */
static int64_t compute_shell_cover_q31(const struct glint_scene *s,
                                       const struct glint_motion_layer *l,
                                       int32_t cosine_q15)
{
    const int32_t share_q15 =
        GLINT_SCENE_ONE_Q15 - s->material[l->material].pass_q15;

    return (int64_t)share_q15 * (2 * GLINT_SCENE_ONE_Q15 - cosine_q15);
}

/* Returns the opacity of a shell times its coverage of pixel (X, Y), q8. Used
 * near the shell's rim, or if the camera is inside the shell, where the fast
 * path (quick.h) does not apply. */
static NEVER_INLINE int
compute_shell_rim_cover_q8(const struct glint_scene_worker *w,
                           const struct glint_motion_layer *l, int x, int y)
{
    const struct glint_scene *s = w->scene;
    const struct glint_placed *ball = l->ball;
    const int n = s->cfg.edge_samples;
    const int32_t x_q8 = glint_pixel_position_q8(s, x, 0),
                  y_q8 = glint_pixel_position_q8(s, y, 1);
    struct glint_chord chord;
    int32_t depth = 0, cosine_q15 = 0;
    int hits = 0, is_inner = 0;

    if (find_ball_entry(s, ball, x_q8, y_q8, &chord, &depth)) {
        const int64_t radius = (int64_t)ball->radius * (INT64_C(1) << chord.up);
        const int64_t within =
            ((int64_t)ball->radius - ball->margin) * (INT64_C(1) << chord.up);

        cosine_q15 =
            q_divide_to_fraction_q30(
                (uint64_t)chord.half,
                (uint64_t)(radius > chord.half ? radius : chord.half)) >>
            15;
        is_inner =
            within > 0 && v3_dot(chord.middle, chord.middle) <= within * within;
        hits = is_inner ? n : 0;
    }
    for (int k = 0; k < n && !is_inner; k++) {
        struct glint_chord at;
        int32_t sample_depth;

        if (!find_ball_entry(s, ball, x_q8 + glint_sample_offset_q8(s, k, 0),
                             y_q8 + glint_sample_offset_q8(s, k, 1), &at,
                             &sample_depth))
            continue;
        depth = q_larger(depth, sample_depth);
        hits++;
    }
    if (hits == 0)
        return 0;
    return (int)q_shift((compute_shell_cover_q31(s, l, cosine_q15) * hits >>
                         glint_get_samples_log2(n)) *
                            compute_unoccluded_fraction_q8(w, x, y, depth),
                        31);
}

/* Returns whether no sample of pixel (X, Y) sees an object nearer than
 * DEPTH. */
static int is_pixel_unoccluded(const struct glint_scene_worker *w, int x, int y,
                               int32_t depth)
{
    const int32_t *at = &w->depth[glint_get_sample_index(w, x, y, 0)];
    int nearer = 0;

    for (int k = 0; k < w->scene->cfg.edge_samples; k++)
        nearer |= at[k] > depth;
    return !nearer;
}

/* Returns the opacity of a shell times its coverage of pixel (X, Y), q8. Uses
 * the fast path (quick.h) for pixels inside the rim. */
static int compute_shell_cover_q8(const struct glint_scene_worker *w,
                                  const struct glint_motion_layer *l, int x,
                                  int y)
{
    const struct glint_scene *s = w->scene;
    struct glint_scene_ray ray;
    int32_t seen_q30[3], across_q30[3], cosine_q30, t;
    int all_q8 = ALL_Q8;

    if (!l->ball->over_up)
        return compute_shell_rim_cover_q8(w, l, x, y);
    glint_quick_compute_ray(&s->view, glint_pixel_position_q8(s, x, 0),
                            glint_pixel_position_q8(s, y, 1), &ray, seen_q30);
    if (!glint_quick_intersect_ball(l->ball, &ray, across_q30, &cosine_q30) ||
        cosine_q30 < l->inner_q30)
        return compute_shell_rim_cover_q8(w, l, x, y);
    /* l->depth[0] is the depth of the shell's far side */
    if (!is_pixel_unoccluded(w, x, y, l->depth[0])) {
        t = glint_quick_get_ball_distance(l->ball, &ray, cosine_q30);
        all_q8 = compute_unoccluded_fraction_q8(
            w, x, y, compute_depth_at_distance(s, t, seen_q30));
    }
    return (int)q_shift(
        compute_shell_cover_q31(s, l, cosine_q30 >> 15) * all_q8, 31);
}

static int list_overlays_at_pixel(struct glint_scene_worker *w, int x)
{
    int end = w->tile.x1;

    w->n_over = 0;
    for (int i = 0; i < w->n_spans; i++) {
        const struct glint_layer_span *span = &w->span[i];

        if (x < span->x0) {
            end = q_smaller(end, span->x0);
        } else if (x < span->x1) {
            end = q_smaller(end, span->x1);
            w->over[w->n_over++] = span->layer;
        }
    }
    return end;
}

static void composite_overlays_over_pixel(const struct glint_scene_worker *w,
                                          int x, int y,
                                          struct glint_scene_sum *sum)
{
    const struct glint_scene *s = w->scene;

    for (int i = 0; i < w->n_over; i++) {
        const struct glint_motion_layer *l = &s->motion->layer[w->over[i]];
        const int32_t *rgb_q15 = s->material[l->material].rgb_q15;
        int a;

        a = l->ball ? compute_shell_cover_q8(w, l, x, y)
                    : compute_line_cover_q8(w, l, x, y);
        if (a == 0)
            continue;
        for (int c = 0; c < 3; c++)
            sum->rgb_q17[c] = q_shift(sum->rgb_q17[c] * (ALL_Q8 - a) +
                                          (int64_t)SUMMED * rgb_q15[c] * a,
                                      8);
        sum->cover_q10 = (int)q_shift(
            sum->cover_q10 * (int64_t)(ALL_Q8 - a) + SUMMED * ALL_Q8 * a, 8);
    }
}

static void allocate_overlay_arrays_of_worker(const struct glint_scene *s,
                                              struct glint_arena *arena,
                                              struct glint_scene_worker *worker)
{
    worker->span = glint_arena_allocate(
        arena, glint_motion_count_max_overlays(s->model.motion),
        sizeof *worker->span);
    worker->over = glint_arena_allocate(
        arena, glint_motion_count_max_overlays(s->model.motion),
        sizeof *worker->over);
}

const struct glint_scene_motions glint_scene_motions = {
    glint_motion_allocate,        allocate_overlay_arrays_of_worker,
    glint_motion_start_playback,  project_overlays,
    count_overlays_of_kind,       find_overlay_box,
    list_overlays_in_row,         list_overlays_at_pixel,
    composite_overlays_over_pixel};
