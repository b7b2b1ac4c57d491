/* SPDX-License-Identifier: MIT
 *
 * Checks that each surface gets the coating that the lens table or --coating
 * names, that reflectances match formulas, that model keys depend on coatings,
 * and that invalid texts are rejected.
 */
#include "glint/bake.h"
#include "support/test.h"

/* A cemented doublet and a single lens: surface 1 is the cemented one; surfaces
 * 0, 2, 3 and 4 are in air. */
static const char table[] = "name films\n"
                            "f-number 10\n"
                            "film 36 24\n"
                            "surface 61.47 6 12 1.5168 64.17\n"
                            "surface -44.64 2.5 12 1.6727 32.2\n"
                            "surface -129.94 5 12 air\n"
                            "stop 5 8\n"
                            "surface 80 3 12 1.5168 64.17\n"
                            "surface -400 60 12 air\n";

static struct glint_error error;

static enum glint_status parse_table_with_line(struct glint_prescription *lens,
                                               const char *line)
{
    char text[1024] = "";

    strcat(text, table);
    strcat(text, line);
    return glint_prescription_parse(lens, text, strlen(text), "x.lens", &error);
}

static void parse_valid_table_with_line(struct glint_prescription *lens,
                                        const char *line)
{
    if (parse_table_with_line(lens, line) != GLINT_OK)
        fail_msg("%s", error.text);
}

static void apply_coatings(struct glint_prescription *lens, const char *films)
{
    struct glint_coating coating[GLINT_MAX_COATINGS];
    int n = 0;

    if (glint_coatings_parse(coating, &n, films, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    glint_prescription_coat(lens, coating, n);
}

static void check_coatings_of_surfaces(const struct glint_prescription *lens,
                                       const double nm[5],
                                       const double index[5])
{
    for (int k = 0; k < 5; k++) {
        assert_true(lens->surface[k].coating.nm == nm[k]);
        assert_true(lens->surface[k].coating.film[0].index == index[k]);
    }
}

/* ------------------------------------------------- coatings in lens tables */

TEST(parses_a_mixed_coating_line)
{
    static struct glint_prescription lens;
    const double all[5] = {550, 0, 550, 550, 550};
    const double mgf2[5] = {1.38, 0, 1.38, 1.38, 1.38};

    parse_valid_table_with_line(&lens, "");
    assert_int_equal(lens.n_mixed, 0);
    parse_valid_table_with_line(&lens, "mixed-coating 450 none 620/1.46\n");
    assert_int_equal(lens.n_mixed, 3);
    assert_true(lens.mixed[0].nm == 450 && lens.mixed[0].film[0].index == 1.38);
    assert_true(lens.mixed[1].nm == 0 && lens.mixed[1].n_films == 0);
    assert_true(lens.mixed[2].nm == 620 && lens.mixed[2].film[0].index == 1.46);
    check_coatings_of_surfaces(&lens, all,
                               mgf2); /* the mixed coating is not applied yet */
}

TEST(rejects_wrong_lines)
{
    static const char *const bad[][2] = {
        {"mixed-coating\n", "x.lens:10:14: coating wavelength is missing"},
        {"mixed-coating 450 99\n",
         "x.lens:10:19: coating wavelength must be 100 .. 5000, not 99"},
        {"mixed-coating 450/5\n",
         "x.lens:10:19: coating index must be 1.01 .. 4, not 5"},
        {"mixed-coating 450/\n", "x.lens:10:19: coating index is missing"},
        {"mixed-coating blue\n",
         "x.lens:10:15: 'blue' is not a coating; expected none, v-coat, "
         "broadband-3, broadband-4 or a wavelength in nm"},
        {"mixed-coating 450\nmixed-coating 500\n",
         "x.lens:11:1: a second mixed-coating; the first is on line 10"}};

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        static struct glint_prescription lens;

        assert_int_equal(parse_table_with_line(&lens, bad[i][0]), GLINT_E_LENS);
        assert_string_equal(error.text, bad[i][1]);
    }
}

/* -------------------------------------------------------- option --coating */

TEST(coatings_are_assigned_in_turn)
{
    static struct glint_prescription lens;
    const double zero[5] = {0};

    parse_valid_table_with_line(&lens, "coating 600 1.5\n");
    apply_coatings(&lens, "450,500/1.6,none");
    check_coatings_of_surfaces(&lens, (const double[]){450, 0, 500, 0, 450},
                               (const double[]){1.38, 0, 1.6, 0, 1.38});
    apply_coatings(&lens, "none");
    check_coatings_of_surfaces(&lens, zero, zero);
    apply_coatings(&lens, "480");
    check_coatings_of_surfaces(&lens, (const double[]){480, 0, 480, 480, 480},
                               (const double[]){1.38, 0, 1.38, 1.38, 1.38});
}

TEST(rejects_invalid_coatings)
{
    static const char *const bad[][2] = {
        {"", "the text of the coating is empty"},
        {"blue", "'blue' is not a coating; expected none, v-coat, "
                 "broadband-3, broadband-4 or a wavelength in nm"},
        {"v-coat/500/2", "'2' is one value too many for the coating"},
        {"none/2", "'2' is one value too many for the coating"},
        {"none/", "a value is missing after the slash"},
        {"v-coat/", "coating wavelength is missing"},
        {"500//2", "coating index is missing"},
        {"500/1.4:0", "coating thickness must be 0.01 .. 16, not 0"},
        {"500/1.4:", "coating thickness is missing"},
        {"500/2/2/2/2/2/2/2/2/2", "more than 8 films"},
        {"450,99", "coating wavelength must be 100 .. 5000, not 99"},
        {"5001", "coating wavelength must be 100 .. 5000, not 5001"},
        {"450/1", "coating index must be 1.01 .. 4, not 1"},
        {"nan", "'nan' is not a coating; expected none, v-coat, broadband-3, "
                "broadband-4 or a wavelength in nm"}};

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct glint_coating coating[GLINT_MAX_COATINGS] = {{.nm = 1}};
        int n = 7;

        assert_int_equal(glint_coatings_parse(coating, &n, bad[i][0], &error),
                         GLINT_E_ARGUMENT);
        assert_string_equal(error.text, bad[i][1]);
        assert_true(n == 7 && coating[0].nm == 1);
    }
}

TEST(rejects_too_many_coatings)
{
    struct glint_coating coating[GLINT_MAX_COATINGS];
    char text[600] = "";
    int n;

    for (int i = 0; i < 65; i++)
        strcat(text, i ? ",500" : "500");
    assert_int_equal(glint_coatings_parse(coating, &n, text, &error),
                     GLINT_E_ARGUMENT);
    assert_string_equal(error.text,
                        "the text of a coating has at most 200 characters");
}

/* Parses TEXT as one coating and checks its films: pairs of refractive index
 * and number of quarter waves. */
static void check_films_of_coating(const char *text, double nm, int n,
                                   const double film[][2])
{
    struct glint_coating coating[GLINT_MAX_COATINGS];
    int n_coatings = 0;

    if (glint_coatings_parse(coating, &n_coatings, text, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(n_coatings, 1);
    assert_true(coating->nm == nm);
    assert_int_equal(coating->n_films, n);
    for (int k = 0; k < n; k++) {
        assert_true(coating->film[k].index == film[k][0]);
        assert_true(coating->film[k].quarters == film[k][1]);
    }
}

TEST(coatings_have_their_films)
{
    static const double v[][2] = {{1.38, 1}, {1.69, 1}};
    static const double b3[][2] = {{1.38, 1}, {2.1, 2}, {1.63, 1}};
    static const double b4[][2] = {
        {1.38, 1.01}, {2.1, 2.2}, {1.38, 0.31}, {2.1, 0.26}};
    static const double own[][2] = {{1.46, 1}, {2.3, 0.25}, {1.46, 1.5}};
    static struct glint_prescription lens, other;

    check_films_of_coating("v-coat", 550, 2, v);
    check_films_of_coating("v-coat/600", 600, 2, v);
    check_films_of_coating("broadband-3", 520, 3, b3);
    check_films_of_coating("broadband-4/510", 510, 4, b4);
    check_films_of_coating("510/1.46/2.3:.25/1.46:1.5", 510, 3, own);
    /* In a lens table spaces separate the words of a coating. */
    parse_valid_table_with_line(&lens, "coating 510 1.46 2.3:.25 1.46:1.5\n");
    parse_valid_table_with_line(&other, "");
    apply_coatings(&other, "510/1.46/2.3:.25/1.46:1.5");
    assert_memory_equal(&lens.surface[0].coating, &other.surface[0].coating,
                        sizeof lens.surface[0].coating);
    parse_valid_table_with_line(&lens, "coating broadband-3 # as is\n");
    apply_coatings(&other, "broadband-3");
    assert_memory_equal(&lens.surface[4].coating, &other.surface[4].coating,
                        sizeof lens.surface[4].coating);
    assert_int_equal(lens.surface[1].coating.n_films, 0); /* cemented */
}

/* ---------------------------------------------------- reflectance and keys */

static double reflectance(const struct glint_prescription *lens, int k,
                          double nm)
{
    const struct glint_surface *s = &lens->surface[k];
    const double before = k ? glint_index(s[-1].nd, s[-1].vd, nm) : 1;
    struct glint_film_at film[GLINT_MAX_FILMS];

    return glint_reflectance(before, glint_index(s->nd, s->vd, nm), 1, film,
                             glint_coating_at(&s->coating, nm, film));
}

/* Checks that a quarter-wave film (surfaces 0, 2 and 4) reflects least at its
 * design wavelength. A half-wave film for 550 nm (surface 3) must have no
 * effect at 550 nm, and reduce the reflectance at other wavelengths. */
TEST(quarter_wave_film_reflects_least_at_its_wavelength)
{
    static struct glint_prescription lens, bare;

    parse_valid_table_with_line(&lens, "");
    bare = lens;
    apply_coatings(&bare, "none");
    /* design wavelengths for surfaces 0, 2, 3 and 4, nm */
    apply_coatings(&lens, "450,650,1100,550");
    assert_true(reflectance(&lens, 0, 650) > 1.2 * reflectance(&lens, 0, 450));
    assert_true(reflectance(&lens, 2, 450) > 1.2 * reflectance(&lens, 2, 650));
    assert_true(reflectance(&lens, 4, 550) < reflectance(&lens, 4, 450));
    assert_true(reflectance(&lens, 4, 550) < reflectance(&lens, 4, 650));
    assert_true(reflectance(&lens, 1, 500) == reflectance(&bare, 1, 500));
    assert_true(fabs(reflectance(&lens, 3, 550) - reflectance(&bare, 3, 550)) <
                1e-9);
    assert_true(reflectance(&lens, 3, 420) < 0.7 * reflectance(&bare, 3, 420));
    assert_true(reflectance(&lens, 3, 680) < 0.9 * reflectance(&bare, 3, 680));
}

TEST(coatings_change_the_key)
{
    static struct glint_prescription lens, other;
    struct glint_bake_options options;
    uint64_t key;

    glint_bake_defaults(&options);
    parse_valid_table_with_line(&lens, "");
    key = glint_bake_key(&lens, &options);
    parse_valid_table_with_line(&other, "mixed-coating 450 620\n");
    /* A mixed coating changes the model key only when it is applied. */
    assert_true(glint_bake_key(&other, &options) == key);
    glint_prescription_coat(&other, other.mixed, other.n_mixed);
    assert_true(glint_bake_key(&other, &options) != key);
    other = lens;
    apply_coatings(&other, "550");
    assert_true(glint_bake_key(&other, &options) == key);
    apply_coatings(&other, "550/1.39");
    assert_true(glint_bake_key(&other, &options) != key);
    apply_coatings(&other, "550,550,550,551");
    assert_true(glint_bake_key(&other, &options) != key);
    apply_coatings(&other, "550/1.38:1");
    assert_true(glint_bake_key(&other, &options) == key);
    apply_coatings(&other, "550/1.38:1.01");
    assert_true(glint_bake_key(&other, &options) != key);
    apply_coatings(&other, "550/1.38/1.7");
    assert_true(glint_bake_key(&other, &options) != key);
}

TEST(default_mixed_coatings_are_valid)
{
    struct glint_coating coating[GLINT_MAX_COATINGS];
    const int n = glint_coatings_mixed(coating);

    assert_true(n >= 2 && n <= GLINT_MAX_COATINGS);
    for (int i = 0; i < n; i++)
        assert_true(coating[i].nm >= 100 && coating[i].nm <= 5000 &&
                    coating[i].n_films == 1 &&
                    coating[i].film[0].index == 1.38 &&
                    coating[i].film[0].quarters == 1 &&
                    (i == 0 || coating[i].nm != coating[i - 1].nm));
}
