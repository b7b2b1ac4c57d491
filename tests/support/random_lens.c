/* SPDX-License-Identifier: MIT */
#include "support/random_lens.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "support/stage.h"

enum { MOST_TRIES = 20000 };

struct glass {
    const char *name;
    double nd, vd;
};

static const struct glass catalogue[] = {
    {"BK7", 1.5168, 64.17},    {"FK51", 1.48656, 84.47},
    {"F2", 1.62004, 36.37},    {"SF6", 1.80518, 25.43},
    {"SF11", 1.78472, 25.76},  {"LaK9", 1.691, 54.71},
    {"LaSF9", 1.85025, 32.17}, {"BaF10", 1.67003, 47.11},
    {"SSK8", 1.61772, 49.83},  {"CaF2", 1.43385, 95.23}};

enum { N_CATALOGUE = sizeof catalogue / sizeof *catalogue };

static double choose_log_uniform_number(uint64_t *r, double low, double high)
{
    return exp(stage_random_uniform(r, log(low), log(high)));
}

static bool is_true_with_probability(uint64_t *r, double p)
{
    return stage_random_uniform(r, 0, 1) < p;
}

static int random_integer_below(uint64_t *r, int n)
{
    return (int)(stage_random_bits(r) % (uint64_t)n);
}

static void choose_glass(uint64_t *r, struct glint_surface *s)
{
    const struct glass *g = &catalogue[random_integer_below(r, N_CATALOGUE)];

    s->nd = g->nd;
    s->vd = g->vd;
    if (is_true_with_probability(r, 0.5)) {
        s->nd = stage_random_uniform(r, 1.4, 2.1);
        s->vd = stage_random_uniform(r, 18, 95);
    }
}

static double compute_sag(double radius, double height)
{
    return radius == 0
               ? 0
               : radius -
                     copysign(sqrt(radius * radius - height * height), radius);
}

/* Chooses glasses, semi-diameters that start at 0.1 .. 0.5 mm and change by up
 * to 10 % per surface, and radii of curvature that grow with the number of
 * surfaces. */
static void choose_glasses_and_radii(uint64_t *r, struct glint_prescription *l)
{
    const double weak = sqrt(l->n_surfaces / 4.0);
    double semi = stage_random_uniform(r, 0.1, 0.5);
    /* number of surfaces still missing in the cemented group */
    int left = 0;

    for (int k = 0; k < l->n_surfaces; k++) {
        struct glint_surface *s = &l->surface[k];
        const int rest = l->n_surfaces - k;

        *s = (struct glint_surface){.nd = 1};
        if (left == 0) /* groups of 2 to 4 surfaces; the last may have 1 */
            left = rest <= 3   ? rest
                   : rest == 4 ? 2
                               : 2 + random_integer_below(r, 3);
        left--;
        if (left > 0)
            choose_glass(r, s);
        semi *= stage_random_uniform(r, 0.9, 1.1);
        s->semi_mm = semi;
        if (!is_true_with_probability(r, 0.12))
            s->radius_mm =
                (is_true_with_probability(r, 0.5) ? 1 : -1) *
                fmax(1.05 * semi, weak * choose_log_uniform_number(r, 0.4, 8));
    }
}

/* Chooses thicknesses slightly larger than needed to keep the rims of
 * neighbouring surfaces from crossing. The stop is a separate plane before,
 * between or after the surfaces. */
static void choose_thicknesses(uint64_t *r, struct glint_prescription *l)
{
    l->stop_after = random_integer_below(r, l->n_surfaces + 1);
    l->stop_semi_mm =
        l->surface[l->stop_after == 0 ? 0 : l->stop_after - 1].semi_mm *
        stage_random_uniform(r, 0.5, 1);
    for (int k = 0; k < l->n_surfaces; k++) {
        struct glint_surface *s = &l->surface[k];
        const bool last = k == l->n_surfaces - 1;
        const bool to_stop = l->stop_after == k + 1;
        const double height =
            last ? s->semi_mm : fmin(s->semi_mm, s[1].semi_mm);
        const double out = compute_sag(s->radius_mm, fmin(height, s->semi_mm));
        const double in = last ? 0 : compute_sag(s[1].radius_mm, height);
        const double more = choose_log_uniform_number(r, 0.003, 0.15);

        if (to_stop) {
            s->thickness_mm = fmax(0, out) + more;
            l->stop_thickness_mm = fmax(0, -in) + more;
        } else
            s->thickness_mm = fmax(0, out - in) + more;
    }
    if (l->stop_after == 0)
        l->stop_thickness_mm = fmax(0, -compute_sag(l->surface[0].radius_mm,
                                                    l->surface[0].semi_mm)) +
                               choose_log_uniform_number(r, 0.003, 0.15);
}

static void choose_coatings(uint64_t *r, struct glint_prescription *l)
{
    const double coated = stage_random_uniform(r, -0.3, 1.3);
    /* Abbe number vd of the medium in front of the surface; 0: air */
    double before = 0;

    for (int k = 0; k < l->n_surfaces; k++) {
        struct glint_surface *s = &l->surface[k];

        if ((before > 0) != (s->vd > 0) &&
            is_true_with_probability(r, coated)) {
            s->coating.nm = stage_random_uniform(r, 350, 800);
            s->coating.n_films = 1;
            s->coating.film[0].index = is_true_with_probability(r, 0.5)
                                           ? 1.38
                                           : stage_random_uniform(r, 1.2, 2.3);
            s->coating.film[0].quarters = 1;
        }
        before = s->vd;
    }
}

/* Multiplies all lengths of the lens by FACTOR. */
static void scale_lens(struct glint_prescription *l, double factor)
{
    for (int k = 0; k < l->n_surfaces; k++) {
        l->surface[k].radius_mm *= factor;
        l->surface[k].thickness_mm *= factor;
        l->surface[k].semi_mm *= factor;
    }
    l->stop_thickness_mm *= factor;
    l->stop_semi_mm *= factor;
}

static double *find_gap_before_sensor(struct glint_prescription *l)
{
    return l->stop_after == l->n_surfaces
               ? &l->stop_thickness_mm
               : &l->surface[l->n_surfaces - 1].thickness_mm;
}

/* Chooses the f-number and sensor size, and focuses the lens. Returns false if
 * the lens forms no image, or if the image lies inside the lens. */
static bool choose_sensor_and_focus(uint64_t *r, struct glint_prescription *l)
{
    struct glint_optics o;
    double behind;

    l->f_number = 1;
    glint_optics_of(l, &o);
    if (!(o.focal_mm > 1e-3 && o.focal_mm < 1e3 && o.stop_radius_mm > 1e-6))
        return false;
    scale_lens(l, choose_log_uniform_number(r, 1, 1e4) / o.focal_mm);
    glint_optics_of(l, &o);
    behind = o.back_focal_mm;
    if (l->stop_after == l->n_surfaces)
        behind -= l->surface[l->n_surfaces - 1].thickness_mm;
    *find_gap_before_sensor(l) = behind * stage_random_uniform(r, 0.98, 1.02);
    l->f_number =
        fmin(1000, fmax(0.5, o.stop_radius_mm / l->stop_semi_mm *
                                 choose_log_uniform_number(r, 1.001, 30)));
    l->film_width_mm = fmin(
        100, fmax(1, o.focal_mm * choose_log_uniform_number(r, 0.05, 1.5)));
    l->film_height_mm = l->film_width_mm / stage_random_uniform(r, 1, 2.4);
    return behind > 0;
}

static int append_formatted_text(char *text, int at, const char *format,
                                 double a, double b, double c)
{
    return at + snprintf(text + at, (size_t)(RANDOM_LENS_TEXT - at), format, a,
                         b, c);
}

static int append_stop_line(const struct glint_prescription *l, char *text,
                            int at)
{
    return append_formatted_text(text, at, "stop %.9g %.9g\n",
                                 l->stop_thickness_mm, l->stop_semi_mm, 0);
}

static int append_surface_lines(const struct glint_surface *s, bool cemented,
                                char *text, int at)
{
    if (s->radius_mm == 0)
        at = append_formatted_text(text, at, "surface flat %.9g %.9g ",
                                   s->thickness_mm, s->semi_mm, 0);
    else
        at = append_formatted_text(text, at, "surface %.9g %.9g %.9g ",
                                   s->radius_mm, s->thickness_mm, s->semi_mm);
    at = s->vd > 0
             ? append_formatted_text(text, at, "%.6g %.6g", s->nd, s->vd, 0)
             : append_formatted_text(text, at, "air", 0, 0, 0);
    if (cemented)
        return append_formatted_text(text, at, "\n", 0, 0, 0);
    return s->coating.n_films
               ? append_formatted_text(text, at, " coating %.6g %.6g\n",
                                       s->coating.nm, s->coating.film[0].index,
                                       0)
               : append_formatted_text(text, at, " coating none\n", 0, 0, 0);
}

static void write_lens_table(const struct glint_prescription *l, int number,
                             char *text)
{
    int at = append_formatted_text(text, 0, "name random-%.0f\nf-number %.9g\n",
                                   number, l->f_number, 0);

    at = append_formatted_text(text, at, "film %.9g %.9g\n", l->film_width_mm,
                               l->film_height_mm, 0);
    for (int k = 0; k < l->n_surfaces; k++) {
        if (l->stop_after == k)
            at = append_stop_line(l, text, at);
        at = append_surface_lines(&l->surface[k],
                                  k > 0 && l->surface[k].vd > 0 &&
                                      l->surface[k - 1].vd > 0,
                                  text, at);
    }
    if (l->stop_after == l->n_surfaces)
        append_stop_line(l, text, at);
}

static bool make_lens_candidate(uint64_t *r, struct glint_prescription *l,
                                int number, char *text)
{
    struct glint_error error;
    /* Most lenses get few surfaces, as the number of ghosts grows with the
     * square of the number of surfaces. */
    const double u = stage_random_uniform(r, 0, 1);
    const int n = (int)floor(2 * pow(32.5, u * u));

    memset(l, 0, sizeof *l);
    l->n_surfaces = n < 64 ? n : 64;
    choose_glasses_and_radii(r, l);
    choose_thicknesses(r, l);
    choose_coatings(r, l);
    if (!choose_sensor_and_focus(r, l))
        return false;
    write_lens_table(l, number, text);
    return glint_prescription_parse(l, text, strlen(text), "random", &error) ==
           GLINT_OK;
}

int make_random_lens(struct glint_prescription *lens, uint64_t seed, int number,
                     char text[RANDOM_LENS_TEXT])
{
    uint64_t r = seed * UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)number;

    for (int tries = 0; tries < MOST_TRIES; tries++)
        if (make_lens_candidate(&r, lens, number, text))
            return tries;
    return -1;
}
