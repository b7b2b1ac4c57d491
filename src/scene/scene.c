/* SPDX-License-Identifier: MIT
 *
 * Allocates a scene's memory, and changes its objects, camera and lights from
 * frame to frame. */
#include "scene/visible.h"

#include "base/compiler.h"
#include "base/real.h"
#include "scene/valid.h"
#include "scene/parts.h"

enum { ONE_Q30 = 1 << 30 };

/* ------------------------------------------------------------------ memory */

void glint_scene_defaults(struct glint_scene_config *cfg, int width, int height)
{
    *cfg = (struct glint_scene_config){.width = width,
                                       .height = height,
                                       .tile_log2 = 5,
                                       .edge_samples = 4,
                                       .shadow_points = 4,
                                       .ward_samples = 8,
                                       .highlights = -1,
                                       .max_refs = 1 << 15};
}

/* Returns whether a scene has brushed metal or an environment, which need the
 * ward module. */
static int needs_ward_module(const struct glint_scene_header *h)
{
    return h->n_wards > 0 || h->n_environments > 0;
}

const char *glint_scene_lacks(const struct glint_scene_parts *parts,
                              const struct glint_scene_model *model)
{
    const struct glint_scene_header *h = model->header;

    if (h->n_meshes > 0 && !parts->meshes)
        return "meshes";
    if (needs_ward_module(h) && !parts->wards)
        return "wards";
    if (h->n_skins > 0 && !parts->stones)
        return "stones";
    if (h->n_motions > 0 && !parts->motions)
        return "motions";
    for (uint32_t i = 0; i < h->n_materials; i++) {
        const struct glint_scene_material *m = &model->material[i];

        if (m->texture != GLINT_SCENE_NONE && !parts->textures)
            return "textures";
        if ((m->reflect_q15 || m->pass_q15) && !parts->bounces)
            return "bounces";
    }
    return NULL;
}

static size_t count_vertices(const struct glint_scene_model *m)
{
    size_t n = 0;

    for (uint32_t i = 0; i < m->header->n_objects; i++)
        if (m->object[i].kind == GLINT_OBJECT_MESH)
            n += m->mesh[m->object[i].mesh].n_vertices;
    return n;
}

/* Returns whether N is a power of two that is set as a bit in ALL. */
static int is_power_of_two_in_set(int n, int all)
{
    return n > 0 && (n & all) == n && (n & (n - 1)) == 0;
}

static int is_config_in_range(const struct glint_scene_config *c)
{
    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->tile_log2 >= 3 &&
           c->tile_log2 <= 6 &&
           is_power_of_two_in_set(c->edge_samples, 1 | 4 | 8 | 16) &&
           is_power_of_two_in_set(c->shadow_points, 1 | 4 | 16) &&
           c->ward_samples >= 1 && c->ward_samples <= 32 &&
           (c->half_shading & ~1) == 0 && c->highlights >= -1 &&
           c->highlights <= 8 && c->max_refs >= 0 &&
           glint_workers_count(c->workers) <= 64;
}

/* Returns the max number of shadow casters in a sun's grid: all triangles
 * and balls. */
static size_t count_shadow_casters(const struct glint_scene_model *m)
{
    size_t n = 0;

    for (uint32_t i = 0; i < m->header->n_objects; i++)
        n += m->object[i].kind == GLINT_OBJECT_MESH
                 ? m->mesh[m->object[i].mesh].n_triangles
                 : 1;
    return n;
}

/* Returns whether all shadows are black, as those of a grid. */
static int are_shadows_black(const struct glint_scene_model *m)
{
    int32_t any = 0;

    for (uint32_t i = 0; i < m->header->n_objects; i++)
        any |= m->object[i].unblocked_q15;
    return any == 0;
}

/* Allocates the shadow grids of suns. Not inlined, as the dummy grid that is
 * used to count bytes is large on the stack. */
static NEVER_INLINE void allocate_shadow_grids(struct glint_scene *s,
                                               struct glint_arena *a)
{
    const size_t cells = (size_t)1 << 2 * GLINT_SHADOW_CELLS_LOG2;
    const size_t n_vertices = count_vertices(&s->model);
    const size_t n_refs = 12 * count_shadow_casters(&s->model) + 64;
    const int has_grids =
        s->model.header->shadow && are_shadows_black(&s->model);

    for (uint32_t i = 0; i < s->model.header->n_lights; i++) {
        struct glint_shadow measured, *m;

        if (s->lit)
            s->lit[i].shadow = NULL;
        if (!has_grids || s->model.light[i].kind != GLINT_LIGHT_SUN)
            continue;
        m = glint_arena_allocate(a, 1, sizeof *m);
        if (s->lit)
            s->lit[i].shadow = m;
        m = m ? m : &measured;
        m->light = (int)i;
        m->is_ready = 0;
        m->max_refs = (int)n_refs;
        m->vertex = glint_arena_allocate(a, n_vertices, sizeof *m->vertex);
        m->bins.start =
            glint_arena_allocate(a, cells + 1, sizeof *m->bins.start);
        m->bins.ref = glint_arena_allocate(a, n_refs, sizeof *m->bins.ref);
        m->thing = glint_arena_allocate(a, count_shadow_casters(&s->model),
                                        sizeof *m->thing);
    }
}

/* Allocates the memory of one worker. WORKER must be NULL while the arena only
 * counts bytes. */
static void allocate_worker_memory(struct glint_scene *s, struct glint_arena *a,
                                   struct glint_scene_worker *worker)
{
    const size_t side = (size_t)1 << s->cfg.tile_log2;
    const size_t samples = side * side * (size_t)s->cfg.edge_samples;
    struct glint_scene_worker w = {.scene = s};

    w.depth = glint_arena_allocate(a, samples, sizeof *w.depth);
    w.id = glint_arena_allocate(a, samples, sizeof *w.id);
    w.scratch = (struct glint_tile_scratch){
        .light = glint_arena_allocate(a, 1, sizeof *w.scratch.light),
        .light_q20 =
            glint_arena_allocate(a, 3 * 2 * side, sizeof *w.scratch.light_q20),
        .codes = glint_arena_allocate(a, 1, sizeof *w.scratch.codes),
        .blend = glint_arena_allocate(a, 1, sizeof *w.scratch.blend)};
    if (s->cfg.half_shading)
        w.quad = glint_arena_allocate(a, side / 2, sizeof *w.quad);
    if (s->model.header->n_meshes)
        w.quick =
            glint_arena_allocate(a, GLINT_QUICK_TRIANGLES, sizeof *w.quick);
    if (s->model.motion)
        s->cfg.parts.motions->carve_worker(s, a, &w);
    if (worker)
        *worker = w;
}

/* Returns whether any material reflects or refracts the camera's picture. */
static int needs_background_picture(const struct glint_scene_model *model)
{
    const struct glint_scene_header *h = model->header;
    int any = 0;

    for (uint32_t i = 0; i < h->n_materials; i++)
        any |= model->material[i].reflect_q15 ||
               (model->material[i].pass_q15 &&
                model->material[i].index_q16 != 1 << 16);
    return any && h->background == GLINT_BACKGROUND_CAMERA;
}

/* Called twice. The first call has an arena that only counts bytes, and returns
 * NULL; the second one allocates. */
static struct glint_scene *allocate_scene(struct glint_arena *a,
                                          const struct glint_scene_config *cfg,
                                          const struct glint_scene_model *model)
{
    struct glint_scene measured = {.cfg = *cfg, .model = *model};
    struct glint_scene *placed = glint_arena_allocate(a, 1, sizeof *placed);
    struct glint_scene *s = placed ? placed : &measured;
    const struct glint_box all = {0, 0, cfg->width, cfg->height};
    const size_t n_vertices = count_vertices(model);
    const int n_workers = glint_workers_count(cfg->workers);

    *s = measured;
    s->placed =
        glint_arena_allocate(a, model->header->n_objects, sizeof *s->placed);
    s->lit = glint_arena_allocate(a, model->header->n_lights, sizeof *s->lit);
    allocate_shadow_grids(s, a);
    s->seen = glint_arena_allocate(a, n_vertices, sizeof *s->seen);
    s->corner = glint_arena_allocate(a, n_vertices, sizeof *s->corner);
    glint_bins_init(&s->bins, all, cfg->tile_log2, NULL, NULL);
    if (n_vertices > 0) {
        s->bins.start = glint_arena_allocate(
            a, (size_t)s->bins.tiles_x * (size_t)s->bins.tiles_y + 1,
            sizeof *s->bins.start);
        s->bins.ref =
            glint_arena_allocate(a, (size_t)cfg->max_refs, sizeof *s->bins.ref);
    }
    s->resolve = glint_arena_allocate(a, 1, sizeof *s->resolve);
    s->gloss =
        glint_arena_allocate(a, model->header->n_materials, sizeof *s->gloss);
    if (model->header->n_textures > 0)
        s->curve = glint_arena_allocate(a, 1, sizeof *s->curve);
    if (needs_background_picture(model))
        cfg->parts.bounces->carve(s, a);
    s->material = glint_arena_allocate(a, model->header->n_materials,
                                       sizeof *s->material);
    s->ward = glint_arena_allocate(a, model->header->n_wards, sizeof *s->ward);
    s->wards =
        needs_ward_module(model->header) ? cfg->parts.wards->carve(s, a) : NULL;
    s->stones =
        model->header->n_skins > 0 ? cfg->parts.stones->carve(s, a) : NULL;
    s->bright = cfg->parts.highlights && glint_scene_get_max_highlights(s) > 0
                    ? cfg->parts.highlights->carve(s, a)
                    : NULL;
    s->motion = model->motion ? cfg->parts.motions->carve(s, a) : NULL;
    s->cover_across = (cfg->width + 7) >> GLINT_COVER_LOG2;
    s->cover_down = (cfg->height + 7) >> GLINT_COVER_LOG2;
    s->cover = glint_arena_allocate(
        a, (size_t)s->cover_across * (size_t)s->cover_down, sizeof *s->cover);
    s->worker = glint_arena_allocate(a, (size_t)n_workers, sizeof *s->worker);
    for (int i = 0; i < n_workers; i++)
        allocate_worker_memory(s, a, s->worker ? &s->worker[i] : NULL);
    return placed;
}

size_t glint_scene_bytes(const struct glint_scene_config *cfg,
                         const struct glint_scene_model *model)
{
    struct glint_arena arena = glint_arena_begin_measuring();

    if (!is_config_in_range(cfg) || glint_scene_lacks(&cfg->parts, model))
        return 0;
    allocate_scene(&arena, cfg, model);
    return arena.used;
}

/* Returns the index of the light map (skin) of object I, or -1 if it has
 * none. */
static int find_translucency_map(const struct glint_scene_model *model,
                                 uint32_t i)
{
    for (uint32_t k = 0; k < model->header->n_skins; k++)
        if (model->skin[k].object == i)
            return (int)k;
    return -1;
}

/* Moves all objects to the positions that the model states; returns 0 if one is
 * out of range. */
static int set_initial_poses(struct glint_scene *s)
{
    const struct glint_scene_model *model = &s->model;
    uint32_t first = 0;

    for (uint32_t i = 0; i < model->header->n_objects; i++) {
        const struct glint_scene_object *o = &model->object[i];

        s->placed[i] =
            (struct glint_placed){.object = o,
                                  .radius = o->radius,
                                  .is_shown = !o->hidden,
                                  .is_catcher = o->catcher_q15 > 0,
                                  .skin = find_translucency_map(model, i),
                                  .first_vertex = first};
        if (glint_scene_set_material(s, (int)i, (int)o->material) != GLINT_OK)
            return 0;
        s->has_catchers |= s->placed[i].is_catcher;
        if (o->kind == GLINT_OBJECT_MESH)
            first += model->mesh[o->mesh].n_vertices;
        if (glint_scene_set_pose(s, (int)i, o->at, o->turn_q30) != GLINT_OK)
            return 0;
    }
    return 1;
}

static void set_initial_lights(struct glint_scene *s)
{
    const struct glint_scene_model *model = &s->model;

    s->n_lit = model->header->n_lights;
    for (uint32_t i = 0; i < s->n_lit; i++) {
        const struct glint_scene_light *l = &model->light[i];

        s->lit[i].light = l;
        glint_scene_set_light(
            s, (int)i, l->kind == GLINT_LIGHT_SUN ? l->toward_q30 : l->at);
        for (int c = 0; c < 3; c++)
            s->lit[i].rgb_q15[c] =
                (int32_t)real_integer(l->rgb[c], 15, GLINT_SCENE_MOST_LIGHT);
    }
}

enum glint_status glint_scene_init(struct glint_scene **scene,
                                   const struct glint_scene_config *cfg,
                                   const struct glint_scene_model *model,
                                   void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_scene_view view;
    struct glint_scene *s;

    if (!is_config_in_range(cfg) || (uintptr_t)mem % GLINT_ALIGN != 0 ||
        !glint_view_init(&view, &model->header->camera, cfg->width, cfg->height,
                         cfg->focal_q16))
        return GLINT_E_ARGUMENT;
    if (glint_scene_lacks(&cfg->parts, model))
        return GLINT_E_UNSUPPORTED;
    if (glint_scene_bytes(cfg, model) > bytes)
        return GLINT_E_MEMORY;
    s = allocate_scene(&arena, cfg, model);
    s->view = view;
    s->has_split = s->has_catchers = 0;
    s->moved = 0;
    s->is_spread = 0;
    s->sample_q8 = glint_scene_samples(cfg->edge_samples);
    glint_scene_copy_materials(s);
    set_initial_lights(s);
    if (s->wards && cfg->parts.wards->open(s) != GLINT_OK)
        return GLINT_E_FORMAT;
    if (s->stones && cfg->parts.stones->open(s) != GLINT_OK)
        return GLINT_E_FORMAT;
    if (s->curve)
        cfg->parts.textures->prepare(s->curve);
    for (uint32_t i = 0; i < model->header->n_materials; i++)
        glint_gloss_fill_power_table(&s->gloss[i], model->material[i].power_q8);
    if (!set_initial_poses(s))
        return GLINT_E_ARGUMENT; /* cannot happen, as opening the model has
                                    checked its poses */
    if (s->motion && cfg->parts.motions->open(s) != GLINT_OK)
        return GLINT_E_FORMAT;
    *scene = s;
    return GLINT_OK;
}

/* ------------------------------------------------------------------- poses */

void glint_scene_quaternion_to_rotation(const int32_t q[4],
                                        struct glint_scene_turn *to)
{
    const int32_t w = q[0], *v = q + 1;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int k = 3 - i - j;
            int64_t e_q60;

            if (i == j) {
                const int32_t a = v[(i + 1) % 3], b = v[(i + 2) % 3];

                e_q60 =
                    (INT64_C(1) << 60) - 2 * ((int64_t)a * a + (int64_t)b * b);
            } else {
                const int64_t turn = 2 * (int64_t)w * v[k];

                e_q60 = 2 * (int64_t)v[i] * v[j] +
                        ((j - i + 3) % 3 == 1 ? -turn : turn);
            }
            to->row_q30[i][j] = (int32_t)q_shift(e_q60, 30);
        }
}

/* Returns whether object P already has position AT and rotation TURN. */
static int is_same_pose(const struct glint_placed *p, const int32_t at[3],
                        const struct glint_scene_turn *turn)
{
    int32_t other = 0;

    for (int i = 0; i < 3; i++) {
        other |= p->at[i] ^ at[i];
        for (int k = 0; k < 3; k++)
            other |= p->turn.row_q30[i][k] ^ turn->row_q30[i][k];
    }
    return other == 0;
}

enum glint_status glint_scene_set_pose(struct glint_scene *scene, int object,
                                       const int32_t at[3],
                                       const int32_t turn_q30[4])
{
    struct glint_scene_turn turn;
    struct glint_placed *p;

    if (object < 0 || object >= (int)scene->model.header->n_objects)
        return GLINT_E_ARGUMENT;
    p = &scene->placed[object];
    if (!glint_scene_is_unit_vector(turn_q30, 4) ||
        !glint_scene_is_object_in_range(&scene->model, p->object, at) ||
        !glint_scene_is_vector_within(at, 3, GLINT_SCENE_SPAN - 1 - p->radius))
        return GLINT_E_ARGUMENT;
    glint_scene_quaternion_to_rotation(turn_q30, &turn);
    if (is_same_pose(p, at, &turn))
        return GLINT_OK;
    glint_scene_invalidate_shadows(scene);
    p->turn = turn;
    for (int k = 0; k < 3; k++)
        p->at[k] = p->centre[k] = at[k];
    p->reach = p->radius;
    if (p->object->kind == GLINT_OBJECT_PLANE) {
        const int64_t up[3] = {p->turn.row_q30[0][1], p->turn.row_q30[1][1],
                               p->turn.row_q30[2][1]};

        glint_normalise_vector(up, p->centre);
    } else if (p->object->kind == GLINT_OBJECT_MESH) {
        const struct glint_scene_mesh *m = &scene->model.mesh[p->object->mesh];
        int32_t centre[3];

        v3_rotate(&p->turn, m->centre, centre);
        for (int k = 0; k < 3; k++)
            p->centre[k] += centre[k];
        p->reach = m->radius + 4;
    }
    return GLINT_OK;
}

enum glint_status glint_scene_set_camera(struct glint_scene *scene,
                                         const int32_t at[3],
                                         const int32_t axis_q30[3][3])
{
    struct glint_scene_camera camera = scene->model.header->camera;

    for (int k = 0; k < 3; k++) {
        camera.at[k] = at[k];
        for (int i = 0; i < 3; i++)
            camera.axis_q30[k][i] = axis_q30[k][i];
    }
    if (glint_scene_check_camera(&camera))
        return GLINT_E_ARGUMENT;
    glint_view_init(&scene->view, &camera, scene->cfg.width, scene->cfg.height,
                    scene->cfg.focal_q16);
    return GLINT_OK;
}

enum glint_status glint_scene_set_light(struct glint_scene *scene, int light,
                                        const int32_t at[3])
{
    struct glint_lit *l;
    int is_sun;

    if (light < 0 || light >= (int)scene->model.header->n_lights)
        return GLINT_E_ARGUMENT;
    l = &scene->lit[light];
    is_sun = l->light->kind == GLINT_LIGHT_SUN;
    if (is_sun ? !glint_scene_is_unit_vector(at, 3)
               : !glint_scene_is_vector_within(at, 3, GLINT_SCENE_SPAN - 1))
        return GLINT_E_ARGUMENT;
    for (int k = 0; k < 3; k++) {
        l->at[k] = is_sun ? 0 : at[k];
        l->toward_q30[k] = is_sun ? at[k] : 0;
    }
    glint_scene_invalidate_shadows(scene);
    return GLINT_OK;
}

void glint_scene_look_around(struct glint_scene *scene,
                             const struct glint_image *image)
{
    int any = 0;

    for (uint32_t i = 0; i < scene->model.header->n_objects; i++)
        any |= scene->placed[i].is_seen;
    if (needs_background_picture(&scene->model) && (any || !image))
        scene->cfg.parts.bounces->look(scene, image);
}

int glint_scene_spread(struct glint_scene *scene)
{
    if (!scene->stones || scene->is_spread)
        return 0;
    scene->is_spread = 1;
    return scene->cfg.parts.stones->update(scene);
}

void glint_scene_show(struct glint_scene *scene, int object, int is_shown)
{
    if (object < 0 || object >= (int)scene->model.header->n_objects)
        return;
    if (scene->placed[object].is_shown == (is_shown != 0))
        return;
    scene->placed[object].is_shown = is_shown != 0;
    glint_scene_invalidate_shadows(scene);
}
