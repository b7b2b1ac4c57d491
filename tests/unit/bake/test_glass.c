/* SPDX-License-Identifier: MIT
 *
 * Checks that glasses of the catalogue have their published indices and are
 * found by their names in lens tables.
 */
#include "support/lens_check.h"

/* Refractive indices at the d, C and F lines as printed by the manufacturers, 5
 * decimals; not computed from glint's coefficients. */
static const struct {
    const char *name;
    double nd, nc, nf;
} printed[] = {
    {"N-BK7", 1.5168, 1.51432, 1.52238},
    {"N-BAK1", 1.5725, 1.56949, 1.57943},
    {"N-BAK2", 1.53996, 1.53721, 1.54625},
    {"N-BAK4", 1.56883, 1.56575, 1.57591},
    {"N-BALF4", 1.57956, 1.57631, 1.58707},
    {"N-BALF5", 1.54739, 1.5443, 1.55451},
    {"N-BASF2", 1.66446, 1.65905, 1.67751},
    {"N-BASF64", 1.704, 1.69872, 1.71659},
    {"N-BK10", 1.49782, 1.49552, 1.50296},
    {"N-F2", 1.62005, 1.61506, 1.63208},
    {"N-FK5", 1.48749, 1.48535, 1.49227},
    {"N-FK51A", 1.48656, 1.4848, 1.49056},
    {"N-FK58", 1.456, 1.45446, 1.45948},
    {"N-K5", 1.52249, 1.51982, 1.5286},
    {"N-KF9", 1.52346, 1.5204, 1.53056},
    {"N-KZFS11", 1.63775, 1.63324, 1.64828},
    {"N-KZFS2", 1.55836, 1.55519, 1.56553},
    {"S-LAH60", 1.834, 1.82738, 1.84982},
    {"S-LAH63", 1.8044, 1.79838, 1.8187},
    {"S-LAH64", 1.788, 1.783, 1.79963},
    {"S-LAH66", 1.7725, 1.7678, 1.78337},
    {"S-LAH79", 2.0033, 1.99301, 2.0285},
    {"S-LAH88", 1.9165, 1.90803, 1.93703},
    {"S-LAH89", 1.8515, 1.8453, 1.86618},
    {"S-LAH92", 1.8919, 1.88482, 1.90884},
    {"TAFD30", 1.883, 1.87657, 1.89821},
    {"TAFD33", 1.881, 1.8745, 1.89644},
    {"TAFD37", 1.90043, 1.89333, 1.91742},
};

/* nd and Vd as printed in CDGM's catalogue of 2022-06, six decimals. */
static const struct {
    const char *name;
    double nd, vd;
} printed_vd[] = {
    {"D-LAK52", 1.7305, 53.944268},   {"D-ZK3", 1.58913, 61.152901},
    {"H-BAK5", 1.56069, 58.344731},   {"H-BAK7", 1.56883, 56.041308},
    {"H-F4", 1.62005, 36.345886},     {"H-FK61", 1.497, 81.612838},
    {"H-FK95N", 1.4378, 94.523389},   {"H-K9L", 1.5168, 64.198732},
    {"H-KF6", 1.51742, 52.149249},    {"H-LAF10LA", 1.788, 47.491731},
    {"H-LAF3B", 1.744, 44.900027},    {"H-LAF50B", 1.7725, 49.598996},
    {"H-LAK4L", 1.64, 60.202769},     {"H-LAK51A", 1.6968, 55.526357},
    {"H-LAK52", 1.72916, 54.684737},  {"H-LAK53A", 1.755, 52.320574},
    {"H-LAK7A", 1.713, 53.832974},    {"H-QF50A", 1.58144, 40.746424},
    {"H-QK3L", 1.48749, 70.440487},   {"H-ZBAF16", 1.66672, 48.421731},
    {"H-ZF1", 1.64769, 33.840317},    {"H-ZF10", 1.68893, 31.16057},
    {"H-ZF12", 1.76182, 26.607986},   {"H-ZF13", 1.78472, 25.720045},
    {"H-ZF2", 1.6727, 32.171186},     {"H-ZF3", 1.71736, 29.49911},
    {"H-ZF4A", 1.72825, 28.318797},   {"H-ZF5", 1.74, 28.295649},
    {"H-ZF52", 1.84666, 23.784497},   {"H-ZF6", 1.7552, 27.530047},
    {"H-ZF62", 1.92286, 20.879915},   {"H-ZF72A", 1.92286, 18.895887},
    {"H-ZF7LA", 1.80518, 25.456256},  {"H-ZF88", 1.94595, 17.941964},
    {"H-ZK11", 1.63854, 55.446553},   {"H-ZK14", 1.60311, 60.603787},
    {"H-ZK3", 1.58913, 61.253571},    {"H-ZK9B", 1.62041, 60.339343},
    {"H-ZLAF4LA", 1.91082, 35.25034}, {"H-ZLAF50E", 1.804, 46.574487},
    {"H-ZLAF52A", 1.8061, 41.016887}, {"H-ZLAF55D", 1.83481, 42.725177},
    {"H-ZLAF68N", 1.883, 39.2182},    {"H-ZLAF78B", 1.90069, 37.050531},
    {"H-ZLAF90", 2.00069, 25.425752}, {"H-ZPK1A", 1.618, 63.392702},
    {"H-ZPK5", 1.5928, 68.342024},
};

static struct glint_prescription lens;
static struct glint_error error;

static enum glint_status parse_lens_of_medium(const char *medium)
{
    char text[400];

    snprintf(text, sizeof text,
             "name t\nf-number 8\nfilm 36 24\nstop 5 9\n"
             "surface 60 5 10 %s\nsurface -60 90 10 air\n",
             medium);
    return glint_prescription_parse(&lens, text, strlen(text), "t.lens",
                                    &error);
}

/* Checks that GOT differs from WANT, a printed refractive index, by at most
 * 1e-5 plus half of the last printed decimal. */
static void check_index_is_near(double got, double want)
{
    assert_true(fabs(got - want) < 1.5e-5);
}

TEST(indices_match_the_printed_ones)
{
    for (size_t i = 0; i < sizeof printed / sizeof *printed; i++) {
        if (parse_lens_of_medium(printed[i].name) != GLINT_OK)
            fail_msg("%s", error.text);
        check_index_is_near(lens.surface[0].nd, printed[i].nd);
        check_index_is_near(glint_surface_index(&lens.surface[0], 587.5618),
                            printed[i].nd);
        check_index_is_near(glint_surface_index(&lens.surface[0], 656.2725),
                            printed[i].nc);
        check_index_is_near(glint_surface_index(&lens.surface[0], 486.1327),
                            printed[i].nf);
        assert_true(fabs(lens.surface[0].vd * (printed[i].nf - printed[i].nc) /
                             (printed[i].nd - 1) -
                         1) < 2e-3);
        assert_true(glint_surface_index(&lens.surface[1], 500) == 1);
    }
}

TEST(dispersions_match_the_printed_ones)
{
    for (size_t i = 0; i < sizeof printed_vd / sizeof *printed_vd; i++) {
        const double nd = printed_vd[i].nd;
        double apart;

        if (parse_lens_of_medium(printed_vd[i].name) != GLINT_OK)
            fail_msg("%s", error.text);
        check_index_is_near(glint_surface_index(&lens.surface[0], 587.5618),
                            nd);
        apart = glint_surface_index(&lens.surface[0], 486.1327) -
                glint_surface_index(&lens.surface[0], 656.2725);
        assert_true(fabs(apart - (nd - 1) / printed_vd[i].vd) < 1e-6);
        assert_true(fabs(lens.surface[0].vd / printed_vd[i].vd - 1) < 1e-4);
    }
}

/* Checks that every row of the catalogue has values that are plausible for a
 * glass; misprinted coefficients would give others. */
TEST(all_rows_are_glasses)
{
    const struct glint_glass *glass;
    int n = 0;

    for (; (glass = glint_glass_at(n)) != NULL; n++) {
        double last = 9;

        assert_ptr_equal(glint_glass_find(glass->name, strlen(glass->name)),
                         glass);
        assert_ptr_equal(glint_glass_near(glass->name, strlen(glass->name)),
                         glass);
        assert_ok(parse_lens_of_medium(glass->name));
        assert_true(lens.surface[0].nd > 1.4 && lens.surface[0].nd < 2.1);
        assert_true(lens.surface[0].vd > 17 && lens.surface[0].vd < 96);
        for (int nm = 365; nm <= 1010; nm += 15) {
            const double at = glint_surface_index(&lens.surface[0], nm);

            assert_true(at < last && at > 1.4);
            last = at;
        }
    }
    assert_true(n > 200);
    assert_null(glint_glass_at(-1));
}

/* Checks that the dispersion of a flint glass in the violet differs from
 * Cauchy's formula, whose two terms nd and Vd determine. */
TEST(violet_dispersion_is_not_that_of_two_terms)
{
    double by_numbers;

    assert_ok(parse_lens_of_medium("N-SF11"));
    by_numbers = glint_index(lens.surface[0].nd, lens.surface[0].vd, 404.66);
    assert_true(glint_surface_index(&lens.surface[0], 404.66) - by_numbers >
                4e-3);
}

TEST(misspelt_names_get_a_suggestion)
{
    static const struct {
        const char *wrong, *meant;
    } cases[] = {{"N-BK8", "did you mean N-B"},
                 {"NBK7", "did you mean N-BK7?"},
                 {"S-LAH6", "did you mean S-LA"},
                 {"SLAH66", "did you mean S-LAH66?"},
                 {"N-SF111", "did you mean N-SF11?"},
                 {"ZZZZZZ", "nor in the catalogue"}};
    static const char own[] =
        "name t\nf-number 8\nfilm 36 24\nstop 5 9\n"
        "glass N-BK7 1.6 50\nsurface 60 5 10 N-BK7\nsurface -60 90 10 air\n";

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        error.text[0] = '\0';
        assert_int_equal(parse_lens_of_medium(cases[i].wrong), GLINT_E_LENS);
        assert_non_null(strstr(error.text, "t.lens:5:17: no glass"));
        assert_non_null(strstr(error.text, cases[i].meant));
    }
    assert_null(strstr(error.text, "did you mean"));
    /* a glass defined in the table takes precedence over the catalogue */
    parse_lens_text(&lens, own);
    assert_true(lens.surface[0].nd == 1.6);
    assert_true(lens.surface[0].sellmeier[0] == 0);
}

TEST(glasses_of_equal_nd_and_vd_have_distinct_keys)
{
    struct glint_bake_options options;
    uint64_t key;

    glint_bake_defaults(&options);
    assert_ok(parse_lens_of_medium("N-SK16"));
    key = glint_bake_key(&lens, &options);
    memset(lens.surface[0].sellmeier, 0, sizeof lens.surface[0].sellmeier);
    assert_true(glint_bake_key(&lens, &options) != key);
}
