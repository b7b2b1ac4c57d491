/* SPDX-License-Identifier: MIT */
#include "glint/explain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine_parts.h"
#include "engine/explain_frame.h"
#include "engine/frame/frame_parts.h"

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
    int64_t sum = 0, most = 0;

    part->x0 = view->width;
    part->y0 = view->height;
    part->x1 = part->y1 = -1;
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++, px += 3) {
            const int64_t here = (int64_t)px[0] + px[1] + px[2];

            if ((px[0] | px[1] | px[2]) == 0)
                continue;
            part->lit++;
            part->x0 = min_int(part->x0, x);
            part->y0 = min_int(part->y0, y);
            part->x1 = max_int(part->x1, x);
            part->y1 = max_int(part->y1, y);
            sum += here;
            most = here > most ? here : most;
        }
    part->tiles = e->lens ? glint_flare_tiles(e->frame->memory.flare) : 0;
    part->flux = (double)sum / 3 * 0x1p-20 * e->unit;
    part->brightest = (double)most / 3 * 0x1p-20 * e->unit;
}

/* Draws and measures PART of the frame if any of its ray bundles is drawn. */
static enum glint_status draw_and_measure_part(struct glint_explain *e,
                                               struct glint_explain_part *part,
                                               int ghost, int light, int wave)
{
    enum glint_status status;

    if (glint_explain_drawn(part) == 0)
        return GLINT_OK;
    status = draw_flare_part(e, ghost, light, wave);
    if (status == GLINT_OK)
        measure_part_light(e, part);
    return status;
}

/* Draws and measures each ghost, and measures their sum, which costs less than
 * to draw all again if rays are exact. */
static enum glint_status measure_ghosts_and_sum(struct glint_explain *e)
{
    const size_t n =
        3 * (size_t)e->frame->view.width * (size_t)e->frame->view.height;
    int32_t *const part = e->linear_q20, *const sum = calloc(n, sizeof *sum);
    enum glint_status status = sum ? GLINT_OK : GLINT_E_MEMORY;

    for (int i = 0; i < e->n_ghosts && status == GLINT_OK; i++) {
        status = draw_and_measure_part(e, &e->ghost[i], i, -1, -1);
        for (size_t k = 0; k < n && e->ghost[i].lit > 0; k++) {
            const int64_t light = (int64_t)sum[k] + part[k];

            sum[k] = (int32_t)(light < INT32_MAX ? light : INT32_MAX);
        }
    }
    if (status == GLINT_OK && !e->lens) {
        e->linear_q20 = sum;
        measure_part_light(e, &e->all);
        e->linear_q20 = part;
    }
    free(sum);
    return status;
}

static enum glint_status draw_and_measure_all_parts(struct glint_explain *e)
{
    enum glint_status status = measure_ghosts_and_sum(e);
    const int n_lights = !e->lens && e->n_lights == 1 ? 0 : e->n_lights;

    if (n_lights < e->n_lights)
        e->light[0] = e->all;
    for (int i = 0; i < n_lights && status == GLINT_OK; i++)
        status = draw_and_measure_part(e, &e->light[i], -1, i, -1);
    for (int i = 0; i < e->n_waves && status == GLINT_OK; i++)
        status = draw_and_measure_part(e, &e->wave[i], -1, -1, i);
    if (!e->lens || status != GLINT_OK)
        return status;
    return draw_and_measure_part(e, &e->all, -1, -1, -1);
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
    const struct glint_setup *s = e->frame->setup;

    e->n_ghosts = s->n_ghosts - s->n_parts;
    for (int k = 0; k < s->n_ghosts; k++)
        e->ghost_of[k] = glint_frame_find_ghost_number(s, k);
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

enum glint_status glint_explain_open_for_frame(struct glint_explain *e,
                                               struct glint_frame *frame,
                                               double unit)
{
    const size_t n_all = (size_t)frame->setup->n_ghosts + 1;
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
    e->ghost_of = malloc(n_all * sizeof *e->ghost_of);
    e->ghost = calloc(n_all, sizeof *e->ghost);
    e->light = calloc((size_t)e->n_lights + 1, sizeof *e->light);
    e->wave = calloc((size_t)e->n_waves + 1, sizeof *e->wave);
    e->linear_q20 =
        calloc(3 * (size_t)frame->view.width * (size_t)frame->view.height,
               sizeof *e->linear_q20);
    if (!e->ghost_of || !e->ghost || !e->light || !e->wave || !e->linear_q20)
        return GLINT_E_MEMORY;
    set_ghost_numbers(e);
    if (e->lens)
        count_model_bundles(e);
    else
        frame->trace->account(frame, count_bundle, e);
    status = draw_and_measure_all_parts(e);
    if (status != GLINT_OK)
        return status;
    if (e->lens)
        set_costs(e);
    e->all.share = e->all.flux > 0;
    set_part_fractions_of_total(e, e->ghost, e->n_ghosts);
    set_part_fractions_of_total(e, e->light, e->n_lights);
    set_part_fractions_of_total(e, e->wave, e->n_waves);
    return GLINT_OK;
}

enum glint_status glint_explain_open(struct glint_explain *explain,
                                     struct glint_engine *engine, double gain)
{
    struct glint_frame *const f = &engine->paint.frame;

    return glint_explain_open_for_frame(
        explain, f, gain > 0 && f->plan.scale > 0 ? gain / f->plan.scale : 1);
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
