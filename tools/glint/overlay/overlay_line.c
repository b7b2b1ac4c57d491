/* SPDX-License-Identifier: MIT */
#include "overlay/overlay_line.h"

#include <math.h>
#include <stdlib.h>

#include "glint/setup.h"
#include "overlay/drawing.h"

/* Linear light, 1 = white, below which a flare is invisible: that of sRGB code
 * 2 of 255. Near black the sRGB curve has the slope 12.92. */
static const double least_seen = 2 / 255.0 / 12.92;
/* Linear light, 1 = white, of the flare's peak with the option that is
 * suggested if the flare is invisible */
static const double well_seen = 0.25;

/* --------------------------------------------------------------- the light */

/* Returns whether --only selects the starburst or the veil. */
static bool is_single_component_drawn(const struct drawing *drawing)
{
    return drawing->line.settings.options.only == GLINT_ONLY_STARBURST ||
           drawing->line.settings.options.only == GLINT_ONLY_VEIL;
}

/* Draws the layer of the last frame again and sets LIGHT to its peak and mean.
 * Returns false without memory. */
static bool measure_layer_light(struct drawing *drawing,
                                struct glint_response_light *light)
{
    const size_t n =
        (size_t)drawing->run.view.width * (size_t)drawing->run.view.height;
    const struct glint_engine_report report = drawing->run.report;
    float *rgb = malloc(3 * n * sizeof *rgb);
    const bool is_drawn =
        rgb && drawing_draw_layer(&drawing->run, 0, rgb) == GLINT_OK;

    if (is_drawn) {
        glint_response_around(rgb, n, light);
        for (int c = 0; c < 3; c++) {
            light->peak[c] /= drawing->run.white;
            light->mean[c] /= drawing->run.white;
        }
    }
    drawing->run.report = report;
    free(rgb);
    return is_drawn;
}

int overlay_count_frames(const struct overlay *o)
{
    const int n = o->drawing.run.n_frames;

    return n > o->first ? n - o->first : 0;
}

struct overlay_light overlay_measure_light(struct overlay *o)
{
    struct drawing *drawing = &o->drawing;
    const int n = overlay_count_frames(o);
    struct overlay_light light = {true, o->figures.peak,
                                  n ? o->figures.mean_sum / n : 0};
    struct glint_response_light drawn;

    if (is_single_component_drawn(drawing) && drawing->run.n_lamps > 0 &&
        drawing_get_exposure_factor(&drawing->run) > 0) {
        light.is_known =
            drawing->run.n_frames == 1 && measure_layer_light(drawing, &drawn);
        if (light.is_known) {
            light.peak = glint_largest_channel(drawn.peak);
            light.mean = glint_largest_channel(drawn.mean);
        }
        return light;
    }
    if (n != 1 || drawing->run.n_lamps == 0 ||
        drawing_get_exposure_factor(&drawing->run) <= 0 ||
        glint_engine_exposed(drawing->run.engine)->is_drawn ||
        glint_engine_measure(drawing->run.engine, drawing->run.lamp,
                             drawing->run.n_lamps, &drawn) != GLINT_OK)
        return light;
    light.peak = drawing_get_exposure_factor(&drawing->run) /
                 drawing->run.white * glint_largest_channel(drawn.peak);
    light.mean = drawing_get_exposure_factor(&drawing->run) /
                 drawing->run.white * glint_largest_channel(drawn.mean);
    return light;
}

static double convert_lamp_power_to_stops(const struct glint_engine_lamp *lamp)
{
    return log2(fmax(lamp->lamp.power, 1e-30));
}

static double get_lens_f_number(const struct opened_lens *lens)
{
    return lens->model.data ? model_convert_real_to_double(
                                  lens->model.lens.header->f_number) /
                                  lens->setup.opening
                            : lens->table.f_number;
}

/* ---------------------------------------------------------------- the line */

static const struct glint_engine_lamp *
brightest_of(const struct drawing *drawing)
{
    const struct glint_engine_lamp *best = drawing->run.lamp;

    for (int i = 1; i < drawing->run.n_lamps; i++)
        if (drawing->run.lamp[i].lamp.power > best->lamp.power)
            best = &drawing->run.lamp[i];
    return best;
}

/* Returns X rounded to an integer, without a sign for 0. */
static double round_without_minus_zero(double x)
{
    return rint(x) + 0.0;
}

static void print_lights(const struct drawing *drawing, int most, FILE *to)
{
    const struct glint_engine_lamp *lamp;
    double x, y;

    fprintf(to, "%s%d light%s", drawing->run.n_frames == 1 ? "" : "at most ",
            most, most == 1 ? "" : "s");
    if (drawing->run.n_lamps == 0 || drawing->run.n_frames > 1)
        return;
    lamp = brightest_of(drawing);
    glint_view_to_pixel(&drawing->run.view,
                        drawing->files.lens.setup.optics.focal_mm, &lamp->lamp,
                        &x, &y);
    fprintf(to, " (%s%.0f stops over a white pixel, ",
            most == 1 ? "" : "the brightest ",
            convert_lamp_power_to_stops(lamp));
    if (fabs(x) > 2 * drawing->run.view.width ||
        fabs(y) > 2 * drawing->run.view.height)
        fputs("far outside the picture)", to);
    else
        fprintf(to, "at %.0f,%.0f)", round_without_minus_zero(x),
                round_without_minus_zero(y));
}

/* Prints NAME and the range of its values OF. If HAS_SIGN, positive values have
 * a plus. */
static void print_value_range(const struct overlay_span *of, const char *name,
                              bool has_sign, FILE *to)
{
    fprintf(to, has_sign ? "%s %+g" : "%s %g", name, of->min);
    if (of->max > of->min)
        fprintf(to, has_sign ? " to %+g" : " to %g", of->max);
}

/* Prints the ranges of strength, exposure and gain over all frames. */
static void print_brightness_options(const struct overlay_figures *f, FILE *to)
{
    if (f->strength.n > 0)
        print_value_range(&f->strength, "strength", false, to);
    if (f->exposure.n > 0) {
        print_value_range(&f->exposure,
                          f->strength.n > 0 ? ", in other frames exposure"
                                            : "exposure",
                          true, to);
        fputs(" EV", to);
    }
    if (f->gain.min != 1 || f->gain.max != 1)
        print_value_range(&f->gain, ", gain", false, to);
}

/* Prints lens and stop, and which of them the picture's Exif determined. */
static void print_lens(const struct drawing *drawing, FILE *to)
{
    const struct drawing_line *const line = &drawing->line;
    const double f_number = get_lens_f_number(&drawing->files.lens);
    const double photo =
        line->settings.options.f_number > 0 ? 0 : line->settings.photo_f_number;

    fprintf(to, ", %s", drawing->files.lens.table.name);
    if (line->photo_focal_mm > 0)
        fprintf(to, " (nearest to %.3g mm of Exif)", line->photo_focal_mm);
    fprintf(to, " f/%.3g", f_number);
    if (photo > 0 && fabs(photo / f_number - 1) < 0.01)
        fputs(" (Exif)", to);
    else if (photo > 0)
        fprintf(to, " (widest; Exif: f/%.3g)", photo);
    fprintf(to, ", %s, ",
            drawing->files.lens.model.data ? "baked model" : "exact rays");
}

static bool are_all_lamps_off_screen(const struct drawing *drawing)
{
    const struct glint_view *const view = &drawing->run.view;
    bool all = true;

    for (int i = 0; i < drawing->run.n_lamps; i++) {
        double x, y;

        glint_view_to_pixel(view, drawing->files.lens.setup.optics.focal_mm,
                            &drawing->run.lamp[i].lamp, &x, &y);
        all = all && (x < 0 || y < 0 || x > view->width || y > view->height);
    }
    return all;
}

/* Prints why the flare, whose light is LIGHT, is invisible, and which option
 * makes it visible. settings_print_light_warnings() has reported lights outside
 * the angles of the model. */
static void print_faint_flare_remedy(const struct overlay *o,
                                     const struct overlay_light *light,
                                     FILE *to)
{
    const struct drawing *drawing = &o->drawing;
    const struct glint_engine_report *const report = &drawing->run.report;
    const bool is_beyond = light->peak <= 0 && report->beyond_lights > 0 &&
                           report->beyond_lights == report->lights;
    const bool is_held =
        drawing->line.settings.options.gain <= 0 ||
        (!GLINT_OPTION_GIVEN(&drawing->line.settings.options, exposure) &&
         drawing->line.settings.options.strength <= 0);

    if (is_held)
        fprintf(to, "%s: no flare was drawn because of %s\n", o->output,
                drawing->line.settings.options.gain <= 0 ? "--gain 0"
                                                         : "--strength 0");
    else if (is_beyond)
        return;
    else if (light->peak <= 0 && drawing->line.settings.options.stop_mask)
        fprintf(to,
                "%s: no light reaches the picture through this lens and its "
                "--stop-mask; white pixels of a mask transmit light\n",
                o->output);
    else if (light->peak <= 0 && are_all_lamps_off_screen(drawing))
        fprintf(to,
                "%s: no ghost reaches the picture, because all lamps lie "
                "outside it; move one into or near the %dx%d pixels\n",
                o->output, drawing->run.view.width, drawing->run.view.height);
    else if (light->peak <= 0)
        fprintf(to,
                "%s: no light of the flare reaches the picture with this lens; "
                "try another one (--lens)\n",
                o->output);
    else if (GLINT_OPTION_GIVEN(&drawing->line.settings.options, exposure))
        fprintf(to,
                "%s: the flare is %.1f stops too faint to be seen; use "
                "--strength instead of --exposure, or --exposure %+.0f\n",
                o->output, log2(least_seen / light->peak),
                drawing->line.settings.options.exposure +
                    ceil(log2(well_seen / light->peak)));
    else
        fprintf(to,
                "%s: the flare is %.1f stops too faint to be seen; use "
                "--strength %.2g\n",
                o->output, log2(least_seen / light->peak),
                drawing->line.settings.options.strength *
                    sqrt(well_seen / light->peak));
}

/* Returns what was drawn on a picture without lamps, for a message: "only the
 * veil", "no flare" (but a scene), or "nothing". */
static const char *describe_picture_without_lamps(const struct drawing *drawing)
{
    return drawing->run.engine && glint_engine_has_veil(drawing->run.engine)
               ? "only the veil"
           : drawing->files.scene.is_open ? "no flare"
                                          : "nothing";
}

/* Returns whether --mask or --edge-fade removed the light of all lamps. For
 * several frames, returns whether LIGHT, the light of all flares, is 0 and all
 * lamps of the last frame are hidden. */
static bool are_all_lamps_hidden(const struct drawing *drawing,
                                 const struct overlay_light *light)
{
    if (!drawing->files.occlusion.file &&
        !(drawing->files.occlusion.fade_px > 0))
        return false;
    if (drawing->run.n_lamps == 0 ||
        (drawing->run.n_frames > 1 && light->peak > 0))
        return false;
    for (int i = 0; i < drawing->run.n_lamps; i++)
        if (drawing->run.lamp[i].lamp.power > 0)
            return false;
    return true;
}

static void print_hidden_lamps(const struct drawing *drawing, int most,
                               FILE *to)
{
    const struct occlusion *const o = &drawing->files.occlusion;
    const bool both = o->file && o->fade_px > 0;

    fprintf(to, "%s%d light%s, but %s %s %s, so %s was drawn\n",
            drawing->run.n_frames > 1 ? "at most " : "", most,
            most == 1 ? "" : "s",
            both      ? "--mask and --edge-fade"
            : o->file ? "--mask"
                      : "--edge-fade",
            both ? "hide" : "hides", most == 1 ? "it" : "all of them",
            describe_picture_without_lamps(drawing));
}

/* Prints the --light-at options that add lamps at the candidates, of which
 * there must be one. */
static void print_lamp_candidates(const struct drawing *drawing, FILE *to)
{
    struct glint_spot next;
    const bool is_one = !drawing_get_candidate(drawing, 1, &next);

    fprintf(to, "brightest candidate%s:", is_one ? "" : "s");
    for (int i = 0; drawing_get_candidate(drawing, i, &next); i++)
        fprintf(to, " --light-at %.0f,%.0f", next.x_q8 / 256.0,
                next.y_q8 / 256.0);
}

void overlay_print_no_lamp_found(const struct drawing *drawing, bool is_copied,
                                 FILE *to)
{
    struct glint_spot next;
    const bool is_searched = drawing_searches_picture(drawing);
    const bool is_next =
        drawing->run.n_frames <= 1 && drawing_get_candidate(drawing, 0, &next);

    fprintf(to, "no light was %s, so %s was drawn%s; ",
            !is_searched                               ? "given"
            : drawing_find_removal(drawing, true) >= 0 ? "left"
                                                       : "found",
            describe_picture_without_lamps(drawing),
            is_copied ? " and the file was copied" : "");
    if (is_next)
        print_lamp_candidates(drawing, to);
    else
        fputs("place a lamp by --light-at X,Y", to);
    if (over_scene_has_lights_without_flare(&drawing->files.scene))
        fputs("; 'flare lights' in the scene file makes its lights visible to "
              "the lens",
              to);
    fputc('\n', to);
}

/* Prints the --light-at options that remove the lamps found, one each. */
static void print_removals(const struct drawing *drawing, FILE *to)
{
    const struct drawing_run *const run = &drawing->run;

    fprintf(to, "; to remove %s:", run->n_found == 1 ? "it" : "one");
    for (int i = 0; i < run->n_found; i++)
        fprintf(to, " --light-at %.0f,%.0f,off",
                run->lamp[i].track.x_q8 / 256.0,
                run->lamp[i].track.y_q8 / 256.0);
}

/* Prints a warning if X,Y,off of --light-at removed no lamp of a picture. */
static void print_idle_removal(const struct overlay *o, FILE *to)
{
    const struct drawing *const drawing = &o->drawing;
    const int k =
        drawing->run.n_frames == 1 ? drawing_find_removal(drawing, false) : -1;

    if (k >= 0)
        fprintf(to,
                "%s: no lamp was found at %g%s,%g%s, so --light-at removed "
                "none there; --show lights lists the lamps\n",
                o->output, drawing->line.at[k].xy[0],
                drawing->line.at[k].is_percent[0] ? "%" : "",
                drawing->line.at[k].xy[1],
                drawing->line.at[k].is_percent[1] ? "%" : "");
}

/* Prints a warning for each lamp of --light-at where a picture is dark. */
static void print_lamps_on_dark(const struct overlay *o, FILE *to)
{
    const struct drawing *const drawing = &o->drawing;

    for (int k = 0; k < drawing->line.n_at; k++)
        if (drawing->run.n_frames == 1 && drawing->run.at[k].is_on_dark)
            fprintf(to,
                    "%s: no pixel is bright at %g%s,%g%s, so the lamp of "
                    "--light-at is not one of the picture; --show lights marks "
                    "those that are\n",
                    o->output, drawing->line.at[k].xy[0],
                    drawing->line.at[k].is_percent[0] ? "%" : "",
                    drawing->line.at[k].xy[1],
                    drawing->line.at[k].is_percent[1] ? "%" : "");
}

/* Prints how many lamps --show lights marked, the options that remove them, and
 * the candidates. */
static void print_marked_lamps(const struct overlay *o, FILE *to)
{
    const struct drawing *const drawing = &o->drawing;
    struct glint_spot next;

    print_lights(drawing, o->figures.most_lights, to);
    fputs(o->figures.most_lights == 1 ? ", marked" : ", all marked", to);
    if (drawing->run.n_frames <= 1 && drawing->run.n_found > 0)
        print_removals(drawing, to);
    if (drawing->run.n_frames <= 1 &&
        drawing_get_candidate(drawing, 0, &next)) {
        fputs("; ", to);
        print_lamp_candidates(drawing, to);
    }
    fputc('\n', to);
}

void overlay_print_summary(const struct overlay *o,
                           const struct overlay_light *light, FILE *to)
{
    const struct drawing *drawing = &o->drawing;
    const double seconds = tool_clock_s() - o->figures.started;
    const int n = overlay_count_frames(o);

    print_idle_removal(o, to);
    print_lamps_on_dark(o, to);
    fprintf(to, "%s: ", o->output);
    if (n != 1)
        fprintf(to, "%d frames, %.1f a second, ", n, n / seconds);
    if (drawing->files.scene.is_open)
        over_scene_print_line(&drawing->files.scene, to);
    if (!drawing->files.has_lens) {
        fprintf(to, "; %.0f ms\n", 1e3 * seconds);
        return;
    }
    if (drawing->files.scene.is_open)
        fputs(", ", to);
    if (o->figures.most_lights == 0) {
        overlay_print_no_lamp_found(drawing, o->is_copied, to);
        return;
    }
    if (drawing->line.show_lights) {
        print_marked_lamps(o, to);
        return;
    }
    if (are_all_lamps_hidden(drawing, light)) {
        print_hidden_lamps(drawing, o->figures.most_lights, to);
        return;
    }
    if (n == 1 && drawing->files.scene.lamps_hidden >= drawing->run.n_lamps) {
        fprintf(to,
                "%d light%s, all hidden by objects, so no flare was drawn\n",
                o->figures.most_lights, o->figures.most_lights == 1 ? "" : "s");
        return;
    }
    print_lights(drawing, o->figures.most_lights, to);
    print_lens(drawing, to);
    print_brightness_options(&o->figures, to);
    if (light->is_known)
        fprintf(to, ": %s at %.*g %% of white, mean %.2g %%",
                drawing->line.settings.options.only == GLINT_ONLY_STARBURST
                    ? "the starburst peaks"
                : drawing->line.settings.options.only == GLINT_ONLY_VEIL
                    ? "the veil peaks"
                    : "the ghosts peak",
                light->peak < 1 ? 2 : 3, 100 * light->peak, 100 * light->mean);
    fprintf(to, "; %.0f ms\n", 1e3 * seconds);
    if (light->is_known && light->peak < least_seen)
        print_faint_flare_remedy(o, light, to);
}

/* -------------------------------------------------------------------- JSON */

void overlay_write_json(struct json_writer *json, const struct overlay *o,
                        const struct overlay_light *light)
{
    const struct drawing *drawing = &o->drawing;
    const double focal = drawing->files.lens.setup.optics.focal_mm;

    over_scene_write_json(json, &drawing->files.scene);
    if (!drawing->files.has_lens) {
        json_write(json, "lens: null, found: []");
        return;
    }
    json_write(
        json,
        "lens: %s, rays: %s, f_number: %g, strength: %g, scale_ev: %.3f, "
        "peak: %.6g, mean: %.6g, found: [",
        drawing->files.lens.table.name,
        drawing->files.lens.model.data ? "model" : "exact",
        get_lens_f_number(&drawing->files.lens),
        GLINT_OPTION_GIVEN(&drawing->line.settings.options, exposure)
            ? (double)NAN
            : drawing->line.settings.options.strength,
        log2(drawing_get_exposure_factor(&drawing->run)),
        light->is_known ? light->peak : (double)NAN,
        light->is_known ? light->mean : (double)NAN);
    for (int i = 0; i < drawing->run.n_lamps; i++) {
        const struct glint_engine_lamp *known = &drawing->run.lamp[i];
        const struct glint_lamp *l = &known->lamp;
        double x, y;

        glint_view_to_pixel(&drawing->run.view, focal, l, &x, &y);
        json_write(json,
                   "{x: %.2f, y: %.2f, stops: %.2f, rgb: [%.4g, %.4g, %.4g]}",
                   x, y, convert_lamp_power_to_stops(known), l->rgb[0],
                   l->rgb[1], l->rgb[2]);
    }
    json_write(json, "]");
}
