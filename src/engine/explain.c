/* SPDX-License-Identifier: MIT */
#include "glint/explain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine_parts.h"
#include "engine/explain_frame.h"
#include "engine/frame/frame_parts.h"
#include "engine/setup/degrees.h"

/* Returns the cost, in instructions, of N operations of type KIND, such as
 * drawing edges. */
static double compute_item_cost(enum glint_cost_kind kind, double n)
{
    return 1e3 * glint_cost_weight[kind].counted * n;
}

/* Returns the cost of P (one ghost, light or wavelength of the flare), in
 * instructions, and sets STAGE to the cost per type of operation. Lit pixels
 * and subdivided cells are not included, as they do not belong to a single
 * ghost, light or wavelength. */
static double compute_part_cost(const struct glint_explain_part *p,
                                double *stage)
{
    const double count[GLINT_COST_PARTS] = {
        [GLINT_COST_LOOKED_AT] = (double)p->probed,
        [GLINT_COST_BUNDLES] = glint_explain_drawn(p),
        [GLINT_COST_VERTICES] = (double)p->vertices,
        [GLINT_COST_EDGES] = (double)p->edges,
        [GLINT_COST_ROWS] = (double)p->rows};
    double work = 0;

    for (int k = 0; k < GLINT_COST_PARTS; k++)
        work += stage[k] = compute_item_cost((enum glint_cost_kind)k, count[k]);
    return work;
}

int glint_explain_drawn(const struct glint_explain_part *p)
{
    return p->of[GLINT_OUTCOME_DRAWN] + p->of[GLINT_OUTCOME_EMPTY];
}

int glint_explain_bundles(const struct glint_explain_part *p)
{
    int n = 0;

    for (int outcome = 0; outcome < GLINT_OUTCOMES; outcome++)
        n += p->of[outcome];
    return n;
}

/* ---------------------------------------------------------------- accounts */

static void add_account(struct glint_explain_part *p,
                        const struct glint_account *a)
{
    p->probed += a->probed;
    if (a->outcome == GLINT_OUTCOME_OTHER_SET) /* The ghost is drawn with
                                                  another set of wavelengths. */
        return;
    p->of[a->outcome]++;
    if (a->outcome != GLINT_OUTCOME_DRAWN && a->outcome != GLINT_OUTCOME_EMPTY)
        return;
    p->cells = a->cells > p->cells ? a->cells : p->cells;
    p->terms = a->terms > p->terms ? a->terms : p->terms;
    p->barrels = a->barrels > p->barrels ? a->barrels : p->barrels;
    p->vertices += a->vertices;
    p->all_terms += (long long)a->vertices * a->terms;
    p->edges += a->edges;
    p->rows += a->rows;
    p->refs += a->refs;
}

/* Returns the index in e->wave of the statistics of wavelength WAVE. There is
 * one entry per set of wavelengths, or one per wavelength if there are no
 * sets. */
static int find_part_of_wave(const struct glint_explain *e, int wave)
{
    const struct glint_wave_sets *sets = e->frame->plan.rays.sets;
    int part = wave;

    if (sets)
        for (part = 0; wave >= sets->size[part]; part++)
            wave -= sets->size[part];
    return part;
}

/* Adds the statistics A of a ray bundle to the totals of the explanation CTX:
 * of the frame, of GHOST and of LIGHT. */
static void count_bundle(void *ctx, int ghost, int light,
                         const struct glint_account *a)
{
    struct glint_explain *const e = ctx;

    add_account(&e->all, a);
    /* NOLINTNEXTLINE: set_ghost_numbers() has set ghost_of */
    add_account(&e->ghost[e->ghost_of[ghost]], a);
    add_account(&e->light[light], a);
    add_account(&e->lamp[e->lamp_of[light]], a);
    if (a->outcome == GLINT_OUTCOME_DRAWN || a->outcome == GLINT_OUTCOME_EMPTY)
        e->barrels[a->barrels]++;
}

static void count_model_bundles(struct glint_explain *e)
{
    const int n_ghosts = (int)e->frame->lens->header->n_ghosts;
    const int n_waves = e->frame->plan.rays.n_waves;

    for (int light = 0; light < e->n_lights; light++)
        for (int ghost = 0; ghost < n_ghosts; ghost++)
            for (int wave = 0; wave < n_waves; wave++) {
                struct glint_account a;

                glint_flare_account(e->frame->memory.flare, ghost, light, wave,
                                    &a);
                count_bundle(e, ghost, light, &a);
                add_account(&e->wave[find_part_of_wave(e, wave)], &a);
            }
}

/* ------------------------------------------------------------------- light */

static enum glint_status draw_flare_part(struct glint_explain *e, int ghost,
                                         int light, int wave)
{
    const struct glint_view *view = &e->frame->view;
    struct glint_image image = glint_image_over(e->linear_q20, GLINT_LINEAR_Q20,
                                                view->width, view->height);

    memset(e->linear_q20, 0,
           3 * (size_t)view->width * (size_t)view->height *
               sizeof *e->linear_q20);
    if (!e->lens)
        return e->frame->trace->draw_part(e->frame, ghost, light, &image);
    glint_flare_keep(e->frame->memory.flare, ghost, light, wave);
    glint_flare_draw(e->frame->memory.flare, &image);
    return GLINT_OK;
}

enum glint_status glint_explain_draw(struct glint_explain *explain, int ghost)
{
    return draw_flare_part(explain, ghost, -1, -1);
}

/* Sets flux, max light, numbers of lit pixels and tiles, and bounding box of
 * PART. The last drawing must have drawn PART alone. */
static void measure_part_light(struct glint_explain *e,
                               struct glint_explain_part *part)
{
    const struct glint_view *view = &e->frame->view;
    const int32_t *px = e->linear_q20;
    int64_t sum = 0;
    int32_t most = 0;

    part->x0 = view->width;
    part->y0 = view->height;
    part->x1 = part->y1 = -1;
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++, px += 3) {
            const int32_t here = max_int(px[0], max_int(px[1], px[2]));

            if ((px[0] | px[1] | px[2]) == 0)
                continue;
            part->lit++;
            part->x0 = min_int(part->x0, x);
            part->y0 = min_int(part->y0, y);
            part->x1 = max_int(part->x1, x);
            part->y1 = max_int(part->y1, y);
            sum += (int64_t)px[0] + px[1] + px[2];
            most = here > most ? here : most;
        }
    part->tiles = e->lens ? glint_flare_tiles(e->frame->memory.flare) : 0;
    part->flux = (double)sum / 3 * 0x1p-20 * e->unit;
    part->brightest = most * 0x1p-20 * e->unit;
}

/* Progress of drawing the parts of a frame one by one. */
struct parts {
    struct glint_explain *e;
    const struct glint_explain_config *cfg;
    int n_done, n_all;
    int32_t *sum; /* sum of the light of some parts, like e->linear_q20 */
};

static size_t count_frame_samples(const struct glint_explain *e)
{
    return 3 * (size_t)e->frame->view.width * (size_t)e->frame->view.height;
}

/* Draws and measures PART of the frame if any of its ray bundles is drawn. */
static enum glint_status draw_and_measure_part(struct parts *p,
                                               struct glint_explain_part *part,
                                               int ghost, int light, int wave)
{
    enum glint_status status;

    if (glint_explain_drawn(part) == 0)
        return GLINT_OK;
    status = draw_flare_part(p->e, ghost, light, wave);
    if (status == GLINT_OK)
        measure_part_light(p->e, part);
    p->n_done++;
    if (p->cfg->progress)
        p->cfg->progress(p->cfg->progress_ctx, (double)p->n_done / p->n_all);
    return status;
}

/* Adds the light of PART, which must have been drawn last, to P->sum. */
static void add_part_to_sum(struct parts *p,
                            const struct glint_explain_part *part)
{
    const size_t n = part->lit > 0 ? count_frame_samples(p->e) : 0;

    for (size_t k = 0; k < n; k++) {
        const int64_t light = (int64_t)p->sum[k] + p->e->linear_q20[k];

        p->sum[k] = (int32_t)(light < INT32_MAX ? light : INT32_MAX);
    }
}

/* Measures P->sum as the light of PART. */
static void measure_sum_of_parts(struct parts *p,
                                 struct glint_explain_part *part)
{
    int32_t *const drawn = p->e->linear_q20;

    p->e->linear_q20 = p->sum;
    measure_part_light(p->e, part);
    p->e->linear_q20 = drawn;
}

/* Draws and measures each ghost, and measures their sum, which costs less than
 * to draw all again if rays are exact. */
static enum glint_status measure_ghosts_and_sum(struct parts *p)
{
    struct glint_explain *const e = p->e;
    enum glint_status status = GLINT_OK;

    for (int i = 0; i < e->n_ghosts && status == GLINT_OK; i++) {
        status = draw_and_measure_part(p, &e->ghost[i], i, -1, -1);
        if (!e->lens)
            add_part_to_sum(p, &e->ghost[i]);
    }
    if (status == GLINT_OK && !e->lens)
        measure_sum_of_parts(p, &e->all);
    return status;
}

/* Draws and measures the lights of lamp LAMP, and measures their sum. A single
 * light is its own sum, and the light of a single lamp is that of the frame. */
static enum glint_status measure_lights_of_lamp(struct parts *p, int lamp)
{
    struct glint_explain *const e = p->e;
    enum glint_status status = GLINT_OK;
    int n = 0;
    bool has_sum;

    for (int i = 0; i < e->n_lights; i++)
        n += e->lamp_of[i] == lamp;
    has_sum = n > 1 && e->n_lamps > 1;
    if (has_sum)
        memset(p->sum, 0, count_frame_samples(e) * sizeof *p->sum);
    for (int i = 0; i < e->n_lights && status == GLINT_OK; i++) {
        if (e->lamp_of[i] != lamp)
            continue;
        status = draw_and_measure_part(p, &e->light[i], -1, i, -1);
        if (has_sum)
            add_part_to_sum(p, &e->light[i]);
        else if (n == 1)
            e->lamp[lamp] = e->light[i];
    }
    if (has_sum)
        measure_sum_of_parts(p, &e->lamp[lamp]);
    return status;
}

static int count_drawn_parts(const struct glint_explain_part *part, int n)
{
    int n_drawn = 0;

    for (int i = 0; i < n; i++)
        n_drawn += glint_explain_drawn(&part[i]) > 0;
    return n_drawn;
}

static enum glint_status draw_and_measure_all_parts(struct parts *p)
{
    struct glint_explain *const e = p->e;
    const bool is_only_light = !e->lens && e->n_lights == 1;
    enum glint_status status;

    p->n_all = count_drawn_parts(e->ghost, e->n_ghosts) +
               (is_only_light ? 0 : count_drawn_parts(e->light, e->n_lights)) +
               count_drawn_parts(e->wave, e->n_waves) + (e->lens ? 1 : 0);
    status = measure_ghosts_and_sum(p);
    if (is_only_light)
        e->light[0] = e->all;
    for (int i = 0; i < e->n_lamps && !is_only_light && status == GLINT_OK; i++)
        status = measure_lights_of_lamp(p, i);
    for (int i = 0; i < e->n_waves && status == GLINT_OK; i++)
        status = draw_and_measure_part(p, &e->wave[i], -1, -1, i);
    if (e->lens && status == GLINT_OK)
        status = draw_and_measure_part(p, &e->all, -1, -1, -1);
    if (e->n_lamps == 1)
        e->lamp[0] = e->all;
    return status;
}

static void set_part_fractions_of_total(const struct glint_explain *e,
                                        struct glint_explain_part *part, int n)
{
    double stage[GLINT_COST_KINDS];

    for (int i = 0; i < n; i++) {
        part[i].work = compute_part_cost(&part[i], stage);
        part[i].share = e->all.flux > 0 ? part[i].flux / e->all.flux : 0;
        part[i].cost = e->all.work > 0 ? part[i].work / e->all.work : 0;
    }
}

/* ----------------------------------------------------------------- opening */

static void set_ghost_numbers(struct glint_explain *e)
{
    const int n = glint_frame_count_pupil_regions(e->frame);

    for (int k = 0; k < n; k++) {
        e->ghost_of[k] = glint_frame_find_ghost_number(e->frame, k);
        e->n_ghosts += e->ghost_of[k] == k;
    }
}

static int count_picture_tiles(const struct glint_frame *f)
{
    const int side = 1 << f->cfg.tile_log2;

    return ((f->view.width + side - 1) / side) *
           ((f->view.height + side - 1) / side);
}

/* Sets the costs of the frame and of its parts, which a model has drawn. */
static void set_costs(struct glint_explain *e)
{
    struct glint_frame *const frame = e->frame;
    const struct glint_cost_plan plan = glint_frame_make_cost_plan(frame);

    e->stage[GLINT_COST_PARTS] = compute_item_cost(
        GLINT_COST_PARTS,
        glint_cost_of(&plan, &plan.dials).count[GLINT_COST_PARTS]);
    e->stage[GLINT_COST_LIT] = compute_item_cost(GLINT_COST_LIT, e->all.lit);
    e->stage[GLINT_COST_STAR] = compute_item_cost(
        GLINT_COST_STAR, frame->star.is_set ? frame->star.pixels : 0);
    e->stage[GLINT_COST_VEIL] = compute_item_cost(
        GLINT_COST_VEIL,
        frame->veil.is_set ? glint_frame_veil_estimate_cost_px(frame) : 0);
    e->all.work = compute_part_cost(&e->all, e->stage);
    for (int k = GLINT_COST_PARTS; k < GLINT_COST_KINDS; k++)
        e->all.work += e->stage[k];
    e->all.cost = 1;
}

/* Returns the distance of LIGHT from the centre of LAMP, in major semi-axes of
 * the lamp. */
static double compute_distance_from_lamp(const struct glint_light *light,
                                         const struct glint_lamp *lamp)
{
    const double tangent = tan(lamp->theta_deg * (GLINT_PI / 180));
    const double scale = ldexp(light->sine_q30, -30) / light->cosine_q30;

    return hypot(scale * light->cos_q30 -
                     tangent * glint_cos_deg(lamp->phi_deg),
                 scale * light->sin_q30 -
                     tangent * glint_sin_deg(lamp->phi_deg)) /
           lamp->axis[0];
}

/* Returns the index of the lamp of CFG that LIGHT is a point of, or -1 if LIGHT
 * is not a point of a lamp of visible extent. */
static int find_lamp_of_point(const struct glint_explain_config *cfg,
                              const struct glint_light *light)
{
    double least = HUGE_VAL;
    int nearest = -1;

    for (int i = 0; i < cfg->n_lamps && light->apart_q30 > 0; i++) {
        const struct glint_lamp *const lamp = &cfg->lamps[i].lamp;
        const double distance = lamp->axis[0] > 0
                                    ? compute_distance_from_lamp(light, lamp)
                                    : HUGE_VAL;

        if (distance < least) {
            least = distance;
            nearest = i;
        }
    }
    return nearest;
}

/* Sets e->lamp_of and e->n_lamps. */
static enum glint_status
assign_lights_to_lamps(struct glint_explain *e,
                       const struct glint_explain_config *cfg)
{
    /* index of each lamp of CFG in e->lamp, plus 1; 0: it has no light yet */
    int *const number = calloc((size_t)cfg->n_lamps + 1, sizeof *number);

    if (!number)
        return GLINT_E_MEMORY;
    for (int i = 0; i < e->n_lights; i++) {
        const int lamp = find_lamp_of_point(cfg, &e->lights[i]);

        if (lamp < 0 || number[lamp] == 0)
            e->n_lamps++;
        if (lamp >= 0 && number[lamp] == 0)
            number[lamp] = e->n_lamps;
        e->lamp_of[i] = (lamp < 0 ? e->n_lamps : number[lamp]) - 1;
    }
    free(number);
    return GLINT_OK;
}

static enum glint_status allocate_parts(struct glint_explain *e)
{
    const size_t n_all = (size_t)glint_frame_count_pupil_regions(e->frame) + 1;
    const size_t n_lights = (size_t)e->n_lights + 1;

    e->ghost_of = malloc(n_all * sizeof *e->ghost_of);
    e->ghost = calloc(n_all, sizeof *e->ghost);
    e->light = calloc(n_lights, sizeof *e->light);
    e->lamp = calloc(n_lights, sizeof *e->lamp);
    e->lamp_of = calloc(n_lights, sizeof *e->lamp_of);
    e->wave = calloc((size_t)e->n_waves + 1, sizeof *e->wave);
    e->linear_q20 = calloc(count_frame_samples(e), sizeof *e->linear_q20);
    return e->ghost_of && e->ghost && e->light && e->lamp && e->lamp_of &&
                   e->wave && e->linear_q20
               ? GLINT_OK
               : GLINT_E_MEMORY;
}

/* Counts the bundles of all parts, then draws and measures the parts. */
static enum glint_status measure_frame(struct glint_explain *e,
                                       const struct glint_explain_config *cfg)
{
    struct parts parts = {.e = e, .cfg = cfg};
    enum glint_status status;

    if (e->lens)
        count_model_bundles(e);
    else
        e->frame->trace->account(e->frame, count_bundle, e);
    parts.sum = calloc(count_frame_samples(e), sizeof *parts.sum);
    status = parts.sum ? draw_and_measure_all_parts(&parts) : GLINT_E_MEMORY;
    free(parts.sum);
    return status;
}

static enum glint_status open_frame(struct glint_explain *e,
                                    struct glint_frame *frame, double unit,
                                    const struct glint_explain_config *cfg)
{
    const struct glint_wave_sets *const sets = frame->plan.rays.sets;
    enum glint_status status;

    *e = (struct glint_explain){.frame = frame,
                                .view = &frame->view,
                                .setup = frame->setup,
                                .lens = frame->lens,
                                .tints = frame->tints,
                                .lights = frame->lights.light,
                                .dim_codes = frame->plan.rays.dimmest.mantissa
                                                 ? frame->dials.dim_codes
                                                 : 0,
                                .set_size = sets ? sets->size : NULL,
                                .n_lights = frame->lights.n,
                                .n_waves = !frame->lens ? 0
                                           : sets       ? sets->n_sets
                                                  : frame->plan.rays.n_waves,
                                .unit = unit,
                                .tile_log2 = frame->cfg.tile_log2,
                                .n_tiles = count_picture_tiles(frame)};
    status = allocate_parts(e);
    if (status == GLINT_OK)
        status = assign_lights_to_lamps(e, cfg);
    if (status != GLINT_OK)
        return status;
    set_ghost_numbers(e);
    status = measure_frame(e, cfg);
    if (status != GLINT_OK)
        return status;
    if (e->lens)
        set_costs(e);
    e->all.share = e->all.flux > 0;
    set_part_fractions_of_total(e, e->ghost, e->n_ghosts);
    set_part_fractions_of_total(e, e->light, e->n_lights);
    set_part_fractions_of_total(e, e->lamp, e->n_lamps);
    set_part_fractions_of_total(e, e->wave, e->n_waves);
    return GLINT_OK;
}

enum glint_status glint_explain_open_for_frame(struct glint_explain *e,
                                               struct glint_frame *frame,
                                               double unit)
{
    const struct glint_explain_config cfg = {.n_lamps = 0};

    return open_frame(e, frame, unit, &cfg);
}

enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_engine *engine,
                                     const struct glint_explain_config *config)
{
    struct glint_frame *const f = &engine->paint.frame;

    return open_frame(explain, f,
                      config->gain > 0 && f->plan.scale > 0
                          ? config->gain / f->plan.scale
                          : 1,
                      config);
}

enum glint_status glint_explain_at(struct glint_explain *explain,
                                   struct glint_engine *engine,
                                   const struct glint_engine_lamp *lamps, int n,
                                   double scale, int width, int height)
{
    struct glint_frame *const own = calloc(1, sizeof *own);
    struct glint_image codes = {
        .format = GLINT_RGB24, .width = width, .height = height};
    uint8_t *const mem =
        calloc(glint_image_bytes(GLINT_RGB24, width, height), 1);
    struct glint_view view = engine->paint.frame.view;
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    *explain = (struct glint_explain){.own = own};
    if (n < 0 || n > engine->most_lamps) {
        free(mem);
        return GLINT_E_ARGUMENT;
    }
    view.width = width;
    view.height = height;
    if (own && mem) {
        glint_frame_init_like(own, &engine->paint.frame, view);
        own->tints = engine->paint.frame.tints;
        own->dials = own->asked = engine->paint.frame.dials;
        own->dials.dispersion_q8 = 0;
        glint_image_place(&codes, mem);
        status = GLINT_OK;
    }
    if (status == GLINT_OK && own->lens)
        status = glint_frame_draw(
            own, glint_engine_copy_ghost_lamps(engine, lamps, n), n, scale,
            &codes, &report);
    free(mem);
    if (status == GLINT_OK && own->lights.n > 0)
        status = glint_explain_open_for_frame(explain, own, 1);
    explain->own = own;
    return status;
}

void glint_explain_close(struct glint_explain *e)
{
    if (e->own)
        glint_frame_finish(e->own);
    free(e->own);
    free(e->ghost_of);
    free(e->ghost);
    free(e->light);
    free(e->lamp);
    free(e->lamp_of);
    free(e->wave);
    free(e->linear_q20);
}

int glint_explain_listed(const struct glint_explain *explain, int tile)
{
    return explain->lens
               ? glint_flare_listed(explain->frame->memory.flare, tile)
               : 0;
}

int glint_explain_is_beyond(const struct glint_explain *explain,
                            const struct glint_lamp *lamp)
{
    return explain->frame &&
           glint_frame_is_lamp_outside_model(explain->frame, lamp);
}

/* ------------------------------------------------------------------- order */

void glint_explain_sort(const struct glint_explain *e, int *ghosts)
{
    for (int i = 0; i < e->n_ghosts; i++) {
        int at = i;

        for (; at > 0 && e->ghost[ghosts[at - 1]].flux < e->ghost[i].flux; at--)
            ghosts[at] = ghosts[at - 1];
        ghosts[at] = i;
    }
}
