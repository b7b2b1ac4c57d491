/* SPDX-License-Identifier: MIT
 *
 * Reads .fx tables of polyflare and of polynomial optics. The columns are
 * radius, thickness, medium, and semi-diameter. If the medium is a glass, index
 * and Abbe number follow it.
 *
 * The medium is "air", "iris" or the name of a glass, which is ignored. The
 * prefix "cx_" makes a cylinder that is curved in x. A thickness "a/b/c" has
 * one value per zoom position. The lines "#EFL" (focal length) and "#FOV"
 * (diagonal field, degrees) also have one value per zoom position. "#!scale"
 * multiplies all lengths. "#!aspheric=" at the end of a row states the conic
 * and the terms of h^4 to h^10. "//" begins a comment, and so does '#' at the
 * start of a line.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "glint/options.h"
#include "import/lines.h"
#include "options/tool.h"

/* min radius of surfaces that count as planes, because these files write planes
 * with a large radius */
#define PLANE 1e4

enum { POSITIONS = 8 };

struct polyflare {
    struct imported *lens;
    struct lines lines;
    int at;        /* index of the selected zoom position */
    int positions; /* max number of values of a thickness; 0: none read yet */
    int line;      /* line of the first thickness with several values */
    double focal[POSITIONS], field[POSITIONS];
};

static void remove_comment_words(struct lines *l)
{
    for (int k = 0; k < l->n; k++) {
        char *comment = strstr(l->text + (l->word[k] - l->text), "//");

        if (!comment)
            continue;
        *comment = '\0';
        l->n = k + (comment > l->word[k]);
        return;
    }
}

static bool report_too_many_words(struct polyflare *p)
{
    return imported_report_error(
        p->lens, p->lines.number,
        "more than %d zoom positions are not supported", POSITIONS);
}

/* Parses "#EFL", "#FOV" or "#!scale". Notes any other line "#!..." as not read;
 * all other lines that begin with '#' are comments. */
static bool parse_header_line(struct polyflare *p)
{
    const struct lines *l = &p->lines;
    const bool focal = lines_first_word_is(l, "#EFL");

    if (focal || lines_first_word_is(l, "#FOV")) {
        if (l->n > 1 + POSITIONS)
            return report_too_many_words(p);
        for (int k = 1; k < l->n; k++)
            if (!lines_parse_number(l, k, l->word[0] + 1,
                                    focal ? &p->focal[k - 1]
                                          : &p->field[k - 1]))
                return false;
        return true;
    }
    if (!lines_first_word_is(l, "#!scale"))
        return strncmp(l->word[0], "#!", 2) != 0 ||
               imported_note_unread_word(p->lens, l->number, l->word[0]);
    return lines_parse_number(l, 1, "scale", &p->lens->unit_mm) &&
           (p->lens->unit_mm > 0 ||
            imported_report_error(p->lens, l->number,
                                  "the scale must be above 0, not %g",
                                  p->lens->unit_mm));
}

static bool parse_thickness(struct polyflare *p, struct imported_surface *s)
{
    const struct lines *l = &p->lines;
    double value[POSITIONS];
    char word[24];
    const char *at = l->n > 1 ? l->word[1] : "";
    int n = 0;

    /* "BFL", the back focal distance, is ignored here because it is computed
     * later. */
    if (strcmp(at, "BFL") == 0)
        return true;
    for (bool more = true; more; n++) {
        const size_t bytes = strcspn(at, "/");

        if (n == POSITIONS)
            return report_too_many_words(p);
        if (bytes >= sizeof word)
            return imported_report_error(
                p->lens, l->number, "thickness '%.40s' is not a number", at);
        memcpy(word, at, bytes);
        word[bytes] = '\0';
        if (!tool_parse_number(word, &value[n]))
            return imported_report_error(
                p->lens, l->number, "thickness '%.40s' is not a number", word);
        more = at[bytes] == '/';
        at += bytes + more;
    }
    if (n > 1 && p->positions > 0 && n != p->positions)
        return imported_report_error(
            p->lens, l->number, "%d zoom positions here, but %d on line %d", n,
            p->positions, p->line);
    if (n > 1 && p->positions == 0) {
        p->positions = n;
        p->line = l->number;
        if (!imported_choose_position(p->lens, l->number, n, &p->at))
            return false;
    }
    s->thickness = value[n > 1 ? p->at : 0];
    return true;
}

/* Parses word K, such as "#!aspheric=0,1e-5,0,0,0", into the shape of S. */
static bool parse_aspheric_terms(struct polyflare *p, int k,
                                 struct imported_surface *s)
{
    const char *at = p->lines.word[k] + strlen("#!aspheric=");
    double value[5];
    const char *end;

    for (int i = 0; i < 5; i++) {
        value[i] = glint_option_number(at, &end);
        if (end == at || *end != (i < 4 ? ',' : '\0') || !isfinite(value[i]))
            return imported_report_error(
                p->lens, p->lines.number,
                "'%.60s' is not #!aspheric=K,A4,A6,A8,A10", p->lines.word[k]);
        at = end + 1;
    }
    s->shape.conic = value[0];
    memcpy(s->shape.term, value + 1, 4 * sizeof *value);
    return true;
}

/* Parses the medium, word 2, and the words after it. */
static bool parse_medium(struct polyflare *p, struct imported_surface *s)
{
    const struct lines *l = &p->lines;
    const struct imported_surface *before = p->lens->n > 1 ? s - 1 : NULL;
    const char *medium = l->n > 2 ? l->word[2] : "";
    int k = 3;

    if (!*medium)
        return imported_report_error(p->lens, l->number,
                                     "the medium is missing");
    if (strncasecmp(medium, "cx_", 3) == 0) {
        s->shape.bend = GLINT_BEND_X;
        medium += 3;
    }
    s->stop = strcasecmp(medium, "iris") == 0;
    /* A plane iris lies inside the medium in front of it. A curved iris is a
     * surface at which this medium ends. */
    if (s->stop && before && fabs(s->radius) >= PLANE) {
        s->nd = before->nd;
        s->vd = before->vd;
    } else if (!s->stop && strcasecmp(medium, "air") != 0) {
        if (!lines_parse_number(l, 3, "index", &s->nd) ||
            !lines_parse_number(l, 4, "Abbe number", &s->vd))
            return false;
        k = 5;
    }
    if (k < l->n && *l->word[k] != '#' &&
        !lines_parse_number(l, k++, "semi-diameter", &s->semi))
        return false;
    for (; k < l->n; k++)
        if (strncmp(l->word[k], "#!aspheric=", 11) == 0)
            return parse_aspheric_terms(p, k, s);
    return true;
}

static bool parse_surface_row(struct polyflare *p)
{
    struct imported_surface *s = imported_add_surface(p->lens, p->lines.number);

    return s && lines_parse_number(&p->lines, 0, "radius", &s->radius) &&
           parse_thickness(p, s) && parse_medium(p, s);
}

/* If the file has no iris, uses the only plane in the air as the stop. */
static bool choose_plane_as_stop(struct imported *lens)
{
    int at = -1;

    for (int k = 0; k < lens->n; k++) {
        const struct imported_surface *s = &lens->surface[k];

        if (s->stop)
            return true;
        if (fabs(s->radius) >= PLANE && s->nd == 1 && (k == 0 || s[-1].nd == 1))
            at = at == -1 ? k : -2;
    }
    if (at < 0)
        return true;
    lens->surface[at].stop = true;
    return imported_add_note(
        lens, lens->surface[at].line,
        "no iris is stated; the plane surface in air is used as the stop");
}

bool import_polyflare(struct imported *lens, const char *text, size_t bytes)
{
    struct polyflare p = {.lens = lens};

    lines_init(&p.lines, lens, text, bytes);
    while (lines_read_next(&p.lines, '\0')) {
        remove_comment_words(&p.lines);
        if (p.lines.n > 0 && !(*p.lines.word[0] == '#' ? parse_header_line(&p)
                                                       : parse_surface_row(&p)))
            return false;
    }
    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    lens->nominal = p.focal[p.at];
    lens->field_deg = p.field[p.at] / 2;
    return choose_plane_as_stop(lens);
}
