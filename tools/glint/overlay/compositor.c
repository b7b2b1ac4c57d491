/* SPDX-License-Identifier: MIT */
#include "overlay/compositor_layer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "desk/preview.h"
#include "lamp_files/lamp_keys.h"
#include "formats/paint.h"
#include "overlay/show_lights.h"
#include "model/response_cache.h"

/* ------------------------------------------------------------------- making */

/* Makes the list of lamps: the rows of the file, linked if lamps move between
 * them, and the lamps by pixel. */
static enum glint_status open_list(struct compositor *compositor,
                                   struct glint_error *error)
{
    enum glint_status status = GLINT_OK;

    if (compositor->settings.options.lights)
        status = lamp_list_read(&compositor->list,
                                compositor->settings.options.lights, error);
    if (status == GLINT_OK && compositor->settings.options.interpolate)
        status = lamp_keys_link(&compositor->list);
    for (int i = 0; i < compositor->at.n && status == GLINT_OK; i++)
        status = lamp_list_add(&compositor->list, &compositor->at.row[i]);
    compositor->is_listed =
        compositor->settings.options.lights || compositor->at.n > 0;
    return status;
}

/* Opens the scene; without a lens there has to be one that needs none. */
static int open_scene(const struct tool *tool, struct compositor *compositor)
{
    const int code = over_scene_open(&compositor->scene, tool);

    if (code != EXIT_OK || compositor->has_lens)
        return code;
    if (!compositor->scene.is_open)
        return tool_usage(tool, "--lens none draws no flare, and there is no "
                                "--scene to draw");
    if (over_scene_needs_lens(&compositor->scene))
        return tool_usage(tool,
                          "%s: 'camera lens' has the field of a lens, and "
                          "--lens none is none; take 'camera fov'",
                          compositor->scene.file);
    return compositor->settings.options.layer != GLINT_LAYER_COMPOSITE
               ? tool_usage(tool, "--layer shows the flare of a lens, not of "
                                  "--lens none")
               : EXIT_OK;
}

int compositor_open(const struct tool *tool, struct compositor *compositor)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    int code = compositor_desk_open_keys(tool, compositor);
    size_t n;

    compositor->has_lens =
        strcmp(compositor->settings.options.lens, "none") != 0;
    if (code == EXIT_OK)
        code = compositor_zoom_begin(tool, compositor);
    if (code == EXIT_OK)
        code = open_scene(tool, compositor);
    if (code == EXIT_OK && compositor->has_lens)
        code = compositor_zoom_lines(tool, compositor);
    if (code == EXIT_OK && compositor->has_lens)
        code = settings_open(tool, &compositor->settings,
                             compositor->settings.options.lens);
    if (code != EXIT_OK || !compositor->has_lens)
        return code;
    status = open_list(compositor, &error);
    if (status == GLINT_OK && compositor->settings.options.save_lights)
        status =
            lamp_save_open(&compositor->save,
                           compositor->settings.options.save_lights, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    code = compositor_desk_open(tool, compositor);
    if (code != EXIT_OK)
        return code;
    n = (size_t)compositor->n_hand + (size_t)compositor->list.n +
        GLINT_ENGINE_MAX_LAMPS +
        (compositor->scene.is_open ? OVER_SCENE_LAMPS : 0);
    compositor->lamp = malloc(n * sizeof *compositor->lamp);
    return compositor->lamp ? EXIT_OK : tool_fail(tool, GLINT_E_MEMORY, NULL);
}

int compositor_open_lens(const struct tool *tool, struct compositor *compositor)
{
    return strcmp(compositor->settings.options.lens, "none") == 0
               ? tool_usage(tool, "--lens none is for overlay and live")
               : compositor_open(tool, compositor);
}

static void unsize(struct compositor *compositor)
{
    glint_engine_destroy(compositor->engine);
    compositor->engine = NULL;
    compositor->sized = false;
}

/* Returns how many lamps there may be beside those that are found. */
static int more_lamps(const struct compositor *compositor)
{
    return compositor->n_hand + compositor->list.n +
           (compositor->scene.is_open ? OVER_SCENE_LAMPS : 0);
}

/* Says what progress there is while rays are exact. */
static void watch(const struct tool *tool, struct compositor *compositor,
                  struct glint_engine_config *cfg)
{
    if (!tool->quiet)
        fprintf(stderr,
                "glint %s: exact rays: first how bright flares of %s are, "
                "a minute or more for a zoom, then each frame anew\n",
                tool->name, compositor->settings.lens.name);
    tool_progress_start(&compositor->progress, tool, "exact rays");
    compositor->is_progressing = true;
    cfg->drawing.progress = tool_progress_show;
    cfg->drawing.progress_ctx = &compositor->progress;
}

/* Says how much memory a picture takes at least if --memory is too little. */
static int fail_sizing(const struct tool *tool,
                       const struct compositor *compositor,
                       enum glint_status status,
                       const struct glint_error *error)
{
    const size_t mib = (size_t)1 << 20;
    const size_t scene = over_scene_bytes(&compositor->scene);
    char text[400], more[64] = "";

    if (status != GLINT_E_MEMORY || !compositor->reserve_bytes)
        return tool_fail(tool, status, error->text);
    if (scene)
        snprintf(more, sizeof more, ", and the scene %zu",
                 (scene + mib - 1) / mib);
    snprintf(text, sizeof text, "--memory %zu is too little: %s%s",
             compositor->reserve_bytes / mib, error->text, more);
    return tool_fail(tool, status, text);
}

int compositor_size(const struct tool *tool, struct compositor *compositor,
                    int width, int height)
{
    struct glint_engine_config cfg;
    struct glint_error error = {""};
    enum glint_status status;
    size_t scene;
    int code;

    unsize(compositor);
    compositor->view = compositor->has_lens
                           ? settings_view(&compositor->settings, width, height)
                           : (struct glint_view){width, height, 1, {0, {0}}};
    code = compositor_scene_size(compositor, width, height);
    if (code != EXIT_OK)
        return code;
    compositor->sized = !compositor->has_lens;
    if (compositor->sized)
        return EXIT_OK;
    scene = over_scene_bytes(&compositor->scene);
    settings_engine(tool, &compositor->settings, width, height, &cfg);
    cfg.search.more_lamps = more_lamps(compositor);
    /* what the scene leaves */
    if (compositor->reserve_bytes)
        cfg.arena_bytes = compositor->reserve_bytes > scene
                              ? compositor->reserve_bytes - scene
                              : 1;
    compositor->cache = response_cache(tool);
    cfg.cache = &compositor->cache;
    if (compositor->settings.options.rays == GLINT_RAYS_EXACT)
        watch(tool, compositor, &cfg);
    status = glint_engine_create(&compositor->engine, &cfg, &error);
    if (status != GLINT_OK)
        return fail_sizing(tool, compositor, status, &error);
    if (tool->verbose && !tool->quiet && !compositor->is_listed &&
        compositor->n_hand == 0)
        fprintf(stderr, "%s: lamps from %g stops of white, down to %g\n",
                tool->name, cfg.search.threshold_ev[0],
                cfg.search.threshold_ev[1]);
    compositor->sized = true;
    return EXIT_OK;
}

void compositor_replace(struct compositor *compositor,
                        const struct compositor *fresh)
{
    const struct lamp_save save = compositor->save;
    const int n_frames = compositor->n_frames;

    /* so that compositor_close() leaves the file of saved lamps open; SAVE
     * still has it */
    compositor->save.is_open = false;
    compositor_close(compositor);
    *compositor = *fresh;
    if (save.is_open) {
        lamp_save_abort(&compositor->save);
        compositor->save = save;
        compositor->n_frames = n_frames;
    }
    /* A setup from a table points to the lens, which has moved. */
    if (compositor->settings.setup.lens)
        compositor->settings.setup.lens = &compositor->settings.lens;
}

int compositor_finish(const struct tool *tool, struct compositor *compositor)
{
    struct glint_error error = {""};
    const enum glint_status status =
        lamp_save_finish(&compositor->save, &error);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

void compositor_close(struct compositor *compositor)
{
    unsize(compositor);
    compositor_desk_close(compositor);
    over_scene_close(&compositor->scene);
    lamp_save_abort(&compositor->save);
    lamp_list_free(&compositor->list);
    lamp_list_free(&compositor->at);
    free(compositor->lamp);
    compositor->lamp = NULL;
    settings_close(&compositor->settings);
}

/* ------------------------------------------------------------------ drawing */

static int set_lamps(struct compositor *compositor,
                     const struct glint_image *image, int32_t elapsed_us)
{
    const bool follows = !compositor->settings.options.no_tracking;
    struct glint_engine_lamp *const lamp = compositor->lamp;
    int n = compositor->n_hand;

    for (int i = 0; i < n; i++)
        lamp[i] = glint_engine_lamp_of(
            &compositor->hand[i],
            (compositor->is_listed ? LAMP_ID_TEXT : 1) + (uint32_t)i);
    if (compositor->is_listed)
        n += lamp_list_frame(&compositor->list, compositor->n_frames,
                             &compositor->view,
                             compositor->settings.setup.optics.focal_mm,
                             lamp + n, compositor->list.n);
    compositor->is_followed = elapsed_us > 0 && follows;
    if (!compositor->is_listed && n == 0)
        n = glint_engine_find(compositor->engine, image,
                              follows ? elapsed_us : 0, lamp,
                              GLINT_ENGINE_MAX_LAMPS);
    for (int i = 0; i < n && compositor->is_measured; i++)
        if (lamp[i].is_found)
            lamp[i].seen_px = 0;
    glint_engine_elapsed(compositor->engine, elapsed_us);
    if (!follows || (compositor->is_listed &&
                     lamp_keys_is_cut(&compositor->list, compositor->n_frames)))
        glint_engine_mark_cut(compositor->engine);
    return n;
}

int compositor_lamps(struct compositor *compositor,
                     const struct glint_image *image, int32_t elapsed_us)
{
    compositor_desk_turn(compositor);
    compositor->n_lamps = set_lamps(compositor, image, elapsed_us);
    compositor->n_own = compositor->n_lamps;
    compositor_desk_hide(compositor, compositor->n_lamps);
    compositor_save_lamps(compositor);
    return compositor->n_lamps;
}

void compositor_drawn(struct compositor *compositor)
{
    if (compositor->is_progressing)
        tool_progress_end(&compositor->progress);
    compositor->is_progressing = false;
}

double compositor_scale(const struct compositor *compositor)
{
    return glint_engine_exposed(compositor->engine)->scale;
}

bool compositor_is_new(const struct compositor *compositor)
{
    return !compositor->has_lens ||
           glint_engine_exposed(compositor->engine)->is_new;
}

enum glint_status compositor_expose(struct compositor *compositor,
                                    const struct glint_image *image)
{
    struct glint_engine_config cfg;

    compositor_save_lamps(compositor);
    glint_engine_configure(&cfg, &compositor->settings.options);
    glint_engine_set_light(compositor->engine, &cfg.light);
    return glint_engine_expose(compositor->engine, compositor->lamp,
                               compositor->n_lamps, image, compositor->white);
}

enum glint_status compositor_find(struct compositor *compositor,
                                  const struct glint_image *image,
                                  int32_t elapsed_us)
{
    const double start = tool_seconds();

    compositor->n_lamps = 0;
    if (compositor->has_lens) {
        compositor_desk_turn(compositor);
        compositor->n_lamps = set_lamps(compositor, image, elapsed_us);
        compositor_desk_hide(compositor, compositor->n_lamps);
    }
    compositor->find_ms = 1e3 * (tool_seconds() - start);
    compositor->scene.elapsed_us = elapsed_us;
    compositor->scene.no_tracking = compositor->settings.options.no_tracking;
    return compositor_scene(compositor, image);
}

enum glint_status compositor_draw(struct compositor *compositor,
                                  const struct glint_image *image,
                                  int32_t elapsed_us)
{
    enum glint_status status = compositor_find(compositor, image, elapsed_us);
    double found;

    if (status != GLINT_OK || !compositor->has_lens) {
        over_scene_mark(&compositor->scene, image);
        compositor->n_frames++;
        return status;
    }
    found = tool_seconds();
    status = compositor_expose(compositor, image);
    if (status != GLINT_OK)
        return status;
    if (compositor->settings.options.layer != GLINT_LAYER_COMPOSITE)
        paint_black(image);
    status = glint_engine_draw(compositor->engine, compositor->lamp,
                               compositor->n_lamps, image, &compositor->report);
    compositor_drawn(compositor);
    compositor->flare_ms = 1e3 * (tool_seconds() - found);
    if (compositor_marks(compositor))
        compositor_mark(compositor, image);
    compositor->n_frames++;
    return status;
}
