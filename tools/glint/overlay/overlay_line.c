/* SPDX-License-Identifier: MIT */
#include "overlay/overlay_line.h"

#include <math.h>
#include <stdlib.h>

#include "glint/setup.h"
#include "overlay/compositor_layer.h"

/* Linear light, 1 = white, of code 2 of 255 in sRGB, whose slope near black is
 * 12.92. A darker flare cannot be seen. */
static const double least_seen = 2 / 255.0 / 12.92;
/* Linear light, 1 = white, at which a flare peaks with the option that is
 * suggested for one that cannot be seen. */
static const double well_seen = 0.25;

/* --------------------------------------------------------------- the light */

/* Returns whether the starburst or the veil is drawn by itself. */
static bool is_part(const struct compositor *compositor)
{
    return compositor->settings.options.only == GLINT_ONLY_STARBURST ||
           compositor->settings.options.only == GLINT_ONLY_VEIL;
}

/* Sets LIGHT to that of the layer that was drawn last; returns false without
 * memory. */
static bool measure_layer(struct compositor *compositor,
                          struct glint_response_light *light)
{
    const size_t n =
        (size_t)compositor->view.width * (size_t)compositor->view.height;
    const struct glint_engine_report report = compositor->report;
    float *rgb = malloc(3 * n * sizeof *rgb);
    const bool is_drawn =
        rgb && compositor_draw_layer(compositor, true, rgb) == GLINT_OK;

    if (is_drawn) {
        glint_response_around(rgb, n, light);
        for (int c = 0; c < 3; c++) {
            light->peak[c] /= compositor->white;
            light->mean[c] /= compositor->white;
        }
    }
    compositor->report = report;
    free(rgb);
    return is_drawn;
}

int overlay_drawn(const struct overlay *o)
{
    const int n = o->compositor.n_frames;

    return n > o->first ? n - o->first : 0;
}

struct overlay_light overlay_light(struct overlay *o)
{
    struct compositor *compositor = &o->compositor;
    const int n = overlay_drawn(o);
    struct overlay_light light = {true, o->peak, n ? o->mean_sum / n : 0};
    struct glint_response_light drawn;

    if (is_part(compositor) && compositor->n_lamps > 0 &&
        compositor_scale(compositor) > 0) {
        light.is_known =
            compositor->n_frames == 1 && measure_layer(compositor, &drawn);
        if (light.is_known) {
            light.peak = glint_largest_channel(drawn.peak);
            light.mean = glint_largest_channel(drawn.mean);
        }
        return light;
    }
    if (n != 1 || compositor->n_lamps == 0 ||
        compositor_scale(compositor) <= 0 ||
        glint_engine_exposed(compositor->engine)->is_drawn ||
        glint_engine_measure(compositor->engine, compositor->lamp,
                             compositor->n_lamps, &drawn) != GLINT_OK)
        return light;
    light.peak = compositor_scale(compositor) / compositor->white *
                 glint_largest_channel(drawn.peak);
    light.mean = compositor_scale(compositor) / compositor->white *
                 glint_largest_channel(drawn.mean);
    return light;
}

/* Returns the power of LAMP in stops over a white pixel. */
static double stops_of(const struct glint_engine_lamp *lamp)
{
    return log2(fmax(lamp->lamp.power, 1e-30));
}

static double f_number_of(const struct settings *s)
{
    return s->model.data ? model_real_of(s->model.lens.header->f_number) /
                               s->setup.opening
                         : s->lens.f_number;
}

/* ---------------------------------------------------------------- the line */

static const struct glint_engine_lamp *
brightest_of(const struct compositor *compositor)
{
    const struct glint_engine_lamp *best = compositor->lamp;

    for (int i = 1; i < compositor->n_lamps; i++)
        if (compositor->lamp[i].lamp.power > best->lamp.power)
            best = &compositor->lamp[i];
    return best;
}

/* Returns X to print as a whole number, which is never -0. */
static double whole(double x)
{
    return rint(x) + 0.0;
}

static void say_lights(const struct compositor *compositor, int most, FILE *to)
{
    const struct glint_engine_lamp *lamp;
    double x, y;

    fprintf(to, "%s%d light%s", compositor->n_frames == 1 ? "" : "at most ",
            most, most == 1 ? "" : "s");
    if (compositor->n_lamps == 0 || compositor->n_frames > 1)
        return;
    lamp = brightest_of(compositor);
    glint_view_to_pixel(&compositor->view,
                        compositor->settings.setup.optics.focal_mm, &lamp->lamp,
                        &x, &y);
    fprintf(to, " (%s%.0f stops over a white pixel, at %.0f,%.0f)",
            most == 1 ? "" : "the brightest ", stops_of(lamp), whole(x),
            whole(y));
}

static void say_dial(const struct compositor *compositor, FILE *to)
{
    if (GLINT_OPTION_GIVEN(&compositor->settings.options, exposure))
        fprintf(to, "exposure %+g EV", compositor->settings.options.exposure);
    else
        fprintf(to, "strength %g", compositor->settings.options.strength);
    if (compositor->settings.options.gain != 1)
        fprintf(to, ", gain %g", compositor->settings.options.gain);
}

/* Prints which option would show a flare that is as faint as LIGHT. */
static void say_faint(const struct overlay *o,
                      const struct overlay_light *light, FILE *to)
{
    const struct compositor *compositor = &o->compositor;
    const bool is_held =
        compositor->settings.options.gain <= 0 ||
        (!GLINT_OPTION_GIVEN(&compositor->settings.options, exposure) &&
         compositor->settings.options.strength <= 0);

    if (is_held)
        fprintf(to, "%s: %s draws nothing, as it says\n", o->output,
                compositor->settings.options.gain <= 0 ? "--gain 0"
                                                       : "--strength 0");
    else if (light->peak <= 0 && compositor->settings.stop.mask_file)
        fprintf(to,
                "%s: no light gets through this lens and its --stop-mask into "
                "the picture; white in a mask lets light through\n",
                o->output);
    else if (light->peak <= 0)
        fprintf(to,
                "%s: no light gets through this lens into the picture; "
                "another one (--lens) may show a flare\n",
                o->output);
    else if (GLINT_OPTION_GIVEN(&compositor->settings.options, exposure))
        fprintf(to,
                "%s: that is %.1f stops below what can be seen; --strength "
                "instead of --exposure, or --exposure %+.0f, shows it\n",
                o->output, log2(least_seen / light->peak),
                compositor->settings.options.exposure +
                    ceil(log2(well_seen / light->peak)));
    else
        fprintf(to,
                "%s: that is %.1f stops below what can be seen; --strength "
                "%.2g shows it\n",
                o->output, log2(least_seen / light->peak),
                compositor->settings.options.strength *
                    sqrt(well_seen / light->peak));
}

/* Returns what the picture has where no lamp gives light. */
static const char *rest_of(const struct compositor *compositor)
{
    return compositor->engine && glint_engine_has_veil(compositor->engine)
               ? "only the veil"
           : compositor->scene.is_open ? "no flare"
                                       : "nothing";
}

/* Returns whether lamps were there, but a mask or fade leaves none of their
 * light: of several frames as far as the flare's LIGHT and the last tell. */
static bool is_hidden(const struct compositor *compositor,
                      const struct overlay_light *light)
{
    if (!compositor->occlusion.file && !(compositor->occlusion.fade_px > 0))
        return false;
    if (compositor->n_lamps == 0 ||
        (compositor->n_frames > 1 && light->peak > 0))
        return false;
    for (int i = 0; i < compositor->n_lamps; i++)
        if (compositor->lamp[i].lamp.power > 0)
            return false;
    return true;
}

static void say_hidden(const struct compositor *compositor, int most, FILE *to)
{
    const struct occlusion *const o = &compositor->occlusion;
    const bool both = o->file && o->fade_px > 0;

    fprintf(to, "%s%d light%s, but %s %s %s, so %s was drawn\n",
            compositor->n_frames > 1 ? "at most " : "", most,
            most == 1 ? "" : "s",
            both      ? "--mask and --edge-fade"
            : o->file ? "--mask"
                      : "--edge-fade",
            both ? "hide" : "hides", most == 1 ? "it" : "all of them",
            rest_of(compositor));
}

void overlay_say_none(const struct compositor *compositor, FILE *to)
{
    const bool is_found = !compositor->is_listed && compositor->n_hand == 0;
    struct glint_spot next;
    const bool is_next = compositor->engine && is_found &&
                         compositor->n_frames <= 1 &&
                         glint_engine_doubtful(compositor->engine, &next);

    fprintf(to, "no light was found, so %s was drawn; ", rest_of(compositor));
    if (is_next)
        fprintf(to, "brightest candidate: --light-at %.0f,%.0f",
                next.x_q8 / 256.0, next.y_q8 / 256.0);
    else
        fputs("see --threshold, or give one with --light-at X,Y", to);
    if (over_scene_keeps_lights(&compositor->scene))
        fputs("; 'flare lights' in the scene shows its own to the lens", to);
    fputc('\n', to);
}

void overlay_say(const struct overlay *o, const struct overlay_light *light,
                 FILE *to)
{
    const struct compositor *compositor = &o->compositor;
    const double seconds = tool_seconds() - o->started;
    const int n = overlay_drawn(o);

    fprintf(to, "%s: ", o->output);
    if (n != 1)
        fprintf(to, "%d frames, %.1f a second, ", n, n / seconds);
    if (compositor->scene.is_open)
        over_scene_say(&compositor->scene, to);
    if (!compositor->has_lens) {
        fprintf(to, "; %.0f ms\n", 1e3 * seconds);
        return;
    }
    if (compositor->scene.is_open)
        fputs(", ", to);
    if (o->most_lights == 0) {
        overlay_say_none(compositor, to);
        return;
    }
    if (is_hidden(compositor, light)) {
        say_hidden(compositor, o->most_lights, to);
        return;
    }
    if (n == 1 && compositor->scene.lamps_hidden >= compositor->n_lamps) {
        fprintf(to, "%d light%s, hidden all, so no flare was drawn\n",
                o->most_lights, o->most_lights == 1 ? "" : "s");
        return;
    }
    say_lights(compositor, o->most_lights, to);
    fprintf(to, ", %s f/%.3g, ", compositor->settings.lens.name,
            f_number_of(&compositor->settings));
    say_dial(compositor, to);
    if (light->is_known)
        fprintf(to, ": %s at %.*g %% of white, %.2g %% on average",
                compositor->settings.options.only == GLINT_ONLY_STARBURST
                    ? "the starburst peaks"
                : compositor->settings.options.only == GLINT_ONLY_VEIL
                    ? "the veil peaks"
                    : "the ghosts peak",
                light->peak < 1 ? 2 : 3, 100 * light->peak, 100 * light->mean);
    fprintf(to, "; %.0f ms\n", 1e3 * seconds);
    if (light->is_known && light->peak < least_seen)
        say_faint(o, light, to);
}

/* -------------------------------------------------------------------- JSON */

void overlay_json(struct json_writer *json, const struct overlay *o,
                  const struct overlay_light *light)
{
    const struct compositor *compositor = &o->compositor;
    const double focal = compositor->settings.setup.optics.focal_mm;

    over_scene_json(json, &compositor->scene);
    if (!compositor->has_lens) {
        json_write(json, "lens: null, found: []");
        return;
    }
    json_write(json,
               "lens: %s, f_number: %g, strength: %g, scale_ev: %.3f, "
               "peak: %.6g, mean: %.6g, found: [",
               compositor->settings.lens.name,
               f_number_of(&compositor->settings),
               GLINT_OPTION_GIVEN(&compositor->settings.options, exposure)
                   ? (double)NAN
                   : compositor->settings.options.strength,
               log2(compositor_scale(compositor)),
               light->is_known ? light->peak : (double)NAN,
               light->is_known ? light->mean : (double)NAN);
    for (int i = 0; i < compositor->n_lamps; i++) {
        const struct glint_engine_lamp *known = &compositor->lamp[i];
        const struct glint_lamp *l = &known->lamp;
        double x, y;

        glint_view_to_pixel(&compositor->view, focal, l, &x, &y);
        json_write(json,
                   "{x: %.2f, y: %.2f, stops: %.2f, rgb: [%.4g, %.4g, %.4g]}",
                   x, y, stops_of(known), l->rgb[0], l->rgb[1], l->rgb[2]);
    }
    json_write(json, "]");
}
