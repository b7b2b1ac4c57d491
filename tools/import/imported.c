/* SPDX-License-Identifier: MIT */
#include "import/imported.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define LINE_C_NM 656.2725
#define LINE_D_NM 587.5618
#define LINE_F_NM 486.1327

void imported_begin(struct imported *lens, const char *file, bool strict)
{
    memset(lens, 0, sizeof *lens);
    lens->file = file;
    lens->strict = strict;
    lens->unit_mm = 1;
}

/* Sets the error, but for one that there is. */
static void say(struct imported *lens, int line, const char *format,
                va_list values)
{
    int n;

    if (lens->error[0])
        return;
    n = line > 0
            ? snprintf(lens->error, sizeof lens->error,
                       "%.100s:%d: ", lens->file, line)
            : snprintf(lens->error, sizeof lens->error, "%.100s: ", lens->file);

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

bool imported_empty(struct imported *lens)
{
    return imported_fail(lens, 0,
                         "there are no surfaces in it, read as %s (--format)",
                         lens->format);
}

static void add_note(struct imported *lens, int line, bool guess,
                     const char *format, va_list values)
{
    const int k = lens->n_notes++;

    lens->n_guesses += guess;
    if (k < IMPORT_NOTES) {
        lens->note[k].line = line;
        lens->note[k].guess = guess;
        vsnprintf(lens->note[k].text, sizeof lens->note[k].text, format,
                  values);
    }
}

bool imported_note(struct imported *lens, int line, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    add_note(lens, line, true, format, values);
    va_end(values);
    return true;
}

void imported_tell(struct imported *lens, int line, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    add_note(lens, line, false, format, values);
    va_end(values);
}

bool imported_unread(struct imported *lens, int line, const char *word)
{
    char text[IMPORT_TEXT];

    snprintf(text, sizeof text, "'%.30s' is not read", word);
    for (int k = 0; k < lens->n_notes && k < IMPORT_NOTES; k++)
        if (strcmp(lens->note[k].text, text) == 0)
            return true;
    return imported_note(lens, line, "%s", text);
}

void imported_object(struct imported *lens, int line, double distance)
{
    lens->object_near = fabs(distance) <= 1e8;
    lens->object_line = line;
    lens->object = distance;
}

bool imported_unit(struct imported *lens, int line, double mm)
{
    lens->unit_mm = mm;
    lens->unit_said = true;
    return mm > 0 || imported_fail(lens, line, "unit %g is no length", mm);
}

void imported_image(struct imported *lens, int line, double radius,
                    double defocus)
{
    /* Planes of some have a radius that no table takes. */
    if (radius != 0 && fabs(radius) * lens->unit_mm < 1e9)
        imported_note(lens, line,
                      "the image is bent, by a radius of %.6g mm: a flat "
                      "sensor taken",
                      radius * lens->unit_mm);
    if (defocus == 0)
        return;
    lens->surface[lens->n - 1].thickness += defocus;
    imported_tell(lens, line,
                  "the image's defocus, %.6g mm, is added to the sensor's "
                  "distance",
                  defocus * lens->unit_mm);
}

bool imported_need_unit(struct imported *lens, const char *word)
{
    return lens->unit_said ||
           imported_note(lens, 0, "no %s line: lengths are taken as mm", word);
}

bool imported_choose(struct imported *lens, int line, int n, int *at)
{
    lens->chosen = true;
    if (lens->position > n)
        return imported_fail(lens, line, "position %d of %d", lens->position,
                             n);
    *at = lens->position > 0 ? lens->position - 1 : 0;
    return lens->position > 0 || n == 1 ||
           imported_note(lens, line,
                         "the first of %d positions is taken (--position)", n);
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

/* Sets NAME to the glass of S in capitals. Returns the maker behind '_', or "":
 * what else is there belongs to the name. */
static const char *plain_name(const struct imported_surface *s, char name[32])
{
    const struct glint_glass *glass;
    const char *maker = strrchr(s->glass, '_');
    size_t n = 0;
    bool known = false;

    for (int k = 0; maker && (glass = glint_glass_at(k)) != NULL && !known; k++)
        known = strncasecmp(maker + 1, glass->maker, strlen(glass->maker)) == 0;
    for (const char *c = s->glass; *c && (!known || c != maker) && n < 31; c++)
        name[n++] = *c >= 'a' && *c <= 'z' ? (char)(*c - 'a' + 'A') : *c;
    name[n] = '\0';
    return known ? maker + 1 : "";
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
 * none. One of another than MAKER is none, if that is said. */
static const struct glint_glass *
catalogue_glass(const char *name, const char *maker, bool *succeeds)
{
    const struct glint_glass *glass, *successor = NULL;

    *succeeds = false;
    for (int k = 0; (glass = glint_glass_at(k)) != NULL; k++) {
        if (*maker &&
            strncasecmp(maker, glass->maker, strlen(glass->maker)) != 0)
            continue;
        if (same_letters(glass->name, name))
            return glass;
        if (strncmp(glass->name, "N-", 2) == 0 &&
            same_letters(glass->name + 2, name))
            successor = glass;
    }
    *succeeds = successor != NULL;
    return successor;
}

static double index_at(const struct glint_glass *glass, double nm)
{
    struct glint_surface medium = {.nd = 1};

    memcpy(medium.sellmeier, glass->sellmeier, sizeof medium.sellmeier);
    return glint_surface_index(&medium, nm);
}

static double abbe_of(const struct glint_glass *glass)
{
    return (index_at(glass, LINE_D_NM) - 1) /
           (index_at(glass, LINE_F_NM) - index_at(glass, LINE_C_NM));
}

/* Guesses the Abbe number of the index of S: that of the glass of the catalogue
 * that has it to the fifth decimal, if there is one. */
static double guess_abbe(struct imported *lens,
                         const struct imported_surface *s)
{
    const struct glint_glass *glass;
    const bool is_fine = fabs(s->nd * 1e4 - round(s->nd * 1e4)) > 0.05;
    double vd;

    for (int k = 0; is_fine && (glass = glint_glass_at(k)) != NULL; k++) {
        if (fabs(index_at(glass, LINE_D_NM) - s->nd) > 6e-6)
            continue;
        vd = abbe_of(glass);
        imported_note(lens, s->line,
                      "no Abbe number of index %.9g: %.1f guessed, that of %s, "
                      "which has this index",
                      s->nd, vd, glass->name);
        return vd;
    }
    /* Schott's line of normal glasses, from K7 to F2. */
    vd = 60.5 - 24.2 * (s->nd - 1.511) / 0.109;
    vd = vd > 70 ? 70 : vd < 22 ? 22 : vd;
    imported_note(lens, s->line,
                  "no Abbe number of index %g: %.1f guessed, that of "
                  "normal glasses",
                  s->nd, vd);
    return vd;
}

static bool by_numbers(struct imported *lens, struct imported_surface *s)
{
    double vd = s->vd;

    s->index = s->nd;
    if (!(s->nd >= 1.01 && s->nd <= 4))
        return imported_fail(lens, s->line, "index %g is not that of a glass",
                             s->nd);
    if (!(vd > 0))
        vd = guess_abbe(lens, s);
    else if (!(vd >= 10 && vd <= 150))
        return imported_fail(lens, s->line,
                             "Abbe number %g is not that of a glass", vd);
    snprintf(s->medium, sizeof s->medium, "%.9g %.6g", s->nd, vd);
    return true;
}

/* Notes numbers of the file that are not those of its GLASS. */
static void check_numbers(struct imported *lens,
                          const struct imported_surface *s,
                          const struct glint_glass *glass)
{
    const double nd = index_at(glass, LINE_D_NM);
    const double vd = abbe_of(glass);

    if (!(fabs(s->nd - nd) < 2e-3 && fabs(s->vd / vd - 1) < 0.02))
        imported_note(lens, s->line,
                      "index %g and Abbe number %g beside glass %s, which "
                      "has %.5f and %.2f: those of the glass taken",
                      s->nd, s->vd, glass->name, nd, vd);
}

static bool settle_medium(struct imported *lens, struct imported_surface *s)
{
    const bool has_numbers = s->nd > 1.01 && s->vd > 0;
    const struct glint_glass *glass;
    const char *maker;
    char name[32];
    bool succeeds;

    s->index = 1;
    snprintf(s->medium, sizeof s->medium, "air");
    if (!s->glass[0])
        return s->nd == 1 || by_numbers(lens, s);
    maker = plain_name(s, name);
    glass = catalogue_glass(name, maker, &succeeds);
    if ((!glass || succeeds) && has_numbers)
        return by_numbers(lens, s);
    if (!glass) {
        glass = glint_glass_near(name, strlen(name));
        return imported_fail(
            lens, s->line,
            "glass '%s' is not in the catalogue, and the file has no index of "
            "it%s%s%s",
            s->glass, glass ? "; did they mean " : "", glass ? glass->name : "",
            glass ? "?" : "");
    }
    if (succeeds)
        imported_note(lens, s->line,
                      "glass %s is not in the catalogue: its successor %s "
                      "taken",
                      s->glass, glass->name);
    if (has_numbers)
        check_numbers(lens, s, glass);
    s->index = index_at(glass, LINE_D_NM);
    snprintf(s->medium, sizeof s->medium, "%s", glass->name);
    return true;
}

bool imported_settle_media(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++)
        if (!settle_medium(lens, &lens->surface[k]))
            return false;
    return true;
}
