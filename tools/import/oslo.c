/* SPDX-License-Identifier: MIT
 *
 * Reads OSLO .len files: spheres, conics and even aspheres.
 *
 * "LEN NEW" begins a lens, at the object surface; "NXT" begins the next
 * surface, and "RD", "TH", "AP", "GLA", "AST", "CC" and "AD" to "AH" set its
 * values.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/lines.h"

struct oslo {
    struct imported *lens;
    struct lines lines;
    struct imported_surface *s;
    bool ended;
};

static bool parse_glass(struct oslo *o)
{
    const struct lines *l = &o->lines;

    if (l->n < 2)
        return imported_report_error(o->lens, l->number,
                                     "the glass has no name");
    if (strncmp(l->word[1], "REFL", 4) == 0)
        return lines_reject_mirror(l);
    if (strcmp(l->word[1], "AIR") != 0)
        snprintf(o->s->glass, sizeof o->s->glass, "%s", l->word[1]);
    /* A glass that the file defines has three indices after its name. */
    if (l->n > 4) {
        double n[3];

        for (int i = 0; i < 3; i++)
            if (!lines_parse_number(l, 2 + i, "index", &n[i]))
                return false;
        o->s->nd = n[0];
        o->s->vd = n[1] != n[2] ? (n[0] - 1) / (n[1] - n[2]) : 0;
    }
    return true;
}

/* Handles an unsupported keyword: reports an error if the keyword changes the
 * lens, else adds a note. */
static bool reject_or_note_keyword(struct oslo *o)
{
    static const char *const shaping[] = {"TLA", "TLB", "TLC", "DCX", "DCY",
                                          "DCZ", "CVX", "PK",  "DT",  "ASP",
                                          "PI",  "PIC", "PU",  "PUC"};
    const struct lines *l = &o->lines;

    if (lines_first_word_is(l, "RFL") || lines_first_word_is(l, "RFH"))
        return lines_reject_mirror(l);
    for (size_t i = 0; i < sizeof shaping / sizeof *shaping; i++)
        if (lines_first_word_is(l, shaping[i]))
            return imported_report_error(
                o->lens, l->number,
                "'%s' is not supported: surfaces must be centred, not tilted, "
                "spheres, conics (CC) or aspheres (AD .. AH), and without "
                "pickups and solves",
                l->word[0]);
    return imported_note_unread_word(o->lens, l->number, l->word[0]);
}

static bool parse_surface_keyword(struct oslo *o)
{
    const struct lines *l = &o->lines;
    struct glint_shape *shape = &o->s->shape;

    if (lines_first_word_is(l, "RD"))
        return lines_parse_number(l, 1, "radius", &o->s->radius);
    if (lines_first_word_is(l, "CV"))
        return lines_parse_curvature(l, 1, &o->s->radius);
    if (lines_first_word_is(l, "TH"))
        return lines_parse_number(l, 1, "thickness", &o->s->thickness);
    if (lines_first_word_is(l, "AP"))
        return lines_parse_number(l, l->n > 2 ? 2 : 1, "semi-diameter",
                                  &o->s->semi);
    if (lines_first_word_is(l, "GLA"))
        return parse_glass(o);
    if (lines_first_word_is(l, "AIR"))
        return true;
    if (lines_first_word_is(l, "AST"))
        return o->s->stop = true;
    if (lines_first_word_is(l, "CC"))
        return lines_parse_number(l, 1, "conic", &shape->conic);
    if (strlen(l->word[0]) == 2 && l->word[0][0] == 'A' &&
        l->word[0][1] >= 'D' && l->word[0][1] <= 'H')
        return lines_parse_number(l, 1, "aspheric term",
                                  &shape->term[l->word[0][1] - 'D']);
    return reject_or_note_keyword(o);
}

static bool parse_header_keyword(struct oslo *o)
{
    const struct lines *l = &o->lines;
    double value;

    if (lines_first_word_is(l, "LEN") && l->n > 2)
        snprintf(o->lens->title, sizeof o->lens->title, "%s", l->word[2]);
    if (lines_first_word_is(l, "UNI"))
        return lines_parse_number(l, 1, "unit", &value) &&
               imported_set_unit(o->lens, l->number, value);
    if (lines_first_word_is(l, "EBR")) {
        if (!lines_parse_number(l, 1, "beam radius", &o->lens->pupil))
            return false;
        o->lens->pupil *= 2;
        return true;
    }
    if (lines_first_word_is(l, "ANG"))
        return lines_parse_number(l, 1, "field", &o->lens->field_deg);
    return true;
}

static bool parse_keyword_line(struct oslo *o)
{
    const struct lines *l = &o->lines;

    if (lines_first_word_is(l, "NXT")) {
        o->s = imported_add_surface(o->lens, l->number);
        return o->s != NULL;
    }
    if (lines_first_word_is(l, "EBR") || lines_first_word_is(l, "ANG") ||
        lines_first_word_is(l, "UNI") || lines_first_word_is(l, "LEN"))
        return parse_header_keyword(o);
    if (!o->s && lines_first_word_is(l, "TH")) {
        double object;

        if (!lines_parse_number(l, 1, "distance of the object", &object))
            return false;
        imported_set_object(o->lens, l->number, object);
        return true;
    }
    return !o->s || parse_surface_keyword(o);
}

bool import_oslo(struct imported *lens, const char *text, size_t bytes)
{
    struct oslo o = {.lens = lens};
    const struct imported_surface *image;

    lines_init(&o.lines, lens, text, bytes);
    while (lines_read_next(&o.lines, '\0')) {
        if (lines_first_word_is(&o.lines, "END") ||
            lines_first_word_is(&o.lines, "WV")) {
            o.s = NULL;
            o.ended = true;
        }
        if (!parse_keyword_line(&o))
            return false;
    }
    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    image = &lens->surface[--lens->n];
    if (o.ended)
        imported_set_image_surface(lens, image->line, image->radius,
                                   image->thickness);
    else
        imported_add_note(lens, 0, "no END line: the file may be cut off");
    return imported_note_missing_unit(lens, "UNI");
}
