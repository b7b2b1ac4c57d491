/* SPDX-License-Identifier: MIT
 *
 * Rasterises triangles: vertices are transformed to camera coordinates once per
 * frame, and triangles are sorted into tiles. In a tile, a sample is inside a
 * triangle if three exact edge functions are not negative.
 *
 * Nothing is clipped: the coefficients of an edge function are the cross
 * product of two homogeneous corners (view.h). x and y are within 2^22 and w is
 * 1, or all three are within 2^16. So the first two coefficients are below
 * 2^39, and the third is within +-2^40. Samples are within 2^22, so edge
 * functions are below 2^62. A vertex is rounded once, in the same way for all
 * its triangles, so that neighbouring triangles neither leave gaps nor overlap.
 * A sample on an edge is assigned to a side by the direction of the edge, which
 * is opposite in the two triangles that share it. */
#include "scene/mesh.h"

#include "base/compiler.h"
#include "base/divide.h"
#include "base/log2.h"
#include "scene/parts.h"
#include "scene/visible.h"

/* -------------------------------------------------------------------- small */

/* Small on-screen triangles: all samples of a pixel are tested at once, in 32
 * bits, in loops that compilers vectorise. The inside test equals that of large
 * triangles. Depths are interpolated linearly in the picture between the
 * corners' depths. */

/* The edge function of two corners. At position (x, y) its value is ACROSS x +
 * DOWN y + AT: positive on one side of the edge, 0 on the edge. */
struct line {
    int64_t across, down, at;
};

static inline int64_t evaluate_edge_function(const struct line *l, int64_t x,
                                             int64_t y)
{
    return l->across * x + l->down * y + l->at;
}

/* The edge functions and depth of a small triangle, in 32 bits. */
struct small {
    uint32_t id;
    int32_t across[3], down[3]; /* change of the edge functions per pixel */
    /* edge functions at the middle of the box's first pixel, plus their max
     * change from there to a sample */
    int32_t at[3];
    struct glint_depth depth;
    int32_t off[3][GLINT_SCENE_SAMPLES], deeper[GLINT_SCENE_SAMPLES];
};

enum { DEPTH_BITS = 12, MOST_DEEPER = 1 << 28 };

/* Sets DEPTH_Q30 to the depths of the three corners of T; returns 0 if a depth
 * is out of range. */
static inline int compute_corner_depths(const struct glint_scene *s,
                                        uint32_t object,
                                        const struct glint_scene_triangle *t,
                                        int32_t depth_q30[3])
{
    const uint32_t first = s->placed[object].first_vertex;
    int fits = 1;

    for (int k = 0; k < 3; k++) {
        const int32_t z = s->seen[first + t->vertex[k]][2];

        depth_q30[k] = glint_divide_rounded((uint64_t)s->nearest << 30,
                                            (uint64_t)q_larger(1, z));
        fits &= depth_q30[k] < GLINT_FAR;
    }
    return fits;
}

/* Returns whether all samples of box B already see objects nearer than
 * DEPTH_Q30. */
static int are_all_samples_nearer_than(const struct glint_scene_worker *w,
                                       struct glint_box b, int32_t depth_q30)
{
    const int n = w->scene->cfg.edge_samples * (b.x1 - b.x0);

    for (int y = b.y0; y < b.y1; y++) {
        const int32_t *at_q30 =
            w->depth + glint_get_sample_index(w, b.x0, y, 0);
        int32_t min_q30 = at_q30[0];

        for (int i = 1; i < n; i++)
            min_q30 = q_smaller(min_q30, at_q30[i]);
        if (min_q30 <= depth_q30)
            return 0;
    }
    return 1;
}

/* Returns whether objects drawn before hide triangle ID at all samples of box
 * B. The depth of a sample inside lies between the corners' depths, apart from
 * rounding errors, for which the compared depth has a margin. Each of the three
 * edge functions may be 1 too low. If twice the triangle's area is at least 6,
 * this changes the depth by at most half of the corners' range. The rest of the
 * margin is for truncated slopes of depth. As range / area is limited, slopes
 * are at most 2 * 2 * 48 * 256 range / area, below 2^20. So
 * set_triangle_depth_function() would accept the triangle, with these
 * depths. */
static int is_triangle_hidden(const struct glint_scene_worker *w, uint32_t id,
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
    if (area < LEAST_AREA || !compute_corner_depths(s, id >> 20, t, depth_q30))
        return 0;
    most = q_larger(depth_q30[0], q_larger(depth_q30[1], depth_q30[2]));
    range =
        most - q_smaller(depth_q30[0], q_smaller(depth_q30[1], depth_q30[2]));
    return range < MOST_RANGE && range <= 16 * area &&
           are_all_samples_nearer_than(w, b, most + range + SLACK);
}

/* Sets the triangle's depth as a function of position, interpolated between its
 * corners with the edge functions as barycentric weights. Returns 0 if a depth
 * is out of range, a slope needs more than 32 bits, or the area is 0. */
static int set_triangle_depth_function(const struct glint_scene *s,
                                       uint32_t object,
                                       const struct glint_scene_triangle *t,
                                       const struct line line[3],
                                       struct small *small)
{
    const struct glint_corner *c =
        &s->corner[s->placed[object].first_vertex + t->vertex[0]];
    int32_t depth_q30[3];
    int64_t all = 0, across = 0, down = 0;

    if (!compute_corner_depths(s, object, t, depth_q30))
        return 0;
    for (int k = 0; k < 3; k++)
        all += evaluate_edge_function(&line[k], c->x, c->y);
    if (all <= 0)
        return 0;
    for (int k = 1; k < 3; k++) { /* sums are below 2^46 */
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

/* Sets the values that all pixels of a small triangle share: edge functions in
 * the middle (X, Y) of the first pixel, and the differences between samples. */
static inline void prepare_small_triangle(const struct glint_scene *s, int n,
                                          const struct line line[3],
                                          int32_t x_q8, int32_t y_q8,
                                          struct small *small)
{
    for (int i = 0; i < 3; i++) {
        const int32_t across = (int32_t)line[i].across;
        const int32_t down = (int32_t)line[i].down;
        int32_t most = INT32_MIN;

        for (int k = 0; k < n; k++) {
            small->off[i][k] = across * glint_sample_offset_q8(s, k, 0) +
                               down * glint_sample_offset_q8(s, k, 1);
            most = q_larger(most, small->off[i][k]);
        }
        for (int k = 0; k < n; k++)
            small->off[i][k] -= most;
        small->across[i] = 256 * across;
        small->down[i] = 256 * down;
        small->at[i] =
            (int32_t)evaluate_edge_function(&line[i], x_q8, y_q8) + most;
    }
    for (int k = 0; k < n; k++)
        small->deeper[k] =
            (int32_t)((small->depth.across * glint_sample_offset_q8(s, k, 0) +
                       small->depth.down * glint_sample_offset_q8(s, k, 1)) >>
                      DEPTH_BITS);
}

/* Draws the N samples of a pixel. AT and Z are the edge functions (plus the max
 * that was subtracted from small->off) and the depth at the pixel's middle. The
 * loop is written so that compilers vectorise it before they unroll it. */
static inline void draw_pixel_of_small_triangle(const struct small *small,
                                                int n, const int32_t at[3],
                                                int32_t z,
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

static inline void draw_rows_of_small_triangle(struct glint_scene_worker *w,
                                               int n, const struct small *small,
                                               struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const struct glint_depth d = small->depth;
    const int32_t x_q8 = glint_pixel_position_q8(s, b.x0, 0);
    int32_t first[3] = {small->at[0], small->at[1], small->at[2]};

    for (int y = b.y0; y < b.y1; y++) {
        int64_t depth =
            d.across * x_q8 + d.down * glint_pixel_position_q8(s, y, 1) + d.at;
        int32_t at[3] = {first[0], first[1], first[2]};
        int k = glint_get_sample_index(w, b.x0, y, 0);

        for (int x = b.x0; x < b.x1; x++, k += n) {
            if ((at[0] | at[1] | at[2]) >= 0)
                draw_pixel_of_small_triangle(
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

/* Draws triangle T, with id ID, in 32-bit arithmetic. Returns 0, and draws
 * nothing, if depths need more bits. All corners must be in the picture or near
 * it, and the edge functions below 2^30 in box B. */
static int draw_small_triangle(struct glint_scene_worker *w, uint32_t id,
                               const struct glint_scene_triangle *t,
                               const struct line line[3], struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const int n = s->cfg.edge_samples;
    const int32_t x_q8 = glint_pixel_position_q8(s, b.x0, 0);
    const int32_t y_q8 = glint_pixel_position_q8(s, b.y0, 1);
    struct small small;

    small.id = id;
    if (!set_triangle_depth_function(s, id >> 20, t, line, &small))
        return 0;
    if (n == 1) {
        prepare_small_triangle(s, 1, line, x_q8, y_q8, &small);
        draw_rows_of_small_triangle(w, 1, &small, b);
    } else if (n == 4) {
        prepare_small_triangle(s, 4, line, x_q8, y_q8, &small);
        draw_rows_of_small_triangle(w, 4, &small, b);
    } else {
        prepare_small_triangle(s, n, line, x_q8, y_q8, &small);
        draw_rows_of_small_triangle(w, n, &small, b);
    }
    return 1;
}

/* --------------------------------------------------------------------- rays */

/* Traces rays through a mesh's grid of cells, in the mesh's own space.
 *
 * A ray starts where it comes near the mesh, so that differences stay below
 * 2^29. It walks from cell to cell. The face through which it leaves a cell is
 * found without division, by comparing products instead of the ratios dx /
 * |d.x| and dy / |d.y|. The list of a cell includes triangles up to 16 steps
 * outside it, so that none is missed if the ray's start is rounded. */

/* A ray transformed to a mesh's own space. */
struct inside {
    const struct glint_scene *scene;
    const struct glint_scene_mesh *mesh;
    struct glint_scene_ray ray;
    struct glint_sheared sheared;
    /* distance along the original ray, steps, at which this ray begins */
    int32_t start;
    /* index of the triangle on which the ray starts, which is skipped */
    uint32_t but;
};

/* Transforms RAY to the space of OBJECT; the new ray starts at distance T.
 * Returns 0 if this start is out of range. */
static int transform_ray_to_mesh(const struct glint_scene *s, uint32_t object,
                                 const struct glint_scene_ray *ray, int32_t t,
                                 struct inside *in)
{
    const struct glint_placed *p = &s->placed[object];
    int32_t place[3], off[3];

    in->scene = s;
    in->mesh = glint_mesh_of(s, object);
    in->start = t;
    if (!glint_ray_point_at_distance(ray, t, place))
        return 0;
    v3_subtract(place, p->at, off);
    v3_rotate_back(&p->turn, off, in->ray.at);
    v3_rotate_back(&p->turn, ray->toward_q30, in->ray.toward_q30);
    glint_ray_shear_to_axis(&in->ray, &in->sheared);
    return 1;
}

/* --------------------------------------------------------------------- grid */

/* The grid cell in which a ray is, and the ray's distances to the next
 * cells. */
struct walk {
    int32_t cell[3], step[3];
    int64_t away[3];  /* distance along each axis to the face through which the
                         ray leaves the cell, steps */
    int64_t speed[3]; /* magnitude of each component of the ray's direction,
                         q30 */
};

/* Starts the walk at the point where the ray enters the grid, or in the nearest
 * cell if rounding has moved this point out of the grid. Returns 0 if the ray
 * misses the grid. */
static int begin_grid_walk(struct inside *in, struct walk *w)
{
    enum { SLACK = GLINT_SCENE_MARGIN / 2 };
    const struct glint_scene_mesh *m = in->mesh;
    const int32_t *d_q30 = in->ray.toward_q30;
    int32_t t = 0, at[3];

    for (int k = 0; k < 3; k++) {
        const int64_t far =
            m->origin[k] + ((int64_t)m->cells[k] << m->cell_log2);
        const int64_t below = m->origin[k] - (int64_t)in->ray.at[k];
        const int64_t above = in->ray.at[k] - far;
        const int64_t off = below > 0 ? below : above;

        w->speed[k] = (int64_t)q_magnitude(d_q30[k]);
        if (off <= 0)
            continue;
        if (below > 0 ? d_q30[k] <= 0 : d_q30[k] >= 0)
            return 0;
        t = q_larger(t, glint_divide_rounded((uint64_t)off << 30,
                                             (uint64_t)w->speed[k]));
    }
    if (t == GLINT_FAR || !glint_ray_point_at_distance(&in->ray, t, at))
        return 0;
    for (int k = 0; k < 3; k++) {
        const int64_t from = at[k] - (int64_t)m->origin[k];
        const int64_t length = (int64_t)m->cells[k] << m->cell_log2;

        if (from < -SLACK || from > length + SLACK)
            return 0;
        w->cell[k] =
            q_clamp_sat(from >> m->cell_log2, 0, (int32_t)m->cells[k] - 1);
        w->step[k] = d_q30[k] < 0 ? -1 : 1;
        w->away[k] = d_q30[k] < 0
                         ? from - ((int64_t)w->cell[k] << m->cell_log2)
                         : (((int64_t)w->cell[k] + 1) << m->cell_log2) - from;
    }
    in->start += t;
    /* The min distance is negative, so that triangles that lie in the face
     * through which the ray enters the grid are found. */
    in->sheared.least = -q_smaller(t, SLACK);
    for (int k = 0; k < 3; k++)
        in->ray.at[k] = in->sheared.at[k] = at[k];
    return 1;
}

/* Moves to the next cell. Returns 0 at the end of the grid, or if the next cell
 * is more than LIMIT steps from the start of the walk. */
static int advance_to_next_cell(const struct inside *in, struct walk *w,
                                int64_t limit)
{
    const struct glint_scene_mesh *m = in->mesh;
    int next = 0;

    /* starts with the largest component of the direction, which is not 0 */
    for (int k = 1; k < 3; k++)
        next = w->speed[k] > w->speed[next] ? k : next;
    for (int k = 0; k < 3; k++)
        if (w->away[k] * w->speed[next] < w->away[next] * w->speed[k])
            next = k;
    /* This compares away / speed > limit without division. away, speed and
     * limit are below 2^30, and away may be a few steps below 0. */
    if (w->away[next] * (INT64_C(1) << 30) > limit * w->speed[next])
        return 0;
    w->away[next] += INT64_C(1) << m->cell_log2;
    w->cell[next] += w->step[next];
    return w->cell[next] >= 0 && w->cell[next] < (int32_t)m->cells[next];
}

/* Intersects the ray with the triangles of the current cell. Sets MET to the
 * nearest intersection before MET->t; returns 0 if there is none. */
static int intersect_cell_triangles(const struct inside *in,
                                    const struct walk *w, struct glint_met *met)
{
    const struct glint_scene_mesh *m = in->mesh;
    const size_t cell =
        (size_t)((uint32_t)w->cell[2] * m->cells[1] + (uint32_t)w->cell[1]) *
            m->cells[0] +
        (uint32_t)w->cell[0];
    const uint32_t *start = glint_mesh_get_table(in->scene, m->start_at);
    const uint32_t *ref = glint_mesh_get_table(in->scene, m->ref_at);
    int any = 0;

    glint_scene_count_ray_tests(in->scene,
                                1 + (int64_t)start[cell + 1] - start[cell]);
    for (uint32_t i = start[cell]; i < start[cell + 1]; i++) {
        const int32_t *vertex[3];
        struct glint_spot_on spot;

        if (ref[i] == in->but)
            continue;
        glint_mesh_get_vertices(in->scene, m, ref[i], vertex);
        if (!glint_ray_intersect_triangle(&in->sheared, vertex, &spot) ||
            (int64_t)spot.t + in->start >= met->t)
            continue;
        met->t = spot.t + in->start;
        met->triangle = ref[i];
        met->spot = spot;
        any = 1;
    }
    return any;
}

static int intersect_mesh(const struct glint_scene *scene, uint32_t object,
                          uint32_t but_triangle,
                          const struct glint_scene_ray *ray, int any,
                          struct glint_met *met)
{
    const struct glint_placed *p = &scene->placed[object];
    struct glint_chord chord;
    struct inside in = {.but = but_triangle};
    struct walk w;
    int found = 0;

    met->object = object;
    if (!glint_ray_intersect_sphere(ray, p->centre, p->reach, &chord) ||
        chord.t[1] <= 0 || chord.t[0] >= met->t ||
        !transform_ray_to_mesh(scene, object, ray, q_larger(0, chord.t[0]),
                               &in) ||
        !begin_grid_walk(&in, &w))
        return 0;
    do {
        found |= intersect_cell_triangles(&in, &w, met);
    } while (!(found && any) &&
             advance_to_next_cell(&in, &w, (int64_t)met->t - in.start));
    return found;
}

/* Intersects a primary ray with one triangle, using the vertices in camera
 * coordinates that were computed once for the frame. */
static int intersect_triangle(const struct glint_scene *scene, uint32_t object,
                              uint32_t triangle, const int32_t seen_q30[3],
                              struct glint_met *met)
{
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(scene, glint_mesh_of(scene, object), triangle);
    struct glint_scene_ray ray = {.at = {0}};
    struct glint_sheared sheared;
    const int32_t *vertex[3];

    for (int k = 0; k < 3; k++) {
        ray.toward_q30[k] = seen_q30[k];
        vertex[k] =
            scene->seen[scene->placed[object].first_vertex + t->vertex[k]];
    }
    glint_ray_shear_to_axis(&ray, &sheared);
    if (!glint_ray_clamp_to_triangle(&sheared, vertex, &met->spot))
        return 0;
    met->object = object;
    met->triangle = triangle;
    met->t = q_clamp_sat(met->spot.t, 1, GLINT_FAR - 1);
    return 1;
}

/* ----------------------------------------------------------------- surfaces */

/* Sets TO[N] to the mean of the numbers ROW[3][N] of a triangle's vertices,
 * weighted by the barycentric weights in SPOT. */
static void interpolate_vertex_rows(const struct glint_spot_on *spot,
                                    const int32_t *const row[3], int n,
                                    int32_t *to)
{
    for (int k = 0; k < n; k++) {
        int64_t sum = 0;

        for (int i = 0; i < 3; i++)
            sum += (int64_t)spot->part_q30[i] * row[i][k];
        to[k] = q_narrow(q_shift(sum, 30));
    }
}

static void get_vertex_rows(const struct glint_scene *s,
                            const struct glint_scene_triangle *t, uint32_t at,
                            int n, const int32_t *row[3])
{
    for (int k = 0; k < 3; k++)
        row[k] = (const int32_t *)glint_mesh_get_table(s, at) +
                 (size_t)n * t->vertex[k];
}

/* Returns log2 (_q16) of the length of V, or -2^24 if V is 0. */
static int32_t compute_log2_length_q16(const int64_t v[3])
{
    const uint64_t any =
        q_magnitude(v[0]) | q_magnitude(v[1]) | q_magnitude(v[2]);
    const int down = q_larger(0, bit_length(any) - 31);
    uint64_t square = 0;

    for (int k = 0; k < 3; k++)
        square += (uint64_t)((v[k] >> down) * (v[k] >> down));
    return square ? q_log2_q16(square) / 2 + down * 65536 : -(1 << 24);
}

/* Sets the texture coordinates of SURFACE, and log2 of the triangle's area in
 * uv space divided by its area on the surface. */
static void set_texture_coordinates_of_surface(
    const struct glint_scene *s, const struct glint_scene_mesh *m,
    const struct glint_scene_triangle *t, const int32_t *const vertex[3],
    const struct glint_met *met, struct glint_met_surface *surface)
{
    const int32_t *uv_q16[3];
    int32_t first[3] = {0}, second[3] = {0}, uv[2][3] = {{0}};
    int64_t area[3], uv_area[3];

    get_vertex_rows(s, t, m->uv_at, 2, uv_q16);
    interpolate_vertex_rows(&met->spot, uv_q16, 2, surface->uv_q16);
    v3_subtract(vertex[1], vertex[0], first);
    v3_subtract(vertex[2], vertex[0], second);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 2; i++)
            uv[i][k] = uv_q16[i + 1][k] - uv_q16[0][k];
    v3_cross(first, second, area);
    v3_cross(uv[0], uv[1], uv_area);
    surface->uv_log2_q16 = compute_log2_length_q16(uv_area) - (32 << 16) -
                           compute_log2_length_q16(area);
}

static int set_mesh_surface(const struct glint_scene *scene,
                            const struct glint_met *met,
                            struct glint_met_surface *surface)
{
    const struct glint_placed *p = &scene->placed[met->object];
    const struct glint_scene_mesh *m = glint_mesh_of(scene, met->object);
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(scene, m, met->triangle);
    const int32_t *vertex[3], *row[3];
    int32_t place[3], normal_q30[3];

    glint_mesh_get_vertices(scene, m, met->triangle, vertex);
    interpolate_vertex_rows(&met->spot, vertex, 3, place);
    v3_rotate(&p->turn, place, surface->place);
    for (int k = 0; k < 3; k++)
        surface->place[k] += p->at[k];
    if (!glint_set_triangle_normal(vertex, normal_q30))
        return 0;
    v3_rotate(&p->turn, normal_q30, surface->face_q30);
    if (m->normal_at) {
        int64_t sum[3];

        get_vertex_rows(scene, t, m->normal_at, 3, row);
        interpolate_vertex_rows(&met->spot, row, 3, normal_q30);
        for (int k = 0; k < 3; k++)
            sum[k] = normal_q30[k];
        if (!glint_normalise_vector(sum, normal_q30))
            return 0;
    }
    v3_rotate(&p->turn, normal_q30, surface->normal_q30);
    if (t->material != GLINT_SCENE_NONE)
        surface->material = &scene->model.material[t->material];
    if (m->uv_at &&
        (surface->material->texture != GLINT_SCENE_NONE || p->skin >= 0))
        set_texture_coordinates_of_surface(scene, m, t, vertex, met, surface);
    return 1;
}

static int can_triangles_share_shading(const struct glint_scene *scene,
                                       uint32_t a, uint32_t b)
{
    const struct glint_scene_mesh *m = glint_mesh_of(scene, a >> 20);
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(scene, m, a & 0xfffff);
    const struct glint_scene_triangle *u =
        glint_mesh_triangle(scene, m, b & 0xfffff);
    int shared = 0;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            shared |= t->vertex[i] == u->vertex[k];
    return shared && m->normal_at && t->material == u->material;
}

/* ------------------------------------------------------------------ corners */

static const struct glint_corner *
get_projected_vertex(const struct glint_scene *s, uint32_t object,
                     uint32_t vertex)
{
    return &s->corner[s->placed[object].first_vertex + vertex];
}

static void transform_vertices(struct glint_scene *s, uint32_t object)
{
    const struct glint_placed *p = &s->placed[object];
    const struct glint_scene_mesh *m = glint_mesh_of(s, object);
    const int32_t *vertex = glint_mesh_get_table(s, m->vertex_at);

    for (uint32_t i = 0; i < m->n_vertices; i++) {
        int32_t *to = s->seen[p->first_vertex + i], place[3];

        v3_rotate(&p->turn, vertex + 3 * (size_t)i, place);
        for (int k = 0; k < 3; k++)
            place[k] += p->at[k];
        glint_view_convert_to_camera(&s->view, place, to);
        s->corner[p->first_vertex + i] =
            glint_view_project_vertex(&s->view, to);
    }
}

/* Returns the max distance on one axis of a sample from the middle of its
 * pixel, 1/256 pixel. */
static int32_t compute_max_sample_offset_q8(const struct glint_scene *s)
{
    return s->cfg.edge_samples > 4 ? 120 : 96;
}

/* Returns the first pixel, 0 .. SIDE, that may have a sample at X_Q8 or to the
 * right of it. OFF_Q8 is the max offset of samples. */
static int find_first_pixel_right_of(int32_t x_q8, int side, int32_t off_q8)
{
    return (x_q8 + 128 * (side - 1) - off_q8 + 255) >> 8;
}

/* Returns 1 + the last pixel that may have a sample at X_Q8 or to the left of
 * it. */
static int find_end_pixel_left_of(int32_t x_q8, int side, int32_t off_q8)
{
    return ((x_q8 + 128 * (side - 1) + off_q8) >> 8) + 1;
}

/* max width and height of small triangles, 1/256 pixel; within 256 pixels of
 * such a triangle its edge functions, and the sum of any two, are below 2^30 */
enum { SMALL_Q8 = 48 << 8 };

/* Returns the box of pixels that a triangle may cover: the whole picture if a
 * corner is behind the camera or far off-screen, an empty box if all are behind
 * it. Sets *IS_SMALL to whether the triangle is small (SMALL_Q8). */
static struct glint_box
compute_triangle_box(const struct glint_scene *s, uint32_t object,
                     const struct glint_scene_triangle *t, int *is_small)
{
    const struct glint_box all = {0, 0, s->view.width, s->view.height};
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};
    const int32_t off_q8 = compute_max_sample_offset_q8(s);
    int n_near = 0, n_behind = 0;

    for (int k = 0; k < 3; k++) {
        const struct glint_corner *c =
            get_projected_vertex(s, object, t->vertex[k]);

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
    return glint_box_intersect(
        all,
        (struct glint_box){find_first_pixel_right_of(lo[0], all.x1, off_q8),
                           find_first_pixel_right_of(lo[1], all.y1, off_q8),
                           find_end_pixel_left_of(hi[0], all.x1, off_q8),
                           find_end_pixel_left_of(hi[1], all.y1, off_q8)});
}

/* -------------------------------------------------------------------- lists */

static int64_t count_tile_list_entries_of_object(struct glint_scene *s,
                                                 uint32_t object)
{
    const struct glint_scene_mesh *m = glint_mesh_of(s, object);
    int64_t n = 0;
    int is_small;

    for (uint32_t i = 0; i < m->n_triangles; i++)
        n += glint_bins_count_overlapped_tiles(
            &s->bins, compute_triangle_box(
                          s, object, glint_mesh_triangle(s, m, i), &is_small));
    return n;
}

static int is_triangle_facing_camera(const struct glint_scene *s,
                                     uint32_t object,
                                     const struct glint_scene_triangle *t)
{
    const struct glint_corner *a =
        get_projected_vertex(s, object, t->vertex[0]);
    const struct glint_corner *b =
        get_projected_vertex(s, object, t->vertex[1]);
    const struct glint_corner *c =
        get_projected_vertex(s, object, t->vertex[2]);

    return a->w != 1 || b->w != 1 || c->w != 1 ||
           (int64_t)(b->x - a->x) * (c->y - a->y) >
               (int64_t)(b->y - a->y) * (c->x - a->x);
}

enum { BOTH_SIDES = -1 };

/* If FACING is BOTH_SIDES, counts for each tile's list (bin) the triangles of
 * all meshes. Otherwise appends to the lists the triangles that face the camera
 * (FACING 1) or face away from it (0). */
static void sort_triangles_into_tile_lists(struct glint_scene *s, int facing)
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

            if (facing != BOTH_SIDES &&
                facing != is_triangle_facing_camera(s, k, t))
                continue;
            b = compute_triangle_box(s, k, t, &is_small);
            if (glint_box_is_empty(b))
                continue;
            if (facing != BOTH_SIDES)
                glint_bins_put_item(&s->bins, b,
                                    (int32_t)glint_make_triangle_id(k, i));
            else
                glint_bins_count_box(&s->bins, b);
        }
    }
}

static void project_meshes(struct glint_scene *s,
                           struct glint_scene_stats *stats)
{
    int64_t need = 0;

    glint_bins_clear_counts(&s->bins);
    for (uint32_t k = 0; k < s->model.header->n_objects; k++) {
        struct glint_placed *p = &s->placed[k];
        int64_t span;

        if (p->object->kind != GLINT_OBJECT_MESH || !p->is_seen)
            continue;
        transform_vertices(s, k);
        span = count_tile_list_entries_of_object(s, k);
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
    sort_triangles_into_tile_lists(s, BOTH_SIDES);
    glint_bins_convert_counts_to_starts(&s->bins);
    /* Triangles that face the camera are first in the lists, as they hide most
     * of the others. */
    sort_triangles_into_tile_lists(s, 1);
    sort_triangles_into_tile_lists(s, 0);
    glint_bins_reset_starts(&s->bins);
    s->has_triangles = stats->refs > 0;
}

/* --------------------------------------------------------------------- tile */

static struct line
compute_edge_function_of_corners(const struct glint_corner *a,
                                 const struct glint_corner *b)
{
    return (struct line){(int64_t)a->y * b->w - (int64_t)b->y * a->w,
                         (int64_t)b->x * a->w - (int64_t)a->x * b->w,
                         (int64_t)a->x * b->y - (int64_t)b->x * a->y};
}

/* Assigns samples exactly on an edge to one of its sides, by the sign of the
 * edge function's first nonzero coefficient. Returns 0 if all coefficients are
 * 0. */
static int break_ties_on_edge(struct line *l)
{
    const int is_out =
        l->across < 0 ||
        (l->across == 0 && (l->down < 0 || (l->down == 0 && l->at < 0)));

    if (l->across == 0 && l->down == 0 && l->at == 0)
        return 0;
    l->at -= is_out;
    return 1;
}

/* Sets the three edge functions of a triangle, which are not negative inside.
 * Returns 0 if the triangle has no area in the picture. */
static int
compute_edge_functions_of_triangle(const struct glint_scene *s, uint32_t object,
                                   const struct glint_scene_triangle *t,
                                   struct line line[3])
{
    const struct glint_corner *c[3];
    int64_t side;

    for (int k = 0; k < 3; k++)
        c[k] = get_projected_vertex(s, object, t->vertex[k]);
    for (int k = 0; k < 3; k++)
        line[k] =
            compute_edge_function_of_corners(c[(k + 1) % 3], c[(k + 2) % 3]);
    side = line[0].across * c[0]->x + line[0].down * c[0]->y +
           line[0].at * c[0]->w;
    if (side == 0)
        return 0;
    for (int k = 0; k < 3; k++) {
        if (side < 0)
            line[k] =
                (struct line){-line[k].across, -line[k].down, -line[k].at};
        if (!break_ties_on_edge(&line[k]))
            return 0;
    }
    return 1;
}

static int compute_depth_function(const struct glint_scene *s, uint32_t object,
                                  const struct glint_scene_triangle *t,
                                  struct glint_depth *depth)
{
    const int32_t *at[3];
    int32_t normal_q30[3];

    for (int k = 0; k < 3; k++)
        at[k] = s->seen[s->placed[object].first_vertex + t->vertex[k]];
    return glint_set_triangle_normal(at, normal_q30) &&
           glint_view_set_plane_depth(&s->view, at[0], normal_q30, s->nearest,
                                      depth);
}

/* A projected triangle of any size: edge functions and depth, in 64 bits. */
struct seen {
    uint32_t id;
    struct line line[3];
    struct glint_depth depth;
    /* Changes of the edge functions (off) and the depth (deeper) from a pixel's
     * middle to its samples. The max over the samples is stored in most and
     * subtracted from off. */
    int64_t off[GLINT_SCENE_SAMPLES][3], most[3], deeper[GLINT_SCENE_SAMPLES];
};

static void set_function_offsets_of_samples(const struct glint_scene *s,
                                            struct seen *seen)
{
    const int n = s->cfg.edge_samples;

    for (int i = 0; i < 3; i++) {
        const struct line *l = &seen->line[i];

        seen->most[i] = INT64_MIN;
        for (int k = 0; k < n; k++) {
            seen->off[k][i] = l->across * glint_sample_offset_q8(s, k, 0) +
                              l->down * glint_sample_offset_q8(s, k, 1);
            if (seen->off[k][i] > seen->most[i])
                seen->most[i] = seen->off[k][i];
        }
        for (int k = 0; k < n; k++)
            seen->off[k][i] -= seen->most[i];
    }
    for (int k = 0; k < n; k++)
        seen->deeper[k] = seen->depth.across * glint_sample_offset_q8(s, k, 0) +
                          seen->depth.down * glint_sample_offset_q8(s, k, 1);
}

/* Draws the samples of a pixel; I is the index of its first sample. AT_0 to
 * AT_2 are the edge functions at the pixel's middle, plus seen->most. */
static inline void
draw_pixel_of_large_triangle(const struct glint_scene_worker *w,
                             const struct seen *seen, int64_t at_0,
                             int64_t at_1, int64_t at_2, int64_t depth, int i)
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

/* Draws the triangle in box B row by row, adding constant differences to the
 * edge functions from pixel to pixel. */
static void draw_rows_of_large_triangle(struct glint_scene_worker *w,
                                        const struct seen *seen,
                                        struct glint_box b)
{
    const struct glint_scene *s = w->scene;
    const struct glint_depth d = seen->depth;
    const struct line *l = seen->line;
    const int n = s->cfg.edge_samples;
    const int32_t x_q8 = glint_pixel_position_q8(s, b.x0, 0);

    for (int y = b.y0; y < b.y1; y++) {
        const int32_t y_q8 = glint_pixel_position_q8(s, y, 1);
        const int64_t depth = d.across * x_q8 + d.down * y_q8 + d.at;
        int64_t at_0 =
            evaluate_edge_function(&l[0], x_q8, y_q8) + seen->most[0];
        int64_t at_1 =
            evaluate_edge_function(&l[1], x_q8, y_q8) + seen->most[1];
        int64_t at_2 =
            evaluate_edge_function(&l[2], x_q8, y_q8) + seen->most[2];
        int i = glint_get_sample_index(w, b.x0, y, 0);

        for (int x = 0; x < b.x1 - b.x0; x++, i += n) {
            if ((at_0 | at_1 | at_2) >= 0)
                draw_pixel_of_large_triangle(w, seen, at_0, at_1, at_2,
                                             depth + 256 * x * d.across, i);
            at_0 += 256 * l[0].across;
            at_1 += 256 * l[1].across;
            at_2 += 256 * l[2].across;
        }
    }
}

/* Draws a triangle of any size, in 64 bits. */
static NEVER_INLINE void
draw_large_triangle(struct glint_scene_worker *w, uint32_t id,
                    const struct glint_scene_triangle *t,
                    const struct line line[3], struct glint_box b)
{
    struct seen seen;

    seen.id = id;
    for (int k = 0; k < 3; k++)
        seen.line[k] = line[k];
    if (!compute_depth_function(w->scene, id >> 20, t, &seen.depth))
        return;
    set_function_offsets_of_samples(w->scene, &seen);
    draw_rows_of_large_triangle(w, &seen, b);
}

static void draw_triangle(struct glint_scene_worker *w, uint32_t id)
{
    const struct glint_scene *s = w->scene;
    const uint32_t object = id >> 20;
    const struct glint_scene_triangle *t =
        glint_mesh_triangle(s, glint_mesh_of(s, object), id & 0xfffff);
    int is_small;
    const struct glint_box b = glint_box_intersect(
        w->touched, compute_triangle_box(s, object, t, &is_small));
    struct line line[3];

    if (glint_box_is_empty(b) ||
        (is_small && is_triangle_hidden(w, id, t, b)) ||
        !compute_edge_functions_of_triangle(s, object, t, line))
        return;
    if (!is_small || !draw_small_triangle(w, id, t, line, b))
        draw_large_triangle(w, id, t, line, b);
}

const struct glint_scene_meshes glint_scene_meshes = {
    project_meshes,
    draw_triangle,
    intersect_mesh,
    intersect_triangle,
    set_mesh_surface,
    can_triangles_share_shading,
    glint_quick_find_mesh_surface};
