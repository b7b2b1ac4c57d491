/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "live/live.h"
#include "live/live_bake.h"
#include "live/live_input.h"
#include "live/live_log.h"
#include "live/live_picture.h"
#include "live/live_signals.h"
#include "posix/clock.h"

#define RETRY_MS 500
/* max time without a frame, ms, before the input is checked */
#define WAIT_MS 250

struct live {
    struct tool *tool;
    struct live_options *o;
    live_reread_fn *reread;
    void *ctx;

    struct live_input in;
    /* format of the input, read when the input was opened or restarted */
    struct glint_source_format format;
    /* number of restarts of the input at the time FORMAT was read */
    int n_restarts;
    struct live_output output;
    /* buffer for copies of frames whose memory is slow to read */
    struct live_copy copy;

    /* bake in the background; see open_lens_and_start_bake() */
    struct live_bake bake;
    struct live_adapt adapt;
    /* requested quality parameters, before adaptation */
    struct glint_dials asked;
    struct live_log log;
    int n_shown, n_snapshots;
    /* error of the last attempt to open the camera */
    struct glint_error why;
    int64_t time_us; /* time of the last frame, microseconds */
    /* earliest time of the next attempt to open the output; 0: no attempt so
     * far */
    int64_t retry_us;
    bool had_signal;
};

/* ------------------------------------------------------------------ set-up */

/* Returns whether the quality of frames may depend on the time that drawing
 * them takes. */
static bool is_quality_adaptive(const struct live_options *o)
{
    return o->adaptive == LIVE_ADAPTIVE ||
           (o->adaptive == LIVE_ADAPTIVE_CAMERA &&
            live_input_is_camera(o->input.camera.device) &&
            o->drawing.line.settings.options.budget == 0);
}

/* Stores the format of the input, and how often the input has restarted. */
static void read_input_format(struct live *l)
{
    const struct glint_source *source = l->in.source;

    source->describe(source, &l->format);
    l->n_restarts = source->n_restarts;
}

static enum glint_status start_live_input(struct live *l,
                                          struct glint_error *error)
{
    const enum glint_status status = live_input_start(&l->in, error);

    if (status != GLINT_OK)
        return status;
    live_log_print_message(&l->log, l->format.text);
    if (l->tool->verbose && l->format.detail)
        live_log_print_message(&l->log, l->format.detail);
    return GLINT_OK;
}

static void print_output_description(const struct live *l)
{
    char text[320];

    if (*live_output_describe(&l->output, text, sizeof text))
        live_log_print_message(&l->log, text);
    if (l->tool->verbose && live_output_get_console_note(&l->output))
        live_log_print_message(&l->log,
                               live_output_get_console_note(&l->output));
}

static enum glint_status open_camera(struct live *l, struct glint_error *error)
{
    const enum glint_status status =
        live_input_open(&l->in, &l->o->input, (uint32_t)l->tool->seed, error);

    if (status != GLINT_OK)
        return status;
    l->time_us = 0;
    if (l->o->drawing.run.engine)
        glint_engine_forget_lamps(l->o->drawing.run.engine);
    l->had_signal = l->in.source->has_signal;
    return GLINT_OK;
}

/* Returns, in TEXT, options that replace a missing framebuffer, and also the
 * camera if there is none; NULL for other outputs. */
static const char *advise_without_output(const struct live *l, char *text,
                                         size_t size)
{
    const char *const device = l->o->input.camera.device;

    if (l->output.kind != LIVE_OUTPUT_FB)
        return NULL;
    if (strncmp(device, "/dev/", 5) != 0 || access(device, F_OK) == 0)
        return "use -o window, or pipe -o y4m:- into a player";
    snprintf(text, size, "-d test -o window, as there is no %.40s either",
             device);
    return text;
}

static int open_live_output(struct live *l, const struct glint_image *image)
{
    struct glint_error error = {""};
    enum glint_status status;
    char text[96];

    if (l->output.sink)
        return EXIT_OK;
    if (glint_get_time_us() < l->retry_us)
        return EXIT_OK;
    status = live_output_open(&l->output, image, l->format.fps_num,
                              l->format.fps_den, &error);
    if (status == GLINT_OK)
        print_output_description(l);
    if (status == GLINT_OK || (l->retry_us && status == GLINT_E_DEVICE)) {
        l->retry_us = glint_get_time_us() + 1000 * RETRY_MS;
        return EXIT_OK;
    }
    return live_log_print_error(&l->log, status, &error,
                                advise_without_output(l, text, sizeof text));
}

/* Applies the current quality step to flare and scene. Returns an exit code. */
static int apply_quality_step(struct live *l)
{
    struct drawing *drawing = &l->o->drawing;
    const enum glint_status status = over_scene_set_quality(
        &drawing->files.scene, live_adapt_get_max_scene_quality(&l->adapt));

    if (drawing->run.engine)
        glint_engine_set_dials(
            drawing->run.engine,
            live_adapt_coarsen_parameters(&l->adapt, l->asked));
    return status == GLINT_OK ? EXIT_OK : tool_fail(l->tool, status, NULL);
}

/* Allocates the drawing for images of IMAGE's size. Returns an exit code. */
static int prepare_drawing(struct live *l, const struct glint_image *image)
{
    struct drawing *drawing = &l->o->drawing;
    int code;

    if (drawing->run.is_sized && image->width == drawing->run.view.width &&
        image->height == drawing->run.view.height)
        return EXIT_OK;
    code = drawing_allocate(l->tool, drawing, image->width, image->height);
    if (code != EXIT_OK)
        return code;
    if (drawing->run.engine)
        l->asked = glint_engine_dials(drawing->run.engine);
    return apply_quality_step(l);
}

/* Sets up the drawing and the output for the input's format. Returns an exit
 * code. */
static int set_up_drawing_and_output(struct live *l)
{
    int code;

    read_input_format(l);
    code = prepare_drawing(l, &l->format.image);
    return code == EXIT_OK ? open_live_output(l, &l->format.image) : code;
}

/* ------------------------------------------------------------------- frames */

static void save_snapshot_image(struct live *l, const struct glint_image *image)
{
    struct glint_error error = {""};
    char name[LIVE_NAME_BYTES], text[LIVE_NAME_BYTES + 320];
    enum glint_status status;

    snprintf(name, sizeof name, l->o->snapshot, ++l->n_snapshots);
    status = live_save_image(name, image, &error);
    snprintf(text, sizeof text, "snapshot %s%s%s", name,
             status == GLINT_OK ? "" : ": ",
             status == GLINT_OK ? ""
             : *error.text      ? error.text
                                : glint_status_text(status));
    live_log_print_message(&l->log, text);
}

static double get_frame_period_ms(const struct live *l)
{
    const struct glint_source_format *f = &l->format;

    return f->fps_num ? 1e3 * f->fps_den / f->fps_num : 0;
}

static void adapt_quality(struct live *l, int64_t busy_us, int n_missed)
{
    const int before = l->adapt.step;
    char text[96];

    if (!is_quality_adaptive(l->o) || get_frame_period_ms(l) == 0 ||
        !live_adapt_add_frame(&l->adapt, 1e-3 * (double)busy_us,
                              get_frame_period_ms(l), n_missed))
        return;
    apply_quality_step(l);
    snprintf(text, sizeof text, "quality %s: step %d of %d%s",
             l->adapt.step > before  ? "lowered to keep the frame rate"
             : l->adapt.futile_s > 0 ? "raised, as lowering it saves no time"
                                     : "raised",
             l->adapt.step, LIVE_MAX_STEP,
             l->adapt.step == LIVE_MAX_STEP ? ", the lowest" : "");
    live_log_print_message(&l->log, text);
}

static int64_t convert_ms_to_us(double ms)
{
    return (int64_t)(1e3 * ms);
}

/* Adds FRAME to the statistics. AT_US[4] are the times at which FRAME was
 * received, copied, drawn and shown. AT_US is NULL if frames were only lost. */
static void record_frame_statistics(struct live *l,
                                    const struct glint_source_frame *frame,
                                    const int64_t *at_us)
{
    const struct drawing *drawing = &l->o->drawing;
    struct live_frame_times t = {.shown = at_us != NULL,
                                 .n_dropped = frame->n_dropped,
                                 .n_late = frame->n_late,
                                 .n_corrupt = frame->n_corrupt};

    if (at_us) {
        t.captured_us = frame->time_us;
        t.shown_us = at_us[3];
        t.stage_us[LIVE_CONVERT] = at_us[1] - at_us[0];
        t.stage_us[LIVE_FIND] = convert_ms_to_us(drawing->run.find_ms);
        t.stage_us[LIVE_SCENE] = convert_ms_to_us(drawing->files.scene.ms);
        t.stage_us[LIVE_PLAN] = convert_ms_to_us(drawing->run.report.plan_ms);
        t.stage_us[LIVE_BIN] = convert_ms_to_us(drawing->run.report.bin_ms);
        t.stage_us[LIVE_DRAW] = convert_ms_to_us(drawing->run.report.draw_ms);
        t.stage_us[LIVE_SHOW] = at_us[3] - at_us[2];
        t.lights = drawing->run.report.drawn_lights;
        t.ghosts = drawing->run.report.ghosts;
        t.bytes = drawing->run.report.peak_bytes +
                  drawing->run.report.star_bytes +
                  over_scene_count_memory_bytes(&drawing->files.scene);
        t.reused = drawing->run.report.stats.reused != 0;
        t.quality = 1 - (double)l->adapt.step / LIVE_MAX_STEP;
    }
    live_stats_add_frame(&l->log.stats, &t);
}

/* ------------------------------------------------------------- device loss */

/* Prints that the device WHAT was lost, with the reason WHY. With --reconnect
 * and STATUS GLINT_E_DEVICE returns -1: the run continues, the panel shows the
 * last image, and the device is retried. Otherwise returns an exit code. */
static int report_device_loss(struct live *l, const char *what,
                              enum glint_status status, const char *why)
{
    char text[320];

    if (!l->o->reconnect || status != GLINT_E_DEVICE)
        return tool_fail(l->tool, status, why);
    snprintf(text, sizeof text, "%s; waiting for the %s", why, what);
    live_log_print_message(&l->log, text);
    return -1;
}

static int handle_camera_loss(struct live *l, enum glint_status status,
                              const char *why)
{
    live_input_close(&l->in);
    return report_device_loss(l, "camera", status, why);
}

static int handle_output_loss(struct live *l, enum glint_status status,
                              const char *why)
{
    struct glint_error unsaid;

    live_output_close(&l->output, &unsaid);
    l->retry_us = glint_get_time_us() + 1000 * RETRY_MS;
    return report_device_loss(l, "output", status, why);
}

/* Tries to reopen the camera. Returns -1 to continue, or an exit code. */
static int retry_camera(struct live *l)
{
    struct glint_error error = {""};

    if (open_camera(l, &error) == GLINT_OK) {
        const int code = set_up_drawing_and_output(l);

        if (code != EXIT_OK)
            return code;
        if (start_live_input(l, &error) == GLINT_OK)
            return -1;
    }
    if (strcmp(error.text, l->why.text) != 0)
        live_log_print_message(&l->log, error.text);
    l->why = error;
    live_signals_wait(-1, RETRY_MS);
    return -1;
}

/* Returns the time since the previous frame, microseconds, at most 1e9. Returns
 * 40000 for the first frame, or if the time did not increase. */
static int32_t compute_elapsed_us(struct live *l, int64_t time_us)
{
    const int64_t before_us = l->time_us;
    const int64_t elapsed = time_us - before_us;

    l->time_us = time_us;
    return before_us == 0 || elapsed < 1 ? 40000
           : elapsed > 1000000000        ? 1000000000
                                         : (int32_t)elapsed;
}

/* Draws and shows FRAME, which was requested at TAKEN_US. Returns -1 to
 * continue, or an exit code. */
static int draw_and_show_frame(struct live *l,
                               const struct glint_source_frame *frame,
                               int64_t taken_us)
{
    struct drawing *drawing = &l->o->drawing;
    const struct glint_image *image = &frame->image;
    struct glint_error error = {""};
    enum glint_status status;
    int64_t at_us[4];
    int code;

    /* The conversion begins here, because it includes the decoding of a JPEG.
     */
    at_us[0] = taken_us;
    if (!frame->is_drawable)
        image = live_copy_image(&l->copy, image);
    code = image ? prepare_drawing(l, image)
                 : tool_fail(l->tool, GLINT_E_MEMORY, "");
    if (code != EXIT_OK)
        return code;
    at_us[1] = glint_get_time_us();
    status = drawing_draw_flare(drawing, image,
                                compute_elapsed_us(l, frame->time_us));
    if (status != GLINT_OK)
        return tool_fail(l->tool, status, NULL);
    live_log_warn_of_memory_limit(&l->log, &drawing->run.report.stats);
    if (live_signals_has_arrived(LIVE_SNAPSHOT))
        save_snapshot_image(l, image);
    code = open_live_output(l, image);
    if (code != EXIT_OK)
        return code;
    at_us[2] = glint_get_time_us();
    if (l->output.sink)
        status = l->output.sink->put(l->output.sink, image, &error);
    at_us[3] = glint_get_time_us();
    record_frame_statistics(l, frame, at_us);
    adapt_quality(l, at_us[3] - at_us[0] - l->output.sink->wait_us,
                  l->n_shown ? frame->n_dropped + frame->n_late : 0);
    l->n_shown++;
    return status == GLINT_OK ? -1 : handle_output_loss(l, status, error.text);
}

/* ---------------------------------------------------------------- the loop */

static void report_stop_signal(struct live *l)
{
    const bool has = l->in.source->has_signal;

    if (has != l->had_signal)
        live_log_print_message(
            &l->log,
            has ? "the camera has a signal again"
                : "the camera reports no signal; its frames may be blank");
    l->had_signal = has;
}

/* Called after the input has restarted with another format: sets up drawing and
 * output for this format, then starts the input. Returns -1 to continue, or an
 * exit code. */
static int restart_input(struct live *l)
{
    struct glint_error error = {""};
    const int code = set_up_drawing_and_output(l);
    enum glint_status status;

    if (code != EXIT_OK)
        return code;
    status = start_live_input(l, &error);
    return status == GLINT_OK ? -1 : handle_camera_loss(l, status, error.text);
}

/* Reads a frame from the input, if one is available, draws and shows it.
 * Returns -1 to continue, or an exit code. */
static int process_next_frame(struct live *l)
{
    struct glint_source *const source = l->in.source;
    struct glint_source_frame frame;
    struct glint_error error = {""};
    const int64_t taken_us = glint_get_time_us();
    const enum glint_status status = source->next(source, &frame, &error);
    int code = -1;

    if (status != GLINT_OK)
        return handle_camera_loss(l, status, error.text);
    report_stop_signal(l);
    if (!frame.image.plane[0]) {
        record_frame_statistics(l, &frame, NULL);
        return source->n_restarts != l->n_restarts ? restart_input(l) : -1;
    }
    if (l->o->skip > 0)
        l->o->skip--;
    else
        code = draw_and_show_frame(l, &frame, taken_us);
    source->done(source, &frame);
    return code;
}

/* Checks FRESH, the options after a reload: if the present options name a lens,
 * FRESH must also name one. Otherwise the configuration file was probably read
 * while another program wrote it. */
static bool check_config_names_lens(const struct live *l,
                                    const struct live_options *fresh)
{
    if (GLINT_OPTION_GIVEN(&fresh->drawing.line.settings.options, lens) ||
        !GLINT_OPTION_GIVEN(&l->o->drawing.line.settings.options, lens))
        return true;
    tool_error(l->tool, "the configuration names no lens any more; the file "
                        "may be empty or incomplete");
    return false;
}

/* Reloads configuration and lens. Devices stay open, and no lens is baked. On
 * an error the present configuration stays in use. */
static void reload_config_and_lens(struct live *l)
{
    struct live_options *fresh = calloc(1, sizeof *fresh);

    if (!fresh) {
        live_log_print_message(&l->log, "not reloaded: out of memory");
        return;
    }
    l->tool->no_bake = true;
    if (l->reread(l->ctx, l->tool, fresh) < 0 &&
        check_config_names_lens(l, fresh) &&
        drawing_open(l->tool, &fresh->drawing) == EXIT_OK) {
        drawing_replace_settings_and_lens(&l->o->drawing, &fresh->drawing);
        live_bake_stop(&l->bake); /* of the former lens */
        live_adapt_init(&l->adapt);
        live_log_print_message(&l->log, "reloaded");
    } else {
        drawing_close(&fresh->drawing);
        live_log_print_message(
            &l->log, "not reloaded: the previous configuration stays in use");
    }
    l->tool->no_bake = false;
    free(fresh);
}

/* Opens the lens and starts the bake of a missing model. Exact rays draw the
 * frames until it ends. Without a process or a cache, bakes first. Returns an
 * exit code. */
static int open_lens_and_start_bake(struct live *l)
{
    struct drawing *const d = &l->o->drawing;
    const int code = drawing_open(l->tool, d);
    char text[320];

    if (code != EXIT_OK || !d->files.has_lens || !d->files.lens.is_unbaked)
        return code;
    if (!live_bake_start(&l->bake, l->tool, &d->line.settings))
        return drawing_open_model(l->tool, d);
    snprintf(text, sizeof text,
             "bakes the model of %s in the background; until it is baked, "
             "exact rays draw fewer frames a second",
             d->files.lens.table.name);
    live_log_print_message(&l->log, text);
    return EXIT_OK;
}

/* Replaces exact rays by the model when its bake has ended. Returns -1 to
 * continue, or an exit code. */
static int change_to_baked_model(struct live *l)
{
    struct drawing *const d = &l->o->drawing;
    const enum live_bake_state state = live_bake_poll(&l->bake);
    char text[320];
    int code;

    if (state != LIVE_BAKE_DONE && state != LIVE_BAKE_FAILED)
        return -1;
    l->tool->no_bake = true;
    code = state == LIVE_BAKE_DONE ? drawing_open_model(l->tool, d) : EXIT_LENS;
    l->tool->no_bake = false;
    snprintf(text, sizeof text,
             d->files.lens.is_unbaked
                 ? "%s has no model; exact rays continue to draw"
                 : "the model of %s is baked",
             d->files.lens.table.name);
    live_log_print_message(&l->log, text);
    if (code == EXIT_OK && d->run.engine) {
        live_adapt_init(
            &l->adapt); /* A frame by the model takes another time. */
        l->asked = glint_engine_dials(d->run.engine);
        code = apply_quality_step(l);
    }
    if (d->files.lens.is_unbaked)
        return -1;
    return code == EXIT_OK ? -1 : code;
}

static int run_frame_loop(struct live *l)
{
    int code = -1;

    while (code < 0 && !live_signals_has_arrived(LIVE_STOP) &&
           (l->o->count == 0 || l->n_shown < l->o->count)) {
        code = change_to_baked_model(l);
        if (code >= 0)
            break;
        if (live_signals_has_arrived(LIVE_RELOAD))
            reload_config_and_lens(l);
        if (!l->in.source) {
            code = retry_camera(l);
            live_log_print_second(&l->log,
                                  live_signals_has_arrived(LIVE_REPORT_NOW));
            continue;
        }
        live_signals_wait(l->in.source->fd, WAIT_MS);
        code = process_next_frame(l);
        live_log_print_second(&l->log,
                              live_signals_has_arrived(LIVE_REPORT_NOW));
    }
    return code < 0 ? EXIT_OK : code;
}

static int start_live_run(struct live *l)
{
    const char *const device = l->o->input.camera.device;
    struct settings *const settings = &l->o->drawing.line.settings;
    struct glint_error error = {""};
    enum glint_status status;
    bool is_lens_first; /* whether the lens is opened before the devices */
    int code = EXIT_OK;

    /* Frames of fixed quality must not depend on the end of a bake. */
    if (is_quality_adaptive(l->o))
        settings->unbaked = settings_choose_method_without_model(settings);
    is_lens_first = settings->unbaked == SETTINGS_TRACE;
    if (is_lens_first)
        code = open_lens_and_start_bake(l);
    if (code == EXIT_OK && live_output_accepts_any_size(&l->output))
        code = open_live_output(l, &(struct glint_image){.width = 0});
    if (code != EXIT_OK)
        return code;
    status = open_camera(l, &error);
    if (status != GLINT_OK)
        return live_input_report_error(&l->log, device, status, &error);
    if (!is_lens_first)
        code = drawing_open(l->tool, &l->o->drawing);
    if (code != EXIT_OK)
        return code;
    /* Before this call a signal ends the process at once. */
    live_signals_install();
    code = set_up_drawing_and_output(l);
    if (code != EXIT_OK)
        return code;
    status = start_live_input(l, &error);
    return status == GLINT_OK
               ? EXIT_OK
               : live_input_report_error(&l->log, device, status, &error);
}

int live_run(struct tool *tool, struct live_options *o, live_reread_fn *reread,
             void *ctx)
{
    struct live *l = calloc(1, sizeof *l);
    struct glint_error error = {""};
    enum glint_status status;
    int code;

    if (!l)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    *l = (struct live){.tool = tool, .o = o, .reread = reread, .ctx = ctx};
    live_adapt_init(&l->adapt);
    code =
        live_output_parse(&l->output, o->output)
            ? EXIT_OK
            : tool_usage(tool,
                         "-o: '%s' is not an output; expected fb, kms, window, "
                         "FILE.y4m, y4m:-, v4l2:DEVICE or null",
                         o->output);
    l->output.fit = o->fit;
    live_log_init(&l->log, tool, o->report,
                  l->output.kind == LIVE_OUTPUT_Y4M &&
                      strcmp(l->output.path, "-") == 0);
    if (code == EXIT_OK)
        code = start_live_run(l);
    if (code == EXIT_OK) {
        live_stats_start(&l->log.stats, glint_get_time_us());
        code = run_frame_loop(l);
        if (code == EXIT_OK)
            code = drawing_finish_lamp_file(tool, &o->drawing);
        live_log_print_summary(&l->log, code == EXIT_OK, l->n_shown,
                               live_output_count_dropped_frames(&l->output));
    }
    live_bake_stop(&l->bake);
    live_input_close(&l->in);
    status = live_output_close(&l->output, &error);
    if (status != GLINT_OK && code == EXIT_OK)
        code = tool_fail(tool, status, error.text);
    live_copy_free(&l->copy);
    free(l);
    return code;
}
