/* SPDX-License-Identifier: MIT */
#include "scenes/account.h"

#include <inttypes.h>
#include <stdlib.h>

#include "glint/scene/highlights.h"
#include "scenes/baked_scene.h"

const char *const scene_item_name[GLINT_SCENE_ITEMS] = {
    "triangles", "samples", "covering", "shaded",
    "shadows",   "texels",  "lookups",  "bounced"};

enum glint_status scene_account_collect_costs(struct scene_account *account,
                                              const struct scene_frame *frame)
{
    const size_t n = frame->model->header->n_objects;
    const size_t px = (size_t)frame->cfg.width * (size_t)frame->cfg.height;
    /* finds which object covers another */
    int16_t *const seen = malloc(px * sizeof *seen);

    *account = (struct scene_account){
        .objects = malloc((n + 1) * sizeof *account->objects)};
    if (!account->objects || !seen) {
        free(seen);
        scene_account_free(account);
        return GLINT_E_MEMORY;
    }
    glint_scene_account(frame->scene, account->objects, &account->all, seen);
    free(seen);
    glint_scene_account_layers(frame->scene, account->layer);
    return GLINT_OK;
}

void scene_account_free(struct scene_account *account)
{
    free(account->objects);
    account->objects = NULL;
}

/* Returns the number of pixels that objects cover in the frame drawn last. */
static int count_covered_px(const struct scene_frame *frame)
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

static void write_counts_json(struct json_writer *json,
                              const struct scene_account *account)
{
    const int64_t *const n = account->all.count;

    json_write(
        json,
        "refs: %" PRId64 ", shaded_px: %" PRId64 ", samples: %" PRId64
        ", shadow_rays: %" PRId64 ", texels: %" PRId64 ", bounces: %" PRId64
        ", shells: %d, lines: %d, box_edges: %d",
        n[GLINT_SCENE_TRIANGLES], n[GLINT_SCENE_SHADED], n[GLINT_SCENE_SAMPLED],
        n[GLINT_SCENE_SHADOWS], n[GLINT_SCENE_TEXELS], n[GLINT_SCENE_BOUNCED],
        account->layer[GLINT_KIND_SHELLS].n, account->layer[GLINT_KIND_LINES].n,
        account->layer[GLINT_KIND_BOX].n);
}

static size_t count_highlight_search_bytes(const struct scene_frame *frame)
{
    struct glint_scene_config without = frame->cfg;

    without.highlights = 0;
    return frame->bytes - glint_scene_bytes(&without, frame->model);
}

static size_t count_light_map_bytes(const struct scene_frame *frame)
{
    struct glint_scene_header header = *frame->model->header;
    struct glint_scene_model without = *frame->model;

    header.n_skins = header.n_stones = 0;
    without.header = &header;
    return frame->bytes - glint_scene_bytes(&frame->cfg, &without);
}

void scene_account_write_json(struct json_writer *json,
                              const struct scene_frame *frame, size_t bytes)
{
    struct scene_account account;

    json_write(json, "objects: %u, drawn: %d, triangles: %d",
               frame->model->header->n_objects, frame->stats.objects,
               frame->stats.triangles);
    if (scene_account_collect_costs(&account, frame) == GLINT_OK) {
        write_counts_json(json, &account);
        scene_account_free(&account);
    }
    json_write(json, "covered_px: %d", count_covered_px(frame));
    baked_scene_write_byte_counts(json, frame->model);
    json_write(json,
               "scene: %zu, arena: %zu, highlights: %zu, maps: %zu}, "
               "project_ms: %.3f, draw_ms: %.3f, map_ms: %.3f, map_texels: %d",
               bytes, frame->bytes, count_highlight_search_bytes(frame),
               count_light_map_bytes(frame), frame->project_ms, frame->draw_ms,
               frame->map_ms, frame->map_texels);
}

void scene_write_highlights_json(struct json_writer *json,
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
