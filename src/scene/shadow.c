/* SPDX-License-Identifier: MIT
 *
 * Shadow grid of a sun [Haines86]: a grid of cells perpendicular to its rays. A
 * cell lists all balls and triangles that may lie between the sun and a point
 * in the cell; planes are tested separately. A point outside the grid, or in an
 * empty cell, is lit.
 *
 *   in positions of objects; the directions to the points of a sun's disc
 *   out whether a point of the scene sees a point of the disc
 *
 * Grid coordinates are integer steps within +-2^29: u and v across the ray from
 * the middle of the sun's disc, h along this ray. Vertices are rotated once per
 * frame and rounded in the same way in all their triangles, so that no ray
 * passes between two triangles that share an edge. Rays to other points of the
 * disc are slanted. So the footprint of an object in the grid is enlarged by
 * the max offset of such rays, over the height from the lowest point for which
 * the grid is valid to the object's top. */
#include "base/compiler.h"
#include "base/divide.h"
#include "scene/mesh.h"
#include "scene/state.h"

enum {
    CELLS = 1 << GLINT_SHADOW_CELLS_LOG2,
    SLACK = 4,  /* tolerance for rounding errors, steps */
    SORTED = 64 /* max length of a cell's list that is sorted by height */
};

/* Returns the max offset, across the grid, that rays to any point of the sun's
 * disc reach over a height of HEIGHT steps. HEIGHT must be below 2^32. */
static inline int64_t compute_max_ray_offset(const struct glint_shadow *shadow,
                                             int64_t height)
{
    return q_shift(height * shadow->lean_q30, 30);
}

/* Returns grid coordinate X along AXIS in 1/256 of a cell, within +-2^15. X
 * must be within +-2^33. A cell is at least SLACK steps wide. */
static inline int32_t
convert_steps_to_cells_q8(const struct glint_shadow *shadow, int64_t x,
                          int axis)
{
    return q_clamp_sat((x - shadow->lo[axis]) * shadow->cells_q32[axis] >> 24,
                       INT16_MIN, INT16_MAX);
}

/* --------------------------------------------------------------------- grid */

static int does_object_cast_shadow(const struct glint_placed *p)
{
    return p->is_shown && p->object->kind != GLINT_OBJECT_PLANE;
}

/* ------------------------------------------------------------------ extents */

static void extend_grid_bounds_to_sphere(struct glint_shadow *shadow,
                                         const int32_t at[3], int32_t reach)
{
    for (int k = 0; k < 3; k++) {
        shadow->lo[k] = q_smaller(shadow->lo[k], at[k] - reach);
        shadow->hi[k] = q_larger(shadow->hi[k], at[k] + reach);
    }
}

/* Sets the grid's bounding box to the box around all balls and meshes that cast
 * shadows; returns 0 if there are none. */
static int find_caster_bounds(const struct glint_scene *s,
                              struct glint_shadow *shadow)
{
    for (int k = 0; k < 3; k++) {
        shadow->lo[k] = INT32_MAX;
        shadow->hi[k] = INT32_MIN;
    }
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];
        int32_t at[3];

        if (!does_object_cast_shadow(p))
            continue;
        v3_rotate(&shadow->turn, p->centre, at);
        extend_grid_bounds_to_sphere(shadow, at, p->reach + SLACK);
    }
    return shadow->lo[0] <= shadow->hi[0];
}

/* Enlarges the grid for slanted rays. The grid becomes valid for points down to
 * SIDE steps below the objects; SIDE is the longer side of their bounding box
 * across the rays. */
static void enlarge_grid_for_slant(struct glint_shadow *shadow)
{
    const int32_t side =
        q_larger(shadow->hi[0] - shadow->lo[0], shadow->hi[1] - shadow->lo[1]);
    int64_t lean;

    shadow->lowest = -GLINT_FAR;
    if (shadow->lean_q30 == 0)
        return;
    shadow->lowest = q_larger(shadow->lo[2] - side, -GLINT_FAR);
    lean = compute_max_ray_offset(shadow,
                                  (int64_t)shadow->hi[2] - shadow->lowest) +
           SLACK;
    for (int k = 0; k < 2; k++) {
        shadow->lo[k] =
            q_clamp_sat(shadow->lo[k] - lean, -GLINT_FAR, GLINT_FAR);
        shadow->hi[k] =
            q_clamp_sat(shadow->hi[k] + lean, -GLINT_FAR, GLINT_FAR);
    }
}

/* ------------------------------------------------------------------- lists */

/* Returns the range of grid cells that footprint T covers. */
static struct glint_box find_footprint_cells(const struct glint_shadow_thing *t)
{
    return glint_box_intersect((struct glint_box){0, 0, CELLS, CELLS},
                               (struct glint_box){t->lo[0] >> 8, t->lo[1] >> 8,
                                                  (t->hi[0] >> 8) + 1,
                                                  (t->hi[1] >> 8) + 1});
}

/* Sets T to the footprint of an object with bounds LO .. HI: the region of the
 * grid in which the object can cast shadows. */
static void set_caster_footprint(const struct glint_shadow *shadow,
                                 const int32_t lo[3], const int32_t hi[3],
                                 uint32_t id, struct glint_shadow_thing *t)
{
    const int64_t lean =
        SLACK +
        (shadow->lean_q30
             ? compute_max_ray_offset(shadow, (int64_t)hi[2] - shadow->lowest)
             : 0);

    t->id = id;
    t->top = hi[2];
    for (int k = 0; k < 2; k++) {
        t->lo[k] = (int16_t)convert_steps_to_cells_q8(shadow, lo[k] - lean, k);
        t->hi[k] = (int16_t)convert_steps_to_cells_q8(shadow, hi[k] + lean, k);
    }
}

/* Appends the triangles of mesh I to the shadow casters THING; returns their
 * number. */
static int list_triangle_casters(const struct glint_scene *s,
                                 const struct glint_shadow *shadow, uint32_t i,
                                 struct glint_shadow_thing *thing)
{
    const struct glint_scene_mesh *mesh = glint_mesh_of(s, i);
    const struct glint_scene_triangle *t = glint_mesh_triangle(s, mesh, 0);
    int32_t(*const at)[3] = shadow->vertex + s->placed[i].first_vertex;

    for (uint32_t n = 0; n < mesh->n_triangles; n++, t++) {
        int32_t lo[3], hi[3];

        for (int k = 0; k < 3; k++) {
            const int32_t a = at[t->vertex[0]][k], b = at[t->vertex[1]][k];
            const int32_t c = at[t->vertex[2]][k];

            lo[k] = q_smaller(a, q_smaller(b, c));
            hi[k] = q_larger(a, q_larger(b, c));
        }
        set_caster_footprint(shadow, lo, hi, glint_make_triangle_id(i, n),
                             thing++);
    }
    return (int)mesh->n_triangles;
}

/* Lists all balls and triangles that cast shadows. Returns the total number of
 * entries in the lists of all cells. */
static int64_t list_shadow_casters(const struct glint_scene *s,
                                   struct glint_shadow *shadow)
{
    int64_t n = 0;

    shadow->n_things = 0;
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];
        struct glint_shadow_thing *t = &shadow->thing[shadow->n_things];
        int32_t at[3], lo[3], hi[3];

        if (!does_object_cast_shadow(p))
            continue;
        if (p->object->kind == GLINT_OBJECT_MESH) {
            shadow->n_things += list_triangle_casters(s, shadow, i, t);
            continue;
        }
        v3_rotate(&shadow->turn, p->at, at);
        for (int k = 0; k < 3; k++) {
            lo[k] = at[k] - p->radius;
            hi[k] = at[k] + p->radius;
        }
        set_caster_footprint(shadow, lo, hi, glint_make_triangle_id(i, 0), t);
        shadow->n_things++;
    }
    for (int i = 0; i < shadow->n_things; i++) {
        const struct glint_box b = find_footprint_cells(&shadow->thing[i]);

        if (!glint_box_is_empty(b))
            n += (int64_t)(b.x1 - b.x0) * (b.y1 - b.y0);
    }
    return n;
}

static void list_casters_by_cell(struct glint_shadow *shadow)
{
    glint_bins_clear_counts(&shadow->bins);
    for (int i = 0; i < shadow->n_things; i++) {
        const struct glint_box b = find_footprint_cells(&shadow->thing[i]);

        if (!glint_box_is_empty(b))
            glint_bins_count_box(&shadow->bins, b);
    }
    glint_bins_convert_counts_to_starts(&shadow->bins);
    for (int i = 0; i < shadow->n_things; i++) {
        const struct glint_box b = find_footprint_cells(&shadow->thing[i]);

        for (int y = b.y0; y < b.y1; y++)
            for (int x = b.x0; x < b.x1; x++)
                shadow->bins.ref[shadow->bins.start[y * CELLS + x]++] = i;
    }
    glint_bins_reset_starts(&shadow->bins);
}

/* Sorts the list of each cell by height, the highest object first, except lists
 * longer than SORTED. */
static void sort_lists_by_height(struct glint_shadow *shadow)
{
    for (int i = 0; i < CELLS * CELLS; i++) {
        int32_t *ref = shadow->bins.ref + shadow->bins.start[i];
        const int n = shadow->bins.start[i + 1] - shadow->bins.start[i];

        for (int k = 1; k < n && n <= SORTED; k++) {
            const int32_t own = ref[k], top = shadow->thing[own].top;
            int to = k;

            for (; to > 0 && shadow->thing[ref[to - 1]].top < top; to--)
                ref[to] = ref[to - 1];
            ref[to] = own;
        }
    }
}

/* Returns whether CELL lists an object that reaches above height LOWEST and can
 * shadow points within LO .. HI. Object OWN is ignored. */
static int can_objects_in_cell_shadow_box(const struct glint_shadow *shadow,
                                          int cell, uint32_t own,
                                          int32_t lowest,
                                          const int32_t lo_q8[2],
                                          const int32_t hi_q8[2])
{
    for (int i = shadow->bins.start[cell]; i < shadow->bins.start[cell + 1];
         i++) {
        const struct glint_shadow_thing *t =
            &shadow->thing[shadow->bins.ref[i]];

        if (t->id != own && t->top > lowest && t->lo[0] <= hi_q8[0] &&
            t->hi[0] >= lo_q8[0] && t->lo[1] <= hi_q8[1] &&
            t->hi[1] >= lo_q8[1])
            return 1;
    }
    return 0;
}

/* Returns whether no other ball and no mesh can shadow ball I; 0 if the ball
 * extends out of the grid. Points on the ball are accurate to 2^-20 of its
 * radius (quick.c). */
static int is_ball_unshadowed(const struct glint_scene *s,
                              const struct glint_shadow *shadow, uint32_t i)
{
    const struct glint_placed *p = &s->placed[i];
    const int32_t reach = p->radius + (p->radius >> 20) + SLACK;
    int32_t at[3], lo_q8[2], hi_q8[2];

    v3_rotate(&shadow->turn, p->at, at);
    for (int k = 0; k < 2; k++) {
        lo_q8[k] = convert_steps_to_cells_q8(shadow, (int64_t)at[k] - reach, k);
        hi_q8[k] = convert_steps_to_cells_q8(shadow, (int64_t)at[k] + reach, k);
        if (lo_q8[k] < 0 || hi_q8[k] >= CELLS << 8)
            return 0;
    }
    for (int y = lo_q8[1] >> 8; y <= hi_q8[1] >> 8; y++)
        for (int x = lo_q8[0] >> 8; x <= hi_q8[0] >> 8; x++)
            if (can_objects_in_cell_shadow_box(shadow, y * CELLS + x,
                                               glint_make_triangle_id(i, 0),
                                               at[2] - reach, lo_q8, hi_q8))
                return 0;
    return 1;
}

/* Sets the bit of this sun in open_to of each ball that no ball or mesh can
 * shadow. */
static void mark_unshadowed_balls(const struct glint_scene *s,
                                  const struct glint_shadow *shadow)
{
    const uint32_t bit = UINT32_C(1) << shadow->light;

    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        struct glint_placed *p = &s->placed[i];

        p->open_to &= ~bit;
        if (p->is_shown && p->object->kind == GLINT_OBJECT_SPHERE &&
            is_ball_unshadowed(s, shadow, i))
            p->open_to |= bit;
    }
}

static void rotate_vertices_to_sun(const struct glint_scene *s,
                                   struct glint_shadow *shadow)
{
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];
        const struct glint_scene_mesh *mesh;
        const int32_t *vertex;

        if (!does_object_cast_shadow(p) || p->object->kind != GLINT_OBJECT_MESH)
            continue;
        mesh = glint_mesh_of(s, i);
        vertex = glint_mesh_get_table(s, mesh->vertex_at);
        for (uint32_t k = 0; k < mesh->n_vertices; k++) {
            int32_t place[3];

            v3_rotate(&p->turn, vertex + 3 * (size_t)k, place);
            for (int j = 0; j < 3; j++)
                place[j] += p->at[j];
            v3_rotate(&shadow->turn, place,
                      shadow->vertex[p->first_vertex + k]);
        }
    }
}

/* Sets the directions of the sun's sample points, and the slopes of the rays to
 * these points relative to the grid's axis. */
static void set_sample_points_of_sun(const struct glint_scene *s,
                                     const struct glint_lit *lit,
                                     struct glint_shadow *shadow)
{
    shadow->n_points = lit->light->radius ? s->cfg.shadow_points : 1;
    for (int i = 0; i < shadow->n_points; i++) {
        struct glint_shadow_point *p = &shadow->point[i];
        struct glint_scene_ray to = {.at = {0}};
        int32_t at_q30[3];

        for (int k = 0; k < 3; k++)
            to.toward_q30[k] = lit->toward_q30[k];
        glint_scene_aim_at_light_point(&to, GLINT_FAR, lit->light->radius, i,
                                       shadow->n_points);
        v3_rotate(&shadow->turn, to.toward_q30, at_q30);
        for (int k = 0; k < 3; k++)
            p->toward_q30[k] = to.toward_q30[k];
        for (int k = 0; k < 2; k++)
            p->lean_q30[k] = (int32_t)q_divide(at_q30[k] * (INT64_C(1) << 30),
                                               q_larger(at_q30[2], 1 << 28));
        shadow->lean_q30 = q_larger(
            shadow->lean_q30,
            q_larger(p->lean_q30[0] < 0 ? -p->lean_q30[0] : p->lean_q30[0],
                     p->lean_q30[1] < 0 ? -p->lean_q30[1] : p->lean_q30[1]));
    }
}

void glint_shadow_build_grid(const struct glint_scene *s,
                             const struct glint_lit *lit,
                             struct glint_shadow *shadow)
{
    int32_t *row_q30[3] = {shadow->turn.row_q30[0], shadow->turn.row_q30[1],
                           shadow->turn.row_q30[2]};

    shadow->is_ready = 0;
    shadow->lean_q30 = 0;
    for (int k = 0; k < 3; k++)
        row_q30[2][k] = lit->toward_q30[k];
    glint_scene_find_perpendicular_vectors(row_q30[2], row_q30[0], row_q30[1]);
    set_sample_points_of_sun(s, lit, shadow);
    shadow->is_empty = !find_caster_bounds(s, shadow);
    shadow->is_ready = 1;
    if (shadow->is_empty)
        return;
    enlarge_grid_for_slant(shadow);
    for (int k = 0; k < 2; k++)
        shadow->cells_q32[k] = (int32_t)q_divide(
            INT64_C(1) << (32 + GLINT_SHADOW_CELLS_LOG2),
            (int64_t)shadow->hi[k] - shadow->lo[k] + CELLS * SLACK);
    glint_bins_init(&shadow->bins, (struct glint_box){0, 0, CELLS, CELLS}, 0,
                    shadow->bins.start, shadow->bins.ref);
    rotate_vertices_to_sun(s, shadow);
    while (list_shadow_casters(s, shadow) > shadow->max_refs)
        for (int k = 0; k < 2; k++)
            shadow->cells_q32[k] -= (shadow->cells_q32[k] + 3) / 4;
    list_casters_by_cell(shadow);
    sort_lists_by_height(shadow);
    mark_unshadowed_balls(s, shadow);
}

/* -------------------------------------------------------------------- boxes */

/* Sets PLACE to the point of plane P at grid coordinates (U, V); returns 0 if
 * it is out of range. */
static int find_point_on_plane(const struct glint_shadow *shadow,
                               const struct glint_placed *p, int32_t u,
                               int32_t v, int32_t place[3])
{
    int32_t at[3], n_q30[3], to[3] = {u, v, 0};
    int64_t off_q30, h;

    v3_rotate(&shadow->turn, p->at, at);
    v3_rotate(&shadow->turn, p->centre, n_q30);
    if (q_magnitude(n_q30[2]) < 1 << 20)
        return 0;
    off_q30 = ((int64_t)u - at[0]) * n_q30[0] + ((int64_t)v - at[1]) * n_q30[1];
    h = at[2] - q_divide(off_q30, n_q30[2]);
    if (h < shadow->lowest || h <= -(1 << 29) || h >= 1 << 29 ||
        q_magnitude(u) >= 1 << 29 || q_magnitude(v) >= 1 << 29)
        return 0;
    to[2] = (int32_t)h;
    v3_rotate_back(&shadow->turn, to, place);
    return 1;
}

struct glint_box glint_shadow_find_plane_box(const struct glint_scene *s,
                                             const struct glint_shadow *shadow,
                                             const struct glint_placed *p)
{
    int32_t seen[4][3];

    if (shadow->is_empty)
        return (struct glint_box){0, 0, 0, 0};
    for (int k = 0; k < 4; k++) {
        int32_t place[3];

        if (!find_point_on_plane(shadow, p,
                                 k & 1 ? shadow->lo[0] : shadow->hi[0],
                                 k & 2 ? shadow->lo[1] : shadow->hi[1], place))
            return (struct glint_box){0, 0, s->view.width, s->view.height};
        glint_view_convert_to_camera(&s->view, place, seen[k]);
    }
    return glint_view_find_box_of_points(&s->view, (const int32_t(*)[3])seen,
                                         4);
}

/* Sets CELLS to the range of cells along AXIS, not empty, that contains the
 * grid coordinates LO .. HI and one cell on either side. Points of the
 * quadrilateral that are shaded lie outside it by less than 1/32 of its width,
 * a pixel. Returns 0 if the range is out of the grid. */
static int find_cells_between(const struct glint_shadow *shadow, int64_t lo,
                              int64_t hi, int axis, int cells[2])
{
    const int64_t margin = (hi - lo) / 32 + SLACK;

    cells[0] = (convert_steps_to_cells_q8(shadow, lo - margin, axis) >> 8) - 1;
    cells[1] = (convert_steps_to_cells_q8(shadow, hi + margin, axis) >> 8) + 1;
    cells[0] = q_larger(cells[0], 0);
    cells[1] = q_smaller(cells[1], CELLS - 1);
    return cells[0] <= cells[1];
}

int glint_shadow_can_fall_on(const struct glint_shadow *shadow,
                             const int32_t corner[4][3])
{
    int32_t lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {INT32_MIN, INT32_MIN};
    int across[2], down[2];

    if (shadow->is_empty)
        return 0;
    for (int i = 0; i < 4; i++) {
        int32_t at[3];

        v3_rotate(&shadow->turn, corner[i], at);
        if (at[2] < shadow->lowest + SLACK)
            return 1;
        for (int k = 0; k < 2; k++) {
            lo[k] = q_smaller(lo[k], at[k]);
            hi[k] = q_larger(hi[k], at[k]);
        }
    }
    if (!find_cells_between(shadow, lo[0], hi[0], 0, across) ||
        !find_cells_between(shadow, lo[1], hi[1], 1, down))
        return 0;
    for (int y = down[0]; y <= down[1]; y++)
        if (shadow->bins.start[y * CELLS + across[0]] !=
            shadow->bins.start[y * CELLS + across[1] + 1])
            return 1;
    return 0;
}

/* Special cell indices. NONE: the point lies outside the grid or in a cell that
 * lists no object. BEYOND: it lies below the heights for which the grid is
 * valid. */
enum { NONE = -1, BEYOND = -2 };

/* -------------------------------------------------------------------- rays */

/* Returns whether three numbers are all positive or all negative. */
static int have_same_sign(const int32_t x[3])
{
    return (x[0] & x[1] & x[2]) < 0 || (-x[0] & -x[1] & -x[2]) < 0;
}

/* Returns whether a ray from point AT, of slope LEAN, hits a triangle above the
 * point, by the signs of edge functions. A triangle is at most 2^28 long and
 * lies in the cell of AT. So coordinates relative to AT, even with the ray's
 * offset, are below 2^30. */
static int ray_hits_triangle(const int32_t *const vertex[3],
                             const int32_t at[3], const int32_t lean_q30[2])
{
    int32_t x[3], y[3], up[3], part_q30[3];
    int64_t edge[3], sum = 0;

    for (int i = 0; i < 3; i++) {
        up[i] = vertex[i][2] - at[2];
        x[i] = vertex[i][0] - at[0];
        y[i] = vertex[i][1] - at[1];
        if (lean_q30[0] | lean_q30[1]) {
            x[i] -= (int32_t)q_shift((int64_t)up[i] * lean_q30[0], 30);
            y[i] -= (int32_t)q_shift((int64_t)up[i] * lean_q30[1], 30);
        }
    }
    if (have_same_sign(x) || have_same_sign(y))
        return 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        edge[i] = (int64_t)x[k] * y[j] - (int64_t)y[k] * x[j];
        sum += edge[i];
    }
    if (((edge[0] | edge[1] | edge[2]) < 0 &&
         (edge[0] > 0 || edge[1] > 0 || edge[2] > 0)) ||
        sum == 0)
        return 0;
    if (up[0] > 0 && up[1] > 0 && up[2] > 0)
        return 1;
    glint_compute_vertex_weights(edge, sum, part_q30);
    return q_shift(v3_dot(part_q30, up), 30) > 0;
}

static int ray_hits_ball(const struct glint_shadow *shadow,
                         const struct glint_placed *p, const int32_t at[3],
                         const struct glint_shadow_point *point,
                         const int32_t place[3])
{
    struct glint_scene_ray ray;
    struct glint_chord chord;

    if (shadow->lean_q30 == 0) {
        int32_t centre[3] = {0, 0, 0};
        int64_t x, y, up, rest;

        v3_rotate(&shadow->turn, p->at, centre);
        x = (int64_t)centre[0] - at[0];
        y = (int64_t)centre[1] - at[1];
        up = (int64_t)centre[2] - at[2];
        rest = (int64_t)p->radius * p->radius - x * x - y * y;
        return rest >= 0 && (up > 0 || up * up < rest);
    }
    for (int k = 0; k < 3; k++) {
        ray.at[k] = place[k];
        ray.toward_q30[k] = point->toward_q30[k];
    }
    return glint_ray_intersect_sphere(&ray, p->at, p->radius, &chord) &&
           chord.t[1] > 0;
}

/* A point: its coordinates u, v and h, steps; the index of its cell, NONE or
 * BEYOND; and u and v in 1/256 of a cell, set unless cell is NONE or BEYOND. */
struct below {
    int32_t at[3];
    int cell;
    int32_t across_q8[2];
};

/* Returns whether the ray from BELOW to a point of the sun's disc hits an
 * object in the list of BELOW's cell. Skips the ball or triangle of SURFACE
 * itself. */
static int is_ray_blocked_in_cell(const struct glint_scene *s,
                                  const struct glint_shadow *shadow,
                                  const struct below *below,
                                  const struct glint_shadow_point *point,
                                  const int32_t place[3],
                                  const struct glint_met_surface *surface)
{
    const uint32_t own =
        glint_make_triangle_id(surface->object, surface->triangle);
    const int32_t *ref = shadow->bins.ref + shadow->bins.start[below->cell];
    const int32_t *end = shadow->bins.ref + shadow->bins.start[below->cell + 1];
    const int32_t u = below->across_q8[0], v = below->across_q8[1];
    const int32_t height = below->at[2];
    const int is_sorted = end - ref <= SORTED;

    glint_scene_count_ray_tests(s, end - ref);
    for (; ref < end; ref++) {
        const struct glint_shadow_thing *thing = &shadow->thing[*ref];
        const struct glint_placed *p;
        const struct glint_scene_triangle *t;
        const int32_t *vertex[3];

        if (thing->top <= height) {
            if (is_sorted)
                return 0;
            continue;
        }
        if (u < thing->lo[0] || u > thing->hi[0] || v < thing->lo[1] ||
            v > thing->hi[1] || thing->id == own)
            continue;
        p = &s->placed[thing->id >> 20];
        if (p->object->kind == GLINT_OBJECT_SPHERE) {
            if (ray_hits_ball(shadow, p, below->at, point, place))
                return 1;
            continue;
        }
        t = glint_mesh_triangle(s, glint_mesh_of(s, thing->id >> 20),
                                thing->id & 0xfffff);
        for (int k = 0; k < 3; k++)
            vertex[k] = shadow->vertex[p->first_vertex + t->vertex[k]];
        if (ray_hits_triangle(vertex, below->at, point->lean_q30))
            return 1;
    }
    return 0;
}

static WHOLLY_INLINE void
project_point_to_grid(const struct glint_shadow *shadow, const int32_t place[3],
                      struct below *below)
{
    int32_t *at = below->at;
    int64_t lean = 0;

    below->cell = NONE;
    if (shadow->is_empty)
        return;
    v3_rotate(&shadow->turn, place, at);
    if (at[2] < shadow->lowest)
        lean = compute_max_ray_offset(shadow, (int64_t)shadow->lowest - at[2]) +
               SLACK;
    if (at[2] > shadow->hi[2] || at[0] < shadow->lo[0] - lean ||
        at[0] > shadow->hi[0] + lean || at[1] < shadow->lo[1] - lean ||
        at[1] > shadow->hi[1] + lean)
        return;
    below->cell = BEYOND;
    if (lean)
        return;
    for (int k = 0; k < 2; k++)
        below->across_q8[k] = convert_steps_to_cells_q8(shadow, at[k], k);
    below->cell =
        (below->across_q8[1] >> 8) * CELLS + (below->across_q8[0] >> 8);
    if (shadow->bins.start[below->cell] == shadow->bins.start[below->cell + 1])
        below->cell = NONE;
}

/* Returns whether the light of a sun with a single sample point reaches
 * SURFACE. The caller must have checked that no plane can shadow SURFACE and
 * that the cell of BELOW has a list. */
static int is_lit_by_point_sun(const struct glint_scene *s,
                               const struct glint_shadow *shadow,
                               const struct below *below,
                               const int32_t place[3],
                               const struct glint_met_surface *surface)
{
    const struct glint_shadow_point *p = &shadow->point[0];

    return v3_dot(p->toward_q30, surface->face_q30) > 0 &&
           !is_ray_blocked_in_cell(s, shadow, below, p, place, surface);
}

/* Returns REACHED, a number of sample points of a sun's disc, as a fraction of
 * all of them, _q15. A sun has 1, 4 or 16 sample points. */
static int32_t compute_fraction_of_sun_points(const struct glint_shadow *shadow,
                                              int reached)
{
    return reached << (shadow->n_points == 1   ? 15
                       : shadow->n_points == 4 ? 13
                                               : 11);
}

/* Returns the fraction, _q15, of the disc's sample points that are above the
 * tangent plane of SURFACE. */
static int32_t
compute_fraction_above_surface(const struct glint_shadow *shadow,
                               const struct glint_met_surface *surface)
{
    int above = 0;

    for (int i = 0; i < shadow->n_points; i++)
        above += v3_dot(shadow->point[i].toward_q30, surface->face_q30) > 0;
    return compute_fraction_of_sun_points(shadow, above);
}

/* Returns the fraction, _q15, of the disc's sample points whose light reaches
 * SURFACE, by tracing a ray to each. */
static NEVER_INLINE int32_t compute_lit_fraction(
    const struct glint_scene *s, const struct glint_shadow *shadow,
    const struct glint_met_surface *surface, const struct below *below,
    const int32_t place[3])
{
    const int asks_planes =
        glint_scene_has_other_shadow_planes(s, surface->object);
    struct glint_scene_ray ray;
    int reached = 0;

    for (int k = 0; k < 3; k++)
        ray.at[k] = place[k];
    for (int i = 0; i < shadow->n_points; i++) {
        const struct glint_shadow_point *p = &shadow->point[i];

        for (int k = 0; k < 3; k++)
            ray.toward_q30[k] = p->toward_q30[k];
        if (v3_dot(p->toward_q30, surface->face_q30) <= 0)
            continue;
        if (below->cell == BEYOND) {
            reached += !glint_scene_is_ray_blocked(
                s, &ray, surface->object, surface->triangle, GLINT_FAR);
            continue;
        }
        reached +=
            !(asks_planes &&
              glint_scene_is_ray_blocked_by_plane(s, &ray, surface->object)) &&
            (below->cell == NONE ||
             !is_ray_blocked_in_cell(s, shadow, below, p, place, surface));
    }
    return compute_fraction_of_sun_points(shadow, reached);
}

int32_t glint_shadow_compute_lit_fraction(
    const struct glint_scene *s, const struct glint_shadow *shadow,
    const struct glint_met_surface *surface, const int32_t place[3])
{
    struct below below;

    if (s->placed[surface->object].open_to >> shadow->light & 1)
        below.cell = NONE;
    else
        project_point_to_grid(shadow, place, &below);
    if (below.cell == BEYOND ||
        glint_scene_has_other_shadow_planes(s, surface->object))
        return compute_lit_fraction(s, shadow, surface, &below, place);
    if (below.cell == NONE)
        return compute_fraction_above_surface(shadow, surface);
    if (shadow->n_points == 1)
        return is_lit_by_point_sun(s, shadow, &below, place, surface) << 15;
    return compute_lit_fraction(s, shadow, surface, &below, place);
}

void glint_scene_invalidate_shadows(struct glint_scene *s)
{
    s->moved++;
    for (uint32_t i = 0; i < s->model.header->n_lights; i++)
        if (s->lit[i].shadow)
            s->lit[i].shadow->is_ready = 0;
}
