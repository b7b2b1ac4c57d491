/* SPDX-License-Identifier: MIT
 *
 * One picture or frame of a run of overlay: drawn, or looked at alone; and what
 * the result says of all. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "overlay/overlay.h"
#include "overlay/overlay_line.h"

static void say_frame(const struct overlay *o)
{
    char lights[64];

    settings_lights_text(&o->compositor.report, lights);
    fprintf(stderr, "frame %d: %s, %d ghosts, %d primitives\n",
            o->compositor.n_frames - 1, lights, o->compositor.report.ghosts,
            o->compositor.report.stats.primitives);
}

static void note_worst(struct glint_engine_report *worst,
                       const struct glint_engine_report *report)
{
    const int dropped =
        worst->stats.dropped_bundles > report->stats.dropped_bundles
            ? worst->stats.dropped_bundles
            : report->stats.dropped_bundles;
    const int cells = worst->stats.dropped_cells > report->stats.dropped_cells
                          ? worst->stats.dropped_cells
                          : report->stats.dropped_cells;
    const int beyond = worst->beyond_lights > report->beyond_lights
                           ? worst->beyond_lights
                           : report->beyond_lights;
    const int lights =
        worst->lights > report->lights ? worst->lights : report->lights;
    const bool tight = worst->tight || report->tight;

    if (report->apart_lights - report->drawn_lights >
        worst->apart_lights - worst->drawn_lights)
        *worst = *report;
    worst->stats.dropped_bundles = dropped;
    worst->stats.dropped_cells = cells;
    worst->lights = lights;
    worst->beyond_lights = beyond;
    worst->tight = tight;
}

static enum glint_status draw_in_place(void *ctx, struct compositor *compositor,
                                       const struct glint_image *image,
                                       int32_t elapsed_us)
{
    (void)ctx;
    return compositor_draw(compositor, image, elapsed_us);
}

int overlay_draw(struct tool *tool, struct overlay *o,
                 const struct glint_image *image)
{
    return overlay_draw_by(tool, o, image, draw_in_place, NULL);
}

int overlay_look(struct tool *tool, struct overlay *o,
                 const struct glint_image *image)
{
    struct compositor *const compositor = &o->compositor;
    enum glint_status status = GLINT_OK;
    int code = EXIT_OK;

    if (!compositor->sized)
        code = compositor_size(tool, compositor, image->width, image->height);
    if (code != EXIT_OK)
        return code;
    if (o->first - compositor->n_frames <= o->warm_up) {
        status = compositor_find(compositor, image, o->elapsed_us);
        if (status == GLINT_OK && compositor->has_lens)
            status = compositor_expose(compositor, image);
    }
    o->is_cut = compositor_is_new(compositor);
    compositor->n_frames++;
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, NULL);
}

int overlay_draw_by(struct tool *tool, struct overlay *o,
                    const struct glint_image *image, overlay_draw_fn *draw,
                    void *ctx)
{
    struct compositor *compositor = &o->compositor;
    enum glint_status status;
    int code = EXIT_OK;

    compositor->is_still = o->elapsed_us == 0;
    if (!compositor->sized)
        code = compositor_size(tool, compositor, image->width, image->height);
    if (code != EXIT_OK)
        return code;
    status = draw(ctx, compositor, image, o->elapsed_us);
    if (status != GLINT_OK)
        return tool_fail(tool, status, NULL);
    code = layers_write(tool, &o->layers, compositor);
    if (code != EXIT_OK)
        return code;
    o->find_ms += compositor->find_ms;
    o->flare_ms += compositor->flare_ms;
    if (compositor->engine) {
        const struct glint_response_light *const light =
            &glint_engine_exposed(compositor->engine)->light;

        o->peak = fmax(o->peak, glint_largest_channel(light->peak));
        o->mean_sum += glint_largest_channel(light->mean);
    }
    if (compositor->n_lamps > o->most_lights)
        o->most_lights = compositor->n_lamps;
    o->n_reused += compositor->report.stats.reused;
    if (compositor->report.peak_bytes + compositor->report.star_bytes >
        o->peak_bytes)
        o->peak_bytes =
            compositor->report.peak_bytes + compositor->report.star_bytes;
    note_worst(&o->worst, &compositor->report);
    if (tool->verbose && !tool->quiet)
        say_frame(o);
    return EXIT_OK;
}

void overlay_progress(const struct tool *tool, struct overlay *o)
{
    const double now = tool_seconds(), spent = now - o->started;
    const bool is_terminal = isatty(STDERR_FILENO);

    if (tool->quiet || tool->verbose)
        return;
    if (!is_terminal && now - fmax(o->started, o->reported) < 5)
        return;
    o->reported = now;
    fprintf(stderr,
            is_terminal ? "\rframe %d  %.1f fps  %d lights \033[K"
                        : "glint overlay: frame %d, %.1f fps, %d "
                          "lights\n",
            o->compositor.n_frames, o->compositor.n_frames / spent,
            o->compositor.report.lights);
    fflush(stderr);
}

int overlay_check_apart(const struct tool *tool, const struct overlay *o,
                        const char *from, const char *to)
{
    struct apart files = {.n_read = 0};

    apart_read(&files, NULL, from);
    apart_write(&files, "-o", to);
    apart_compositor(&files, &o->compositor);
    return layers_check_apart(tool, &o->layers, &files);
}
