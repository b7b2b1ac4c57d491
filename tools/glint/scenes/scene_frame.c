/* SPDX-License-Identifier: MIT */
#include "scenes/scene_frame.h"

#include <math.h>
#include <stdlib.h>

#include "glint/scene/account.h"

/* alignment of the run time's memory, bytes */
#define ALIGNMENT 64

/* ------------------------------------------------------ quality parameters */

void scene_dials_set_defaults(struct scene_dials *dials,
                              const struct glint_options *o)
{
    static const int edges[] = {1, 4, 8, 16}, points[] = {1, 4, 16};

    if (GLINT_OPTION_GIVEN(o, edge_samples))
        dials->edge_samples = edges[o->edge_samples];
    if (GLINT_OPTION_GIVEN(o, shadow_points))
        dials->shadow_points = points[o->shadow_points];
    dials->half_shading = o->shading == 1;
    if (GLINT_OPTION_GIVEN(o, ward_samples))
        dials->ward_samples = o->ward_samples;
    dials->has_highlights = GLINT_OPTION_GIVEN(o, highlights);
    dials->highlights = o->highlights;
}

static void set_frame_config(struct glint_scene_config *cfg,
                             const struct scene_dials *dials)
{
    if (dials->edge_samples)
        cfg->edge_samples = dials->edge_samples;
    if (dials->shadow_points)
        cfg->shadow_points = dials->shadow_points;
    cfg->half_shading = dials->half_shading;
    if (dials->ward_samples)
        cfg->ward_samples = dials->ward_samples;
    if (dials->has_highlights)
        cfg->highlights = dials->highlights;
    if (dials->tile_log2)
        cfg->tile_log2 = dials->tile_log2;
}

/* ------------------------------------------------------------------ memory */

static enum glint_status allocate_scene_memory(struct scene_frame *frame)
{
    const size_t bytes = glint_scene_bytes(&frame->cfg, frame->model);
    void *mem = NULL;
    enum glint_status status;

    if (!bytes)
        return GLINT_E_ARGUMENT;
    if (posix_memalign(&mem, ALIGNMENT, bytes))
        return GLINT_E_MEMORY;
    status =
        glint_scene_init(&frame->scene, &frame->cfg, frame->model, mem, bytes);
    if (status != GLINT_OK) {
        free(mem);
        return status;
    }
    free(frame->mem);
    frame->mem = mem;
    frame->bytes = bytes;
    frame->is_fresh = true;
    return GLINT_OK;
}

static int report_scene_status(const struct tool *tool,
                               enum glint_status status)
{
    return tool_fail(
        tool, status,
        status == GLINT_E_ARGUMENT
            ? "the field of view of the scene's camera is too large for a "
              "picture of this shape: its corner exceeds a tangent of 64"
            : NULL);
}

/* Rejects a scene if its picture, with all objects at the poses of the scene
 * file, needs more intersection tests than SCENE_TESTS, or than SCENE_TESTS_PX
 * per pixel if that is more. */
static int check_intersection_tests(struct scene_frame *frame)
{
    const int64_t px = (int64_t)frame->cfg.width * frame->cfg.height;
    const int64_t most =
        px * SCENE_TESTS_PX > SCENE_TESTS ? px * SCENE_TESTS_PX : SCENE_TESTS;
    struct glint_scene_stats stats;
    int64_t tests;

    glint_scene_begin(frame->scene, &stats);
    /* A triangle costs about one intersection test for each pixel of the tiles
     * that it touches. */
    tests = (int64_t)stats.need_refs << 2 * frame->cfg.tile_log2;
    if (tests <= most)
        tests += glint_scene_count_tests(frame->scene, most - tests);
    if (tests <= most)
        return EXIT_OK;
    tool_error(frame->tool,
               "a picture of this scene needs more than %g intersection tests, "
               "about %lld s of processor time; remove objects or lights, or "
               "set --shadow-points 1, 4 or 16, which lifts the limit",
               (double)most, (long long)(most / (SCENE_TESTS / 30)));
    scene_frame_close(frame);
    return EXIT_LENS;
}

int scene_frame_open(struct scene_frame *frame, const struct tool *tool,
                     const struct glint_scene_model *model,
                     const struct scene_dials *dials)
{
    enum glint_status status;

    *frame = (struct scene_frame){.tool = tool, .model = model};
    glint_scene_defaults(&frame->cfg, dials->width, dials->height);
    frame->cfg.workers = tool->workers;
    frame->cfg.sets = tool_enabled_instruction_sets(tool);
    set_frame_config(&frame->cfg, dials);
    frame->cfg.focal_q16 = llrint(fmin(dials->focal_px, 1e6) * 0x1p16);
    frame->cfg.parts = (struct glint_scene_parts){
        &glint_scene_meshes, &glint_scene_textures, &glint_scene_bounces,
        &glint_scene_wards,  &glint_scene_stones,   &glint_scene_highlights,
        &glint_scene_motions};
    status = allocate_scene_memory(frame);
    if (status != GLINT_OK)
        return report_scene_status(tool, status);
    return dials->is_bounded ? check_intersection_tests(frame) : EXIT_OK;
}

void scene_frame_close(struct scene_frame *frame)
{
    free(frame->mem);
    *frame = (struct scene_frame){.mem = NULL};
}

/* Calls POSE if needed and prepares a frame. */
static void prepare_frame(struct scene_frame *frame)
{
    if (frame->pose && frame->is_fresh)
        frame->pose(frame->pose_ctx, frame->scene);
    frame->is_fresh = false;
    glint_scene_begin(frame->scene, &frame->stats);
}

enum glint_status scene_frame_draw_once(struct scene_frame *frame,
                                        const struct glint_image *image)
{
    const double start = tool_clock_s();
    double begun, spread;

    prepare_frame(frame);
    if (frame->stats.dropped_objects > 0) {
        enum glint_status status;

        frame->cfg.max_refs = frame->stats.need_refs;
        status = allocate_scene_memory(frame);
        if (status != GLINT_OK)
            return status;
        prepare_frame(frame);
    }
    begun = tool_clock_s();
    frame->map_texels = glint_scene_spread(frame->scene);
    spread = tool_clock_s();
    glint_scene_look_around(frame->scene, image);
    glint_scene_draw(frame->scene, image);
    frame->project_ms = 1e3 * (begun - start);
    frame->map_ms = 1e3 * (spread - begun);
    frame->draw_ms = 1e3 * (tool_clock_s() - spread);
    return GLINT_OK;
}

int scene_frame_draw(struct scene_frame *frame, const struct glint_image *image)
{
    const enum glint_status status = scene_frame_draw_once(frame, image);

    return status == GLINT_OK ? EXIT_OK
                              : report_scene_status(frame->tool, status);
}
