/* SPDX-License-Identifier: MIT */
#include "scenes/account.h"

#include <inttypes.h>
#include <stdlib.h>

#include "glint/scene/highlights.h"
#include "scenes/baked_scene.h"

/* By make scene-cost-fit: least squares of the relative errors of random scenes
 * that callgrind counts. tests/figures/scenes/told.md says how far they are
 * off. */
/* clang-format off */
const struct scene_cost_weight scene_cost_weight[GLINT_SCENE_ITEMS] = {
    /* begin weights */
    {"triangles", 3.34},
    {"touched", 0.0224},
    {"looked", 0.00776},
    {"rows", 4.78},
    {"samples", 0.0445},
    {"covering", 0.314},
    {"shaded", 0.295},
    {"meshed", 0.441},
    {"lit", 0.256},
    {"shadows", 0.0468},
    {"listed", 0.0598},
    {"rays", 0.228},
    {"aimed", 0.0377},
    {"asked", 0.184},
    {"entered", 0.441},
    {"walked", 0.165},
    {"tried", 0.175},
    {"texels", 0.158},
    {"skies", 0.37},
    {"metals", 0.651},
    {"fours", 0.511},
    {"nearest", 0.319},
    {"lobes", 0.436},
    {"bounced", 0.502},
    {"passed", 0.253},
    {"gathered", 0.37},
    {"spread", 0.00197},
    /* end weights */
};
static const struct scene_cost_weight rest_weight[SCENE_COST_RESTS] = {
    /* begin rest */
    {"picture", 0.00705},
    {"things", 0.974},
    {"faces", 0.384},
    {"around", 0.175},
    /* end rest */
};
/* clang-format on */

/* A pixel that a layer may touch, as for scene_cost_weight: what a frame of
 * tools/examples/scenes/walk.scene takes less where they are hidden. */
static const double layer_kinsn[GLINT_KINDS] = {[GLINT_KIND_SHELLS] = 1.09,
                                                [GLINT_KIND_LINES] = 0.45,
                                                [GLINT_KIND_BOX] = 0.63};

/* Returns the entries of lists that suns with shadows make of things that have
 * moved: triangles and balls, for each of them. */
static double things_of(const struct glint_scene_model *model)
{
    double n = 0, suns = 0;

    for (uint32_t i = 0; i < model->header->n_lights; i++)
        suns +=
            model->header->shadow && model->light[i].kind == GLINT_LIGHT_SUN;

    for (uint32_t i = 0; i < model->header->n_objects; i++)
        n += model->object[i].kind == GLINT_OBJECT_MESH
                 ? model->mesh[model->object[i].mesh].n_triangles
                 : 1;
    return suns * n;
}

/* Returns whether things show the picture that they stand in. */
static bool shows_picture(const struct glint_scene_model *model)
{
    bool any = false;

    for (uint32_t i = 0; i < model->header->n_materials; i++)
        any |= model->material[i].reflect_q15 ||
               (model->material[i].pass_q15 &&
                model->material[i].index_q16 != 1 << 16);
    return any && model->header->background == GLINT_BACKGROUND_CAMERA;
}

enum glint_status scene_account_make(struct scene_account *account,
                                     const struct scene_frame *frame)
{
    const size_t n = frame->model->header->n_objects;
    const double px = (double)frame->cfg.width * frame->cfg.height;

    *account = (struct scene_account){
        .objects = malloc((n + 1) * sizeof *account->objects),
        .seen = malloc((size_t)px * sizeof *account->seen),
        .rest = {px, things_of(frame->model), frame->stats.triangles,
                 shows_picture(frame->model) ? px : 0}};
    if (!account->objects || !account->seen) {
        scene_account_free(account);
        return GLINT_E_MEMORY;
    }
    glint_scene_account(frame->scene, account->objects, &account->all,
                        account->seen);
    glint_scene_account_layers(frame->scene, account->layer);
    return GLINT_OK;
}

void scene_account_free(struct scene_account *account)
{
    free(account->objects);
    free(account->seen);
    account->objects = NULL;
    account->seen = NULL;
}

double scene_cost_part(const struct glint_scene_part *part)
{
    double sum = 0;

    for (int k = 0; k < GLINT_SCENE_ITEMS; k++)
        sum += scene_cost_weight[k].kinsn * (double)part->count[k];
    return 1e-3 * sum;
}

double scene_cost_layer(const struct scene_account *account,
                        enum glint_scene_kind kind)
{
    return 1e-3 * layer_kinsn[kind] * (double)account->layer[kind].pixels;
}

double scene_cost_minsn(const struct scene_account *account)
{
    double sum = scene_cost_part(&account->all);

    for (int kind = 0; kind < GLINT_KINDS; kind++)
        sum += scene_cost_layer(account, (enum glint_scene_kind)kind);

    for (int k = 0; k < SCENE_COST_RESTS; k++)
        sum += 1e-3 * rest_weight[k].kinsn * account->rest[k];
    return sum;
}

int scene_covered_px(const struct scene_frame *frame)
{
    const int width = frame->cfg.width, height = frame->cfg.height;
    int64_t sum = 0;

    for (int y = 0; y < height; y += 8)
        for (int x = 0; x < width; x += 8) {
            const int w = width - x < 8 ? width - x : 8;
            const int h = height - y < 8 ? height - y : 8;

            sum += (int64_t)w * h *
                   glint_scene_cover(frame->scene, 256 * x + 128, 256 * y + 128,
                                     0);
        }
    return (int)((sum + 128) / 256);
}

/* Returns the millions of instructions that it says. */
static double counts_json(struct json_writer *json,
                          const struct scene_account *account)
{
    const int64_t *const n = account->all.count;
    const double minsn = scene_cost_minsn(account);

    json_write(
        json,
        "refs: %" PRId64 ", shaded_px: %" PRId64 ", samples: %" PRId64
        ", shadow_rays: %" PRId64 ", texels: %" PRId64 ", bounces: %" PRId64
        ", shells: %d, lines: %d, box_edges: %d, "
        "predicted_minsn: %.4f",
        n[GLINT_SCENE_TRIANGLES], n[GLINT_SCENE_SHADED], n[GLINT_SCENE_SAMPLED],
        n[GLINT_SCENE_SHADOWS] + n[GLINT_SCENE_RAYS], n[GLINT_SCENE_TEXELS],
        n[GLINT_SCENE_BOUNCED], account->layer[GLINT_KIND_SHELLS].n,
        account->layer[GLINT_KIND_LINES].n, account->layer[GLINT_KIND_BOX].n,
        minsn);
    return minsn;
}

/* Returns what of the memory of FRAME highlights take. */
static size_t highlight_bytes(const struct scene_frame *frame)
{
    struct glint_scene_config without = frame->cfg;

    without.highlights = 0;
    return frame->bytes - glint_scene_bytes(&without, frame->model);
}

/* Returns what of it maps of stones take. */
static size_t map_bytes(const struct scene_frame *frame)
{
    struct glint_scene_header header = *frame->model->header;
    struct glint_scene_model without = *frame->model;

    header.n_skins = header.n_stones = 0;
    without.header = &header;
    return frame->bytes - glint_scene_bytes(&frame->cfg, &without);
}

double scene_cost_json(struct json_writer *json,
                       const struct scene_frame *frame, size_t bytes)
{
    struct scene_account account;
    double minsn = 0;

    json_write(json, "objects: %u, drawn: %d, triangles: %d",
               frame->model->header->n_objects, frame->stats.objects,
               frame->stats.triangles);
    if (scene_account_make(&account, frame) == GLINT_OK) {
        minsn = counts_json(json, &account);
        scene_account_free(&account);
    }
    json_write(json, "covered_px: %d", scene_covered_px(frame));
    baked_scene_bytes(json, frame->model);
    json_write(json,
               "scene: %zu, arena: %zu, highlights: %zu, maps: %zu}, "
               "project_ms: %.3f, draw_ms: %.3f, map_ms: %.3f, map_texels: %d",
               bytes, frame->bytes, highlight_bytes(frame), map_bytes(frame),
               frame->project_ms, frame->draw_ms, frame->map_ms,
               frame->map_texels);
    return minsn;
}

void scene_highlights_json(struct json_writer *json,
                           const struct scene_frame *frame)
{
    struct glint_scene_highlight found[GLINT_SCENE_MAX_HIGHLIGHTS];
    const int n = glint_scene_find_highlights(frame->scene, found);

    json_write(json, "highlights: [");
    for (int i = 0; i < n; i++) {
        const struct glint_spot *const s = &found[i].spot;

        json_write(json, "{object: %s, x: %.3f, y: %.3f, power: %.4f}",
                   frame->model->object[found[i].object].name, s->x_q8 / 256.0,
                   s->y_q8 / 256.0, (double)s->power_q16 * 0x1p-16);
    }
    json_write(json, "]");
}
