/* SPDX-License-Identifier: MIT */
#include "import/imported.h"
#include "posix/output.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define LINE_C_NM 656.2725
#define LINE_D_NM 587.5618
#define LINE_F_NM 486.1327

void imported_init(struct imported *lens, const char *file, bool strict)
{
    memset(lens, 0, sizeof *lens);
    lens->file = file;
    lens->strict = strict;
    lens->unit_mm = 1;
}

/* Sets the error message, unless there is one already. */
static void set_first_error(struct imported *lens, int line, const char *format,
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

bool imported_report_error(struct imported *lens, int line, const char *format,
                           ...)
{
    va_list values;

    va_start(values, format);
    set_first_error(lens, line, format, values);
    va_end(values);
    return false;
}

bool imported_report_no_surfaces(struct imported *lens)
{
    return imported_report_error(
        lens, 0, "no surfaces were found; the file was read as %s (--format)",
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

bool imported_add_note(struct imported *lens, int line, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    add_note(lens, line, true, format, values);
    va_end(values);
    return true;
}

/* Adds a note about an input that does not affect the lens. STRICT accepts
 * lenses with such notes. */
static void add_harmless_note(struct imported *lens, int line,
                              const char *format, ...)
{
    va_list values;

    va_start(values, format);
    add_note(lens, line, false, format, values);
    va_end(values);
}

bool imported_note_unread_word(struct imported *lens, int line,
                               const char *word)
{
    char text[IMPORT_TEXT];

    snprintf(text, sizeof text, "'%.30s' is not read", word);
    for (int k = 0; k < lens->n_notes && k < IMPORT_NOTES; k++)
        if (strcmp(lens->note[k].text, text) == 0)
            return true;
    return imported_add_note(lens, line, "%s", text);
}

void imported_set_object(struct imported *lens, int line, double distance)
{
    lens->object_near = fabs(distance) <= 1e8;
    lens->object_line = line;
    lens->object = distance;
}

bool imported_set_unit(struct imported *lens, int line, double mm)
{
    lens->unit_mm = mm;
    lens->unit_said = true;
    return mm > 0 ||
           imported_report_error(
               lens, line, "the unit of length must be above 0 mm, not %g", mm);
}

void imported_set_image_surface(struct imported *lens, int line, double radius,
                                double defocus)
{
    /* Some programs write a very large radius for a plane, which lens tables do
     * not allow. Such an image surface is plane. */
    if (radius != 0 && fabs(radius) * lens->unit_mm < 1e9)
        imported_add_note(lens, line,
                          "the image surface is curved, radius %.6g mm; a flat "
                          "sensor is assumed",
                          radius * lens->unit_mm);
    if (defocus == 0)
        return;
    lens->surface[lens->n - 1].thickness += defocus;
    add_harmless_note(lens, line,
                      "the image's defocus, %.6g mm, is added to the sensor's "
                      "distance",
                      defocus * lens->unit_mm);
}

bool imported_note_missing_unit(struct imported *lens, const char *word)
{
    return lens->unit_said ||
           imported_add_note(
               lens, 0, "no %s line: lengths are assumed to be in mm", word);
}

bool imported_choose_position(struct imported *lens, int line, int n, int *at)
{
    lens->chosen = true;
    if (lens->position > n)
        return imported_report_error(lens, line, "position %d of %d",
                                     lens->position, n);
    *at = lens->position > 0 ? lens->position - 1 : 0;
    return lens->position > 0 || n == 1 ||
           imported_add_note(
               lens, line, "the first of %d positions is used (--position)", n);
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

struct imported_surface *imported_add_surface(struct imported *lens, int line)
{
    struct imported_surface *s = &lens->surface[lens->n];

    if (lens->n == IMPORT_SURFACES) {
        imported_report_error(lens, line, "more than %d surfaces",
                              IMPORT_SURFACES);
        return NULL;
    }
    *s = (struct imported_surface){.line = line, .nd = 1};
    lens->n++;
    return s;
}

/* -------------------------------------------------------------------- glass */

/* Sets NAME to the glass name of S, in capitals. If the name ends with '_' and
 * a maker that occurs in the catalogue, removes this suffix from NAME and
 * returns the maker; else returns "". */
static const char *strip_glass_maker(const struct imported_surface *s,
                                     char name[32])
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

static bool equals_without_hyphens(const char *a, const char *b)
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

/* Returns the glass NAME of the catalogue; hyphens are ignored. If there is
 * none, returns its lead-free successor "N-NAME" and sets *SUCCEEDS. Returns
 * NULL if there is neither. Considers only glasses of MAKER, unless MAKER is
 * "". */
static const struct glint_glass *
find_catalogue_glass(const char *name, const char *maker, bool *succeeds)
{
    const struct glint_glass *glass, *successor = NULL;

    *succeeds = false;
    for (int k = 0; (glass = glint_glass_at(k)) != NULL; k++) {
        if (*maker &&
            strncasecmp(maker, glass->maker, strlen(glass->maker)) != 0)
            continue;
        if (equals_without_hyphens(glass->name, name))
            return glass;
        if (strncmp(glass->name, "N-", 2) == 0 &&
            equals_without_hyphens(glass->name + 2, name))
            successor = glass;
    }
    *succeeds = successor != NULL;
    return successor;
}

static double compute_refractive_index(const struct glint_glass *glass,
                                       double nm)
{
    struct glint_surface medium = {.nd = 1};

    memcpy(medium.sellmeier, glass->sellmeier, sizeof medium.sellmeier);
    return glint_surface_index(&medium, nm);
}

static double compute_abbe_number(const struct glint_glass *glass)
{
    return (compute_refractive_index(glass, LINE_D_NM) - 1) /
           (compute_refractive_index(glass, LINE_F_NM) -
            compute_refractive_index(glass, LINE_C_NM));
}

/* Guesses the Abbe number of S from its index. If the index has five decimals
 * or more, uses a glass of the catalogue that has this index to the fifth
 * decimal. If there is none, uses the typical Abbe number of glasses of this
 * index. */
static double guess_abbe_number(struct imported *lens,
                                const struct imported_surface *s)
{
    const struct glint_glass *glass;
    const bool is_fine = fabs(s->nd * 1e4 - round(s->nd * 1e4)) > 0.05;
    double vd;

    for (int k = 0; is_fine && (glass = glint_glass_at(k)) != NULL; k++) {
        if (fabs(compute_refractive_index(glass, LINE_D_NM) - s->nd) > 6e-6)
            continue;
        vd = compute_abbe_number(glass);
        imported_add_note(
            lens, s->line,
            "no Abbe number for index %.9g: %.1f assumed, that of "
            "%s, which has this index",
            s->nd, vd, glass->name);
        return vd;
    }
    /* the straight line through the glasses K7 and F2, by which Schott defines
     * normal dispersion */
    vd = 60.5 - 24.2 * (s->nd - 1.511) / 0.109;
    vd = vd > 70 ? 70 : vd < 22 ? 22 : vd;
    imported_add_note(
        lens, s->line,
        "no Abbe number for index %g: %.1f assumed, that of ordinary glass",
        s->nd, vd);
    return vd;
}

static bool set_medium_by_numbers(struct imported *lens,
                                  struct imported_surface *s)
{
    double vd = s->vd;

    s->index = s->nd;
    if (!(s->nd >= 1.01 && s->nd <= 4))
        return imported_report_error(lens, s->line,
                                     "index %g is not that of a glass", s->nd);
    if (!(vd > 0))
        vd = guess_abbe_number(lens, s);
    else if (!(vd >= 10 && vd <= 150))
        return imported_report_error(
            lens, s->line, "Abbe number %g is not that of a glass", vd);
    snprintf(s->medium, sizeof s->medium, "%.9g %.6g", s->nd, vd);
    return true;
}

/* Adds a note if index or Abbe number of the file differ from the catalogue's
 * values of GLASS. */
static void check_index_and_abbe(struct imported *lens,
                                 const struct imported_surface *s,
                                 const struct glint_glass *glass)
{
    const double nd = compute_refractive_index(glass, LINE_D_NM);
    const double vd = compute_abbe_number(glass);

    if (!(fabs(s->nd - nd) < 2e-3 && fabs(s->vd / vd - 1) < 0.02))
        imported_add_note(
            lens, s->line,
            "index %g and Abbe number %g contradict glass %s, which "
            "has %.5f and %.2f; the values of the glass are used",
            s->nd, s->vd, glass->name, nd, vd);
}

static bool set_surface_medium(struct imported *lens,
                               struct imported_surface *s)
{
    const bool has_numbers = s->nd > 1.01 && s->vd > 0;
    const struct glint_glass *glass;
    const char *maker;
    char name[32];
    bool succeeds;

    s->index = 1;
    snprintf(s->medium, sizeof s->medium, "air");
    if (!s->glass[0])
        return s->nd == 1 || set_medium_by_numbers(lens, s);
    maker = strip_glass_maker(s, name);
    glass = find_catalogue_glass(name, maker, &succeeds);
    if ((!glass || succeeds) && has_numbers)
        return set_medium_by_numbers(lens, s);
    if (!glass) {
        glass = glint_glass_near(name, strlen(name));
        return imported_report_error(
            lens, s->line,
            "glass '%s' is not in the catalogue, and the file "
            "does not state its index%s%s%s",
            s->glass, glass ? "; did you mean " : "", glass ? glass->name : "",
            glass ? "?" : "");
    }
    if (succeeds)
        imported_add_note(
            lens, s->line,
            "glass %s is not in the catalogue; its successor %s is used",
            s->glass, glass->name);
    if (has_numbers)
        check_index_and_abbe(lens, s, glass);
    s->index = compute_refractive_index(glass, LINE_D_NM);
    snprintf(s->medium, sizeof s->medium, "%s", glass->name);
    return true;
}

/* Sets medium and index behind each surface from glass names and numbers. */
static bool set_all_media(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++)
        if (!set_surface_medium(lens, &lens->surface[k]))
            return false;
    return true;
}

/* --------------------------------------------------------------- completing
 *
 * Adds the values that a lens table needs and files of other programs omit: one
 * stop in the air, semi-diameters, a film, an f-number, a focus. */

/* A paraxial ray and its height at each surface */
struct thin_ray {
    /* height and slope before the first surface; trace_paraxial_ray() replaces
     * both by the values behind the last surface */
    double y, u;
    double height[IMPORT_SURFACES]; /* height at each surface, in the file's
                                       unit */
};

static double compute_curvature(const struct imported_surface *s)
{
    return s->radius == 0 ? 0 : 1 / s->radius;
}

/* Returns the curvature in the y-z plane, in which paraxial values are
 * computed. */
static double compute_paraxial_curvature(const struct imported_surface *s)
{
    return s->shape.bend == GLINT_BEND_X ? 0 : compute_curvature(s);
}

static void trace_paraxial_ray(const struct imported *lens,
                               struct thin_ray *ray)
{
    double n = 1;

    for (int k = 0; k < lens->n; k++) {
        const struct imported_surface *s = &lens->surface[k];

        ray->height[k] = ray->y;
        ray->u = (n * ray->u -
                  ray->y * (s->index - n) * compute_paraxial_curvature(s)) /
                 s->index;
        if (k + 1 < lens->n)
            ray->y += s->thickness * ray->u;
        n = s->index;
    }
}

/* ---------------------------------------------------------- dummy surfaces */

/* Returns whether the same medium is on both sides of surface K. */
static bool is_dummy_surface(const struct imported *lens, int k)
{
    const struct imported_surface *s = &lens->surface[k];

    return strcmp(s->medium, k > 0 ? s[-1].medium : "air") == 0;
}

/* Removes surfaces with the same medium on both sides, except the stop. */
static bool remove_dummy_surfaces(struct imported *lens)
{
    int n = 0, line = 0;

    for (int k = 0; k < lens->n;) {
        struct imported_surface *s = &lens->surface[k];

        if (s->stop || !is_dummy_surface(lens, k)) {
            k++;
            continue;
        }
        line = n++ == 0 ? s->line : line;
        if (k > 0)
            s[-1].thickness += s->thickness;
        lens->n--;
        memmove(s, s + 1, (size_t)(lens->n - k) * sizeof *s);
    }
    if (n > 0)
        add_harmless_note(lens, line,
                          "a surface between equal media is left out%s, as it "
                          "refracts nothing",
                          n > 1 ? ", and others like it" : "");
    return lens->n > 0 ||
           imported_report_error(lens, 0, "the file contains no glass");
}

/* ------------------------------------------------------------------ stop */

/* Returns the sag of S at height H, in the file's unit. Beyond the equator of a
 * sphere or conic, the root in the formula counts as 0. */
static double compute_surface_sag(const struct imported_surface *s, double h)
{
    const double c = compute_curvature(s);
    const double root = 1 - (1 + s->shape.conic) * c * c * h * h;
    double terms = 0;

    for (int i = GLINT_SHAPE_TERMS - 1; i >= 0; i--)
        terms = (terms + s->shape.term[i]) * h * h;
    return c * h * h / (1 + sqrt(root > 0 ? root : 0)) + terms * h * h;
}

static bool insert_stop_surface(struct imported *lens, int k)
{
    if (lens->n == IMPORT_SURFACES)
        return imported_report_error(lens, 0, "more than %d surfaces",
                                     IMPORT_SURFACES);
    memmove(&lens->surface[k + 1], &lens->surface[k],
            (size_t)(lens->n - k) * sizeof lens->surface[0]);
    lens->n++;
    return true;
}

/* Moves the stop from the glass surface K into the adjacent air. The new
 * position on the axis is that of the surface's rim or of its vertex, whichever
 * is farther from the glass; that of the vertex if the neighbouring surface is
 * nearer than the rim. */
static bool move_stop_to_air(struct imported *lens, int k)
{
    struct imported_surface *s = &lens->surface[k], stop = *s;
    const bool behind = strcmp(s->medium, "air") == 0;
    const double rim = compute_surface_sag(s, s->semi);
    double off = behind ? fmax(0, rim) : fmin(0, rim);

    if (behind && off > s->thickness)
        off = 0;
    if (!behind && k > 0 && -off > s[-1].thickness)
        off = 0;
    s->stop = false;
    stop.radius = 0;
    memset(&stop.shape, 0, sizeof stop.shape);
    stop.thickness = behind ? s->thickness - off : fabs(off);
    if (behind)
        s->thickness = off;
    else if (k > 0)
        s[-1].thickness += off;
    if (!behind) {
        snprintf(stop.medium, sizeof stop.medium, "%s",
                 k > 0 ? s[-1].medium : "air");
        stop.index = k > 0 ? s[-1].index : 1;
    }
    if (!insert_stop_surface(lens, behind ? k + 1 : k))
        return false;
    lens->surface[behind ? k + 1 : k] = stop;
    /* a note about a guessed stop was added already */
    return lens->stop_guessed ||
           imported_add_note(
               lens, stop.line,
               "the stop is a glass surface; it is moved %.3g %s it, "
               "to the surface's rim",
               fabs(off) * lens->unit_mm, behind ? "mm behind" : "mm before");
}

static int find_stop_surface(const struct imported *lens)
{
    int k = 0;

    while (!lens->surface[k].stop)
        k++;
    return k;
}

static bool separate_stop_from_glass(struct imported *lens)
{
    const int at = find_stop_surface(lens);

    return is_dummy_surface(lens, at) || move_stop_to_air(lens, at);
}

/* Finds the stop, or assumes it at the front surface, and moves it into the air
 * if it is on a glass surface. A stop without a semi-diameter is moved later,
 * because the move needs the surface's rim. Rejects a second stop. */
static bool place_stop_surface(struct imported *lens)
{
    int at = -1;

    for (int k = 0; k < lens->n; k++) {
        if (!lens->surface[k].stop)
            continue;
        if (at >= 0)
            return imported_report_error(
                lens, lens->surface[k].line,
                "a second stop; the first is on line %d",
                lens->surface[at].line);
        at = k;
    }
    if (at < 0) {
        imported_add_note(lens, 0,
                          "no stop is stated; it is assumed at the front");
        lens->surface[0].stop = lens->stop_guessed = true;
        at = 0;
    }
    return !(lens->surface[at].semi > 0) || separate_stop_from_glass(lens);
}

/* ------------------------------------------------------------------ film */

static double compute_focal_length(const struct imported *lens)
{
    struct thin_ray ray = {.y = 1};

    trace_paraxial_ray(lens, &ray);
    return ray.u != 0 ? -1 / ray.u : 0;
}

/* Unless the file states the film, sets it to a 3 : 2 rectangle within the
 * lens's image circle, or to 36 x 24 mm if the file states no field. */
static void set_film_size(struct imported *lens, double focal_units)
{
    double half = lens->height;

    if (lens->film_mm[0] > 0)
        return;
    if (!(half > 0) && lens->field_deg > 0 && lens->field_deg < 80)
        half = fabs(focal_units) * tan(lens->field_deg * 0.017453292519943295);
    half *= lens->unit_mm;
    if (!(half > 0.05)) {
        lens->film_mm[0] = 36;
        lens->film_mm[1] = 24;
        imported_add_note(
            lens, 0, "no field is stated; film 36x24 mm is assumed (--film)");
        return;
    }
    lens->film_mm[0] = 2 * half * 3 / sqrt(13);
    lens->film_mm[1] = 2 * half * 2 / sqrt(13);
    imported_add_note(lens, 0,
                      "film %.4g x %.4g mm is assumed, 3:2 within the image of "
                      "%.4g mm (--film)",
                      lens->film_mm[0], lens->film_mm[1], 2 * half);
}

/* --------------------------------------------------------------- apertures */

/* Computes the f-number from the pupil diameter or vice versa, or both from the
 * stop's semi-diameter if the file states neither. */
static bool set_pupil_and_f_number(struct imported *lens, double focal_units)
{
    const int stop = find_stop_surface(lens);
    struct thin_ray ray = {.y = 1};

    trace_paraxial_ray(lens, &ray);
    if (lens->f_number_given > 0)
        lens->f_number = lens->f_number_given;
    if (lens->f_number > 0)
        lens->pupil = focal_units / lens->f_number;
    else if (lens->pupil > 0)
        lens->f_number = focal_units / lens->pupil;
    else if (lens->surface[stop].semi > 0 && fabs(ray.height[stop]) > 1e-9) {
        lens->pupil = 2 * lens->surface[stop].semi / fabs(ray.height[stop]);
        lens->f_number = focal_units / lens->pupil;
        /* Round up, so that the table's f-number does not open wider than the
         * stop. */
        lens->f_number = ceil(lens->f_number * 1000) / 1000;
        lens->pupil = focal_units / lens->f_number;
        return imported_add_note(lens, lens->surface[stop].line,
                                 "f/%g is assumed, that of the fully open stop",
                                 lens->f_number);
    } else
        return imported_report_error(
            lens, 0,
            "the file states neither f-number, pupil nor the "
            "size of the stop (--f-number)");
    return true;
}

/* Sets missing semi-diameters by two paraxial rays: the ray through the rim of
 * the pupil, and the chief ray from the edge of the field. Semi-diameters are
 * 1.05 times the sum of the two heights. Enlarges a stop that is too small for
 * the f-number. */
static void set_missing_semi_diameters(struct imported *lens)
{
    const int stop = find_stop_surface(lens);
    struct thin_ray rim = {.y = lens->pupil / 2}, chief = {.u = 0.01};
    struct thin_ray slant = {.u = 0.01};
    double field, start;
    int n = 0;

    trace_paraxial_ray(lens, &rim);
    trace_paraxial_ray(lens, &slant);
    /* The chief ray has height 0 at the stop. The chief ray is a linear
     * combination of the rays RIM and SLANT. */
    start = rim.height[stop] != 0
                ? -slant.height[stop] / rim.height[stop] * lens->pupil / 2
                : 0;
    chief.y = start;
    trace_paraxial_ray(lens, &chief);
    field = hypot(lens->film_mm[0], lens->film_mm[1]) / 2 / lens->unit_mm /
            fabs(compute_focal_length(lens)) / 0.01;
    for (int k = 0; k < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];
        const double least = k == stop ? fabs(rim.height[k]) * (1 + 1e-5) : 0;

        if (s->semi <= 0) {
            s->semi = 1.05 * (fabs(rim.height[k]) +
                              (k == stop ? 0 : fabs(field * chief.height[k])));
            n++;
        }
        if (s->semi < (1 - 1e-5) * least)
            imported_add_note(lens, s->line,
                              "the stop's semi-diameter is %.6g mm, but f/%.4g "
                              "needs %.6g, which is used",
                              s->semi * lens->unit_mm, lens->f_number,
                              least * lens->unit_mm);
        s->semi = fmax(s->semi, least);
    }
    if (n > 0)
        imported_add_note(
            lens, 0,
            "%d surface%s no semi-diameter; those of paraxial rays are used", n,
            n == 1 ? " has" : "s have");
}

/* Reduces semi-diameters that are larger than the sphere or conic itself. */
static void limit_semi_diameters(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];
        const double size = s->shape.conic > -1
                                ? fabs(s->radius) / sqrt(1 + s->shape.conic)
                                : (double)INFINITY;

        if (s->radius != 0 && s->semi >= size) {
            imported_add_note(lens, s->line,
                              "semi-diameter %.6g exceeds the surface, which "
                              "ends at %.6g; %.6g is used",
                              s->semi, size, 0.98 * size);
            s->semi = 0.98 * size;
        }
    }
}

double imported_compute_gap_at_height(const struct imported_surface *s,
                                      double h)
{
    return s->thickness + compute_surface_sag(s + 1, h) -
           compute_surface_sag(s, h);
}

/* Reduces semi-diameters where neighbouring surfaces cross. This happens at
 * thin lenses if semi-diameters are estimates. Rejects surfaces that cross near
 * the axis. */
static bool separate_surface_rims(struct imported *lens)
{
    for (int k = 0; k + 1 < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];
        double low = 0, high = IMPORT_FREE * fmin(s[0].semi, s[1].semi), semi;

        if (imported_compute_gap_at_height(s, high) >= 0 ||
            imported_compute_gap_at_height(s, 0) < 0 || s[0].stop || s[1].stop)
            continue;
        for (int i = 0; i < 40; i++) {
            const double middle = 0.5 * (low + high);

            if (imported_compute_gap_at_height(s, middle) < 0)
                high = middle;
            else
                low = middle;
        }
        semi = low / IMPORT_FREE;
        if (semi * lens->unit_mm < 0.01)
            return imported_report_error(lens, s->line,
                                         "the next surface, %.6g mm behind "
                                         "this, crosses it near the axis",
                                         s->thickness * lens->unit_mm);
        imported_add_note(lens, s->line,
                          "the next surface crosses this one at its rim; "
                          "semi-diameters of %.6g mm are used",
                          semi * lens->unit_mm);
        for (int i = 0; i < 2; i++)
            s[i].semi = fmin(s[i].semi, semi);
    }
    return true;
}

static bool set_missing_sensor_distance(struct imported *lens)
{
    struct thin_ray ray = {.y = 1};
    struct imported_surface *last = &lens->surface[lens->n - 1];
    double behind;

    trace_paraxial_ray(lens, &ray);
    behind = ray.u != 0 ? -ray.y / ray.u : 0;
    if (last->thickness > 0)
        return true;
    if (!(behind > 0))
        return imported_report_error(
            lens, last->line,
            "no distance to the sensor, and the paraxial "
            "focus lies %.6g mm before the last surface",
            -behind * lens->unit_mm);
    last->thickness = behind;
    return imported_add_note(
        lens, last->line,
        "no distance to the sensor is stated; the paraxial "
        "focus is used, %.6g mm",
        behind * lens->unit_mm);
}

/* If the file has a near object, adds a note that light from infinity is
 * assumed, and whether the sensor is at the distance in the file. */
static void note_near_object(struct imported *lens)
{
    if (lens->object_near)
        imported_add_note(
            lens, lens->object_line,
            "the object is %g mm away; light from infinity is assumed%s",
            lens->object * lens->unit_mm,
            lens->surface[lens->n - 1].thickness > 0
                ? ", with the sensor at the distance in the file"
                : "");
}

/* Rejects negative thicknesses. An exception is a stop in front of the lens,
 * which may lie behind the vertex of the first surface, as in phone lenses. */
static bool check_thicknesses(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++)
        if (!(lens->surface[k].thickness >= 0) &&
            !(k == 0 && lens->surface[0].stop && is_dummy_surface(lens, 0) &&
              isfinite(lens->surface[0].thickness)))
            return imported_report_error(lens, lens->surface[k].line,
                                         "thickness %g runs backwards",
                                         lens->surface[k].thickness);
    return true;
}

static bool check_last_surface(struct imported *lens)
{
    const struct imported_surface *last = &lens->surface[lens->n - 1];

    return strcmp(last->medium, "air") == 0 ||
           imported_report_error(
               lens, last->line,
               "there is glass behind the last surface; a surface is "
               "missing, as the sensor is in air");
}

/* Rejects an f-number set by the user if the beam at this f-number is wider
 * than the front surface. The f-number of the file is not checked, because
 * published lenses often have a stop that is slightly too wide for the
 * front. */
static bool check_front_aperture(struct imported *lens, double focal_units)
{
    const double slack = 1.01; /* tolerance, as semi-diameters are rounded */
    const struct imported_surface *front = lens->surface;

    if (front->stop && lens->n > 1)
        front++;
    if (!(lens->f_number_given > 0) || lens->pupil / 2 <= front->semi * slack)
        return true;
    return imported_report_error(
        lens, front->line,
        "f/%.4g needs a front semi-diameter of %.4g mm, but the front has "
        "%.4g; the lens cannot be faster than f/%g",
        lens->f_number, lens->pupil / 2 * lens->unit_mm,
        front->semi * lens->unit_mm,
        ceil(500 * focal_units / front->semi) / 1000);
}

/* Checks LENS and computes all missing values that the table needs. */
static bool complete_lens(struct imported *lens)
{
    double f;

    if (!set_all_media(lens) || !remove_dummy_surfaces(lens) ||
        !check_thicknesses(lens) || !check_last_surface(lens))
        return false;
    note_near_object(lens);
    if (!place_stop_surface(lens))
        return false;
    f = compute_focal_length(lens);
    if (lens->nominal > 0 && fabs(f / lens->nominal - 1) > 0.02)
        imported_add_note(lens, 0,
                          "its focal length is %.6g mm, not the stated %.6g: "
                          "there may be a misprint (glint lint)",
                          f * lens->unit_mm, lens->nominal * lens->unit_mm);
    if (f == 0)
        return imported_report_error(
            lens, 0,
            "the system is afocal; glint needs a lens that forms an image");
    if (!(f > 0))
        return imported_report_error(
            lens, 0,
            "focal length is %.6g mm; glint needs a lens that forms an image",
            f * lens->unit_mm);
    set_film_size(lens, f);
    if (!set_pupil_and_f_number(lens, f))
        return false;
    set_missing_semi_diameters(lens);
    limit_semi_diameters(lens);
    if (!separate_stop_from_glass(lens) || !check_front_aperture(lens, f))
        return false;
    return separate_surface_rims(lens) && set_missing_sensor_distance(lens);
}

/* Writes the lines "shape" for the bend, conic and aspheric terms of SHAPE. A
 * line has at most four values, because lines of lens tables are short. */
static void write_surface_shape(FILE *file, const struct glint_shape *shape,
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

static void write_surface_line(FILE *file, const struct imported_surface *s,
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
    write_surface_shape(file, &s->shape, unit);
}

/* Writes at most MOST characters of TEXT as part of a comment, with '?' for
 * characters other than ASCII. */
static void write_comment_words(FILE *file, const char *text, int most)
{
    for (; *text && most > 0; text++, most--)
        fputc(*text < ' ' || *text > '~' ? '?' : *text, file);
}

static void write_table_head(const struct imported *lens, FILE *file)
{
    const char *stem = strrchr(lens->file, '/');

    fputs("# Imported from ", file);
    write_comment_words(file, stem ? stem + 1 : lens->file, 100);
    fputs(".\n", file);
    for (int k = 0; k < lens->n_notes && k < IMPORT_NOTES; k++) {
        if (lens->note[k].line > 0)
            fprintf(file, "# Line %d: ", lens->note[k].line);
        else
            fputs("# ", file);
        write_comment_words(file, lens->note[k].text, 170);
        fputs(".\n", file);
    }
    fprintf(file, "\nname      %s\n", lens->name);
    if (lens->title[0]) {
        fputs("source    ", file);
        write_comment_words(file, lens->title, 170);
        fputc('\n', file);
    }
    fprintf(file, "f-number  %.6g\nfilm      %.6g %.6g\n", lens->f_number,
            lens->film_mm[0], lens->film_mm[1]);
    fputc('\n', file);
}

char *imported_write_table(struct imported *lens, size_t *bytes)
{
    char *text = NULL;
    FILE *file;

    if (!complete_lens(lens))
        return NULL;
    imported_sort_notes(lens);
    if (lens->strict && lens->n_guesses > 0) {
        imported_report_error(lens, 0,
                              "%d assumption%s, which --strict rejects",
                              lens->n_guesses, lens->n_guesses == 1 ? "" : "s");
        return NULL;
    }
    file = glint_memory_file_open(&text, bytes);
    if (!file) {
        imported_report_error(lens, 0, "out of memory");
        return NULL;
    }
    write_table_head(lens, file);
    for (int k = 0; k < lens->n; k++)
        write_surface_line(file, &lens->surface[k], lens->unit_mm);
    if (glint_memory_file_close(file))
        return text;
    free(text);
    imported_report_error(lens, 0, "out of memory");
    return NULL;
}
