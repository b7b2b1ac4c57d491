/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "engine/measure.h"
#include "reference/scenes/scene_sweep.h"
#include "reference/scenes/twin.h"

/* What scenes are compared over: light grey, on which shadows show. */
#define BEHIND 0.25F

/* Of metal, for each point of a pixel, without footprints. */
enum { EXACT_LOOKUPS = 256 };

static size_t values(const struct scene_sweep *s)
{
    return 3 * (size_t)s->width * (size_t)s->height;
}

/* ------------------------------------------------------------------ timing */

static int open_trials(struct scene_sweep *s)
{
    struct tool tool = *s->tool;
    int code = EXIT_OK;

    if (!tool.n_threads)
        tool.workers = s->one;
    s->trial = calloc(SCENE_POINTS, sizeof *s->trial);
    if (!s->trial ||
        canvas_init(&s->canvas, GLINT_YUYV, s->width, s->height) != GLINT_OK)
        return tool_fail(s->tool, GLINT_E_MEMORY, NULL);
    for (int i = 0; i < s->n_points && code == EXIT_OK; i++) {
        struct scene_point *const p = &s->point[i];
        const struct scene_dials dials = {
            .width = s->width,
            .height = s->height,
            .edge_samples = p->value[SCENE_EDGES],
            .shadow_points = p->value[SCENE_SHADOWED],
            .half_shading = p->value[SCENE_SHADING] == 2,
            .ward_samples = p->value[SCENE_LOOKUPS],
            .ward_nearest = p->value[SCENE_LEVELS] == 1,
            .stone_frames = p->value[SCENE_FRAMES]};

        p->trial = &s->trial[i];
        code = scene_trial_open(p->trial, &tool, &p->scene->model, NULL, &dials,
                                &s->canvas);
    }
    return code;
}

/* Runs P: where maps are worked out every few frames, so many, and notes their
 * mean. */
static void run(const struct scene_sweep *s, const struct scene_point *p,
                int round)
{
    const int n = p->value[SCENE_FRAMES] > 1 ? p->value[SCENE_FRAMES] : 1;
    double ms = 0, instructions = 0;

    for (int i = 0; i < n; i++) {
        if (s->count_only)
            printf("%d\n", (int)(p - s->point));
        stone_sweep_stir(p, round * n + i);
        scene_trial_run(p->trial, s->counter, round);
        ms += p->trial->ms[SCENE_WHOLE][round] / n;
        instructions += p->trial->instructions / n;
    }
    p->trial->ms[SCENE_WHOLE][round] = ms;
    p->trial->instructions = instructions;
}

/* Times all points, in turns with the memory floor. */
static enum glint_status time_all(struct scene_sweep *s,
                                  struct tool_progress *progress)
{
    const int n = s->count_only ? 1 : s->rounds;
    enum glint_status status = GLINT_OK;

    for (int i = 0; i < s->n_points && status == GLINT_OK; i++)
        status = scene_trial_warm(s->point[i].trial);
    for (int round = 0; round < n && status == GLINT_OK; round++) {
        s->floor_ms[round] = canvas_floor_ms(&s->canvas);
        for (int i = 0; i < s->n_points; i++)
            run(s, &s->point[i], round);
        tool_progress_show(progress, 0.5 * (round + 1) / n);
    }
    for (int i = 0; i < s->n_points && status == GLINT_OK; i++) {
        struct scene_point *const p = &s->point[i];

        p->ms = canvas_median(p->trial->ms[SCENE_WHOLE], n);
        p->ratio = p->ms / canvas_median(s->floor_ms, n);
        p->instructions = p->trial->instructions;
    }
    return status;
}

/* ---------------------------------------------------------------- pictures */

/* Draws the exact picture. */
static enum glint_status draw_exact(struct scene_sweep *s)
{
    const struct twin_view view = {s->width, s->height, 0, s->samples};
    const size_t n = values(s);
    struct twin_pixel *pixels = malloc(n / 3 * sizeof *pixels);
    enum glint_status status = GLINT_E_MEMORY;
    struct twin twin;

    if (pixels)
        status = twin_open(&twin, s->text);
    if (status == GLINT_OK) {
        twin.rows = s->rows[0].r ? s->rows : NULL;
        twin.shadow_points = 16;
        twin.ward_samples = EXACT_LOOKUPS;
        twin_render(&twin, &view, s->tool->workers, pixels);
        twin_close(&twin);
        for (size_t i = 0; i < n; i++)
            s->exact.rgb[i] =
                pixels[i / 3].rgb[i % 3] + (1 - pixels[i / 3].cover) * BEHIND;
    }
    free(pixels);
    return status;
}

/* Draws P to s->got. Mirrors show black where they meet nothing, as the exact
 * picture has it. */
static enum glint_status draw_point(struct scene_sweep *s,
                                    const struct scene_point *p)
{
    const size_t n = values(s);
    struct glint_image linear = {
        .format = GLINT_LINEAR_Q20, .width = s->width, .height = s->height};
    int32_t *const light_q20 = malloc(n * sizeof *light_q20);

    if (!light_q20)
        return GLINT_E_MEMORY;
    for (size_t i = 0; i < n; i++)
        light_q20[i] = (int32_t)(BEHIND * 0x1p20F);
    glint_image_place(&linear, light_q20);
    stone_sweep_age(p);
    scene_frame_begin(&p->trial->frame);
    glint_scene_look_around(p->trial->frame.scene, NULL);
    glint_scene_draw(p->trial->frame.scene, &linear);
    for (size_t i = 0; i < n; i++)
        s->got.rgb[i] = (float)light_q20[i] * 0x1p-20F;
    free(light_q20);
    return GLINT_OK;
}

/* Returns the means of s->by x s->by pixels of CODES; of OTHER, unless it is
 * NULL, 16 times what CODES differ from it, about grey. NULL without memory. */
static uint8_t *shrink(const struct scene_sweep *s, const uint8_t *codes,
                       const uint8_t *other)
{
    const int w = s->shrunk_width, h = s->shrunk_height, by = s->by;
    uint8_t *const to = malloc(3 * (size_t)w * (size_t)h);

    for (int i = 0; to && i < 3 * w * h; i++) {
        const int x = i / 3 % w * by, y = i / 3 / w * by;
        int sum = by * by / 2;

        for (int k = 0; k < by * by; k++) {
            const size_t at = 3 * ((size_t)(y + k / by) * (size_t)s->width +
                                   (size_t)(x + k % by)) +
                              (size_t)(i % 3);
            const int far =
                other ? 128 + 16 * (codes[at] - other[at]) : codes[at];

            sum += far < 0 ? 0 : far > 255 ? 255 : far;
        }
        to[i] = (uint8_t)(sum / (by * by));
    }
    return to;
}

/* Checks whether the page shows P: --budget comes by there, or it is as usual.
 */
static bool is_pictured(const struct scene_point *p)
{
    return p->quality >= 0 || p->kind == SCENE_STANDARD;
}

static enum glint_status keep_picture(struct scene_sweep *s,
                                      struct scene_point *p)
{
    uint8_t *const codes = glint_measure_encode(&s->got, 1);

    if (codes) {
        p->rgb = shrink(s, codes, NULL);
        p->difference = shrink(s, codes, s->exact_codes);
    }
    free(codes);
    return p->rgb && p->difference ? GLINT_OK : GLINT_E_MEMORY;
}

static enum glint_status compare(struct scene_sweep *s, struct scene_point *p)
{
    struct glint_measure m;

    if (!glint_measure_at(&s->exact, &s->got, false, 1, &m))
        return GLINT_E_MEMORY;
    p->psnr_db = m.psnr_db;
    p->ssim = m.ssim;
    p->p99 = m.p99;
    p->flux_error = m.flux - 1;
    return is_pictured(p) ? keep_picture(s, p) : GLINT_OK;
}

static enum glint_status compare_all(struct scene_sweep *s,
                                     struct tool_progress *progress)
{
    enum glint_status status = GLINT_E_MEMORY;

    s->by = s->width > 2 * SCENE_SHRUNK ? s->width / SCENE_SHRUNK : 1;
    s->shrunk_width = s->width / s->by;
    s->shrunk_height = s->height / s->by > 0 ? s->height / s->by : 1;
    s->exact = (struct glint_float_image){s->width, s->height,
                                          malloc(values(s) * sizeof(float))};
    s->got = s->exact;
    s->got.rgb = malloc(values(s) * sizeof(float));
    if (s->exact.rgb && s->got.rgb)
        status = draw_exact(s);
    if (status != GLINT_OK)
        return status;
    s->exact_codes = glint_measure_encode(&s->exact, 1);
    if (!s->exact_codes || !(s->exact_rgb = shrink(s, s->exact_codes, NULL)))
        return GLINT_E_MEMORY;
    tool_progress_show(progress, 0.75);
    for (int i = 0; i < s->n_points && status == GLINT_OK; i++) {
        status = draw_point(s, &s->point[i]);
        if (status == GLINT_OK)
            status = compare(s, &s->point[i]);
    }
    return status;
}

int scene_sweep_measure(struct scene_sweep *s)
{
    struct glint_described_stone old[GLINT_DESCRIPTION_MAX_STONES] = {{0}};
    struct tool_progress progress;
    enum glint_status status;
    int code = open_trials(s);

    if (code == EXIT_OK && !s->count_only)
        code = stone_sweep_exact(s, old);
    if (code != EXIT_OK) {
        stone_sweep_restore(s, old);
        return code;
    }
    tool_progress_start(&progress, s->tool, "sweep");
    status = time_all(s, &progress);
    if (status == GLINT_OK && !s->count_only)
        status = compare_all(s, &progress);
    tool_progress_end(&progress);
    stone_sweep_restore(s, old);
    return status == GLINT_OK ? EXIT_OK : tool_fail(s->tool, status, NULL);
}

void scene_sweep_free(struct scene_sweep *s)
{
    for (int i = 0; i < s->n_points; i++) {
        if (s->point[i].trial)
            scene_trial_close(s->point[i].trial);
        free(s->point[i].rgb);
        free(s->point[i].difference);
    }
    free(s->trial);
    canvas_finish(&s->canvas);
    free(s->exact.rgb);
    free(s->got.rgb);
    free(s->exact_codes);
    free(s->exact_rgb);
}
