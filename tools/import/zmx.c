/* SPDX-License-Identifier: MIT
 *
 * Reads sequential Zemax .zmx files: STANDARD and EVENASPH surfaces.
 *
 * A line is a word and its values. Lines after "SURF n" describe that surface;
 * the first surface is the object, the last the image. PARM 1 .. 8 of an
 * EVENASPH are the terms of h^2 .. h^16.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/lines.h"

struct zmx {
    struct imported *lens;
    struct lines lines;
    struct imported_surface *s; /* current surface; NULL: before the first */
    bool even;                  /* whether PARM lines of s are aspheric terms */
    bool indented; /* whether lines that describe a surface are indented */
    int field_type;
    double field, object;
    double number;   /* number of surface s in the file */
    int object_line; /* line of the object surface; 0: not read yet */
};

static bool parse_surface_type(struct zmx *z)
{
    const char *type = z->lines.n > 1 ? z->lines.word[1] : "";

    z->even = strcmp(type, "EVENASPH") == 0;
    return z->even || strcmp(type, "STANDARD") == 0 ||
           imported_report_error(
               z->lens, z->lines.number,
               "surfaces of type '%s' are not supported; STANDARD "
               "and EVENASPH are",
               type);
}

static bool parse_glass(struct zmx *z)
{
    const struct lines *l = &z->lines;
    double nd = 0, vd = 0;

    if (l->n < 2)
        return imported_report_error(z->lens, l->number,
                                     "the glass has no name");
    if (strcmp(l->word[1], "MIRROR") == 0)
        return lines_reject_mirror(l);
    if (l->n > 5 && (!lines_parse_number(l, 4, "index", &nd) ||
                     !lines_parse_number(l, 5, "Abbe number", &vd)))
        return false;
    if (strncmp(l->word[1], "___", 3) != 0) {
        snprintf(z->s->glass, sizeof z->s->glass, "%s", l->word[1]);
        /* Older versions of Zemax write these two values for every named glass,
         * so they are ignored. */
        if (nd == 1.5 && vd == 40)
            nd = vd = 0;
    }
    z->s->nd = nd;
    z->s->vd = vd;
    return true;
}

static bool parse_surface_parameter(struct zmx *z)
{
    double k, value;

    if (!z->even)
        return true;
    if (!lines_parse_number(&z->lines, 1, "number of the term", &k) ||
        !lines_parse_number(&z->lines, 2, "aspheric term", &value))
        return false;
    if (value == 0)
        return true;
    if (k < 2 || k > 8 || k != floor(k))
        return imported_report_error(
            z->lens, z->lines.number,
            "aspheric term h^%g is not supported; only h^4 to h^16 are", 2 * k);
    z->s->shape.term[(int)k - 2] = value;
    return true;
}

static bool parse_surface_keyword(struct zmx *z)
{
    /* keywords about drawing, manufacturing and optimisation */
    static const char *const ignored[] = {"HIDE", "MIRR", "SLAB", "POPS",
                                          "FIMP", "MEMA", "FLAP", "COMM"};
    const struct lines *l = &z->lines;

    if (lines_first_word_is(l, "TYPE"))
        return parse_surface_type(z);
    if (lines_first_word_is(l, "STOP"))
        return z->s->stop = true;
    if (lines_first_word_is(l, "CURV"))
        return lines_parse_curvature(l, 1, &z->s->radius);
    if (lines_first_word_is(l, "DISZ")) {
        if (l->n > 1 && strcmp(l->word[1], "INFINITY") == 0) {
            z->s->thickness = (double)INFINITY;
            return true;
        }
        return lines_parse_number(l, 1, "thickness", &z->s->thickness);
    }
    if (lines_first_word_is(l, "GLAS"))
        return parse_glass(z);
    if (lines_first_word_is(l, "DIAM"))
        return lines_parse_number(l, 1, "semi-diameter", &z->s->semi);
    if (lines_first_word_is(l, "CONI"))
        return lines_parse_number(l, 1, "conic", &z->s->shape.conic);
    if (lines_first_word_is(l, "PARM"))
        return parse_surface_parameter(z);
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (lines_first_word_is(l, ignored[i]))
            return true;
    return imported_note_unread_word(z->lens, l->number, l->word[0]);
}

static bool parse_unit_keyword(struct zmx *z)
{
    static const struct {
        const char *word;
        double mm;
    } units[] = {
        {"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}, {"M", 1000}};
    const char *word = z->lines.n > 1 ? z->lines.word[1] : "";

    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].word, word) == 0)
            return imported_set_unit(z->lens, z->lines.number, units[i].mm);
    return imported_report_error(
        z->lens, z->lines.number,
        "unit '%s' is unknown; expected MM, CM, IN or METER", word);
}

static bool parse_header_keyword(struct zmx *z)
{
    const struct lines *l = &z->lines;
    double value;

    if (lines_first_word_is(l, "MODE") && l->n > 1 &&
        strcmp(l->word[1], "SEQ") != 0)
        return imported_report_error(
            z->lens, l->number,
            "mode '%s' is not supported; only SEQ (sequential) is", l->word[1]);
    if (lines_first_word_is(l, "NAME")) {
        snprintf(z->lens->title, sizeof z->lens->title, "%.230s", l->rest);
        return true;
    }
    if (lines_first_word_is(l, "UNIT"))
        return parse_unit_keyword(z);
    if (lines_first_word_is(l, "ENPD"))
        return lines_parse_number(l, 1, "entrance pupil", &z->lens->pupil);
    if (lines_first_word_is(l, "FNUM"))
        return lines_parse_number(l, 1, "f-number", &z->lens->f_number);
    if (lines_first_word_is(l, "FTYP")) {
        if (!lines_parse_number(l, 1, "type of field", &value))
            return false;
        z->field_type = value >= 0 && value < 10 ? (int)value : 9;
        return true;
    }
    return !(lines_first_word_is(l, "XFLN") ||
             lines_first_word_is(l, "YFLN")) ||
           lines_parse_fields(l, &z->field);
}

/* Begins a surface. The first one is the object and is not added to the lens.
 * Rejects surface numbers that are not consecutive, because a surface is then
 * missing or duplicate. */
static bool start_surface(struct zmx *z)
{
    double number;

    if (!lines_parse_number(&z->lines, 1, "number of the surface", &number))
        return false;
    if (!(number >= 0) || number > 1e6 || number != floor(number) ||
        (z->s && number != z->number + 1))
        return imported_report_error(
            z->lens, z->lines.number,
            "surface %.15g: surfaces count up from 0%s", number,
            z->s ? ", one by one" : "");
    z->number = number;
    z->even = false;
    if (z->s && z->object_line == 0) {
        z->object = z->s->thickness;
        z->object_line = z->s->line;
        z->lens->n = 0;
    }
    z->s = imported_add_surface(z->lens, z->lines.number);
    if (z->s)
        z->s->thickness = (double)NAN; /* NAN marks a missing DISZ line */
    return z->s != NULL;
}

/* Removes the last surface, which is the image. Rejects an image with glass
 * behind it, because the file is then truncated. */
static bool remove_image_surface(struct imported *lens)
{
    const struct imported_surface *image = &lens->surface[--lens->n];

    if (image->glass[0] || image->nd != 1)
        return imported_report_error(
            lens, image->line,
            "the last surface, which is the image, has glass "
            "behind it: the file is cut off");
    if (image->thickness == 0)
        imported_set_image_surface(lens, image->line, image->radius, 0);
    else
        imported_add_note(
            lens, image->line,
            "the last surface, which is the image, has no DISZ of 0: "
            "the file may be cut off");
    return true;
}

static bool check_surface_distances(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];

        if (isnan(s->thickness)) {
            imported_add_note(lens, s->line,
                              "no DISZ is stated; a thickness of 0 is assumed");
            s->thickness = 0;
        }
        if (!isfinite(s->thickness))
            return imported_report_error(
                lens, s->line, "an infinite thickness inside the lens");
    }
    return true;
}

static bool finish_lens(struct zmx *z)
{
    struct imported *lens = z->lens;
    const struct imported_surface *image;

    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    if (!remove_image_surface(lens))
        return false;
    image = &lens->surface[lens->n];
    if (z->field_type == 0)
        lens->field_deg = z->field;
    else if (z->field_type == 2 || z->field_type == 3)
        lens->height = z->field;
    else
        lens->height = image->semi;
    if (z->field_type == 0 && !(z->field > 0))
        lens->height = image->semi;
    if (!check_surface_distances(lens))
        return false;
    imported_set_object(lens, z->object_line, z->object);
    return imported_note_missing_unit(lens, "UNIT");
}

bool import_zmx(struct imported *lens, const char *text, size_t bytes)
{
    struct zmx z = {.lens = lens};
    bool more = true, tail = false;

    lines_init(&z.lines, lens, text, bytes);
    while (more && lines_read_next(&z.lines, '\0')) {
        const struct lines *l = &z.lines;

        if (lines_first_word_is(l, "SURF"))
            more = start_surface(&z);
        /* Configurations, merit functions and tolerances follow the last
         * surface. */
        else if (lines_first_word_is(l, "MNUM")) {
            tail = true;
            more = l->n < 2 || strcmp(l->word[1], "1") == 0 ||
                   imported_add_note(lens, l->number,
                                     "only the first configuration is read");
        } else if (lines_first_word_is(l, "TOL") ||
                   lines_first_word_is(l, "DMFS"))
            tail = true;
        else if (!z.s)
            more = parse_header_keyword(&z);
        else if (!tail) {
            const bool indented = l->word[0] > l->text;

            tail = z.indented && !indented;
            z.indented |= indented;
            more = tail || parse_surface_keyword(&z);
        }
    }
    return more && finish_lens(&z);
}
