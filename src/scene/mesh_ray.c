/* SPDX-License-Identifier: MIT
 *
 * Rays through a mesh's grid, in the mesh's own space.
 *
 * A ray starts where it comes near the mesh, so that what is subtracted stays
 * below 2^29, and goes from cell to cell by comparing products: which side of
 * the cell it leaves first, dx / |d.x| < dy / |d.y|, takes no division. Lists
 * hold triangles 16 steps beyond their cells, so that rounding of the start
 * loses none. */
#include "scene/mesh.h"

#include "base/compiler.h"
#include "base/divide.h"

/* A ray in a mesh's space. */
struct inside {
    const struct glint_scene *scene;
    const struct glint_scene_mesh *mesh;
    struct glint_scene_ray ray;
    struct glint_sheared sheared;
    int32_t start; /* how far along the ray in space it begins */
    uint32_t but;  /* triangle that is not asked */
};

/* Turns RAY into the space of OBJECT; T from where on. */
static int enter(const struct glint_scene *s, uint32_t object,
                 const struct glint_scene_ray *ray, int32_t t,
                 struct inside *in)
{
    const struct glint_placed *p = &s->placed[object];
    int32_t place[3], off[3];

    in->scene = s;
    in->mesh = glint_mesh_of(s, object);
    in->start = t;
    if (!glint_ray_go(ray, t, place))
        return 0;
    v3_minus(place, p->at, off);
    v3_turn_back(&p->turn, off, in->ray.at);
    v3_turn_back(&p->turn, ray->toward_q30, in->ray.toward_q30);
    glint_shear(&in->ray, &in->sheared);
    return 1;
}

/* --------------------------------------------------------------------- grid */

/* Where a ray is in the grid. */
struct walk {
    int32_t cell[3], step[3];
    int64_t away[3];  /* steps to the side of the cell that it leaves by */
    int64_t speed[3]; /* |direction|, q30 */
};

/* Sets up a walk from where the ray enters the grid; returns 0 if it does not.
 * A start that rounding has put beside the grid counts as in the cell next to
 * it. */
static int begin(struct inside *in, struct walk *w)
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
        t = q_larger(t,
                     glint_ratio((uint64_t)off << 30, (uint64_t)w->speed[k]));
    }
    if (t == GLINT_FAR || !glint_ray_go(&in->ray, t, at))
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
    for (int k = 0; k < 3; k++)
        in->ray.at[k] = in->sheared.at[k] = at[k];
    return 1;
}

/* Goes on to the next cell. Returns 0 where the grid ends, or nothing nearer
 * than LIMIT, counted from where the walk began, can follow. */
static int go_on(const struct inside *in, struct walk *w, int64_t limit)
{
    const struct glint_scene_mesh *m = in->mesh;
    int next = 0;

    for (int k = 1; k < 3; k++) /* the fastest is not 0 */
        next = w->speed[k] > w->speed[next] ? k : next;
    for (int k = 0; k < 3; k++)
        if (w->away[k] * w->speed[next] < w->away[next] * w->speed[k])
            next = k;
    /* away / speed > limit; away is below 2^30, and so are the others; it may
     * be a few steps below 0 */
    if (w->away[next] * (INT64_C(1) << 30) > limit * w->speed[next])
        return 0;
    w->away[next] += INT64_C(1) << m->cell_log2;
    w->cell[next] += w->step[next];
    return w->cell[next] >= 0 && w->cell[next] < (int32_t)m->cells[next];
}

/* Asks the triangles of the cell; sets MET to the nearest within MET->t. */
static int ask(const struct inside *in, const struct walk *w,
               struct glint_met *met)
{
    const struct glint_scene_mesh *m = in->mesh;
    const size_t cell =
        (size_t)((uint32_t)w->cell[2] * m->cells[1] + (uint32_t)w->cell[1]) *
            m->cells[0] +
        (uint32_t)w->cell[0];
    const uint32_t *start = glint_mesh_table(in->scene, m->start_at);
    const uint32_t *ref = glint_mesh_table(in->scene, m->ref_at);
    int any = 0;

    for (uint32_t i = start[cell]; i < start[cell + 1]; i++) {
        const int32_t *vertex[3];
        struct glint_spot_on spot;

        if (ref[i] == in->but)
            continue;
        glint_mesh_vertices(in->scene, m, ref[i], vertex);
        if (!glint_ray_triangle(&in->sheared, vertex, &spot) ||
            (int64_t)spot.t + in->start >= met->t)
            continue;
        met->t = spot.t + in->start;
        met->triangle = ref[i];
        met->spot = spot;
        any = 1;
    }
    return any;
}

int glint_mesh_meet(const struct glint_scene *scene, uint32_t object,
                    uint32_t but_triangle, const struct glint_scene_ray *ray,
                    int any, struct glint_met *met)
{
    const struct glint_placed *p = &scene->placed[object];
    struct glint_chord chord;
    struct inside in = {.but = but_triangle};
    struct walk w;
    int found = 0;

    met->object = object;
    if (!glint_ray_sphere(ray, p->centre, p->reach, &chord) ||
        chord.t[1] <= 0 || chord.t[0] >= met->t ||
        !enter(scene, object, ray, q_larger(0, chord.t[0]), &in) ||
        !begin(&in, &w))
        return 0;
    do {
        found |= ask(&in, &w, met);
    } while (!(found && any) && go_on(&in, &w, (int64_t)met->t - in.start));
    return found;
}

/* Vertices are in camera coordinates once a frame. */
int glint_mesh_hold(const struct glint_scene *scene, uint32_t object,
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
    glint_shear(&ray, &sheared);
    if (!glint_ray_hold(&sheared, vertex, &met->spot))
        return 0;
    met->object = object;
    met->triangle = triangle;
    met->t = q_clamp_sat(met->spot.t, 1, GLINT_FAR - 1);
    return 1;
}
