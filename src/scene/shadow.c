/* SPDX-License-Identifier: MIT
 *
 * What throws shadows, as a sun sees it [Haines86]: a grid at right angles to
 * its rays, whose cells list all that can stand between the sun and a place in
 * them. A place outside of the grid, or in an empty cell, is lit.
 *
 *   in   where objects are; the directions to the points of a sun's disc
 *   out  whether a place sees such a point
 *
 * Places are u, v across and h along the sun's middle ray, whole steps, within
 * +-2^29: vertices are turned once a frame and rounded alike in all triangles
 * that have them, so that no ray passes between two of these. Rays to other
 * points of the disc lean by less than a cell's margin: footprints are as much
 * larger as they lean between the top of a thing and the lowest place that the
 * grid answers for. */
#include "base/compiler.h"
#include "base/divide.h"
#include "scene/shadow_grid.h"
#include "scene/mesh.h"

/* in place of a cell: nothing is above; the grid does not answer */
enum { NONE = -1, BEYOND = -2 };

/* -------------------------------------------------------------------- rays */

/* Returns whether three numbers are all above 0, or all below. */
static int is_aside(const int32_t x[3])
{
    return (x[0] & x[1] & x[2]) < 0 || (-x[0] & -x[1] & -x[2]) < 0;
}

/* Returns whether a ray from AT that leans by LEAN meets a triangle above it,
 * by edge functions. A triangle is at most 2^28 long, and AT, in a cell of its
 * own, as near: with what the ray leans elements are below 2^30. */
static int meets_triangle(const int32_t *const vertex[3], const int32_t at[3],
                          const int32_t lean_q30[2])
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
    if (is_aside(x) || is_aside(y))
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
    glint_weigh(edge, sum, part_q30);
    return q_shift(v3_dot(part_q30, up), 30) > 0;
}

static int meets_ball(const struct glint_shadow *shadow,
                      const struct glint_placed *p, const int32_t at[3],
                      const struct glint_shadow_point *point,
                      const int32_t place[3])
{
    struct glint_scene_ray ray;
    struct glint_chord chord;

    if (shadow->lean_q30 == 0) {
        int32_t centre[3] = {0, 0, 0};
        int64_t x, y, up, rest;

        v3_turn(&shadow->turn, p->at, centre);
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
    return glint_ray_sphere(&ray, p->at, p->radius, &chord) && chord.t[1] > 0;
}

/* A place as the sun sees it: CELL, and where that is in 256ths of cells. */
struct below {
    int32_t at[3];
    int cell;
    int32_t across_q8[2];
};

/* Returns whether anything in the list but SURFACE itself is on the ray. */
static int
is_blocked(const struct glint_scene *s, const struct glint_shadow *shadow,
           const struct below *below, const struct glint_shadow_point *point,
           const int32_t place[3], const struct glint_met_surface *surface)
{
    const uint32_t own = glint_id(surface->object, surface->triangle);
    const int32_t *ref = shadow->bins.ref + shadow->bins.start[below->cell];
    const int32_t *end = shadow->bins.ref + shadow->bins.start[below->cell + 1];
    const int32_t u = below->across_q8[0], v = below->across_q8[1];
    const int32_t height = below->at[2];
    const int is_sorted = end - ref <= GLINT_SHADOW_SORTED;

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
            if (meets_ball(shadow, p, below->at, point, place))
                return 1;
            continue;
        }
        t = glint_mesh_triangle(s, glint_mesh_of(s, thing->id >> 20),
                                thing->id & 0xfffff);
        for (int k = 0; k < 3; k++)
            vertex[k] = shadow->vertex[p->first_vertex + t->vertex[k]];
        if (meets_triangle(vertex, below->at, point->lean_q30))
            return 1;
    }
    return 0;
}

/* Finds PLACE below the sun. */
static WHOLLY_INLINE void find(const struct glint_shadow *shadow,
                               const int32_t place[3], struct below *below)
{
    int32_t *at = below->at;
    int64_t lean = 0;

    below->cell = NONE;
    if (shadow->is_empty)
        return;
    v3_turn(&shadow->turn, place, at);
    if (at[2] < shadow->lowest)
        lean = glint_shadow_lean(shadow, (int64_t)shadow->lowest - at[2]) +
               GLINT_SHADOW_SLACK;
    if (at[2] > shadow->hi[2] || at[0] < shadow->lo[0] - lean ||
        at[0] > shadow->hi[0] + lean || at[1] < shadow->lo[1] - lean ||
        at[1] > shadow->hi[1] + lean)
        return;
    below->cell = BEYOND;
    if (lean)
        return;
    for (int k = 0; k < 2; k++)
        below->across_q8[k] = glint_shadow_across_q8(shadow, at[k], k);
    below->cell = (below->across_q8[1] >> 8) * GLINT_SHADOW_CELLS +
                  (below->across_q8[0] >> 8);
    if (shadow->bins.start[below->cell] == shadow->bins.start[below->cell + 1])
        below->cell = NONE;
}

/* Returns whether a sun that is a point reaches SURFACE, where no plane throws
 * shadows and a list of the grid answers. */
static int is_lit(const struct glint_scene *s,
                  const struct glint_shadow *shadow, const struct below *below,
                  const int32_t place[3],
                  const struct glint_met_surface *surface)
{
    const struct glint_shadow_point *p = &shadow->point[0];

    return v3_dot(p->toward_q30, surface->face_q30) > 0 &&
           !is_blocked(s, shadow, below, p, place, surface);
}

/* Returns the share of 1, 4 or 16 points that REACHED of them are. */
static int32_t share(const struct glint_shadow *shadow, int reached)
{
    return reached << (shadow->n_points == 1   ? 15
                       : shadow->n_points == 4 ? 13
                                               : 11);
}

/* The share of a disc's points that are above SURFACE, where nothing else comes
 * before them. */
static int32_t share_above(const struct glint_shadow *shadow,
                           const struct glint_met_surface *surface)
{
    int above = 0;

    for (int i = 0; i < shadow->n_points; i++)
        above += v3_dot(shadow->point[i].toward_q30, surface->face_q30) > 0;
    return share(shadow, above);
}

/* The share of a disc's points, each by itself. */
static NEVER_INLINE int32_t
share_of_points(const struct glint_scene *s, const struct glint_shadow *shadow,
                const struct glint_met_surface *surface,
                const struct below *below, const int32_t place[3])
{
    const int asks_planes = glint_scene_other_planes(s, surface->object);
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
            reached += !glint_scene_blocks(s, &ray, surface->object,
                                           surface->triangle, GLINT_FAR);
            continue;
        }
        reached += !(asks_planes &&
                     glint_scene_planes_block(s, &ray, surface->object)) &&
                   (below->cell == NONE ||
                    !is_blocked(s, shadow, below, p, place, surface));
    }
    return share(shadow, reached);
}

int32_t glint_shadow_reaches(const struct glint_scene *s,
                             const struct glint_shadow *shadow,
                             const struct glint_met_surface *surface,
                             const int32_t place[3])
{
    struct below below;

    if (s->placed[surface->object].open_to >> shadow->light & 1)
        below.cell = NONE;
    else
        find(shadow, place, &below);
    if (below.cell == BEYOND || glint_scene_other_planes(s, surface->object))
        return share_of_points(s, shadow, surface, &below, place);
    if (below.cell == NONE)
        return share_above(shadow, surface);
    if (shadow->n_points == 1)
        return is_lit(s, shadow, &below, place, surface) << 15;
    return share_of_points(s, shadow, surface, &below, place);
}

void glint_scene_forget_shadows(struct glint_scene *s)
{
    s->moved++;
    for (uint32_t i = 0; i < s->model.header->n_lights; i++)
        if (s->lit[i].shadow)
            s->lit[i].shadow->is_ready = 0;
}
