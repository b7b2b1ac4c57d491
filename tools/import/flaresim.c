/* SPDX-License-Identifier: MIT
 *
 * Reads FlareSim's .lens files. They have lines "name:" and "focal_length:",
 * then "surfaces:" and one row per surface. The columns of a row are: radius or
 * "stop", thickness, index, Abbe number, semi-diameter, coating. A row of a
 * cylinder ends with cyl_x or cyl_y, the direction of the axis.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/lines.h"

static bool parse_surface_kind(struct imported *lens, const struct lines *l,
                               struct imported_surface *s)
{
    const char *kind = l->n > 6 ? l->word[6] : "";

    if (!*kind || strcmp(kind, "sphere") == 0 || strcmp(kind, "spherical") == 0)
        return true;
    if (strcmp(kind, "cyl_x") != 0 && strcmp(kind, "cyl_y") != 0)
        return imported_report_error(
            lens, l->number,
            "surfaces of type '%.40s' are not supported; cyl_x and cyl_y are",
            kind);
    s->shape.bend = kind[4] == 'x' ? GLINT_BEND_Y : GLINT_BEND_X;
    return true;
}

static bool parse_surface_row(struct imported *lens, const struct lines *l)
{
    struct imported_surface *s = imported_add_surface(lens, l->number);

    if (!s)
        return false;
    s->stop = lines_first_word_is(l, "stop");
    if ((!s->stop && !lines_parse_number(l, 0, "radius", &s->radius)) ||
        !lines_parse_number(l, 1, "thickness", &s->thickness) ||
        !lines_parse_number(l, 2, "index", &s->nd) ||
        !lines_parse_number(l, 3, "Abbe number", &s->vd) ||
        !lines_parse_number(l, 4, "semi-diameter", &s->semi))
        return false;
    if (s->nd == 1)
        s->vd = 0;
    return parse_surface_kind(lens, l, s);
}

/* Returns whether surface K extends too far: its semi-diameter exceeds the
 * radius of its sphere, or its rim crosses the next surface. */
static bool is_semi_diameter_too_large(const struct imported *lens, int k)
{
    const struct imported_surface *s = &lens->surface[k];

    if (s->radius != 0 && s->semi > fabs(s->radius))
        return true;
    return k + 1 < lens->n && !s[0].stop && !s[1].stop &&
           imported_compute_gap_at_height(
               s, IMPORT_FREE * fmin(s[0].semi, s[1].semi)) < 0;
}

/* Halves all semi-diameters if fewer surfaces are then too large, because some
 * files were made from tables of diameters. */
static bool halve_diameters(struct imported *lens)
{
    int at = -1, whole = 0, halved = 0;

    for (int k = 0; k < lens->n; k++)
        if (is_semi_diameter_too_large(lens, k) && whole++ == 0)
            at = k;
    for (int k = 0; k < lens->n; k++)
        lens->surface[k].semi /= 2;
    for (int k = 0; k < lens->n; k++)
        halved += is_semi_diameter_too_large(lens, k);
    if (halved < whole)
        return imported_add_note(
            lens, lens->surface[at].line,
            "semi-diameter %g is beyond the glass of radius "
            "%g: the column has diameters, and all are halved",
            2 * lens->surface[at].semi, lens->surface[at].radius);
    for (int k = 0; k < lens->n; k++)
        lens->surface[k].semi *= 2;
    return true;
}

bool import_flaresim(struct imported *lens, const char *text, size_t bytes)
{
    struct lines lines;
    bool rows = false, good = true;

    lines_init(&lines, lens, text, bytes);
    while (good && lines_read_next(&lines, '#')) {
        if (rows)
            good = parse_surface_row(lens, &lines);
        else if (lines_first_word_is(&lines, "name:"))
            snprintf(lens->title, sizeof lens->title, "%.230s", lines.rest);
        else if (lines_first_word_is(&lines, "focal_length:"))
            good =
                lines_parse_number(&lines, 1, "focal length", &lens->nominal);
        else if (lines_first_word_is(&lines, "squeeze:"))
            good = true;
        else if (lines_first_word_is(&lines, "surfaces:"))
            rows = true;
        else
            good = imported_report_error(
                lens, lines.number, "unknown word '%.40s'%s", lines.word[0],
                lines_first_word_is(&lines, "name")
                    ? ": this already is a glint lens table"
                    : "");
    }
    if (!good)
        return false;
    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    return halve_diameters(lens) &&
           imported_add_note(lens, 0, "coatings are ignored");
}
