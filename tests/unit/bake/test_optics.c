/* SPDX-License-Identifier: MIT
 *
 * Compares refractive indices, coatings, first-order optics and lists of ghosts
 * with textbook values, and with the values published for the lens tables in
 * lenses/.
 */
#include <complex.h>

#include "support/lens_check.h"

static struct glint_optics optics;

static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------- glass */

/* The manufacturer's catalogue lists for N-BK7: nd 1.5168, Vd 64.17, nF - nC
 * 0.008054, nF 1.52238, nC 1.51432, ng (435.83 nm) 1.52668. Cauchy's formula of
 * two terms is less exact in the violet. */
TEST(bk7_indices_match_the_catalogue)
{
    assert_near(glint_index(1.5168, 64.17, 587.5618), 1.5168, 1e-15);
    assert_near(glint_index(1.5168, 64.17, 486.1327) -
                    glint_index(1.5168, 64.17, 656.2725),
                0.008054, 5e-7);
    assert_near(glint_index(1.5168, 64.17, 486.1327), 1.52238, 3e-4);
    assert_near(glint_index(1.5168, 64.17, 656.2725), 1.51432, 3e-4);
    assert_near(glint_index(1.5168, 64.17, 435.8343), 1.52668, 6e-4);
    assert_true(glint_index(1.0, 0.0, 400.0) == 1.0);
    assert_true(glint_index(1.7, 0.0, 400.0) == 1.7);
}

/* -------------------------------------------------------------- boundaries */

/* Returns the reflectance of a boundary between media of refractive indices N1
 * and N2 with a film of index NF; NF 0: no film. */
static double film_reflectance(double n1, double n2, double cosine, double nf,
                               double phase)
{
    const struct glint_film_at film = {nf, phase};

    return glint_reflectance(n1, n2, cosine, &film, nf > 0);
}

static double compute_bare_reflectance(double n1, double n2, double cosine)
{
    return glint_reflectance(n1, n2, cosine, NULL, 0);
}

TEST(bare_boundaries_reflect_by_fresnel)
{
    assert_near(compute_bare_reflectance(1.0, 1.5, 1.0), 0.04, 1e-16);
    assert_near(compute_bare_reflectance(1.5, 1.0, 1.0), 0.04, 1e-16);
    assert_near(compute_bare_reflectance(1.0, 2.0, 1.0), 1.0 / 9.0, 1e-16);
    assert_near(compute_bare_reflectance(1.5, 1.6, 1.0), 1.0 / 961.0, 1e-16);
    /* At Brewster's angle, whose tangent is 1.5, the p reflectance is 0 and the
     * s reflectance is (1.25 / 3.25)^2. */
    assert_near(compute_bare_reflectance(1.0, 1.5, 1.0 / sqrt(3.25)),
                0.5 * 25.0 / 169.0, 1e-16);
    /* At 45 degrees Rp = Rs^2, and Rs = ((1 - sqrt(3.5)) / (1 +
     * sqrt(3.5)))^2. */
    assert_near(compute_bare_reflectance(1.0, 1.5, sqrt(0.5)),
                0.5 * (0.0920134 + 0.0920134 * 0.0920134), 1e-7);
    assert_near(compute_bare_reflectance(1.0, 1.5, 1e-9), 1.0, 1e-8);
    assert_true(compute_bare_reflectance(1.0, 1.5, 0.0) == 1.0);
}

/* From refractive index 1.5 to 1, the cosine of the critical angle is sqrt(5) /
 * 3; rays of smaller cosines are totally reflected. */
TEST(reflects_totally_beyond_the_critical_angle)
{
    static const double film[] = {0.0, 1.38};

    for (int f = 0; f < 2; f++) {
        assert_true(film_reflectance(1.5, 1.0, 0.3, film[f], pi) == 1.0);
        assert_true(film_reflectance(1.5, 1.0, sqrt(5.0) / 3.0 - 1e-9, film[f],
                                     pi) == 1.0);
        assert_true(film_reflectance(1.5, 1.0, sqrt(5.0) / 3.0 + 1e-9, film[f],
                                     pi) < 1.0);
    }
}

/* At normal incidence a quarter-wave film of refractive index f between media
 * of indices n1 and n2 reflects ((n1 n2 - f^2) / (n1 n2 + f^2))^2, so nothing
 * if f^2 = n1 n2. A half-wave film has no effect. */
TEST(film_reflectance_matches_hand_computation)
{
    const double quarter = pi, half = 2.0 * pi;

    assert_near(film_reflectance(1.0, 2.25, 1.0, 1.5, quarter), 0.0, 1e-30);
    assert_near(film_reflectance(2.25, 1.0, 1.0, 1.5, quarter), 0.0, 1e-30);
    assert_near(film_reflectance(1.0, 1.52, 1.0, 1.38, quarter), 0.0126008,
                5e-8);
    assert_near(film_reflectance(1.0, 1.5, 1.0, 1.38, half), 0.04, 1e-15);
    assert_near(film_reflectance(1.0, 1.5, 1.0, 1.38, 0.0), 0.04, 1e-15);
    /* a film with the refractive index of one of the media has no effect */
    for (int i = 1; i <= 20; i++) {
        const double c = 0.05 * i;

        assert_near(film_reflectance(1.0, 1.5, c, 1.5, 2.0),
                    compute_bare_reflectance(1, 1.5, c), 1e-14);
        assert_near(film_reflectance(1.0, 1.5, c, 1.0, 2.0),
                    compute_bare_reflectance(1, 1.5, c), 1e-14);
    }
}

/* Returns the reflectance of a film by the textbook form of Airy's sum in
 * complex numbers, from the cosines in all three media and the amplitudes at
 * both faces of the film. */
static double compute_airy_reflectance(double n1, double n2, double c1,
                                       double nf, double phase)
{
    const double complex cf = csqrt(1 - n1 * n1 / (nf * nf) * (1 - c1 * c1));
    const double complex c2 = csqrt(1 - n1 * n1 / (n2 * n2) * (1 - c1 * c1));
    const double complex turn = cexp((double complex)I * phase * cf);
    const double complex s1 = (n1 * c1 - nf * cf) / (n1 * c1 + nf * cf);
    const double complex s2 = (nf * cf - n2 * c2) / (nf * cf + n2 * c2);
    const double complex p1 = (nf * c1 - n1 * cf) / (nf * c1 + n1 * cf);
    const double complex p2 = (n2 * cf - nf * c2) / (n2 * cf + nf * c2);
    const double s = cabs((s1 + s2 * turn) / (1 + s1 * s2 * turn));
    const double p = cabs((p1 + p2 * turn) / (1 + p1 * p2 * turn));

    return 0.5 * (s * s + p * p);
}

TEST(film_reflectance_matches_airy)
{
    /* refractive indices in front of the film, of the film, and behind it; in
     * the last three cases, light at grazing angles passes the film only by
     * frustrated total reflection */
    static const double n[][3] = {
        {1, 1.38, 1.5},   {1.8, 1.38, 1},   {1, 2.3, 1.6},   {1.5, 1.7, 1.6},
        {1.7, 1.2, 1.65}, {1.9, 1.01, 1.5}, {1.5, 1.38, 1.9}};
    int frustrated = 0;

    for (int k = 0; k < 7; k++)
        for (int i = 1; i <= 200; i++)
            for (double phase = 0.1; phase < 9.0; phase += 0.7) {
                const double c = 0.005 * i;
                const double sine = n[k][0] * sqrt(1 - c * c);

                frustrated += sine > n[k][1] && sine < n[k][2];
                assert_near(
                    film_reflectance(n[k][0], n[k][2], c, n[k][1], phase),
                    compute_airy_reflectance(n[k][0], n[k][2], c, n[k][1],
                                             phase),
                    1e-11);
            }
    assert_true(frustrated > 1000);
}

/* Checks that a thin air gap transmits light that a thick one reflects
 * totally. */
TEST(thin_gap_transmits_by_frustrated_reflection)
{
    assert_true(film_reflectance(1.7, 1.7, 0.6, 1.01, 1e-3) < 1e-4);
    assert_near(film_reflectance(1.7, 1.7, 0.6, 1.01, 60.0), 1.0, 1e-12);
    assert_near(film_reflectance(1.7, 1.7, 0.6, 1.01, 1e300), 1.0, 1e-12);
    /* The film's refractive index is 1.36, 1.7 times the sine 0.8, so the angle
     * is critical. */
    assert_near(film_reflectance(1.7, 1.7, 0.6, 1.36, 3.0),
                film_reflectance(1.7, 1.7, 0.6, 1.36 - 1e-9, 3.0), 1e-7);
}

/* Checks that the reflectance of a boundary is 0 .. 1 and the same from both
 * sides. */
TEST(reflectance_is_equal_from_both_sides)
{
    static const double film[] = {0.0, 1.38, 1.2, 2.4};

    for (int f = 0; f < 4; f++)
        for (double n2 = 1.3; n2 < 2.2; n2 += 0.17)
            for (int i = 0; i <= 1000; i++) {
                const double c1 = 1e-3 * i, s1 = sqrt(1 - c1 * c1);
                const double s2 = s1 / n2, c2 = sqrt(1 - s2 * s2);
                const double into = film_reflectance(1, n2, c1, film[f], 2.6);
                const double out = film_reflectance(n2, 1, c2, film[f], 2.6);

                assert_true(into >= 0.0 && into <= 1.0);
                assert_true(out >= 0.0 && out <= 1.0);
                /* cosines of grazing angles are less exact, as they are
                 * computed from sines */
                assert_near(into, out, 1e-14 / fmax(c1, 1e-8));
            }
}

/* ------------------------------------------------------------- first order */

/* Returns a biconvex lens with radii of 50 mm, thickness 6 mm and refractive
 * index 1.5. The expected values below were computed by hand from the
 * lensmaker's equation. */
static struct glint_prescription make_biconvex_lens(void)
{
    struct glint_prescription lens;

    memset(&lens, 0, sizeof(lens));
    lens.f_number = 8.0;
    lens.n_surfaces = 2;
    lens.surface[0] = (struct glint_surface){
        .radius_mm = 50, .thickness_mm = 6, .semi_mm = 12, .nd = 1.5};
    lens.surface[1] = (struct glint_surface){
        .radius_mm = -50, .thickness_mm = 10, .semi_mm = 12, .nd = 1};
    lens.stop_after = 2;
    lens.stop_thickness_mm = 38.0;
    lens.stop_semi_mm = 10.0;
    return lens;
}

#define BICONVEX_F    (1.0 / 0.0196)
#define BICONVEX_BACK (0.96 / 0.0196)

TEST(stop_behind_a_biconvex_lens_matches)
{
    const struct glint_prescription lens = make_biconvex_lens();

    glint_optics_of(&lens, &optics);
    assert_near(optics.focal_mm, BICONVEX_F, 1e-12);
    assert_near(optics.back_focal_mm, BICONVEX_BACK, 1e-12);
    assert_near(optics.entrance_radius_mm, BICONVEX_F / 16.0, 1e-12);
    /* the stop, 10 mm behind the lens, limits the cone of rays that meet in the
     * focus */
    assert_near(optics.stop_radius_mm, (BICONVEX_BACK - 10.0) / 16.0, 1e-12);
    assert_near(optics.length_mm, 54.0, 1e-12);
    /* Newton's formula: the stop is BACK - 10 mm before the rear focus, so
     * its image is f^2 / (BACK - 10) mm behind the front focus. The lens is
     * symmetric, so the front focus lies BACK mm in front of the front
     * vertex. */
    assert_near(optics.entrance_z_mm,
                BICONVEX_F * BICONVEX_F / (BICONVEX_BACK - 10.0) -
                    BICONVEX_BACK,
                1e-11);
}

TEST(stop_before_a_biconvex_lens_matches)
{
    struct glint_prescription lens = make_biconvex_lens();

    lens.stop_after = 0;
    lens.stop_thickness_mm = 7.0;
    glint_optics_of(&lens, &optics);
    assert_near(optics.focal_mm, BICONVEX_F, 1e-12);
    assert_near(optics.back_focal_mm, BICONVEX_BACK, 1e-12);
    assert_near(optics.stop_radius_mm, BICONVEX_F / 16.0, 1e-12);
    assert_near(optics.entrance_z_mm, -7.0, 1e-15);
    assert_near(optics.length_mm, 16.0, 1e-15);
}

/* --------------------------------------------------- published lens tables */

/* Values published with the lens tables: focal length, back focal length and
 * stop radius in mm at the d line, f-number, number of surfaces before and
 * after the stop, number of ghosts. */
static const struct {
    const char *name;
    double focal, back_focal, stop_radius, f_number;
    int before, after, ghosts;
} tables[] = {
    /* clang-format off */
    {"heliar-tronnier",         99.236,  81.315, 2.4868, 16,  5,  3,  13},
    {"double-gauss-angenieux",  49.992,  27.903, 1.3200, 11,  7,  7,  42},
    {"itoh-zoom-short",         99.918, 149.458, 2.9038, 32,  8, 10,  73},
    {"itoh-zoom-mid",          118.568, 165.772, 3.0951, 32,  8, 10,  73},
    {"itoh-zoom-long",         145.726, 189.530, 3.3735, 32,  8, 10,  73},
    {"nikon-zoom-short",        57.206,  28.733, 1.1483, 22, 17,  4, 142},
    {"nikon-zoom-mid",          93.032,  33.739, 1.2616, 22, 17,  4, 142},
    {"nikon-zoom-long",        143.076,  28.744, 1.1486, 22, 17,  4, 142},
    {"canon-zoom-short",        72.118,  52.446, 2.2941, 22, 24,  9, 312},
    {"canon-zoom-mid",         134.948,  52.429, 2.2938, 22, 24,  9, 312},
    {"canon-zoom-long",        193.910,  52.421, 2.2936, 22, 24,  9, 312},
    /* clang-format on */
};

#define N_TABLES ((int)(sizeof(tables) / sizeof(tables[0])))

TEST(focal_lengths_match_published_values)
{
    static struct glint_prescription lens;

    for (int i = 0; i < N_TABLES; i++) {
        load_lens(&lens, tables[i].name);
        glint_optics_of(&lens, &optics);
        assert_string_equal(lens.name, tables[i].name);
        assert_true(lens.f_number == tables[i].f_number);
        assert_near(optics.focal_mm, tables[i].focal, 5.1e-4);
        assert_near(optics.back_focal_mm, tables[i].back_focal, 5.1e-4);
        assert_near(optics.stop_radius_mm, tables[i].stop_radius, 5.1e-5);
        assert_near(lens.check_focal_mm, tables[i].focal, 0.0);
        assert_near(lens.check_back_mm, tables[i].back_focal, 0.0);
        /* the lens is focused at infinity */
        assert_near(lens.surface[lens.n_surfaces - 1].thickness_mm,
                    optics.back_focal_mm, 1e-6);
        assert_int_equal(lens.stop_after, tables[i].before);
        assert_int_equal(lens.n_surfaces, tables[i].before + tables[i].after);
        assert_int_equal(glint_ghost_list(&lens, NULL, 0), tables[i].ghosts);
        assert_true(lens.film_width_mm == 36.0 && lens.film_height_mm == 24.0);
    }
}

/* ------------------------------------------------------------------ ghosts */

/* Checks the order of the list of ghosts. A ghost is a pair of surfaces on the
 * same side of the stop; five surfaces are before it, three behind it. */
TEST(ghosts_are_listed_in_order)
{
    static const struct glint_ghost expected[] = {
        {0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4},
        {2, 3}, {2, 4}, {3, 4}, {5, 6}, {5, 7}, {6, 7}};
    static struct glint_prescription lens;
    struct glint_ghost ghosts[14];

    memset(ghosts, -1, sizeof(ghosts));
    load_lens(&lens, "heliar-tronnier");
    assert_int_equal(glint_ghost_list(&lens, ghosts, 14), 13);
    assert_memory_equal(ghosts, expected, sizeof(expected));
    assert_int_equal(ghosts[13].i, -1);
    memset(ghosts, -1, sizeof(ghosts));
    assert_int_equal(glint_ghost_list(&lens, ghosts, 2), 13);
    assert_memory_equal(ghosts, expected, 2 * sizeof(expected[0]));
    assert_int_equal(ghosts[2].i, -1);
}
