/* SPDX-License-Identifier: MIT
 *
 * An imported lens written down as a table.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/imported.h"

static void write_shape(FILE *file, const struct glint_shape *shape,
                        double unit_mm)
{
    const char *between = "shape";

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
        between = "";
    }
    for (int i = 0; i < GLINT_SHAPE_TERMS; i++)
        if (shape->term[i] != 0) {
            fprintf(file, "%s A%d %.12g", between, 2 * i + 4,
                    shape->term[i] * pow(unit_mm, -(2 * i + 3)));
            between = "";
        }
    if (shape->conic != 0 || !*between)
        fputc('\n', file);
}

static bool write_surface(struct imported *lens, FILE *file, int k)
{
    const struct imported_surface *s = &lens->surface[k];
    const double unit = lens->unit_mm;
    char medium[48], radius[32] = "flat";
    double nd;

    if (s->stop) {
        fprintf(file, "stop    %13s %12.9g %10.8g\n", "", s->thickness * unit,
                s->semi * unit);
        return true;
    }
    if (!imported_medium(lens, s, medium, &nd))
        return false;
    if (s->radius != 0)
        snprintf(radius, sizeof radius, "%.12g", s->radius * unit);
    fprintf(file, "surface %13s %12.9g %10.8g  %s\n", radius,
            s->thickness * unit, s->semi * unit, medium);
    write_shape(file, &s->shape, unit);
    return true;
}

/* Writes TEXT as a comment may have it, other letters than those of ASCII as
 * question marks. */
static void write_words(FILE *file, const char *text, int most)
{
    for (; *text && most > 0; text++, most--)
        fputc(*text < ' ' || *text > '~' ? '?' : *text, file);
}

static void write_head(struct imported *lens, FILE *file)
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

/* Writes the surfaces to memory, by which notes of glasses come to be known. */
static char *write_body(struct imported *lens, size_t *bytes)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, bytes);
    bool good = true;

    if (!file) {
        imported_fail(lens, 0, "out of memory");
        return NULL;
    }
    for (int k = 0; k < lens->n && good; k++)
        good = write_surface(lens, file, k);
    if (fclose(file) != 0 || !good) {
        free(text);
        return NULL;
    }
    return text;
}

char *imported_finish(struct imported *lens, size_t *bytes)
{
    char *body, *text = NULL;
    size_t body_bytes = 0;
    FILE *file;

    if (!imported_complete(lens))
        return NULL;
    body = write_body(lens, &body_bytes);
    if (!body)
        return NULL;
    imported_sort_notes(lens);
    file = open_memstream(&text, bytes);
    if (!file)
        imported_fail(lens, 0, "out of memory");
    else {
        write_head(lens, file);
        fwrite(body, 1, body_bytes, file);
        if (fclose(file) != 0) {
            free(text);
            text = NULL;
        }
    }
    free(body);
    return text;
}
