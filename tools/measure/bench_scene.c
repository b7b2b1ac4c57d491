/* SPDX-License-Identifier: MIT
 *
 * glint bench --scene: measures the time of drawing a scene onto frames, per
 * stage.
 */
#include <math.h>
#include <stdlib.h>

#include "measure/bench.h"
#include "options/command_line.h"
#include "options/json_writer.h"
#include "scenes/account.h"
#include "scenes/baked_scene.h"
#include "scenes/scene_frame.h"

static const char help[] =
    "glint bench --scene NAME.scene|BAKED [options]\n"
    "\n"
    "Measures the time of drawing a scene onto frames of 8-bit video, per\n"
    "stage, and compares it with the memory floor, like glint bench for\n"
    "flares. All cases are measured in turns; prints medians and their ratios\n"
    "to the floor. Stages: prepare lists visible objects and shadows, as if\n"
    "an object had moved; around makes a small copy of the picture for\n"
    "mirrors and glass; draw; shadows, the part of draw that a scene without\n"
    "shadows saves; lights, the visibility of the scene's lights to the lens.\n"
    "\n"
    "  --size WxH          default 1920x1080\n"
    "  --repeat N          rounds, 1 to 100 (default 15)\n"
    "  --format F          yuyv (default) | i420 | nv12 | rgb24 | xrgb8888 |\n"
    "                      rgb565\n";

/* DRAW includes SHADOWS, the additional time of shadows. WHOLE is the sum of
 * all stages. */
enum { PREPARE, AROUND, DRAW, SHADOWS, LIGHTS, WHOLE };

struct opened {
    const char *file;
    /* bare: copy of the scene without shadows; only set if it has shadows */
    struct baked_scene scene, bare;
};

struct scene_case {
    struct bench_case base;
    struct scene_frame frame, bare;
    int covered_px;
};

/* ------------------------------------------------------------------- cases */

/* Sets the first object to its current position. This invalidates the shadow
 * lists, so that each frame rebuilds them, as for a moving object. */
static void invalidate_shadows(void *ctx, struct glint_scene *scene)
{
    const struct scene_frame *const frame = ctx;
    const struct glint_scene_model *const model = frame->model;

    if (model->header->n_objects > 0)
        glint_scene_set_pose(scene, 0, model->object[0].at,
                             model->object[0].turn_q30);
}

/* Opens FRAME of MODEL and draws one frame, which allocates all memory. */
static int open_bench_frame(struct bench *b, struct scene_frame *frame,
                            const struct glint_scene_model *model,
                            const struct scene_dials *dials)
{
    int code = scene_frame_open(frame, b->tool, model, dials);

    frame->pose = invalidate_shadows;
    frame->pose_ctx = frame;
    canvas_restore_background(&b->canvas);
    return code == EXIT_OK ? scene_frame_draw(frame, &b->canvas.image) : code;
}

static int add_bench_case(struct bench *b)
{
    struct opened *const o = b->opened;
    struct scene_dials dials = {.width = b->width,
                                .height = b->height,
                                .edge_samples = 4,
                                .shadow_points = 4};
    struct scene_case *const t =
        (struct scene_case *)bench_add_case(b, o->scene.model.header->name);
    int code;

    if (!t)
        return tool_fail(b->tool, GLINT_E_MEMORY, NULL);
    scene_dials_set_defaults(&dials, &b->base.options);
    code = open_bench_frame(b, &t->frame, &o->scene.model, &dials);
    if (code == EXIT_OK && o->bare.data)
        code = open_bench_frame(b, &t->bare, &o->bare.model, &dials);
    if (code == EXIT_OK)
        t->covered_px = scene_count_covered_px(&t->frame);
    return code;
}

/* ------------------------------------------------------------------ rounds */

/* Draws a frame. Sets AT_S to the start times of all stages, s, followed by the
 * end time of the last. */
static void time_frame_stages(struct scene_frame *frame,
                              const struct glint_image *image, double at_s[5])
{
    struct glint_scene_lamp lamps[GLINT_SCENE_MAX_LIGHTS];

    at_s[0] = tool_clock_s();
    scene_frame_prepare(frame);
    at_s[1] = tool_clock_s();
    glint_scene_look_around(frame->scene, image);
    at_s[2] = tool_clock_s();
    glint_scene_draw(frame->scene, image);
    at_s[3] = tool_clock_s();
    glint_scene_lights(frame->scene, lamps);
    at_s[4] = tool_clock_s();
}

static enum glint_status draw_bench_frame(struct bench *b, struct bench_case *c,
                                          int round)
{
    static const int span[][3] = {{PREPARE, 0, 1},
                                  {AROUND, 1, 2},
                                  {DRAW, 2, 3},
                                  {LIGHTS, 3, 4},
                                  {WHOLE, 0, 4}};
    struct scene_case *const t = (struct scene_case *)c;
    double at_s[5];

    time_frame_stages(&t->frame, &b->canvas.image, at_s);
    for (size_t i = 0; i < sizeof span / sizeof *span; i++)
        c->ms[span[i][0]][round] = 1e3 * (at_s[span[i][2]] - at_s[span[i][1]]);
    c->ms[SHADOWS][round] = 0;
    if (t->bare.scene) {
        canvas_restore_background(&b->canvas);
        time_frame_stages(&t->bare, &b->canvas.image, at_s);
        c->ms[SHADOWS][round] = c->ms[DRAW][round] - 1e3 * (at_s[3] - at_s[2]);
    }
    return GLINT_OK;
}

/* ----------------------------------------------------------------- opening */

/* Sets o->bare to a copy of the scene without shadows. Returns an exit code. */
static int open_scene_without_shadows(struct bench *b, struct opened *o)
{
    const int code = baked_scene_open(b->tool, o->file, &o->bare);

    /* The checksum was verified when the scene was opened, so the header may
     * be changed. */
    if (code == EXIT_OK)
        ((struct glint_scene_header *)o->bare.data)->shadow = 0;
    return code;
}

static int open_bench_scene(struct bench *b, int n, const char *const *name)
{
    struct opened *const o = b->opened;
    int code;

    if (n > 0)
        return tool_usage(b->tool, "--scene accepts no lens, not '%s'", *name);
    code = baked_scene_open(b->tool, o->file, &o->scene);
    if (code != EXIT_OK)
        return code;
    if (o->scene.model.header->camera.kind == GLINT_CAMERA_LENS)
        return tool_usage(b->tool,
                          "%s: 'camera lens' needs the lens of a flare; here "
                          "use 'camera fov'",
                          o->file);
    if (o->scene.model.header->shadow)
        code = open_scene_without_shadows(b, o);
    if (code != EXIT_OK)
        return code;
    return add_bench_case(b);
}

static void close_bench_case(struct bench_case *c)
{
    struct scene_case *const t = (struct scene_case *)c;

    scene_frame_close(&t->frame);
    scene_frame_close(&t->bare);
}

static void close_bench_scene(struct bench *b)
{
    struct opened *const o = b->opened;

    if (!o)
        return;
    baked_scene_close(&o->scene);
    baked_scene_close(&o->bare);
    free(o);
}

/* ------------------------------------------------------------------ output */

static const char *get_shading_method_name(const struct scene_case *t)
{
    return t->frame.cfg.half_shading ? "half" : "full";
}

static void print_bench_case(const struct bench *b, const struct bench_case *c)
{
    const struct scene_case *const t = (const struct scene_case *)c;
    const struct glint_scene_config *const cfg = &t->frame.cfg;

    printf("%-16.16s %4dx%-4d %5d %6d %-7s %2d %-5s", c->name, cfg->width,
           cfg->height, cfg->edge_samples, cfg->shadow_points,
           get_shading_method_name(t), bench_get_threads(b), b->tool->kernels);
}

static void print_bench_result(const struct bench *b,
                               const struct bench_case *c)
{
    const struct scene_case *const t = (const struct scene_case *)c;
    const struct opened *const o = b->opened;

    printf("%7d %7.2f", t->covered_px,
           (double)(t->frame.bytes + o->scene.bytes) / (1 << 20));
}

static void write_bench_json(struct json_writer *to, const struct bench *b,
                             const struct bench_case *c)
{
    const struct scene_case *const t = (const struct scene_case *)c;
    const struct glint_scene_config *const cfg = &t->frame.cfg;
    const struct opened *const o = b->opened;

    bench_write_json_format(to, b);
    json_write(to,
               "edge_samples: %d, shadow_points: %d, shading: %s, threads: %d, "
               "kernels: %s",
               cfg->edge_samples, cfg->shadow_points,
               get_shading_method_name(t), bench_get_threads(b),
               b->tool->kernels);
    bench_write_json_times(to, b, c);
    json_write(to,
               "whole_ms: %.4f, covered_px: %d, "
               "triangles: %d, arena_bytes: %zu, model_bytes: %zu",
               bench_compute_median_ms(b, c, WHOLE), t->covered_px,
               t->frame.stats.triangles, t->frame.bytes, o->scene.bytes);
}

/* ----------------------------------------------------------------- options */

static const struct option own[] = {
    {"scene", required_argument, NULL, BENCH_OWN}, BENCH_OPTIONS};

static int parse_bench_option(struct bench *b, int c, const char *value)
{
    struct opened *o = b->opened;

    if (c != BENCH_OWN)
        return -2;
    if (!o) {
        o = b->opened = calloc(1, sizeof *o);
        if (!o)
            return 0;
    }
    o->file = value;
    return *value != '\0';
}

const struct bench_subject bench_scene = {
    .word = "scene",
    .help = help,
    .own = own,
    .groups = ENGINE_GROUP(SHADING),
    .max_rounds = 100,
    .n_stages = WHOLE + 1,
    .stage = {"prepare", "around", "draw", "shadows", "lights", "whole"},
    .heads = "scene                 size edges points shading th sets ",
    .tail = " covers     MiB",
    .case_bytes = sizeof(struct scene_case),
    .take = parse_bench_option,
    .open = open_bench_scene,
    .draw = draw_bench_frame,
    .print_case = print_bench_case,
    .print_result = print_bench_result,
    .json = write_bench_json,
    .close_case = close_bench_case,
    .close = close_bench_scene};
