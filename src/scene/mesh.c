/* SPDX-License-Identifier: MIT
 *
 * Triangles in the picture: vertices moved to the camera once, triangles listed
 * by tiles, and in a tile three exact edge functions for each.
 *
 * Nothing is clipped. Edges are cross products of homogeneous corners (view.h):
 * with x, y within 2^22 and w 1, or all within 2^16, their elements stay below
 * 2^39, +-2^40 the last; a sample is within 2^22, so a sum is below 2^62. A
 * corner is rounded once, alike in all triangles that have it, so that these
 * neither leak nor overlap. A sample on an edge is on one side of it by the
 * edge's own direction, which two neighbours see the other way round. */
#include "scene/mesh.h"

#include "scene/visible.h"
#include "scene/parts.h"

/* ------------------------------------------------------------------ corners */

static const struct glint_corner *corner_of(const struct glint_scene *s,
                                            uint32_t object, uint32_t vertex)
{
    return &s->corner[s->placed[object].first_vertex + vertex];
}

static void move_vertices(struct glint_scene *s, uint32_t object)
{
    const struct glint_placed *p = &s->placed[object];
    const struct glint_scene_mesh *m = glint_mesh_of(s, object);
    const int32_t *vertex = glint_mesh_table(s, m->vertex_at);

    for (uint32_t i = 0; i < m->n_vertices; i++) {
        int32_t *to = s->seen[p->first_vertex + i], place[3];

        v3_turn(&p->turn, vertex + 3 * (size_t)i, place);
        for (int k = 0; k < 3; k++)
            place[k] += p->at[k];
        glint_view_seen(&s->view, place, to);
        s->corner[p->first_vertex + i] = glint_view_corner(&s->view, to);
    }
}

/* Returns how far samples lie from the middle of their pixel at most. */
static int32_t most_off_q8(const struct glint_scene *s)
{
    return s->cfg.edge_samples > 4 ? 120 : 96;
}

/* Returns the first pixel with a sample at X or right of it, or below it. */
static int first_at(int32_t x_q8, int side, int32_t off_q8)
{
    return (x_q8 + 128 * (side - 1) - off_q8 + 255) >> 8;
}

/* Returns one more than the last with a sample at X or before. */
static int end_at(int32_t x_q8, int side, int32_t off_q8)
{
    return ((x_q8 + 128 * (side - 1) + off_q8) >> 8) + 1;
}

/* Lines of triangles that are as wide and high as this at most are below 2^30
 * at places less than 256 beside them, and so are sums of two. */
enum { SMALL_Q8 = 48 << 8 };

/* The pixels that a triangle may touch: all, where a corner is behind the
 * camera or far out. */
static struct glint_box box_of(const struct glint_scene *s, uint32_t object,
                               const struct glint_scene_triangle *t,
                               int *is_small)
{
    const struct glint_box all = {0, 0, s->view.width, s->view.height};
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};
    const int32_t off_q8 = most_off_q8(s);
    int n_near = 0, n_behind = 0;

    for (int k = 0; k < 3; k++) {
        const struct glint_corner *c = corner_of(s, object, t->vertex[k]);

        n_near += c->w == 1;
        n_behind += c->w < 0;
        lo[0] = q_smaller(lo[0], c->x);
        lo[1] = q_smaller(lo[1], c->y);
        hi[0] = q_larger(hi[0], c->x);
        hi[1] = q_larger(hi[1], c->y);
    }
    *is_small =
        n_near == 3 && hi[0] - lo[0] <= SMALL_Q8 && hi[1] - lo[1] <= SMALL_Q8;
    if (n_behind == 3)
        return (struct glint_box){0, 0, 0, 0};
    if (n_near < 3)
        return all;
    return glint_box_cut(all,
                         (struct glint_box){first_at(lo[0], all.x1, off_q8),
                                            first_at(lo[1], all.y1, off_q8),
                                            end_at(hi[0], all.x1, off_q8),
                                            end_at(hi[1], all.y1, off_q8)});
}

/* -------------------------------------------------------------------- lists */

/* Returns how many entries the triangles of an object take. */
static int64_t span_of(struct glint_scene *s, uint32_t object)
{
    const struct glint_scene_mesh *m = glint_mesh_of(s, object);
    int64_t n = 0;
    int is_small;

    for (uint32_t i = 0; i < m->n_triangles; i++)
        n += glint_bins_span(
            &s->bins,
            box_of(s, object, glint_mesh_triangle(s, m, i), &is_small));
    return n;
}

/* Returns whether a triangle turns its front to the camera, or may. */
static int is_facing(const struct glint_scene *s, uint32_t object,
                     const struct glint_scene_triangle *t)
{
    const struct glint_corner *a = corner_of(s, object, t->vertex[0]);
    const struct glint_corner *b = corner_of(s, object, t->vertex[1]);
    const struct glint_corner *c = corner_of(s, object, t->vertex[2]);

    return a->w != 1 || b->w != 1 || c->w != 1 ||
           (int64_t)(b->x - a->x) * (c->y - a->y) >
               (int64_t)(b->y - a->y) * (c->x - a->x);
}

enum { BOTH_SIDES = -1 };

/* Counts the triangles of all meshes, or puts into the lists those that face
 * the camera, or those that do not. */
static void list(struct glint_scene *s, int facing)
{
    for (uint32_t k = 0; k < s->model.header->n_objects; k++) {
        const struct glint_scene_triangle *t;
        const struct glint_scene_mesh *m;

        if (s->placed[k].object->kind != GLINT_OBJECT_MESH ||
            !s->placed[k].is_seen)
            continue;
        m = glint_mesh_of(s, k);
        t = glint_mesh_triangle(s, m, 0);
        for (uint32_t i = 0; i < m->n_triangles; i++, t++) {
            struct glint_box b;
            int is_small;

            if (facing != BOTH_SIDES && facing != is_facing(s, k, t))
                continue;
            b = box_of(s, k, t, &is_small);
            if (glint_box_empty(b))
                continue;
            if (facing != BOTH_SIDES)
                glint_bins_put(&s->bins, b, (int32_t)glint_id(k, i));
            else
                glint_bins_count(&s->bins, b);
        }
    }
}

static void project_meshes(struct glint_scene *s,
                           struct glint_scene_stats *stats)
{
    int64_t need = 0;

    glint_bins_open(&s->bins);
    for (uint32_t k = 0; k < s->model.header->n_objects; k++) {
        struct glint_placed *p = &s->placed[k];
        int64_t span;

        if (p->object->kind != GLINT_OBJECT_MESH || !p->is_seen)
            continue;
        move_vertices(s, k);
        span = span_of(s, k);
        need += span;
        if (stats->refs + span > s->cfg.max_refs) {
            p->is_seen = 0;
            stats->dropped_objects++;
            continue;
        }
        stats->refs += (int)span;
        stats->triangles += (int)glint_mesh_of(s, k)->n_triangles;
    }
    stats->need_refs = q_clamp_sat(need, 0, INT32_MAX);
    list(s, BOTH_SIDES);
    glint_bins_sum(&s->bins);
    list(s, 1); /* these hide most of the others */
    list(s, 0);
    glint_bins_close(&s->bins);
    s->has_triangles = stats->refs > 0;
}

/* --------------------------------------------------------------------- tile */

static struct glint_line line_of(const struct glint_corner *a,
                                 const struct glint_corner *b)
{
    return (struct glint_line){(int64_t)a->y * b->w - (int64_t)b->y * a->w,
                               (int64_t)b->x * a->w - (int64_t)a->x * b->w,
                               (int64_t)a->x * b->y - (int64_t)b->x * a->y};
}

/* Makes a line that a sample on it is inside of, or not, as the first of its
 * numbers that is not 0 says; returns 0 if all are. */
static int settle(struct glint_line *l)
{
    const int is_out =
        l->across < 0 ||
        (l->across == 0 && (l->down < 0 || (l->down == 0 && l->at < 0)));

    if (l->across == 0 && l->down == 0 && l->at == 0)
        return 0;
    l->at -= is_out;
    return 1;
}

/* The three lines of a triangle, 0 and more inside; returns 0 if it is seen
 * from its side, or not at all. */
static int lines_of(const struct glint_scene *s, uint32_t object,
                    const struct glint_scene_triangle *t,
                    struct glint_line line[3])
{
    const struct glint_corner *c[3];
    int64_t side;

    for (int k = 0; k < 3; k++)
        c[k] = corner_of(s, object, t->vertex[k]);
    for (int k = 0; k < 3; k++)
        line[k] = line_of(c[(k + 1) % 3], c[(k + 2) % 3]);
    side = line[0].across * c[0]->x + line[0].down * c[0]->y +
           line[0].at * c[0]->w;
    if (side == 0)
        return 0;
    for (int k = 0; k < 3; k++) {
        if (side < 0)
            line[k] = (struct glint_line){-line[k].across, -line[k].down,
                                          -line[k].at};
        if (!settle(&line[k]))
            return 0;
    }
    return 1;
}

static int depth_of(const struct glint_scene *s, uint32_t object,
                    const struct glint_scene_triangle *t,
                    struct glint_depth *depth)
{
    const int32_t *at[3];
    int32_t normal_q30[3];

    for (int k = 0; k < 3; k++)
        at[k] = s->seen[s->placed[object].first_vertex + t->vertex[k]];
    return glint_triangle_normal(at, normal_q30) &&
           glint_view_depth(&s->view, at[0], normal_q30, s->nearest, depth);
}

/* A triangle in the picture. */
struct seen {
    uint32_t id;
    struct glint_line line[3];
    struct glint_depth depth;
    /* What the lines and the depth differ by from a pixel's middle to its
     * samples; of lines less the most that any of the pixel's does. */
    int64_t off[GLINT_SCENE_SAMPLES][3], most[3], deeper[GLINT_SCENE_SAMPLES];
};

static void set_offsets(const struct glint_scene *s, struct seen *seen)
{
    const int n = s->cfg.edge_samples;

    for (int i = 0; i < 3; i++) {
        const struct glint_line *l = &seen->line[i];

        seen->most[i] = INT64_MIN;
        for (int k = 0; k < n; k++) {
            seen->off[k][i] = l->across * glint_sample(s, k, 0) +
                              l->down * glint_sample(s, k, 1);
            if (seen->off[k][i] > seen->most[i])
                seen->most[i] = seen->off[k][i];
        }
        for (int k = 0; k < n; k++)
            seen->off[k][i] -= seen->most[i];
    }
    for (int k = 0; k < n; k++)
        seen->deeper[k] = seen->depth.across * glint_sample(s, k, 0) +
                          seen->depth.down * glint_sample(s, k, 1);
}

/* Draws the samples of a pixel, which begin at I; AT is of the lines there,
 * plus the most. */
static inline void look_at_pixel(const struct glint_scene_worker *w,
                                 const struct seen *seen, int64_t at_0,
                                 int64_t at_1, int64_t at_2, int64_t depth,
                                 int i)
{
    const int n = w->scene->cfg.edge_samples, shift = seen->depth.shift;

    for (int k = 0; k < n; k++, i++) {
        const int64_t *off = seen->off[k];
        int64_t z;

        if (((at_0 + off[0]) | (at_1 + off[1]) | (at_2 + off[2])) < 0)
            continue;
        z = (depth + seen->deeper[k]) >> shift;
        if (z > INT32_MAX)
            z = INT32_MAX;
        if (z < 1)
            z = 1;
        if (z < w->depth[i] || (z == w->depth[i] && seen->id >= w->id[i]))
            continue;
        w->depth[i] = (int32_t)z;
        w->id[i] = seen->id;
    }
}

/* Goes along rows by adding what each line changes by from pixel to pixel. */
static void look_at_box(struct glint_scene_worker *w, const struct seen *seen,
                        struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const struct glint_depth d = seen->depth;
    const struct glint_line *l = seen->line;
    const int n = s->cfg.edge_samples;
    const int32_t x_q8 = glint_place(s, b.x0, 0);

    for (int y = b.y0; y < b.y1; y++) {
        const int32_t y_q8 = glint_place(s, y, 1);
        const int64_t depth = d.across * x_q8 + d.down * y_q8 + d.at;
        int64_t at_0 = glint_line_at(&l[0], x_q8, y_q8) + seen->most[0];
        int64_t at_1 = glint_line_at(&l[1], x_q8, y_q8) + seen->most[1];
        int64_t at_2 = glint_line_at(&l[2], x_q8, y_q8) + seen->most[2];
        int i = glint_sample_index(w, b.x0, y, 0);

        for (int x = 0; x < b.x1 - b.x0; x++, i += n) {
            if ((at_0 | at_1 | at_2) >= 0)
                look_at_pixel(w, seen, at_0, at_1, at_2,
                              depth + 256 * x * d.across, i);
            at_0 += 256 * l[0].across;
            at_1 += 256 * l[1].across;
            at_2 += 256 * l[2].across;
        }
    }
}

/* At length: in 64 bits. */
static NEVER_INLINE void look_at_large(struct glint_scene_worker *w,
                                       uint32_t id,
                                       const struct glint_scene_triangle *t,
                                       const struct glint_line line[3],
                                       struct glint_box b)
{
    struct seen seen;

    seen.id = id;
    for (int k = 0; k < 3; k++)
        seen.line[k] = line[k];
    if (!depth_of(w->scene, id >> 20, t, &seen.depth))
        return;
    set_offsets(w->scene, &seen);
    look_at_box(w, &seen, b);
}

static void look_at_triangle(struct glint_scene_worker *w, uint32_t id)
{
    const struct glint_scene *s = w->scene;
    const uint32_t object = id >> 20;
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(s, glint_mesh_of(s, object), id & 0xfffff);
    int is_small;
    const struct glint_box b =
        glint_box_cut(w->touched, box_of(s, object, t, &is_small));
    struct glint_line line[3];

    if (glint_box_empty(b) || (is_small && glint_mesh_is_hidden(w, id, t, b)) ||
        !lines_of(s, object, t, line))
        return;
    if (!is_small || !glint_mesh_look_small(w, id, t, line, b))
        look_at_large(w, id, t, line, b);
}

const struct glint_scene_meshes glint_scene_meshes = {
    project_meshes,     look_at_triangle, glint_mesh_meet,      glint_mesh_hold,
    glint_mesh_surface, glint_mesh_joins, glint_quick_mesh_find};
