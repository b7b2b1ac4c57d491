/* SPDX-License-Identifier: MIT */
#include "import/imported.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define LINE_D_NM 587.5618

void imported_begin(struct imported *lens, const char *file, bool strict)
{
    memset(lens, 0, sizeof *lens);
    lens->file = file;
    lens->strict = strict;
    lens->unit_mm = 1;
}

static void say(struct imported *lens, int line, const char *format,
                va_list values)
{
    int n = line > 0 ? snprintf(lens->error, sizeof lens->error,
                                "%.100s:%d: ", lens->file, line)
                     : snprintf(lens->error, sizeof lens->error,
                                "%.100s: ", lens->file);

    n += vsnprintf(lens->error + n, sizeof lens->error - (size_t)n, format,
                   values);
    if ((size_t)n >= sizeof lens->error)
        memcpy(lens->error + sizeof lens->error - 4, "...", 4);
}

bool imported_fail(struct imported *lens, int line, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    say(lens, line, format, values);
    va_end(values);
    return false;
}

bool imported_note(struct imported *lens, int line, const char *format, ...)
{
    const int k = lens->n_notes;
    va_list values;

    va_start(values, format);
    if (lens->strict)
        say(lens, line, format, values);
    else if (k < IMPORT_NOTES) {
        lens->note[k].line = line;
        vsnprintf(lens->note[k].text, sizeof lens->note[k].text, format,
                  values);
    }
    va_end(values);
    lens->n_notes += !lens->strict;
    return !lens->strict;
}

void imported_sort_notes(struct imported *lens)
{
    const int n = lens->n_notes < IMPORT_NOTES ? lens->n_notes : IMPORT_NOTES;

    for (int i = 1; i < n; i++)
        for (int k = i; k > 0 && lens->note[k].line > 0 &&
                        (lens->note[k - 1].line == 0 ||
                         lens->note[k - 1].line > lens->note[k].line);
             k--) {
            const struct imported_note swap = lens->note[k];

            lens->note[k] = lens->note[k - 1];
            lens->note[k - 1] = swap;
        }
}

struct imported_surface *imported_add(struct imported *lens, int line)
{
    struct imported_surface *s = &lens->surface[lens->n];

    if (lens->n == IMPORT_SURFACES) {
        imported_fail(lens, line, "more than %d surfaces", IMPORT_SURFACES);
        return NULL;
    }
    *s = (struct imported_surface){.line = line, .nd = 1};
    lens->n++;
    return s;
}

/* -------------------------------------------------------------------- glass */

/* Sets NAME to the glass of S in capitals, without the maker behind '_'. */
static void plain_name(const struct imported_surface *s, char name[32])
{
    size_t n = 0;

    for (const char *c = s->glass; *c && *c != '_' && n < 31; c++)
        name[n++] = *c >= 'a' && *c <= 'z' ? (char)(*c - 'a' + 'A') : *c;
    name[n] = '\0';
}

/* Returns whether A and B are the same but for hyphens. */
static bool same_letters(const char *a, const char *b)
{
    while (*a || *b) {
        a += *a == '-';
        b += *b == '-';
        if (*a != *b)
            return false;
        a += *a != '\0';
        b += *b != '\0';
    }
    return true;
}

/* Returns the glass of the catalogue that NAME is but for hyphens, or with N-
 * before it the lead-free successor, SUCCEEDS being set; NULL if there is
 * none. */
static const struct glint_glass *catalogue_glass(const char *name,
                                                 bool *succeeds)
{
    const struct glint_glass *glass, *successor = NULL;

    *succeeds = false;
    for (int k = 0; (glass = glint_glass_at(k)) != NULL; k++) {
        if (same_letters(glass->name, name))
            return glass;
        if (strncmp(glass->name, "N-", 2) == 0 &&
            same_letters(glass->name + 2, name))
            successor = glass;
    }
    *succeeds = successor != NULL;
    return successor;
}

static bool by_numbers(struct imported *lens, const struct imported_surface *s,
                       char text[48], double *nd)
{
    double vd = s->vd;

    *nd = s->nd;
    if (!(s->nd >= 1.01 && s->nd <= 4))
        return imported_fail(lens, s->line, "index %g is not that of a glass",
                             s->nd);
    if (!(vd > 0)) {
        /* Schott's line of normal glasses, from K7 to F2. */
        vd = 60.5 - 24.2 * (s->nd - 1.511) / 0.109;
        vd = vd > 70 ? 70 : vd < 22 ? 22 : vd;
        if (!imported_note(lens, s->line,
                           "no Abbe number of index %g: %.1f guessed, that of "
                           "normal glasses",
                           s->nd, vd))
            return false;
    } else if (!(vd >= 10 && vd <= 150))
        return imported_fail(lens, s->line,
                             "Abbe number %g is not that of a glass", vd);
    snprintf(text, 48, "%.9g %.6g", s->nd, vd);
    return true;
}

bool imported_medium(struct imported *lens, const struct imported_surface *s,
                     char text[48], double *nd)
{
    const bool has_numbers = s->nd > 1.01 && s->vd > 0;
    struct glint_surface medium = {.nd = 1};
    const struct glint_glass *glass;
    char name[32];
    bool succeeds;

    *nd = 1;
    snprintf(text, 48, "air");
    if (!s->glass[0])
        return s->nd == 1 || by_numbers(lens, s, text, nd);
    plain_name(s, name);
    glass = catalogue_glass(name, &succeeds);
    if ((!glass || succeeds) && has_numbers)
        return by_numbers(lens, s, text, nd);
    if (!glass) {
        glass = glint_glass_near(name, strlen(name));
        return imported_fail(
            lens, s->line,
            "glass '%s' is not in the catalogue, and the file has no index of "
            "it%s%s%s",
            s->glass, glass ? "; did they mean " : "", glass ? glass->name : "",
            glass ? "?" : "");
    }
    if (succeeds && !imported_note(lens, s->line,
                                   "glass %s is not in the catalogue: its "
                                   "successor %s taken",
                                   s->glass, glass->name))
        return false;
    memcpy(medium.sellmeier, glass->sellmeier, sizeof medium.sellmeier);
    *nd = glint_surface_index(&medium, LINE_D_NM);
    snprintf(text, 48, "%s", glass->name);
    return true;
}
