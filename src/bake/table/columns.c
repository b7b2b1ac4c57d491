/* SPDX-License-Identifier: MIT */
#include "bake/table/columns.h"

#include <math.h>
#include <string.h>

#include "bake/table/elements.h"

/* Least change of a zoom's focal length from column to column, as a share. */
#define LEAST_ZOOM 1e-3

/* Cuts what stands before the next slash off REST. */
static struct glint_word cut(struct glint_word *rest)
{
    const char *slash = memchr(rest->start, '/', (size_t)rest->length);
    struct glint_word word = *rest;

    word.length = slash ? (int)(slash - rest->start) : rest->length;
    rest->start += word.length + (slash ? 1 : 0);
    rest->length -= word.length + (slash ? 1 : 0);
    rest->place.column += word.length + 1;
    return word;
}

static int slashes(const struct glint_word *word)
{
    int n = 0;

    for (int i = 0; i < word->length; i++)
        n += word->start[i] == '/';
    return n;
}

/* Reads as glint_columns_read() does; sets N to how many numbers there are. */
static bool read(struct glint_text *text, const struct glint_text_range *range,
                 struct glint_zoom *zoom, double column[GLINT_MAX_POSITIONS],
                 struct glint_text_place *place, int *n)
{
    struct glint_word word = glint_text_next_word(text);

    *n = slashes(&word) + 1;
    if (place)
        *place = word.place;
    if (*n > GLINT_MAX_POSITIONS)
        return glint_text_fail(text, word.place, "more than %d positions",
                               GLINT_MAX_POSITIONS);
    if (*n > 1 && zoom->n_positions && *n != zoom->n_positions)
        return glint_text_fail(
            text, word.place,
            "%s has %d positions, but what stands above has %d", range->name,
            *n, zoom->n_positions);
    for (int k = 0; k < *n; k++) {
        const struct glint_word one = cut(&word);

        if (!glint_text_value_of(text, &one, range, &column[k]))
            return false;
    }
    if (*n > 1)
        zoom->n_positions = *n;
    for (int k = *n; k < GLINT_MAX_POSITIONS; k++)
        column[k] = column[*n - 1];
    return true;
}

bool glint_columns_read(struct glint_text *text,
                        const struct glint_text_range *range,
                        struct glint_zoom *zoom,
                        double column[GLINT_MAX_POSITIONS],
                        struct glint_text_place *place)
{
    int n;

    return read(text, range, zoom, column, place, &n);
}

bool glint_columns_gap(struct glint_text *text,
                       const struct glint_text_range *range,
                       struct glint_zoom *zoom, int element, double *gap_mm,
                       struct glint_text_place *place)
{
    double column[GLINT_MAX_POSITIONS] = {0};
    const int k = zoom->n_moves;
    int n;

    if (!read(text, range, zoom, column, place, &n))
        return false;
    *gap_mm = column[0];
    if (n == 1)
        return true;
    if (k == GLINT_MAX_MOVES)
        return glint_text_fail(text, *place, "more than %d gaps that change",
                               GLINT_MAX_MOVES);
    zoom->move[k] = element;
    memcpy(zoom->gap_mm[k], column, sizeof column);
    zoom->n_moves++;
    return true;
}

/* ------------------------------------------------------------------- check */

/* Puts LENS at column K, with what the table states there. */
static void put_at(struct glint_prescription *lens, int k)
{
    const struct glint_zoom *const z = &lens->zoom;

    for (int m = 0; m < z->n_moves; m++)
        *glint_gap_of(lens, z->move[m]) = z->gap_mm[m][k];
    lens->f_number = z->f_number[k];
    lens->check_focal_mm = z->check_focal_mm[k];
    lens->check_back_mm = z->check_back_mm[k];
}

/* Checks that focal lengths only rise or only fall, and says how far along the
 * zoom each column is. */
static bool set_along(struct glint_zoom *z, const struct glint_text *text,
                      const struct glint_places *places)
{
    const int last = z->n_positions - 1;
    const double whole = log(z->focal_mm[last] / z->focal_mm[0]);

    for (int k = 1; k <= last; k++) {
        const double step = log(z->focal_mm[k] / z->focal_mm[k - 1]);

        if (!(step * (whole < 0 ? -1 : 1) > LEAST_ZOOM))
            return glint_text_fail(
                text, places->focal.line ? places->focal : glint_text_end(text),
                "focal lengths must only rise or only fall from position to "
                "position, not %.6g mm, %.6g mm",
                z->focal_mm[k - 1], z->focal_mm[k]);
        z->along[k] = log(z->focal_mm[k] / z->focal_mm[0]) / whole;
    }
    z->along[last] = 1.0;
    return true;
}

bool glint_columns_check(struct glint_prescription *lens,
                         const struct glint_text *text,
                         const struct glint_places *places)
{
    struct glint_zoom *const z = &lens->zoom;

    if (z->n_positions && !z->n_moves)
        return glint_text_fail(text, glint_text_end(text),
                               "there are %d positions, but no thickness "
                               "changes",
                               z->n_positions);
    for (int k = 0; k < (z->n_positions ? z->n_positions : 1); k++) {
        struct glint_optics optics;

        put_at(lens, k);
        if (!glint_prescription_check(lens, text, places))
            return false;
        glint_optics_of(lens, &optics);
        z->focal_mm[k] = optics.focal_mm;
        z->back_mm[k] = optics.back_focal_mm;
        z->last_gap_mm[k] = element_gap_mm(lens, element_count(lens) - 1);
    }
    put_at(lens, 0);
    return !z->n_positions || set_along(z, text, places);
}
