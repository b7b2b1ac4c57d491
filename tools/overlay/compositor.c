/* SPDX-License-Identifier: MIT */
#include "overlay/compositor_layer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "desk/preview.h"
#include "lamp_files/lamp_keys.h"
#include "overlay/paint.h"
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
        GLINT_LAMP_DETECTOR_MAX +
        (compositor->scene.is_open ? OVER_SCENE_LAMPS : 0);
    compositor->lamp = malloc(n * sizeof *compositor->lamp);
    compositor->level = malloc(n * sizeof *compositor->level);
    compositor->share = malloc(n * sizeof *compositor->share);
    compositor->excess = malloc(n * sizeof *compositor->excess);
    compositor->excess_before = malloc(n * sizeof *compositor->excess);
    compositor->id_before = malloc(n * sizeof *compositor->id_before);
    compositor->seen_px = malloc(n * sizeof *compositor->seen_px);
    compositor->id = malloc(n * sizeof *compositor->id);
    return compositor->lamp && compositor->level && compositor->seen_px &&
                   compositor->share && compositor->id && compositor->excess &&
                   compositor->excess_before && compositor->id_before
               ? EXIT_OK
               : tool_fail(tool, GLINT_E_MEMORY, NULL);
}

int compositor_open_lens(const struct tool *tool, struct compositor *compositor)
{
    return strcmp(compositor->settings.options.lens, "none") == 0
               ? tool_usage(tool, "--lens none is for overlay and live")
               : compositor_open(tool, compositor);
}

/* Returns how many lamps to look for, 16 by default: most pictures have many
 * that hardly show. */
static int finder_max(const struct compositor *compositor)
{
    const int asked = compositor->settings.options.max_lights
                          ? compositor->settings.options.max_lights
                          : 16;

    return asked < GLINT_LAMP_DETECTOR_MAX ? asked : GLINT_LAMP_DETECTOR_MAX;
}

static void unsize(struct compositor *compositor)
{
    if (compositor->sized && compositor->has_lens) {
        glint_lamp_detector_close(&compositor->finder);
        glint_frame_finish(&compositor->frame);
    }
    compositor->sized = false;
}

static enum glint_status open_finder(struct compositor *compositor, int width,
                                     int height)
{
    compositor->finder.headroom_ev = compositor->headroom_ev;
    compositor->finder.max = finder_max(compositor);
    return glint_lamp_detector_open_at(&compositor->finder, width, height,
                                       compositor->threshold_ev);
}

static int by_hand(const struct compositor *compositor)
{
    return compositor->n_hand + compositor->list.n;
}

/* Returns how many lamps are drawn at most: while lamps change places, those
 * that fade are drawn beside those that rise. */
static int most_lamps(const struct compositor *compositor)
{
    return by_hand(compositor) + 2 * compositor->finder.max +
           (compositor->scene.is_open ? OVER_SCENE_LAMPS : 0);
}

/* Takes reserve_bytes: what stars and a veil take, and for ghosts what that
 * leaves. */
static enum glint_status reserve(struct compositor *compositor)
{
    struct glint_frame *frame = &compositor->frame;
    const enum glint_status status =
        glint_frame_star_hold(frame, most_lamps(compositor));
    const enum glint_status veiled = glint_frame_veil_hold(frame);
    const size_t star =
        glint_frame_star_bytes(frame) + over_scene_bytes(&compositor->scene);

    if (status != GLINT_OK || veiled != GLINT_OK ||
        star >= compositor->reserve_bytes)
        return GLINT_E_MEMORY;
    return glint_frame_reserve(
        frame, NULL, compositor->reserve_bytes - star,
        by_hand(compositor) + GLINT_LAMP_DETECTOR_MAX +
            (compositor->scene.is_open ? OVER_SCENE_LAMPS : 0),
        most_lamps(compositor));
}

/* Says how much memory a picture takes at least if --memory is too little. */
static int fail_sizing(const struct tool *tool, struct compositor *compositor,
                       enum glint_status status)
{
    struct glint_frame *frame = &compositor->frame;
    const size_t mib = (size_t)1 << 20;
    size_t least = over_scene_bytes(&compositor->scene);
    char text[128];

    if (status != GLINT_E_MEMORY || !compositor->reserve_bytes)
        return tool_fail(tool, status, NULL);
    least += glint_frame_star_bytes(frame) + glint_frame_least_bytes(frame);
    snprintf(text, sizeof text,
             "--memory %zu is too little: pictures of %dx%d with this lens "
             "take %zu at least",
             compositor->reserve_bytes / mib, frame->view.width,
             frame->view.height, (least + mib - 1) / mib);
    return tool_fail(tool, status, text);
}

int compositor_size(const struct tool *tool, struct compositor *compositor,
                    int width, int height)
{
    enum glint_status status;
    int code;

    unsize(compositor);
    compositor->view = compositor->has_lens
                           ? settings_view(&compositor->settings, width, height)
                           : (struct glint_view){width, height, 1, {0, {0}}};
    code = compositor_scene_size(compositor, width, height);
    if (code != EXIT_OK)
        return code;
    compositor->sized = true;
    if (!compositor->has_lens)
        return EXIT_OK;
    compositor->sized = false;
    compositor->strength.follows = false;
    code = settings_frame(tool, &compositor->settings, compositor->view,
                          &compositor->frame);
    if (code != EXIT_OK)
        return code;
    compositor->sized = true;
    compositor->frame.cfg.reuse = &glint_reuse;
    if (compositor->settings.options.rays == GLINT_RAYS_EXACT) {
        if (!tool->quiet)
            fprintf(stderr,
                    "glint %s: exact rays: first how bright flares of %s are, "
                    "a minute or more for a zoom, then each frame anew\n",
                    tool->name, compositor->settings.lens.name);
        tool_progress_start(&compositor->progress, tool, "exact rays");
        compositor->frame.progress = tool_progress_show;
        compositor->frame.progress_ctx = &compositor->progress;
    }
    status = response_cached(tool, compositor->settings.lens.name,
                             &compositor->frame, compositor->reserve_bytes,
                             &compositor->response);
    if (status == GLINT_OK)
        status = open_finder(compositor, width, height);
    if (tool->verbose && !tool->quiet && !compositor->is_listed &&
        compositor->n_hand == 0)
        fprintf(stderr, "%s: lamps from %g stops of white, down to %g\n",
                tool->name, compositor->threshold_ev[0],
                compositor->threshold_ev[1]);
    if (status == GLINT_OK && compositor->reserve_bytes)
        status = reserve(compositor);
    return status == GLINT_OK ? EXIT_OK : fail_sizing(tool, compositor, status);
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
    free(compositor->level);
    compositor->level = NULL;
    free(compositor->share);
    compositor->share = NULL;
    free(compositor->excess);
    free(compositor->excess_before);
    free(compositor->id_before);
    compositor->excess = compositor->excess_before = NULL;
    compositor->id_before = NULL;
    free(compositor->seen_px);
    compositor->seen_px = NULL;
    free(compositor->id);
    compositor->id = NULL;
    free(compositor->ground);
    compositor->ground = NULL;
    settings_close(&compositor->settings);
}

/* ------------------------------------------------------------------ drawing */

static int set_lamps(struct compositor *compositor,
                     const struct glint_image *image, int32_t elapsed_us)
{
    const double focal = compositor->settings.setup.optics.focal_mm;
    const bool clips = compositor->headroom_ev < 0 && !compositor->is_measured;
    int n = compositor->n_hand;

    memcpy(compositor->lamp, compositor->hand,
           (size_t)n * sizeof *compositor->lamp);
    for (int i = 0; i < n; i++) {
        compositor->level[i] = 1;
        compositor->seen_px[i] = 0;
        compositor->id[i] =
            (compositor->is_listed ? LAMP_ID_TEXT : 1) + (uint32_t)i;
    }
    if (compositor->is_listed) {
        lamp_keys_ids(&compositor->list, compositor->n_frames,
                      compositor->id + n);
        n += lamp_list_frame(&compositor->list, compositor->n_frames,
                             &compositor->view, focal, compositor->lamp + n,
                             compositor->level + n, compositor->seen_px + n,
                             compositor->list.n);
    }
    compositor->is_followed =
        elapsed_us > 0 && !compositor->settings.options.no_tracking;
    if (compositor->is_listed || n > 0)
        return n;
    n = glint_lamp_detector_frame(
        &compositor->finder, image,
        compositor->settings.options.no_tracking ? 0 : elapsed_us,
        &compositor->view, focal, compositor->lamp);
    for (int i = 0; i < n; i++) {
        compositor->seen_px[i] =
            clips ? compositor->finder.track[i].size_q8 / 256.0 : 0;
        compositor->level[i] = compositor->finder.track[i].level_q15 / 32768.0;
        compositor->id[i] = compositor->finder.track[i].id;
    }
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
    if (compositor->frame.progress)
        tool_progress_end(&compositor->progress);
    compositor->frame.progress = NULL;
}

double compositor_scale(const struct compositor *compositor)
{
    return compositor->strength.scale;
}

void compositor_expose(struct compositor *compositor, int32_t elapsed_us)
{
    const bool is_new = compositor_is_new(compositor);
    const struct glint_strength_lamps lamps = {
        compositor->lamp, compositor->level, compositor->n_lamps,
        (double)compositor->view.width * compositor->view.height *
            compositor->white};

    compositor_save_lamps(compositor);
    compositor->strength.is_physical =
        GLINT_OPTION_GIVEN(&compositor->settings.options, exposure);
    compositor->strength.exposure_ev = compositor->settings.options.exposure;
    compositor->strength.gain = compositor->settings.options.gain;
    glint_strength_expose(&compositor->strength, &compositor->response, &lamps,
                          is_new ? 0 : elapsed_us);
    if (elapsed_us == 0 && compositor->settings.options.budget <= 0)
        glint_strength_expose_still(&compositor->strength, &compositor->frame,
                                    compositor->lamp, compositor->n_lamps,
                                    compositor->ground, compositor->white);
    free(compositor->ground);
    compositor->ground = NULL;
    compositor->frame.star.seen_px = compositor->seen_px;
    compositor->frame.star.level = compositor->level;
    compositor_veil(compositor, is_new ? 0 : elapsed_us);
    compositor->frame.star.share = glint_strength_star(
        &compositor->strength, settings_starburst(&compositor->settings));
}

/* Notes what IMAGE, a picture by itself, shows under its flare, by which it is
 * exposed. Without memory for that it is exposed as on any picture. */
static void keep_ground(struct compositor *compositor,
                        const struct glint_image *image)
{
    free(compositor->ground);
    compositor->ground = malloc(sizeof *compositor->ground);
    if (compositor->ground)
        glint_ground_take(compositor->ground, image);
}

/* Sets the lamps of IMAGE and draws the scene over it. */
static enum glint_status find(struct compositor *compositor,
                              const struct glint_image *image,
                              int32_t elapsed_us)
{
    const double start = tool_seconds();
    enum glint_status status;

    compositor->n_lamps = 0;
    if (compositor->has_lens) {
        compositor_desk_turn(compositor);
        compositor->n_lamps = set_lamps(compositor, image, elapsed_us);
        compositor_desk_hide(compositor, compositor->n_lamps);
    }
    compositor->find_ms = 1e3 * (tool_seconds() - start);
    compositor->scene.elapsed_us = elapsed_us;
    compositor->scene.no_tracking = compositor->settings.options.no_tracking;
    status = compositor_scene(compositor, image);
    return status;
}

enum glint_status compositor_find(struct compositor *compositor,
                                  const struct glint_image *image,
                                  int32_t elapsed_us)
{
    const struct settings *settings = &compositor->settings;
    const enum glint_status status = find(compositor, image, elapsed_us);

    if (status != GLINT_OK || !compositor->has_lens)
        return status;
    if (settings->options.budget <= 0)
        glint_frame_set_still(&compositor->frame, elapsed_us == 0,
                              !settings->options.area_samples,
                              !settings->options.max_lights);
    if (elapsed_us == 0)
        keep_ground(compositor, image);
    return GLINT_OK;
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
    compositor_expose(compositor, elapsed_us);
    found = tool_seconds();
    status = glint_frame_veil_look(&compositor->frame, image, 1);
    if (status != GLINT_OK)
        return status;
    if (compositor->settings.options.layer != GLINT_LAYER_COMPOSITE)
        paint_black(image);
    status = glint_frame_draw(
        &compositor->frame, compositor->lamp,
        compositor_scale(compositor) > 0 ? compositor->n_lamps : 0,
        compositor_scale(compositor), image, &compositor->report);
    compositor_drawn(compositor);
    compositor->report.lights = compositor->n_lamps;
    compositor->flare_ms = 1e3 * (tool_seconds() - found);
    if (compositor_marks(compositor))
        compositor_mark(compositor, image);
    compositor->n_frames++;
    return status;
}
