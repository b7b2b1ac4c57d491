/* SPDX-License-Identifier: MIT */
#include "overlay/drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "desk/preview.h"
#include "formats/paint.h"
#include "lamp_files/lamp_keys.h"
#include "model/response_cache.h"
#include "overlay/lamp_excess.h"
#include "overlay/show_lights.h"

/* --quality of a preview, equal to that of the word draft */
static const double preview_quality = 0.25;

static double get_lens_focal_mm(const struct drawing *d)
{
    return d->files.lens.setup.optics.focal_mm;
}

/* ------------------------------------------------------------------ opening */

/* Lowers --quality and --area-samples for a preview, unless the user set the
 * quality by --quality, --grid, --error or --budget. Does not change the
 * tolerance, so that the same baked model is used. */
static void lower_preview_quality(struct settings *s)
{
    struct glint_options *const o = &s->options;
    const double tolerance = s->tolerance;

    if (settings_has_grid_option(s) || o->budget > 0)
        return;
    settings_set_quality(s, preview_quality);
    GLINT_OPTION_GIVEN(o, quality) = false;
    s->tolerance = tolerance;
    if (!o->area_samples)
        o->area_samples = 1;
}

/* Zooms the lens to ZOOM, a focal length in mm or 0 .. 1. On GLINT_E_ARGUMENT
 * the zoom does not change. */
static enum glint_status set_lens_zoom(struct drawing *d, double zoom,
                                       struct glint_error *error)
{
    struct settings *const s = &d->line.settings;
    const enum glint_status status =
        opened_lens_set_zoom(&d->files.lens, s, zoom, error);

    if (status != GLINT_OK)
        return status;
    s->zoom.zoom = zoom;
    if (d->run.engine)
        glint_engine_update_stop(d->run.engine);
    return GLINT_OK;
}

/* Sets the option NAME to VALUE, for a control line. Returns GLINT_E_ARGUMENT
 * with the reason in ERROR if VALUE is invalid. */
static enum glint_status set_option_by_control(void *ctx, const char *name,
                                               double value,
                                               struct glint_error *error)
{
    struct drawing *const d = ctx;
    struct settings *const s = &d->line.settings;
    const int column = key_frames_find_column(name);
    const double before = s->options.f_number;
    struct opened_lens *const lens = &d->files.lens;
    struct glint_error unused;
    enum glint_status status;

    if (column >= 0 && key_frames_have_column(&d->files.keys, column)) {
        snprintf(error->text, sizeof error->text,
                 "the key frames already set %s", name);
        return GLINT_E_ARGUMENT;
    }
    if (column == KEYS_ZOOM)
        return set_lens_zoom(d, value, error);
    if (column != KEYS_F_NUMBER)
        return glint_options_set(&s->options, name, value, error);
    if (s->options.rays == GLINT_RAYS_EXACT) {
        snprintf(
            error->text, sizeof error->text,
            "changing the stop between frames needs a model, not --rays exact");
        return GLINT_E_ARGUMENT;
    }
    s->options.f_number = value;
    status = opened_lens_set_stop(lens, s, error);
    if (status != GLINT_OK) {
        s->options.f_number = before;
        opened_lens_set_stop(lens, s, &unused);
    } else if (d->run.engine)
        glint_engine_update_stop(d->run.engine);
    return status;
}

/* Returns the max number of lamps that options, lists and the scene define.
 * Lamps detected in the picture are not included. */
static int count_max_given_lamps(const struct drawing *d)
{
    return d->line.n_hand + d->files.list.n +
           (d->files.scene.is_open ? OVER_SCENE_LAMPS : 0);
}

int drawing_open(const struct tool *tool, struct drawing *drawing)
{
    struct drawing_run *const run = &drawing->run;
    int code;

    run->white = 1;
    if (drawing->line.settings.options.preview)
        lower_preview_quality(&drawing->line.settings);
    drawing->files.scene.set_option = set_option_by_control;
    drawing->files.scene.set_ctx = drawing;
    code = drawing_files_open(tool, &drawing->line, &drawing->files);
    if (code != EXIT_OK || !drawing->files.has_lens)
        return code;
    run->lamp = malloc(
        (size_t)(count_max_given_lamps(drawing) + GLINT_ENGINE_MAX_LAMPS) *
        sizeof *run->lamp);
    return run->lamp ? EXIT_OK : tool_fail(tool, GLINT_E_MEMORY, NULL);
}

int drawing_open_lens(const struct tool *tool, struct drawing *drawing)
{
    const bool has_lens =
        strcmp(drawing->line.settings.options.lens, "none") != 0;

    return has_lens && !drawing->line.show_lights
               ? drawing_open(tool, drawing)
               : tool_usage(tool, "%s applies to overlay and live only",
                            has_lens ? "--show lights" : "--lens none");
}

static void destroy_sized_engine(struct drawing_run *run)
{
    glint_engine_destroy(run->engine);
    run->engine = NULL;
    run->is_sized = false;
}

void drawing_close(struct drawing *drawing)
{
    destroy_sized_engine(&drawing->run);
    drawing_files_close(&drawing->files);
    free(drawing->run.lamp);
    drawing->run.lamp = NULL;
}

void drawing_replace_settings_and_lens(struct drawing *drawing,
                                       const struct drawing *fresh)
{
    const struct lamp_save save = drawing->files.save;
    const int n_frames = drawing->run.n_frames;

    /* SAVE owns the file of saved lamps now, so drawing_close() must not close
     * it. */
    drawing->files.save.is_open = false;
    drawing_close(drawing);
    *drawing = *fresh;
    if (save.is_open) {
        lamp_save_abort(&drawing->files.save);
        drawing->files.save = save;
        drawing->run.n_frames = n_frames;
    }
    opened_lens_update_table_pointer(&drawing->files.lens);
}

int drawing_finish_lamp_file(const struct tool *tool, struct drawing *drawing)
{
    struct glint_error error = {""};
    const enum glint_status status =
        lamp_save_finish(&drawing->files.save, &error);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* ------------------------------------------------------------------- sizing */

/* Points on the disc of a light to which shadow rays are traced, for a single
 * picture and for a frame of a video */
enum { STILL_POINTS = 16, VIDEO_POINTS = 4 };

static int allocate_scene(struct drawing *d, int width, int height)
{
    const struct glint_options *const o = &d->line.settings.options;
    struct scene_dials dials = d->line.scene_dials;

    if (GLINT_OPTION_GIVEN(o, quality) || o->preview)
        scene_dials_set_quality(&dials, GLINT_OPTION_GIVEN(o, quality)
                                            ? o->quality
                                            : preview_quality);
    dials.width = width;
    dials.height = height;
    if (d->files.has_lens)
        dials.focal_px =
            1 / glint_view_pixel_tangent(&d->run.view, get_lens_focal_mm(d));
    dials.is_bounded = !dials.shadow_points;
    if (!dials.shadow_points)
        dials.shadow_points = d->line.is_still ? STILL_POINTS : VIDEO_POINTS;
    dials.tile_log2 = 3 + o->tile;
    return over_scene_allocate(&d->files.scene, &dials);
}

static bool are_rays_exact(const struct drawing *d)
{
    return d->files.has_lens && !d->files.lens.model.data;
}

/* Starts the progress of drawing by exact rays, which takes seconds per frame.
 * For a video, prints that the brightness is measured first. */
static void show_exact_ray_progress(const struct tool *tool, struct drawing *d,
                                    struct glint_engine_config *cfg)
{
    if (!tool->quiet && !d->line.is_still && !d->line.is_live &&
        d->line.settings.unbaked != SETTINGS_SEARCH &&
        !GLINT_OPTION_GIVEN(&d->line.settings.options, exposure))
        fprintf(stderr,
                "glint %s: exact rays: measures the brightness of flares of %s "
                "first (slower for a zoom), then draws each frame\n",
                tool->name, d->files.lens.table.name);
    tool_progress_start(&d->run.progress, tool, "exact rays");
    /* While the brightness is measured, the progress restarts at 0 several
     * times, so that an estimate of the time would be wrong. Only the bar of a
     * terminal is shown. */
    d->run.progress.shown &= d->run.progress.is_terminal;
    d->run.progress.told = true;
    cfg->drawing.progress = tool_progress_show;
    cfg->drawing.progress_ctx = &d->run.progress;
}

/* Prints the reason of a failure. If --memory is too small, this includes the
 * min value for a picture of this size. Returns an exit code. */
static int report_sizing_failure(const struct tool *tool,
                                 const struct drawing *d,
                                 enum glint_status status,
                                 const struct glint_error *error)
{
    const size_t mib = (size_t)1 << 20;
    const size_t scene = over_scene_count_memory_bytes(&d->files.scene);
    char text[400], more[64] = "";

    if (status != GLINT_E_MEMORY || !d->line.reserve_bytes)
        return tool_fail(tool, status, error->text);
    if (scene)
        snprintf(more, sizeof more, ", and the scene %zu",
                 (scene + mib - 1) / mib);
    snprintf(text, sizeof text, "--memory %zu is too small: %s%s",
             d->line.reserve_bytes / mib, error->text, more);
    return tool_fail(tool, status, text);
}

static int allocate_engine(const struct tool *tool, struct drawing *d)
{
    const struct drawing_line *const line = &d->line;
    const size_t scene = over_scene_count_memory_bytes(&d->files.scene);
    struct drawing_run *const run = &d->run;
    struct glint_engine_config cfg;
    struct glint_error error = {""};
    enum glint_status status;

    opened_lens_configure_engine(tool, &d->files.lens, &line->settings,
                                 run->view.width, run->view.height, &cfg);
    cfg.search.more_lamps = count_max_given_lamps(d);
    /* The flare may use the memory that the scene leaves. */
    if (line->reserve_bytes && !d->files.lens.is_unbaked)
        cfg.arena_bytes =
            line->reserve_bytes > scene ? line->reserve_bytes - scene : 1;
    run->cache = response_cache_callbacks(tool);
    cfg.cache = &run->cache;
    run->is_progressing = are_rays_exact(d) && !line->show_lights;
    if (run->is_progressing)
        show_exact_ray_progress(tool, d, &cfg);
    status = glint_engine_create(&run->engine, &cfg, &error);
    if (status != GLINT_OK)
        return report_sizing_failure(tool, d, status, &error);
    if (tool->verbose && !tool->quiet && drawing_searches_picture(d))
        fprintf(stderr,
                "%s: a lamp appears at %g stops relative to white and vanishes "
                "below %g\n",
                tool->name, cfg.search.threshold_ev[0],
                cfg.search.threshold_ev[1]);
    return EXIT_OK;
}

/* Sets the positions of the lamps of --light-at in a picture of WIDTH x HEIGHT.
 * If WARNS, prints a warning for each lamp outside the picture. */
static void place_lamps_at_pixels(const struct tool *tool, struct drawing *d,
                                  int width, int height, bool warns)
{
    for (int i = 0; i < d->line.n_at; i++) {
        const struct glint_light_at *const at = &d->line.at[i];
        struct lamp_row *const row = &d->files.list.row[d->files.first_at + i];

        row->x = at->xy[0] * (at->is_percent[0] ? width / 100.0 : 1);
        row->y = at->xy[1] * (at->is_percent[1] ? height / 100.0 : 1);
        if (warns &&
            (row->x < 0 || row->y < 0 || row->x > width || row->y > height))
            fprintf(
                stderr,
                "glint %s: --light-at %g,%g lies outside the picture of "
                "%d x %d pixels; some of its ghosts may reach the picture\n",
                tool->name, row->x, row->y, width, height);
    }
}

int drawing_allocate(const struct tool *tool, struct drawing *drawing,
                     int width, int height)
{
    struct drawing_run *const run = &drawing->run;
    int code;

    destroy_sized_engine(run);
    run->is_at_set = false;
    if (drawing->files.has_lens)
        place_lamps_at_pixels(
            tool, drawing, width, height,
            !tool->quiet &&
                (!drawing->files.lens.is_unbaked ||
                 drawing->line.settings.unbaked != SETTINGS_SEARCH));
    run->view =
        drawing->files.has_lens
            ? opened_lens_compute_view(&drawing->files.lens,
                                       &drawing->line.settings, width, height)
            : (struct glint_view){width, height, 1, {0, {0}}};
    code = allocate_scene(drawing, width, height);
    if (code == EXIT_OK && drawing->files.has_lens)
        code = allocate_engine(tool, drawing);
    run->is_sized = code == EXIT_OK;
    return code;
}

/* --------------------------------------------------------------- key frames */

/* Zooms the lens to the value of the key frames at FRAME. An invalid zoom would
 * leave the zoom unchanged, but opening the files has rejected invalid
 * values. */
static void set_zoom_by_keys(struct drawing *d, int frame)
{
    const double before = d->line.settings.zoom.zoom;
    const double zoom =
        key_frames_interpolate_at(&d->files.keys, KEYS_ZOOM, frame, before);
    struct glint_error error;

    if (key_frames_have_column(&d->files.keys, KEYS_ZOOM) && zoom != before)
        set_lens_zoom(d, zoom, &error);
}

/* Sets f-number, rotation and roundness of the stop to the values of the key
 * frames at FRAME. The exposure remains that of the widest stop. */
static enum glint_status set_f_number_by_keys(struct drawing *d, int frame)
{
    const struct keys *const keys = &d->files.keys;
    struct settings *const s = &d->line.settings;
    struct glint_engine_camera *const stop = &s->camera;
    const double f_number = key_frames_interpolate_at(
        keys, KEYS_F_NUMBER, frame, s->options.f_number);
    const double turn = key_frames_interpolate_at(keys, KEYS_TURN, frame,
                                                  stop->blade_rotation_deg);
    const double round = key_frames_interpolate_at(keys, KEYS_ROUND, frame,
                                                   stop->iris.roundness);
    struct glint_error error;
    enum glint_status status;

    if (f_number == s->options.f_number && turn == stop->blade_rotation_deg &&
        round == stop->iris.roundness)
        return GLINT_OK;
    stop->blade_rotation_deg = turn;
    stop->iris.roundness = round;
    s->options.f_number = f_number;
    status = opened_lens_set_stop(&d->files.lens, s, &error);
    if (status == GLINT_OK)
        glint_engine_update_stop(d->run.engine);
    return status;
}

/* Moves the lamp that the key frames define, the last one of LIST. */
static void move_lamp_by_keys(struct lamp_list *list, const struct keys *keys,
                              int frame)
{
    struct lamp_row *row;

    if (!key_frames_have_column(keys, KEYS_X) ||
        !key_frames_have_column(keys, KEYS_Y))
        return;
    row = &list->row[list->n - 1];
    row->x = key_frames_interpolate_at(keys, KEYS_X, frame, 0);
    row->y = key_frames_interpolate_at(keys, KEYS_Y, frame, 0);
    row->power = exp2(
        key_frames_interpolate_at(keys, KEYS_EV, frame, GLINT_LIGHT_AT_EV));
}

/* Sets the options that change in the next frame, such as zoom, f-number and
 * brightness: first by control lines, then by key frames. */
static enum glint_status apply_control_and_keys(struct drawing *d)
{
    struct glint_options *const o = &d->line.settings.options;
    const struct keys *const keys = &d->files.keys;
    const int frame = d->run.n_frames;

    d->files.scene.set_ctx = d;
    over_scene_apply_control(&d->files.scene, frame);
    if (!o->keys)
        return GLINT_OK;
    o->exposure =
        key_frames_interpolate_at(keys, KEYS_EXPOSURE, frame, o->exposure);
    o->gain = key_frames_interpolate_at(keys, KEYS_GAIN, frame, o->gain);
    o->strength =
        key_frames_interpolate_at(keys, KEYS_STRENGTH, frame, o->strength);
    if (key_frames_have_column(keys, KEYS_STARBURST)) {
        GLINT_OPTION_GIVEN(o, starburst) = true;
        o->starburst =
            key_frames_interpolate_at(keys, KEYS_STARBURST, frame, 1);
    }
    set_zoom_by_keys(d, frame);
    move_lamp_by_keys(&d->files.list, keys, frame);
    return set_f_number_by_keys(d, frame);
}

/* -------------------------------------------------------------------- lamps */

bool drawing_searches_picture(const struct drawing *drawing)
{
    return !drawing->files.is_listed && drawing->line.n_hand == 0;
}

bool drawing_get_candidate(const struct drawing *drawing, int i,
                           struct glint_spot *spot)
{
    return i < 3 && drawing->run.engine && drawing_searches_picture(drawing) &&
           drawing->line.is_still &&
           glint_engine_doubtful(drawing->run.engine, i, spot);
}

/* Returns the distance, pixels, of the user-defined lamp GIVEN from a region at
 * (X, Y), pixels, with the RMS radius SIZE_Q8. Returns HUGE_VAL unless GIVEN is
 * in the disc of the region, or closer to this disc than 1 / 100 of the
 * picture's width, within which the detector merges lamps. */
static double
compute_distance_within_reach(const struct drawing *d, double x, double y,
                              int32_t size_q8,
                              const struct glint_engine_lamp *given)
{
    const struct glint_view *const view = &d->run.view;
    const double reach_px = sqrt(2) * size_q8 / 256.0 + view->width / 100.0;
    double at[2], distance;

    glint_view_to_pixel(view, get_lens_focal_mm(d), &given->lamp, &at[0],
                        &at[1]);
    distance = hypot(x - at[0], y - at[1]);
    return distance <= reach_px ? distance : HUGE_VAL;
}

static double compute_distance_from_lamp(const struct drawing *d,
                                         const struct glint_engine_lamp *lamp,
                                         const struct glint_engine_lamp *given)
{
    return compute_distance_within_reach(d, lamp->track.x_q8 / 256.0,
                                         lamp->track.y_q8 / 256.0,
                                         lamp->track.size_q8, given);
}

/* Returns the id of the nearest of N detected lamps at the position of GIVEN
 * whose id exceeds AFTER, so that it was detected later. Returns 0 if there is
 * none. */
static uint32_t find_lamp_under(const struct drawing *d,
                                const struct glint_engine_lamp *lamp, int n,
                                const struct glint_engine_lamp *given,
                                uint32_t after)
{
    double least = HUGE_VAL;
    uint32_t id = 0;

    for (int i = 0; i < n; i++) {
        const double distance = compute_distance_from_lamp(d, &lamp[i], given);

        if (lamp[i].id > after && distance < least) {
            least = distance;
            id = lamp[i].id;
        }
    }
    return id;
}

/* Returns whether a lamp of GIVEN[N] that follows no detected lamp is at the
 * position of LAMP. */
static bool is_lamp_replaced(const struct drawing *d,
                             const struct glint_engine_lamp *lamp,
                             const struct glint_engine_lamp *given, int n)
{
    for (int i = 0; i < n; i++)
        if (given[i].id == 0 &&
            compute_distance_from_lamp(d, lamp, &given[i]) < HUGE_VAL)
            return true;
    return false;
}

/* Returns whether lamp K of --light-at is X,Y,off. */
static bool is_off(const struct drawing *d, int k)
{
    return k < d->line.n_at && isinf(d->line.at[k].ev);
}

/* Returns whether X,Y,off of --light-at removes the detected lamp ID. */
static bool is_lamp_removed(const struct drawing *d, uint32_t id)
{
    for (int k = 0; k < d->line.n_at; k++)
        if (is_off(d, k) && d->run.at[k].id == id)
            return true;
    return false;
}

int drawing_find_removal(const struct drawing *drawing, bool is_found)
{
    for (int k = 0; k < drawing->line.n_at; k++)
        if (is_off(drawing, k) && (drawing->run.at[k].id != 0) == is_found)
            return k;
    return -1;
}

/* Returns whether IMAGE is known to have no pixel near GIVEN, a lamp of
 * --light-at inside it, that is brighter than half a stop below white. At most
 * SAMPLES pixels per row and column are read. */
static bool is_on_dark_pixels(const struct drawing *d,
                              const struct glint_image *image,
                              const struct glint_engine_lamp *given)
{
    enum { SAMPLES = 1024, LEAST_CODE = 219 };
    const int columns = image->width < SAMPLES ? image->width : SAMPLES;
    const int rows = image->height < SAMPLES ? image->height : SAMPLES;
    const double reach_px = image->width / 100.0 + 1;
    uint8_t *rgb;
    double at[2];
    int most = 0;

    glint_view_to_pixel(&d->run.view, get_lens_focal_mm(d), &given->lamp,
                        &at[0], &at[1]);
    if (image->format == GLINT_LINEAR_Q20 || !(at[0] >= 0 && at[1] >= 0) ||
        !(at[0] < image->width && at[1] < image->height))
        return false;
    rgb = malloc((size_t)columns * (size_t)rows * 3);
    if (!rgb)
        return false;
    glint_image_sample(image, columns, rows, rgb);
    for (int i = 0; i < columns * rows; i++) {
        const int column = i % columns, row = i / columns;
        const double x = (column + 0.5) * image->width / columns;
        const double y = (row + 0.5) * image->height / rows;

        if (hypot(x - at[0], y - at[1]) <= reach_px)
            for (int c = 0; c < 3; c++)
                most = rgb[3 * i + c] > most ? rgb[3 * i + c] : most;
    }
    free(rgb);
    return most < LEAST_CODE;
}

/* If a candidate is at the position of GIVEN, a lamp of --light-at, gives GIVEN
 * the candidate's centre, colour and extent. Returns whether there is one. */
static bool snap_to_candidate(const struct drawing *d,
                              struct glint_engine_lamp *given)
{
    const struct glint_view *const view = &d->run.view;
    struct glint_lamp *const lamp = &given->lamp;
    struct glint_spot spot;

    for (int i = 0; drawing_get_candidate(d, i, &spot); i++) {
        const double x = spot.x_q8 / 256.0, y = spot.y_q8 / 256.0;

        if (!(compute_distance_within_reach(d, x, y, spot.size_q8, given) <
              HUGE_VAL))
            continue;
        glint_view_to_angles(view, get_lens_focal_mm(d), x, y, lamp);
        for (int k = 0; k < 2; k++)
            lamp->axis[k] =
                glint_view_pixel_tangent(view, get_lens_focal_mm(d)) *
                fmax(spot.axis_q8[k], spot.size_q8 / 6.0) / 256;
        lamp->turn_deg = atan2(-spot.sin_q15, spot.cos_q15) * 180 / GLINT_PI;
        for (int c = 0; c < 3; c++)
            lamp->rgb[c] = spot.rgb_q15[c] / 32768.0;
        return true;
    }
    return false;
}

/* Continues AT in a frame with the detected lamps LAMP[N]: updates the place of
 * the followed lamp. If the lamp is lost, AT follows a lamp that appears later
 * at the last place. GIVEN is scratch. */
static void continue_followed_lamp(const struct drawing *d,
                                   struct drawing_followed *at,
                                   const struct glint_engine_lamp *lamp, int n,
                                   struct glint_engine_lamp *given)
{
    uint32_t next, newest = 0;
    bool exists = false;

    for (int i = 0; i < n; i++) {
        newest = lamp[i].id > newest ? lamp[i].id : newest;
        if (lamp[i].id != at->id)
            continue;
        at->x = lamp[i].track.x_q8 / 256.0;
        at->y = lamp[i].track.y_q8 / 256.0;
        exists = true;
    }
    if (exists) {
        at->newest = newest;
        return;
    }
    glint_view_to_angles(&d->run.view, get_lens_focal_mm(d), at->x, at->y,
                         &given->lamp);
    next = find_lamp_under(d, lamp, n, given, at->newest);
    at->id = next ? next : at->id;
}

/* Sets the ids of the user-defined lamps GIVEN[N]. Those of --light-at come
 * first; the id is that of the detected lamp, of LAMP[N_FOUND], that the lamp
 * follows, from the first frame of a video on. Other ids are 0. */
static void follow_detected_lamps(struct drawing *d, bool is_video,
                                  const struct glint_engine_lamp *lamp,
                                  int n_found, struct glint_engine_lamp *given,
                                  int n)
{
    struct drawing_run *const run = &d->run;

    for (int i = 0; i < n; i++) {
        struct drawing_followed *const at = &run->at[i];

        given[i].id = 0;
        if (i >= d->line.n_at)
            continue;
        if (!run->is_at_set)
            at->id = find_lamp_under(d, lamp, n_found, &given[i], 0);
        if (at->id)
            continue_followed_lamp(d, at, lamp, n_found, &given[i]);
        given[i].id = at->id;
    }
    run->is_at_set = is_video;
}

/* Gives detected lamps the power that --light-at sets. Those without power are
 * hidden and stay so. */
static void set_powers_at_pixels(struct drawing *d)
{
    struct drawing_run *const run = &d->run;

    for (int k = 0; k < d->line.n_at && !d->files.is_listed; k++)
        for (int i = 0; i < run->n_found && d->line.at[k].has_ev; i++)
            if (run->lamp[i].id == run->at[k].id &&
                run->lamp[i].lamp.power > 0) {
                run->lamp[i].lamp.power =
                    exp2(d->line.at[k].ev) * run->lamp[i].level;
                run->lamp[i].seen_px = 0;
            }
}

/* Inserts the lamps detected in IMAGE before the N user-defined lamps of RUN.
 * Omits user-defined lamps that follow a detected lamp or are off, and detected
 * lamps that are removed or at the position of another user-defined lamp.
 * Returns the total number. */
static int add_found_lamps(struct drawing *d, const struct glint_image *image,
                           int32_t elapsed_us, int n)
{
    struct drawing_run *const run = &d->run;
    struct glint_engine_lamp *const lamp = run->lamp;
    struct glint_engine_lamp *const given = lamp + GLINT_ENGINE_MAX_LAMPS;
    int n_found, n_all;

    memmove(given, lamp, (size_t)n * sizeof *lamp);
    n_found = glint_engine_find(run->engine, image, elapsed_us, lamp,
                                GLINT_ENGINE_MAX_LAMPS);
    follow_detected_lamps(d, elapsed_us > 0, lamp, n_found, given, n);
    run->n_found = 0;
    for (int i = 0; i < n_found; i++)
        if (!is_lamp_replaced(d, &lamp[i], given, n) &&
            !is_lamp_removed(d, lamp[i].id))
            lamp[run->n_found++] = lamp[i];
    n_all = run->n_found;
    for (int i = 0; i < n; i++) {
        if (i < d->line.n_at)
            run->at[i].is_on_dark = false;
        if (given[i].id != 0 || is_off(d, i))
            continue;
        if (i < d->line.n_at)
            run->at[i].is_on_dark = !snap_to_candidate(d, &given[i]) &&
                                    d->line.is_still &&
                                    is_on_dark_pixels(d, image, &given[i]);
        /* The ids of detected lamps start at 1, so user-defined lamps get other
         * ids, from LAMP_ID_TEXT on. */
        given[i].id = LAMP_ID_TEXT + (uint32_t)i;
        lamp[n_all++] = given[i];
    }
    for (int i = 0; i < run->n_found && run->is_measured; i++)
        lamp[i].seen_px = 0;
    set_powers_at_pixels(d);
    return n_all;
}

/* Collects the lamps of IMAGE: those defined by angle, by pixel, by key frames
 * or in a list, and detected ones unless an option disables detection. */
static void collect_image_lamps(struct drawing *d,
                                const struct glint_image *image,
                                int32_t elapsed_us)
{
    const struct drawing_line *const line = &d->line;
    const struct lamp_list *const list = &d->files.list;
    const bool is_listed = d->files.is_listed;
    const bool follows = !line->settings.options.no_tracking;
    struct drawing_run *const run = &d->run;
    struct glint_engine_lamp *const lamp = run->lamp;
    int n = line->n_hand;

    for (int i = 0; i < n; i++)
        lamp[i] = glint_engine_lamp_of(
            &line->hand[i], (is_listed ? LAMP_ID_TEXT : 1) + (uint32_t)i);
    if (list->n > 0)
        n += lamp_list_get_frame(list, run->n_frames, &run->view,
                                 get_lens_focal_mm(d), lamp + n, list->n);
    run->is_followed = elapsed_us > 0 && follows;
    run->n_found = 0;
    if (drawing_searches_picture(d))
        n = add_found_lamps(d, image, follows ? elapsed_us : 0, n);
    glint_engine_elapsed(run->engine, elapsed_us);
    if (!follows || (is_listed && lamp_keys_is_cut(list, run->n_frames)))
        glint_engine_mark_cut(run->engine);
    run->n_lamps = run->n_own = n;
}

/* Collects the lamps of IMAGE. Reduces the power of lamps behind a mask and of
 * off-screen lamps. */
static enum glint_status find_image_lamps(struct drawing *d,
                                          const struct glint_image *image,
                                          int32_t elapsed_us)
{
    const enum glint_status status = apply_control_and_keys(d);

    if (status != GLINT_OK)
        return status;
    collect_image_lamps(d, image, elapsed_us);
    occlusion_dim_lamps(&d->files.occlusion, d->run.n_frames, &d->run.view,
                        get_lens_focal_mm(d), d->run.lamp, d->run.n_lamps);
    return GLINT_OK;
}

void drawing_measure_clipped_lamps(struct drawing *drawing,
                                   const struct glint_samples *samples)
{
    struct drawing_run *const run = &drawing->run;

    add_lamp_excess(run->lamp, run->n_found, samples, run->white, &run->view,
                    get_lens_focal_mm(drawing));
    set_powers_at_pixels(drawing);
}

/* Returns the row of lamp I for --save-lights. The row's position is where the
 * lamp was detected, or the position that a list or option sets. */
static struct lamp_row make_saved_lamp_row(const struct drawing_run *run,
                                           double focal_mm, int i)
{
    const struct glint_engine_lamp *const known = &run->lamp[i];
    const struct glint_lamp *lamp = &known->lamp;
    const double *axis = lamp->axis;
    const double pixels = run->view.width * fabs(focal_mm) /
                          run->view.sensor_width_mm; /* pixels per tangent */
    struct lamp_row row = {.frame = run->n_frames,
                           .power = lamp->power,
                           .size = pixels * hypot(axis[0], axis[1]),
                           .shape = axis[0] > 0 ? axis[1] / axis[0] : 1,
                           .turn = lamp->turn_deg,
                           .level = known->level,
                           .seen = fmax(known->seen_px, 0),
                           .id = known->id,
                           .next = -1};

    memcpy(row.rgb, lamp->rgb, sizeof row.rgb);
    if (known->is_found) {
        row.x = known->track.x_q8 / 256.0;
        row.y = known->track.y_q8 / 256.0;
    } else
        glint_view_to_pixel(&run->view, focal_mm, lamp, &row.x, &row.y);
    return row;
}

static void save_frame_lamps(struct lamp_save *save,
                             const struct drawing_run *run, double focal_mm)
{
    for (int i = 0; save->is_open && i < run->n_lamps; i++) {
        const struct lamp_row row = make_saved_lamp_row(run, focal_mm, i);

        lamp_save_write_row(save, &row);
    }
}

enum glint_status drawing_detect_lamps_only(struct drawing *drawing,
                                            const struct glint_image *image,
                                            int32_t elapsed_us)
{
    const enum glint_status status =
        find_image_lamps(drawing, image, elapsed_us);

    if (status == GLINT_OK)
        save_frame_lamps(&drawing->files.save, &drawing->run,
                         get_lens_focal_mm(drawing));
    return status;
}

/* -------------------------------------------------------------------- scene */

/* Min fraction of the time budget that is reserved for the flare */
#define LEAST_SHARE 0.1

/* Appends the lights and highlights of the scene to the lamps of RUN. Reduces
 * the light of lamps by the fraction that objects occlude. */
static void add_scene_lamps(struct drawing *d)
{
    struct over_scene *const scene = &d->files.scene;
    struct drawing_run *const run = &d->run;
    const int n = run->n_lamps;

    run->n_lamps = glint_engine_add_scene(run->engine, scene->frame.scene,
                                          run->lamp, n, &scene->lamps_hidden);
    scene->lights = run->n_lamps - n;
    run->n_lamps += over_scene_add_highlights(
        scene, !d->line.settings.options.no_tracking, &run->view,
        get_lens_focal_mm(d), run->lamp + run->n_lamps);
    glint_engine_apply_shares(run->lamp, run->n_lamps, d->line.is_still);
}

/* Draws the scene over IMAGE. Sets the time budget of the flare to the time
 * that remains. */
static enum glint_status draw_scene_on_image(struct drawing *d,
                                             const struct glint_image *image)
{
    const double budget_ms = d->line.settings.options.budget;
    struct over_scene *const scene = &d->files.scene;
    struct drawing_run *const run = &d->run;
    enum glint_status status;

    if (budget_ms > 0)
        scene->budget_ms =
            d->files.has_lens
                ? scene_budget_limit_flare(budget_ms, run->flare_ms,
                                           run->report.quality)
                : budget_ms;
    status = over_scene_draw(scene, image, run->n_frames);
    if (budget_ms > 0 && d->files.has_lens)
        glint_engine_set_budget(
            run->engine,
            budget_ms * fmax(LEAST_SHARE, 1 - scene->ms / budget_ms));
    if (status == GLINT_OK && d->files.has_lens)
        add_scene_lamps(d);
    return status;
}

/* ------------------------------------------------------------------- frames */

enum glint_status drawing_detect_and_draw_scene(struct drawing *drawing,
                                                const struct glint_image *image,
                                                int32_t elapsed_us)
{
    struct over_scene *const scene = &drawing->files.scene;
    struct drawing_run *const run = &drawing->run;
    const double start = tool_clock_s();

    run->n_lamps = run->n_own = 0;
    if (drawing->files.has_lens) {
        const enum glint_status status =
            find_image_lamps(drawing, image, elapsed_us);

        if (status != GLINT_OK)
            return status;
    }
    run->find_ms = 1e3 * (tool_clock_s() - start);
    scene->elapsed_us = elapsed_us;
    return scene->is_open ? draw_scene_on_image(drawing, image) : GLINT_OK;
}

int drawing_open_model(const struct tool *tool, struct drawing *drawing)
{
    struct opened_lens *const lens = &drawing->files.lens;
    struct settings *const s = &drawing->line.settings;
    struct drawing_run *const run = &drawing->run;
    struct opened_lens fresh = {.tints = NULL};
    struct glint_engine *const before = run->engine;
    const int unbaked = s->unbaked;
    int code;

    s->unbaked = SETTINGS_BAKE;
    code = opened_lens_open(tool, &fresh, s, s->options.lens);
    if (code != EXIT_OK) {
        s->unbaked = unbaked;
        opened_lens_close(&fresh);
        return code;
    }
    opened_lens_close(lens);
    *lens = fresh;
    opened_lens_update_table_pointer(lens);
    run->engine = NULL;
    if (!before) /* The size of pictures is not known yet. */
        return EXIT_OK;
    /* The scene stays, so that its highlights do not fade in again. */
    run->view =
        opened_lens_compute_view(lens, s, run->view.width, run->view.height);
    code = allocate_engine(tool, drawing);
    run->is_sized = code == EXIT_OK;
    if (code == EXIT_OK)
        /* --light-at follows the same lamps. */
        run->is_at_set &=
            glint_engine_continue(run->engine, before) == GLINT_OK;
    glint_engine_destroy(before);
    return code;
}

int drawing_fail(const struct tool *tool, const struct drawing *drawing,
                 enum glint_status status)
{
    return drawing->run.code != EXIT_OK ? drawing->run.code
                                        : tool_fail(tool, status, NULL);
}

/* Opens the model of a lens that waits for lamps (SETTINGS_SEARCH), if there
 * are lamps. On failure run.code is set. */
static enum glint_status open_model_for_lamps(struct drawing *d)
{
    const struct tool *const tool = d->files.scene.tool;
    struct drawing_run *const run = &d->run;

    if (run->n_lamps == 0 || !d->files.lens.is_unbaked ||
        d->line.settings.unbaked != SETTINGS_SEARCH)
        return GLINT_OK;
    if (!tool->quiet)
        fprintf(stderr, "glint %s: %d light%s\n", tool->name, run->n_lamps,
                run->n_lamps == 1 ? "" : "s");
    run->code = drawing_open_model(tool, d);
    return run->code == EXIT_OK ? GLINT_OK : GLINT_E_LENS;
}

/* Prints the number of lamps of a single picture before their rays are traced
 * exactly. */
static void print_exact_ray_notice(const struct drawing *d)
{
    const struct tool *const tool = d->files.scene.tool;
    const int n = d->run.n_lamps;

    if (tool->quiet || !d->line.is_still || n == 0)
        return;
    fprintf(stderr,
            "glint %s: %d light%s; draws the flare of %s by exact rays\n",
            tool->name, n, n == 1 ? "" : "s", d->files.lens.table.name);
}

void drawing_start_flare(struct drawing *drawing)
{
    struct drawing_run *const run = &drawing->run;

    if (!run->is_progressing)
        return;
    /* If brightness had to be measured, this was done when the engine was
     * created. From here on every ray is traced once, so that the progress is
     * steady. */
    print_exact_ray_notice(drawing);
    tool_progress_start(&run->progress, drawing->files.scene.tool,
                        "exact rays");
    run->progress.least_s = 3;
    run->progress.waits = true;
}

enum glint_status drawing_set_exposure(struct drawing *drawing,
                                       const struct glint_image *image)
{
    struct drawing_run *const run = &drawing->run;
    struct glint_engine_config cfg;
    enum glint_status status;

    save_frame_lamps(&drawing->files.save, run, get_lens_focal_mm(drawing));
    status = open_model_for_lamps(drawing);
    if (status != GLINT_OK)
        return status;
    glint_engine_configure(&cfg, &drawing->line.settings.options);
    if (drawing->line.show_lights) {
        cfg.light.by_hand = 1;
        cfg.light.gain = 0;
    }
    glint_engine_set_light(run->engine, &cfg.light);
    drawing_start_flare(drawing);
    status = glint_engine_expose(run->engine, run->lamp, run->n_lamps, image,
                                 run->white);
    if (status != GLINT_OK && run->is_progressing)
        tool_progress_end(&run->progress);
    return status;
}

void drawing_end_flare(struct drawing_run *run, double start)
{
    if (run->is_progressing)
        tool_progress_end(&run->progress);
    run->is_progressing = false;
    run->flare_ms = 1e3 * (tool_clock_s() - start);
}

enum glint_status drawing_draw_layer(struct drawing_run *run, unsigned accuracy,
                                     float *rgb)
{
    const double start = tool_clock_s();
    const enum glint_status status =
        glint_engine_draw_layer(run->engine, run->lamp, run->n_lamps,
                                GLINT_ENGINE_ALL | accuracy, rgb, &run->report);

    drawing_end_flare(run, start);
    return status;
}

/* Sets the exposure, then adds the flare to IMAGE. For --layer other than
 * composite, IMAGE is black before. */
static enum glint_status draw_exposed_flare(struct drawing *d,
                                            const struct glint_image *image)
{
    struct drawing_run *const run = &d->run;
    const double start = tool_clock_s();
    enum glint_status status = drawing_set_exposure(d, image);

    if (status != GLINT_OK)
        return status;
    if (d->line.settings.options.layer != GLINT_LAYER_COMPOSITE)
        paint_set_image_black(image);
    if (!d->line.show_lights)
        status = glint_engine_draw(run->engine, run->lamp, run->n_lamps, image,
                                   &run->report);
    drawing_end_flare(run, start);
    return status;
}

enum glint_status drawing_draw_flare(struct drawing *drawing,
                                     const struct glint_image *image,
                                     int32_t elapsed_us)
{
    enum glint_status status =
        drawing_detect_and_draw_scene(drawing, image, elapsed_us);

    if (status == GLINT_OK && drawing->files.has_lens)
        status = draw_exposed_flare(drawing, image);
    if (status == GLINT_OK)
        drawing_draw_marks(drawing, image);
    drawing->run.n_frames++;
    return status;
}

/* -------------------------------------------------------------------- marks */

/* Marks lamp I on IMAGE: a detected lamp with its track, any other lamp with
 * its position and number. */
static void draw_lamp_mark(const struct drawing_run *run, double focal_mm,
                           int i, const struct glint_image *image)
{
    const struct lamp_row row = make_saved_lamp_row(run, focal_mm, i);
    const uint32_t id = row.id < LAMP_ID_TEXT ? row.id : (uint32_t)i + 1;
    struct glint_lamp_track track = {.id = id, .state = GLINT_LAMP_STEADY};

    if (!(fabs(row.x) < 1 << 20 && fabs(row.y) < 1 << 20))
        return;
    if (run->lamp[i].is_found)
        track = run->lamp[i].track;
    track.x_q8 = (int32_t)(row.x * 256);
    track.y_q8 = (int32_t)(row.y * 256);
    show_lamp_mark_with_power(image, &track, row.power);
}

void drawing_draw_marks(const struct drawing *drawing,
                        const struct glint_image *image)
{
    const struct drawing_line *const line = &drawing->line;
    const struct drawing_run *const run = &drawing->run;
    struct glint_spot spot;
    int n_candidates = 0;

    if (run->engine && line->settings.options.preview)
        /* Without memory the numbers are omitted. */
        preview_draw_ghost_numbers(run->engine, run->lamp, run->n_lamps,
                                   drawing_get_exposure_factor(run), image);
    if (line->show_time_line)
        over_scene_draw_time_line(&drawing->files.scene, image);
    if (!line->show_lights || !run->engine)
        return;
    for (int i = 0; i < run->n_lamps; i++)
        draw_lamp_mark(run, get_lens_focal_mm(drawing), i, image);
    while (drawing_get_candidate(drawing, n_candidates, &spot)) {
        show_candidate_mark(image, &spot);
        n_candidates++;
    }
    show_mark_legend(image, run->n_found > 0 && run->is_followed,
                     n_candidates > 0);
}

bool drawing_has_marks(const struct drawing_line *line)
{
    return line->show_lights || line->settings.options.preview ||
           line->show_time_line;
}

/* ------------------------------------------------------------------ results */

double drawing_get_exposure_factor(const struct drawing_run *run)
{
    return glint_engine_exposed(run->engine)->scale;
}

bool drawing_has_exposure_restarted(const struct drawing *drawing)
{
    return !drawing->files.has_lens ||
           glint_engine_exposed(drawing->run.engine)->is_new;
}
