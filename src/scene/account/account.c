/* SPDX-License-Identifier: MIT
 *
 * Counts the work that each object of a frame causes: samples, shaded points,
 * shadow rays, texels and reflected rays. Visibility and surfaces are computed
 * as for drawing, but no light is computed. */
#include "glint/scene/account.h"

#include "glint/scene/translucent.h"
#include "scene/mesh.h"
#include "scene/visible.h"
#include "scene/parts.h"

enum {
    TEXELS = 8,     /* texels read per texture lookup: 4 in each of 2 mip
                       levels */
    MAP_TEXELS = 4, /* texels read per lookup in the map of a translucent
                       medium */
    POINTS = 16, /* number of sample points on a light's disc; one ray is traced
                    from the camera to each */
    /* Costs, in units of a ray-object test: of the light of one source at one
     * point; of the visibility of a ball in one pixel of its box. */
    LIT_TESTS = 4,
    BALL_TESTS = 3
};

struct account {
    const struct glint_scene *scene;
    struct glint_scene_part *objects, *all;
    int16_t *seen;
};

/* ---------------------------------------------------------------- surfaces */

/* Counts the shadow rays from SURFACE, one per sample point of each light in
 * front of it; none if the scene has no shadows. */
static void count_shadow_rays(const struct glint_scene *s,
                              const struct glint_met_surface *surface,
                              struct glint_scene_part *part)
{
    for (uint32_t i = 0; s->model.header->shadow && i < s->n_lit; i++) {
        const struct glint_lit *lit = &s->lit[i];
        int32_t toward_q30[3], level_q15[3];

        if (glint_scene_compute_light_at(s, lit, surface->place, toward_q30,
                                         level_q15) &&
            v3_dot(toward_q30, surface->normal_q30) > 0) {
            part->count[GLINT_SCENE_SHADOWS] +=
                lit->light->radius ? s->cfg.shadow_points : 1;
            if (s->tests)
                glint_scene_lit_fraction(s, surface, lit);
        }
    }
}

static int is_translucent(const struct glint_scene *s,
                          const struct glint_met_surface *surface)
{
    const int skin = s->placed[surface->object].skin;

    return skin >= 0 &&
           surface->material ==
               &s->model.material[s->model.stone[s->model.skin[skin].stone]
                                      .material];
}

/* Counts the work of lighting a point of SURFACE: tests and shadow rays of all
 * light sources, and lookups of the environment if the material is metal. A
 * translucent medium without a coat only reads its light map. */
static void
count_lighting_work_of_point(const struct glint_scene *s,
                             const struct glint_met_surface *surface,
                             struct glint_scene_part *part)
{
    const int is_metal = surface->material->ward != GLINT_SCENE_NONE;

    glint_scene_count_ray_tests(s, LIT_TESTS * (int64_t)s->n_lit);
    if (is_translucent(s, surface)) {
        part->count[GLINT_SCENE_TEXELS] += MAP_TEXELS;
        if (!is_metal)
            return;
    }
    count_shadow_rays(s, surface, part);
    if (is_metal && s->model.header->n_environments > 0 &&
        !s->placed[surface->object].object->catcher_q15)
        part->count[GLINT_SCENE_LOOKUPS] += s->cfg.ward_samples;
}

/* Traces RAY from SURFACE to the next surface that it hits, and counts the work
 * of shading this next surface. Returns 0 if the ray hits no surface. */
static int trace_ray_to_next_surface(const struct glint_scene *s,
                                     struct glint_scene_ray *ray,
                                     struct glint_met_surface *surface,
                                     struct glint_scene_part *part)
{
    const struct glint_met_surface from = *surface;
    struct glint_met met;

    part->count[GLINT_SCENE_BOUNCED]++;
    glint_scene_set_ray_start(s, &from, ray->at);
    if (!glint_scene_find_nearest_hit(s, ray, from.object, from.triangle,
                                      &met) ||
        !glint_scene_find_surface_at_hit(s, ray, &met, surface))
        return 0;
    part->count[GLINT_SCENE_SHADED]++;
    count_lighting_work_of_point(s, surface, part);
    return 1;
}

/* Counts the reflected and transmitted rays that continue RAY at SURFACE. */
static void count_secondary_rays(const struct glint_scene *s,
                                 const struct glint_scene_ray *ray,
                                 const struct glint_met_surface *surface,
                                 struct glint_scene_part *part)
{
    struct glint_met_surface at = *surface;
    struct glint_scene_ray on = *ray;

    if (surface->material->reflect_q15) {
        glint_reflect_direction(ray->toward_q30, surface->normal_q30,
                                on.toward_q30);
        trace_ray_to_next_surface(s, &on, &at, part);
        at = *surface;
        on = *ray;
    }
    for (int i = 0; i < GLINT_SCENE_PASSES && at.material->pass_q15; i++) {
        /* a ray that enters a sphere searches for a surface inside it, too */
        if (s->placed[at.object].object->kind == GLINT_OBJECT_SPHERE) {
            part->count[GLINT_SCENE_BOUNCED]++;
            glint_scene_count_ray_tests(s, s->model.header->n_objects);
        }
        if (!trace_ray_to_next_surface(s, &on, &at, part))
            return;
    }
}

/* Counts the work of shading object or triangle ID at position (X, Y), pixels
 * q8 from the picture's middle. */
static void count_shading_work_of_point(const struct account *a, uint32_t id,
                                        int32_t x_q8, int32_t y_q8)
{
    const struct glint_scene *s = a->scene;
    struct glint_scene_part *part = &a->objects[id >> 20];
    const struct glint_scene_material *m =
        &s->model.material[s->placed[id >> 20].material];
    struct glint_met_surface surface;
    struct glint_scene_ray ray;
    struct glint_met met;
    int32_t seen_q30[3];

    part->count[GLINT_SCENE_SHADED]++;
    glint_view_set_ray(&s->view, x_q8, y_q8, &ray, seen_q30);
    if (!glint_scene_ray_hits_id(s, &ray, seen_q30, id, &met) ||
        !glint_scene_find_surface_at_hit(s, &ray, &met, &surface))
        return;
    count_lighting_work_of_point(s, &surface, part);
    if (s->placed[id >> 20].object->catcher_q15)
        return;
    if (m->texture != GLINT_SCENE_NONE)
        part->count[GLINT_SCENE_TEXELS] += TEXELS;
    if (m->reflect_q15 || m->pass_q15)
        count_secondary_rays(s, &ray, &surface, part);
}

static int do_ids_name_same_object(uint32_t a, uint32_t b)
{
    return a != GLINT_NOTHING && (a ^ b) >> 20 == 0;
}

/* Returns whether all samples of the aligned block of 2 x 2 pixels that
 * contains (X, Y) see one object, so that one shaded point serves all four
 * pixels; 0 if half_shading is off. */
static int can_pixel_quad_share_shading(const struct glint_scene_worker *w,
                                        int x, int y, uint32_t id)
{
    const struct glint_box b = w->touched;
    const int x0 = x & ~1, y0 = y & ~1, n = w->scene->cfg.edge_samples;

    if (!w->scene->cfg.half_shading || x0 < b.x0 || y0 < b.y0 ||
        x0 + 1 >= b.x1 || y0 + 1 >= b.y1)
        return 0;
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < n; i++)
            if (!do_ids_name_same_object(
                    id, w->id[glint_get_sample_index(w, x0 + (k & 1),
                                                     y0 + (k >> 1), i)]))
                return 0;
    return 1;
}

/* Counts the work of shading pixel (X, Y), for each object that its samples
 * see. */
static void count_work_of_pixel(const struct account *a,
                                const struct glint_scene_worker *w, int x,
                                int y)
{
    const struct glint_scene *s = a->scene;
    const uint32_t *id = &w->id[glint_get_sample_index(w, x, y, 0)];
    const int32_t x_q8 = glint_pixel_position_q8(s, x, 0),
                  y_q8 = glint_pixel_position_q8(s, y, 1);
    const int quad = can_pixel_quad_share_shading(w, x, y, id[0]);
    int any = 0;

    if (a->seen && id[0] != GLINT_NOTHING)
        a->seen[(ptrdiff_t)y * s->cfg.width + x] = (int16_t)(id[0] >> 20);
    for (int k = 0; k < s->cfg.edge_samples; k++) {
        int i = 0;

        if (id[k] == GLINT_NOTHING)
            continue;
        any = 1;
        a->objects[id[k] >> 20].count[GLINT_SCENE_SAMPLED]++;
        while (!do_ids_name_same_object(id[i], id[k]))
            i++;
        if (i == k)
            a->objects[id[k] >> 20].count[GLINT_SCENE_COVERING]++;
        if (quad ? k > 0 || ((x | y) & 1)
                 : i != k && !s->placed[id[k] >> 20].is_split)
            continue;
        if (s->placed[id[k] >> 20].is_split && !quad)
            count_shading_work_of_point(a, id[k],
                                        x_q8 + glint_sample_offset_q8(s, k, 0),
                                        y_q8 + glint_sample_offset_q8(s, k, 1));
        else
            count_shading_work_of_point(a, id[k], x_q8, y_q8);
    }
    a->all->count[GLINT_SCENE_COVERING] += any;
}

static void count_work_of_tile(const struct account *a,
                               struct glint_scene_worker *w,
                               struct glint_box tile)
{
    if (!glint_scene_look(w, tile))
        return;
    for (int y = w->touched.y0; y < w->touched.y1; y++)
        for (int x = w->touched.x0; x < w->touched.x1; x++)
            count_work_of_pixel(a, w, x, y);
}

/* -------------------------------------------------------------- visibility */

static enum glint_scene_fate
get_fate_of_unseen_object(const struct glint_placed *p)
{
    if (!p->is_shown)
        return GLINT_SCENE_OFF;
    return p->object->kind != GLINT_OBJECT_PLANE && p->z[1] == GLINT_FAR
               ? GLINT_SCENE_BEHIND
               : GLINT_SCENE_OUTSIDE;
}

/* Returns whether the ray through the middle of pixel (X, Y) hits object I. */
static int ray_hits_object(const struct glint_scene *s, uint32_t i, int x,
                           int y)
{
    struct glint_met met = {.t = GLINT_FAR};
    struct glint_scene_ray ray;
    int32_t seen_q30[3];

    glint_view_set_ray(&s->view, glint_pixel_position_q8(s, x, 0),
                       glint_pixel_position_q8(s, y, 1), &ray, seen_q30);
    if (s->placed[i].object->kind == GLINT_OBJECT_MESH)
        return s->cfg.parts.meshes->meet(s, i, GLINT_NOTHING, &ray, 1, &met);
    return glint_scene_ray_hits_id(s, &ray, seen_q30,
                                   glint_make_triangle_id(i, 0), &met);
}

/* Finds the object that hides most pixels of object I, by a majority vote
 * [Boyer91]. No sample may see I. Sets the fate COVERED, or SMALL if the ray
 * through no pixel's middle hits I. */
static void find_occluder(const struct account *a, uint32_t i)
{
    const struct glint_scene *s = a->scene;
    const struct glint_box b = s->placed[i].box;
    int by = -1, votes = 0, any = 0;

    for (int y = b.y0; y < b.y1; y++)
        for (int x = b.x0; x < b.x1; x++) {
            int other;

            if (!ray_hits_object(s, i, x, y))
                continue;
            any = 1;
            other = a->seen ? a->seen[(ptrdiff_t)y * s->cfg.width + x] : -1;
            by = votes == 0 ? other : by;
            votes += other == by ? 1 : -1;
        }
    a->objects[i].fate = any ? GLINT_SCENE_COVERED : GLINT_SCENE_SMALL;
    a->objects[i].by = any ? by : -1;
}

static void set_object_fate(const struct account *a, uint32_t i)
{
    struct glint_scene_part *part = &a->objects[i];

    if (!a->scene->placed[i].is_seen)
        part->fate = get_fate_of_unseen_object(&a->scene->placed[i]);
    else if (part->count[GLINT_SCENE_SAMPLED] > 0)
        part->fate = GLINT_SCENE_DRAWN;
    else
        find_occluder(a, i);
}

/* ------------------------------------------------------------- all objects */

static void clear_object_counts(const struct account *a)
{
    const struct glint_scene *s = a->scene;
    const ptrdiff_t n = (ptrdiff_t)s->cfg.width * s->cfg.height;

    *a->all = (struct glint_scene_part){.by = -1};
    for (uint32_t i = 0; i < s->model.header->n_objects; i++)
        a->objects[i] = *a->all;
    for (ptrdiff_t i = 0; a->seen && i < n; i++)
        a->seen[i] = -1;
}

void glint_scene_account(struct glint_scene *scene,
                         struct glint_scene_part *objects,
                         struct glint_scene_part *all, int16_t *seen)
{
    const struct account a = {scene, objects, all, seen};
    const struct glint_bins *bins = &scene->bins;
    const int n_tiles = bins->tiles_x * bins->tiles_y;

    clear_object_counts(&a);
    for (int tile = 0; tile < n_tiles; tile++)
        count_work_of_tile(&a, &scene->worker[0],
                           glint_bins_compute_tile_box(bins, tile));
    for (int32_t i = 0; scene->has_triangles && i < bins->start[n_tiles]; i++)
        objects[(uint32_t)bins->ref[i] >> 20].count[GLINT_SCENE_TRIANGLES]++;
    for (uint32_t i = 0; i < scene->model.header->n_objects; i++) {
        set_object_fate(&a, i);
        for (int k = 0; k < GLINT_SCENE_ITEMS; k++)
            if (k != GLINT_SCENE_COVERING)
                all->count[k] += objects[i].count[k];
    }
}

/* --------------------------------------------------------------- ray tests */

/* Finds the surface at the middle of pixel (X, Y), without counting; returns 0
 * if there is none. */
static int find_pixel_surface(const struct glint_scene *s, int x, int y,
                              struct glint_scene_ray *ray,
                              struct glint_met_surface *surface)
{
    struct glint_met met;
    int32_t seen_q30[3];

    glint_view_set_ray(&s->view, glint_pixel_position_q8(s, x, 0),
                       glint_pixel_position_q8(s, y, 1), ray, seen_q30);
    if (glint_scene_find_nearest_hit(s, ray, GLINT_NOTHING, GLINT_NOTHING,
                                     &met))
        return glint_scene_find_surface_at_hit(s, ray, &met, surface);
    for (uint32_t i = 0; i < s->model.header->n_objects; i++)
        if (s->placed[i].is_shown && s->placed[i].is_catcher &&
            glint_scene_ray_hits_id(s, ray, seen_q30,
                                    glint_make_triangle_id(i, 0), &met))
            return glint_scene_find_surface_at_hit(s, ray, &met, surface);
    return 0;
}

/* Adds the number of ray tests that pixel (X, Y) needs to TESTS. Returns
 * whether the pixel sees a surface. */
static int add_ray_tests_of_pixel(struct glint_scene *s, int x, int y,
                                  int64_t *tests)
{
    const int64_t before = *tests;
    struct glint_met_surface surface;
    struct glint_scene_ray ray;
    struct glint_scene_part part = {.by = -1};

    if (!find_pixel_surface(s, x, y, &ray, &surface))
        return 0;
    s->tests = tests;
    count_lighting_work_of_point(s, &surface, &part);
    if (!s->placed[surface.object].is_catcher)
        count_secondary_rays(s, &ray, &surface, &part);
    s->tests = NULL;
    /* Mirrors and glass are shaded at each sample, so the tests of the middle
     * are multiplied. */
    if (s->placed[surface.object].is_split)
        *tests += (*tests - before) * (s->cfg.edge_samples - 1);
    return 1;
}

/* Returns an upper bound of the number of texels in the light maps of all
 * translucent objects. The map of a ball is twice as wide as high. */
static int64_t compute_max_map_texels(const struct glint_scene_model *m)
{
    int64_t n = 0;

    for (uint32_t i = 0; i < m->header->n_skins; i++)
        n += INT64_C(2) << 2 * GLINT_TRANSLUCENT_MOST_LOG2;
    return n;
}

/* Returns the cost of finding the visible balls, in ray-object tests. */
static int64_t estimate_ball_visibility_cost(const struct glint_scene *s)
{
    int64_t px = 0;

    for (uint32_t i = 0; i < s->model.header->n_objects; i++) {
        const struct glint_placed *p = &s->placed[i];

        if (p->is_seen && p->object->kind == GLINT_OBJECT_SPHERE)
            px += (int64_t)(p->box.x1 - p->box.x0) * (p->box.y1 - p->box.y0);
    }
    return BALL_TESTS * px;
}

int64_t glint_scene_count_tests(struct glint_scene *scene, int64_t most)
{
    const int width = scene->cfg.width, height = scene->cfg.height;
    const int step =
        q_larger(4, (int32_t)glint_compute_square_root(
                        (uint64_t)width * (uint64_t)height / 2048));
    const int64_t balls = estimate_ball_visibility_cost(scene);
    int64_t tests = 0, n = 0;

    for (int y = step / 2; y < height; y += step)
        for (int x = step / 2; x < width; x += step) {
            n += add_ray_tests_of_pixel(scene, x, y, &tests);
            if (tests > (most - balls) / (step * step))
                return most + 1;
        }
    if (n > 0 && tests > 0)
        tests = tests * step * step +
                tests / n * compute_max_map_texels(&scene->model);
    return tests + balls;
}

int glint_scene_hider(const struct glint_scene *scene, int light)
{
    const struct glint_lit *lit = &scene->lit[light];
    struct glint_scene_ray middle = {.at = {0}};
    int32_t level_q15[3], t;
    int by = -1, votes = 0;

    for (int k = 0; k < 3; k++)
        middle.at[k] = scene->view.at[k];
    t = glint_scene_compute_light_at(scene, lit, middle.at, middle.toward_q30,
                                     level_q15);
    for (int i = 0; t > 0 && i < POINTS; i++) {
        struct glint_scene_ray to = middle;
        struct glint_met met;

        glint_scene_aim_at_light_point(&to, t, lit->light->radius, i, POINTS);
        if (!glint_scene_find_nearest_hit(scene, &to, GLINT_NOTHING,
                                          GLINT_NOTHING, &met) ||
            met.t >= t)
            continue;
        by = votes == 0 ? (int)met.object : by;
        votes += (int)met.object == by ? 1 : -1;
    }
    return by;
}
