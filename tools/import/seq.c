/* SPDX-License-Identifier: MIT
 *
 * Reads CODE V .seq files: spheres, conics and even aspheres.
 *
 * Commands are separated by ';' or line ends. "S r t glass", "SO" and "SI"
 * begin the next surface, the object and the image; later commands apply to
 * that surface, or to surface K if their second word is "SK". Case is ignored.
 * Radii are stated as curvatures unless the command "RDM" precedes them. A
 * glass that is a number (six digits, or nnn.vvv) states nd - 1 and Vd.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "glint/options.h"
#include "import/lines.h"

struct seq {
    struct imported *lens;
    struct lines lines;
    struct imported_surface *s;
    bool curvatures;
    bool image; /* whether the image surface has been read */
};

/* Sets nd and Vd of S if WORD is a glass code, such as "517642", "517.642" or
 * "516800.641672" (nd 1.5168, Vd 64.1672). Returns whether it is. */
static bool parse_glass_code(struct imported_surface *s, const char *word)
{
    static const char digits[] = "0123456789";
    const size_t all = strlen(word), before = strspn(word, digits);
    const bool point = word[before] == '.';
    const size_t n = point ? before : 3, from = point ? n + 1 : n;
    const char *end;
    char text[24];

    if (n < 3 || all < from + 2 || all > from + 6 || before < n ||
        strspn(word + from, digits) != all - from || (!point && all != 6))
        return false;
    snprintf(text, sizeof text, "1.%.*s", (int)n, word);
    s->nd = glint_option_number(text, &end);
    snprintf(text, sizeof text, "0.%s", word + from);
    s->vd = 100 * glint_option_number(text, &end);
    return n <= 6;
}

static bool parse_glass(struct seq *q, const char *word)
{
    q->s->glass[0] = '\0';
    q->s->nd = 1;
    q->s->vd = 0;
    if (strcasecmp(word, "AIR") == 0)
        return true;
    if (strncasecmp(word, "REFL", 4) == 0)
        return lines_reject_mirror(&q->lines);
    if (!parse_glass_code(q->s, word))
        snprintf(q->s->glass, sizeof q->s->glass, "%s", word);
    return true;
}

static bool parse_surface_radius(struct seq *q, int k, bool curvature)
{
    return curvature
               ? lines_parse_curvature(&q->lines, k, &q->s->radius)
               : lines_parse_number(&q->lines, k, "radius", &q->s->radius);
}

/* Stores the image surface; its thickness is the defocus. */
static bool parse_image_surface(struct seq *q)
{
    const struct lines *l = &q->lines;
    double bend = 0, defocus = 0;

    q->image = true;
    if (q->lens->n == 0 ||
        (l->n > 1 && !lines_parse_number(l, 1, "curvature", &bend)) ||
        (l->n > 2 && !lines_parse_number(l, 2, "defocus", &defocus)))
        return q->lens->n == 0;
    imported_set_image_surface(q->lens, l->number,
                               bend == 0 || !q->curvatures ? bend : 1 / bend,
                               defocus);
    return true;
}

static bool start_surface(struct seq *q)
{
    const struct lines *l = &q->lines;
    double object = 0;

    if (lines_first_word_is(l, "SI") || lines_first_word_is(l, "SO")) {
        q->s = NULL;
        if (lines_first_word_is(l, "SI"))
            return parse_image_surface(q);
        if (l->n < 3)
            return true;
        if (!lines_parse_number(l, 2, "distance of the object", &object))
            return false;
        imported_set_object(q->lens, l->number, object);
        return true;
    }
    q->s = imported_add_surface(q->lens, l->number);
    return q->s && parse_surface_radius(q, 1, q->curvatures) &&
           lines_parse_number(l, 2, "thickness", &q->s->thickness) &&
           (l->n < 4 || parse_glass(q, l->word[3]));
}

static bool parse_aperture_command(struct seq *q)
{
    const struct lines *l = &q->lines;
    const int k = l->n - 1;
    double value;

    if (l->n > 1 && (strcasecmp(l->word[1], "OBS") == 0 ||
                     strcasecmp(l->word[1], "HOL") == 0))
        return imported_add_note(
            q->lens, l->number,
            "'%s %s' is not supported; apertures must be circular", l->word[0],
            l->word[1]);
    if (l->n > 1 && strcasecmp(l->word[1], "EDG") == 0 && q->s->semi > 0)
        return true;
    if (!lines_parse_number(l, k, "semi-diameter", &value))
        return false;
    q->s->semi = value;
    return true;
}

/* Handles a command that sets a single number or the glass of the surface.
 * Sets *DONE to whether the command is known. */
static bool parse_number_command(struct seq *q, bool *done)
{
    static const char terms[] = "ABCDEFGHJ"; /* terms of h^4 to h^20 */
    const struct lines *l = &q->lines;
    const char *word = l->word[0];

    *done = true;
    if (strcmp(word, "CUY") == 0 || strcmp(word, "RDY") == 0)
        return parse_surface_radius(q, 1, *word == 'C');
    if (strcmp(word, "THI") == 0)
        return lines_parse_number(l, 1, "thickness", &q->s->thickness);
    if (strcmp(word, "GLA") == 0)
        return l->n > 1 ? parse_glass(q, l->word[1])
                        : imported_report_error(q->lens, l->number,
                                                "the glass has no name");
    if (strcmp(word, "K") == 0)
        return lines_parse_number(l, 1, "conic", &q->s->shape.conic);
    if (*word && !word[1] && strchr(terms, *word))
        return lines_parse_number(
            l, 1, "aspheric term",
            &q->s->shape.term[strchr(terms, *word) - terms]);
    *done = false;
    return true;
}

/* Handles a command about the surface, including its shape: "K" for the conic
 * and "A" to "J" for h^4 to h^20. */
static bool parse_surface_command(struct seq *q)
{
    static const char *const ignored[] = {
        "CCY", "THC", "GLC", "KC",  "AC",  "BC",  "CC",  "DC",
        "ASP", "CON", "PIM", "SLB", "SPH", "RMD", "CUM", "THM"};
    static const char *const refused[] = {"XDE", "YDE", "ZDE", "ADE", "BDE",
                                          "CDE", "SPS", "CUX", "RDX", "XTO",
                                          "YTO", "CYL", "DIF", "GRN", "UDS"};
    const struct lines *l = &q->lines;
    bool done;

    if (!parse_number_command(q, &done))
        return false;
    if (done)
        return true;
    if (lines_first_word_is(l, "STO"))
        return q->s->stop = true;
    if (lines_first_word_is(l, "CIR"))
        return parse_aperture_command(q);
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (lines_first_word_is(l, ignored[i]))
            return true;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (lines_first_word_is(l, refused[i]))
            return imported_report_error(
                q->lens, l->number,
                "'%s': tilted, diffractive and other surfaces without "
                "rotational symmetry are not supported",
                l->word[0]);
    return imported_note_unread_word(q->lens, l->number, l->word[0]);
}

static bool parse_dimension_command(struct seq *q)
{
    const char *word = q->lines.n > 1 ? q->lines.word[1] : "";
    /* first letter of the unit's name, in upper case */
    const char unit = (char)(*word & ~0x20);

    if (unit != 'I' && unit != 'C' && unit != 'M')
        return imported_report_error(q->lens, q->lines.number,
                                     "unit '%s' is unknown; expected M (mm), C "
                                     "(cm) or I (inches)",
                                     word);
    return imported_set_unit(q->lens, q->lines.number,
                             unit == 'I'   ? 25.4
                             : unit == 'C' ? 10
                                           : 1);
}

static bool parse_header_command(struct seq *q)
{
    const struct lines *l = &q->lines;

    if (lines_first_word_is(l, "RDM")) {
        q->curvatures = l->n > 1 && *l->word[1] == 'N';
        return true;
    }
    if (lines_first_word_is(l, "TITLE") || lines_first_word_is(l, "TIT")) {
        snprintf(q->lens->title, sizeof q->lens->title, "%s",
                 l->n > 1 ? l->word[1] : "");
        return true;
    }
    if (lines_first_word_is(l, "DIM"))
        return parse_dimension_command(q);
    if (lines_first_word_is(l, "EPD"))
        return lines_parse_number(l, 1, "entrance pupil", &q->lens->pupil);
    if (lines_first_word_is(l, "FNO"))
        return lines_parse_number(l, 1, "f-number", &q->lens->f_number);
    if (lines_first_word_is(l, "YAN") || lines_first_word_is(l, "XAN"))
        return lines_parse_fields(l, &q->lens->field_deg);
    if (lines_first_word_is(l, "YIM") || lines_first_word_is(l, "YRI") ||
        lines_first_word_is(l, "XIM"))
        return lines_parse_fields(l, &q->lens->height);
    if (lines_first_word_is(l, "PRV"))
        return imported_add_note(
            q->lens, l->number,
            "private glasses (PRV) are ignored; those of the "
            "catalogue are used");
    return !lines_first_word_is(l, "ZOO") ||
           imported_add_note(q->lens, l->number,
                             "only the first zoom position is read");
}

/* Converts the first word to upper case. */
static void capitalise_command(struct lines *l)
{
    for (char *c = l->text + (l->word[0] - l->text); *c; c++)
        if (*c >= 'a' && *c <= 'z')
            *c = (char)(*c - 'a' + 'A');
}

/* If the second word is a surface, such as "S3", makes it the current
 * surface and removes the word. */
static bool select_surface(struct seq *q)
{
    struct lines *l = &q->lines;
    const char *word = l->n > 1 ? l->word[1] : "";
    char *end;
    long k;

    if ((*word != 'S' && *word != 's') || word[1] < '0' || word[1] > '9')
        return true;
    k = strtol(word + 1, &end, 10);
    if (*end)
        return true;
    if (k < 1 || k > q->lens->n)
        return imported_report_error(q->lens, l->number,
                                     "there is no surface '%s'", word);
    q->s = &q->lens->surface[k - 1];
    l->n--;
    for (int i = 1; i < l->n; i++)
        l->word[i] = l->word[i + 1];
    return true;
}

static bool parse_command(struct seq *q)
{
    const struct lines *l = &q->lines;
    struct imported_surface *const current = q->s;
    bool good;

    capitalise_command(&q->lines);
    if (lines_first_word_is(l, "S") || lines_first_word_is(l, "SO") ||
        lines_first_word_is(l, "SI"))
        return start_surface(q);
    if (!select_surface(q))
        return false;
    good = q->s && !lines_first_word_is(l, "DIM") ? parse_surface_command(q)
                                                  : parse_header_command(q);
    q->s = current;
    return good;
}

bool import_seq(struct imported *lens, const char *text, size_t bytes)
{
    struct seq q = {.lens = lens, .curvatures = true};

    lines_init(&q.lines, lens, text, bytes);
    q.lines.divider = ';';
    while (lines_read_next(&q.lines, '!'))
        if (!parse_command(&q))
            return false;
    if (lens->n == 0)
        return imported_report_no_surfaces(lens);
    if (!q.image)
        imported_add_note(
            lens, 0, "the SI line (image) is missing; the file may be cut off");
    return imported_note_missing_unit(lens, "DIM");
}
