/* SPDX-License-Identifier: MIT
 *
 * Reads tables of PhotonsToPhotos' Optical Bench: sections of tab-separated
 * values.
 *
 * A row of [lens data] has the columns number, radius, thickness, index,
 * diameter and Abbe number. A radius "AS" marks the stop, "CG" a cover glass,
 * "FS" another diaphragm. A thickness may be the name of a row of [variable
 * distances], which has one column per zoom position. The angle of view is the
 * full angle; the image height is the diameter of the image. [aspherical data]
 * has the columns number, radius, conic, and the aspheric terms from h^4 on.
 * Index and Abbe number define a glass; names of similar glasses are ignored.
 */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "import/lines.h"
#include "options/tool.h"

enum { VARIABLES = 64, POSITIONS = 16, ID_BYTES = 8 };

enum section { NO_SECTION, TITLE, CONSTANTS, DISTANCES, ROWS, ASPHERES, OTHER };

struct variable {
    char name[24];
    int n;
    double value[POSITIONS]; /* value per zoom position; NAN: not stated */
};

struct optical_bench {
    struct imported *lens;
    struct lines lines;
    enum section section;
    int at; /* index of the selected zoom position; -1: not known yet */
    int n_variables;
    struct variable variable[VARIABLES];
    char id[IMPORT_SURFACES][ID_BYTES];
    /* values of aspheric terms that glint does not support: odd powers, and
     * h^2 */
    double odd, a2;
};

static const char *get_word_or_empty(const struct optical_bench *b, int k)
{
    return k < b->lines.n ? b->lines.word[k] : "";
}

static bool start_file_section(struct optical_bench *b)
{
    static const struct {
        const char *name;
        enum section section;
    } names[] = {{"[descriptive data]", TITLE},
                 {"[constants]", CONSTANTS},
                 {"[variable distances]", DISTANCES},
                 {"[lens data]", ROWS},
                 {"[aspherical data]", ASPHERES},
                 {"[figure]", OTHER},
                 {"[notes]", OTHER},
                 {"[patent info]", OTHER},
                 {"[report data]", OTHER}};

    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(get_word_or_empty(b, 0), names[i].name) == 0) {
            b->section = names[i].section;
            return true;
        }
    b->section = OTHER;
    return imported_note_unread_word(b->lens, b->lines.number,
                                     get_word_or_empty(b, 0));
}

static bool parse_variable_row(struct optical_bench *b)
{
    struct variable *v = &b->variable[b->n_variables];

    if (b->n_variables == VARIABLES)
        return imported_report_error(b->lens, b->lines.number,
                                     "more than %d variable distances",
                                     VARIABLES);
    snprintf(v->name, sizeof v->name, "%.23s", get_word_or_empty(b, 0));
    for (v->n = 0; v->n < POSITIONS && v->n + 1 < b->lines.n; v->n++) {
        const char *text = get_word_or_empty(b, v->n + 1);

        if (strcasecmp(text, "Infinity") == 0)
            v->value[v->n] = (double)INFINITY;
        else if (!tool_parse_number(text, &v->value[v->n]))
            v->value[v->n] = (double)NAN;
    }
    b->n_variables++;
    return true;
}

/* Returns the variable NAME at the selected zoom position, or NAN if it is
 * not stated. */
static double find_variable_value(const struct optical_bench *b,
                                  const char *name)
{
    for (int i = 0; i < b->n_variables; i++)
        if (strcasecmp(b->variable[i].name, name) == 0)
            return b->at < b->variable[i].n ? b->variable[i].value[b->at]
                                            : (double)NAN;
    return (double)NAN;
}

/* Selects the zoom position; the file has one position per focal length. */
static bool select_zoom_position(struct optical_bench *b)
{
    int n = 0;

    if (b->at >= 0)
        return true;
    b->at = 0;
    for (int i = 0; i < b->n_variables; i++)
        if (strcasecmp(b->variable[i].name, "Focal Length") == 0)
            while (n < b->variable[i].n && isfinite(b->variable[i].value[n]))
                n++;
    return imported_choose_position(b->lens, 0, n > 0 ? n : 1, &b->at);
}

/* Sets VALUE to half of the diameter in word K, or to 0 if the word is missing,
 * "Infinity" or "undefined". */
static bool parse_diameter(struct optical_bench *b, int k, double *value)
{
    const char *text = get_word_or_empty(b, k);

    *value = 0;
    if (!*text || strcasecmp(text, "Infinity") == 0 ||
        strcasecmp(text, "undefined") == 0)
        return true;
    if (!lines_parse_number(&b->lines, k, "diameter", value))
        return false;
    *value /= 2;
    return true;
}

static bool parse_thickness(struct optical_bench *b, struct imported_surface *s)
{
    const char *text = get_word_or_empty(b, 2);

    if (!*text)
        return imported_report_error(b->lens, b->lines.number,
                                     "thickness is missing");
    if (tool_parse_number(text, &s->thickness))
        return true;
    s->thickness = find_variable_value(b, text);
    return isfinite(s->thickness) ||
           imported_report_error(
               b->lens, b->lines.number,
               "thickness '%.23s' is neither a number nor among the "
               "variable distances",
               text);
}

static bool parse_surface_row(struct optical_bench *b)
{
    const char *radius = get_word_or_empty(b, 1);
    struct imported_surface *s;

    if (!select_zoom_position(b) ||
        !(s = imported_add_surface(b->lens, b->lines.number)))
        return false;
    snprintf(b->id[b->lens->n - 1], ID_BYTES, "%.7s", get_word_or_empty(b, 0));
    s->stop = strcasecmp(radius, "AS") == 0;
    if (!s->stop && strcasecmp(radius, "CG") != 0 &&
        strcasecmp(radius, "FS") != 0 && strcasecmp(radius, "Infinity") != 0 &&
        !lines_parse_number(&b->lines, 1, "radius", &s->radius))
        return false;
    if (!parse_thickness(b, s) || !parse_diameter(b, 4, &s->semi))
        return false;
    if (*get_word_or_empty(b, 3)) {
        if (!lines_parse_number(&b->lines, 3, "index", &s->nd) ||
            (*get_word_or_empty(b, 5) &&
             !lines_parse_number(&b->lines, 5, "Abbe number", &s->vd)))
            return false;
    } else if (*get_word_or_empty(b, 6))
        snprintf(s->glass, sizeof s->glass, "%.31s", get_word_or_empty(b, 6));
    s->vd = s->nd == 1 ? 0 : s->vd;
    return true;
}

static bool parse_lens_constant(struct optical_bench *b)
{
    if (strcasecmp(get_word_or_empty(b, 0), "AsphericalOddCount") == 0)
        return lines_parse_number(&b->lines, 1, "number of odd terms", &b->odd);
    if (strcasecmp(get_word_or_empty(b, 0), "AsphericalA2") == 0)
        b->a2 = 1;
    return true;
}

/* Sets aspheric term I of S (I = 0 is h^4) from word K. */
static bool parse_aspheric_term(struct optical_bench *b,
                                struct imported_surface *s, int k, int i)
{
    double value;

    if (!*get_word_or_empty(b, k))
        return true;
    if (!lines_parse_number(&b->lines, k, "aspheric term", &value))
        return false;
    if (value == 0)
        return true;
    if (i < 0 || i >= GLINT_SHAPE_TERMS)
        return imported_report_error(
            b->lens, b->lines.number,
            "aspheric term h^%d is not supported; only h^4 to h^20 are",
            i < 0 ? b->a2 > 0 ? 2 : 3 : 2 * i + 4);
    s->shape.term[i] = value;
    return true;
}

static bool parse_aspheric_row(struct optical_bench *b)
{
    const int first = b->odd > 0 || b->a2 > 0 ? -1 : 0;
    struct imported_surface *s = NULL;
    double radius;

    for (int k = 0; k < b->lens->n && !s; k++)
        if (strncmp(b->id[k], get_word_or_empty(b, 0), ID_BYTES - 1) == 0)
            s = &b->lens->surface[k];
    if (!s)
        return imported_report_error(b->lens, b->lines.number,
                                     "surface '%.20s' is not in [lens data]",
                                     get_word_or_empty(b, 0));
    if (b->odd > 1)
        return imported_report_error(
            b->lens, b->lines.number,
            "%g odd aspheric terms are not supported; only even powers are",
            b->odd);
    if (strcasecmp(get_word_or_empty(b, 1), "Infinity") == 0)
        radius = 0;
    else if (!lines_parse_number(&b->lines, 1, "radius", &radius))
        return false;
    if (fabs(radius - s->radius) > 1e-3 * fabs(s->radius))
        imported_add_note(
            b->lens, b->lines.number,
            "radius %g contradicts %g in [lens data], which is used", radius,
            s->radius);
    if (*get_word_or_empty(b, 2) &&
        !lines_parse_number(&b->lines, 2, "conic", &s->shape.conic))
        return false;
    for (int k = 3; k < b->lines.n; k++)
        if (!parse_aspheric_term(b, s, k, k - 3 + first))
            return false;
    return true;
}

static bool parse_section_line(struct optical_bench *b)
{
    if (*get_word_or_empty(b, 0) == '[')
        return start_file_section(b);
    switch (b->section) {
    case NO_SECTION:
        return imported_report_error(
            b->lens, b->lines.number,
            "'%.40s' is not a [section] of Optical Bench (for "
            "tables of polyflare use --format polyflare)",
            get_word_or_empty(b, 0));
    case TITLE:
        if (strcasecmp(get_word_or_empty(b, 0), "title") == 0)
            snprintf(b->lens->title, sizeof b->lens->title, "%.230s",
                     get_word_or_empty(b, 1));
        return true;
    case CONSTANTS:
        return parse_lens_constant(b);
    case DISTANCES:
        return parse_variable_row(b);
    case ROWS:
        return parse_surface_row(b);
    case ASPHERES:
        return parse_aspheric_row(b);
    case OTHER:
        break;
    }
    return true;
}

/* Sets VALUE to SHARE times the variable NAME. Does not change VALUE if the
 * file does not state the variable. */
static void set_from_variable(const struct optical_bench *b, const char *name,
                              double share, double *value)
{
    const double said = find_variable_value(b, name);

    if (isfinite(said))
        *value = share * said;
}

bool import_opticalbench(struct imported *lens, const char *text, size_t bytes)
{
    /* static because the struct is too large for the stack */
    static struct optical_bench b;
    double object = (double)INFINITY;

    b = (struct optical_bench){.lens = lens, .at = -1};
    lines_init(&b.lines, lens, text, bytes);
    b.lines.tabs = true;
    while (lines_read_next(&b.lines, '#'))
        if (!parse_section_line(&b))
            return false;
    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    set_from_variable(&b, "Focal Length", 1, &lens->nominal);
    set_from_variable(&b, "F-Number", 1, &lens->f_number);
    set_from_variable(&b, "Angle of View", 0.5, &lens->field_deg);
    set_from_variable(&b, "Image Height", 0.5, &lens->height);
    set_from_variable(&b, "d0", 1, &object);
    imported_set_object(lens, 0, object);
    return true;
}
