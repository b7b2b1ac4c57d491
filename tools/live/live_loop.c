/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "linux/v4l2_buffers.h"
#include "live/live.h"
#include "live/live_input.h"
#include "live/live_picture.h"
#include "live/live_signals.h"

#define RETRY_MS 500
#define WAIT_MS  250 /* longest sleep, so that silence is noticed */

struct live {
    struct tool *tool;
    struct live_options *o;
    live_reread_fn *reread;
    void *ctx;

    struct live_input in; /* in.camera.source.fd -1: closed */
    struct live_output output;
    struct live_copy copy; /* of frames that lie in slow memory */

    struct live_adapt adapt;
    struct glint_dials asked; /* of the look's frame before it was adapted */
    struct live_stats stats;
    int n_shown, n_snapshots;
    struct glint_error why; /* the camera could not be opened, last time */
    int n_short;            /* frames that did not fit into memory */
    int64_t time_us;        /* of the last frame */
    enum live_report report;
    int64_t retry_us; /* when a lost output is tried again; 0: never lost */
    bool had_signal;
    bool is_piped; /* frames go to standard output */
};

/* Whether statistics overwrite one line of a terminal. */
static bool is_line(const struct live *l)
{
    return l->report == LIVE_REPORT_LINE && isatty(STDERR_FILENO);
}

static void say(const struct live *l, const char *text)
{
    if (!l->tool->quiet)
        fprintf(stderr, "%sglint live: %s\n", is_line(l) ? "\r\033[K" : "",
                text);
}

/* --------------------------------------------------------------------- made */

static void say_camera(const struct live *l)
{
    static const char *const io[] = {"", "mapped", "user", "read"};
    const struct glint_v4l2 *c = &l->in.camera;
    char format[96], text[GLINT_V4L2_PATH + 256];

    glint_v4l2_format_text(&c->device.format, format);
    if (l->in.kind != LIVE_INPUT_CAMERA) {
        snprintf(text, sizeof text, "%s (%s): %dx%d, %.5g fps", c->device.path,
                 c->device.card, c->device.format.width,
                 c->device.format.height,
                 (double)c->device.format.fps_num / c->device.format.fps_den);
        say(l, text);
        return;
    }
    snprintf(text, sizeof text, "%s (%s): %s, %d %s buffers%s%s",
             c->device.path, c->device.card, format, c->n_buffers, io[c->io],
             c->is_cached ? "" : ", uncached: copied first",
             c->device.has_signal ? "" : "; NO SIGNAL");
    say(l, text);
    if (l->tool->verbose && c->exports_dmabuf)
        say(l, "buffers could be exported as DMABUF");
}

static void say_output(const struct live *l)
{
    const struct live_output *out = &l->output;
    char text[320];

    if (out->kind == LIVE_OUTPUT_FB) {
        snprintf(text, sizeof text, "%s: %dx%d, %d bits a pixel%s",
                 out->as.fb.id, out->as.fb.width, out->as.fb.height,
                 8 * out->as.fb.layout.bytes,
                 out->as.fb.n_pages > 1 ? ", drawn unseen" : "");
        say(l, text);
        if (out->as.fb.has_note && l->tool->verbose)
            say(l, out->as.fb.note.text);
    } else if (out->kind == LIVE_OUTPUT_V4L2)
        say(l, out->as.v4l2.card);
}

static enum glint_status open_camera(struct live *l, struct glint_error *error)
{
    const struct live_options *o = l->o;
    const enum glint_status status =
        live_input_open(&l->in, &o->camera, o->io, o->n_buffers,
                        (uint32_t)l->tool->seed, error);

    if (status != GLINT_OK)
        return status;
    l->time_us = 0;
    if (l->o->look.sized)
        lamp_finder_restart(&l->o->look.finder);
    l->had_signal = l->in.camera.device.has_signal;
    say_camera(l);
    return GLINT_OK;
}

/* Says ERROR and what does for now where there is no such device. */
static int fail_without(const struct live *l, enum glint_status status,
                        const struct glint_error *error, const char *instead)
{
    char text[sizeof error->text + 80];

    if (status != GLINT_E_DEVICE || !instead)
        return tool_fail(l->tool, status, error->text);
    snprintf(text, sizeof text, "%s; without one: %s", error->text, instead);
    return tool_fail(l->tool, status, text);
}

static int fail_camera(const struct live *l, enum glint_status status,
                       const struct glint_error *error)
{
    const char *const device = l->o->camera.device;

    return fail_without(l, status, error,
                        live_input_kind(device) == LIVE_INPUT_CAMERA
                            ? "-d test, or a .y4m file"
                            : NULL);
}

static int open_output(struct live *l, const struct glint_image *image)
{
    const struct glint_v4l2_format *f = &l->in.camera.device.format;
    struct glint_error error = {""};
    enum glint_status status;

    if (l->output.sink)
        return EXIT_OK;
    if (glint_v4l2_now_us() < l->retry_us)
        return EXIT_OK;
    status =
        live_output_open(&l->output, image, f->fps_num, f->fps_den, &error);
    if (status == GLINT_OK)
        say_output(l);
    if (status == GLINT_OK || (l->retry_us && status == GLINT_E_DEVICE)) {
        l->retry_us = glint_v4l2_now_us() + 1000 * RETRY_MS;
        return EXIT_OK;
    }
    return fail_without(l, status, &error,
                        l->output.kind == LIVE_OUTPUT_FB
                            ? "-o window, or -o y4m:- into a player"
                            : NULL);
}

/* Makes all that depends on the size of the pictures. */
static int take_size(struct live *l, const struct glint_image *image)
{
    struct look *look = &l->o->look;
    int code;

    if (look->sized && image->width == look->view.width &&
        image->height == look->view.height)
        return EXIT_OK;
    code = look_size(l->tool, look, image->width, image->height);
    if (code != EXIT_OK)
        return code;
    l->asked = look->frame.dials;
    look->frame.dials = live_adapt_dials(&l->adapt, l->asked);
    return EXIT_OK;
}

/* An image of the kind that the camera delivers. */
static struct glint_image expected(const struct live *l)
{
    const struct glint_v4l2_format *f = &l->in.camera.device.format;

    return (struct glint_image){.format = f->is_jpeg ? GLINT_I420 : f->pixels,
                                .width = f->width,
                                .height = f->height};
}

/* ------------------------------------------------------------------- frames */

static void snapshot(struct live *l, const struct glint_image *image)
{
    struct glint_error error = {""};
    char name[LIVE_NAME_BYTES], text[LIVE_NAME_BYTES + 320];
    enum glint_status status;

    snprintf(name, sizeof name, l->o->snapshot, ++l->n_snapshots);
    status = live_save(name, image, &error);
    snprintf(text, sizeof text, "snapshot %s%s%s", name,
             status == GLINT_OK ? "" : ": ",
             status == GLINT_OK ? ""
             : *error.text      ? error.text
                                : glint_status_text(status));
    say(l, text);
}

static double period_ms(const struct live *l)
{
    const struct glint_v4l2_format *f = &l->in.camera.device.format;

    return f->fps_num ? 1e3 * f->fps_den / f->fps_num : 0;
}

static void adapt(struct live *l, int64_t busy_us, int n_missed)
{
    const int before = l->adapt.step;
    char text[96];

    if (!l->o->adaptive || period_ms(l) == 0 ||
        !live_adapt_note(&l->adapt, 1e-3 * (double)busy_us, period_ms(l),
                         n_missed))
        return;
    l->o->look.frame.dials = live_adapt_dials(&l->adapt, l->asked);
    snprintf(text, sizeof text, "quality %s: step %d of %d%s",
             l->adapt.step > before ? "lowered to hold the rate" : "raised",
             l->adapt.step, LIVE_MAX_STEP,
             l->adapt.step == LIVE_MAX_STEP ? ", which is the last" : "");
    say(l, text);
}

/* Said once: it is likely to be so in every frame. */
static void say_short(struct live *l)
{
    const struct frame_report *r = &l->o->look.report;
    char text[160];

    if (r->stats.dropped_bundles == 0 &&
        r->stats.need_primitives <= r->stats.primitives)
        return;
    if (l->n_short++ > 0)
        return;
    snprintf(text, sizeof text,
             "a frame needs more than --memory allows: %d of %d bundles and %d "
             "of %d edges are left out",
             r->stats.dropped_bundles, r->stats.need_bundles,
             r->stats.need_primitives - r->stats.primitives,
             r->stats.need_primitives);
    say(l, text);
}

static int64_t us(double ms)
{
    return (int64_t)(1e3 * ms);
}

/* AT_US: taken, copied, drawn, shown; NULL: there was no frame to show. */
static void note(struct live *l, const struct glint_source_frame *frame,
                 const int64_t *at_us)
{
    const struct look *look = &l->o->look;
    struct live_frame_times t = {.shown = at_us != NULL,
                                 .n_dropped = frame->n_dropped,
                                 .n_late = frame->n_late,
                                 .n_corrupt = frame->n_corrupt};

    if (at_us) {
        t.captured_us = frame->time_us;
        t.shown_us = at_us[3];
        t.stage_us[LIVE_CONVERT] = at_us[1] - at_us[0];
        t.stage_us[LIVE_FIND] = us(look->find_ms);
        t.stage_us[LIVE_PLAN] = us(look->report.plan_ms);
        t.stage_us[LIVE_BIN] = us(look->report.bin_ms);
        t.stage_us[LIVE_DRAW] = us(look->report.draw_ms);
        t.stage_us[LIVE_SHOW] = at_us[3] - at_us[2];
        t.lights = look->report.drawn_lights;
        t.ghosts = look->report.ghosts;
        t.bytes = look->report.peak_bytes;
        t.quality = 1 - (double)l->adapt.step / LIVE_MAX_STEP;
    }
    live_stats_add(&l->stats, &t);
}

/* ------------------------------------------------------------- what is lost */

/* With --reconnect a device that went away is waited for; the panel keeps the
 * last picture meanwhile, and why is said. Returns -1 to go on. */
static int lose(struct live *l, const char *what, enum glint_status status,
                const char *why)
{
    char text[320];

    if (!l->o->reconnect || status != GLINT_E_DEVICE)
        return tool_fail(l->tool, status, why);
    snprintf(text, sizeof text, "%s; waiting for the %s", why, what);
    say(l, text);
    return -1;
}

static int lose_camera(struct live *l, enum glint_status status,
                       const char *why)
{
    l->in.camera.source.close(&l->in.camera.source);
    return lose(l, "camera", status, why);
}

static int lose_output(struct live *l, enum glint_status status,
                       const char *why)
{
    struct glint_error unsaid;

    live_output_close(&l->output, &unsaid);
    l->retry_us = glint_v4l2_now_us() + 1000 * RETRY_MS;
    return lose(l, "output", status, why);
}

static void retry_camera(struct live *l)
{
    struct glint_error error = {""};

    if (open_camera(l, &error) == GLINT_OK)
        return;
    if (strcmp(error.text, l->why.text) != 0)
        say(l, error.text);
    l->why = error;
    live_signals_wait(-1, RETRY_MS);
}

/* Since the frame before; of the first, what a frame takes. */
static int32_t elapsed_us(struct live *l, int64_t time_us)
{
    const int64_t before_us = l->time_us;
    const int64_t elapsed = time_us - before_us;

    l->time_us = time_us;
    return before_us == 0 || elapsed < 1 ? 40000
           : elapsed > 1000000000        ? 1000000000
                                         : (int32_t)elapsed;
}

/* Draws FRAME, asked for at TAKEN_US, and shows it. Returns -1 to go on. */
static int show(struct live *l, const struct glint_source_frame *frame,
                int64_t taken_us)
{
    struct look *look = &l->o->look;
    const struct glint_image *image = &frame->image;
    struct glint_error error = {""};
    enum glint_status status;
    int64_t at_us[4];
    int code;

    at_us[0] = taken_us; /* a JPEG was decoded since */
    if (!frame->cached)
        image = live_copy(&l->copy, image);
    code = image ? take_size(l, image) : tool_fail(l->tool, GLINT_E_MEMORY, "");
    if (code != EXIT_OK)
        return code;
    at_us[1] = glint_v4l2_now_us();
    status = look_draw(look, image, elapsed_us(l, frame->time_us));
    if (status != GLINT_OK)
        return tool_fail(l->tool, status, NULL);
    say_short(l);
    if (live_signal(LIVE_SNAPSHOT))
        snapshot(l, image);
    code = open_output(l, image);
    if (code != EXIT_OK)
        return code;
    at_us[2] = glint_v4l2_now_us();
    if (l->output.sink)
        status = l->output.sink->put(l->output.sink, image, &error);
    at_us[3] = glint_v4l2_now_us();
    note(l, frame, at_us);
    adapt(l, at_us[3] - at_us[0],
          l->n_shown ? frame->n_dropped + frame->n_late : 0);
    l->n_shown++;
    return status == GLINT_OK ? -1 : lose_output(l, status, error.text);
}

/* ---------------------------------------------------------------- the loop */

static void say_signal(struct live *l)
{
    const bool has = l->in.camera.device.has_signal;

    if (has != l->had_signal)
        say(l, has ? "the camera has a signal again"
                   : "the camera has no signal: its picture is what it makes "
                     "of that");
    l->had_signal = has;
}

/* One frame, if there is one. Returns -1 to go on. */
static int step(struct live *l)
{
    struct glint_source *source = &l->in.camera.source;
    struct glint_source_frame frame;
    struct glint_error error = {""};
    const int n_restarts = l->in.camera.n_restarts;
    const int64_t taken_us = glint_v4l2_now_us();
    const enum glint_status status = source->next(source, &frame, &error);
    int code = -1;

    if (status != GLINT_OK)
        return lose_camera(l, status, error.text);
    if (l->in.camera.n_restarts != n_restarts)
        say_camera(l);
    say_signal(l);
    if (!frame.image.plane[0]) {
        note(l, &frame, NULL);
        return -1;
    }
    if (l->o->skip > 0)
        l->o->skip--;
    else
        code = show(l, &frame, taken_us);
    source->done(source, &frame);
    return code;
}

/* Lens and lights as the configuration says now; devices stay. If anything is
 * wrong with it, all stays as it was. */
static void reload(struct live *l)
{
    struct live_options *fresh = calloc(1, sizeof *fresh);

    if (!fresh)
        return;
    if (l->reread(l->ctx, l->tool, fresh) < 0 &&
        look_open(l->tool, &fresh->look) == EXIT_OK) {
        look_replace(&l->o->look, &fresh->look);
        live_adapt_init(&l->adapt);
        say(l, "reloaded");
    } else {
        look_close(&fresh->look);
        say(l, "not reloaded: all stays as it was");
    }
    free(fresh);
}

static void print_report(const struct live *l, bool total)
{
    const int64_t now_us = glint_v4l2_now_us();
    char text[LIVE_STATS_TEXT];

    if (l->report == LIVE_REPORT_JSON) {
        FILE *const out = l->is_piped ? stderr : stdout;

        fprintf(out, "%s\n", live_stats_json(&l->stats, now_us, total, text));
        fflush(out);
    } else if (l->report == LIVE_REPORT_LINE && !total)
        fputs(live_stats_line(&l->stats, now_us, is_line(l), text), stderr);
}

static void report(struct live *l)
{
    const int64_t now_us = glint_v4l2_now_us();
    const bool is_asked = live_signal(LIVE_REPORT_NOW);

    if (!live_stats_due(&l->stats, now_us) && !is_asked)
        return;
    print_report(l, false);
    live_stats_next(&l->stats, now_us);
}

/* The last word: how it went, and what was left out. */
static void conclude(struct live *l, int code)
{
    const struct live_sums *t = &l->stats.total;
    char text[200];

    print_report(l, true);
    if (l->report != LIVE_REPORT_LINE || code != EXIT_OK || l->n_shown == 0)
        return;
    snprintf(text, sizeof text,
             "%d frames, %ld of them not taken by the output; %llu dropped, "
             "%llu late, %llu corrupt; latency %.1f ms, 1 in 100 above %.1f",
             l->n_shown, live_output_dropped(&l->output),
             (unsigned long long)t->drops, (unsigned long long)t->late,
             (unsigned long long)t->corrupt, live_stats_latency_ms(t, 50),
             live_stats_latency_ms(t, 99));
    say(l, text);
    if (l->n_short) {
        snprintf(text, sizeof text,
                 "in %d frames something was left out for want of --memory",
                 l->n_short);
        say(l, text);
    }
}

static int loop(struct live *l)
{
    int code = -1;

    while (code < 0 && !live_signal(LIVE_STOP) &&
           (l->o->count == 0 || l->n_shown < l->o->count)) {
        if (live_signal(LIVE_RELOAD))
            reload(l);
        if (l->in.camera.source.fd < 0) {
            retry_camera(l);
            report(l);
            continue;
        }
        live_signals_wait(l->in.camera.source.fd, WAIT_MS);
        code = step(l);
        report(l);
    }
    return code < 0 ? EXIT_OK : code;
}

static int start(struct live *l)
{
    struct glint_error error = {""};
    struct glint_image image;
    enum glint_status status;
    int code = EXIT_OK;

    if (live_output_is_flexible(&l->output))
        code = open_output(l, &(struct glint_image){.width = 0});
    if (code != EXIT_OK)
        return code;
    status = live_input_look(l->o->camera.device, &error);
    if (status != GLINT_OK)
        return fail_camera(l, status, &error);
    code = look_open(l->tool, &l->o->look);
    if (code != EXIT_OK)
        return code;
    live_signals_take(); /* until here, whoever is impatient may kill it */
    status = open_camera(l, &error);
    if (status != GLINT_OK)
        return fail_camera(l, status, &error);
    image = expected(l);
    return take_size(l, &image);
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
    l->in.camera.source.fd = l->in.camera.device.fd = -1;
    l->report = o->report != LIVE_REPORT_AUTO ? o->report
                : tool->json                  ? LIVE_REPORT_JSON
                : tool->quiet                 ? LIVE_REPORT_NONE
                                              : LIVE_REPORT_LINE;
    live_adapt_init(&l->adapt);
    code = live_output_parse(&l->output, o->output)
               ? EXIT_OK
               : tool_usage(tool, "-o: '%s' is no output", o->output);
    l->output.fit = o->fit;
    l->output.dither = o->look.scene.dither;
    l->is_piped =
        l->output.kind == LIVE_OUTPUT_Y4M && strcmp(l->output.path, "-") == 0;
    if (code == EXIT_OK)
        code = start(l);
    if (code == EXIT_OK) {
        live_stats_start(&l->stats, glint_v4l2_now_us());
        code = loop(l);
        if (code == EXIT_OK)
            code = look_finish(tool, &o->look);
        conclude(l, code);
    }
    if (l->in.camera.source.fd >= 0)
        l->in.camera.source.close(&l->in.camera.source);
    status = live_output_close(&l->output, &error);
    if (status != GLINT_OK && code == EXIT_OK)
        code = tool_fail(tool, status, error.text);
    live_copy_free(&l->copy);
    free(l);
    return code;
}
