/* SPDX-License-Identifier: MIT
 *
 * What a table needs and files of other programs leave out: one stop in the
 * air, semi-diameters, a film, an f-number, a focus.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/imported.h"

/* A paraxial ray, and what it meets. */
struct thin_ray {
    double y, u;                    /* height and slope before the first */
    double height[IMPORT_SURFACES]; /* at each surface */
};

static double curvature(const struct imported_surface *s)
{
    return s->radius == 0 ? 0 : 1 / s->radius;
}

/* Returns that in the y-z plane, whose first-order values a lens has. */
static double power_of(const struct imported_surface *s)
{
    return s->shape.bend == GLINT_BEND_X ? 0 : curvature(s);
}

/* Takes RAY through all surfaces; its y and u are then those behind the
 * last. */
static void run(const struct imported *lens, struct thin_ray *ray)
{
    double n = 1;

    for (int k = 0; k < lens->n; k++) {
        const struct imported_surface *s = &lens->surface[k];

        ray->height[k] = ray->y;
        ray->u =
            (n * ray->u - ray->y * (s->index - n) * power_of(s)) / s->index;
        if (k + 1 < lens->n)
            ray->y += s->thickness * ray->u;
        n = s->index;
    }
}

/* --------------------------------------------------------------- dummies */

/* Returns whether the same medium is on both sides of surface K. */
static bool does_nothing(const struct imported *lens, int k)
{
    const struct imported_surface *s = &lens->surface[k];

    return strcmp(s->medium, k > 0 ? s[-1].medium : "air") == 0;
}

/* Leaves out surfaces with the same medium on both sides. */
static bool drop_dummies(struct imported *lens)
{
    int n = 0, line = 0;

    for (int k = 0; k < lens->n;) {
        struct imported_surface *s = &lens->surface[k];

        if (s->stop || !does_nothing(lens, k)) {
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
        imported_tell(lens, line,
                      "the same medium on both sides: left out%s, which "
                      "changes nothing",
                      n > 1 ? ", and others like it" : "");
    return lens->n > 0 || imported_fail(lens, 0, "there is no glass in it");
}

/* ------------------------------------------------------------------ stop */

/* Returns the sag of S at the height H, or at its equator. */
static double sag_at(const struct imported_surface *s, double h)
{
    const double c = curvature(s);
    const double root = 1 - (1 + s->shape.conic) * c * c * h * h;
    double terms = 0;

    for (int i = GLINT_SHAPE_TERMS - 1; i >= 0; i--)
        terms = (terms + s->shape.term[i]) * h * h;
    return c * h * h / (1 + sqrt(root > 0 ? root : 0)) + terms * h * h;
}

static bool insert_stop(struct imported *lens, int k)
{
    if (lens->n == IMPORT_SURFACES)
        return imported_fail(lens, 0, "more than %d surfaces", IMPORT_SURFACES);
    memmove(&lens->surface[k + 1], &lens->surface[k],
            (size_t)(lens->n - k) * sizeof lens->surface[0]);
    lens->n++;
    return true;
}

/* Puts the stop beside surface K, which is one: in the air there, at the rim of
 * its opening or at the vertex, whichever is farther from the glass. */
static bool stop_beside(struct imported *lens, int k)
{
    struct imported_surface *s = &lens->surface[k], stop = *s;
    const bool behind = strcmp(s->medium, "air") == 0;
    const double rim = sag_at(s, s->semi);
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
    if (!insert_stop(lens, behind ? k + 1 : k))
        return false;
    lens->surface[behind ? k + 1 : k] = stop;
    /* One that is a guess itself has been told. */
    return lens->stop_guessed ||
           imported_note(lens, stop.line,
                         "the stop is a surface of glass: put %.3g %s it, at "
                         "its rim",
                         fabs(off) * lens->unit_mm,
                         behind ? "mm behind" : "mm before");
}

static int stop_of(const struct imported *lens)
{
    int k = 0;

    while (!lens->surface[k].stop)
        k++;
    return k;
}

/* Puts a stop that is a surface of glass into the air. */
static bool free_stop(struct imported *lens)
{
    const int at = stop_of(lens);

    return does_nothing(lens, at) || stop_beside(lens, at);
}

/* Finds the stop, and frees it. One whose opening is not said waits until that
 * is, as what it has to clear is the surface at its rim. */
static bool settle_stop(struct imported *lens)
{
    int at = -1;

    for (int k = 0; k < lens->n; k++) {
        if (!lens->surface[k].stop)
            continue;
        if (at >= 0)
            return imported_fail(lens, lens->surface[k].line,
                                 "a second stop; the first is on line %d",
                                 lens->surface[at].line);
        at = k;
    }
    if (at < 0) {
        imported_note(lens, 0, "there is no stop: taken at the front");
        lens->surface[0].stop = lens->stop_guessed = true;
        at = 0;
    }
    return !(lens->surface[at].semi > 0) || free_stop(lens);
}

/* ------------------------------------------------------------------ film */

static double focal(const struct imported *lens)
{
    struct thin_ray ray = {.y = 1};

    run(lens, &ray);
    return ray.u != 0 ? -1 / ray.u : 0;
}

/* Sets the film to 3 : 2 within the circle that the lens is for. */
static void settle_film(struct imported *lens, double focal_units)
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
        imported_note(lens, 0,
                      "no field is said: film 36x24 mm taken (--film)");
        return;
    }
    lens->film_mm[0] = 2 * half * 3 / sqrt(13);
    lens->film_mm[1] = 2 * half * 2 / sqrt(13);
    imported_note(lens, 0,
                  "film %.4g x %.4g mm taken, 3:2 within the image of %.4g mm "
                  "(--film)",
                  lens->film_mm[0], lens->film_mm[1], 2 * half);
}

/* ------------------------------------------------------------- openings */

/* Sets what is missing of f-number and pupil; the stop's semi-diameter says it
 * where the file does not. */
static bool settle_pupil(struct imported *lens, double focal_units)
{
    const int stop = stop_of(lens);
    struct thin_ray ray = {.y = 1};

    run(lens, &ray);
    if (lens->f_number_given > 0)
        lens->f_number = lens->f_number_given;
    if (lens->f_number > 0)
        lens->pupil = focal_units / lens->f_number;
    else if (lens->pupil > 0)
        lens->f_number = focal_units / lens->pupil;
    else if (lens->surface[stop].semi > 0 && fabs(ray.height[stop]) > 1e-9) {
        lens->pupil = 2 * lens->surface[stop].semi / fabs(ray.height[stop]);
        lens->f_number = focal_units / lens->pupil;
        /* The table's own rounding must not make it wider than the stop. */
        lens->f_number = ceil(lens->f_number * 1000) / 1000;
        lens->pupil = focal_units / lens->f_number;
        return imported_note(lens, lens->surface[stop].line,
                             "f/%g taken, to which the stop opens",
                             lens->f_number);
    } else
        return imported_fail(lens, 0,
                             "neither f-number, pupil nor the stop's size is "
                             "in it (--f-number)");
    return true;
}

/* Sets semi-diameters that are missing to where paraxial rays of the pupil's
 * rim and of the field's end go. */
static void settle_semis(struct imported *lens)
{
    const int stop = stop_of(lens);
    struct thin_ray rim = {.y = lens->pupil / 2}, chief = {.u = 0.01};
    struct thin_ray slant = {.u = 0.01};
    double field, start;
    int n = 0;

    run(lens, &rim);
    run(lens, &slant);
    /* The chief ray is that with the height 0 at the stop. */
    start = rim.height[stop] != 0
                ? -slant.height[stop] / rim.height[stop] * lens->pupil / 2
                : 0;
    chief.y = start;
    run(lens, &chief);
    field = hypot(lens->film_mm[0], lens->film_mm[1]) / 2 / lens->unit_mm /
            fabs(focal(lens)) / 0.01;
    for (int k = 0; k < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];
        const double least = k == stop ? fabs(rim.height[k]) * (1 + 1e-5) : 0;

        if (s->semi <= 0) {
            s->semi = 1.05 * (fabs(rim.height[k]) +
                              (k == stop ? 0 : fabs(field * chief.height[k])));
            n++;
        }
        if (s->semi < (1 - 1e-5) * least)
            imported_note(lens, s->line,
                          "the stop's semi-diameter is %.6g mm, f/%.4g needs "
                          "%.6g: taken",
                          s->semi * lens->unit_mm, lens->f_number,
                          least * lens->unit_mm);
        s->semi = fmax(s->semi, least);
    }
    if (n > 0)
        imported_note(lens, 0,
                      "%d surface%s no semi-diameter: those of paraxial rays "
                      "taken",
                      n, n == 1 ? " has" : "s have");
}

/* Cuts semi-diameters that reach beyond a sphere or the end of a conic. */
static void cut_semis(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];
        const double size = s->shape.conic > -1
                                ? fabs(s->radius) / sqrt(1 + s->shape.conic)
                                : (double)INFINITY;

        if (s->radius != 0 && s->semi >= size) {
            imported_note(lens, s->line,
                          "semi-diameter %.6g of a surface that ends at "
                          "%.6g: %.6g taken",
                          s->semi, size, 0.98 * size);
            s->semi = 0.98 * size;
        }
    }
}

double imported_gap(const struct imported_surface *s, double h)
{
    return s->thickness + sag_at(s + 1, h) - sag_at(s, h);
}

/* Cuts semi-diameters where neighbours' rims cross, as thin lenses of estimated
 * ones do. */
static bool part_rims(struct imported *lens)
{
    for (int k = 0; k + 1 < lens->n; k++) {
        struct imported_surface *s = &lens->surface[k];
        double low = 0, high = IMPORT_FREE * fmin(s[0].semi, s[1].semi), semi;

        if (imported_gap(s, high) >= 0 || imported_gap(s, 0) < 0 || s[0].stop ||
            s[1].stop)
            continue;
        for (int i = 0; i < 40; i++) {
            const double middle = 0.5 * (low + high);

            if (imported_gap(s, middle) < 0)
                high = middle;
            else
                low = middle;
        }
        semi = low / IMPORT_FREE;
        if (semi * lens->unit_mm < 0.01)
            return imported_fail(lens, s->line,
                                 "the next surface, %.6g mm behind this, "
                                 "crosses it next to the axis",
                                 s->thickness * lens->unit_mm);
        imported_note(lens, s->line,
                      "the next surface crosses this at its rim: "
                      "semi-diameters of %.6g mm taken",
                      semi * lens->unit_mm);
        for (int i = 0; i < 2; i++)
            s[i].semi = fmin(s[i].semi, semi);
    }
    return true;
}

static bool settle_focus(struct imported *lens)
{
    struct thin_ray ray = {.y = 1};
    struct imported_surface *last = &lens->surface[lens->n - 1];
    double behind;

    run(lens, &ray);
    behind = ray.u != 0 ? -ray.y / ray.u : 0;
    if (last->thickness > 0)
        return true;
    if (!(behind > 0))
        return imported_fail(lens, last->line,
                             "no distance to the sensor, and the paraxial "
                             "focus lies %.6g mm before the last surface",
                             -behind * lens->unit_mm);
    last->thickness = behind;
    return imported_note(lens, last->line,
                         "no distance to the sensor: the paraxial focus taken, "
                         "%.6g mm",
                         behind * lens->unit_mm);
}

/* Tells that the light comes from afar where the file has an object that is
 * near, and, where it has a sensor, that this is not moved for it. */
static void tell_object(struct imported *lens)
{
    if (lens->object_near)
        imported_note(lens, lens->object_line,
                      "the object is %g mm away: light from afar taken%s",
                      lens->object * lens->unit_mm,
                      lens->surface[lens->n - 1].thickness > 0
                          ? ", the sensor where the file has it"
                          : "");
}

/* Refuses what runs backwards but for a stop at the front, which may lie behind
 * the vertex, as in phones. */
static bool check_thicknesses(struct imported *lens)
{
    for (int k = 0; k < lens->n; k++)
        if (!(lens->surface[k].thickness >= 0) &&
            !(k == 0 && lens->surface[0].stop && does_nothing(lens, 0) &&
              isfinite(lens->surface[0].thickness)))
            return imported_fail(lens, lens->surface[k].line,
                                 "thickness %g runs backwards",
                                 lens->surface[k].thickness);
    return true;
}

static bool check_end(struct imported *lens)
{
    const struct imported_surface *last = &lens->surface[lens->n - 1];

    return strcmp(last->medium, "air") == 0 ||
           imported_fail(lens, last->line,
                         "there is glass behind the last surface: one is "
                         "missing, as sensors stand in the air");
}

/* Refuses an f-number of the user's whose light does not fit through the front.
 * A file's own is taken as it is, as stops of published lenses open a little
 * wider than their fronts. */
static bool check_front(struct imported *lens, double focal_units)
{
    const double slack = 1.01; /* semi-diameters are rounded */
    const struct imported_surface *front = lens->surface;

    if (front->stop && lens->n > 1)
        front++;
    if (!(lens->f_number_given > 0) || lens->pupil / 2 <= front->semi * slack)
        return true;
    return imported_fail(lens, front->line,
                         "f/%.4g needs %.4g mm of the front, which has a "
                         "semi-diameter of %.4g: f/%g is the fastest "
                         "that there can be",
                         lens->f_number, lens->pupil / 2 * lens->unit_mm,
                         front->semi * lens->unit_mm,
                         ceil(500 * focal_units / front->semi) / 1000);
}

bool imported_complete(struct imported *lens)
{
    double f;

    if (!imported_settle_media(lens) || !drop_dummies(lens) ||
        !check_thicknesses(lens) || !check_end(lens))
        return false;
    tell_object(lens);
    if (!settle_stop(lens))
        return false;
    f = focal(lens);
    if (lens->nominal > 0 && fabs(f / lens->nominal - 1) > 0.02)
        imported_note(lens, 0,
                      "its focal length is %.6g mm, not the stated %.6g: "
                      "there may be a misprint (glint lint)",
                      f * lens->unit_mm, lens->nominal * lens->unit_mm);
    if (f == 0)
        return imported_fail(lens, 0,
                             "light leaves it as it comes in, without a focus; "
                             "glint takes lenses that form an image");
    if (!(f > 0))
        return imported_fail(lens, 0,
                             "focal length is %.6g mm; glint takes lenses "
                             "that form an image",
                             f * lens->unit_mm);
    settle_film(lens, f);
    if (!settle_pupil(lens, f))
        return false;
    settle_semis(lens);
    cut_semis(lens);
    if (!free_stop(lens) || !check_front(lens, f))
        return false;
    return part_rims(lens) && settle_focus(lens);
}
