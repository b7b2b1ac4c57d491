/* SPDX-License-Identifier: MIT
 *
 * Spot diagrams below a section.
 */
#include <math.h>

#include "lens_figures/figure.h"
#include "lens_figures/spots.h"

enum { SPOT_PX = 170 };
#define BELOW_PX  40.0 /* from the section to the boxes */
#define LEGEND_PX 48.0 /* below them */

static const char *const spot_colour[SPOT_COLOURS] = {"#2a52d0", "#2f9a3c",
                                                      "#d0342a"};

double figure_spots_px(const struct figure *f)
{
    return f->drawing->spots ? BELOW_PX + SPOT_PX + LEGEND_PX : 0;
}

static double top_px(const struct figure *f)
{
    return f->middle + 0.5 * f->height_px + BELOW_PX;
}

static double per_mm(double mm)
{
    return mm < 1 ? 1e3 : 1;
}

static const char *unit(double mm)
{
    return mm < 1 ? "µm" : "mm";
}

static void draw_box(const struct figure *f, double x, double y)
{
    fprintf(f->file,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\" "
            "fill=\"#fff\" stroke=\"#888\" stroke-width=\"0.7\"/>\n"
            "<path d=\"M%.1f %.1f h%d M%.1f %.1f v%d\" stroke=\"#ddd\" "
            "stroke-width=\"0.6\"/>\n",
            x, y, SPOT_PX, SPOT_PX, x, y + 0.5 * SPOT_PX, SPOT_PX,
            x + 0.5 * SPOT_PX, y, SPOT_PX);
}

static void draw_one(const struct figure *f, const struct spots *s, int field,
                     double theta)
{
    const double step =
        (f->drawing->width_px - 2 * FIGURE_MARGIN_PX) / DRAWING_FIELDS;
    const double cx = FIGURE_MARGIN_PX + step * (field + 0.5);
    const double cy = top_px(f) + 0.5 * SPOT_PX;
    const double half_mm = figure_round_up(s->radius_mm);
    const double scale = 0.5 * SPOT_PX / half_mm;

    draw_box(f, cx - 0.5 * SPOT_PX, cy - 0.5 * SPOT_PX);
    for (int c = 0; c < SPOT_COLOURS; c++) {
        fprintf(f->file, "<g fill=\"%s\">\n", spot_colour[c]);
        for (int k = 0; k < s->n; k++)
            if (s->colour[k] == c)
                fprintf(f->file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\".8\"/>\n",
                        cx + scale * (s->at[k][1] - s->middle[1]),
                        cy - scale * (s->at[k][0] - s->middle[0]));
        fputs("</g>\n", f->file);
    }
    fprintf(f->file,
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" "
            "fill=\"%s\">%.1f°, RMS %.3g %s</text>\n"
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" "
            "fill=\"#444\">side %.4g %s</text>\n",
            cx, cy - 0.5 * SPOT_PX - 7, figure_field_colour[field], theta,
            per_mm(s->rms_mm) * s->rms_mm, unit(s->rms_mm), cx,
            cy + 0.5 * SPOT_PX + 15, per_mm(half_mm) * 2 * half_mm,
            unit(half_mm));
}

/* Says what the colours are, to the right below the boxes. */
static void draw_legend(const struct figure *f)
{
    const double y = top_px(f) + SPOT_PX + 34;
    const double end = f->drawing->width_px - FIGURE_MARGIN_PX;

    for (int c = 0; c < SPOT_COLOURS; c++) {
        const double x = end - 66 * (SPOT_COLOURS - c);

        fprintf(f->file,
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>"
                "<text x=\"%.1f\" y=\"%.1f\" fill=\"#444\">%.0f nm</text>\n",
                x, y - 4, spot_colour[c], x + 7, y, spots_nm(c));
    }
}

void figure_draw_spots(const struct figure *f)
{
    struct spots s;

    for (int i = 0; i < DRAWING_FIELDS; i++) {
        const double theta = figure_field_deg(f, i);

        spots_gather(&s, f->drawing->lens, f->drawing->plane_deg, theta);
        draw_one(f, &s, i, theta);
    }
    draw_legend(f);
}
