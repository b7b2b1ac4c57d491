/* SPDX-License-Identifier: MIT
 *
 * Parses the text of a lens table into a struct glint_prescription, or reports
 * the first mistake and its position. lenses/README.md describes the format.
 *
 * The parser reads values one word at a time and checks their ranges. After
 * the last line, check.h checks the lens as a whole.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bake/table/catalogue.h"
#include "bake/table/check.h"
#include "bake/table/coatings.h"
#include "bake/table/elements.h"
#include "bake/table/text.h"
#include "base/compiler.h"
#include "glint/prescription.h"

static const struct glint_text_range radius_range = {"radius", 0.01, 1e9};
static const struct glint_text_range conic_range = {"conic", -1e4, 1e4};
static const struct glint_text_range term_range = {"aspheric term", -1e18,
                                                   1e18};
static const struct glint_text_range shift_range = {"decentre", -1e3, 1e3};
static const struct glint_text_range tilt_range = {"tilt", -45, 45};

/* Reads the next word as a radius, mm; "flat" becomes 0. */
static bool read_surface_radius(struct glint_text *text, double *radius_mm)
{
    const struct glint_word word = glint_text_next_word(text);

    *radius_mm = 0.0;
    if (glint_word_equals(&word, "flat"))
        return true;
    if (!glint_text_parse_number(text, &word, radius_range.name, radius_mm))
        return false;
    if (*radius_mm == 0.0)
        return glint_text_set_error(
            text, word.place,
            "radius must not be 0; a plane has the radius 'flat'");
    return glint_text_check_range(text, word.place, &radius_range,
                                  fabs(*radius_mm));
}

/* Returns the index of the aspheric term WORD ("A4" .. "A20"), 0 for A4; -1 if
 * WORD is not a term. */
static int find_aspheric_term(const struct glint_word *word)
{
    char name[8];

    for (int k = 0; k < GLINT_SHAPE_TERMS; k++) {
        snprintf(name, sizeof name, "A%d", 4 + 2 * k);
        if (glint_word_equals(word, name))
            return k;
    }
    return -1;
}

static bool reject_repeated_shape_item(struct glint_text *text,
                                       const struct glint_word *word)
{
    char quote[GLINT_QUOTE_BYTES];

    return glint_text_set_error(text, word->place,
                                "'%s' occurs twice for this surface",
                                glint_word_quote(word, quote));
}

/* Reads the axis of a cylinder or toric, x or y. For a toric (CYLINDER is
 * false), also reads the radius across the axis. */
static bool read_cylinder_or_toric_axis(struct glint_text *text,
                                        struct glint_shape *shape,
                                        bool cylinder)
{
    const struct glint_word word = glint_text_next_word(text);

    if (!glint_word_equals(&word, "x") && !glint_word_equals(&word, "y"))
        return glint_text_set_error(
            text, word.place, "the axis of a cylinder or toric must be x or y");
    shape->bend = glint_word_equals(&word, "x") ? GLINT_BEND_X : GLINT_BEND_Y;
    return cylinder || read_surface_radius(text, &shape->across_mm);
}

/* Reads the item of a line "shape" whose first word is WORD. */
static bool read_shape_item(struct glint_text *text, struct glint_shape *shape,
                            const struct glint_word *word)
{
    const bool cylinder = glint_word_equals(word, "cylinder");
    const int term = find_aspheric_term(word);
    char quote[GLINT_QUOTE_BYTES];

    if (cylinder || glint_word_equals(word, "toric"))
        return shape->bend != GLINT_BEND_ROUND
                   ? reject_repeated_shape_item(text, word)
                   : read_cylinder_or_toric_axis(text, shape, cylinder);
    if (glint_word_equals(word, "conic"))
        return shape->conic != 0.0 ? reject_repeated_shape_item(text, word)
                                   : glint_text_read_value(text, &conic_range,
                                                           &shape->conic, NULL);
    if (term >= 0)
        return shape->term[term] != 0.0
                   ? reject_repeated_shape_item(text, word)
                   : glint_text_read_value(text, &term_range,
                                           &shape->term[term], NULL);
    return glint_text_set_error(
        text, word->place,
        "'%s' is unknown; expected conic, A4, A6 .. A20, cylinder or toric",
        glint_word_quote(word, quote));
}

/* Reads the rest of a line "shape [conic K] [A4 V] .. [A20 V] [cylinder AXIS |
 * toric AXIS RADIUS]" into SHAPE. Members of SHAPE that the line does not set
 * keep their values. On mistakes, such as repeated items, sets the error of
 * TEXT and returns false. */
static bool read_shape_words(struct glint_text *text, struct glint_shape *shape)
{
    struct glint_word word = glint_text_next_word(text);

    if (!word.length)
        return glint_text_set_error(text, word.place, "shape is missing");
    for (; word.length; word = glint_text_next_word(text))
        if (!read_shape_item(text, shape, &word))
            return false;
    return true;
}

/* Reads the rest of a line "group [decentre X Y] [tilt X Y]" into SHAPE. */
static bool read_group_words(struct glint_text *text, struct glint_shape *shape)
{
    struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES];

    if (!word.length)
        return glint_text_set_error(text, word.place,
                                    "decentre or tilt is missing");
    for (; word.length; word = glint_text_next_word(text)) {
        const bool tilt = glint_word_equals(&word, "tilt");
        const struct glint_text_range *const range =
            tilt ? &tilt_range : &shift_range;
        double *const to = tilt ? shape->tilt_deg : shape->decentre_mm;

        if (!tilt && !glint_word_equals(&word, "decentre"))
            return glint_text_set_error(
                text, word.place, "expected 'decentre' or 'tilt', not '%s'",
                glint_word_quote(&word, quote));
        if (to[0] != 0.0 || to[1] != 0.0)
            return reject_repeated_shape_item(text, &word);
        if (!glint_text_read_value(text, range, &to[0], NULL) ||
            !glint_text_read_value(text, range, &to[1], NULL))
            return false;
    }
    return true;
}

/* Min relative change of the focal length between two positions of a zoom
 * lens. */
#define LEAST_ZOOM 1e-3

/* Cuts REST after its first slash. Returns the text before that slash, or all
 * of REST if it has none. */
static struct glint_word cut_word_at_slash(struct glint_word *rest)
{
    const char *slash = memchr(rest->start, '/', (size_t)rest->length);
    struct glint_word word = *rest;

    word.length = slash ? (int)(slash - rest->start) : rest->length;
    rest->start += word.length + (slash ? 1 : 0);
    rest->length -= word.length + (slash ? 1 : 0);
    rest->place.column += word.length + 1;
    return word;
}

static int count_slashes(const struct glint_word *word)
{
    int n = 0;

    for (int i = 0; i < word->length; i++)
        n += word->start[i] == '/';
    return n;
}

/* Does the work of read_zoom_columns(), and sets N to the count of numbers in
 * the word. */
static bool read_and_count_columns(struct glint_text *text,
                                   const struct glint_text_range *range,
                                   struct glint_zoom *zoom,
                                   double column[GLINT_MAX_POSITIONS],
                                   struct glint_text_place *place, int *n)
{
    struct glint_word word = glint_text_next_word(text);

    *n = count_slashes(&word) + 1;
    if (place)
        *place = word.place;
    if (*n > GLINT_MAX_POSITIONS)
        return glint_text_set_error(text, word.place, "more than %d positions",
                                    GLINT_MAX_POSITIONS);
    if (*n > 1 && zoom->n_positions && *n != zoom->n_positions)
        return glint_text_set_error(
            text, word.place,
            "%s has %d positions, but the lines above have %d", range->name, *n,
            zoom->n_positions);
    for (int k = 0; k < *n; k++) {
        const struct glint_word one = cut_word_at_slash(&word);

        if (!glint_text_parse_value(text, &one, range, &column[k]))
            return false;
    }
    if (*n > 1)
        zoom->n_positions = *n;
    for (int k = *n; k < GLINT_MAX_POSITIONS; k++)
        column[k] = column[*n - 1];
    return true;
}

/* Reads the next word into COLUMN: one number per zoom position, separated by
 * slashes, or a single number for all positions. PLACE receives the word's
 * position. Returns false, with the error set, if a number is not in RANGE or
 * if their count differs from that of earlier lines. */
static bool read_zoom_columns(struct glint_text *text,
                              const struct glint_text_range *range,
                              struct glint_zoom *zoom,
                              double column[GLINT_MAX_POSITIONS],
                              struct glint_text_place *place)
{
    int n;

    return read_and_count_columns(text, range, zoom, column, place, &n);
}

/* Reads the gap behind ELEMENT, one number or one per zoom position. GAP_MM
 * receives the first number. */
static bool read_gap_columns(struct glint_text *text,
                             const struct glint_text_range *range,
                             struct glint_zoom *zoom, int element,
                             double *gap_mm, struct glint_text_place *place)
{
    double column[GLINT_MAX_POSITIONS] = {0};
    const int k = zoom->n_moves;
    int n;

    if (!read_and_count_columns(text, range, zoom, column, place, &n))
        return false;
    *gap_mm = column[0];
    if (n == 1)
        return true;
    if (k == GLINT_MAX_MOVES)
        return glint_text_set_error(
            text, *place, "more than %d thicknesses that change with the zoom",
            GLINT_MAX_MOVES);
    zoom->move[k] = element;
    memcpy(zoom->gap_mm[k], column, sizeof column);
    zoom->n_moves++;
    return true;
}

/* ------------------------------------------------------------------- check */

/* Sets gaps, f-number and stated focal lengths of LENS to those of zoom
 * position K. */
static void set_zoom_position(struct glint_prescription *lens, int k)
{
    const struct glint_zoom *const z = &lens->zoom;

    for (int m = 0; m < z->n_moves; m++)
        *glint_gap_get_pointer(lens, z->move[m]) = z->gap_mm[m][k];
    lens->f_number = z->f_number[k];
    lens->check_focal_mm = z->check_focal_mm[k];
    lens->check_back_mm = z->check_back_mm[k];
}

/* Checks that focal lengths rise or fall monotonically, and sets the zoom
 * parameter of each position, 0 .. 1. */
static bool set_zoom_parameters(struct glint_zoom *z,
                                const struct glint_text *text,
                                const struct glint_places *places)
{
    const int last = z->n_positions - 1;
    const double whole = log(z->focal_mm[last] / z->focal_mm[0]);

    for (int k = 1; k <= last; k++) {
        const double step = log(z->focal_mm[k] / z->focal_mm[k - 1]);

        if (!(step * (whole < 0 ? -1 : 1) > LEAST_ZOOM))
            return glint_text_set_error(
                text,
                places->focal.line ? places->focal
                                   : glint_text_get_end_place(text),
                "focal lengths must only rise or only fall from position to "
                "position, not %.6g mm, %.6g mm",
                z->focal_mm[k - 1], z->focal_mm[k]);
        z->along[k] = log(z->focal_mm[k] / z->focal_mm[0]) / whole;
    }
    z->along[last] = 1.0;
    return true;
}

/* Checks LENS at each zoom position, after all lines were read, and leaves it
 * at the first one. Returns false, with the error set, if a check fails. */
static bool check_all_zoom_positions(struct glint_prescription *lens,
                                     const struct glint_text *text,
                                     const struct glint_places *places)
{
    struct glint_zoom *const z = &lens->zoom;

    if (z->n_positions && !z->n_moves)
        return glint_text_set_error(text, glint_text_get_end_place(text),
                                    "the table has %d zoom positions, but no "
                                    "thickness differs between them",
                                    z->n_positions);
    for (int k = 0; k < (z->n_positions ? z->n_positions : 1); k++) {
        struct glint_optics optics;

        set_zoom_position(lens, k);
        if (!glint_prescription_check(lens, text, places))
            return false;
        glint_optics_of(lens, &optics);
        z->focal_mm[k] = optics.focal_mm;
        z->back_mm[k] = optics.back_focal_mm;
        z->last_gap_mm[k] = get_element_gap_mm(lens, count_elements(lens) - 1);
    }
    set_zoom_position(lens, 0);
    return !z->n_positions || set_zoom_parameters(z, text, places);
}

#define MAX_GLASSES      64
#define GLASS_NAME_BYTES 24

STATIC_ASSERT(sizeof(((struct glint_prescription *)0)->source) >
              GLINT_LINE_BYTES);

struct medium {
    double nd, vd;
    /* Sellmeier coefficients; all 0 unless the glass is in the catalogue */
    double sellmeier[6];
};

static const struct glint_text_range f_number_range = {
    "f-number", GLINT_MIN_F_NUMBER, GLINT_MAX_F_NUMBER};
static const struct glint_text_range film_width_range = {"film width", 0.1,
                                                         1000};
static const struct glint_text_range film_height_range = {"film height", 0.1,
                                                          1000};
static const struct glint_text_range stated_range = {"focal length", 0.01,
                                                     GLINT_MAX_FOCAL_MM};
static const struct glint_text_range thickness_range = {"thickness", 0, 1e5};
static const struct glint_text_range front_stop_range = {"thickness", -100,
                                                         1e5};
static const struct glint_text_range semi_range = {"semi-diameter", 0.01, 1e4};
static const struct glint_text_range nd_range = {"index", 1.01, 4};
static const struct glint_text_range vd_range = {"Abbe number", 10, 150};

enum field {
    NAME,
    SOURCE,
    CHARACTER,
    F_NUMBER,
    FILM,
    FOCAL,
    BACK_FOCAL,
    COATING,
    MIXED,
    GLASS,
    SURFACE,
    SHAPE,
    GROUP,
    FOCUS,
    END,
    STOP,
    N_FIELDS
};

struct parser {
    struct glint_text text;
    struct glint_prescription lens;
    /* position of the last line of each type; its line is 0 if the type has not
     * occurred */
    struct glint_text_place word[N_FIELDS];
    struct glint_places places;
    /* coating of surfaces whose line in the table states none */
    struct glint_coating coating;
    bool has_coating[GLINT_MAX_SURFACES];
    int n_elements;
    /* true: the parser is within a group, whose decentre and tilt are in
     * GROUP */
    bool in_group;
    bool in_focus; /* true: the parser is within the focusing group */
    /* true: the last element is a surface; false: it is the stop */
    bool is_surface;
    struct glint_shape group;
    int n_glasses;
    struct {
        char name[GLASS_NAME_BYTES];
        struct medium medium;
    } glass[MAX_GLASSES];
};

/* ------------------------------------------------------------ header lines */

static bool is_lower_case_letter(char c)
{
    return c >= 'a' && c <= 'z';
}

static bool is_letter(char c)
{
    return is_lower_case_letter(c) || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool read_lens_name(struct parser *p)
{
    const struct glint_word word = glint_text_next_word(&p->text);

    if (!word.length)
        return glint_text_set_error(&p->text, word.place, "name is missing");
    if (word.length >= GLINT_NAME_BYTES)
        return glint_text_set_error(&p->text, word.place,
                                    "name is longer than %d bytes",
                                    GLINT_NAME_BYTES - 1);
    for (int i = 0; i < word.length; i++) {
        const char c = word.start[i];

        if (!is_lower_case_letter(c) && !is_digit(c) && (c != '-' || i == 0))
            return glint_text_set_error(&p->text, word.place,
                                        "a name may only contain a-z, 0-9 and "
                                        "-, and must not begin with -");
    }
    memcpy(p->lens.name, word.start, (size_t)word.length);
    return true;
}

static bool read_source_line(struct parser *p)
{
    const struct glint_word rest = glint_text_get_rest(&p->text);

    if (!rest.length)
        return glint_text_set_error(&p->text, rest.place,
                                    "the text of 'source' is missing");
    memcpy(p->lens.source, rest.start, (size_t)rest.length);
    return true;
}

static bool read_character_line(struct parser *p)
{
    const struct glint_word rest = glint_text_get_rest(&p->text);

    if (!rest.length)
        return glint_text_set_error(&p->text, rest.place,
                                    "the text of 'character' is missing");
    memcpy(p->lens.character, rest.start, (size_t)rest.length);
    return true;
}

static bool read_f_number_line(struct parser *p)
{
    return read_zoom_columns(&p->text, &f_number_range, &p->lens.zoom,
                             p->lens.zoom.f_number, &p->places.f_number);
}

static bool read_film_size(struct parser *p)
{
    return glint_text_read_value(&p->text, &film_width_range,
                                 &p->lens.film_width_mm, NULL) &&
           glint_text_read_value(&p->text, &film_height_range,
                                 &p->lens.film_height_mm, NULL);
}

static bool read_stated_focal_length(struct parser *p)
{
    return read_zoom_columns(&p->text, &stated_range, &p->lens.zoom,
                             p->lens.zoom.check_focal_mm, &p->places.focal);
}

static bool read_stated_back_focal_length(struct parser *p)
{
    return read_zoom_columns(&p->text, &stated_range, &p->lens.zoom,
                             p->lens.zoom.check_back_mm, &p->places.back_focal);
}

static bool read_default_coating(struct parser *p)
{
    return glint_coating_read(&p->text, &p->coating);
}

static bool read_mixed_coatings(struct parser *p)
{
    return glint_coatings_read(&p->text, p->lens.mixed, &p->lens.n_mixed);
}

/* ------------------------------------------------------------------- glass */

/* Returns the index of the glass WORD in p->glass; -1 if the table does not
 * define it. */
static int find_table_glass(const struct parser *p,
                            const struct glint_word *word)
{
    int i = p->n_glasses - 1;

    while (i >= 0 && !glint_word_equals(word, p->glass[i].name))
        i--;
    return i;
}

static bool check_glass_name(struct parser *p, const struct glint_word *word)
{
    bool good = word->length > 0 && is_letter(word->start[0]);

    if (!word->length)
        return glint_text_set_error(&p->text, word->place,
                                    "glass name is missing");
    for (int i = 0; i < word->length; i++)
        good = good && (is_letter(word->start[i]) || is_digit(word->start[i]) ||
                        word->start[i] == '-');
    if (!good || word->length >= GLASS_NAME_BYTES)
        return glint_text_set_error(
            &p->text, word->place,
            "glass name must be a letter and at most %d "
            "letters, digits and -",
            GLASS_NAME_BYTES - 2);
    if (glint_word_equals(word, "air") || find_table_glass(p, word) >= 0)
        return glint_text_set_error(&p->text, word->place,
                                    "glass of this name is already defined");
    return true;
}

static bool read_glass_definition(struct parser *p)
{
    const struct glint_word word = glint_text_next_word(&p->text);
    const int n = p->n_glasses;

    if (!check_glass_name(p, &word))
        return false;
    if (n == MAX_GLASSES)
        return glint_text_set_error(&p->text, word.place,
                                    "more than %d glasses", MAX_GLASSES);
    memcpy(p->glass[n].name, word.start, (size_t)word.length);
    p->n_glasses++;
    return glint_text_read_value(&p->text, &nd_range, &p->glass[n].medium.nd,
                                 NULL) &&
           glint_text_read_value(&p->text, &vd_range, &p->glass[n].medium.vd,
                                 NULL);
}

/* Sets MEDIUM to the glass WORD of the catalogue. */
static bool read_catalogue_glass(struct parser *p,
                                 const struct glint_word *word,
                                 struct medium *medium)
{
    const size_t bytes = (size_t)word->length;
    const struct glint_glass *glass = glint_glass_find(word->start, bytes);
    char quote[GLINT_QUOTE_BYTES];

    if (!glass) {
        glass = glint_glass_near(word->start, bytes);
        return glint_text_set_error(
            &p->text, word->place,
            "no glass '%s' is defined above this line, nor in the catalogue"
            "%s%s%s",
            glint_word_quote(word, quote), glass ? "; did you mean " : "",
            glass ? glass->name : "", glass ? "?" : "");
    }
    memcpy(medium->sellmeier, glass->sellmeier, sizeof medium->sellmeier);
    medium->nd = glint_sellmeier_index(glass->sellmeier, LINE_D_NM);
    medium->vd = (medium->nd - 1.0) /
                 (glint_sellmeier_index(glass->sellmeier, LINE_F_NM) -
                  glint_sellmeier_index(glass->sellmeier, LINE_C_NM));
    return true;
}

/* Reads a medium: "air", ND VD, or the name of a glass. */
static bool read_lens_medium(struct parser *p, struct medium *medium)
{
    const struct glint_word word = glint_text_next_word(&p->text);
    int glass;

    p->places.medium = word.place;
    if (!word.length)
        return glint_text_set_error(
            &p->text, word.place,
            "medium is missing: write air, ND VD or the name of a glass");
    *medium = (struct medium){.nd = 1.0};
    if (glint_word_equals(&word, "air"))
        return true;
    if (!is_letter(word.start[0]))
        return glint_text_parse_value(&p->text, &word, &nd_range,
                                      &medium->nd) &&
               glint_text_read_value(&p->text, &vd_range, &medium->vd, NULL);
    glass = find_table_glass(p, &word);
    if (glass < 0)
        return read_catalogue_glass(p, &word, medium);
    *medium = p->glass[glass].medium;
    return true;
}

/* ---------------------------------------------------------------- elements */

/* Reads thickness and semi-diameter of the next element. */
static bool read_gap_and_semi_diameter(struct parser *p,
                                       const struct glint_text_range *gap,
                                       double *thickness_mm, double *semi_mm,
                                       struct glint_text_place *semi)
{
    const int e = p->n_elements++;

    return read_gap_columns(&p->text, gap, &p->lens.zoom, e, thickness_mm,
                            &p->places.thickness[e]) &&
           glint_text_read_value(&p->text, &semi_range, semi_mm, semi);
}

/* Reads the coating of surface K, if the line states one. CEMENTED: the media
 * in front of and behind the surface are glass. */
static bool read_surface_coating(struct parser *p, int k, bool cemented)
{
    struct glint_surface *s = &p->lens.surface[k];
    struct glint_coating coating;
    struct glint_word word;

    if (!glint_text_read_optional_word(&p->text, "coating", &word))
        return false;
    p->has_coating[k] = cemented || word.length;
    if (!word.length)
        return true;
    if (!glint_coating_read(&p->text, &coating))
        return false;
    if (cemented && coating.n_films > 0)
        return glint_text_set_error(&p->text, word.place,
                                    "a cemented surface has no coating");
    s->coating = coating;
    return true;
}

static bool read_surface_line(struct parser *p)
{
    const int k = p->lens.n_surfaces;
    struct glint_surface *s = &p->lens.surface[k];
    struct medium before = {.nd = 1.0}, medium = before;

    if (k == GLINT_MAX_SURFACES)
        return glint_text_set_error(&p->text, p->word[SURFACE],
                                    "more than %d surfaces",
                                    GLINT_MAX_SURFACES);
    if (!read_surface_radius(&p->text, &s->radius_mm) ||
        !read_gap_and_semi_diameter(p, &thickness_range, &s->thickness_mm,
                                    &s->semi_mm, &p->places.semi[k]))
        return false;
    if (!read_lens_medium(p, &medium))
        return false;
    if (k > 0)
        before = (struct medium){.nd = s[-1].nd, .vd = s[-1].vd};
    if (before.nd == medium.nd && before.vd == medium.vd)
        return glint_text_set_error(
            &p->text, p->places.medium,
            "both sides of the surface have the same medium");
    s->nd = medium.nd;
    s->vd = medium.vd;
    memcpy(s->sellmeier, medium.sellmeier, sizeof s->sellmeier);
    s->shape = p->group;
    p->group.pivot_mm -= p->in_group ? s->thickness_mm : 0.0;
    p->is_surface = true;
    p->lens.n_surfaces++;
    return read_surface_coating(p, k, before.vd > 0.0 && medium.vd > 0.0);
}

/* Reads the line "shape" of the last surface. */
static bool read_shape_line(struct parser *p)
{
    if (!p->is_surface)
        return glint_text_set_error(
            &p->text, p->word[SHAPE],
            "a shape must follow the line of its surface");
    return read_shape_words(&p->text,
                            &p->lens.surface[p->lens.n_surfaces - 1].shape);
}

static bool read_group_line(struct parser *p)
{
    if (p->in_group || p->in_focus)
        return glint_text_set_error(&p->text, p->word[GROUP],
                                    "the group above has no line 'end'");
    p->in_group = true;
    return read_group_words(&p->text, &p->group);
}

static bool read_focus_line(struct parser *p)
{
    if (p->in_group)
        return glint_text_set_error(&p->text, p->word[FOCUS],
                                    "the group above has no line 'end'");
    p->in_focus = true;
    p->lens.focus_first = p->lens.n_surfaces;
    return true;
}

static bool read_group_end_line(struct parser *p)
{
    if (!p->in_group && !p->in_focus)
        return glint_text_set_error(&p->text, p->word[END],
                                    "'end' without a line 'group' above");
    if (!p->in_group) {
        p->in_focus = false;
        p->lens.n_focus = p->lens.n_surfaces - p->lens.focus_first;
        return p->lens.n_focus > 0 ||
               glint_text_set_error(&p->text, p->word[END],
                                    "the focusing group has no surface");
    }
    p->in_group = false;
    p->group = (struct glint_shape){.conic = 0};
    return true;
}

static bool read_stop_line(struct parser *p)
{
    struct glint_word word;

    if (p->in_group || p->in_focus)
        return glint_text_set_error(
            &p->text, p->word[STOP],
            "the stop cannot be in a group; end it above");
    p->is_surface = false;
    p->lens.stop_after = p->lens.n_surfaces;
    if (!read_gap_and_semi_diameter(
            p, p->lens.n_surfaces ? &thickness_range : &front_stop_range,
            &p->lens.stop_thickness_mm, &p->lens.stop_semi_mm,
            &p->places.stop) ||
        !glint_text_read_optional_word(&p->text, "circle", &word))
        return false;
    p->lens.stop_is_circle = word.length > 0;
    return true;
}

/* ------------------------------------------------------------------- lines */

static const struct {
    const char *word;
    bool (*read)(struct parser *p);
    bool required, repeats;
} fields[N_FIELDS] = {
    [NAME] = {"name", read_lens_name, true, false},
    [SOURCE] = {"source", read_source_line, false, false},
    [CHARACTER] = {"character", read_character_line, false, false},
    [F_NUMBER] = {"f-number", read_f_number_line, true, false},
    [FILM] = {"film", read_film_size, true, false},
    [FOCAL] = {"focal-length", read_stated_focal_length, false, false},
    [BACK_FOCAL] = {"back-focal-length", read_stated_back_focal_length, false,
                    false},
    [COATING] = {"coating", read_default_coating, false, false},
    [MIXED] = {"mixed-coating", read_mixed_coatings, false, false},
    [GLASS] = {"glass", read_glass_definition, false, true},
    [SURFACE] = {"surface", read_surface_line, true, true},
    [SHAPE] = {"shape", read_shape_line, false, true},
    [GROUP] = {"group", read_group_line, false, true},
    [FOCUS] = {"focus", read_focus_line, false, false},
    [END] = {"end", read_group_end_line, false, true},
    [STOP] = {"stop", read_stop_line, true, false},
};

static bool read_table_line(struct parser *p)
{
    struct glint_word word = glint_text_next_word(&p->text);
    char quote[GLINT_QUOTE_BYTES];
    int f = 0;

    if (!word.length)
        return true;
    while (f < N_FIELDS && !glint_word_equals(&word, fields[f].word))
        f++;
    if (f == N_FIELDS)
        return glint_text_set_error(&p->text, word.place, "unknown word '%s'",
                                    glint_word_quote(&word, quote));
    if (p->word[f].line && !fields[f].repeats)
        return glint_text_set_error(&p->text, word.place,
                                    "a second %s; the first is on line %d",
                                    fields[f].word, p->word[f].line);
    p->word[f] = word.place;
    if (!fields[f].read(p))
        return false;
    word = glint_text_next_word(&p->text);
    return !word.length ||
           glint_text_set_error(&p->text, word.place,
                                "'%s' is one value too many for %s",
                                glint_word_quote(&word, quote), fields[f].word);
}

static bool read_all_lines(struct parser *p)
{
    while (glint_text_next_line(&p->text))
        if (!read_table_line(p))
            return false;
    for (int f = 0; f < N_FIELDS; f++)
        if (fields[f].required && !p->word[f].line)
            return glint_text_set_error(
                &p->text, glint_text_get_end_place(&p->text),
                "the line '%s' is missing", fields[f].word);
    return (!p->in_group && !p->in_focus) ||
           glint_text_set_error(&p->text, p->word[p->in_group ? GROUP : FOCUS],
                                "the group has no line 'end'");
}

/* ---------------------------------------------------------------- the lens */

static void set_default_coatings(struct parser *p)
{
    for (int k = 0; k < p->lens.n_surfaces; k++)
        if (!p->has_coating[k])
            p->lens.surface[k].coating = p->coating;
}

enum glint_status glint_prescription_parse(struct glint_prescription *lens,
                                           const char *text, size_t bytes,
                                           const char *file_name,
                                           struct glint_error *error)
{
    struct parser p;

    memset(&p, 0, sizeof(p));
    error->text[0] = '\0';
    glint_coating_set_single_layer(&p.coating, 550);
    if (!glint_text_open(&p.text, text, bytes, file_name, error) ||
        !read_all_lines(&p) ||
        !check_all_zoom_positions(&p.lens, &p.text, &p.places))
        return GLINT_E_LENS;
    set_default_coatings(&p);
    *lens = p.lens;
    return GLINT_OK;
}
