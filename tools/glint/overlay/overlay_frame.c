/* SPDX-License-Identifier: MIT
 *
 * Draws one picture or frame of glint overlay, or only detects its lamps, and
 * collects the statistics of all frames. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "overlay/overlay.h"
#include "overlay/overlay_line.h"

static void print_frame_statistics(const struct overlay *o)
{
    char lights[64];

    settings_write_light_counts(&o->drawing.run.report, lights);
    fprintf(stderr, "frame %d: %s, %d ghosts, %d edges of ray cells\n",
            o->drawing.run.n_frames - 1, lights, o->drawing.run.report.ghosts,
            o->drawing.run.report.stats.primitives);
}

static void record_max_dropped_counts(struct glint_engine_report *worst,
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

static enum glint_status draw_in_place(void *ctx, struct drawing *drawing,
                                       const struct glint_image *image,
                                       int32_t elapsed_us)
{
    (void)ctx;
    return drawing_draw_flare(drawing, image, elapsed_us);
}

int overlay_draw_frame(struct tool *tool, struct overlay *o,
                       const struct glint_image *image)
{
    return overlay_draw_frame_by_callback(tool, o, image, draw_in_place, NULL);
}

int overlay_find_lamps_only(struct tool *tool, struct overlay *o,
                            const struct glint_image *image)
{
    struct drawing *const drawing = &o->drawing;
    enum glint_status status = GLINT_OK;
    int code = EXIT_OK;

    if (!drawing->run.is_sized)
        code = drawing_allocate(tool, drawing, image->width, image->height);
    if (code != EXIT_OK)
        return code;
    if (o->first - drawing->run.n_frames <= o->warm_up) {
        status = drawing_detect_and_draw_scene(drawing, image, o->elapsed_us);
        if (status == GLINT_OK && drawing->files.has_lens)
            status = drawing_set_exposure(drawing, image);
    }
    o->is_cut = drawing_has_exposure_restarted(drawing);
    drawing->run.n_frames++;
    return status == GLINT_OK ? EXIT_OK : drawing_fail(tool, drawing, status);
}

static void extend_value_range(struct overlay_span *of, double x)
{
    of->min = of->n ? fmin(of->min, x) : x;
    of->max = of->n ? fmax(of->max, x) : x;
    of->n++;
}

/* Extends the range of gain, and that of exposure (if the option was given) or
 * strength, by the values O of a frame. */
static void record_frame_brightness(struct overlay_figures *f,
                                    const struct glint_options *o)
{
    if (GLINT_OPTION_GIVEN(o, exposure))
        extend_value_range(&f->exposure, o->exposure);
    else
        extend_value_range(&f->strength, o->strength);
    extend_value_range(&f->gain, o->gain);
}

int overlay_draw_frame_by_callback(struct tool *tool, struct overlay *o,
                                   const struct glint_image *image,
                                   overlay_draw_fn *draw, void *ctx)
{
    struct drawing *drawing = &o->drawing;
    enum glint_status status;
    int code = EXIT_OK;

    drawing->line.is_still = o->elapsed_us == 0;
    if (!drawing->run.is_sized)
        code = drawing_allocate(tool, drawing, image->width, image->height);
    if (code != EXIT_OK)
        return code;
    status = draw(ctx, drawing, image, o->elapsed_us);
    if (status != GLINT_OK)
        return drawing_fail(tool, drawing, status);
    code = layers_write(tool, &o->layers, drawing);
    if (code != EXIT_OK)
        return code;
    record_frame_brightness(&o->figures, &drawing->line.settings.options);
    o->figures.find_ms += drawing->run.find_ms;
    o->figures.flare_ms += drawing->run.flare_ms;
    /* The response of the lens does not know the angles of the model. */
    if (drawing->run.engine &&
        drawing->run.report.beyond_lights < drawing->run.report.lights) {
        const struct glint_response_light *const light =
            &glint_engine_exposed(drawing->run.engine)->light;

        o->figures.peak =
            fmax(o->figures.peak, glint_largest_channel(light->peak));
        o->figures.mean_sum += glint_largest_channel(light->mean);
    }
    if (drawing->run.n_lamps > o->figures.most_lights)
        o->figures.most_lights = drawing->run.n_lamps;
    o->figures.n_reused += drawing->run.report.stats.reused;
    if (drawing->run.report.peak_bytes + drawing->run.report.star_bytes >
        o->figures.peak_bytes)
        o->figures.peak_bytes =
            drawing->run.report.peak_bytes + drawing->run.report.star_bytes;
    record_max_dropped_counts(&o->figures.worst, &drawing->run.report);
    if (tool->verbose && !tool->quiet)
        print_frame_statistics(o);
    return EXIT_OK;
}

void overlay_print_progress(const struct tool *tool, struct overlay *o)
{
    const double now = tool_clock_s(), spent = now - o->figures.started;
    const bool is_terminal = isatty(STDERR_FILENO);

    if (tool->quiet || tool->verbose)
        return;
    if (!is_terminal && now - fmax(o->figures.started, o->figures.reported) < 5)
        return;
    o->figures.reported = now;
    fprintf(stderr,
            is_terminal ? "\rframe %d  %.1f fps  %d light%s \033[K"
                        : "glint overlay: frame %d, %.1f fps, %d light%s\n",
            o->drawing.run.n_frames, o->drawing.run.n_frames / spent,
            o->drawing.run.report.lights,
            o->drawing.run.report.lights == 1 ? "" : "s");
    fflush(stderr);
}

int overlay_check_outputs(const struct tool *tool, const struct overlay *o,
                          const char *from, const char *to)
{
    struct apart files = {.n_read = 0};

    file_conflicts_add_input(&files, NULL, from);
    file_conflicts_add_output(&files, "-o", to);
    file_conflicts_add_drawing_files(&files, &o->drawing.line);
    return layers_check_outputs(tool, &o->layers, &files);
}
