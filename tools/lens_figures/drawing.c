/* SPDX-License-Identifier: MIT */
#include "lens_figures/drawing.h"

#include <math.h>

#include "lens_figures/fans.h"

void drawing_defaults(struct lens_drawing *d,
                      const struct glint_prescription *lens)
{
    *d = (struct lens_drawing){.lens = lens,
                               .ghost = -1,
                               .angle_deg = -1,
                               .rays = 7,
                               .spots = true,
                               .title = true,
                               .width_px = 960};
}

/* -------------------------------------------------------------------- rays */

/* Writes the path of a ray that starts at X mm in the front vertex plane. */
static void draw_ray(struct figure *f, const struct fan *fan, double x,
                     const struct glint_ray *ray, double (*hits)[2],
                     const char *colour)
{
    const double slope = fan->direction[0] / fan->direction[2];
    double back = f->z0;

    if (fabs(slope * back) > 4 * f->x1)
        back = -4 * f->x1 / fabs(slope);
    fprintf(f->file,
            "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.7\" "
            "stroke-linejoin=\"round\" d=\"M%.2f %.2f ",
            colour, figure_px(f, back), figure_py(f, x + slope * back));
    for (int e = 0; e < fan->path.n_events; e++) {
        const bool stop = fan->path.event[e].kind == GLINT_STOP;
        double at[2];

        /* A stop behind the front vertex is met before the glass by the line
         * of the light, not by the light. */
        if (stop && f->drawing->lens->stop_after == 0 &&
            f->drawing->lens->stop_thickness_mm < 0)
            continue;
        figure_meeting(f, &fan->path.event[e], hits[e], at);
        fprintf(f->file, "L%.2f %.2f ", figure_px(f, at[0]),
                figure_py(f, at[1]));
    }
    fprintf(f->file, "L%.2f %.2f\"/>\n", figure_px(f, f->sensor_z),
            figure_py(f, ray->sensor_x_mm / f->widen));
    f->shown++;
}

static void draw_fan(struct figure *f, const struct fan *fan,
                     const char *colour)
{
    const int n = f->drawing->rays;
    double hits[GLINT_MAX_EVENTS + 1][2], edge[2];
    struct glint_ray ray;

    if (!fan_edges(fan, edge))
        return;
    for (int i = 0; i < n; i++) {
        const double share = n > 1 ? (double)i / (n - 1) : 0.5;
        const double u = edge[0] + share * (edge[1] - edge[0]);

        if (fan_ray(fan, u, 0, &ray, hits))
            draw_ray(f, fan, fan_start_mm(fan, u), &ray, hits, colour);
    }
}

static void draw_rays(struct figure *f)
{
    struct fan fan;

    for (int i = DRAWING_FIELDS - 1; i >= 0; i--)
        if (fan_init(&fan, f->drawing->lens, NULL, FIGURE_NM,
                     f->drawing->plane_deg, figure_field_deg(f, i)))
            draw_fan(f, &fan, figure_field_colour[i]);
}

static void draw_ghost(struct figure *f, const struct glint_ghost *ghost,
                       double theta)
{
    struct fan fan;

    if (fan_init(&fan, f->drawing->lens, ghost, FIGURE_NM,
                 f->drawing->plane_deg, theta))
        draw_fan(f, &fan, "#c0392b");
    for (int i = 0; i < 2; i++) {
        const int k = i ? ghost->j : ghost->i;

        fprintf(f->file, "<polyline fill=\"none\" stroke=\"#d0881b\" "
                         "stroke-width=\"2.4\" points=\"");
        figure_profile(f, k, 1);
        fprintf(f->file, "\"/>\n");
    }
}

/* ------------------------------------------------------------------- words */

static void write_words(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '&' || *text == '<' || *text == '>')
            fprintf(file, "&#%d;", *text);
        else
            fputc(*text, file);
}

static void draw_title(const struct figure *f, const struct glint_optics *o,
                       const char *path)
{
    const struct glint_prescription *lens = f->drawing->lens;
    char focus[64] = "", across[48] = "";

    if (fabs(o->squeeze - 1) > 1e-6)
        snprintf(across, sizeof across, " up and down, %.2f across",
                 o->focal_mm / o->squeeze);
    if (f->drawing->focus_m > 0)
        snprintf(focus, sizeof focus, ", focused at %.4g m, light from afar",
                 f->drawing->focus_m);
    fprintf(f->file,
            "<text x=\"%.0f\" y=\"22\" font-size=\"15\" "
            "font-weight=\"bold\">",
            FIGURE_MARGIN_PX);
    write_words(f->file, lens->name);
    fprintf(f->file,
            "<tspan dx=\"10\" font-weight=\"normal\" font-size=\"12\">"
            "f = %.2f mm%s, f/%.3g%s%s</tspan></text>\n",
            o->focal_mm, across, lens->f_number, focus, path);
    fprintf(f->file, "<text x=\"%.0f\" y=\"40\" fill=\"#555\">",
            FIGURE_MARGIN_PX);
    write_words(f->file, lens->source);
    fputs("</text>\n", f->file);
}

static void draw_scale_bar(const struct figure *f)
{
    const double mm = figure_round_up(40 / f->scale);
    const double y = f->middle + 0.5 * f->height_px + 10;

    fprintf(f->file,
            "<path d=\"M%.1f %.1f h%.2f m0 -3 v6 m-%.2f -6 v6\" "
            "stroke=\"#333\" fill=\"none\" stroke-width=\"0.9\"/>\n"
            "<text x=\"%.1f\" y=\"%.1f\" fill=\"#333\">%g mm</text>\n",
            FIGURE_MARGIN_PX, y, mm * f->scale, mm * f->scale,
            FIGURE_MARGIN_PX + mm * f->scale + 6, y + 4, mm);
}

/* --------------------------------------------------------------------- all */

static void open_svg(const struct figure *f)
{
    const double width = f->drawing->width_px;
    const double height =
        f->middle + 0.5 * f->height_px + FIGURE_MARGIN_PX + figure_spots_px(f);

    fprintf(f->file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" "
            "height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" "
            "font-family=\"Helvetica,Arial,sans-serif\" font-size=\"11\">\n"
            "<defs><pattern id=\"hatch-%s\" width=\"4\" height=\"4\" "
            "patternUnits=\"userSpaceOnUse\"><path d=\"M0 4 L4 0\" "
            "stroke=\"#777\" stroke-width=\"0.7\"/></pattern>\n"
            "<clipPath id=\"view-%s\"><rect x=\"%.1f\" y=\"%.1f\" "
            "width=\"%.1f\" height=\"%.1f\"/></clipPath></defs>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            width, height, width, height, f->drawing->lens->name,
            f->drawing->lens->name, figure_px(f, f->z0),
            f->middle - 0.5 * f->height_px, f->scale * (f->z1 - f->z0),
            f->height_px);
}

/* Draws the rays, or those of the ghost; PATH receives what of the latter. */
static void draw_light(struct figure *f, char *path, size_t bytes)
{
    const struct lens_drawing *d = f->drawing;
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    double theta = d->angle_deg;

    if (d->ghost < 0) {
        draw_rays(f);
        return;
    }
    glint_ghost_list(d->lens, ghost, GLINT_MAX_GHOSTS);
    if (theta < 0)
        theta = figure_angle_deg(f, 0.5 * f->film_mm);
    draw_ghost(f, &ghost[d->ghost], theta);
    snprintf(path, bytes, "; ghost %d, surfaces %d and %d, light at %.3g°",
             d->ghost, ghost[d->ghost].i, ghost[d->ghost].j, theta);
    figure_draw_number(f, ghost[d->ghost].i);
    figure_draw_number(f, ghost[d->ghost].j);
}

int drawing_write(const struct lens_drawing *drawing, FILE *file)
{
    struct figure f = {.drawing = drawing, .file = file};
    struct glint_optics optics;
    char path[96] = "";

    glint_optics_of(drawing->lens, &optics);
    figure_begin(&f);
    open_svg(&f);
    figure_draw_axis_and_sensor(&f);
    figure_draw_glasses(&f);
    fprintf(file, "<g clip-path=\"url(#view-%s)\">\n", drawing->lens->name);
    draw_light(&f, path, sizeof path);
    fputs("</g>\n", file);
    figure_draw_stop(&f, optics.stop_radius_mm);
    if (drawing->title) {
        draw_title(&f, &optics, path);
        draw_scale_bar(&f);
    }
    if (drawing->spots)
        figure_draw_spots(&f);
    fputs("</svg>\n", file);
    return f.shown;
}
