/* SPDX-License-Identifier: MIT
 *
 * Tests the reflectance of film stacks against Rouard's recursion in complex
 * numbers: Airy's formula for the film next to the glass gives the amplitude of
 * an equivalent boundary for the film before it, and so on. This method is
 * independent of the characteristic matrices that the library uses.
 */
#include <complex.h>

#include "support/lens_check.h"

static const double pi = 3.14159265358979323846;

/* Fractions of the light that are reflected and transmitted. */
struct shares {
    double r, t;
};

/* Sets R and T to Fresnel's amplitude coefficients for light from a medium of
 * refractive index N1 at the cosine C1. */
static void set_fresnel_amplitudes(double n1, double complex c1, double n2,
                                   double complex c2, int is_p,
                                   double complex *r, double complex *t)
{
    const double complex a = is_p ? n2 * c1 : n1 * c1;
    const double complex b = is_p ? n1 * c2 : n2 * c2;

    *r = (a - b) / (a + b);
    *t = 2 * n1 * c1 / (a + b);
}

/* Returns the fractions of light that N films reflect and transmit. Light comes
 * from the medium of refractive index N1 at the cosine COSINE. FILM[0] is next
 * to the medium of lower index. */
static struct shares compute_stack_by_rouard(double n1, double n2,
                                             double cosine,
                                             const struct glint_film_at *film,
                                             int n, int is_p)
{
    double index[GLINT_MAX_FILMS + 2];
    double complex c[GLINT_MAX_FILMS + 2], r, t;
    /* the films in the order in which light passes them */
    struct glint_film_at met[GLINT_MAX_FILMS];

    index[0] = n1;
    index[n + 1] = n2;
    for (int k = 0; k < n; k++)
        met[k] = film[n1 > n2 ? n - 1 - k : k];
    for (int k = 0; k < n; k++)
        index[k + 1] = met[k].n;
    for (int k = 0; k < n + 2; k++)
        c[k] =
            csqrt(1 - n1 * n1 / (index[k] * index[k]) * (1 - cosine * cosine));
    set_fresnel_amplitudes(index[n], c[n], n2, c[n + 1], is_p, &r, &t);
    for (int k = n; k > 0; k--) {
        /* phase factor of one pass through the film */
        const double complex once =
            cexp((double complex)I * 0.5 * met[k - 1].phase * c[k]);
        double complex r1, t1;

        set_fresnel_amplitudes(index[k - 1], c[k - 1], index[k], c[k], is_p,
                               &r1, &t1);
        t = t1 * t * once / (1 + r1 * r * once * once);
        r = (r1 + r * once * once) / (1 + r1 * r * once * once);
    }
    return (struct shares){pow(cabs(r), 2), pow(cabs(t), 2) *
                                                creal(n2 * c[n + 1]) /
                                                creal(n1 * c[0])};
}

static void expect_stack_equals_rouard(double n1, double n2, double cosine,
                                       const struct glint_film_at *film, int n)
{
    const struct shares s = compute_stack_by_rouard(n1, n2, cosine, film, n, 0);
    const struct shares p = compute_stack_by_rouard(n1, n2, cosine, film, n, 1);
    double of_s, of_p;

    glint_reflectance_sp(n1, n2, cosine, film, n, &of_s, &of_p);
    assert_near(of_s, s.r, 1e-9);
    assert_near(of_p, p.r, 1e-9);
    assert_near(glint_reflectance(n1, n2, cosine, film, n), (s.r + p.r) / 2,
                1e-9);
    /* films do not absorb: light that is not reflected is transmitted */
    assert_near(of_s + s.t, 1, 1e-9);
    assert_near(of_p + p.t, 1, 1e-9);
}

/* ---------------------------------------------------------- named coatings */

/* Checks all named coatings on four glasses, from 380 to 780 nm and from 0 to
 * 89 degrees, from the air and from the glass. */
TEST(named_coatings_match_rouard)
{
    static const double glass[] = {1.46, 1.52, 1.7, 1.95};
    struct glint_coating coating;
    struct glint_film_at film[GLINT_MAX_FILMS];
    int k;

    for (k = 0; glint_coating_named(k, &coating); k++)
        for (int g = 0; g < 4; g++)
            for (double nm = 380; nm <= 780; nm += 25)
                for (int degrees = 0; degrees < 90; degrees++) {
                    const double c = cos(degrees * pi / 180);
                    const double sine = sqrt(1 - c * c) / glass[g];
                    const int n = glint_coating_at(&coating, nm, film);

                    expect_stack_equals_rouard(1, glass[g], c, film, n);
                    expect_stack_equals_rouard(glass[g], 1,
                                               sqrt(1 - sine * sine), film, n);
                }
    assert_int_equal(k, 3);
    assert_null(glint_coating_named(-1, &coating));
}

/* At the design wavelength and normal incidence, two quarter-wave films of
 * refractive indices a and b on glass of index g reflect ((a^2 g - b^2) / (a^2
 * g + b^2))^2; a half-wave film between them has no effect. */
TEST(two_film_stack_matches_hand_computation)
{
    const double g = 1.52, a = 1.38 * 1.38 * g;
    struct glint_coating v, three;
    struct glint_film_at film[GLINT_MAX_FILMS];
    double b = 1.69 * 1.69;

    assert_string_equal(glint_coating_named(0, &v), "v-coat");
    assert_string_equal(glint_coating_named(1, &three), "broadband-3");
    assert_near(
        glint_reflectance(1, g, 1, film, glint_coating_at(&v, v.nm, film)),
        pow((a - b) / (a + b), 2), 1e-15);
    b = 1.63 * 1.63;
    assert_near(glint_reflectance(1, g, 1, film,
                                  glint_coating_at(&three, three.nm, film)),
                pow((a - b) / (a + b), 2), 1e-15);
}

/* Checks the mean reflectances over the band: that of a V-coat is smaller than
 * that of a single film, and those of broadband coatings are below 0.003. */
TEST(coatings_reflect_less_in_their_band)
{
    const struct glint_coating single = {550, 1, {{1.38, 1}}};
    struct glint_coating c[3];
    double mean[3] = {0}, of_single = 0;

    for (int k = 0; k < 3; k++)
        assert_non_null(glint_coating_named(k, &c[k]));
    for (double nm = 420; nm <= 680; nm += 10) {
        struct glint_film_at film[GLINT_MAX_FILMS];

        of_single += glint_reflectance(1, 1.52, 1, film,
                                       glint_coating_at(&single, nm, film)) /
                     27;
        for (int k = 0; k < 3; k++)
            mean[k] += glint_reflectance(1, 1.52, 1, film,
                                         glint_coating_at(&c[k], nm, film)) /
                       27;
    }
    assert_true(of_single > 0.013);
    assert_true(mean[0] < of_single && mean[0] > 0.005);
    assert_true(mean[1] < 0.003 && mean[2] < 0.003);
}

/* ---------------------------------------------- random and extreme stacks */

static double random_uniform(uint32_t *seed, double lo, double hi)
{
    *seed = *seed * 1664525u + 1013904223u;
    return lo + (hi - lo) * (*seed >> 8) / 16777216.0;
}

/* Checks random stacks of 1 to 8 films, including films that light crosses only
 * by frustrated total reflection. */
TEST(random_stacks_match_rouard)
{
    uint32_t seed = 1;
    int frustrated = 0;

    for (int i = 0; i < 40000; i++) {
        struct glint_film_at film[GLINT_MAX_FILMS];
        const int n = 1 + i % GLINT_MAX_FILMS;
        const double n1 = random_uniform(&seed, 1, 2),
                     n2 = random_uniform(&seed, 1, 2);
        const double most = n1 > n2 ? sqrt(1 - n2 * n2 / (n1 * n1)) : 0;
        const double c = random_uniform(&seed, most + 0.02 * (1 - most), 1);
        const double sine = n1 * sqrt(1 - c * c);

        for (int k = 0; k < n; k++) {
            film[k].n = random_uniform(&seed, 1.01, 2.5);
            film[k].phase = random_uniform(&seed, 0.03, 3 * pi);
            frustrated += film[k].n < sine;
        }
        expect_stack_equals_rouard(n1, n2, c, film, n);
        /* the same stack lit from the other side */
        assert_near(glint_reflectance(n1, n2, c, film, n),
                    glint_reflectance(n2, n1, sqrt(1 - sine * sine / (n2 * n2)),
                                      film, n),
                    1e-9);
    }
    assert_true(frustrated > 1000);
}

/* Checks films that transmit no light, grazing incidence, and total
 * reflection. */
TEST(extreme_stacks_match_rouard)
{
    const struct glint_film_at thick[8] = {
        {1.01, 1e300}, {1.01, 150}, {1.01, 150}, {1.01, 150},
        {1.01, 150},   {1.01, 150}, {1.01, 150}, {1.01, 150}};
    const struct glint_film_at critical[2] = {{1.36, 3}, {1.5, 2}};
    const struct glint_film_at beside[2] = {{1.36 - 1e-9, 3}, {1.5, 2}};
    double s, p;

    assert_near(glint_reflectance(1.7, 1.7, 0.6, thick, 8), 1, 1e-12);
    assert_near(glint_reflectance(1.7, 1.7, 0.6, critical, 2),
                glint_reflectance(1.7, 1.7, 0.6, beside, 2), 1e-6);
    assert_true(glint_reflectance(1.7, 1, 0.6, critical, 2) == 1);
    assert_true(glint_reflectance(1, 1.7, 0, critical, 2) == 1);
    glint_reflectance_sp(1.7, 1, 0.6, critical, 2, &s, &p);
    assert_true(s == 1 && p == 1);
}

/* ------------------------------------------------------------ ray energies */

/* Checks that a ray through a coated pane has the product of the two
 * transmittances as its energy, and a ghost the product of the two
 * reflectances, for film stacks as for single films. */
TEST(ghost_energy_is_the_product_of_reflectances)
{
    struct glint_prescription lens = {
        .n_surfaces = 2,
        .surface = {{.thickness_mm = 2, .semi_mm = 9, .nd = 1.6, .vd = 40},
                    {.thickness_mm = 9, .semi_mm = 9, .nd = 1}},
        .stop_after = 2,
        .stop_thickness_mm = 1,
        .stop_semi_mm = 9};
    const struct glint_ghost between = {0, 1};
    const double straight[3] = {0, 0, 1}, slanted[3] = {0.6, 0, 0.8};
    const double g = glint_index(1.6, 40, 500);
    static struct glint_path path;
    struct glint_film_at film[2][GLINT_MAX_FILMS];

    assert_non_null(glint_coating_named(2, &lens.surface[0].coating));
    assert_non_null(glint_coating_named(0, &lens.surface[1].coating));
    for (int slant = 0; slant < 2; slant++) {
        const double *way = slant ? slanted : straight, c = way[2];
        const double inside = sqrt(1 - (1 - c * c) / (g * g));
        double r[2];
        struct glint_ray ray;

        for (int k = 0; k < 2; k++) {
            const int n =
                glint_coating_at(&lens.surface[k].coating, 500, film[k]);

            r[k] = k ? glint_reflectance(g, 1, inside, film[k], n)
                     : glint_reflectance(1, g, c, film[k], n);
        }
        glint_path_init(&path, &lens, NULL, 500);
        assert_int_equal(glint_trace(&path, 0, 0, way, &ray, NULL),
                         GLINT_RAY_OK);
        assert_near(ray.energy, (1 - r[0]) * (1 - r[1]), 1e-12);
        glint_path_init(&path, &lens, &between, 500);
        assert_int_equal(glint_trace(&path, 0, 0, way, &ray, NULL),
                         GLINT_RAY_OK);
        assert_near(ray.energy, (1 - r[0]) * r[1] * r[0] * (1 - r[1]), 1e-12);
    }
}
