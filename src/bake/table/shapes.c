/* SPDX-License-Identifier: MIT */
#include "bake/table/shapes.h"

#include <math.h>
#include <stdio.h>

static const struct glint_text_range radius_range = {"radius", 0.01, 1e9};
static const struct glint_text_range conic_range = {"conic", -1e4, 1e4};
static const struct glint_text_range term_range = {"aspheric term", -1e18,
                                                   1e18};
static const struct glint_text_range shift_range = {"decentre", -1e3, 1e3};
static const struct glint_text_range tilt_range = {"tilt", -45, 45};

bool glint_radius_read(struct glint_text *text, double *radius_mm)
{
    const struct glint_word word = glint_text_next_word(text);

    *radius_mm = 0.0;
    if (glint_word_is(&word, "flat"))
        return true;
    if (!glint_text_number_of(text, &word, radius_range.name, radius_mm))
        return false;
    if (*radius_mm == 0.0)
        return glint_text_fail(text, word.place,
                               "radius must not be 0; a plane is flat");
    return glint_text_in_range(text, word.place, &radius_range,
                               fabs(*radius_mm));
}

/* Returns the number of the term that WORD names, A4 being 0, or -1. */
static int term_of(const struct glint_word *word)
{
    char name[8];

    for (int k = 0; k < GLINT_SHAPE_TERMS; k++) {
        snprintf(name, sizeof name, "A%d", 4 + 2 * k);
        if (glint_word_is(word, name))
            return k;
    }
    return -1;
}

static bool is_twice(struct glint_text *text, const struct glint_word *word)
{
    char quote[GLINT_QUOTE_BYTES];

    return glint_text_fail(text, word->place, "a second '%s' of this surface",
                           glint_word_quote(word, quote));
}

/* Reads x or y, and the radius across unless CYLINDER. */
static bool read_bend(struct glint_text *text, struct glint_shape *shape,
                      bool cylinder)
{
    const struct glint_word word = glint_text_next_word(text);

    if (!glint_word_is(&word, "x") && !glint_word_is(&word, "y"))
        return glint_text_fail(text, word.place,
                               "the plane of the profile must be x or y");
    shape->bend = glint_word_is(&word, "x") ? GLINT_BEND_X : GLINT_BEND_Y;
    return cylinder || glint_radius_read(text, &shape->across_mm);
}

/* Reads what WORD says of a shape. */
static bool read_word(struct glint_text *text, struct glint_shape *shape,
                      const struct glint_word *word)
{
    const bool cylinder = glint_word_is(word, "cylinder");
    const int term = term_of(word);
    char quote[GLINT_QUOTE_BYTES];

    if (cylinder || glint_word_is(word, "toric"))
        return shape->bend != GLINT_BEND_ROUND
                   ? is_twice(text, word)
                   : read_bend(text, shape, cylinder);
    if (glint_word_is(word, "conic"))
        return shape->conic != 0.0
                   ? is_twice(text, word)
                   : glint_text_value(text, &conic_range, &shape->conic, NULL);
    if (term >= 0)
        return shape->term[term] != 0.0
                   ? is_twice(text, word)
                   : glint_text_value(text, &term_range, &shape->term[term],
                                      NULL);
    return glint_text_fail(text, word->place,
                           "'%s' is none of conic, A4, A6 .. A20, cylinder "
                           "and toric",
                           glint_word_quote(word, quote));
}

bool glint_shape_read(struct glint_text *text, struct glint_shape *shape)
{
    struct glint_word word = glint_text_next_word(text);

    if (!word.length)
        return glint_text_fail(text, word.place, "shape is missing");
    for (; word.length; word = glint_text_next_word(text))
        if (!read_word(text, shape, &word))
            return false;
    return true;
}

bool glint_group_read(struct glint_text *text, struct glint_shape *shape)
{
    struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES];

    if (!word.length)
        return glint_text_fail(text, word.place, "decentre or tilt is missing");
    for (; word.length; word = glint_text_next_word(text)) {
        const bool tilt = glint_word_is(&word, "tilt");
        const struct glint_text_range *const range =
            tilt ? &tilt_range : &shift_range;
        double *const to = tilt ? shape->tilt_deg : shape->decentre_mm;

        if (!tilt && !glint_word_is(&word, "decentre"))
            return glint_text_fail(text, word.place,
                                   "'%s' is neither decentre nor tilt",
                                   glint_word_quote(&word, quote));
        if (to[0] != 0.0 || to[1] != 0.0)
            return is_twice(text, &word);
        if (!glint_text_value(text, range, &to[0], NULL) ||
            !glint_text_value(text, range, &to[1], NULL))
            return false;
    }
    return true;
}
