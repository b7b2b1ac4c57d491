/* SPDX-License-Identifier: MIT
 *
 * Makes the grid of a sun's shadows, when something has moved. */
#include "base/divide.h"
#include "scene/shadow_grid.h"
#include "scene/mesh.h"

static int throws(const struct glint_placed *p)
{
    return p->is_shown && p->object->kind != GLINT_OBJECT_PLANE;
}

/* ------------------------------------------------------------------ extents */

static void grow(struct glint_shadow *shadow, const int32_t at[3],
                 int32_t reach)
{
    for (int k = 0; k < 3; k++) {
        shadow->lo[k] = q_smaller(shadow->lo[k], at[k] - reach);
        shadow->hi[k] = q_larger(shadow->hi[k], at[k] + reach);
    }
}

/* Sets the box of all that throws shadows; returns 0 if nothing does. */
static int enclose(const struct glint_scene *s, struct glint_shadow *shadow)
{
    for (int k = 0; k < 3; k++) {
        shadow->lo[k] = INT32_MAX;
        shadow->hi[k] = INT32_MIN;
    }
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];
        int32_t at[3];

        if (!throws(p))
            continue;
        v3_turn(&shadow->turn, p->centre, at);
        grow(shadow, at, p->reach + GLINT_SHADOW_SLACK);
    }
    return shadow->lo[0] <= shadow->hi[0];
}

/* Makes room for rays that lean: the grid answers for places as far below
 * things as these are large. */
static void widen(struct glint_shadow *shadow)
{
    const int32_t side =
        q_larger(shadow->hi[0] - shadow->lo[0], shadow->hi[1] - shadow->lo[1]);
    int64_t lean;

    shadow->lowest = -GLINT_FAR;
    if (shadow->lean_q30 == 0)
        return;
    shadow->lowest = q_larger(shadow->lo[2] - side, -GLINT_FAR);
    lean = glint_shadow_lean(shadow, (int64_t)shadow->hi[2] - shadow->lowest) +
           GLINT_SHADOW_SLACK;
    for (int k = 0; k < 2; k++) {
        shadow->lo[k] =
            q_clamp_sat(shadow->lo[k] - lean, -GLINT_FAR, GLINT_FAR);
        shadow->hi[k] =
            q_clamp_sat(shadow->hi[k] + lean, -GLINT_FAR, GLINT_FAR);
    }
}

/* ------------------------------------------------------------------- lists */

/* Returns the cells of a thing. */
static struct glint_box cells_of(const struct glint_shadow_thing *t)
{
    return glint_box_cut(
        (struct glint_box){0, 0, GLINT_SHADOW_CELLS, GLINT_SHADOW_CELLS},
        (struct glint_box){t->lo[0] >> 8, t->lo[1] >> 8, (t->hi[0] >> 8) + 1,
                           (t->hi[1] >> 8) + 1});
}

/* Sets T to what a thing within LO .. HI can shadow. */
static void set_thing(const struct glint_shadow *shadow, const int32_t lo[3],
                      const int32_t hi[3], uint32_t id,
                      struct glint_shadow_thing *t)
{
    const int64_t lean =
        GLINT_SHADOW_SLACK +
        (shadow->lean_q30
             ? glint_shadow_lean(shadow, (int64_t)hi[2] - shadow->lowest)
             : 0);

    t->id = id;
    t->top = hi[2];
    for (int k = 0; k < 2; k++) {
        t->lo[k] = (int16_t)glint_shadow_across_q8(shadow, lo[k] - lean, k);
        t->hi[k] = (int16_t)glint_shadow_across_q8(shadow, hi[k] + lean, k);
    }
}

/* Sets the things of mesh I from T on; returns how many. */
static int set_triangles(const struct glint_scene *s,
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
        set_thing(shadow, lo, hi, glint_id(i, n), thing++);
    }
    return (int)mesh->n_triangles;
}

/* Sets all things; returns how many entries they have in all cells. */
static int64_t set_things(const struct glint_scene *s,
                          struct glint_shadow *shadow)
{
    int64_t n = 0;

    shadow->n_things = 0;
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];
        struct glint_shadow_thing *t = &shadow->thing[shadow->n_things];
        int32_t at[3], lo[3], hi[3];

        if (!throws(p))
            continue;
        if (p->object->kind == GLINT_OBJECT_MESH) {
            shadow->n_things += set_triangles(s, shadow, i, t);
            continue;
        }
        v3_turn(&shadow->turn, p->at, at);
        for (int k = 0; k < 3; k++) {
            lo[k] = at[k] - p->radius;
            hi[k] = at[k] + p->radius;
        }
        set_thing(shadow, lo, hi, glint_id(i, 0), t);
        shadow->n_things++;
    }
    for (int i = 0; i < shadow->n_things; i++) {
        const struct glint_box b = cells_of(&shadow->thing[i]);

        if (!glint_box_empty(b))
            n += (int64_t)(b.x1 - b.x0) * (b.y1 - b.y0);
    }
    return n;
}

static void list(struct glint_shadow *shadow)
{
    glint_bins_open(&shadow->bins);
    for (int i = 0; i < shadow->n_things; i++) {
        const struct glint_box b = cells_of(&shadow->thing[i]);

        if (!glint_box_empty(b))
            glint_bins_count(&shadow->bins, b);
    }
    glint_bins_sum(&shadow->bins);
    for (int i = 0; i < shadow->n_things; i++) {
        const struct glint_box b = cells_of(&shadow->thing[i]);

        for (int y = b.y0; y < b.y1; y++)
            for (int x = b.x0; x < b.x1; x++)
                shadow->bins
                    .ref[shadow->bins.start[y * GLINT_SHADOW_CELLS + x]++] = i;
    }
    glint_bins_close(&shadow->bins);
}

/* Puts the highest things of each list first, but of long lists. */
static void sort_lists(struct glint_shadow *shadow)
{
    for (int i = 0; i < GLINT_SHADOW_CELLS * GLINT_SHADOW_CELLS; i++) {
        int32_t *ref = shadow->bins.ref + shadow->bins.start[i];
        const int n = shadow->bins.start[i + 1] - shadow->bins.start[i];

        for (int k = 1; k < n && n <= GLINT_SHADOW_SORTED; k++) {
            const int32_t own = ref[k], top = shadow->thing[own].top;
            int to = k;

            for (; to > 0 && shadow->thing[ref[to - 1]].top < top; to--)
                ref[to] = ref[to - 1];
            ref[to] = own;
        }
    }
}

/* Returns whether a list has a thing but OWN that is above LOWEST and can
 * shadow places within LO .. HI. */
static int can_shadow(const struct glint_shadow *shadow, int cell, uint32_t own,
                      int32_t lowest, const int32_t lo_q8[2],
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

/* Returns whether nothing can come between the sun and ball I. Places on it are
 * found to 2^-20 of its radius at least (quick.c). */
static int is_open(const struct glint_scene *s,
                   const struct glint_shadow *shadow, uint32_t i)
{
    const struct glint_placed *p = &s->placed[i];
    const int32_t reach = p->radius + (p->radius >> 20) + GLINT_SHADOW_SLACK;
    int32_t at[3], lo_q8[2], hi_q8[2];

    v3_turn(&shadow->turn, p->at, at);
    for (int k = 0; k < 2; k++) {
        lo_q8[k] = glint_shadow_across_q8(shadow, (int64_t)at[k] - reach, k);
        hi_q8[k] = glint_shadow_across_q8(shadow, (int64_t)at[k] + reach, k);
        if (lo_q8[k] < 0 || hi_q8[k] >= GLINT_SHADOW_CELLS << 8)
            return 0;
    }
    for (int y = lo_q8[1] >> 8; y <= hi_q8[1] >> 8; y++)
        for (int x = lo_q8[0] >> 8; x <= hi_q8[0] >> 8; x++)
            if (can_shadow(shadow, y * GLINT_SHADOW_CELLS + x, glint_id(i, 0),
                           at[2] - reach, lo_q8, hi_q8))
                return 0;
    return 1;
}

/* Marks the balls that nothing can come before. */
static void mark_open(const struct glint_scene *s,
                      const struct glint_shadow *shadow)
{
    const uint32_t bit = UINT32_C(1) << shadow->light;

    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        struct glint_placed *p = &s->placed[i];

        p->open_to &= ~bit;
        if (p->is_shown && p->object->kind == GLINT_OBJECT_SPHERE &&
            is_open(s, shadow, i))
            p->open_to |= bit;
    }
}

static void turn_vertices(const struct glint_scene *s,
                          struct glint_shadow *shadow)
{
    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];
        const struct glint_scene_mesh *mesh;
        const int32_t *vertex;

        if (!throws(p) || p->object->kind != GLINT_OBJECT_MESH)
            continue;
        mesh = glint_mesh_of(s, i);
        vertex = glint_mesh_table(s, mesh->vertex_at);
        for (uint32_t k = 0; k < mesh->n_vertices; k++) {
            int32_t place[3];

            v3_turn(&p->turn, vertex + 3 * (size_t)k, place);
            for (int j = 0; j < 3; j++)
                place[j] += p->at[j];
            v3_turn(&shadow->turn, place, shadow->vertex[p->first_vertex + k]);
        }
    }
}

/* Sets the points of the disc: how their rays lean. */
static void set_points(const struct glint_scene *s, const struct glint_lit *lit,
                       struct glint_shadow *shadow)
{
    shadow->n_points = lit->light->radius ? s->cfg.shadow_points : 1;
    for (int i = 0; i < shadow->n_points; i++) {
        struct glint_shadow_point *p = &shadow->point[i];
        struct glint_scene_ray to = {.at = {0}};
        int32_t at_q30[3];

        for (int k = 0; k < 3; k++)
            to.toward_q30[k] = lit->toward_q30[k];
        glint_scene_point(&to, GLINT_FAR, lit->light->radius, i,
                          shadow->n_points);
        v3_turn(&shadow->turn, to.toward_q30, at_q30);
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

void glint_shadow_prepare(const struct glint_scene *s,
                          const struct glint_lit *lit,
                          struct glint_shadow *shadow)
{
    int32_t *row_q30[3] = {shadow->turn.row_q30[0], shadow->turn.row_q30[1],
                           shadow->turn.row_q30[2]};

    shadow->is_ready = 0;
    shadow->lean_q30 = 0;
    for (int k = 0; k < 3; k++)
        row_q30[2][k] = lit->toward_q30[k];
    glint_scene_frame_of(row_q30[2], row_q30[0], row_q30[1]);
    set_points(s, lit, shadow);
    shadow->is_empty = !enclose(s, shadow);
    shadow->is_ready = 1;
    if (shadow->is_empty)
        return;
    widen(shadow);
    for (int k = 0; k < 2; k++)
        shadow->cells_q32[k] =
            (int32_t)q_divide(INT64_C(1) << (32 + GLINT_SHADOW_CELLS_LOG2),
                              (int64_t)shadow->hi[k] - shadow->lo[k] +
                                  GLINT_SHADOW_CELLS * GLINT_SHADOW_SLACK);
    glint_bins_init(
        &shadow->bins,
        (struct glint_box){0, 0, GLINT_SHADOW_CELLS, GLINT_SHADOW_CELLS}, 0,
        shadow->bins.start, shadow->bins.ref);
    turn_vertices(s, shadow);
    while (set_things(s, shadow) > shadow->max_refs)
        for (int k = 0; k < 2; k++)
            shadow->cells_q32[k] -= (shadow->cells_q32[k] + 3) / 4;
    list(shadow);
    sort_lists(shadow);
    mark_open(s, shadow);
}
