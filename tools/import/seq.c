/* SPDX-License-Identifier: MIT
 *
 * CODE V .seq files: spheres, conics and even aspheres.
 *
 * Commands are divided by ';' or ends of lines. "S r t glass", "SO" and "SI"
 * begin the next surface, the object and the image; what follows is of that
 * surface. Words may be in small letters. Radii are curvatures but after "RDM".
 * Glasses of six digits or nnn.vvv
 * are (nd - 1) and Vd.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/lines.h"
#include "options/tool.h"

struct seq {
    struct imported *lens;
    struct lines lines;
    struct imported_surface *s;
    bool curvatures;
};

/* Sets S to a glass of numbers, as "517.642" or "517642"; returns whether WORD
 * is one. */
static bool numbered_glass(struct imported_surface *s, const char *word)
{
    const char *point = strchr(word, '.');
    double value;

    if (!tool_number(word, &value))
        return false;
    if (point)
        value = point - word == 3 ? value * 1000 : 0;
    if (!(value >= 100000 && value < 1000000))
        return false;
    s->nd = 1 + floor(value / 1000) / 1000;
    s->vd = fmod(value, 1000) / 10;
    return true;
}

static bool take_glass(struct seq *q, const char *word)
{
    if (strcmp(word, "AIR") == 0)
        return true;
    if (strncmp(word, "REFL", 4) == 0)
        return imported_fail(q->lens, q->lines.number,
                             "a mirror: glint has lenses alone");
    if (!numbered_glass(q->s, word))
        snprintf(q->s->glass, sizeof q->s->glass, "%s", word);
    return true;
}

static bool start_surface(struct seq *q)
{
    const struct lines *l = &q->lines;
    double radius = 0;

    if (lines_is(l, "SI") || lines_is(l, "SO")) {
        q->s = NULL;
        return true;
    }
    q->s = imported_add(q->lens, l->number);
    if (!q->s || !lines_number(q->lens, l, 1, "radius", &radius) ||
        !lines_number(q->lens, l, 2, "thickness", &q->s->thickness))
        return false;
    q->s->radius = radius == 0 || !q->curvatures ? radius : 1 / radius;
    return l->n < 4 || take_glass(q, l->word[3]);
}

static bool take_aperture(struct seq *q)
{
    const struct lines *l = &q->lines;
    const int k = l->n - 1;
    double value;

    if (l->n > 1 && strcmp(l->word[1], "EDG") == 0 && q->s->semi > 0)
        return true;
    if (!lines_number(q->lens, l, k, "semi-diameter", &value))
        return false;
    q->s->semi = value;
    return true;
}

/* Takes what is said of the surface: shapes of "K", and "A" to "H" for h^4 to
 * h^18. */
static bool take_surface(struct seq *q)
{
    static const char *const ignored[] = {
        "CCY", "THC", "GLC", "KC",  "AC",  "BC",  "CC",  "DC",
        "ASP", "CON", "PIM", "SLB", "SPH", "RMD", "CUM", "THM"};
    static const char refused[][4] = {"XDE", "YDE", "ZDE", "ADE", "BDE",
                                      "CDE", "SPS", "XTO", "YTO", "CYL",
                                      "DIF", "GRN", "UDS"};
    const struct lines *l = &q->lines;
    double value = 0;

    if (lines_is(l, "STO"))
        return q->s->stop = true;
    if (lines_is(l, "CIR"))
        return take_aperture(q);
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (lines_is(l, ignored[i]))
            return true;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (lines_is(l, refused[i]))
            return imported_fail(q->lens, l->number,
                                 "'%s': tilted, diffractive and other surfaces "
                                 "that are not round are not read",
                                 l->word[0]);
    if (lines_is(l, "K"))
        return lines_number(q->lens, l, 1, "conic", &q->s->shape.conic);
    if (strlen(l->word[0]) == 1 && *l->word[0] >= 'A' && *l->word[0] <= 'H') {
        if (!lines_number(q->lens, l, 1, "aspheric term", &value))
            return false;
        q->s->shape.term[*l->word[0] - 'A'] = value;
        return true;
    }
    return imported_note(q->lens, l->number, "'%.30s' is not read", l->word[0]);
}

static bool take_dimension(struct seq *q)
{
    const char *word = q->lines.n > 1 ? q->lines.word[1] : "";
    const char unit = (char)(*word & ~0x20); /* a capital */

    q->lens->unit_mm = unit == 'I' ? 25.4 : unit == 'C' ? 10 : 1;
    return unit == 'I' || unit == 'C' || unit == 'M' ||
           imported_fail(q->lens, q->lines.number,
                         "unit '%s' is none of M, C and I", word);
}

static bool take_fields(struct seq *q, double *most)
{
    double value;

    for (int k = 1; k < q->lines.n; k++) {
        if (!lines_number(q->lens, &q->lines, k, "field", &value))
            return false;
        *most = fmax(*most, fabs(value));
    }
    return true;
}

static bool take_head(struct seq *q)
{
    const struct lines *l = &q->lines;

    if (lines_is(l, "RDM")) {
        q->curvatures = l->n > 1 && *l->word[1] == 'N';
        return true;
    }
    if (lines_is(l, "TITLE") || lines_is(l, "TIT")) {
        snprintf(q->lens->title, sizeof q->lens->title, "%s",
                 l->n > 1 ? l->word[1] : "");
        return true;
    }
    if (lines_is(l, "DIM"))
        return take_dimension(q);
    if (lines_is(l, "EPD"))
        return lines_number(q->lens, l, 1, "entrance pupil", &q->lens->pupil);
    if (lines_is(l, "FNO"))
        return lines_number(q->lens, l, 1, "f-number", &q->lens->f_number);
    if (lines_is(l, "YAN") || lines_is(l, "XAN"))
        return take_fields(q, &q->lens->field_deg);
    if (lines_is(l, "YIM") || lines_is(l, "YRI") || lines_is(l, "XIM"))
        return take_fields(q, &q->lens->height);
    return !lines_is(l, "ZOO") ||
           imported_note(q->lens, l->number,
                         "zoom positions but the first are not read");
}

/* Puts the first word into capitals. */
static void capitalise(struct lines *l)
{
    for (char *c = l->text + (l->word[0] - l->text); *c; c++)
        if (*c >= 'a' && *c <= 'z')
            *c = (char)(*c - 'a' + 'A');
}

static bool take(struct seq *q)
{
    const struct lines *l = &q->lines;

    capitalise(&q->lines);
    if (lines_is(l, "S") || lines_is(l, "SO") || lines_is(l, "SI"))
        return start_surface(q);
    return q->s ? take_surface(q) : take_head(q);
}

bool import_seq(struct imported *lens, const char *text, size_t bytes)
{
    struct seq q = {.lens = lens, .curvatures = true};

    lines_begin(&q.lines, text, bytes);
    q.lines.divider = ';';
    while (lines_next(&q.lines, '!'))
        if (!take(&q))
            return false;
    return lens->n > 0 || imported_fail(lens, 0, "there are no surfaces in it");
}
