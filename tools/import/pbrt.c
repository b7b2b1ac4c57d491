/* SPDX-License-Identifier: MIT
 *
 * Reads lens tables of pbrt: radius, distance, index and diameter of each
 * surface, in mm. A surface with radius 0 and index 0 is the stop.
 *
 * A distance is measured to the next surface. The older tables, of 100 mm
 * lenses, measure the distance to the previous surface instead. Such tables are
 * recognised because the first distance is 0 and the last is not.
 */
#include "import/lines.h"

static bool parse_element_line(struct imported *lens, const struct lines *l)
{
    struct imported_surface *s = imported_add_surface(lens, l->number);
    double index, diameter;

    if (!s)
        return false;
    if (l->n > 4)
        return imported_report_error(lens, l->number,
                                     "'%.40s' is too many: a line has radius, "
                                     "distance, index and diameter",
                                     l->word[4]);
    if (!lines_parse_number(l, 0, "radius", &s->radius) ||
        !lines_parse_number(l, 1, "distance", &s->thickness) ||
        !lines_parse_number(l, 2, "index", &index) ||
        !lines_parse_number(l, 3, "diameter", &diameter))
        return false;
    s->stop = s->radius == 0 && index == 0;
    s->nd = index == 0 ? 1 : index;
    s->semi = diameter / 2;
    return true;
}

bool import_pbrt(struct imported *lens, const char *text, size_t bytes)
{
    struct lines lines;

    lines_init(&lines, lens, text, bytes);
    while (lines_read_next(&lines, '#'))
        if (!parse_element_line(lens, &lines))
            return false;
    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    if (lens->surface[0].thickness != 0 ||
        lens->surface[lens->n - 1].thickness == 0)
        return true;
    for (int k = 0; k + 1 < lens->n; k++)
        lens->surface[k].thickness = lens->surface[k + 1].thickness;
    lens->surface[lens->n - 1].thickness = 0;
    return imported_add_note(
        lens, lens->surface[0].line,
        "the first distance is 0; distances are assumed to "
        "start at the surface before");
}
