/* SPDX-License-Identifier: MIT
 *
 * Tests extreme lenses, drawn by models and compared with exact images:
 * f-numbers up to 1000, stops of 3 to 64 blades, sensors of 1 to 100 mm, focal
 * lengths of 1 mm to 10 m, a lens scaled by 1/1000 and 1000, radii of 1e-2 and
 * 1e7 mm, 2 to 64 surfaces, no ghosts and two thousand ghosts.
 */
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

static struct glint_error error;

/* Images are so small that each takes 0.1 s. A draft model (tolerance 4) may
 * displace outlines by 0.12 pixel, in faint ghosts by a pixel, and its energy
 * may deviate by 2.4 %. For ghosts about ten pixels wide, this means a PSNR of
 * 40 dB; most lenses reach 50 dB. The flux must be within 3 %: 2.4 %, and the
 * displacement of outlines by 0.1 pixel. */
enum { W = 144, H = 96 };

#define LEAST_DB  40.0
#define MOST_FLUX 0.03

static struct stage stage;
static float test[3 * W * H], exact[3 * W * H];

struct worst {
    double db, flux;
};

static struct worst make_worst_errors(void)
{
    return (struct worst){999, 0};
}

static void compare_model_with_exact(struct worst *worst,
                                     const struct glint_lamp *lamp,
                                     const char *what, double value)
{
    struct glint_measure m;

    assert_true(stage_draw_linear(&stage, lamp, 1, test));
    assert_true(stage_draw_exact(&stage, lamp, 1, 128, exact));
    m = stage_compare_images(&stage, exact, test);
    if (m.psnr_db < LEAST_DB || fabs(m.flux - 1) > MOST_FLUX)
        print_message("  %s %g: %.1f dB, flux x %.4f\n", what, value, m.psnr_db,
                      m.flux);
    worst->db = fmin(worst->db, m.psnr_db);
    worst->flux = fmax(worst->flux, fabs(m.flux - 1));
}

static bool report_worst_errors(const char *what, struct worst worst)
{
    char name[100];
    bool ok;

    snprintf(name, sizeof name, "lenses: %s, against exact", what);
    ok = extreme_check_at_least(name, worst.db, LEAST_DB, "dB");
    snprintf(name, sizeof name, "lenses: %s, flux", what);
    return extreme_check_at_most(name, worst.flux, MOST_FLUX, "") && ok;
}

/* A cemented doublet with the stop behind it: three surfaces, three ghosts. */
static const char doublet[] = "name doublet\nf-number 5.6\nfilm 36 24\n"
                              "surface 61.47 6 13 1.5168 64.17\n"
                              "surface -44.64 2.5 13 1.6727 32.21\n"
                              "surface -129.94 2 13 air\n"
                              "stop 93 10\n";

static void open_lens_text(const char *text, int n_blades)
{
    stage_free(&stage);
    assert_true(stage_parse_lens(&stage, text));
    assert_true(stage_set_up_lens(&stage, n_blades));
}

static void bake_opened_lens(double max_deg)
{
    assert_true(stage_bake_or_load_model(&stage, 4, max_deg));
    stage_set_view(&stage, W, H, 0);
}

/* --------------------------------------------- f-numbers, blades, outlines */

TEST(extreme_f_numbers_match_exact_rays)
{
    static const double f[] = {5.1, 8, 16, 45, 128, 1000};
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    struct worst worst = make_worst_errors();

    for (int k = 0; k < 6; k++) {

        stage_free(&stage);
        assert_true(stage_parse_lens(&stage, doublet));
        if (glint_prescription_set_f_number(&stage.lens, f[k], &error))
            fail_msg("%s", error.text);
        assert_true(stage_set_up_lens(&stage, 8));
        bake_opened_lens(8);
        compare_model_with_exact(&worst, &lamp, "f/", f[k]);
    }
    assert_true(report_worst_errors("f/5.1 (open) to f/1000", worst));
}

TEST(extreme_numbers_of_blades_match_exact_rays)
{
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    struct worst worst = make_worst_errors();

    open_lens_text(doublet, 0);
    bake_opened_lens(8);
    for (int n = 0; n <= 64; n += n == 0 ? 3 : n < 12 ? 1 : 13) {
        assert_true(stage_set_up_lens(&stage, n));
        assert_true(stage_bake_or_load_model(&stage, 4, 8));
        stage_set_view(&stage, W, H, 0);
        compare_model_with_exact(&worst, &lamp, "blades", n);
    }
    assert_true(
        report_worst_errors("stops of 3 to 64 blades and a circle", worst));
}

/* Checks that the outline of a ghost 300 pixels wide with a round stop shows no
 * chords. Apart from the stop, the ghost is hardly bent. The limit of 50 dB
 * lies between the 44.4 dB of a grid of 8 cells and the 54.5 dB of the planned
 * number of cells. */
TEST(outline_of_a_round_stop_shows_no_chords)
{
    enum { WIDE = 432, HIGH = 288 };
    const size_t bytes = sizeof(float) * 3 * WIDE * HIGH;
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    float *drawn = malloc(bytes), *want = malloc(bytes);
    double db;

    assert_true(drawn && want);
    stage_free(&stage);
    assert_true(stage_parse_lens(&stage, doublet));
    assert_ok(glint_prescription_set_f_number(&stage.lens, 64, &error));
    assert_true(stage_set_up_lens(&stage, 0) &&
                stage_bake_or_load_model(&stage, 2, 8));
    stage_set_view(&stage, WIDE, HIGH, 0);
    assert_true(stage_draw_linear(&stage, &lamp, 1, drawn));
    assert_true(stage_draw_exact(&stage, &lamp, 1, 128, want));
    db = stage_compare_images(&stage, want, drawn).psnr_db;
    free(drawn);
    free(want);
    assert_at_least("lenses: outline of a round stop, 300 pixels", db, 50,
                    "dB");
}

/* Checks that barrel apertures that clip half of the light need few cells: the
 * outline with 8 cells is nearly that with 128, as its chords lie on both sides
 * of the exact outline. The limit of 48 dB lies between the 46.0 dB of chords
 * inside the outline and the 49.9 dB of chords on both sides. */
TEST(barrel_outline_needs_few_cells)
{
    static const char narrow[] = "name narrow\nf-number 5.6\nfilm 36 24\n"
                                 "surface 61.47 6 7 1.5168 64.17\n"
                                 "surface -44.64 2.5 7 1.6727 32.21\n"
                                 "surface -129.94 2 7 air\n"
                                 "stop 93 10\n";
    enum { WIDE = 432, HIGH = 288 };
    const size_t bytes = sizeof(float) * 3 * WIDE * HIGH;
    const struct glint_lamp lamp = stage_make_lamp(7, 25, 1);
    float *drawn = malloc(bytes), *want = malloc(bytes);
    double db;

    assert_true(drawn && want);
    open_lens_text(narrow, 8);
    assert_true(stage_bake_or_load_model(&stage, 1, 8));
    stage_set_view(&stage, WIDE, HIGH, 0);
    stage.frame.picture.uniform = true;
    stage.frame.dials.fineness = 128;
    assert_true(stage_draw_linear(&stage, &lamp, 1, want));
    stage.frame.dials.fineness = 8;
    assert_true(stage_draw_linear(&stage, &lamp, 1, drawn));
    db = stage_compare_images(&stage, want, drawn).psnr_db;
    free(drawn);
    free(want);
    assert_at_least("lenses: outline of barrels, 8 cells against 128", db, 48,
                    "dB");
}

/* ----------------------------------------------- sensors and focal lengths */

/* Checks sensors of several sizes. A model is valid for the image size in its
 * lens table plus a tenth, so a larger sensor needs another model, baked as in
 * tools/glint/model/settings.c. */
TEST(extreme_sensor_sizes_match_exact_rays)
{
    static const double mm[] = {1, 2.5, 6.4, 36, 100};
    const struct glint_lamp lamp = stage_make_lamp(4, 25, 1);
    struct worst worst = make_worst_errors();

    for (int k = 0; k < 5; k++) {
        stage_free(&stage);
        assert_true(stage_parse_lens(&stage, doublet));
        stage.lens.film_width_mm = mm[k];
        stage.lens.film_height_mm = mm[k] * H / W;
        assert_true(stage_set_up_lens(&stage, 8));
        bake_opened_lens(6);
        compare_model_with_exact(&worst, &lamp, "sensor", mm[k]);
    }
    assert_true(report_worst_errors("sensors of 1 to 100 mm", worst));
}

/* Multiplies all lengths of the lens by FACTOR, except the thickness of
 * coatings, which is relative to the wavelength. */
static void scale_lens(struct glint_prescription *l, double factor)
{
    for (int k = 0; k < l->n_surfaces; k++) {
        l->surface[k].radius_mm *= factor;
        l->surface[k].thickness_mm *= factor;
        l->surface[k].semi_mm *= factor;
    }
    l->stop_thickness_mm *= factor;
    l->stop_semi_mm *= factor;
    l->film_width_mm *= factor;
    l->film_height_mm *= factor;
    l->check_focal_mm = l->check_back_mm = 0;
}

static void open_scaled_lens(double factor, double max_deg)
{
    stage_free(&stage);
    assert_true(stage_load_lens(&stage, "heliar-tronnier"));
    scale_lens(&stage.lens, factor);
    assert_true(stage_set_up_lens(&stage, 8));
    assert_true(stage_bake_or_load_model(&stage, 4, max_deg));
    stage_set_view(&stage, W, H, 0);
}

/* Checks that a lens scaled by 1000 or 1/1000 gives the same image on a scaled
 * sensor: only angles count, as there is no diffraction. For a power of two the
 * exact image is bit-identical; for 1000 rays differ by 1e-15, and a few may
 * fall on the other side of a threshold. Models are fitted again and must agree
 * to 50 dB; a lower PSNR would reveal a fixed length in mm in the bake. */
TEST(scaled_lens_gives_the_same_image)
{
    static const double factor[] = {0x1p-10, 0x1p10, 1e-3, 1e3};
    static float exact_one[3 * W * H], test_one[3 * W * H];
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    double bits = 0, db_exact = 999, db_model = 999, db_bits = 999;

    open_scaled_lens(1, 8);
    assert_true(stage_draw_linear(&stage, &lamp, 1, test_one));
    assert_true(stage_draw_exact(&stage, &lamp, 1, 128, exact_one));
    for (int k = 0; k < 4; k++) {
        double exact_db, model_db;

        open_scaled_lens(factor[k], 8);
        assert_true(stage_draw_linear(&stage, &lamp, 1, test));
        assert_true(stage_draw_exact(&stage, &lamp, 1, 128, exact));
        exact_db = stage_compare_images(&stage, exact_one, exact).psnr_db;
        model_db = stage_compare_images(&stage, test_one, test).psnr_db;
        print_message("  x %g: exact %.1f dB, model %.1f dB\n", factor[k],
                      exact_db, model_db);
        if (k < 2) {
            for (int i = 0; i < 3 * W * H; i++)
                bits += exact[i] != exact_one[i];
            db_bits = fmin(db_bits, model_db);
        } else
            db_exact = fmin(db_exact, exact_db);
        db_model = fmin(db_model, model_db);
    }
    assert_at_most("lenses: scaled by 2^-10 and 2^10, samples of the exact "
                   "picture that differ",
                   bits, 0, "samples");
    assert_at_least("lenses: scaled by 1e-3 and 1e3, exact pictures of both",
                    db_exact, 70, "dB");
    assert_at_least("lenses: scaled by 1e-3 and 1e3, models of both", db_model,
                    50, "dB");
}

TEST(extreme_focal_lengths_match_exact_rays)
{
    static const double focal[] = {1, 10, 1000, 10000};
    struct worst worst = make_worst_errors();
    struct glint_optics o;

    for (int k = 0; k < 4; k++) {
        const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);

        stage_free(&stage);
        assert_true(stage_parse_lens(&stage, doublet));
        glint_optics_of(&stage.lens, &o);
        scale_lens(&stage.lens, focal[k] / o.focal_mm);
        assert_true(stage_set_up_lens(&stage, 8));
        bake_opened_lens(8);
        compare_model_with_exact(&worst, &lamp, "focal length", focal[k]);
    }
    assert_true(report_worst_errors("focal lengths of 1 mm to 10 m", worst));
}

/* ------------------------------------------------------ radii of curvature */

TEST(smallest_ball_lens_matches_exact_rays)
{
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    struct worst worst = make_worst_errors();

    stage_free(&stage);
    /* Radii of 1/100 mm (1.1, scaled) are the smallest valid radii. */
    assert_true(stage_parse_lens(&stage, "name ball\nf-number 4\nfilm 1 0.7\n"
                                         "surface 1.1 1.1 1 1.5168 64.17\n"
                                         "stop 1.1 0.3\n"
                                         "surface -1.1 0.6 1 1.62 36.4\n"
                                         "surface -1.6 0.5 1.5 air\n"));
    scale_lens(&stage.lens, 0.01 / 1.1);
    assert_true(stage_set_up_lens(&stage, 8));
    bake_opened_lens(8);
    compare_model_with_exact(&worst, &lamp, "ball of mm", 0.01);
    assert_true(report_worst_errors("radii of 1e-2 mm", worst));
}

/* Checks that a surface 28 mm wide with a radius of 1e7 mm gives the image of a
 * plane, from which it differs by 1e-5 mm (1/50 wavelength). */
TEST(almost_plane_surface_matches_exact_rays)
{
    static const char *const radius[] = {"flat", "1e7", "-1e7", "1e9"};
    const struct glint_lamp lamp = stage_make_lamp(6, 25, 1);
    static float plane[3 * W * H];
    struct worst worst = make_worst_errors();
    double db = 999;

    for (int k = 0; k < 4; k++) {
        char text[400];

        snprintf(text, sizeof text,
                 "name plate\nf-number 8\nfilm 36 24\n"
                 "surface %s 3 14 1.62 36.4\n"
                 "surface %s 1 14 air\n"
                 "surface 51.68 5 12 1.5168 64.17\n"
                 "surface %s 2 12 air\nstop 92 10\n",
                 radius[k], radius[k], radius[k]);
        open_lens_text(text, 8);
        bake_opened_lens(8);
        compare_model_with_exact(&worst, &lamp, "radius", k);
        if (k == 0)
            memcpy(plane, exact, sizeof plane);
        db = fmin(db, stage_compare_images(&stage, plane, exact).psnr_db);
    }
    assert_true(report_worst_errors("planes and radii of 1e7 mm", worst));
    assert_at_least("lenses: radii of 1e7 mm against planes", db, 70, "dB");
}

/* ----------------------------------------------------- numbers of surfaces */

/* Makes a lens of N surfaces with a focal length of about 100 mm, the stop
 * behind the first SPLIT surfaces, and the sensor at the focus. */
static void open_lens_of_many_surfaces(int n, int split)
{
    struct glint_prescription *l = &stage.lens;
    struct glint_optics o;

    stage_free(&stage);
    assert_true(stage_parse_lens(&stage, doublet));
    l->n_surfaces = n;
    l->stop_after = split;
    /* The rear surface of each element is almost plane, so that all elements
     * have about the same refractive power. */
    for (int k = 0; k < n; k++)
        l->surface[k] = (struct glint_surface){
            .radius_mm = k % 2 ? -3000.0 - 100 * k : 52.0 * n / 2,
            .thickness_mm = k % 2 ? 0.6 : 1.5,
            .semi_mm = 7,
            .nd = k % 2 ? 1 : 1.5168,
            .vd = k % 2 ? 0 : 64.17,
            .coating = {550, 1, {{1.38, 1}}}};
    l->stop_thickness_mm = 0.5;
    l->stop_semi_mm = 6;
    l->f_number = 12;
    l->film_width_mm = 12;
    l->film_height_mm = 8;
    glint_optics_of(l, &o);
    if (split == n)
        l->stop_thickness_mm = o.back_focal_mm - l->surface[n - 1].thickness_mm;
    else
        l->surface[n - 1].thickness_mm = o.back_focal_mm;
    assert_true(o.stop_radius_mm > 1 && o.stop_radius_mm < 6);
    assert_true(stage_set_up_lens(&stage, 8));
}

/* Checks lenses of 2 to 64 surfaces. A single surface would have the same
 * medium on both sides and is rejected. Two surfaces with the stop between them
 * have no ghost; lenses of more surfaces must give the right image. */
TEST(lenses_of_2_to_64_surfaces_match_exact_rays)
{
    static const int n[] = {2, 4, 8, 16, 32, 64};
    const struct glint_lamp lamp = stage_make_lamp(2, 25, 1);
    struct worst worst = make_worst_errors();
    struct glint_prescription lens;
    static const char one[] = "name one\nf-number 8\nfilm 36 24\n"
                              "surface 50 100 5 air\nstop 5 5\n";

    assert_int_equal(
        glint_prescription_parse(&lens, one, sizeof one - 1, "one", &error),
        GLINT_E_LENS);
    for (int k = 0; k < (extreme_is_long_run() ? 6 : 4); k++) {
        open_lens_of_many_surfaces(n[k], n[k] / 2);
        if (n[k] == 2)
            assert_int_equal(stage.setup.n_ghosts, 0);
        bake_opened_lens(3);
        compare_model_with_exact(&worst, &lamp, "surfaces", n[k]);
    }
    assert_true(report_worst_errors(extreme_is_long_run() ? "2 to 64 surfaces"
                                                          : "2 to 16 surfaces",
                                    worst));
}

TEST(model_without_ghosts_changes_nothing)
{
    const struct glint_lamp lamp = stage_make_lamp(2, 25, 1e9);
    static uint8_t codes[3 * W * H];
    int changed = 0;

    open_lens_of_many_surfaces(2, 1);
    bake_opened_lens(3);
    memset(codes, 77, sizeof codes);
    assert_true(stage_draw_codes(&stage, &lamp, 1, codes));
    for (int i = 0; i < 3 * W * H; i++)
        changed += codes[i] != 77;
    assert_at_most("lenses: no ghosts, samples changed", changed, 0, "samples");
}

/* Checks a lens of 64 surfaces before the stop, which has 2016 pairs of
 * surfaces. Rays are traced exactly, as baking so many ghosts takes an hour;
 * planning, binning and summing do the same work. */
TEST(two_thousand_ghosts_are_drawn)
{
    const struct glint_lamp lamp = stage_make_lamp(2, 25, 1);
    struct worst worst = make_worst_errors();

    if (!extreme_is_long_run()) {
        skip();
        return;
    }
    open_lens_of_many_surfaces(64, 64);
    assert_int_equal(stage.setup.n_ghosts, 2016);
    stage_set_view(&stage, W, H, 0);
    stage.frame.dials.fineness = 32;
    assert_true(stage_draw_linear(&stage, &lamp, 1, test));
    assert_true(stage_draw_exact(&stage, &lamp, 1, 48, exact));
    {
        const struct glint_measure m =
            stage_compare_images(&stage, exact, test);

        worst = (struct worst){m.psnr_db, fabs(m.flux - 1)};
        assert_int_equal(stage.drawn.stats.dropped_bundles, 0);
        print_message("  %d of 2016 ghosts drawn\n", stage.drawn.ghosts);
    }
    assert_true(report_worst_errors("2016 ghosts, exact rays", worst));
}

TEST_CLOSE
{
    stage_free(&stage);
}
