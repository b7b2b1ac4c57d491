/* SPDX-License-Identifier: MIT */
#include "bake/trace/coating.h"

#include "glint/view.h"

int glint_coating_at(const struct glint_coating *coating, double wavelength_nm,
                     struct glint_film_at film[GLINT_MAX_FILMS])
{
    for (int k = 0; k < coating->n_films; k++)
        /* the phase is 4 pi n d / wavelength, where the optical thickness n d
         * is quarters * nm / 4 */
        film[k] = (struct glint_film_at){coating->film[k].index,
                                         GLINT_PI * coating->film[k].quarters *
                                             coating->nm / wavelength_nm};
    return coating->n_films;
}

/* Characteristic matrix (m11, i m12; i m21, m22) of films for one
 * polarisation. */
struct matrix {
    double m11, m12, m21, m22;
};

/* Multiplies M from the right by the characteristic matrix of one film, (C, i S
 * / F; i SIGN S F, C). C, S: cosine and sine of half the film's phase; F: its
 * admittance; SIGN: -1 beyond the critical angle, where cosine and sine are
 * hyperbolic, else 1. */
static void multiply_by_film(struct matrix *m, double c, double s, double f,
                             double sign)
{
    const struct matrix old = *m;
    const double upper = s / f, lower = sign * s * f;

    m->m11 = old.m11 * c - old.m12 * lower;
    m->m12 = old.m11 * upper + old.m12 * c;
    m->m21 = old.m21 * c + old.m22 * lower;
    m->m22 = old.m22 * c - old.m21 * upper;
}

/* Returns the reflectance of films with matrix M between media of admittances A
 * and B. */
static double compute_film_stack_reflectance(const struct matrix *m, double a,
                                             double b)
{
    const double minus = a * m->m11 - b * m->m22,
                 plus = a * m->m11 + b * m->m22;
    const double across = a * b * m->m12, back = m->m21;
    const double part = (minus * minus + (across - back) * (across - back)) /
                        (plus * plus + (across + back) * (across + back));

    return part < 1.0 ? part : 1.0;
}

void glint_stack_compute_reflectance_sp(double n1, double c1, double n2,
                                        double c2,
                                        const struct glint_film_at *film, int n,
                                        double *s, double *p)
{
    struct matrix s_all = {1, 0, 0, 1}, p_all = s_all;
    /* true: light hits the films in reverse order, the last one first */
    const bool turned = n1 > n2;

    for (int k = 0; k < n; k++) {
        const struct glint_film_at *const f = &film[turned ? n - 1 - k : k];
        const double nf = f->n, inside = compute_film_cosine2(n1, c1, nf);
        const double size = sqrt(fabs(inside)), half = 0.5 * f->phase * size;
        const double sign = inside < 0.0 ? -1.0 : 1.0;
        /* limits the phase to 30: products of sinh(30) over 8 layers do not
         * overflow, and hardly any light passes */
        const double sine = inside < 0.0 ? sinh(fmin(half, 30.0)) : sin(half);
        const double cosine = inside < 0.0 ? cosh(fmin(half, 30.0)) : cos(half);

        /* The admittance of a film is nf cos(t) for s and nf / cos(t) for p
         * polarisation, where t is the angle inside the film. Beyond the
         * critical angle, cos(t) is the imaginary number i size. The
         * admittances become i nf size and -i nf / size, and sin D becomes i
         * sinh |D|, where D is half the phase. */
        multiply_by_film(&s_all, cosine, sine, nf * size, sign);
        multiply_by_film(&p_all, cosine, sign * sine, nf / size, sign);
    }
    *s = compute_film_stack_reflectance(&s_all, n1 * c1, n2 * c2);
    *p = compute_film_stack_reflectance(&p_all, n1 / c1, n2 / c2);
}

/* Returns the cosine of the refracted ray for incidence at COS_FROM; 0 if no
 * light is transmitted. */
static double compute_refracted_cosine(double n_from, double n_to,
                                       double cos_from)
{
    const double ratio = n_from / n_to;
    const double cos2 = 1.0 - ratio * ratio * (1.0 - cos_from * cos_from);

    return cos_from > 0.0 && cos2 > 0.0 ? sqrt(cos2) : 0.0;
}

double glint_reflectance(double n_from, double n_to, double cos_from,
                         const struct glint_film_at *film, int n_films)
{
    const double c2 = compute_refracted_cosine(n_from, n_to, cos_from);

    if (!(c2 > 0.0))
        return 1.0; /* grazing incidence, or total reflection */
    if (n_films > 1)
        return compute_stack_reflectance(n_from, cos_from, n_to, c2, film,
                                         n_films);
    if (n_films == 1) {
        const double inside = compute_film_cosine2(n_from, cos_from, film->n);

        return compute_film_reflectance(
            n_from, cos_from, n_to, c2, film->n, inside,
            compute_film_sine2(inside, film->phase));
    }
    return compute_bare_reflectance(n_from, cos_from, n_to, c2);
}

void glint_reflectance_sp(double n_from, double n_to, double cos_from,
                          const struct glint_film_at *film, int n_films,
                          double *s, double *p)
{
    const double c2 = compute_refracted_cosine(n_from, n_to, cos_from);

    *s = *p = 1.0;
    if (c2 > 0.0)
        glint_stack_compute_reflectance_sp(n_from, cos_from, n_to, c2, film,
                                           n_films, s, p);
}
