/* SPDX-License-Identifier: MIT
 *
 * The lens in section: glasses, barrels, stop, axis and sensor.
 */
#include <math.h>

#include "glint/glint.h"
#include "lens_figures/figure.h"

enum { PROFILE = 24 };
#define TITLE_PX  52.0
#define HEIGHT_PX 400.0 /* most that the section takes */

/* ------------------------------------------------------------------ places */

/* Sets AT to the point of surface K at the height X of the section's plane. */
static void rim_point(const struct figure *f, int k, double x, double at[3])
{
    const double phi = f->drawing->plane_deg;
    const double angle = phi * GLINT_PI / 180;

    if (!glint_surface_point(&f->drawing->lens->surface[k], phi, x * cos(angle),
                             x * sin(angle), at)) {
        at[0] = x;
        at[1] = at[2] = 0;
    }
    at[2] += f->vertex[k];
}

void figure_meeting(const struct figure *f, const struct glint_event *event,
                    const double hit[2], double at[2])
{
    const struct glint_prescription *lens = f->drawing->lens;
    double point[3] = {hit[0], hit[1], 0};

    if (event->kind == GLINT_STOP)
        at[0] = f->stop_z;
    else {
        /* A hit of a shaped surface is in its own frame, as X and Y are. */
        if (!glint_surface_point(&lens->surface[event->surface],
                                 event->shaped ? f->drawing->plane_deg : 0,
                                 hit[0], hit[1], point))
            point[2] = 0;
        at[0] = f->vertex[event->surface] + point[2];
    }
    at[1] = point[0];
}

static void place_vertices(struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    double z = lens->stop_after == 0 ? -lens->stop_thickness_mm : 0;

    for (int k = 0; k <= lens->n_surfaces; k++) {
        if (k == lens->stop_after) {
            f->stop_z = z;
            z += lens->stop_thickness_mm;
        }
        if (k == lens->n_surfaces)
            break;
        f->vertex[k] = z;
        z += lens->surface[k].thickness_mm;
    }
    f->sensor_z = z;
}

/* Sets what of the picture lies in the section's plane: all of its diagonal,
 * unless the lens tells its planes apart. */
static void set_film(struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    const bool along_x = f->drawing->plane_deg == 0;
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    f->widen = along_x ? optics.squeeze : 1;
    f->film_mm =
        glint_prescription_is_round(lens)
            ? 0.5 * hypot(lens->film_width_mm, lens->film_height_mm)
            : 0.5 * (along_x ? lens->film_width_mm : lens->film_height_mm);
}

void figure_begin(struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    const double width = f->drawing->width_px - 2 * FIGURE_MARGIN_PX;
    double length, least, at[3];

    place_vertices(f);
    set_film(f);
    least = fmin(0, f->stop_z);
    f->x1 = fmax(f->film_mm / f->widen, lens->stop_semi_mm);
    for (int k = 0; k < lens->n_surfaces; k++)
        for (int side = -1; side <= 1; side += 2) {
            rim_point(f, k, side * lens->surface[k].semi_mm, at);
            f->x1 = fmax(f->x1, fabs(at[0]));
            least = fmin(least, at[2]);
        }
    length = f->sensor_z - least;
    f->x1 *= 1.12;
    f->z0 = least - 0.16 * length;
    f->z1 = f->sensor_z + 0.02 * length;
    f->scale = fmin(width / (f->z1 - f->z0), HEIGHT_PX / (2 * f->x1));
    /* What is left of the width shows more of the way to the lens. */
    f->z0 = fmax(f->z1 - width / f->scale, least - 0.6 * length);
    f->height_px = 2 * f->x1 * f->scale;
    f->left = 0.5 * (f->drawing->width_px - f->scale * (f->z1 - f->z0)) -
              f->scale * f->z0;
    f->middle =
        (f->drawing->title ? TITLE_PX : FIGURE_MARGIN_PX) + 0.5 * f->height_px;
}

/* ---------------------------------------------------------------- the lens */

void figure_profile(const struct figure *f, int k, int sense)
{
    const double semi = f->drawing->lens->surface[k].semi_mm;
    double at[3];

    for (int i = -PROFILE; i <= PROFILE; i++) {
        rim_point(f, k, sense * semi * i / PROFILE, at);
        fprintf(f->file, "%.2f,%.2f ", figure_px(f, at[2]),
                figure_py(f, at[0]));
    }
}

/* Writes the edge of the glass between surfaces K and K + 1, at the upper side
 * or the lower: out to the wider of the two, and along. */
static void write_edge(const struct figure *f, int k, int side)
{
    const struct glint_surface *s = &f->drawing->lens->surface[k];
    double a[3], b[3], out;

    rim_point(f, k, side * s[0].semi_mm, a);
    rim_point(f, k + 1, side * s[1].semi_mm, b);
    out = side * fmax(side * a[0], side * b[0]);
    if (side > 0)
        fprintf(f->file, "%.2f,%.2f %.2f,%.2f ", figure_px(f, a[2]),
                figure_py(f, out), figure_px(f, b[2]), figure_py(f, out));
    else
        fprintf(f->file, "%.2f,%.2f %.2f,%.2f", figure_px(f, b[2]),
                figure_py(f, out), figure_px(f, a[2]), figure_py(f, out));
}

/* Draws the glass behind surface K: the denser, the darker. */
static void draw_glass(const struct figure *f, int k)
{
    const struct glint_surface *s = &f->drawing->lens->surface[k];
    const double shade = fmin(1, fmax(0, (s->nd - 1.4) / 0.6));

    fprintf(f->file,
            "<polygon fill=\"#%02x%02x%02x\" stroke=\"#26323f\" "
            "stroke-width=\"0.9\" stroke-linejoin=\"round\" points=\"",
            (unsigned)(232 - 62 * shade), (unsigned)(241 - 46 * shade),
            (unsigned)(250 - 26 * shade));
    figure_profile(f, k, 1);
    write_edge(f, k, 1);
    figure_profile(f, k + 1, -1);
    write_edge(f, k, -1);
    fprintf(f->file,
            "\"><title>surface %d; nd %.5g, Vd %.4g</title></polygon>\n", k,
            s->nd, s->vd);
}

/* Draws the barrel that holds the glass from surface FIRST to LAST. */
static void draw_barrel(const struct figure *f, int first, int last)
{
    const struct glint_prescription *lens = f->drawing->lens;
    const double wall = 3.5;
    double semi[2] = {0, 0}, a = 1e30, b = -1e30, at[3];

    for (int k = first; k <= last; k++)
        for (int side = 0; side < 2; side++) {
            rim_point(f, k, (side ? 1 : -1) * lens->surface[k].semi_mm, at);
            semi[side] = fmax(semi[side], fabs(at[0]));
            a = fmin(a, fmin(f->vertex[k], at[2]));
            b = fmax(b, fmax(f->vertex[k], at[2]));
        }
    for (int side = 0; side < 2; side++)
        fprintf(f->file,
                "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.1f\" "
                "fill=\"url(#hatch-%s)\" stroke=\"#777\" "
                "stroke-width=\"0.5\"/>\n",
                figure_px(f, a),
                side ? figure_py(f, semi[1]) - wall : figure_py(f, -semi[0]),
                f->scale * (b - a), wall, lens->name);
}

void figure_draw_glasses(const struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    int first = -1;

    for (int k = 0; k < lens->n_surfaces; k++) {
        if (lens->surface[k].vd > 0) {
            first = first < 0 ? k : first;
            draw_glass(f, k);
        } else if (first >= 0) {
            draw_barrel(f, first, k);
            first = -1;
        }
    }
}

void figure_draw_stop(const struct figure *f, double radius)
{
    const double end =
        fmax(f->drawing->lens->stop_semi_mm * 1.18, radius + 9 / f->scale);

    for (int side = -1; side <= 1; side += 2)
        fprintf(f->file,
                "<path d=\"M%.2f %.2f V%.2f M%.2f %.2f h6\" stroke=\"#111\" "
                "stroke-width=\"2.2\" fill=\"none\"/>\n",
                figure_px(f, f->stop_z), figure_py(f, side * radius),
                figure_py(f, side * end), figure_px(f, f->stop_z) - 3,
                figure_py(f, side * radius));
}

void figure_draw_number(const struct figure *f, int k)
{
    double at[3];

    rim_point(f, k, f->drawing->lens->surface[k].semi_mm, at);
    fprintf(f->file,
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" "
            "fill=\"#a2640c\">%d</text>\n",
            figure_px(f, at[2]), figure_py(f, at[0]) - 7, k);
}

void figure_draw_axis_and_sensor(const struct figure *f)
{
    const double film = f->film_mm / f->widen;

    fprintf(f->file,
            "<path d=\"M%.2f %.2f H%.2f\" stroke=\"#888\" stroke-width=\"0.6\" "
            "stroke-dasharray=\"12 3 2 3\"/>\n"
            "<path d=\"M%.2f %.2f V%.2f\" stroke=\"#111\" "
            "stroke-width=\"2\"/>\n",
            figure_px(f, f->z0), figure_py(f, 0), figure_px(f, f->z1),
            figure_px(f, f->sensor_z), figure_py(f, film), figure_py(f, -film));
}
