/* SPDX-License-Identifier: MIT
 *
 * An imported lens written down as a table.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/imported.h"

/* Writes what the last surface is other than a sphere, four values to a line,
 * as a table's lines are short. */
static void write_shape(FILE *file, const struct glint_shape *shape,
                        double unit_mm)
{
    int n = 0;

    if (shape->bend != GLINT_BEND_ROUND) {
        fprintf(file, "shape %s %c",
                shape->across_mm != 0 ? "toric" : "cylinder",
                shape->bend == GLINT_BEND_X ? 'x' : 'y');
        if (shape->across_mm != 0)
            fprintf(file, " %.12g", shape->across_mm * unit_mm);
        fputc('\n', file);
    }
    if (shape->conic != 0) {
        fprintf(file, "shape conic %.12g", shape->conic);
        n++;
    }
    for (int i = 0; i < GLINT_SHAPE_TERMS; i++)
        if (shape->term[i] != 0)
            fprintf(file, "%s A%d %.12g",
                    n++ % 4 ? ""
                    : n > 1 ? "\nshape"
                            : "shape",
                    2 * i + 4, shape->term[i] * pow(unit_mm, -(2 * i + 3)));
    if (n > 0)
        fputc('\n', file);
}

static void write_surface(FILE *file, const struct imported_surface *s,
                          double unit)
{
    char radius[32] = "flat";

    if (s->stop) {
        fprintf(file, "stop    %13s %12.9g %10.8g\n", "", s->thickness * unit,
                s->semi * unit);
        return;
    }
    if (s->radius != 0)
        snprintf(radius, sizeof radius, "%.12g", s->radius * unit);
    fprintf(file, "surface %13s %12.9g %10.8g  %s\n", radius,
            s->thickness * unit, s->semi * unit, s->medium);
    write_shape(file, &s->shape, unit);
}

/* Writes TEXT as a comment may have it, other letters than those of ASCII as
 * question marks. */
static void write_words(FILE *file, const char *text, int most)
{
    for (; *text && most > 0; text++, most--)
        fputc(*text < ' ' || *text > '~' ? '?' : *text, file);
}

static void write_head(const struct imported *lens, FILE *file)
{
    const char *stem = strrchr(lens->file, '/');

    fputs("# Imported from ", file);
    write_words(file, stem ? stem + 1 : lens->file, 100);
    fputs(".\n", file);
    for (int k = 0; k < lens->n_notes && k < IMPORT_NOTES; k++) {
        if (lens->note[k].line > 0)
            fprintf(file, "# Line %d: ", lens->note[k].line);
        else
            fputs("# ", file);
        write_words(file, lens->note[k].text, 170);
        fputs(".\n", file);
    }
    fprintf(file, "\nname      %s\n", lens->name);
    if (lens->title[0]) {
        fputs("source    ", file);
        write_words(file, lens->title, 170);
        fputc('\n', file);
    }
    fprintf(file, "f-number  %.6g\nfilm      %.6g %.6g\n", lens->f_number,
            lens->film_mm[0], lens->film_mm[1]);
    fputc('\n', file);
}

char *imported_finish(struct imported *lens, size_t *bytes)
{
    char *text = NULL;
    FILE *file;

    if (!imported_complete(lens))
        return NULL;
    imported_sort_notes(lens);
    if (lens->strict && lens->n_guesses > 0) {
        imported_fail(lens, 0, "%d guess%s, which --strict refuses",
                      lens->n_guesses, lens->n_guesses == 1 ? "" : "es");
        return NULL;
    }
    file = open_memstream(&text, bytes);
    if (!file) {
        imported_fail(lens, 0, "out of memory");
        return NULL;
    }
    write_head(lens, file);
    for (int k = 0; k < lens->n; k++)
        write_surface(file, &lens->surface[k], lens->unit_mm);
    if (fclose(file) == 0)
        return text;
    free(text);
    imported_fail(lens, 0, "out of memory");
    return NULL;
}
